// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "path/air/blocked_air.h"

/// Boxes of a space of which some cells are blocked.
namespace throng::path {

/// What is left of such a box is cut into cubes, its parts, as an octree down to single voxels.
/// They are numbered from the number of boxes on; numbers of deleted parts are used again.
class SplitBoxes {
 public:
  explicit SplitBoxes(const FlightSpace& space);

  [[nodiscard]] bool is_split(uint32_t box) const {
    return (split_[box / 64] >> (box % 64) & 1) != 0;
  }
  /// Of a split box: the part that holds one of its voxels, or kNoBox.
  [[nodiscard]] uint32_t part_at(uint32_t box, int32_t x, int32_t y, int32_t z) const;
  [[nodiscard]] const world::AirCube& cube(uint32_t part) const { return cubes_[part - first_]; }
  /// Above every part's number.
  [[nodiscard]] uint32_t end() const { return first_ + static_cast<uint32_t>(cubes_.size()); }
  /// Blocks voxels of a box, instead of those blocked before; with none it is whole again.
  void cut(uint32_t box, const CubeCells& blocked);
  /// Calls visit(part) for each part of a split box, always in the same order.
  template <class Visit>
  void for_parts(uint32_t box, Visit visit) const {
    const Nodes& nodes = nodes_.find(box)->second;
    for (const uint32_t word : nodes) {
      if (world::air_kind(word) == world::AirKind::kFree) visit(first_ + world::air_number(word));
    }
  }
  /// The same for parts of at least `min_side` cells a side with cells in a range.
  template <class Visit>
  void for_parts_in(uint32_t box, const AirRange& range, int32_t min_side, Visit& visit) const {
    visit_parts(nodes_.find(box)->second, 0, space_->boxes[box], range, min_side, visit);
  }

 private:
  using Nodes = std::vector<uint32_t>;  // words of an octree; the first is its root
  uint32_t build(Nodes& nodes, const world::AirCube& cube, const world::AirCube& box,
                 const CubeCells& blocked);
  template <class Visit>
  void visit_parts(const Nodes& nodes, size_t node, const world::AirCube& cube,
                   const AirRange& range, int32_t min_side, Visit& visit) const;

  const FlightSpace* space_;
  uint32_t first_;                             // number of the first part
  std::vector<uint64_t> split_;                // bits, by box
  std::unordered_map<uint32_t, Nodes> nodes_;  // by split box; looked up only
  std::vector<world::AirCube> cubes_;          // by part
  std::vector<uint32_t> spare_;                // deleted parts
};

template <class Visit>
void SplitBoxes::visit_parts(const Nodes& nodes, size_t node, const world::AirCube& cube,
                             const AirRange& range, int32_t min_side, Visit& visit) const {
  const uint32_t word = nodes[node];
  if (world::air_kind(word) == world::AirKind::kFull || cube.side < min_side) return;
  const int32_t low[3] = {cube.x, cube.y, cube.z};
  for (int a = 0; a < 3; ++a) {
    if (low[a] > range.last[a] || low[a] + cube.side <= range.first[a]) return;
  }
  if (world::air_kind(word) == world::AirKind::kFree) {
    visit(first_ + world::air_number(word));
    return;
  }
  const int32_t half = cube.side / 2;
  for (int32_t c = 0; c < 8; ++c) {
    visit_parts(
        nodes, world::air_number(word) + static_cast<size_t>(c),
        {cube.x + (c & 1) * half, cube.y + (c >> 1 & 1) * half, cube.z + (c >> 2) * half, half},
        range, min_side, visit);
  }
}

}  // namespace throng::path
