// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "throng/scene.h"

/// Moving AI's benchmark maps.
namespace throng::importer {

/// `name` is for messages only. Fails with kBadFile and the line.
Result<FlatCells> read_grid_map(std::string_view text, const std::string& name);
Result<VoxelCells> read_voxel_map(std::string_view text, const std::string& name);

}  // namespace throng::importer
