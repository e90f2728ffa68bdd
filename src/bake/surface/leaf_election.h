// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "graph/node_data.h"
#include "world/air_leaf.h"
#include "world/zone_data.h"

/// Which nodes the leaves of a zone's air are linked to.
namespace throng::bake {

/// A link that was elected.
struct ElectedLink {
  world::AirLeaf leaf;
  uint32_t slot = 0, node = 0;  ///< The node's zone among all nodes, and its number there.
  uint16_t classes = 0;
  uint8_t s = 0, t = 0;  ///< Cell of the node's patch.
};

/// The links of a zone, by leaf; of a leaf, the best node first.
struct ElectedLinks {
  std::vector<ElectedLink> links;
  uint32_t leaves = 0;  ///< That links lead from.
  uint32_t met = 0;     ///< That a take-off from some node leads into.
};

/// Classes that links are for: those that fly; all, if none does.
[[nodiscard]] uint16_t linked_classes(const world::WorldData& world);

/// Zones of the world, last included.
struct ZoneRect {
  int32_t x0 = 0, z0 = 0, x1 = -1, z1 = -1;
};
/// Zones over which nodes of a zone may lie: its own, and those that control points of its Bezier
/// patches reach.
[[nodiscard]] ZoneRect zones_under(const graph::NodeData& nodes, const graph::NodeZone& zone);

/// Elects the links of a zone among the nodes of some slots, all that may lie in it. None: air or
/// nodes of a zone cannot be used.
[[nodiscard]] std::optional<ElectedLinks> elect_links(const graph::NodeData& nodes,
                                                      std::span<const uint32_t> slots,
                                                      int32_t zone_x, int32_t zone_z);

}  // namespace throng::bake
