// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

/// Limits of numeric options. Other values are refused with a sentence: "--radius: -1 is below 0".
namespace throng::app {

[[nodiscard]] CLI::Validator at_least(double min);
[[nodiscard]] CLI::Validator above(double bound);
[[nodiscard]] CLI::Validator between(double min, double max);

}  // namespace throng::app
