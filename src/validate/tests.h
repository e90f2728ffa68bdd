// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "throng/validation.h"

/// The families of tests, one file each.
namespace throng::validate {

struct Test {
  ValidationTest about;
  Result<ValidationResult> (*run)(const ValidationConfig& config, Context& context);
};

std::span<const Test> density_tests();     // fundamental diagrams
std::span<const Test> bottleneck_tests();  // flow through doors

}  // namespace throng::validate
