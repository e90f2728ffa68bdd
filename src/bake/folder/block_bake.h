// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bake/folder/world_bake.h"
#include "bake/folder/world_folder.h"
#include "throng/bake.h"
#include "throng/base.h"
#include "throng/scene.h"
#include "world/zone_data.h"

/// Ground and air of a scene that is never in memory as a whole.
namespace throng::bake {

/// What was made of some zones, in the order of their block.
struct BlockMade {
  std::vector<format::ZoneInput> inputs;
  std::vector<ZoneFacts> facts;
  AirSlots air;  ///< Null: nothing but air. None at all if the bake has no air.
  uint64_t air_reused = 0;
  double seconds_air = 0;
};

/// Bakes such a scene block by block, for one process as for several: each bakes the blocks that it
/// is given, and one of them collects what all have made.
class BlockBake {
 public:
  /// Can it be baked at all? Fails with kBadConfig or kBadInput.
  static Result<void> check(const SceneRegions& scene, const BakeConfig& config);
  /// All is kept by reference; `old_world` may be null. Fails with kBadConfig or kLimit. [checked]
  static Result<BlockBake> begin(const SceneRegions& scene, const BakeConfig& config,
                                 const world::WorldData* old_world);

  /// Rectangles of zones whose triangles fit into BakeConfig::block_bytes, or of a single zone. Of
  /// a bake in part those are left out in which there is nothing to be baked or kept.
  [[nodiscard]] const std::vector<world::ZoneRect>& blocks() const { return blocks_; }
  /// Zones of the grid, with triangles or without.
  [[nodiscard]] uint64_t place_count() const { return grid_.place_count(); }
  /// Of settings, grid and scene: equal where two processes bake the same.
  [[nodiscard]] uint64_t input_hash() const;

  /// Bakes a block into the folder. Fails as SceneRegions::region, with kIo, kLimit or kCancelled.
  Result<BlockMade> bake(const world::ZoneRect& block, WorldFolder& folder, Context& context) const;
  /// What this or another process has made of a block; in any order.
  void enter(BlockMade made);
  /// Of a whole, once all blocks are entered. Fails with kBadConfig (there is nothing in the part)
  /// or kLimit.
  struct Whole {
    std::vector<format::ZoneInput> inputs;  ///< By z, then x.
    std::vector<ZoneFacts> facts;
  };
  Result<Whole> finish();
  /// A world of them, on any process.
  [[nodiscard]] Result<std::shared_ptr<world::WorldData>> world(const Whole& whole,
                                                                BakeReport& report) const;
  /// After finish(): gives that world the air of all blocks.
  void set_air(world::WorldData& world, BakeReport& report);

 private:
  BlockBake(const SceneRegions& scene, const BakeConfig& config, const world::WorldData* old_world,
            std::unique_ptr<Scene> none, WorldBake grid);
  void split(const world::ZoneRect& zones);
  [[nodiscard]] bool is_left_out(const world::ZoneRect& zones) const;
  void sort();

  const SceneRegions& scene_;
  const BakeConfig& config_;
  const world::WorldData* old_world_;
  std::unique_ptr<Scene> none_;  // the grid's
  WorldBake grid_;
  world::ZoneRect part_;
  std::vector<world::ZoneRect> blocks_;
  bool has_own_ = false;  // a zone of the part
  BlockMade made_;        // of all blocks so far
};

}  // namespace throng::bake
