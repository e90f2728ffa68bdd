// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/leaf_links.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "core/access.h"
#include "core/hash.h"
#include "graph/node_surface.h"
#include "throng/surface.h"
#include "world/air_data.h"
#include "world/sealed_file.h"

// Look-ups in links between the air and the ground, and their public queries. Source: [PACS00]
// 1.2.3.7.
namespace throng {
namespace graph {
namespace {

constexpr double kTallestClass = 30;  // AvatarClass::height, at most [m]

// Do the nodes and the leaves that a zone's links name exist?
bool belongs(const LeafLinkData& links, const LeafLinkZone& zone) {
  const NodeData& nodes = *links.nodes;
  const world::AirData& air = *data_of(nodes.world)->air;
  if (zone.x() < 0 || zone.z() < 0 || zone.x() >= air.zones_x || zone.z() >= air.zones_z) {
    return false;
  }
  const auto nodes_in = [&](int32_t x, int32_t z) -> uint32_t {
    const size_t slot = nodes.slot_at(x, z);
    return slot < nodes.slots.size() ? nodes.slots[slot]->entry.nodes() : 0;
  };
  const auto links_in = [&](int32_t x, int32_t z) -> uint32_t {
    const size_t slot = links.slot_at(x, z);
    return slot < links.slots.size() ? links.slots[slot]->entry.links() : 0;
  };
  const uint32_t own = nodes_in(zone.x(), zone.z());
  const world::AirData::ZoneAir octree = air.zone(zone.x(), zone.z());
  if (!octree.usable) return false;
  for (const format::LeafLink& link : zone.links()) {
    if ((link.node() & kFarNode) == 0 && link.node() >= own) return false;
    if (!world::has_leaf(octree.tree, leaf_of(link))) return false;
  }
  for (const format::LinkedNode& far : zone.far()) {
    if (far.node() >= nodes_in(far.x(), far.z())) return false;
  }
  for (const format::NodeLeaf& leaf : zone.far_leaves()) {
    if (leaf.node() >= own || leaf.link() >= links_in(leaf.x(), leaf.z())) return false;
  }
  return true;
}

// The leaf that holds a voxel of the world; none if it is not free, or its zone cannot be used.
std::optional<world::AirLeafPlace> leaf_at(const world::AirData& air, const Voxel& voxel) {
  const int32_t zone_x = voxel.x / air.zone_side, zone_z = voxel.z / air.zone_side;
  const world::AirData::ZoneAir zone = air.zone(zone_x, zone_z);
  if (!zone.usable) return std::nullopt;
  return world::air_leaf_at(zone.tree, voxel.x - zone_x * air.zone_side, voxel.y,
                            voxel.z - zone_z * air.zone_side);
}

// Where a leaf lies: over the link's feet, at most a body's height up. Below the lowest layer there
// is no air.
Box3d box_of(const NodeData& nodes, const world::AirLeaf& leaf, Vec3d feet) {
  const world::WorldData& world = *data_of(nodes.world);
  const world::AirData& air = *world.air;
  const double cell = air.shape.cell * 1e-3, up = air.shape.origin_y * 1e-3;
  const auto corner = [&](double x, double y, double z) {
    return Vec3d{world.summary.origin.x + x * cell, up + y * cell,
                 world.summary.origin.z + z * cell};
  };
  const auto from =
      voxel_of(world, {feet.x, std::max(feet.y, corner(0, air.shape.floor + 0.5, 0).y), feet.z});
  if (!from) return {};
  const int32_t x0 = from->x / air.zone_side * air.zone_side;
  const int32_t z0 = from->z / air.zone_side * air.zone_side;
  const auto most = static_cast<int32_t>(std::ceil(kTallestClass / cell)) + 1;
  const int32_t last = std::min(from->y + most, air.shape.ceiling - 1);
  for (int32_t y = from->y; y <= last; ++y) {
    const auto found = leaf_at(air, {from->x, y, from->z});
    if (!found || found->leaf != leaf) continue;
    if (leaf.node == world::kSkyLeaf) {
      return {corner(x0, y, z0), corner(x0 + air.zone_side, air.shape.ceiling, z0 + air.zone_side)};
    }
    const world::AirCube& cube = found->cube;
    return {corner(x0 + cube.x, cube.y, z0 + cube.z),
            corner(x0 + cube.x + cube.side, cube.y + cube.side, z0 + cube.z + cube.side)};
  }
  return {};
}

uint32_t node_of(const NodeData& nodes, const LeafLinkZone& zone, const format::LeafLink& link) {
  if ((link.node() & kFarNode) == 0) {
    return nodes.slots[nodes.slot_at(zone.x(), zone.z())]->first_node + link.node();
  }
  const format::LinkedNode& far = zone.far()[link.node() & ~kFarNode];
  return nodes.slots[nodes.slot_at(far.x(), far.z())]->first_node + far.node();
}

AirLink link_of(const NodeData& nodes, const LeafLinkZone& zone, const format::LeafLink& link) {
  AirLink out{
      .node = node_of(nodes, zone, link),
      .classes = link.classes(),
      .leaf_id = {
          .zone_x = zone.x(), .zone_z = zone.z(), .node = link.leaf(), .piece = link.piece()}};
  const auto end = end_of(nodes, zone, link);
  if (!end) return out;
  out.s = end->s;
  out.t = end->t;
  out.feet = end->feet;
  out.leaf = box_of(nodes, leaf_of(link), end->feet);
  return out;
}

}  // namespace

const LeafLinkZone* LeafLinkData::zone(size_t slot) const {
  const Slot& entry = *slots[slot];
  std::call_once(entry.once, [&] {
    const format::LeafLinkEntry& listed = entry.entry;
    entry.open({.name = nodes->path + "/" + leaf_link_file_name(listed.x(), listed.z()),
                .bytes = listed.bytes(),
                .hash = listed.hash(),
                .whose = "the index's",
                .remedy = kLeafLinkRemedy},
               [&](const LeafLinkZone& found) {
                 return found.x() == listed.x() && found.z() == listed.z() &&
                        found.links().size() == listed.links() && belongs(*this, found);
               });
  });
  return entry.zone.get();
}

size_t LeafLinkData::slot_at(int32_t x, int32_t z) const {
  const auto found = std::lower_bound(slots.begin(), slots.end(), std::pair{z, x},
                                      [](const auto& slot, std::pair<int32_t, int32_t> at) {
                                        return std::pair{slot->entry.z(), slot->entry.x()} < at;
                                      });
  const bool hit = found != slots.end() && (*found)->entry.x() == x && (*found)->entry.z() == z;
  return hit ? static_cast<size_t>(found - slots.begin()) : slots.size();
}

const LeafLinkZone* LeafLinkData::zone_at(int32_t x, int32_t z) const {
  const size_t slot = slot_at(x, z);
  return slot < slots.size() ? zone(slot) : nullptr;
}

Result<void> LeafLinkData::check_all() const {
  for (size_t s = 0; s < slots.size(); ++s) {
    if (zone(s) == nullptr) return Error{Errc::kBadFile, slots[s]->error};
  }
  return {};
}

uint64_t air_index_hash(const world::AirData& air, uint64_t world_hash) {
  const std::vector<uint8_t> bytes = world::write_air_manifest(air, world_hash);
  return hash_bytes(bytes.data(), bytes.size());
}

uint64_t node_index_hash(const NodeData& nodes) {
  const std::vector<uint8_t> bytes = write_node_index(nodes);
  return hash_bytes(bytes.data(), bytes.size());
}

std::optional<Voxel> voxel_of(const world::WorldData& world, Vec3d at) {
  if (world.air == nullptr || !std::isfinite(at.x + at.y + at.z)) return std::nullopt;
  const world::AirData& air = *world.air;
  const double cell = air.shape.cell * 1e-3;
  const double x = std::floor((at.x - world.summary.origin.x) / cell);
  const double y = std::floor((at.y * 1000 - air.shape.origin_y) / air.shape.cell);
  const double z = std::floor((at.z - world.summary.origin.z) / cell);
  if (x < 0 || z < 0 || x >= air.width || z >= air.depth || y < air.shape.floor ||
      y >= air.shape.ceiling) {
    return std::nullopt;
  }
  return Voxel{static_cast<int32_t>(x), static_cast<int32_t>(y), static_cast<int32_t>(z)};
}

LinksOfLeaf links_of_leaf(const LeafLinkData& links, const Voxel& voxel) {
  const world::AirData& air = *data_of(links.nodes->world)->air;
  const LeafLinkZone* zone = links.zone_at(voxel.x / air.zone_side, voxel.z / air.zone_side);
  if (zone == nullptr) return {};
  const auto found = leaf_at(air, voxel);
  if (!found) return {};
  return {zone, zone->of_leaf(found->leaf)};
}

std::optional<LinkEnd> end_of(const NodeData& nodes, const LeafLinkZone& zone,
                              const format::LeafLink& link) {
  LinkEnd end{.node = node_of(nodes, zone, link)};
  const auto [of, local] = nodes.find(end.node);
  if (of == nullptr) return std::nullopt;
  const format::NodePatch& patch = of->patch_of(local);
  const NodeSurface surface = surface_of(nodes, *of, patch);
  if (!surface.is_there()) return std::nullopt;
  const double side = 1 << patch.depth();
  end.s = (link.s() + 0.5) / side;
  end.t = (link.t() + 0.5) / side;
  end.feet = surface.at(end.s, end.t);
  return end;
}

}  // namespace graph

namespace {

std::string index_of(const world::WorldData& world) {
  return world.path + "/" + graph::kNodeFolder + "/" + graph::kLeafLinkIndexName;
}

}  // namespace

bool AirLinks::exist(const World& world) {
  // Nodes, and so their links, are of whole worlds.
  if (!world || data_of(world)->path.empty() || data_of(world)->part) return false;
  std::error_code failure;
  return std::filesystem::exists(index_of(*data_of(world)), failure);
}

Result<AirLinks> AirLinks::open(const Nodes& nodes) {
  THRONG_ASSERT(nodes);
  const graph::NodeData& data = *data_of(nodes);
  const world::WorldData& world = *data_of(data.world);
  if (data.path.empty() || !exist(data.world)) {
    return Error{Errc::kNotFound,
                 "air links: the world has none; bake it with --nodes and with --air or a class "
                 "that flies"};
  }
  const std::string name = index_of(world);
  const auto map = FileMap::open(name);
  if (!map) return map.error();
  const auto bad = [&](const char* what) {
    return world::bad_file(name, what, graph::kLeafLinkRemedy);
  };
  const auto content = world::unsealed(map->bytes(), name);
  if (!content) return bad("its checksum is wrong");
  auto index = graph::read_leaf_link_index(*content, name);
  if (!index) return index.error();
  if (world.air == nullptr ||
      index->air != graph::air_index_hash(*world.air, world.manifest_hash)) {
    return bad("belongs to other air than this world's");
  }
  if (index->nodes != graph::node_index_hash(data)) {
    return bad("belongs to other nodes than this world's");
  }
  auto links = std::make_shared<graph::LeafLinkData>();
  links->nodes = data_of(nodes);
  links->index = *std::move(index);
  for (const format::LeafLinkEntry& entry : links->index.zones) {
    links->slots.push_back(std::make_unique<graph::LeafLinkData::Slot>());
    links->slots.back()->entry = entry;
  }
  return AirLinks(std::move(links));
}

Result<void> AirLinks::check_all() const {
  THRONG_ASSERT(state_);
  return state_->check_all();
}

std::vector<AirLink> AirLinks::of_node(uint32_t node) const {
  THRONG_ASSERT(state_ && node < state_->nodes->node_count);
  std::vector<AirLink> out;
  const graph::NodeData& nodes = *state_->nodes;
  const size_t slot = nodes.slot_of(node);
  const format::NodeZoneEntry& entry = nodes.slots[slot]->entry;
  const uint32_t local = node - nodes.slots[slot]->first_node;
  const graph::LeafLinkZone* zone = state_->zone_at(entry.x(), entry.z());
  if (zone == nullptr) return out;
  for (const uint32_t link : zone->of_node(local)) {
    out.push_back(graph::link_of(nodes, *zone, zone->links()[link]));
  }
  for (const format::NodeLeaf& leaf : zone->far_of_node(local)) {
    const graph::LeafLinkZone* other = state_->zone_at(leaf.x(), leaf.z());
    if (other != nullptr) out.push_back(graph::link_of(nodes, *other, other->links()[leaf.link()]));
  }
  return out;
}

std::vector<AirLink> AirLinks::of_leaf(const Vec3d& position) const {
  THRONG_ASSERT(state_);
  std::vector<AirLink> out;
  const graph::NodeData& nodes = *state_->nodes;
  const auto voxel = graph::voxel_of(*data_of(nodes.world), position);
  if (!voxel) return out;
  const graph::LinksOfLeaf found = graph::links_of_leaf(*state_, *voxel);
  for (const format::LeafLink& link : found.links) {
    out.push_back(graph::link_of(nodes, *found.zone, link));
  }
  return out;
}

std::optional<AirLink> AirLinks::link(uint64_t n) const {
  THRONG_ASSERT(state_);
  for (size_t s = 0; s < state_->slots.size(); ++s) {
    const uint64_t links = state_->slots[s]->entry.links();
    if (n >= links) {
      n -= links;
      continue;
    }
    const graph::LeafLinkZone* zone = state_->zone(s);
    if (zone == nullptr) return std::nullopt;
    return graph::link_of(*state_->nodes, *zone, zone->links()[n]);
  }
  return std::nullopt;
}

AirLinkSummary AirLinks::summary() const {
  THRONG_ASSERT(state_);
  AirLinkSummary summary;
  for (const format::LeafLinkEntry& entry : state_->index.zones) {
    summary.links += entry.links();
    summary.leaves += entry.leaves();
    summary.leaf_sinks += entry.met() - entry.leaves();
    summary.nodes += entry.nodes();
    summary.bytes += entry.bytes();
  }
  return summary;
}

}  // namespace throng
