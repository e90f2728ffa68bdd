// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// Values of options as they were typed, and those that no option takes.
namespace throng::app {

/// The values of an option among the words of a command line, joined by its delimiter. CLI11 drops
/// empty ones where it splits: of "1,,3" it keeps "1" and "3". Empty for positional arguments.
[[nodiscard]] std::string typed_values(const CLI::Option& option,
                                       const std::vector<std::string>& words);

/// Refuses what CLI11 takes for a number and is none: empty values (0), NaN, and numbers below 0 of
/// options that count, which wrap around. Throws CLI::ValidationError, which names the option.
void check_values(const CLI::App& command, const std::vector<std::string>& words);

}  // namespace throng::app
