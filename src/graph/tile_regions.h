// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "graph/flood.h"
#include "world/ground.h"

/// Regions of single tiles: connected parts of level tiles, shared by classes, and the links
/// between them. See docs/design/003-graph.md.
namespace throng {

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

enum TileSide : size_t { kWest, kEast, kNorth, kSouth };

/// One class's part of a region.
struct RegionPart {
  uint32_t region = 0;  // of the tile
  uint32_t cells = 0;
  uint64_t side[4] = {};  // legal cells along the four borders of the tile
};

struct TileParts {
  // Of a level for one class: parts [first, last).
  struct ClassParts {
    uint32_t first = 0, last = 0;
  };

  uint32_t first_level = 0, levels = 0;  // of the world
  std::vector<Region> regions;           // in order of levels
  std::vector<uint32_t> first;           // per level: its first region; one more at the end
  std::vector<ClassParts> classes;       // per level and class
  std::vector<RegionPart> parts;
  std::vector<RegionLink> links;  // one class a link, a < b
};

/// Finds regions and links tile by tile. The world must outlive it, and the zones of the tiles
/// asked for must be usable.
class TileRegions {
 public:
  explicit TileRegions(const WorldData& world);

  /// The regions of a tile, without links.
  [[nodiscard]] TileParts parts(int32_t tile_x, int32_t tile_z) const;
  /// And the links between its levels.
  [[nodiscard]] TileParts linked_parts(int32_t tile_x, int32_t tile_z) const;
  /// Links over the border between a tile and its neighbour to the east or south, one class a link:
  /// from a region of `from` to a region of `to`.
  [[nodiscard]] std::vector<RegionLink> border(int32_t tile_x, int32_t tile_z, TileSide side,
                                               const TileParts& from, const TileParts& to) const;

 private:
  using Shapes = std::vector<std::vector<CellRows>>;  // of the parts, per level and class

  TileParts find(int32_t tile_x, int32_t tile_z, Shapes& shapes) const;
  void find_level(const WorldData::TileLevels& levels, uint32_t l, TileParts& tile,
                  Shapes& shapes) const;
  [[nodiscard]] GroundLevel ground(uint32_t level, size_t c) const;
  [[nodiscard]] bool steps_both_ways(size_t c, const GroundLevel& a, const GroundLevel& b,
                                     int32_t x, int32_t z, int32_t nx, int32_t nz) const;
  [[nodiscard]] bool crosses(int32_t tile_x, int32_t tile_z, TileSide side, size_t c,
                             const GroundLevel& a, const GroundLevel& b, uint64_t both) const;
  void link_seam(int32_t tile_x, int32_t tile_z, size_t c, uint32_t a, uint32_t b,
                 const Shapes& shapes, TileParts& tile) const;
  [[nodiscard]] bool touch(int32_t tile_x, int32_t tile_z, size_t c, const GroundLevel& a,
                           const GroundLevel& b, const CellRows& p, const CellRows& q) const;

  const WorldData& world_;
  std::vector<int32_t> steps_;  // per class [mm]
};

/// Makes one link for all classes of a pair, and sorts by a, then b.
void merge_links(std::vector<RegionLink>& links);

}  // namespace throng
