// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/node_file.h"

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/hash.h"

namespace throng {
namespace fs = std::filesystem;

std::vector<ArcRecord> arcs_of(std::span<const NodeLink> links, uint32_t nodes) {
  const auto goes_up = [](const NodeLink& l) { return !l.one_way || !l.turned; };
  const auto goes_down = [](const NodeLink& l) { return !l.one_way || l.turned; };
  std::vector<size_t> next(size_t{nodes} + 1, 0);
  for (const NodeLink& l : links) {
    if (goes_up(l)) ++next[l.a + 1];
    if (goes_down(l)) ++next[l.b + 1];
  }
  for (size_t n = 0; n < nodes; ++n) next[n + 1] += next[n];
  std::vector<ArcRecord> arcs(next[nodes]);
  // Links are sorted, so a stable deal to `from` leaves each node's arcs sorted.
  for (const NodeLink& l : links) {
    if (goes_down(l)) arcs[next[l.b]++] = {l.b, l.a, l.classes, l.kind, l.leap1, !l.turned};
  }
  for (const NodeLink& l : links) {
    if (goes_up(l)) arcs[next[l.a]++] = {l.a, l.b, l.classes, l.kind, l.leap1, l.turned};
  }
  return arcs;
}

uint32_t ZoneContent::far_node(const format::FarNode& node) {
  const auto [entry, is_new] = far_known.try_emplace(std::tuple(node.x(), node.z(), node.node()),
                                                     static_cast<uint32_t>(far.size()));
  if (is_new) far.push_back(node);
  return kFarNode | entry->second;
}

Result<std::unique_ptr<NodeData::Slot>> node_slot(const ZoneContent& content) {
  const std::string name = node_file_name(content.x, content.z);
  const uint64_t bytes =
      content.patches.size() * sizeof(format::NodePatch) +
      content.nodes.size() * sizeof(format::Node) + content.arcs.size() * sizeof(format::Arc) +
      content.leaps.size() * sizeof(format::Leap) + content.far.size() * sizeof(format::FarNode) +
      content.doors.size() * sizeof(format::Door) + content.points.size() * sizeof(double);
  if (bytes > (uint64_t{1} << 31) - (1 << 20)) {
    return Error{Errc::kLimit, name + ": more than 2 GiB of nodes; use smaller zones"};
  }
  flatbuffers::FlatBufferBuilder builder(bytes + 4096);
  const auto patches = builder.CreateVectorOfStructs(content.patches);
  const auto nodes = builder.CreateVectorOfStructs(content.nodes);
  const auto arcs = builder.CreateVectorOfStructs(content.arcs);
  const auto leaps = builder.CreateVectorOfStructs(content.leaps);
  const auto far = builder.CreateVectorOfStructs(content.far);
  const auto doors = builder.CreateVectorOfStructs(content.doors);
  const auto points = builder.CreateVector(content.points);
  builder.Finish(format::CreateNodeZone(builder, kNodeVersion, content.x, content.z, patches, nodes,
                                        arcs, far, leaps, doors, points),
                 "THNZ");
  auto zone = NodeZone::from_bytes(builder.Release(), name);
  if (!zone) return zone.error();
  auto slot = std::make_unique<NodeData::Slot>();
  const auto span = (*zone)->bytes();
  slot->entry =
      format::NodeZoneEntry(content.x, content.z, static_cast<uint32_t>(content.nodes.size()),
                            static_cast<uint32_t>(content.patches.size()), span.size(),
                            hash_bytes(span.data(), span.size()));
  slot->zone = std::move(*zone);
  return slot;
}

uint64_t world_hash(const WorldData& world) {
  if (!world.path.empty()) {
    if (const auto map = FileMap::open(world.path + "/manifest.thm")) {
      return hash_bytes(map->bytes().data(), map->bytes().size());
    }
  }
  const std::vector<uint8_t> bytes = write_manifest(world);
  return hash_bytes(bytes.data(), bytes.size());
}

Result<void> Nodes::write(const std::string& world_path) const {
  THRONG_ASSERT(data_);
  const std::string manifest = world_path + "/manifest.thm";
  const auto map = FileMap::open(manifest);
  if (!map) return map.error();
  if (hash_bytes(map->bytes().data(), map->bytes().size()) != data_->world_hash) {
    return Error{Errc::kBadFile, world_path + ": holds another world than these nodes' own"};
  }
  // Beside, then renamed: there are whole nodes or none.
  const fs::path target = fs::path(world_path) / kNodeFolder, part = target.string() + ".part";
  std::error_code error;
  fs::remove_all(part, error);
  fs::create_directories(part, error);
  if (error) return Error{Errc::kIo, part.string() + ": cannot be created: " + error.message()};
  for (size_t s = 0; s < data_->slots.size(); ++s) {
    const NodeZone* zone = data_->zone(s);
    if (zone == nullptr) return Error{Errc::kBadFile, data_->slots[s]->error};
    const auto file = part / node_file_name(zone->x(), zone->z());
    if (auto ok = write_file(file.string(), zone->bytes()); !ok) return ok.error();
  }
  const auto index = part / kNodeIndexName;
  if (auto ok = write_file(index.string(), write_node_index(*data_)); !ok) return ok.error();
  fs::remove_all(target, error);
  fs::rename(part, target, error);
  if (error) return Error{Errc::kIo, target.string() + ": cannot be written: " + error.message()};
  return {};
}

}  // namespace throng
