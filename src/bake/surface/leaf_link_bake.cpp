// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/leaf_link_bake.h"

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bake/surface/leaf_election.h"
#include "core/access.h"
#include "core/arrays/release.h"
#include "core/files/file_map.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "graph/leaf_links.h"
#include "world/air_data.h"
#include "world/region_data.h"

// Zone by zone: nodes of a zone may lie in the zones beside it, where their patches reach over the
// border, so a zone's links depend on the nodes of all zones that reach into it, and on the air of
// those near it. What leads back from its nodes also depends on the links of the zones into which
// they reach. A zone whose hash of all this is known keeps its file.
namespace throng::bake {
namespace {

constexpr uint64_t kLeafLinkBakeVersion = 1;
constexpr size_t kZonesAtOnce = 64;  // and the rest of their row

}  // namespace

class LeafLinkBake::Baker {
 public:
  Baker(std::shared_ptr<const graph::NodeData> nodes, const NodeConfig& config,
        const NodeFolder& folder)
      : nodes_data_(std::move(nodes)),
        nodes_(*nodes_data_),
        workers_(config.workers),
        old_(config.rebuild ? std::string() : data_of(nodes_.world)->path),
        folder_(folder),
        world_(*data_of(nodes_.world)),
        air_(*world_.air) {}

  Result<void> plan();
  [[nodiscard]] size_t zones() const { return zones_.size(); }
  [[nodiscard]] std::vector<Rows> parts(size_t most) const;
  Result<std::vector<format::LeafLinkEntry>> make(const Rows& rows, const Context& context);
  [[nodiscard]] graph::LeafLinkIndex index(std::vector<format::LeafLinkEntry> made) const {
    return {.air = graph::air_index_hash(air_, world_.manifest_hash),
            .nodes = graph::node_index_hash(nodes_),
            .zones = std::move(made)};
  }

 private:
  // One into which nodes reach, or that has nodes.
  struct Zone {
    int32_t x = 0, z = 0;
    std::vector<uint32_t> from;     // slots of nodes that may lie in it
    std::optional<ZoneRect> reach;  // of its own nodes
    uint64_t own = 0, input = 0;    // hashes: of what its links are made from, and of all
    ElectedLinks elected;
    std::unique_ptr<graph::LeafLinkZone> old;    // null: not reused
    std::string file;                            // from which it is reused
    std::optional<format::LeafLinkEntry> entry;  // none: it has no links, nor do its nodes
  };

  void find_inputs() {
    std::vector<uint64_t> shared{kLeafLinkBakeVersion,
                                 graph::kLeafLinkVersion,
                                 static_cast<uint64_t>(air_.shape.multiple),
                                 static_cast<uint64_t>(air_.shape.cell),
                                 static_cast<uint64_t>(air_.shape.origin_y),
                                 static_cast<uint64_t>(air_.shape.floor),
                                 static_cast<uint64_t>(air_.shape.ceiling),
                                 static_cast<uint64_t>(air_.shape.points),
                                 linked_classes(world_)};
    int32_t reach = 0;  // of the widest body [voxels]
    const auto add = [&](double value) { shared.push_back(std::bit_cast<uint64_t>(value)); };
    add(world_.summary.origin.x);
    add(world_.summary.origin.z);
    for (const AvatarClass& avatar : world_.summary.classes) {
      for (const double value : {avatar.radius, avatar.height, avatar.climb_slope}) add(value);
      reach = std::max(reach, world::air_body(avatar, air_.shape).reach + 3);
    }
    const uint64_t base = hash_span<uint64_t>(shared);
    for (Zone& zone : zones_) zone.own = hash_of(zone, base, reach);
    for (Zone& zone : zones_) {
      std::vector<uint64_t> words{zone.own};
      for_reached(zone, [&](const Zone& other) { words.push_back(other.own); });
      zone.input = hash_span<uint64_t>(words);
    }
  }

