// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/flight_space.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "world/legal_air.h"

// The legal air of a class, cut into the boxes of an octree per zone, whose connected components
// are numbered. Linear in the voxels times the body's width.
namespace throng::path {

AirPoint off_faces(AirPoint p) { return {off_faces(p.x), off_faces(p.y), off_faces(p.z)}; }

uint32_t FlightSpace::box_at(AirPoint p) const {
  constexpr double kMaxCoordinate = 1e9;
  if (!(std::fabs(p.x) < kMaxCoordinate && std::fabs(p.y) < kMaxCoordinate &&
        std::fabs(p.z) < kMaxCoordinate))
    return kNoBox;
  return box_at(static_cast<int32_t>(std::floor(p.x)), static_cast<int32_t>(std::floor(p.y)),
                static_cast<int32_t>(std::floor(p.z)));
}

bool FlightSpace::sees(AirPoint from, AirPoint to) const { return air_sees(*this, from, to); }

void FlightSpace::boxes_in(const AirRange& range, std::vector<uint32_t>& found) const {
  found.clear();
  const auto is_in = [&](const world::AirCube& cube) {
    const int32_t low[3] = {cube.x, cube.y, cube.z};
    for (int a = 0; a < 3; ++a) {
      if (low[a] > range.last[a] || low[a] + cube.side <= range.first[a]) return false;
    }
    return true;
  };
  for (int32_t zz = std::max(range.first[2], 0) / zone_side;
       zz <= std::min(range.last[2] / zone_side, zones_z - 1); ++zz) {
    for (int32_t zx = std::max(range.first[0], 0) / zone_side;
         zx <= std::min(range.last[0] / zone_side, zones_x - 1); ++zx) {
      const auto zone = static_cast<size_t>(zz * zones_x + zx);
      const world::AirTreeData& tree = zones[zone];
      // Cubes are given in cells of the world.
      const auto descend = [&](auto&& self, const world::AirCube& cube, uint32_t word) -> void {
        if (world::air_kind(word) == world::AirKind::kFull || !is_in(cube)) return;
        if (world::air_kind(word) == world::AirKind::kFree) {
          found.push_back(world::air_number(word));
        } else if (world::air_kind(word) == world::AirKind::kLeaf) {
          const Leaf& leaf = leaves[zone][world::air_number(word)];
          for (int32_t i = 0; i < std::popcount(leaf.starts); ++i) {
            const uint32_t box = leaf.first_box + static_cast<uint32_t>(i);
            if (is_in(boxes[box])) found.push_back(box);
          }
        } else {
          const int32_t half = cube.side / 2;
          for (int32_t c = 0; c < 8; ++c) {
            self(self,
                 {cube.x + (c & 1) * half, cube.y + (c >> 1 & 1) * half, cube.z + (c >> 2) * half,
                  half},
                 tree.nodes[world::air_number(word) + static_cast<uint32_t>(c)]);
          }
        }
      };
      for (uint32_t r = 0; r < tree.roots; ++r) {
        descend(descend,
                {zx * zone_side, tree.base + static_cast<int32_t>(r) * tree.side, zz * zone_side,
                 tree.side},
                tree.nodes[r]);
      }
    }
  }
}

uint64_t FlightSpace::bytes() const {
  uint64_t sum = boxes.size() * (sizeof(world::AirCube) + sizeof(uint32_t));
  for (const world::AirTreeData& tree : zones)
    sum += tree.nodes.size() * 4 + tree.leaves.size() * 8;
  for (const auto& of_zone : leaves) sum += of_zone.size() * sizeof(Leaf);
  return sum;
}

namespace {

// Numbers the free cubes and the boxes of leaves.
void number_boxes(world::AirTreeData& tree, std::vector<FlightSpace::Leaf>& leaves,
                  std::vector<world::AirCube>& boxes) {
  leaves.resize(tree.leaves.size());
  const auto number = [&](auto&& self, const world::AirCube& cube, size_t node) -> void {
    const uint32_t word = tree.nodes[node];
    if (world::air_kind(word) == world::AirKind::kFree) {
      tree.nodes[node] =
          world::air_word(world::AirKind::kFree, static_cast<uint32_t>(boxes.size()));
      boxes.push_back(cube);
    } else if (world::air_kind(word) == world::AirKind::kLeaf) {
      const uint64_t cells = tree.leaves[world::air_number(word)];
      FlightSpace::Leaf& leaf = leaves[world::air_number(word)];
      leaf.first_box = static_cast<uint32_t>(boxes.size());
      for (uint64_t rest = cells; rest != 0; rest &= rest - 1) {
        const auto bit = static_cast<uint32_t>(std::countr_zero(rest));
        const uint64_t all = flight_detail::octant(bit);
        const bool whole = (cells & all) == all;
        if (whole && bit != flight_detail::octant_low(bit)) continue;
        leaf.starts |= uint64_t{1} << bit;
        const auto b = static_cast<int32_t>(bit);
        boxes.push_back(
            {cube.x + (b & 3), cube.y + (b >> 2 & 3), cube.z + (b >> 4), whole ? 2 : 1});
      }
    } else if (world::air_kind(word) == world::AirKind::kInner) {
      const int32_t half = cube.side / 2;
      for (int32_t c = 0; c < 8; ++c) {
        self(
            self,
            {cube.x + (c & 1) * half, cube.y + (c >> 1 & 1) * half, cube.z + (c >> 2) * half, half},
            world::air_number(word) + static_cast<size_t>(c));
      }
    }
  };
  for (uint32_t r = 0; r < tree.roots; ++r) {
    number(number, {0, tree.base + static_cast<int32_t>(r) * tree.side, 0, tree.side}, r);
  }
}

void find_components(FlightSpace& space) {
  space.component.assign(space.boxes.size(), kNoBox);
  std::vector<uint32_t> queue;
  for (uint32_t first = 0; first < space.boxes.size(); ++first) {
    if (space.component[first] != kNoBox) continue;
    space.component[first] = first;
    queue.assign(1, first);
    while (!queue.empty()) {
      const uint32_t box = queue.back();
      queue.pop_back();
      space.for_neighbours(space.boxes[box], [&](uint32_t next) {
        if (space.component[next] != kNoBox) return;
        space.component[next] = first;
        queue.push_back(next);
      });
    }
  }
}

}  // namespace

Result<FlightSpace> build_flight_space(const world::AirData& air, const world::AirBody& body,
                                       int32_t largest, int32_t workers, Context& context) {
  FlightSpace space;
  space.shape = air.shape;
  space.width = air.width;
  space.depth = air.depth;
  space.zone_side = air.zone_side;
  space.zones_x = air.zones_x;
  space.zones_z = air.zones_z;
  const auto count = static_cast<size_t>(air.zones_x) * static_cast<size_t>(air.zones_z);
  space.zones.resize(count);
  space.leaves.resize(count);
  std::vector<std::vector<world::AirCube>> boxes(count);
  std::vector<uint8_t> failed(count, 0);
  parallel_for(count, workers, [&](size_t i) {
    if (context.cancel) return;
    const auto zx = static_cast<int32_t>(i) % air.zones_x,
               zz = static_cast<int32_t>(i) / air.zones_x;
    const auto legal = world::find_legal_air(air, body, zx, zz);
    if (!legal) {
      failed[i] = 1;
      return;
    }
    space.zones[i] = world::build_air_tree({.rows = &legal->rows,
                                            .x = legal->pad,
                                            .z = legal->pad,
                                            .side = air.zone_side,
                                            .width = air.zone_side,
                                            .depth = air.zone_side,
                                            .base = legal->base,
                                            .largest = largest,
                                            .free_beyond = false});
    number_boxes(space.zones[i], space.leaves[i], boxes[i]);
  });
  if (context.cancel) return Error{Errc::kCancelled, "path: cancelled"};
  for (size_t i = 0; i < count; ++i) {
    if (failed[i] != 0) return Error{Errc::kBadFile, "path: a zone's air cannot be used"};
    const auto zx = static_cast<int32_t>(i) % air.zones_x,
               zz = static_cast<int32_t>(i) / air.zones_x;
    const auto first = static_cast<uint32_t>(space.boxes.size());
    space.first_box.push_back(first);
    for (uint32_t& word : space.zones[i].nodes) {
      if (world::air_kind(word) == world::AirKind::kFree)
        word = world::air_word(world::AirKind::kFree, world::air_number(word) + first);
    }
    for (FlightSpace::Leaf& leaf : space.leaves[i]) leaf.first_box += first;
    for (world::AirCube box : boxes[i]) {
      box.x += zx * air.zone_side;
      box.z += zz * air.zone_side;
      space.boxes.push_back(box);
    }
    boxes[i] = {};
  }
  space.first_box.push_back(static_cast<uint32_t>(space.boxes.size()));
  find_components(space);
  return space;
}

}  // namespace throng::path
