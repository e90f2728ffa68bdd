// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "path/mesh.h"
#include "path/two_hop.h"
#include "path/zone_ways.h"
#include "throng/context.h"
#include "throng/result.h"

/// Territories group zones ([PACS00]): ways inside one are looked up in labels of its gates, ways
/// between them in labels of posts, a few of the gates of their borders.
namespace throng {

inline constexpr int32_t kTerritoryZones = 8;  // along a side

struct Territory {
  std::vector<uint32_t> gates;       // of its zones, rising
  TwoHopLabels labels;               // of places in `gates`: ways inside the territory
  std::vector<uint32_t> posts;       // on its borders, rising
  std::vector<uint32_t> post_gates;  // their places in `gates`
  std::vector<CellPoint> post_at;    // where they are, side by side: a query looks at all of them

  [[nodiscard]] uint32_t place_of_gate(uint32_t gate) const;
};

struct ZoneGraph {
  std::vector<Gate> gates;
  std::vector<ZoneWays> zones;              // per slot of the world
  std::vector<uint32_t> territory_of_zone;  // per slot
  std::vector<Territory> territories;
  // Of each post the territories that it lies between.
  std::vector<std::array<uint32_t, 2>> post_territories;
  TwoHopLabels post_labels;  // ways between posts over all territories
  [[nodiscard]] uint64_t bytes() const;
  [[nodiscard]] uint64_t label_count() const;
};

/// Fails with kBadConfig (a zone has too many corners) or kCancelled. The same for any number of
/// workers.
Result<ZoneGraph> build_zone_graph(const WorldData& world, const PathMesh& mesh, int32_t workers,
                                   Context& context);

}  // namespace throng