  // Of what a zone's own links are made from: the air near it, and the nodes and the ground of
  // zones that reach into it.
  [[nodiscard]] uint64_t hash_of(const Zone& zone, uint64_t base, int32_t reach) const {
    std::vector<uint64_t> words{base, static_cast<uint64_t>(zone.x), static_cast<uint64_t>(zone.z)};
    const int32_t side = air_.zone_side, more = (reach + side - 1) / side;
    const auto last = [&](int32_t at, int32_t zones) { return std::min(at + more, zones - 1); };
    for (int32_t z = std::max(zone.z - more, 0); z <= last(zone.z, air_.zones_z); ++z) {
      for (int32_t x = std::max(zone.x - more, 0); x <= last(zone.x, air_.zones_x); ++x) {
        const int32_t slot = air_.slot_of_zone[static_cast<size_t>(z * air_.zones_x + x)];
        words.push_back(slot < 0 ? 0 : air_.slots[static_cast<size_t>(slot)]->entry.hash());
      }
    }
    const auto own_part = [&](int32_t grid, int32_t at) {  // how much of all this is the world's
      return static_cast<uint64_t>(std::min(grid - at * side, (1 + more) * side));
    };
    words.push_back(own_part(air_.width, zone.x));
    words.push_back(own_part(air_.depth, zone.z));
    for (const uint32_t s : zone.from) {
      const format::NodeZoneEntry& entry = nodes_.slots[s]->entry;
      const int32_t ground = world::slot_at(world_, entry.x(), entry.z());
      words.push_back(static_cast<uint64_t>(entry.x()));
      words.push_back(static_cast<uint64_t>(entry.z()));
      words.push_back(entry.hash());
      words.push_back(ground < 0 ? 0 : world_.slots[static_cast<size_t>(ground)]->entry.hash());
    }
    return hash_span<uint64_t>(words);
  }

  // The other zones into which a zone's own nodes reach, by z, then x.
  template <class Visit>
  void for_reached(const Zone& zone, Visit visit) const {
    if (!zone.reach) return;
    for (int32_t z = zone.reach->z0; z <= zone.reach->z1; ++z) {
      for (int32_t x = zone.reach->x0; x <= zone.reach->x1; ++x) {
        if (x == zone.x && z == zone.z) continue;
        visit(zones_[place_[static_cast<size_t>(z * world_.zones_x + x)]]);
      }
    }
  }

  // Only sizes are left.
  void release(Zone& zone) const {
    throng::release(zone.elected.links);
    zone.old.reset();
    const int32_t slot =
        air_.slot_of_zone[static_cast<size_t>(zone.z) * static_cast<size_t>(air_.zones_x) +
                          static_cast<size_t>(zone.x)];
    if (slot < 0) return;
    const auto& air = air_.slots[static_cast<size_t>(slot)]->zone;
    if (air != nullptr) air->give_back();
  }

  Result<void> elect(size_t begin, size_t end, const Context& context) {
    std::vector<uint8_t> failed(end - begin, 0);
    parallel_for(failed.size(), workers_, [&](size_t i) {
      if (context.cancel) return;
      Zone& zone = zones_[begin + i];
      auto reused = old_.reuse_links(zone.x, zone.z, zone.input);
      if (reused.zone != nullptr) {
        zone.old = std::move(reused.zone);
        zone.file = std::move(reused.file);
        zone.entry = reused.entry;
        return;
      }
      auto elected = elect_links(nodes_, zone.from, zone.x, zone.z);
      failed[i] = elected ? 0 : 1;
      if (elected) zone.elected = *std::move(elected);
      // Those beside it read the files again.
      for (const uint32_t slot : zone.from) {
        if (const graph::NodeZone* nodes = nodes_.zone(slot)) nodes->give_back();
      }
    });
    if (context.cancel) return Error{Errc::kCancelled, "nodes: cancelled"};
    for (size_t i = 0; i < failed.size(); ++i) {
      if (failed[i] == 0) continue;
      const Zone& zone = zones_[begin + i];
      return Error{Errc::kBadFile, "nodes: the air or the nodes of zone " + std::to_string(zone.x) +
                                       ", " + std::to_string(zone.z) +
                                       " cannot be used; bake the world again"};
    }
    return {};
  }

