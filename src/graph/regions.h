// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "graph/flood.h"
#include "throng/context.h"
#include "throng/result.h"
#include "world/zone_data.h"

/// Regions: connected parts of level tiles, shared by classes, and the links between them. See
/// docs/design/003-graph.md.
namespace throng {

/// A connected part of a level tile. Its classes may see parts of different shape; `key` lies in
/// all of them.
struct Region {
  uint32_t level = 0;    // of the world
  uint32_t classes = 0;  // bit per class
  uint32_t key = 0;      // cell of the tile: z * 64 + x
};

/// A step leads from `a` to `b` and back, for these classes. [a < b]
struct RegionLink {
  uint32_t a = 0, b = 0;
  uint32_t classes = 0;
};

struct RegionGraph {
  std::vector<uint32_t> first;    // per level of the world: its first region; one more at the end
  std::vector<Region> regions;    // in order of levels
  std::vector<RegionLink> links;  // sorted by (a, b)
  // Of the regions, for each of their classes in order of bits.
  std::vector<uint32_t> first_part;  // regions + 1 offsets into the next
  std::vector<uint32_t> cells;       // legal cells

  /// Index into `cells` of a class of a region that has it.
  [[nodiscard]] uint32_t part(uint32_t region, int32_t avatar_class) const;
  /// Bytes of regions and links, what is kept of the graph.
  [[nodiscard]] uint64_t bytes() const;
};

inline constexpr uint32_t kNoRegion = UINT32_MAX;

/// Regions and links of a whole world whose zones can all be used. Fails with kCancelled. The same
/// for any number of workers.
Result<RegionGraph> build_regions(const WorldData& world, int32_t workers, Context& context);

/// Region of a legal cell of a level for a class; kNoRegion if the cell is not legal. Floods the
/// level's part where the class has several regions there.
uint32_t region_at(const WorldData& world, const RegionGraph& graph, uint32_t level,
                   int32_t avatar_class, int32_t x, int32_t z);

}  // namespace throng
