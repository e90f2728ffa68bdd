// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "import/raw/raw_scene.h"

/// Lists of Bezier patches as text (.bpt), the format of the Utah teapot.
namespace throng::importer {

/// Reads patches of degree 1 to 3 in each direction, raised to 3. The file lists no neighbours: two
/// patches are neighbours where their borders are the same numbers. Its second index is our t, so
/// that the teapot's normals point outward. Fails with kBadFile and the line.
[[nodiscard]] Result<RawScene> read_bpt(std::string_view bytes, const ReadOptions& options,
                                        Context& context);

}  // namespace throng::importer
