// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace throng::app {

/// The program's arguments, with old names of commands and options replaced by today's. Prints a
/// note for each. No --help shows the old names; they work for one version.
[[nodiscard]] std::vector<std::string> with_new_names(int argc, const char* const* argv);

}  // namespace throng::app
