// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "throng/avatar_class.h"
#include "throng/base.h"
#include "throng/math.h"
#include "throng/result.h"

/// The baked world: all queries and crowds read it. Opened by mapping its files.
namespace throng {

struct WorldData;  // Internal: zones, tiles, planes.

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
  int32_t tile_x = 0;            ///< World tile coordinates: the tile covers cells
  int32_t tile_z = 0;            ///< [64 tile_x, 64 tile_x + 64) of the world's grid.
  std::vector<int32_t> floor;    ///< 4096, row by row; kNoFloor where the level has none. [mm]
  std::vector<int32_t> ceiling;  ///< 4096; kOpenSky where nothing is above. [mm]
  std::vector<uint8_t> area;     ///< 4096 area kinds.
  /// Per class 4096: 0 is illegal, k: every point within k - 1 cells of this cell is legal, too.
  /// [0 to 8]
  std::vector<std::vector<uint8_t>> clearance;
};

inline constexpr int32_t kNoFloor = INT32_MIN;  ///< In LevelTileContent::floor.
inline constexpr int32_t kOpenSky = INT32_MAX;  ///< In LevelTileContent::ceiling.
inline constexpr int32_t kTileCells = 64;       ///< Cells along a side of a tile.

/// Description and sizes of a world.
struct WorldSummary {
  double cell = 0;        ///< [m]
  double resolution = 0;  ///< [m]
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
  /// Limit of the memory of zones: beyond it, the zones that have not been used for longest are
  /// given back to the system, and read again when they are used. 0: no limit. Never changes a
  /// result.
  uint64_t resident_bytes = 0;
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
  explicit World(std::shared_ptr<const WorldData> data) : data_(std::move(data)) {}

  /// Opens a folder written by bake_world_to. Reads only the manifest: zones are mapped and checked
  /// when they are first used. Fails with kBadFile (by name) or kIo.
  [[nodiscard]] static Result<World> open(const std::string& path, const WorldConfig& config = {});
  /// Checks every zone against the manifest's checksums. Fails with kBadFile and the zone's name.
  [[nodiscard]] Result<void> check_ground() const;
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

  [[nodiscard]] const std::shared_ptr<const WorldData>& data() const { return data_; }

 private:
  std::shared_ptr<const WorldData> data_;
};

}  // namespace throng
