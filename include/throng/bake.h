// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/scene.h"
#include "throng/surface.h"
#include "throng/world.h"

/// Bakes: from a scene to a world, by one process or by several ranks, and the walkable surface of
/// the result.
namespace throng {

// ----
// The bake: from triangles to a world that avatars walk in. Columns of spans, level tiles,
// clearance, zones.

struct NodeConfig;

/// What a bake does with zones in its folder that were baked from the same input.
enum class OldZones : uint8_t {
  kKeep,       ///< Reuses them.
  kBakeAgain,  ///< Bakes them again.
};

class FolderLock;  // Internal: keeps other bakes out of a folder.

/// Settings for bake_world and bake_world_to.
struct BakeConfig {
  double cell = 0.1;  ///< Side of a cell. [m, 0.02 to 5]
  /// Headroom that verify allows the bake to lose: it counts ground as lost where a body that is
  /// this much taller could stand. The world keeps the number, and its ground is the same for any:
  /// heights are whole millimetres. Another number bakes all zones again. [m, 0.001 to 1]
  double resolution = 0.1;
  /// Side of a voxel of the air: 1, 2, 4, 8 or 16 cells. 0: the world has no air, or, if a class
  /// flies, voxels of the smallest such side from 0.4 m on. [m]
  double air = 0;
  /// Tests cells beside walls in parts, so that hardly any legal area is lost; takes 1.1 to 1.9
  /// times as long. No effect on classes with a radius below 1.5 cells.
  bool fine = true;
  /// Only triangles that face up (counter-clockwise seen from above) are floor, as in Recast; the
  /// others still block. False: windings are ignored, so the upper side of a ceiling without
  /// thickness is floor, too. Nodes on patches ignore this setting.
  bool one_sided = false;
  /// A district: only zones that touch this box, seen from above, are baked. Others are in the
  /// world if that in the folder has them, from the same input; a world is completed district by
  /// district, with the bytes of one bake. The scene is the whole one. None: all. [m]
  std::optional<Box3d> part = {};
  /// Of a scene that is read district by district: about how much memory the triangles of a block
  /// of zones may take. Less is slower. Never changes the result. [bytes, > 0]
  uint64_t block_bytes = uint64_t{256} << 20;
  double zone = 160;  ///< Side of a zone, rounded to whole tiles (64 cells). [m, > 0]
  std::vector<AvatarClass> classes = default_classes();
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
  /// Into a folder that holds zones already, of a world or of an interrupted bake.
  OldZones old_zones = OldZones::kKeep;
  /// Into a folder: keeps the nodes of the old world for Nodes::create, which reuses those of zones
  /// that have not changed. If the world has changed, they cannot be opened before that call.
  bool carry_nodes = false;
  /// Into a folder: settings of nodes that will be made afterwards. Their off-mesh links are
  /// checked before the new world replaces the old one, and BakeReport::hold keeps other bakes out.
  /// Null: no nodes.
  const NodeConfig* nodes = nullptr;
};

/// What a bake did. Seconds of a stage are summed over its threads.
struct BakeReport {
  // Only zones in which some class can stand are counted, as in WorldSummary; zones == zones_baked
  // + zones_reused.
  uint64_t zones = 0;
  uint64_t zones_baked = 0;
  uint64_t zones_reused = 0;  ///< Reused, because their input has not changed.
  uint64_t zones_empty = 0;   ///< Not in `zones`: triangles are near, but no class can stand there.
  /// Zones whose links over the eastern and southern border were rebuilt: the baked ones and their
  /// western and northern neighbours. Into a folder only, as is graph_bytes.
  uint64_t zones_relinked = 0;
  uint64_t tiles = 0;  ///< Tiles with at least one level.
  uint64_t level_tiles = 0;
  uint64_t constant_level_tiles = 0;  ///< Whose floor is stored as a constant or a plane.
  uint64_t spans = 0;                 ///< Solid spans after merging, of the zones baked.
  uint64_t bytes = 0;                 ///< Of all zone files.
  uint64_t air_zones = 0;             ///< Zones with an air file: those with solids.
  uint64_t air_zones_reused = 0;      ///< Of these, reused.
  uint64_t air_bytes = 0;             ///< Of all air files.
  uint64_t graph_bytes = 0;           ///< Of all files of regions and links.
  std::vector<double> walkable_area;  ///< Per class. [m^2]
  double seconds_columns = 0;         ///< Triangles to solid spans.
  double seconds_levels = 0;          ///< Places, layers, legality.
  double seconds_clearance = 0;       ///< Distances to walls.
  double seconds_air = 0;
  double seconds_graph = 0;  ///< Regions and links.
  double seconds_write = 0;  ///< Files of zones.
  double seconds_total = 0;  ///< Wall clock.
  /// With BakeConfig::nodes: as long as it exists, the folder accepts nodes but no other bake.
  std::shared_ptr<const FolderLock> hold;
};

/// Bakes a world into memory. Fails with kBadConfig, kBadInput (no triangles), kLimit, kCancelled.
[[nodiscard]] THRONG_API Result<World> bake_world(const Scene& scene, const BakeConfig& config,
                                                  Context& context, BakeReport* report = nullptr);

/// Bakes a world into a folder: files of each zone, a manifest and the graph's index. These are
/// written beside `path` and renamed at the end, so a failed or cancelled bake leaves the old
/// content. If the folder holds a world, only zones whose input has changed are baked, on its grid
/// if the scene still begins on it; the zones of an interrupted bake are reused. Memory: the scene
/// and a few zones, whatever the size of the world. Fails as bake_world, with kIo, with kBadInput
/// (off-mesh links), and at once with kIo if another bake, of any process, is writing the folder.
[[nodiscard]] THRONG_API Result<BakeReport> bake_world_to(const std::string& path,
                                                          const Scene& scene,
                                                          const BakeConfig& config,
                                                          Context& context);

/// The same of a scene that is never in memory as a whole: zones are baked in blocks, nearly
/// square, whose triangles take config.block_bytes at most, or are those of one zone. The
/// same bytes as from the whole scene into an empty folder. The grid begins where the scene does,
/// whatever the old world's. Memory: a block, a few zones, and about 300 bytes for each zone of
/// the world. Off-mesh links are checked as there. Fails as bake_world_to does and as
/// SceneRegions::region.
[[nodiscard]] THRONG_API Result<BakeReport> bake_world_to(const std::string& path,
                                                          const SceneRegions& scene,
                                                          const BakeConfig& config,
                                                          Context& context);

/// Joins worlds whose zones were baked of parts of one scene (BakeConfig::part), with the same
/// settings: zones that several of them have are the same. Makes the graph over the borders again;
/// nodes are not taken over. A world of all parts has the bytes of one bake. Reads the zones'
/// files, links or copies them, and leaves the worlds as they are; `path` may be one of them. Fails
/// with kBadFile, with kBadInput where they do not fit together, with kIo or kCancelled; then
/// `path` keeps its old content.
[[nodiscard]] THRONG_API Result<BakeReport> join_worlds(const std::vector<std::string>& worlds,
                                                        const std::string& path, int32_t workers,
                                                        Context& context);

/// Makes a world in memory from flat cells, with one class, "point", that is legal on every
/// passable cell; feet are at height 0. Fails with kBadConfig (cell, workers) or kBadInput.
[[nodiscard]] THRONG_API Result<World> bake_flat_cells(const FlatCells& cells, double cell,
                                                       int32_t workers = 0);

/// Makes a world in memory from voxels, without ground. Its one class, "point", flies wherever no
/// voxel is filled; voxel (0, 0, 0) lies at the origin. Fails with kBadConfig (`cell` must be a
/// whole number of millimetres) or kBadInput.
[[nodiscard]] THRONG_API Result<World> bake_voxel_cells(const VoxelCells& cells, double cell);

// ----
// Bakes by several processes, on one machine or on several that share a file system. `mpirun -n K`
// starts them; each calls the same functions in the same order.

/// The rank of this process among those that were started together.
struct RankInfo {
  int32_t rank = 0;  ///< [0, size)
  int32_t size = 1;
};

/// Reads the rank from the environment that mpirun (Open MPI, MPICH) sets. Does not initialise MPI,
/// and works without it.
[[nodiscard]] THRONG_API RankInfo rank_info();

/// Exchanges success or failure between all ranks. Succeeds if `mine` is a success on every rank.
/// Otherwise it fails on rank 0 with the error and the number of the first rank that failed, and
/// with kCancelled on the others. Fails with kBadConfig if there are several ranks and the library
/// was built without MPI.
[[nodiscard]] THRONG_API Result<void> agree_over_ranks(const Result<void>& mine);

/// The same for ranks that arrive at very different times: they wait without using a core, and only
/// until their context is cancelled.
[[nodiscard]] THRONG_API Result<void> meet_over_ranks(const Result<void>& mine, Context& context);

/// bake_world_to by all ranks: each idle rank gets the next zone. The world's bytes do not depend
/// on the number of ranks. Every rank has read the same scene; `path` is on a file system that all
/// ranks see. config.workers is per rank; 0 shares the cores of a machine among its ranks. The
/// report is complete on rank 0 and empty elsewhere.
///
/// Fails on rank 0 as bake_world_to does, and with the error and name of another rank that failed;
/// on the others with kCancelled. If a rank dies, mpirun ends the others: their contexts are
/// cancelled if a signal handler does so, and the baked zones stay in PATH.part, which the next
/// bake reuses.
[[nodiscard]] THRONG_API Result<BakeReport> bake_over_ranks(const std::string& path,
                                                            const Scene& scene,
                                                            const BakeConfig& config,
                                                            Context& context);

/// The same of a scene that no rank holds as a whole: each idle rank gets the next block of zones.
/// Every rank has its own SceneRegions of the same files; config.block_bytes is per rank. Fails as
/// above and as SceneRegions::region.
[[nodiscard]] THRONG_API Result<BakeReport> bake_over_ranks(const std::string& path,
                                                            const SceneRegions& scene,
                                                            const BakeConfig& config,
                                                            Context& context);

/// Nodes::create_in_folder by all ranks, of a world that each has opened from the same folder. Each
/// idle rank gets the next batch of zones; a batch takes config.working_bytes at most, and is small
/// enough that each rank gets some. The bytes do not depend on the number of ranks. The summary is
/// complete on rank 0 and empty elsewhere. Fails as bake_over_ranks does; what was made stays in
/// the folder's nodes.part, which the next call reuses.
[[nodiscard]] THRONG_API Result<NodeSummary> nodes_over_ranks(const World& world,
                                                              const Scene& scene,
                                                              const NodeConfig& config,
                                                              Context& context);
/// The same of a scene that no rank holds as a whole. Fails as SceneRegions::region, too.
[[nodiscard]] THRONG_API Result<NodeSummary> nodes_over_ranks(const World& world,
                                                              const SceneRegions& scene,
                                                              const NodeConfig& config,
                                                              Context& context);

// ----
// The walkable surface of a class, as triangles or as polygons seen from above, for other
// programs.

/// Makes triangles of the floor under all legal cells of a class, where its feet are: flat cells
/// and planes are merged into rectangles, within 2 mm at the middle of each cell. One part per
/// storey, material "floor". Borders of the triangles are borders of cells: where the middle of a
/// body may be. Reads every zone. Fails with kBadConfig (no such class), kBadFile (a zone cannot be
/// used), kCancelled.
[[nodiscard]] THRONG_API Result<Scene> walkable_surface(const World& world, int32_t avatar_class,
                                                        Context& context);

/// A piece of the walkable surface seen from above: cells connected by their sides.
struct WalkablePiece {
  Polygon polygon;  ///< Counter-clockwise, its holes clockwise, in (x, z). Rings may touch.
  double area = 0;  ///< [m^2]
};

/// Makes polygons of the legal cells of a class whose floors lie from `lowest` to `highest`, all
/// levels projected onto the plane, largest piece first. Reads every zone. Fails as
/// walkable_surface does, and with kLimit if the world has more than 2^32 cells.
[[nodiscard]] THRONG_API Result<std::vector<WalkablePiece>> walkable_pieces(
    const World& world, int32_t avatar_class, double lowest, double highest, Context& context);

/// A polygon as well-known text: POLYGON((x z, ...), (hole)), to the millimetre.
[[nodiscard]] THRONG_API std::string to_wkt(const Polygon& polygon);

}  // namespace throng
