// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "throng/base.h"

/// A graphics context that needs no window and no display server.
namespace throng::draw {

class Headless {
 public:
  /// Fails with kNotFound and what to install.
  [[nodiscard]] static Result<std::unique_ptr<Headless>> create();
  Headless(const Headless&) = delete;
  Headless& operator=(const Headless&) = delete;
  ~Headless();
  /// Makes this context current on the calling thread.
  void make_current() const;

 private:
  Headless() = default;
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace throng::draw
