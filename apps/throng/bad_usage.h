// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace throng::app {

/// The subcommand that was called, or null.
[[nodiscard]] const CLI::App* command_in_use(const CLI::App& parser);

/// The fault of the program's arguments, in one sentence without its full stop.
/// `words`: the command line, as typed.
[[nodiscard]] std::string what_is_wrong(const CLI::ParseError& error, const CLI::App& parser,
                                        const std::vector<std::string>& words);

}  // namespace throng::app
