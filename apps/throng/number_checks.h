// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

/// What numbers options take. Others are refused with a sentence: "--reach: -1 is below 0".
namespace throng::app {

[[nodiscard]] CLI::Validator at_least(double least);
[[nodiscard]] CLI::Validator above(double bound);
[[nodiscard]] CLI::Validator between(double least, double most);

}  // namespace throng::app
