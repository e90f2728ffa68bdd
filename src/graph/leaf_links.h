// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "graph/leaf_link_zone.h"
#include "graph/node_data.h"
#include "throng/base.h"
#include "world/air_leaf.h"
#include "world/zone_data.h"

/// Links between leaves of the air and the nodes under them, of a world with both.
namespace throng::graph {

/// What AirLinks points to: zones mapped from files, which lie in the folder of the nodes.
struct LeafLinkData {
  struct Slot : world::ZoneSlot<LeafLinkZone> {
    format::LeafLinkEntry entry;
  };

  std::shared_ptr<const NodeData> nodes;
  LeafLinkIndex index;
  std::vector<std::unique_ptr<Slot>> slots;  ///< Zones of the index.

  /// The zone of a slot, opened and checked at its first touch; null if it cannot be used.
  [[nodiscard]] const LeafLinkZone* zone(size_t slot) const;
  /// Slot of a zone, or slots.size().
  [[nodiscard]] size_t slot_at(int32_t x, int32_t z) const;
  [[nodiscard]] const LeafLinkZone* zone_at(int32_t x, int32_t z) const;
  /// Checks every zone. Fails with kBadFile and the zone's name.
  [[nodiscard]] Result<void> check_all() const;
};

/// XXH3 of the index of a world's air, and of an index of nodes.
[[nodiscard]] uint64_t air_index_hash(const world::AirData& air, uint64_t world_hash);
[[nodiscard]] uint64_t node_index_hash(const NodeData& nodes);

/// A voxel of the world.
struct Voxel {
  int32_t x = 0, y = 0, z = 0;
};
/// The voxel that holds a point; none beside the world's air.
[[nodiscard]] std::optional<Voxel> voxel_of(const world::WorldData& world, Vec3d at);

/// The links from the leaf that holds a voxel, and the zone that they are in; null: it has none.
struct LinksOfLeaf {
  const LeafLinkZone* zone = nullptr;
  std::span<const format::LeafLink> links;
};
[[nodiscard]] LinksOfLeaf links_of_leaf(const LeafLinkData& links, const Voxel& voxel);

/// Where a link of a zone leads: a node of all, and parameters of its patch.
struct LinkEnd {
  uint32_t node = 0;
  double s = 0, t = 0;
  Vec3d feet = {};  ///< [m]
};
/// None if the zone of the node cannot be used.
[[nodiscard]] std::optional<LinkEnd> end_of(const NodeData& nodes, const LeafLinkZone& zone,
                                            const format::LeafLink& link);

}  // namespace throng::graph
