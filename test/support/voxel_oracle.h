// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "throng/cells.h"
#include "throng/math.h"

/// Short any-angle ways between voxels, by brute force: knows nothing of octrees or boxes.
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
  /// Does the straight line stay out of filled voxels? Looked at a hundredth of a voxel at a time;
  /// touching one, to 1e-9 voxels, is not entering it. [voxels]
  [[nodiscard]] bool is_clear(const Vec3d& a, const Vec3d& b) const;
  /// Length of the shortest way, in voxels, among those that bend at corners of voxels on convex
  /// edges only and are not longer than `limit`: A* over all such corners, any two that see each
  /// other joined. A way that bends between two corners of an edge may be shorter still, by less
  /// than a hundredth at the unit spacing of corners. Nothing: there is no such way, or more than
  /// `most` corners would have to be looked at.
  struct Answer {
    bool given_up = false;
    std::optional<double> length;
  };
  [[nodiscard]] Answer shortest(const HalfPoint3& from, const HalfPoint3& to, double limit,
                                size_t most) const;

 private:
  using Voxel = std::array<int64_t, 3>;
  /// A point, and the open voxels around it that the way is among: where voxels touch only at an
  /// edge or a corner, there is more than one side to be on.
  struct Spot {
    HalfPoint3 at;
    std::vector<Voxel> side;
  };
  /// Can a point go straight from one to the other? It may slide along faces and touch edges and
  /// corners, but not slip between voxels that touch only there. In whole numbers, exact.
  [[nodiscard]] bool sees(const Spot& a, const Spot& b) const;
  [[nodiscard]] bool is_bend(int64_t x, int64_t y, int64_t z) const;
  [[nodiscard]] std::vector<Voxel> led_on(const std::vector<Voxel>& from,
                                          const std::vector<Voxel>& to) const;
  void add_sides(int64_t x, int64_t y, int64_t z, std::vector<Spot>& spots) const;

  int64_t size_[3];
  std::vector<uint64_t> filled_;
};

}  // namespace throng::test
