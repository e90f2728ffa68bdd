// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "throng/avatar_class.h"
#include "throng/base.h"
#include "throng/cells.h"
#include "throng/context.h"
#include "throng/result.h"
#include "throng/scene.h"
#include "throng/world.h"

/// From triangles to a world that one can walk in: columns of spans, level tiles, clearance, zones.
namespace throng {

struct NodeConfig;

/// What a bake into a folder does with zones that were baked from the same input before.
enum class OldZones : uint8_t { kKeep, kBakeAgain };

struct BakeConfig {
  double cell = 0.1;        ///< Side of a cell. [m, 0.02 to 5]
  double resolution = 0.1;  ///< Headroom that may be lost. [m, 0.001 to 1]
  /// Side of an air cell: 1, 2, 4, 8 or 16 cells. 0: no air is kept, or, if a class flies, that of
  /// these which is nearest above 0.4 m. [m]
  double air = 0;
  /// Looks at cells beside walls by parts of a cell, so that next to none of the room is lost,
  /// which takes 1.1 to 1.9 times as long. Classes of less than 1.5 cells in radius know whole
  /// cells only.
  bool fine = true;
  /// Only what faces up as it is wound (counter-clockwise, seen from above) is floor, as for other
  /// makers of navigation meshes; the rest is still in the way. False: windings say nothing, so the
  /// upper side of a ceiling without thickness is floor, too. Nodes on patches do not ask for it.
  bool one_sided = false;
  double zone = 160;  ///< Side of a zone, rounded to whole tiles of 64 cells. [m, > 0]
  std::vector<AvatarClass> classes = default_classes();
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
  OldZones old_zones = OldZones::kKeep;  ///< Of the world or the killed bake that is in the way.
  /// Into a folder: the old world's nodes are carried over, so that Nodes::make need not make again
  /// what has not changed. They are of the new world only once it has.
  bool carry_nodes = false;
  /// Into a folder: nodes that will be made of the world. Its jumps are looked at before the world
  /// takes the old one's place, and BakeReport::hold keeps other bakes out. Null: none.
  const NodeConfig* nodes = nullptr;
};

/// What a bake did. Seconds are summed over threads where several work.
struct BakeReport {
  // Zones count in which anybody can stand, as in WorldSummary; zones == zones_baked +
  // zones_reused.
  uint64_t zones = 0;
  uint64_t zones_baked = 0;
  uint64_t zones_reused = 0;  ///< Their input has not changed.
  uint64_t zones_empty = 0;   ///< Besides: triangles come near, but nobody can stand.
  /// Zones whose links over their eastern and southern border were made again: those baked and
  /// those to the west and north of them. Into a folder only, as graph_bytes.
  uint64_t zones_relinked = 0;
  uint64_t tiles = 0;  ///< Tiles with at least one level.
  uint64_t level_tiles = 0;
  uint64_t constant_level_tiles = 0;  ///< Whose floor is stored as a constant or a plane.
  uint64_t spans = 0;                 ///< Solid spans after merging, of the zones baked.
  uint64_t bytes = 0;                 ///< Of all zone files.
  uint64_t air_zones = 0;             ///< Zones with an air file: those with matter.
  uint64_t air_zones_reused = 0;      ///< Of these, whose input has not changed.
  uint64_t air_bytes = 0;             ///< Of all air files.
  uint64_t graph_bytes = 0;           ///< Of all files of regions and links.
  std::vector<double> walkable_area;  ///< Per class. [m^2]
  double seconds_columns = 0;
  double seconds_levels = 0;
  double seconds_clearance = 0;
  double seconds_air = 0;
  double seconds_graph = 0;
  double seconds_write = 0;
  double seconds_total = 0;  ///< Wall clock.
  /// With BakeConfig::nodes: while it lives the folder takes nodes, but no other bake.
  std::shared_ptr<const void> hold;
};

/// Bakes into memory. Fails with kBadConfig, kBadInput (no triangles), kLimit, kCancelled.
[[nodiscard]] THRONG_API Result<World> bake_world(const Scene& scene, const BakeConfig& config,
                                                  Context& context, BakeReport* report = nullptr);

/// Bakes into a folder: files of each zone, a manifest, and the graph's index, written beside
/// `path` and renamed at the end, so that a failed or cancelled bake leaves what was there before.
/// Where a world is there, only the zones whose input has changed are baked, on its grid if the
/// scene still begins on it; where a bake was killed, its zones are taken over. Memory: the scene
/// and a few zones, whatever the size of the world. Also fails with kIo, and kBadInput (jumps);
/// with kIo at once if another bake, of this process or another, is writing the folder.
[[nodiscard]] THRONG_API Result<BakeReport> bake_world_to(const std::string& path,
                                                          const Scene& scene,
                                                          const BakeConfig& config,
                                                          Context& context);

/// Takes flat cells as they are: a world in memory with one class, "point", that is legal on every
/// passable cell; its feet are at height 0. Fails with kBadConfig (cell, workers) or kBadInput.
[[nodiscard]] THRONG_API Result<World> bake_flat_cells(const FlatCells& cells, double cell,
                                                       int32_t workers = 0);

/// Takes voxels as they are: a world in memory without ground, whose one class, "point", flies
/// wherever no voxel is; voxel (0, 0, 0) lies at the origin. Fails with kBadConfig (cell, a whole
/// number of millimetres) or kBadInput.
[[nodiscard]] THRONG_API Result<World> bake_voxel_cells(const VoxelCells& cells, double cell);

}  // namespace throng
