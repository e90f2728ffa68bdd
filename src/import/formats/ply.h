// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "import/raw/raw_scene.h"

/// Stanford PLY, text and binary, read without assimp, which never ends on a truncated text file.
namespace throng::importer {

/// Reads `x y z` of the element "vertex" and the list `vertex_indices` (or `vertex_index`) of the
/// element "face"; skips everything else. A file that ends before its last face is refused; bad
/// indices are counted. Fails with kBadFile and the line of the header or the element.
[[nodiscard]] Result<RawScene> read_ply(std::string_view bytes, const ReadOptions& options,
                                        Context& context);

}  // namespace throng::importer
