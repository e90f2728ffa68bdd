// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"

/// Baked worlds: where each class can stand, queries of that ground, and what is connected.
namespace throng {

// ----
// The baked world: all queries and crowds read it. Opened by mapping its files.

namespace world {
struct WorldData;  // Internal: zones, tiles, planes.
struct GraphData;  // Internal: regions and links.
}  // namespace world

/// A place for feet: a position on one level. A zero-initialised place is nowhere.
struct Place {
  Vec3d position;       ///< Y at the feet. [m]
  uint32_t level1 = 0;  ///< Level tile of the world plus one; 0 is nowhere.
  [[nodiscard]] explicit operator bool() const { return level1 != 0; }
};

/// How a move ended.
enum class MoveEnd { kArrived, kBlocked };

/// The result of World::move.
struct MoveResult {
  Place place;  ///< Where the body is now: the end of the line, or the start.
  MoveEnd end = MoveEnd::kBlocked;
};

/// The content of one level tile in plain arrays, for tools and pictures.
struct LevelTileContent {
  /// Which tile: it covers cells [64 tile_x, 64 tile_x + 64) of the world's grid along x, and
  /// likewise along z.
  int32_t tile_x = 0, tile_z = 0;
  std::vector<int32_t> floor;    ///< 4096, row by row; kNoFloor where the level has none. [mm]
  std::vector<int32_t> ceiling;  ///< 4096; kOpenSky where nothing is above. [mm]
  std::vector<uint8_t> area;     ///< 4096 area kinds.
  /// Per class 4096 numbers. 0: the cell is illegal; k: it is legal, and so is every point within k
  /// - 1 cells of it. [0 to 8]
  std::vector<std::vector<uint8_t>> clearance;
};

inline constexpr int32_t kNoFloor = INT32_MIN;  ///< In LevelTileContent::floor.
inline constexpr int32_t kOpenSky = INT32_MAX;  ///< In LevelTileContent::ceiling.
inline constexpr int32_t kTileCells = 64;       ///< Cells along a side of a tile.

/// Description and sizes of a world.
struct WorldSummary {
  double cell = 0;        ///< [m]
  double resolution = 0;  ///< BakeConfig::resolution, for verify. [m]
  Vec3d origin;           ///< Of cell (0, 0) of the grid; heights count from y = origin.y.
  Box3d bounds;           ///< Of the source triangles.
  int32_t tiles_x = 0;
  int32_t tiles_z = 0;
  uint64_t zones = 0;
  uint64_t level_tiles = 0;
  uint64_t bytes = 0;  ///< Of all zones.
  uint64_t source_triangles = 0;
  std::vector<AvatarClass> classes;
  std::vector<double> walkable_area;  ///< Per class. [m^2]
  uint64_t hash = 0;                  ///< XXH3 of the manifest; 0 if it was not read from a folder.
};

/// Settings for World::open.
struct WorldConfig {
  /// Limit of the memory of zones. Beyond it, the least recently used zones are given back to the
  /// system, and read again at their next use. 0: no limit. Never changes a result. [bytes]
  uint64_t resident_bytes = 0;
  /// A district: only zones that touch this box, seen from above, are there, as if nothing else had
  /// been baked; so what is made of the world takes memory for these alone. Levels have numbers of
  /// their own, components are the part's, and there are no nodes. None: all. [m]
  std::optional<Box3d> part = {};
};

/// The part of a world that is in memory. Counted only with WorldConfig::resident_bytes.
struct WorldResidency {
  uint64_t zones = 0;
  uint64_t bytes = 0;  ///< Of their files.
};

/// A baked world. Cheap to copy (shared, immutable); safe to read from many threads.
class THRONG_API World {
 public:
  World() = default;
  /// False for a handle without a world, made by default.
  [[nodiscard]] explicit operator bool() const { return state_ != nullptr; }

  /// Opens a folder written by bake_world_to. Reads only the manifest: zones are mapped and checked
  /// when they are first used. Fails with kBadFile (by name), kIo or kBadConfig (no zone is in the
  /// part).
  [[nodiscard]] static Result<World> open(const std::string& path, const WorldConfig& config = {});
  /// Checks every zone against the manifest's checksums. Fails with kBadFile and the zone's name.
  [[nodiscard]] Result<void> check_ground() const;
  /// Fails with kBadFile and a zone's name if a zone that something came to since the world was
  /// opened could not be used. Reads no file. Not while others read. Time: linear in zones.
  [[nodiscard]] Result<void> check_touched() const;
  /// Checks the ground as check_ground does, and the files of the air, if there are any.
  [[nodiscard]] Result<void> check_all() const;