  // Calls visit(node, link) for each link of a zone to a node of another.
  template <class Visit>
  void for_links_to(const Zone& zone, const Zone& other, Visit visit) const {
    if (zone.old != nullptr) {
      const graph::LeafLinkZone& links = *zone.old;
      for (uint32_t i = 0; i < links.links().size(); ++i) {
        const uint32_t node = links.links()[i].node();
        if ((node & graph::kFarNode) == 0) continue;
        const format::LinkedNode& far = links.far()[node & ~graph::kFarNode];
        if (far.x() == other.x && far.z() == other.z) visit(far.node(), i);
      }
      return;
    }
    const auto slot = static_cast<uint32_t>(nodes_.slot_at(other.x, other.z));
    for (uint32_t i = 0; i < zone.elected.links.size(); ++i) {
      const ElectedLink& link = zone.elected.links[i];
      if (link.slot == slot) visit(link.node, i);
    }
  }

  // What a zone's file holds.
  struct Content {
    std::vector<format::LeafLink> links;
    std::vector<uint32_t> by_node;
    std::vector<format::LinkedNode> far;
    std::vector<format::NodeLeaf> far_leaves;
  };

  [[nodiscard]] Content content_of(const Zone& zone) const {
    Content content;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> far_known;  // index into `far`
    const auto own = static_cast<uint32_t>(nodes_.slot_at(zone.x, zone.z));
    for (const ElectedLink& link : zone.elected.links) {
      uint32_t node = link.node;
      if (link.slot == own) {
        content.by_node.push_back(static_cast<uint32_t>(content.links.size()));
      } else {
        const auto [entry, is_new] = far_known.try_emplace(
            std::pair(link.slot, link.node), static_cast<uint32_t>(content.far.size()));
        if (is_new) {
          const format::NodeZoneEntry& there = nodes_.slots[link.slot]->entry;
          content.far.emplace_back(there.x(), there.z(), link.node);
        }
        node = graph::kFarNode | entry->second;
      }
      content.links.emplace_back(link.leaf.node, node, link.classes,
                                 static_cast<uint8_t>(link.leaf.piece), link.s, link.t);
    }
    std::stable_sort(content.by_node.begin(), content.by_node.end(), [&](uint32_t a, uint32_t b) {
      return content.links[a].node() < content.links[b].node();
    });
    for_reached(zone, [&](const Zone& other) {
      for_links_to(other, zone, [&](uint32_t node, uint32_t link) {
        content.far_leaves.emplace_back(node, other.x, other.z, link);
      });
    });
    // Zones come in order, and links of each.
    std::stable_sort(
        content.far_leaves.begin(), content.far_leaves.end(),
        [](const format::NodeLeaf& a, const format::NodeLeaf& b) { return a.node() < b.node(); });
    return content;
  }

  // Writes the file of a zone whose links were elected. No entry: no links, nor do its nodes have
  // any.
  Result<std::optional<format::LeafLinkEntry>> pack(const Zone& zone) const {
    using Entry = std::optional<format::LeafLinkEntry>;
    const Content content = content_of(zone);
    if (content.links.empty() && content.far_leaves.empty()) return Entry();
    std::vector<uint32_t> linked;  // nodes of the zone
    for (const uint32_t link : content.by_node) linked.push_back(content.links[link].node());
    for (const format::NodeLeaf& leaf : content.far_leaves) linked.push_back(leaf.node());
    std::sort(linked.begin(), linked.end());
    linked.erase(std::unique(linked.begin(), linked.end()), linked.end());

    flatbuffers::FlatBufferBuilder builder;
    const auto links = builder.CreateVectorOfStructs(content.links);
    const auto by_node = builder.CreateVector(content.by_node);
    const auto far = builder.CreateVectorOfStructs(content.far);
    const auto far_leaves = builder.CreateVectorOfStructs(content.far_leaves);
    builder.Finish(format::CreateLeafLinkZone(builder, graph::kLeafLinkVersion, zone.x, zone.z,
                                              zone.input, links, by_node, far, far_leaves),
                   "THGZ");
    auto file = graph::LeafLinkZone::from_bytes(builder.Release(),
                                                graph::leaf_link_file_name(zone.x, zone.z));
    if (!file) return file.error();
    if (auto ok = folder_.write(**file); !ok) return ok.error();
    const auto bytes = (*file)->bytes();
    return Entry(std::in_place, zone.x, zone.z, static_cast<uint32_t>(content.links.size()),
                 zone.elected.leaves, zone.elected.met, static_cast<uint32_t>(linked.size()),
                 bytes.size(), hash_bytes(bytes.data(), bytes.size()), zone.input);
  }

