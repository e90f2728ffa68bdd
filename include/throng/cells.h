// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/result.h"

/// Worlds given by cells or voxels in place of triangles, as in the benchmarks of path search.
namespace throng {

/// Flat ground, row by row. A cell says where a point may be; it is no solid that keeps a body
/// away.
struct FlatCells {
  int32_t width = 0;              ///< Along x. [1 to 16000]
  int32_t depth = 0;              ///< Along z. [1 to 16000]
  std::vector<uint8_t> passable;  ///< width * depth: 1 where the point may be, else 0.
};

/// Filled voxels of a box of width * height * depth voxels along x, y (up) and z.
struct VoxelCells {
  int32_t width = 0, height = 0, depth = 0;  ///< [1 to 4096]
  struct Cube {
    int32_t x = 0, y = 0, z = 0;
  };
  std::vector<Cube> filled;  ///< In any order; repetitions are allowed.
};

/// Reads a map of Moving AI's voxel benchmarks (`voxel X Y Z`, then a filled voxel a line); the
/// file's axes are ours. Fails with kBadFile and the line, or kIo. Source: [BS18].
[[nodiscard]] THRONG_API Result<VoxelCells> load_voxel_map(const std::string& path);

/// Reads a map of Moving AI's grid benchmarks (`type octile`): `.`, `G` and `S` are passable; the
/// file's x is x, its y is z. Fails with kBadFile and the line, or kIo. Source: [Stu12].
[[nodiscard]] THRONG_API Result<FlatCells> load_grid_map(const std::string& path);

}  // namespace throng
