// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "throng/base.h"
#include "throng/scene.h"

/// Short any-angle paths between voxels, by brute force: independent of octrees and air boxes.
namespace throng::test {

/// A point in half voxels, so that the middles of voxels are whole numbers.
using HalfPoint3 = std::array<int64_t, 3>;

inline HalfPoint3 middle(int32_t x, int32_t y, int32_t z) {
  return {2 * int64_t{x} + 1, 2 * int64_t{y} + 1, 2 * int64_t{z} + 1};
}

class VoxelOracle {
 public:
  explicit VoxelOracle(const VoxelCells& cells);

  [[nodiscard]] bool is_open(int64_t x, int64_t y, int64_t z) const;
  /// Does the segment stay out of filled voxels? Sampled every hundredth of a voxel; touching one,
  /// to 1e-9 voxels, is not entering it. [voxels]
  [[nodiscard]] bool is_clear(const Vec3d& a, const Vec3d& b) const;
  /// Length of the shortest path, in voxels, among those that bend only at corners of voxels on
  /// convex edges and are not longer than `limit`: A* over all such corners, where any two that see
  /// each other are joined. A path that bends between two corners of an edge may be shorter, by
  /// less than a hundredth at the unit spacing of corners. Nothing: there is no such path, or there
  /// are more than `max_corners` corners.
  struct Answer {
    bool budget_exhausted = false;
    std::optional<double> length;
  };
  [[nodiscard]] Answer shortest(const HalfPoint3& from, const HalfPoint3& to, double limit,
                                size_t max_corners) const;

 private:
  using Voxel = std::array<int64_t, 3>;
  /// A point, and the connected open voxels around it that the path is in: where voxels touch only
  /// at an edge or a corner, a point has more than one such side.
  struct Node {
    HalfPoint3 at;
    std::vector<Voxel> side;
  };
  /// Can a point move straight from a to b? It may slide along faces and touch edges and corners,
  /// but not pass between voxels that touch only there. Exact, in integers.
  [[nodiscard]] bool sees(const Node& a, const Node& b) const;
  [[nodiscard]] bool is_corner(int64_t x, int64_t y, int64_t z) const;
  [[nodiscard]] std::vector<Voxel> reachable(const std::vector<Voxel>& from,
                                             const std::vector<Voxel>& to) const;
  void add_sides(int64_t x, int64_t y, int64_t z, std::vector<Node>& nodes) const;

  int64_t size_[3];
  std::vector<uint64_t> filled_;
};

}  // namespace throng::test
