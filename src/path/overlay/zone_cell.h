// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "path/ground/mesh.h"
#include "path/ground/two_hop.h"
#include "path/overlay/zone_paths.h"
#include "throng/base.h"

/// Overlay cells group zones ([PACS00]): paths inside one are looked up in labels of its entrances,
/// paths between them in labels of boundary nodes, a few of the entrances of their borders.
namespace throng::path {

inline constexpr int32_t kZonesPerCell = 8;  // along a side

struct OverlayCell {
  std::vector<uint32_t> entrances;       // of its zones, rising
  TwoHopLabels labels;                   // of places in `entrances`: paths inside the overlay cell
  std::vector<uint32_t> boundary_nodes;  // on its borders, rising
  std::vector<uint32_t> boundary_entrances;  // their places in `entrances`
  std::vector<CellPoint>
      boundary_node_at;  // where they are, side by side: a query reads all of them

  [[nodiscard]] uint32_t place_of_entrance(uint32_t entrance) const;
};

struct ZoneGraph {
  std::vector<Entrance> entrances;
  std::vector<ZonePaths> zones;        // per slot of the world
  std::vector<uint32_t> cell_of_zone;  // per slot
  std::vector<OverlayCell> zone_cells;
  // Of each boundary node the overlay cells that it lies between.
  std::vector<std::array<uint32_t, 2>> boundary_cells;
  TwoHopLabels boundary_labels;  // paths between boundary nodes over all overlay cells
  [[nodiscard]] uint64_t bytes() const;
  [[nodiscard]] uint64_t label_count() const;
};

/// Fails with kBadConfig (a zone has too many corners) or kCancelled. The same for any number of
/// workers.
Result<ZoneGraph> build_zone_graph(const world::WorldData& world, const PathMesh& mesh,
                                   int32_t workers, Context& context);

}  // namespace throng::path
