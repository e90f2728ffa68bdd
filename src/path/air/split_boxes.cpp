// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/split_boxes.h"

// Each box with blocked cells becomes an octree of free parts. Linear in the box's cells.
namespace throng::path {

SplitBoxes::SplitBoxes(const FlightSpace& space)
    : space_(&space),
      first_(static_cast<uint32_t>(space.boxes.size())),
      split_((space.boxes.size() + 63) / 64) {}

uint32_t SplitBoxes::part_at(uint32_t box, int32_t x, int32_t y, int32_t z) const {
  const Nodes& nodes = nodes_.find(box)->second;
  const world::AirCube& cube = space_->boxes[box];
  x -= cube.x;
  y -= cube.y;
  z -= cube.z;
  uint32_t word = nodes[0];
  for (int32_t side = cube.side / 2; world::air_kind(word) == world::AirKind::kInner; side /= 2) {
    const int child =
        ((x & side) != 0 ? 1 : 0) | ((y & side) != 0 ? 2 : 0) | ((z & side) != 0 ? 4 : 0);
    word = nodes[world::air_number(word) + static_cast<uint32_t>(child)];
  }
  return world::air_kind(word) == world::AirKind::kFree ? first_ + world::air_number(word) : kNoBox;
}

void SplitBoxes::cut(uint32_t box, const CubeCells& blocked) {
  if (is_split(box)) {
    for_parts(box, [&](uint32_t part) { spare_.push_back(part - first_); });
    nodes_.erase(box);
    split_[box / 64] &= ~(uint64_t{1} << (box % 64));
  }
  Nodes nodes(1);
  const world::AirCube& cube = space_->boxes[box];
  const int32_t side = cube.side;
  uint32_t any = 0;
  for (int32_t y = 0; y < side; ++y) {
    for (int32_t z = 0; z < side; ++z) any |= blocked.row(y, z);
  }
  if (any == 0) return;
  nodes[0] = build(nodes, {0, 0, 0, side}, cube, blocked);
  split_[box / 64] |= uint64_t{1} << (box % 64);
  nodes_.emplace(box, std::move(nodes));
}

uint32_t SplitBoxes::build(Nodes& nodes, const world::AirCube& cube, const world::AirCube& box,
                           const CubeCells& blocked) {
  const uint32_t columns = (~uint32_t{0} >> (32 - cube.side)) << cube.x;
  uint32_t any = 0, all = columns;
  for (int32_t y = cube.y; y < cube.y + cube.side; ++y) {
    for (int32_t z = cube.z; z < cube.z + cube.side; ++z) {
      any |= blocked.row(y, z);
      all &= blocked.row(y, z);
    }
  }
  if (all == columns) return world::air_word(world::AirKind::kFull, 0);
  if ((any & columns) == 0) {
    uint32_t part = static_cast<uint32_t>(cubes_.size());
    if (spare_.empty()) {
      cubes_.emplace_back();
    } else {
      part = spare_.back();
      spare_.pop_back();
    }
    cubes_[part] = {box.x + cube.x, box.y + cube.y, box.z + cube.z, cube.side};
    return world::air_word(world::AirKind::kFree, part);
  }
  const size_t first = nodes.size();
  nodes.resize(first + 8);
  const int32_t half = cube.side / 2;
  for (int32_t c = 0; c < 8; ++c) {
    const uint32_t word = build(
        nodes,
        {cube.x + (c & 1) * half, cube.y + (c >> 1 & 1) * half, cube.z + (c >> 2) * half, half},
        box, blocked);
    nodes[first + static_cast<size_t>(c)] = word;
  }
  return world::air_word(world::AirKind::kInner, static_cast<uint32_t>(first));
}

}  // namespace throng::path