  [[nodiscard]] WorldSummary summary() const;
  [[nodiscard]] WorldResidency residency() const;
  /// Index of a class by name, or none.
  [[nodiscard]] std::optional<int32_t> find_class(const std::string& name) const;

  [[nodiscard]] uint32_t level_tile_count() const;
  [[nodiscard]] LevelTileContent level_tile(uint32_t index) const;
  /// The storey of each level tile: level tiles that continue each other across tile borders have
  /// the same number; 0 is the lowest. For pictures and reports.
  [[nodiscard]] std::vector<int32_t> storeys() const;

  /// The legal place of a class in the column of `position` whose feet are nearest to position.y,
  /// or nowhere if none is within `vertical_tolerance`. [m]
  [[nodiscard]] Place find_place(int32_t avatar_class, Vec3d position,
                                 double vertical_tolerance) const;
  /// The n-th of a reproducible stream of places, uniform over the class's walkable area. Nowhere
  /// only if the class has no place.
  [[nodiscard]] Place random_place(int32_t avatar_class, uint64_t seed, uint64_t n) const;
  /// Moves straight from `from` by (dx, dz) and tests every cell on the line by the conservative
  /// form of [ML06] algorithm 1. The feet follow the surface. [m]
  [[nodiscard]] MoveResult move(int32_t avatar_class, const Place& from, double dx,
                                double dz) const;
  /// Height of the feet on the surface of the place's level at (x, z) of its position. [m]
  [[nodiscard]] double feet(const Place& place) const;

 private:
  friend struct Access;
  explicit World(std::shared_ptr<const world::WorldData> state) : state_(std::move(state)) {}
  std::shared_ptr<const world::WorldData> state_;
};

// ----
// Queries of the ground around a body: the nearest place, the nearest wall, how far a straight
// line leads, sliding along walls, random places nearby. A wall is whatever stops the class: a
// solid, a step that is too high, a slope that is too steep, an edge. All lengths are measured
// from the body's axis, as seen from above: the solid of a wall is one radius farther away.

/// Why a class cannot stand in a cell, found from the floors and ceilings there and within the
/// class's radius: a baked world stores no walls. Queries of the ground know no edits; paths do.
enum class Blocker {
  kNone,
  kGap,     ///< There is no floor near the height of the feet on which any class could stand.
  kStep,    ///< A floor is more than the step height up or down; it is not the top of a wall.
  kLow,     ///< The ceiling is less than the class's height above the floor.
  kSteep,   ///< The floor is steeper than the class's limit.
  kNarrow,  ///< There is a solid: the passage is too narrow, or ends at a wall.
  /// The class can stand there in the baked world, but an obstacle of Edits is in its place.
  kObstacle,
  kClosed,  ///< The same, but the ground is of an area kind that costs infinity.
};

/// The result of a straight walk along the ground.
struct GroundRay {
  Place place;           ///< The last place on the line; a straight move leads there.
  bool arrived = false;  ///< The walk reached the end of the line.
  /// Normal of the wall that stopped it, towards the body. [unit]
  double normal_x = 0, normal_z = 0;
  Blocker blocked_by = Blocker::kNone;  ///< What stopped it.
};

/// The nearest wall around a place.
struct NearestWall {
  bool found = false;                 ///< False: none within the given distance.
  double distance = 0;                ///< [m]
  double x = 0, z = 0;                ///< Its nearest point. [m]
  double normal_x = 0, normal_z = 0;  ///< From there towards the body. [unit]
};

/// Queries of a world's ground for one class. Each has its own memory: give every thread one. No
/// allocation once it is warm. Results are the same on every machine.
class THRONG_API GroundQuery {
 public:
  /// Makes queries for a class; reads nothing yet. Fails with kBadConfig: no such class.
  [[nodiscard]] static Result<GroundQuery> create(const World& world, int32_t avatar_class);
  GroundQuery(GroundQuery&&) noexcept;
  GroundQuery& operator=(GroundQuery&&) noexcept;
  ~GroundQuery();

