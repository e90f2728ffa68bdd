// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

/// Files that the program keeps for a user, where the XDG base directories say.
namespace throng::app {

enum class UserFolder { kConfig, kCache };

/// "/home/ann/.config/throng/NAME"; empty where there is no home.
[[nodiscard]] std::string user_file(UserFolder folder, const std::string& name);
/// Makes the folder that a file lies in; false if that cannot be done.
[[nodiscard]] bool make_folder_of(const std::string& file);
/// All of a file; empty if there is none.
[[nodiscard]] std::string read_text(const std::string& file);
/// Writes beside and renames; false if that cannot be done.
[[nodiscard]] bool write_text(const std::string& file, const std::string& text);

}  // namespace throng::app
