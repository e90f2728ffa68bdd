// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "import/raw/raw_scene.h"

/// Wavefront OBJ, read without assimp: in double precision (city tiles keep their millimetres),
/// with `o`, `g` and `usemtl` names even where the material file is missing.
namespace throng::importer {

/// `o` and `g` names become the node "object/group". Lines and points are counted and skipped. A
/// face with a bad index is dropped and counted. Never fails on content: load_scene refuses
/// an empty scene.
[[nodiscard]] Result<RawScene> read_obj(std::string_view bytes, const ReadOptions& options,
                                        Context& context);

}  // namespace throng::importer