  // Of other zones each reads what was elected, or is in old files, and nothing that is made here.
  Result<void> write(size_t begin, size_t end) {
    std::vector<std::optional<Error>> failed(end - begin);
    parallel_for(failed.size(), workers_, [&](size_t i) {
      Zone& zone = zones_[begin + i];
      if (zone.old != nullptr) {
        if (auto ok = folder_.take_over(*zone.old, zone.file); !ok) failed[i] = ok.error();
        return;
      }
      auto entry = pack(zone);
      if (entry) {
        zone.entry = *entry;
      } else {
        failed[i] = entry.error();
      }
    });
    for (const auto& failure : failed) {
      if (failure) return *failure;
    }
    return {};
  }

  std::shared_ptr<const graph::NodeData> nodes_data_;
  const graph::NodeData& nodes_;
  int32_t workers_;
  OldNodes old_;
  const NodeFolder& folder_;
  const world::WorldData& world_;
  const world::AirData& air_;
  std::vector<Zone> zones_;      // by z, then x
  std::vector<uint32_t> place_;  // by zone of the world: index into zones_
  int32_t far_ = 0;              // rows over which nodes of a zone reach
};

Result<void> LeafLinkBake::Baker::plan() {
  std::vector<ZoneRect> reach(nodes_.slots.size());
  std::vector<uint8_t> failed(reach.size(), 0);
  parallel_for(reach.size(), workers_, [&](size_t s) {
    const graph::NodeZone* zone = nodes_.zone(s);
    failed[s] = zone == nullptr ? 1 : 0;
    if (zone == nullptr) return;
    reach[s] = zones_under(nodes_, *zone);
    zone->give_back();
  });
  for (size_t s = 0; s < failed.size(); ++s) {
    if (failed[s] != 0) return Error{Errc::kBadFile, nodes_.slots[s]->error};
  }
  std::map<std::pair<int32_t, int32_t>, Zone> zones;  // by z, then x
  for (size_t s = 0; s < reach.size(); ++s) {
    const format::NodeZoneEntry& entry = nodes_.slots[s]->entry;
    for (int32_t z = reach[s].z0; z <= reach[s].z1; ++z) {
      for (int32_t x = reach[s].x0; x <= reach[s].x1; ++x) {
        zones[{z, x}].from.push_back(static_cast<uint32_t>(s));
      }
    }
    zones[{entry.z(), entry.x()}].reach = reach[s];
  }
  place_.assign(static_cast<size_t>(world_.zones_x) * static_cast<size_t>(world_.zones_z),
                UINT32_MAX);
  for (auto& [at, zone] : zones) {
    zone.z = at.first;
    zone.x = at.second;
    place_[static_cast<size_t>(zone.z * world_.zones_x + zone.x)] =
        static_cast<uint32_t>(zones_.size());
    zones_.push_back(std::move(zone));
  }
  for (const Zone& zone : zones_) {
    if (zone.reach) far_ = std::max({far_, zone.reach->z1 - zone.z, zone.z - zone.reach->z0});
  }
  find_inputs();
  return {};
}

std::vector<LeafLinkBake::Rows> LeafLinkBake::Baker::parts(size_t most) const {
  std::vector<Rows> parts;
  const size_t of_part = zones_.size() / std::max<size_t>(most, 1) + 1;
  for (size_t begin = 0; begin < zones_.size();) {
    // Rows that are elected twice should be few.
    const int32_t least = zones_[begin].z + 4 * far_;
    size_t end = std::min(begin + of_part, zones_.size());
    while (end < zones_.size() && (zones_[end].z == zones_[end - 1].z || zones_[end].z < least)) {
      ++end;
    }
    parts.push_back({begin, end});
    begin = end;
  }
  return parts;
}

// What was elected in a row is let go once no row that is left reads it.
Result<std::vector<format::LeafLinkEntry>> LeafLinkBake::Baker::make(const Rows& rows,
                                                                     const Context& context) {
  std::vector<format::LeafLinkEntry> made;
  if (rows.begin == rows.end) return made;
  size_t written = rows.begin, elected = rows.begin;
  while (elected > 0 && zones_[elected - 1].z >= zones_[written].z - far_) --elected;
  size_t released = elected;
  while (written < rows.end) {
    size_t end = std::min<size_t>(written + kZonesAtOnce, rows.end);
    while (end < rows.end && zones_[end].z == zones_[end - 1].z) ++end;
    const int32_t last = zones_[end - 1].z;
    size_t read = std::max(elected, end);
    while (read < zones_.size() && zones_[read].z <= last + far_) ++read;
    if (auto ok = elect(elected, read, context); !ok) return ok.error();
    elected = read;
    if (auto ok = write(written, end); !ok) return ok.error();
    written = end;
    for (; released < written && zones_[released].z <= last - far_; ++released) {
      release(zones_[released]);
    }
  }
  for (; released < elected; ++released) release(zones_[released]);
  for (size_t z = rows.begin; z < rows.end; ++z) {
    if (zones_[z].entry) made.push_back(*zones_[z].entry);
  }
  return made;
}

LeafLinkBake::LeafLinkBake(std::unique_ptr<Baker> baker) : baker_(std::move(baker)) {}
LeafLinkBake::LeafLinkBake(LeafLinkBake&&) noexcept = default;
LeafLinkBake::~LeafLinkBake() = default;

Result<LeafLinkBake> LeafLinkBake::begin(const World& world, const NodeConfig& config,
                                         const NodeFolder& folder, const Context& context) {
  const std::string name = folder.part() + "/" + graph::kNodeIndexName;
  const auto map = FileMap::open(name);
  if (!map) return map.error();
  auto written = graph::read_node_index(map->bytes(), name);
  if (!written) return written.error();
  (*written)->world = world;
  (*written)->path = folder.part();
  LeafLinkBake bake(std::make_unique<Baker>(*std::move(written), config, folder));
  if (auto ok = bake.baker_->plan(); !ok) return ok.error();
  if (context.cancel) return Error{Errc::kCancelled, "nodes: cancelled"};
  return bake;
}

size_t LeafLinkBake::zones() const { return baker_->zones(); }

std::vector<LeafLinkBake::Rows> LeafLinkBake::parts(size_t most) const {
  return baker_->parts(most);
}

Result<std::vector<format::LeafLinkEntry>> LeafLinkBake::make(const Rows& rows,
                                                              const Context& context) {
  return baker_->make(rows, context);
}

graph::LeafLinkIndex LeafLinkBake::index(std::vector<format::LeafLinkEntry> made) const {
  return baker_->index(std::move(made));
}

Result<void> link_to_air(const World& world, const graph::NodeData& nodes, const NodeConfig& config,
                         NodeFolder& folder, Context& context) {
  if (data_of(world)->air == nullptr) return {};
  // The nodes as they are in the folder by now: zones that were written are no longer in memory.
  if (auto ok = folder.list(nodes); !ok) return ok;
  auto bake = LeafLinkBake::begin(world, config, folder, context);
  if (!bake) return bake.error();
  auto made = bake->make({0, bake->zones()}, context);
  if (!made) return made.error();
  folder.set_links(bake->index(*std::move(made)));
  return {};
}

}  // namespace throng::bake
