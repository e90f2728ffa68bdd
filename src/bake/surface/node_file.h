// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "graph/node_data.h"
#include "graph/node_links.h"
#include "world/zone_data.h"

/// Packs nodes into the files of zones.
namespace throng::bake {

/// One direction of a link.
struct ArcRecord {
  uint32_t from = 0, to = 0;
  uint16_t classes = 0;
  LinkKind kind = LinkKind::kWalk;
  uint32_t hole_link1 = 0;
  bool backward = false;  ///< Against the hole link.
};

/// Nodes [first, last) of all belong to a zone.
struct ZoneRange {
  int32_t x = 0, z = 0;
  uint32_t first = 0, last = 0;
};

/// The arcs out of a zone's nodes, by `from`, then `to`, then kind.
struct ZoneArcs {
  std::vector<ArcRecord> arcs;
  std::vector<size_t> first;  ///< by node of the zone, and two more: the end, twice

  [[nodiscard]] std::span<const ArcRecord> of(uint32_t local) const {
    return std::span(arcs).subspan(first[local], first[local + 1] - first[local]);
  }
};

/// Of links that are sorted as merge_node_links() does, among them all with an end in the zone.
[[nodiscard]] ZoneArcs arcs_of(std::span<const graph::NodeLink> links, const ZoneRange& zone);

struct ZoneContent {
  int32_t x = 0, z = 0;
  std::vector<format::NodePatch> patches;
  std::vector<format::Node> nodes;
  std::vector<format::Arc> arcs;
  std::vector<format::HoleLink> hole_links;
  std::vector<format::FarNode> far;
  std::vector<format::Door> doors;
  std::vector<double> points;
  std::vector<format::PartialCells> partial;

  /// What an arc's `to` says for a node of another zone.
  uint32_t far_node(const format::FarNode& node);
  std::map<std::tuple<int32_t, int32_t, uint32_t>, uint32_t> far_known;  ///< Index into `far`.
};

/// The zone's bytes, read back and checked. Fails with kLimit.
[[nodiscard]] Result<std::unique_ptr<graph::NodeData::Slot>> node_slot(const ZoneContent& content);

/// XXH3 of the manifest of a world: of its file, or of what would be written.
[[nodiscard]] uint64_t world_hash(const world::WorldData& world);

}  // namespace throng::bake
