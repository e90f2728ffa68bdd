// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "bake/columns.h"
#include "bake/world_folder.h"
#include "bake/zone_bake.h"
#include "world/air_data.h"

/// The free space of a world's zones, beside their ground.
namespace throng {

/// Heights of whole and half cells lie off the borders of layers, as in the plane (bake/grid.h).
AirShape air_shape(const BakePlan& plan, const Box3d& bounds);

/// Why a bake with this config can have no air, or nothing.
Result<void> check_air(const BakeConfig& config);

/// True if the config asks for air: a cell for it, or a class that flies.
bool wants_air(const BakeConfig& config);

/// Bakes air files one zone after the other.
class AirBaker {
 public:
  /// `folder` may be null: then the air stays in memory.
  AirBaker(const BakePlan& plan, const AirShape& shape, WorldFolder* folder);
  ~AirBaker();

  /// One zone, from the triangles that may touch it or its apron, in order. `input` tells what its
  /// ground was baked from. Fails with kIo, kLimit or kCancelled.
  Result<void> bake(int32_t zone_x, int32_t zone_z, std::span<const uint32_t> triangles,
                    uint64_t input, Context& context);

  /// What came of it, for a world whose zones are all baked.
  std::shared_ptr<AirData> finish(const WorldData& world);

 private:
  struct Worker;
  struct TileAir;
  void add(int32_t x, int32_t z, std::span<const uint8_t> bytes, std::unique_ptr<AirZone> zone);
  void rasterise(int32_t tile_x, int32_t tile_z, const TileRect& rect,
                 std::span<const uint32_t> items, Worker& worker, TileAir& tile) const;

  const BakePlan& plan_;
  AirShape shape_;
  WorldFolder* folder_;
  std::vector<std::unique_ptr<AirData::Slot>> slots_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<CellTriangle> triangles_;
};

}  // namespace throng
