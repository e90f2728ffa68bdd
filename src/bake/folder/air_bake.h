// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "bake/columns/columns.h"
#include "bake/folder/world_folder.h"
#include "bake/folder/zone_bake.h"
#include "world/air_data.h"

/// The free space of a world's zones, beside their ground.
namespace throng::world {
struct AirRows;
}

namespace throng::bake {

/// Heights of whole and half cells lie off the borders of layers, as in the plane
/// (bake/columns/grid.h).
world::AirShape air_shape(const BakePlan& plan, const Box3d& bounds);

/// Why a bake with this config can have no air, or nothing.
Result<void> check_air(const BakeConfig& config);

/// True if the config requires air: a cell for it, or a class that flies.
bool wants_air(const BakeConfig& config);

/// Bakes air files one zone after the other. Several may bake different zones of one plan at a
/// time.
class AirBaker {
 public:
  /// `folder` may be null: then the air stays in memory.
  AirBaker(const BakePlan& plan, const world::AirShape& shape, const WorldFolder* folder,
           int32_t workers);
  AirBaker(AirBaker&&) noexcept;
  AirBaker& operator=(AirBaker&&) = delete;
  ~AirBaker();

  /// One zone, from the triangles that may touch it or its apron, in order; null: there is nothing
  /// but air. `input` is the hash of what its ground was baked from. Fails with kIo, kLimit or
  /// kCancelled.
  Result<std::unique_ptr<world::AirData::Slot>> bake(int32_t zone_x, int32_t zone_z,
                                                     std::span<const uint32_t> triangles,
                                                     uint64_t input, Context& context);
  /// Zones whose files were reused, because their input has not changed.
  [[nodiscard]] uint64_t reused() const { return reused_; }

 private:
  struct Worker;
  struct TileAir;
  struct ZoneCells;
  std::vector<TileAir> rasterise_ring(int32_t zone_x, int32_t zone_z,
                                      std::span<const uint32_t> triangles, int32_t apron,
                                      const Context& context);
  void fill_solids(const ZoneCells& c, int32_t zone_x, int32_t zone_z, int32_t base, int32_t height,
                   const std::vector<TileAir>& air, world::AirRows& rows) const;
  void rasterise(int32_t tile_x, int32_t tile_z, const TileRect& rect,
                 std::span<const uint32_t> items, Worker& worker, TileAir& tile) const;

  const BakePlan& plan_;
  world::AirShape shape_;
  const WorldFolder* folder_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<CellTriangle> triangles_;
  uint64_t reused_ = 0;
};

/// What came of all zones of a world, in their order; null ones are passed over.
std::shared_ptr<world::AirData> gather_air(
    const world::AirShape& shape, const world::WorldData& world,
    std::vector<std::unique_ptr<world::AirData::Slot>> zones);

}  // namespace throng::bake
