// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <vector>

#include "core/access.h"
#include "throng/path.h"
#include "world/air_data.h"
#include "world/zone_data.h"

// Counts and lists the nodes of a world's air, octree by octree. Linear in the air files.
namespace throng {

Result<AirSummary> air_summary(const World& world) {
  if (data_of(world) != nullptr) {
    if (auto ok = world::check_air_index(*data_of(world)); !ok) return ok.error();
  }
  if (data_of(world) == nullptr || data_of(world)->air == nullptr) {
    return Error{Errc::kNotFound, "the world was baked without air"};
  }
  const world::AirData& air = *data_of(world)->air;
  const world::AirShape& shape = air.shape;
  const auto height = [&](int32_t layer) {
    return (static_cast<double>(layer) * shape.cell + shape.origin_y) * 1e-3;
  };
  AirSummary summary{.cell = shape.cell * 1e-3,
                     .floor = height(shape.floor),
                     .ceiling = height(shape.ceiling),
                     .zones = air.slots.size(),
                     .bytes = air.bytes};
  for (const auto& slot : air.slots) {
    const world::AirData::ZoneAir zone = air.zone(slot->entry.x(), slot->entry.z());
    if (!zone.usable) return Error{Errc::kBadFile, slot->error};
    zone.tree->for_each([&](const world::AirCube& cube, uint32_t word) {
      if (world::air_kind(word) == world::AirKind::kFull) return;
      ++summary.nodes;
      if (world::air_kind(word) == world::AirKind::kLeaf) {
        summary.free_cells +=
            static_cast<uint64_t>(std::popcount(zone.tree->leaves[world::air_number(word)]));
        return;
      }
      const int32_t layers =
          std::min(cube.y + cube.side, shape.ceiling) - std::max(cube.y, shape.floor);
      summary.free_cells += static_cast<uint64_t>(std::max(layers, 0)) *
                            static_cast<uint64_t>(cube.side) * static_cast<uint64_t>(cube.side);
    });
  }
  return summary;
}

Result<std::vector<Box3d>> air_boxes(const World& world, const Box3d& area) {
  if (const auto sound = air_summary(world); !sound) return sound.error();
  const world::AirData& air = *data_of(world)->air;
  const world::AirShape& shape = air.shape;
  const Vec3d origin = data_of(world)->summary.origin;
  const auto metres = [&](int32_t x, int32_t y, int32_t z) {
    const double cell = shape.cell * 1e-3;
    return Vec3d{origin.x + x * cell, (static_cast<double>(y) * shape.cell + shape.origin_y) * 1e-3,
                 origin.z + z * cell};
  };
  std::vector<Box3d> boxes;
  for (const auto& slot : air.slots) {
    const int32_t x0 = slot->entry.x() * air.zone_side, z0 = slot->entry.z() * air.zone_side;
    const world::AirData::ZoneAir zone = air.zone(slot->entry.x(), slot->entry.z());
    zone.tree->for_each([&](const world::AirCube& cube, uint32_t word) {
      const int32_t low = std::max(cube.y, shape.floor);
      const int32_t high = std::min(cube.y + cube.side, shape.ceiling);
      if (world::air_kind(word) != world::AirKind::kFree || low >= high) return;
      const int32_t x = x0 + cube.x, z = z0 + cube.z;
      const Box3d box{metres(x, low, z), metres(x + cube.side, high, z + cube.side)};
      const Vec3d middle = (box.min + box.max) * 0.5;
      const bool is_wanted =
          area.max.x <= area.min.x || (middle.x >= area.min.x && middle.x <= area.max.x &&
                                       middle.z >= area.min.z && middle.z <= area.max.z);
      if (is_wanted) boxes.push_back(box);
    });
  }
  return boxes;
}

}  // namespace throng