  /// Checks that all zones within `radius` of a position, seen from above, can be used; queries
  /// take a zone that cannot be used as empty. Reads these zones. Fails with kBadFile and the first
  /// one's name. [m, m]
  [[nodiscard]] Result<void> check_near(Vec3d position, double radius) const;
  /// The place of the class nearest to a position in three dimensions, or nowhere if none is within
  /// `radius`. Time: the tiles that the circle touches. [m, m]
  [[nodiscard]] Place nearest_place(Vec3d position, double radius);
  /// Walks straight from a place by (dx, dz), as far as the ground allows. [m, m]
  [[nodiscard]] GroundRay ray(const Place& from, double dx, double dz);
  /// Slides a body that is pushed by (dx, dz) along walls. The push is the diameter of a circle; of
  /// the places that are connected with `from` inside this circle, the result is the one nearest to
  /// the end of the push, at worst `from` itself. [m, m]
  [[nodiscard]] Place slide(const Place& from, double dx, double dz);
  /// The nearest wall within `max_distance` that a straight line from the place can meet. Time: the
  /// cells within that distance. [m]
  [[nodiscard]] NearestWall nearest_wall(const Place& from, double max_distance);
  /// The n-th of a reproducible stream of places, uniform over those connected with `centre` inside
  /// the circle around it. Nowhere only if `centre` is no place of the class. [m]
  [[nodiscard]] Place random_place_near(const Place& centre, double radius, uint64_t seed,
                                        uint64_t n);
  /// Area of the places that random_place_near draws from, to one cell. [m^2]
  [[nodiscard]] double area_near(const Place& centre, double radius);

 private:
  struct State;
  explicit GroundQuery(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// ----
// The accessibility graph of a baked world: which places are connected, for every class. Source:
// [PACS00], as docs/design/003-graph.md reads it for level tiles.

/// Settings for Graph::create.
struct GraphConfig {
  int32_t workers = 0;  ///< Threads, 0 for all cores; used if the graph is not on disk.
};

/// Sizes of a graph.
struct GraphSummary {
  uint64_t regions = 0;  ///< Connected parts of level tiles, shared by classes.
  uint64_t links = 0;    ///< Undirected links: pairs of regions between which some class can walk.
  uint64_t bytes = 0;    ///< Of regions and links, without files and data of classes.
  bool on_disk = false;  ///< Read from the files of the bake, not made in memory.
  double seconds = 0;    ///< To read or to make them.
};

/// A connected component: a class can walk from each of its places to every other.
struct Component {
  double area = 0;       ///< Of the cells where the class may stand. [m^2]
  uint64_t regions = 0;  ///< Regions that it consists of.
  Place place;           ///< One of its places, the middle of a cell.
};

/// The regions and links of a world. Cheap to copy (shared, immutable); safe to read from many
/// threads.
class THRONG_API Graph {
 public:
  Graph() = default;

  /// Opens the graph that a bake has left in the world's folder: reads only its index, and the
  /// regions of a zone when a query needs them. If there is none (a world in memory, or of an old
  /// bake), makes it: reads every zone once; the result is the same for any number of workers.
  /// Fails with kBadFile (the index or, where it is made, a zone cannot be used, by name) or
  /// kCancelled.
  [[nodiscard]] static Result<Graph> create(const World& world, const GraphConfig& config,
                                            Context& context);

  [[nodiscard]] GraphSummary summary() const;
  /// The components of a class, largest first; empty for a class that the world does not have.
  [[nodiscard]] std::span<const Component> components(int32_t avatar_class) const;
  /// Index in components() of the component that a place belongs to. -1 if the class cannot stand
  /// there, or its zone cannot be used: see check_at().
  [[nodiscard]] int32_t component_at(int32_t avatar_class, const Place& place) const;
  /// Checks that the files of the zone at a position can be used, ground and regions. Fails with
  /// kBadFile and the file.
  [[nodiscard]] Result<void> check_at(Vec3d position) const;
  /// Checks that all files of the graph in a world's folder can be used, also those of links, which
  /// no query here reads. Succeeds if there is no graph. Fails as check_at().
  [[nodiscard]] static Result<void> check_files(const World& world);

 private:
  explicit Graph(std::shared_ptr<const world::GraphData> data) : data_(std::move(data)) {}

  std::shared_ptr<const world::GraphData> data_;
};

}  // namespace throng
