// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/node_file.h"

#include <algorithm>
#include <string>

#include "core/hash.h"

// Packs the nodes of one zone, their arcs and what these need into a NodeZone buffer. Linear, after
// sorting.
namespace throng::bake {

ZoneArcs arcs_of(std::span<const graph::NodeLink> links, const ZoneRange& zone) {
  const auto is_here = [&](uint32_t node) { return node >= zone.first && node < zone.last; };
  const auto goes_up = [&](const graph::NodeLink& l) {
    return (!l.one_way || !l.turned) && is_here(l.a);
  };
  const auto goes_down = [&](const graph::NodeLink& l) {
    return (!l.one_way || l.turned) && is_here(l.b);
  };
  ZoneArcs out;
  // Counted two entries ahead: dealing then leaves at n + 1 where the arcs of node n end.
  std::vector<size_t>& next = out.first;
  next.assign(size_t{zone.last - zone.first} + 2, 0);
  for (const graph::NodeLink& l : links) {
    if (goes_up(l)) ++next[l.a - zone.first + 2];
    if (goes_down(l)) ++next[l.b - zone.first + 2];
  }
  for (size_t n = 2; n < next.size(); ++n) next[n] += next[n - 1];
  out.arcs.resize(next.back());
  // Links are sorted, so a stable sort by `from` leaves each node's arcs sorted.
  for (const graph::NodeLink& l : links) {
    if (!goes_down(l)) continue;
    out.arcs[next[l.b - zone.first + 1]++] = {l.b, l.a, l.classes, l.kind, l.hole_link1, !l.turned};
  }
  for (const graph::NodeLink& l : links) {
    if (!goes_up(l)) continue;
    out.arcs[next[l.a - zone.first + 1]++] = {l.a, l.b, l.classes, l.kind, l.hole_link1, l.turned};
  }
  return out;
}

uint32_t ZoneContent::far_node(const format::FarNode& node) {
  const auto [entry, is_new] = far_known.try_emplace(std::tuple(node.x(), node.z(), node.node()),
                                                     static_cast<uint32_t>(far.size()));
  if (is_new) far.push_back(node);
  return graph::kFarNode | entry->second;
}

Result<std::unique_ptr<graph::NodeData::Slot>> node_slot(const ZoneContent& content) {
  const std::string name = graph::node_file_name(content.x, content.z);
  const uint64_t bytes =
      content.patches.size() * sizeof(format::NodePatch) +
      content.nodes.size() * sizeof(format::Node) + content.arcs.size() * sizeof(format::Arc) +
      content.hole_links.size() * sizeof(format::HoleLink) +
      content.far.size() * sizeof(format::FarNode) + content.doors.size() * sizeof(format::Door) +
      content.points.size() * sizeof(double) +
      content.partial.size() * sizeof(format::PartialCells);
  if (bytes > (uint64_t{1} << 31) - (1 << 20)) {
    return Error{Errc::kLimit, name + ": more than 2 GiB of nodes; use smaller zones"};
  }
  flatbuffers::FlatBufferBuilder builder(bytes + 4096);
  const auto patches = builder.CreateVectorOfStructs(content.patches);
  const auto nodes = builder.CreateVectorOfStructs(content.nodes);
  const auto arcs = builder.CreateVectorOfStructs(content.arcs);
  const auto hole_links = builder.CreateVectorOfStructs(content.hole_links);
  const auto far = builder.CreateVectorOfStructs(content.far);
  const auto doors = builder.CreateVectorOfStructs(content.doors);
  const auto points = builder.CreateVector(content.points);
  const auto partial = builder.CreateVectorOfStructs(content.partial);
  builder.Finish(format::CreateNodeZone(builder, graph::kNodeVersion, content.x, content.z, patches,
                                        nodes, arcs, far, hole_links, doors, points, partial),
                 "THNZ");
  auto zone = graph::NodeZone::from_bytes(builder.Release(), name);
  if (!zone) return zone.error();
  auto slot = std::make_unique<graph::NodeData::Slot>();
  const auto span = (*zone)->bytes();
  slot->entry =
      format::NodeZoneEntry(content.x, content.z, static_cast<uint32_t>(content.nodes.size()),
                            static_cast<uint32_t>(content.patches.size()), span.size(),
                            hash_bytes(span.data(), span.size()));
  slot->zone = std::move(*zone);
  return slot;
}

uint64_t world_hash(const world::WorldData& world) {
  if (!world.path.empty()) return world.manifest_hash;
  const std::vector<uint8_t> bytes = world::write_manifest(world);
  return hash_bytes(bytes.data(), bytes.size());
}

}  // namespace throng::bake
