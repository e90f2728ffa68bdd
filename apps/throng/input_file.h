// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/base.h"
#include "throng/recording.h"

/// The one reading of text files that options name.
namespace throng::app {

/// All bytes of a file; pipes are files, too. Fails with kNotFound or kBadFile, the reason and
/// `remedy`, which says what to give instead: "goals.csv: is a folder, not a file; REMEDY".
[[nodiscard]] Result<std::string> read_file(const std::string& path, const std::string& remedy);

/// Fails as read_file does before its first byte: for files that are read line by line.
[[nodiscard]] Result<void> check_file(const std::string& path, const std::string& remedy);

/// Does a path name a file of slices, by its content or its end, ".slices"? No folder does.
[[nodiscard]] bool names_slices(const std::string& path);
/// What to do if it cannot be read.
inline constexpr const char* kNoSlices = "write slices with `throng slices MODEL -o FILE.slices`";

/// Fails with kBadFile if a recording holds no frame: nothing can be shown, exported or summed up.
[[nodiscard]] Result<void> check_has_frames(const Replay& replay, const std::string& file);

}  // namespace throng::app
