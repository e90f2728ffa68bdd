// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "graph/flood.h"
#include "graph/lane_flood.h"
#include "world/ground.h"

/// Regions of single tiles: connected parts of level tiles, shared by classes, and the links
/// between them. See docs/design/003-graph.md.
namespace throng::graph {

/// A connected part of a level tile. Its classes may see parts of different shape; `key` lies in
/// all of them.
struct Region {
  uint32_t level = 0;    // of the world
  uint32_t classes = 0;  // bit per class
  uint32_t key = 0;      // cell of the tile: z * 64 + x
};

/// A step leads from `a` to `b` and back, for these classes.
struct RegionLink {
  uint32_t a = 0, b = 0;
  uint32_t classes = 0;
};

/// One class's part of a region.
struct RegionPart {
  uint32_t region = 0;  // of the tile
  uint32_t cells = 0;
  std::array<uint64_t, 4> side{};  // legal cells along the four borders of the tile
};

struct TileParts {
  // Of a level for one class: parts [first, last).
  struct ClassParts {
    uint32_t first = 0, last = 0;
  };

  uint32_t first_level = 0, levels = 0;    // of the world
  std::vector<Region> regions;             // in order of levels
  std::vector<world::FloorRange> heights;  // per level
  std::vector<uint32_t> first;             // per level: its first region; one more at the end
  std::vector<ClassParts> classes;         // per level and class
  std::vector<RegionPart> parts;
  std::vector<RegionLink> links;  // a < b, maybe several for a pair
};

/// Scratch memory of finding, kept from tile to tile: one for each worker.
struct TileScratch {
  // What is known of steps from cells of one level to those beside them of another, for any class.
  struct Rises {
    std::array<world::CellRows, 4> known,
        low;  // per direction; low: no higher than any class's step
  };
  // The levels of a tile along one of its borders.
  struct Border {
    std::vector<world::LevelView> views;           // per level
    std::vector<uint64_t> known;                   // per level: bit per cell whose height is known
    std::vector<std::array<int32_t, 64>> heights;  // [mm]
    std::vector<uint64_t> legal;                   // per level and class
    std::vector<uint64_t> any_class;               // per level
  };

  PartFinder finder;
  LaneScratch lanes;
  PartList shapes;  // of the tile's parts; sets that are alike have the same
  std::vector<TileParts::ClassParts> shapes_of;  // per level and class: which of them
  std::vector<size_t> together;                  // sets of a level that are left to find in lanes
  std::vector<world::GroundLevel> grounds;       // per level and class
  std::vector<uint32_t> alike;  // the same: classes before it that may stand on the same cells
  std::vector<world::CellRows> legal;      // per level and class
  std::vector<world::CellRows> any_class;  // per level: legal for any class
  PartList common;  // per region of a level: cells that all its classes' parts share
  Rises rises;
  Border from, to;
};

/// Finds regions and links tile by tile. The world must outlive it, and the zones of the tiles
/// given must be usable.
class TileRegions {
 public:
  explicit TileRegions(const world::WorldData& world);

  /// The regions of a tile, without links.
  [[nodiscard]] TileParts parts(int32_t tile_x, int32_t tile_z, TileScratch& scratch) const;
  /// And the links between its levels.
  [[nodiscard]] TileParts linked_parts(int32_t tile_x, int32_t tile_z, TileScratch& scratch) const;
  /// Links over the border between a tile and its neighbour to the east or south, maybe several
  /// for a pair: from a region of `from` to a region of `to`.
  [[nodiscard]] std::vector<RegionLink> border(int32_t tile_x, int32_t tile_z, TileSide side,
                                               const TileParts& from, const TileParts& to,
                                               TileScratch& scratch) const;

 private:
  // A class, and two levels of a tile.
  struct Seam {
    int32_t tile_x, tile_z;
    size_t c;
    uint32_t a, b;
  };

  void find_shapes(uint32_t l, TileScratch& scratch) const;
  void find_level(uint32_t l, TileParts& tile, TileScratch& scratch) const;
  [[nodiscard]] bool steps_in_both_directions(size_t c, const world::GroundLevel& a,
                                              const world::GroundLevel& b, int32_t x, int32_t z,
                                              int32_t nx, int32_t nz) const;
  void link_seam(const Seam& seam, TileParts& tile, TileScratch& scratch) const;

  const world::WorldData& world_;
  std::vector<int32_t> steps_;                  // per class [mm]
  int32_t longest_ = 0, shortest_ = INT32_MAX;  // of them
};

/// Makes one link for all classes of a pair, and sorts by a, then b.
void merge_links(std::vector<RegionLink>& links);

}  // namespace throng::graph
