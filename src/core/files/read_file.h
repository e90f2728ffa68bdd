// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/base.h"

/// Whole files in memory.
namespace throng {

/// The bytes of a file. Fails with kBadFile (missing, a folder) or kIo; the sentence names the
/// path.
[[nodiscard]] Result<std::string> read_file(const std::string& path);

}  // namespace throng
