// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/headless.h"

// In a browser's page there is only the canvas's context.
namespace throng::draw {

Result<std::unique_ptr<Headless>> Headless::create() {
  return Error{Errc::kNotFound, "drawing: a page draws into its canvas only"};
}

Headless::~Headless() = default;

void Headless::make_current() const {}

}  // namespace throng::draw
