// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "import/raw_scene.h"

/// Stanford PLY, text and binary, read by ourselves: on a truncated text file assimp never ends.
namespace throng {

/// Reads `x y z` of the element "vertex" and the list `vertex_indices` (or `vertex_index`) of the
/// element "face"; steps over everything else. Faces that the file ends before are refused; bad
/// indices are counted. Fails with kBadFile and the line of the header or the element.
[[nodiscard]] Result<RawScene> read_ply(std::string_view bytes, const ReadOptions& options,
                                        Context& context);

}  // namespace throng
