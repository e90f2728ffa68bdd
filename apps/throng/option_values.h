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

/// Has all numbers among the options of `command` read to base 10: CLI11 reads 010 as 8 and 0x10 as
/// 16. Leading zeros are dropped; hexadecimal numbers, and whole numbers of more than 64 bits
/// (which CLI11 takes for the largest), are refused with the option's name. For a command that has
/// all its options.
void read_base_10(CLI::App& command);

/// Refuses what CLI11 takes for a number and is none: empty values (0), NaN, and numbers below 0 of
/// options that count, which wrap around. Throws CLI::ValidationError, which names the option.
void check_values(const CLI::App& command, const std::vector<std::string>& words);

}  // namespace throng::app
