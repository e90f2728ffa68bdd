// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "core/access.h"
#include "core/arrays/disjoint_sets.h"
#include "core/hash.h"
#include "core/random.h"
#include "graph/node_data.h"
#include "graph/node_surface.h"
#include "throng/surface.h"
#include "world/sealed_file.h"
#include "world/zone_data.h"

// The public queries of nodes: places, arcs, components, reachable sets.
namespace throng {
namespace {

NodeInfo info_of(uint32_t source, const format::NodePatch& patch, const format::Node& node,
                 uint64_t cells) {
  return {.classes = node.classes(),
          .inclination = static_cast<uint8_t>(node.surface() >> 4),
          .height = static_cast<uint8_t>(node.surface() & 15),
          .headroom = static_cast<uint8_t>(node.room() >> 4),
          .width = static_cast<uint8_t>(node.room() & 15),
          .terminal = (node.flags() & graph::kTerminalFlag) != 0,
          .kind = static_cast<PatchKind>(patch.kind()),
          .source = source,
          .depth = patch.depth(),
          .block_level = node.level(),
          .s = node.s(),
          .t = node.t(),
          .parent1 = 0,
          .area = node.area(),
          .cells = cells};
}

// Is a point in or on the border of one of the cells of a block? [s, t in cells of the block]
bool touches(uint64_t cells, double s, double t) {
  for (const int32_t j : {static_cast<int32_t>(std::ceil(t)) - 1, static_cast<int32_t>(t)}) {
    for (const int32_t i : {static_cast<int32_t>(std::ceil(s)) - 1, static_cast<int32_t>(s)}) {
      if (i >= 0 && i < 8 && j >= 0 && j < 8 && (cells >> (8 * j + i) & 1) != 0) return true;
    }
  }
  return false;
}

// Drop links are one-way, and off-mesh links may be; a one-way link connects no component.
bool goes_back(const graph::NodeData& data, uint32_t from, uint32_t to, const format::Arc& arc) {
  if (arc.kind() == static_cast<uint8_t>(LinkKind::kDrop)) return false;
  if (arc.kind() != static_cast<uint8_t>(LinkKind::kOffMesh)) return true;
  const size_t slot = data.slot_of(to);
  const graph::NodeZone* zone = data.zone(slot);
  if (zone == nullptr) return false;
  const auto arcs = zone->arcs(to - data.slots[slot]->first_node);
  return std::any_of(arcs.begin(), arcs.end(), [&](const format::Arc& back) {
    return back.kind() == arc.kind() && (back.classes() & arc.classes()) == arc.classes() &&
           data.target(slot, *zone, back) == from;
  });
}

std::string index_of(const std::string& world_path) {
  return world_path + "/" + graph::kNodeFolder + "/" + graph::kNodeIndexName;
}

}  // namespace

Result<Nodes> Nodes::open(const std::string& world_path) {
  auto world = World::open(world_path);
  if (!world) return world.error();
  return open(*world);
}

bool Nodes::exist(const World& world) {
  if (!world || data_of(world)->path.empty()) return false;
  std::error_code failure;
  return std::filesystem::exists(index_of(data_of(world)->path), failure);
}

Result<Nodes> Nodes::open(const World& world) {
  THRONG_ASSERT(world);
  const std::string& world_path = data_of(world)->path;
  if (world_path.empty()) {
    return Error{Errc::kBadFile,
                 "this world was not opened from a folder, so it has no nodes there"};
  }
  if (data_of(world)->part) {
    return Error{Errc::kBadConfig,
                 world_path + ": nodes know only the whole world, and it was opened in part"};
  }
  const std::string name = index_of(world_path);
  const auto map = FileMap::open(name);
  if (!map) {
    return Error{Errc::kBadFile,
                 world_path + ": this world has no nodes; bake it again with --nodes"};
  }
  auto nodes = graph::read_node_index(map->bytes(), name);
  if (!nodes) return nodes.error();
  if (const auto whole = world::unsealed(map->bytes(), name); !whole) return whole.error();
  if (data_of(world)->manifest_hash != (*nodes)->world_hash) {
    return Error{Errc::kBadFile, name + ": belongs to another world; bake it again with --nodes"};
  }
  (*nodes)->world = world;
  (*nodes)->path = world_path + "/" + graph::kNodeFolder;
  return Nodes(std::move(*nodes));
}

Result<void> Nodes::check_all() const {
  THRONG_ASSERT(state_);
  for (size_t s = 0; s < state_->slots.size(); ++s) {
    if (state_->zone(s) == nullptr) return Error{Errc::kBadFile, state_->slots[s]->error};
  }
  return state_->world.check_ground();
}

const World& Nodes::world() const { return state_->world; }

NodeSummary Nodes::summary() const {
  THRONG_ASSERT(state_);
  NodeSummary summary = state_->summary;
  summary.classes = state_->world.summary().classes;
  for (size_t s = 0; s < state_->slots.size(); ++s) {
    const graph::NodeZone* zone = state_->zone(s);
    if (zone == nullptr) continue;
    for (const format::Node& node : zone->nodes()) {
      summary.terminal += (node.flags() & graph::kTerminalFlag) != 0;
      summary.partial += (node.flags() & graph::kPartialFlag) != 0;
    }
    for (uint32_t n = 0; n < zone->nodes().size(); ++n) summary.arcs += zone->arcs(n).size();
    zone->give_back();  // All zones together may be far more than fits.
  }
  return summary;
}

uint32_t Nodes::node_count() const {
  THRONG_ASSERT(state_);
  return state_->node_count;
}

NodeInfo Nodes::node(uint32_t node) const {
  THRONG_ASSERT(node < node_count());
  const auto [zone, local] = state_->find(node);
  if (zone == nullptr) return {};
  const format::Node& found = zone->nodes()[local];
  const format::NodePatch& patch = zone->patch_of(local);
  NodeInfo info = info_of(state_->source_of(*zone, patch), patch, found, zone->cells_of(local));
  if (found.parent() != UINT32_MAX) info.parent1 = node - local + found.parent() + 1;
  return info;
}

std::vector<NodeArc> Nodes::arcs(uint32_t node) const {
  THRONG_ASSERT(node < node_count());
  std::vector<NodeArc> out;
  const size_t slot = state_->slot_of(node);
  const graph::NodeZone* zone = state_->zone(slot);
  if (zone == nullptr) return out;
  const uint32_t local = node - state_->slots[slot]->first_node;
  for (const format::Arc& arc : zone->arcs(local)) {
    NodeArc& found = out.emplace_back(NodeArc{.to = state_->target(slot, *zone, arc),
                                              .classes = arc.classes(),
                                              .kind = static_cast<LinkKind>(arc.kind())});
    const auto* hole_link = zone->hole_link_of(static_cast<uint32_t>(&arc - zone->first_arc()));
    const auto [other, to] = state_->find(found.to);
    if (hole_link == nullptr || other == nullptr) continue;
    const double from_side = 1 << zone->patch_of(local).depth();
    const double to_side = 1 << other->patch_of(to).depth();
    found.over_hole = true;
    found.from_s = (hole_link->from_s() + 0.5) / from_side;
    found.from_t = (hole_link->from_t() + 0.5) / from_side;
    found.to_s = (hole_link->to_s() + 0.5) / to_side;
    found.to_t = (hole_link->to_t() + 0.5) / to_side;
  }
  return out;
}

uint64_t Nodes::partial_cells(int32_t avatar_class, uint32_t node) const {
  THRONG_ASSERT(node < node_count());
  const auto [zone, local] = state_->find(node);
  if (zone == nullptr || avatar_class < 0 || avatar_class >= kMaxAvatarClasses) return 0;
  return state_->cells_of(*zone, local, avatar_class);
}

std::array<Vec3d, 4> Nodes::corners(uint32_t node) const {
  const NodeInfo info = this->node(node);
  // Of a level tile the far corners lie in the next cells, which may have no floor.
  const double inside = info.kind == PatchKind::kLevelTile ? 1e-5 : 0;
  const double whole = 1.0 / (1 << info.block_level), side = whole - inside;
  const double s = info.s * whole, t = info.t * whole;
  return {point(node, s, t), point(node, s, t + side), point(node, s + side, t + side),
          point(node, s + side, t)};
}

Vec3d Nodes::middle(uint32_t node) const {
  const NodeInfo info = this->node(node);
  if (info.cells == 0) {
    const double side = 1.0 / (1 << info.block_level);
    return point(node, (info.s + 0.5) * side, (info.t + 0.5) * side);
  }
  // The middle of all cells may lie in none: the nearest of them.
  const int32_t count = std::popcount(info.cells);
  int32_t s = 0, t = 0, nearest = INT32_MAX, best = 0;
  const auto for_cells = [&](auto visit) {
    for (uint64_t left = info.cells; left != 0; left &= left - 1) visit(std::countr_zero(left));
  };
  for_cells([&](int32_t bit) {
    s += bit % 8;
    t += bit / 8;
  });
  for_cells([&](int32_t bit) {
    const int32_t ds = bit % 8 * count - s, dt = bit / 8 * count - t;
    if (ds * ds + dt * dt >= nearest) return;
    nearest = ds * ds + dt * dt;
    best = bit;
  });
  return point(node, (info.s * 8 + best % 8 + 0.5) / kTileCells,
               (info.t * 8 + best / 8 + 0.5) / kTileCells);
}

Vec3d Nodes::point(uint32_t node, double s, double t) const {
  THRONG_ASSERT(node < node_count());
  const auto [zone, local] = state_->find(node);
  if (zone == nullptr) return {};
  return graph::surface_of(*state_, *zone, zone->patch_of(local)).at(s, t);
}

NodePlace Nodes::place(int32_t avatar_class, uint32_t node, double s, double t) const {
  THRONG_ASSERT(node < node_count());
  const auto& classes = data_of(state_->world)->summary.classes;
  if (avatar_class < 0 || static_cast<size_t>(avatar_class) >= classes.size()) return {};
  const auto [zone, local] = state_->find(node);
  if (zone == nullptr) return {};
  const format::Node& found = zone->nodes()[local];
  const double blocks = 1 << found.level();
  const bool inside = s * blocks >= found.s() && s * blocks <= found.s() + 1 &&
                      t * blocks >= found.t() && t * blocks <= found.t() + 1;
  if (!inside || (found.classes() >> avatar_class & 1) == 0) return {};
  if ((found.flags() & graph::kPartialFlag) != 0 &&
      !touches(state_->cells_of(*zone, local, avatar_class), s * kTileCells - found.s() * 8,
               t * kTileCells - found.t() * 8)) {
    return {};
  }
  const graph::NodeSurface surface = graph::surface_of(*state_, *zone, zone->patch_of(local));
  if (!surface.is_there()) return {};
  const bool climbs = classes[static_cast<size_t>(avatar_class)].climb_slope > 0;
  const Vec3d normal = surface.normal(s, t);
  return {node + 1, surface.at(s, t), climbs ? normal : Vec3d{0, 1, 0}, normal, s, t};
}

NodePlace Nodes::random_place(int32_t avatar_class, uint64_t seed, uint64_t n) const {
  THRONG_ASSERT(state_);
  // Nodes without a parent for the class share out its area; sums of them are made once.
  const auto& areas = state_->areas_before(avatar_class);
  if (areas.empty() || !(areas.back().second > 0)) return {};
  const double target = random_unit(seed, n, 0) * areas.back().second;
  auto found = std::upper_bound(areas.begin(), areas.end(), target,
                                [](double at, const auto& entry) { return at < entry.second; });
  if (found == areas.end()) --found;
  const NodeInfo info = node(found->first);
  if (info.cells != 0) {
    uint64_t cells = partial_cells(avatar_class, found->first);
    if (cells == 0) return {};
    const auto count = static_cast<uint64_t>(std::popcount(cells));
    for (uint64_t skip = random_below(seed, n, 3, count); skip > 0; --skip) cells &= cells - 1;
    const int32_t bit = std::countr_zero(cells);
    return place(avatar_class, found->first,
                 (info.s * 8 + bit % 8 + random_unit(seed, n, 1)) / kTileCells,
                 (info.t * 8 + bit / 8 + random_unit(seed, n, 2)) / kTileCells);
  }
  const double side = 1.0 / (1 << info.block_level);
  return place(avatar_class, found->first, (info.s + random_unit(seed, n, 1)) * side,
               (info.t + random_unit(seed, n, 2)) * side);
}

std::vector<NodeComponent> Nodes::components(int32_t avatar_class,
                                             std::vector<uint32_t>* of_node) const {
  THRONG_ASSERT(state_);
  const uint32_t count = state_->node_count;
  DisjointSets sets(count);
  const uint32_t bit =
      avatar_class >= 0 && avatar_class < kMaxAvatarClasses ? 1u << avatar_class : 0u;
  std::vector<uint8_t> stands(count, 0);
  std::vector<double> area(count, 0);
  for (size_t s = 0; s < state_->slots.size(); ++s) {
    const graph::NodeZone* zone = state_->zone(s);
    if (zone == nullptr) continue;
    const uint32_t first = state_->slots[s]->first_node;
    const auto nodes = zone->nodes();
    for (uint32_t n = 0; n < nodes.size(); ++n) {
      if ((nodes[n].classes() & bit) == 0) continue;
      stands[first + n] = 1;
      const uint32_t parent = nodes[n].parent();
      const bool inside = parent != UINT32_MAX && (nodes[parent].classes() & bit) != 0;
      if (inside) sets.join(first + n, first + parent);
      area[first + n] = inside ? 0 : state_->area_of(*zone, n, avatar_class);
      for (const format::Arc& arc : zone->arcs(n)) {
        if ((arc.classes() & bit) == 0) continue;
        const uint32_t to = state_->target(s, *zone, arc);
        if (goes_back(*state_, first + n, to, arc)) sets.join(first + n, to);
      }
    }
  }
  std::vector<NodeComponent> parts;
  std::vector<uint32_t> part(count, UINT32_MAX);
  for (uint32_t n = 0; n < count; ++n) {
    if (stands[n] == 0) continue;
    const uint32_t r = sets.find(n);
    if (r == n) {
      part[n] = static_cast<uint32_t>(parts.size());
      parts.push_back({.area = 0, .nodes = 0, .node = n});
    }
    part[n] = part[r];
    parts[part[n]].area += area[n];
    ++parts[part[n]].nodes;
  }
  std::vector<uint32_t> order(parts.size()), rank(parts.size());
  std::iota(order.begin(), order.end(), uint32_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return parts[a].area > parts[b].area; });
  std::vector<NodeComponent> sorted;
  for (uint32_t i = 0; i < order.size(); ++i) {
    rank[order[i]] = i;
    sorted.push_back(parts[order[i]]);
  }
  if (of_node != nullptr) {
    for (uint32_t& p : part) p = p == UINT32_MAX ? p : rank[p];
    *of_node = std::move(part);
  }
  return sorted;
}

}  // namespace throng
