// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/node_plan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "bake/surface/node_drops.h"
#include "bake/surface/object_ground.h"
#include "bake/surface/patch_cells.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "graph/node_bins.h"
#include "graph/node_data.h"
#include "world/place.h"

// A zone's own input is what its patches are made of: their control points and neighbours, the
// ground's files for its level tiles, and every triangle that a body on one of them, or in a move
// from it, could meet. Its trees depend on nothing else. Its links, and how they number the nodes
// of other zones, depend also on the trees of the zones around it, and so do its widths: the sum of
// the inputs of all zones near is what its file depends on.
namespace throng::bake {
namespace {

constexpr uint64_t kNodeBakeVersion = 2;  // To be raised when equal inputs give other nodes.
constexpr double kLinkEndRadius = 1;      // Places that an off-mesh link's ends may be at. [m]
constexpr double kMargin = 1;             // for rounding, and then some [m]
constexpr double kHeightBound = 1e7;      // above and below all [m]

// Where most ground is Bezier patches, they carry all classes, and level tiles what lies on
// objects. Else, as where a level made of polygons has some curved parts, level tiles carry walkers
// and patches carry climbers.
void choose_layers(const world::WorldData& world, const Scene& scene, const NodeConfig& config,
                   NodePlan& plan) {
  const auto& classes = world.summary.classes;
  const auto& of = scene.patch_of_triangle;
  plan.has_patches = !scene.patches.empty();
  plan.has_tiles = of.empty() || std::find(of.begin(), of.end(), kNoPatch) != of.end();
  ObjectSurvey survey(world);
  for (size_t t = 0; plan.has_patches && t < scene.triangles.size(); ++t) survey.add(scene, t);
  plan.has_objects = plan.has_patches && survey.is_mostly_patches();
  for (size_t c = 0; c < classes.size(); ++c) {
    const auto bit = static_cast<uint16_t>(1u << c);
    if ((config.classes & bit) == 0) continue;
    if (classes[c].max_drop > 0) plan.drops = true;
    if (classes[c].climb_slope > 0 || plan.has_objects) plan.on_patches |= bit;
  }
  if (plan.on_patches == 0) plan.has_patches = plan.has_objects = false;
  if (plan.has_objects) plan.object_tiles = survey.tiles();
}

// May level tiles of a zone carry nodes?
bool has_carriers(const world::WorldData& world, const NodePlan& plan, int32_t zone_x,
                  int32_t zone_z) {
  const auto side = static_cast<int32_t>(world.tiles_per_zone);
  const int32_t end_x = std::min((zone_x + 1) * side, world.summary.tiles_x);
  const int32_t end_z = std::min((zone_z + 1) * side, world.summary.tiles_z);
  for (int32_t z = zone_z * side; z < end_z; ++z) {
    for (int32_t x = zone_x * side; x < end_x; ++x) {
      if (plan.is_carrier(world, x, z)) return true;
    }
  }
  return false;
}

// Bezier patches by their middles, level tiles as the ground's zones.
void list_sources(const world::WorldData& world, const Scene& scene, NodePlan& plan) {
  const auto per_zone = static_cast<int32_t>(world.tiles_per_zone);
  const auto zone = [&](double at, double origin, int32_t zones) {
    const double tile = (at - origin) / world.summary.cell / 64;
    return std::clamp(static_cast<int32_t>(std::floor(tile / per_zone)), 0, zones - 1);
  };
  for (uint32_t p = 0; plan.has_patches && p < scene.patches.size(); ++p) {
    const Box3d box = scene.patches.patches[p].bounds();
    const Vec3d middle = (box.min + box.max) * 0.5;
    plan.sources.push_back({zone(middle.z, world.summary.origin.z, world.zones_z),
                            zone(middle.x, world.summary.origin.x, world.zones_x),
                            PatchKind::kBezier, p});
  }
  for (size_t s = 0; plan.has_tiles && s < world.slots.size(); ++s) {
    const auto& slot = *world.slots[s];
    if (!has_carriers(world, plan, slot.entry.x(), slot.entry.z())) continue;
    const world::Zone* levels = plan.has_objects ? world.zone(s) : nullptr;
    for (uint32_t l = 0; l < slot.entry.levels(); ++l) {
      if (levels != nullptr) {
        const auto [x, z] = world::tile_of(world, *levels, levels->level(l));
        if (!plan.is_carrier(world, x, z)) continue;
      }
      plan.sources.push_back(
          {slot.entry.z(), slot.entry.x(), PatchKind::kLevelTile, slot.first_level + l});
    }
  }
  std::sort(plan.sources.begin(), plan.sources.end());
}

void list_zones(const world::WorldData& world, const Scene& scene, NodePlan& plan) {
  const double side = world.tiles_per_zone * 64 * world.summary.cell;
  for (uint32_t s = 0; s < plan.sources.size(); ++s) {
    const PatchSource& source = plan.sources[s];
    if (plan.zones.empty() || plan.zones.back().x != source.zone_x ||
        plan.zones.back().z != source.zone_z) {
      plan.zones.push_back({.x = source.zone_x, .z = source.zone_z, .first = s});
    }
    NodePlanZone& zone = plan.zones.back();
    zone.last = s + 1;
    if (source.kind == PatchKind::kBezier) {
      const Box3d box = scene.patches.patches[source.source].bounds();
      zone.box.add(box.min);
      zone.box.add(box.max);
    } else {
      zone.has_tiles = true;
      const Vec3d corner = world.summary.origin + Vec3d{zone.x * side, 0, zone.z * side};
      zone.box.add(corner);
      zone.box.add(corner + Vec3d{side, 0, side});
    }
  }
}

// An upper bound of the length across a cell of a patch, from its control points.
double cell_across(const BezierPatch& patch, double size) {
  double along_s = 0, along_t = 0;
  const auto& p = patch.points;
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      along_s = std::max(along_s, length(p[4 * i + j + 1] - p[4 * i + j]));
      along_t = std::max(along_t, length(p[4 * j + 4 + i] - p[4 * j + i]));
    }
  }
  return 3 * (along_s + along_t) / (1 << patch_depth(patch, size));
}

// How far around its patches a zone's nodes depend on anything. [m]
struct NodeReaches {
  double nodes = 0;               // on other nodes: linked, or flooded for widths
  std::vector<double> triangles;  // by zone
};

NodeReaches reaches(const world::WorldData& world, const Scene& scene, const NodeConfig& config,
                    const NodePlan& plan) {
  double body = 0, hole_reach = 0;
  for (const AvatarClass& avatar : world.summary.classes) {
    body = std::max(body, avatar.height + avatar.radius + body_bottom(avatar));
    hole_reach = std::max(hole_reach, hole_link_reach(avatar.radius, config.size));
    hole_reach =
        std::max(hole_reach, drop_reach(avatar, std::max(world.summary.cell, config.size)));
  }
  NodeReaches reach;
  double farthest = 0;
  for (const NodePlanZone& zone : plan.zones) {
    double across = 1.5 * world.summary.cell;
    for (uint32_t s = zone.first; s < zone.last; ++s) {
      if (plan.sources[s].kind != PatchKind::kBezier) continue;
      const BezierPatch& patch = scene.patches.patches[plan.sources[s].source];
      across = std::max(across, cell_across(patch, config.size));
    }
    farthest = std::max(farthest, across);
    reach.triangles.push_back(hole_reach + 2 * body + 4 * across + kMargin);
  }
  // A flood visits cells that come as near, and those beside them.
  const double widest = graph::make_bins(world.summary.classes).width.back();
  reach.nodes = std::max(widest, hole_reach) + farthest + kMargin;
  return reach;
}

bool holds(const Box3d& box, Vec3d at, double reach) {
  return at.x >= box.min.x - reach && at.x <= box.max.x + reach && at.z >= box.min.z - reach &&
         at.z <= box.max.z + reach;
}

// Zones whose boxes come within reach of each other, by a sweep along x.
void find_near(double reach, std::vector<NodePlanZone>& zones) {
  std::vector<uint32_t> order(zones.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return zones[a].box.min.x < zones[b].box.min.x; });
  for (size_t i = 0; i < order.size(); ++i) {
    NodePlanZone& a = zones[order[i]];
    a.near.push_back(order[i]);
    for (size_t k = i + 1; k < order.size(); ++k) {
      NodePlanZone& b = zones[order[k]];
      if (b.box.min.x > a.box.max.x + reach) break;
      if (b.box.min.z > a.box.max.z + reach || b.box.max.z < a.box.min.z - reach) continue;
      a.near.push_back(order[k]);
      b.near.push_back(order[i]);
    }
  }
}

// An off-mesh link makes the zones around both its ends depend on each other.
void find_off_mesh_links(const NodeConfig& config, std::vector<NodePlanZone>& zones) {
  for (uint32_t j = 0; j < config.off_mesh_links.size(); ++j) {
    std::vector<uint32_t> touched;
    for (uint32_t z = 0; z < zones.size(); ++z) {
      for (const Vec3d at : {config.off_mesh_links[j].from, config.off_mesh_links[j].to}) {
        if (!holds(zones[z].box, at, kLinkEndRadius + kMargin)) continue;
        touched.push_back(z);
        break;
      }
    }
    for (const uint32_t z : touched) {
      zones[z].near.insert(zones[z].near.end(), touched.begin(), touched.end());
      zones[z].off_mesh_links.push_back(j);
    }
  }
  for (NodePlanZone& zone : zones) {
    std::sort(zone.near.begin(), zone.near.end());
    zone.near.erase(std::unique(zone.near.begin(), zone.near.end()), zone.near.end());
  }
}

// Words to be hashed.
class Words {
 public:
  void add(uint64_t word) { words_.push_back(word); }
  void add(double number) { words_.push_back(std::bit_cast<uint64_t>(number)); }
  void add(Vec3d p) {
    for (const double number : {p.x, p.y, p.z}) add(number);
  }
  [[nodiscard]] uint64_t hash() const { return hash_span(std::span<const uint64_t>(words_)); }

 private:
  std::vector<uint64_t> words_;
};

// What all zones depend on.
uint64_t common_input(const world::WorldData& world, const Scene& scene, const NodeConfig& config,
                      const NodePlan& plan) {
  Words words;
  words.add(kNodeBakeVersion);
  words.add(uint64_t{graph::kNodeVersion});
  words.add(uint64_t{config.classes});
  words.add(config.size);
  words.add(uint64_t{plan.on_patches});
  // Which zones have objects is a part of their own inputs.
  const bool tiles = plan.has_tiles && !plan.has_objects;
  for (const bool flag : {plan.has_patches, tiles, plan.drops, knows_parts(scene)}) {
    words.add(uint64_t{flag});
  }
  words.add(world.summary.cell);
  words.add(world.summary.origin);
  words.add(uint64_t{world.tiles_per_zone});
  for (const AvatarClass& avatar : world.summary.classes) {
    for (const double number : {avatar.height, avatar.radius, avatar.step_height, avatar.max_slope,
                                avatar.climb_slope, avatar.max_drop}) {
      words.add(number);
    }
  }
  return words.hash();
}

void add_patch(const PatchSet& set, uint32_t patch, Words& words) {
  words.add(uint64_t{patch});
  for (const Vec3d& p : set.patches[patch].points) words.add(p);
  // Those around it too: they are tested differently from others.
  std::vector<uint32_t> around;
  find_patches_around(set, patch, around);
  for (const uint32_t beside : around) words.add(uint64_t{beside});
  for (const PatchEdge& edge : set.edges[patch]) {
    words.add(static_cast<uint64_t>(edge.bind));
    for (const PatchSide& next : edge.next) words.add(uint64_t{next.patch} << 32 | next.edge);
  }
}

// The sum of the triangles' hashes: in which order they come says nothing.
void add_triangles(const TriangleSquares& triangles, const Box3d& zone, double reach,
                   Words& words) {
  const Scene& scene = triangles.scene();
  const bool parts = knows_parts(scene), patches = !scene.patch_of_triangle.empty();
  const Box3d box{.min = {zone.min.x - reach, -kHeightBound, zone.min.z - reach},
                  .max = {zone.max.x + reach, kHeightBound, zone.max.z + reach}};
  std::vector<uint32_t> found;
  triangles.find(box, found);
  uint64_t sum = 0, count = 0;
  for (const uint32_t t : found) {
    const LocalTriangle c = triangles.corners(t);
    if (std::min({c[0].x, c[1].x, c[2].x}) > box.max.x ||
        std::max({c[0].x, c[1].x, c[2].x}) < box.min.x ||
        std::min({c[0].z, c[1].z, c[2].z}) > box.max.z ||
        std::max({c[0].z, c[1].z, c[2].z}) < box.min.z) {
      continue;  // Another one of its cluster is near.
    }
    const PatchPart part = parts ? scene.patch_part[t] : PatchPart{};
    const uint64_t patch = patches ? scene.patch_of_triangle[t] : kNoPatch;
    std::array<uint64_t, 11> own;
    for (size_t k = 0; k < 3; ++k) {
      own[3 * k] = std::bit_cast<uint64_t>(c[k].x);
      own[3 * k + 1] = std::bit_cast<uint64_t>(c[k].y);
      own[3 * k + 2] = std::bit_cast<uint64_t>(c[k].z);
    }
    own[9] = patch << 8 | scene.area[t];
    own[10] = uint64_t{part.s0} << 24 | uint64_t{part.s1} << 16 | uint64_t{part.t0} << 8 | part.t1;
    sum += hash_bytes(own.data(), sizeof own);
    ++count;
  }
  words.add(sum);
  words.add(count);
}

}  // namespace

NodePlan plan_nodes(const world::WorldData& world, const Scene& scene, const NodeConfig& config) {
  NodePlan plan;
  choose_layers(world, scene, config, plan);
  list_sources(world, scene, plan);
  list_zones(world, scene, plan);
  return plan;
}

void find_node_inputs(const world::WorldData& world, const Scene& scene, const NodeConfig& config,
                      const TriangleSquares* triangles, NodePlan& plan) {
  const NodeReaches reach = reaches(world, scene, config, plan);
  const uint64_t common = common_input(world, scene, config, plan);
  find_near(reach.nodes, plan.zones);
  find_off_mesh_links(config, plan.zones);
  std::vector<uint64_t> own(plan.zones.size());
  parallel_for(own.size(), config.workers, [&](size_t z) {
    const NodePlanZone& zone = plan.zones[z];
    Words words;
    words.add(common);
    words.add(uint64_t{static_cast<uint32_t>(zone.x)} << 32 | static_cast<uint32_t>(zone.z));
    for (uint32_t s = zone.first; s < zone.last; ++s) {
      if (plan.sources[s].kind == PatchKind::kBezier) {
        const uint32_t patch = plan.sources[s].source;
        add_patch(scene.patches, patch, words);
        if (knows_parts(scene)) words.add(scene.patch_off[patch]);
      }
    }
    const int32_t slot =
        zone.has_tiles ? world.slot_of_zone[static_cast<size_t>(zone.z * world.zones_x + zone.x)]
                       : -1;
    words.add(slot < 0 ? 0 : world.slots[static_cast<size_t>(slot)]->entry.hash());
    if (triangles != nullptr) add_triangles(*triangles, zone.box, reach.triangles[z], words);
    own[z] = words.hash();
  });
  for (NodePlanZone& zone : plan.zones) {
    Words words;
    for (const uint32_t near : zone.near) words.add(own[near]);
    for (const uint32_t j : zone.off_mesh_links) {
      const NodeOffMeshLink& off_mesh_link = config.off_mesh_links[j];
      words.add(off_mesh_link.from);
      words.add(off_mesh_link.to);
      words.add(uint64_t{static_cast<uint32_t>(off_mesh_link.avatar_class)} << 1 |
                uint64_t{off_mesh_link.two_way});
    }
    zone.input = words.hash();
  }
}

namespace {

// What the nodes of a zone take while they are made, about. [bytes]
uint64_t working_bytes(const Scene& scene, const NodeConfig& config, const NodePlan& plan,
                       const NodePlanZone& zone) {
  constexpr uint64_t kLevelTile = 16384, kPatchCell = 48;
  uint64_t sum = 0;
  for (uint32_t s = zone.first; s < zone.last; ++s) {
    if (plan.sources[s].kind == PatchKind::kLevelTile) {
      sum += kLevelTile;
      continue;
    }
    const int32_t depth = patch_depth(scene.patches.patches[plan.sources[s].source], config.size);
    sum += kPatchCell << (2 * depth);
  }
  return sum;
}

// Halves zones along their longer side until each part is small enough.
class BatchSplitter {
 public:
  BatchSplitter(const NodePlan& plan, std::vector<uint64_t> bytes, uint64_t max_bytes)
      : zones_(plan.zones), bytes_(std::move(bytes)), max_bytes_(max_bytes) {}

  void split(std::vector<uint32_t> zones) {
    uint64_t sum = 0;
    Box3d box;
    for (const uint32_t z : zones) {
      sum += bytes_[z];
      box.add({static_cast<double>(zones_[z].x), 0, static_cast<double>(zones_[z].z)});
    }
    if (sum <= max_bytes_ || zones.size() < 2) {
      batches_.push_back(std::move(zones));
      return;
    }
    const bool along_x = box.max.x - box.min.x > box.max.z - box.min.z;
    const auto place = [&](uint32_t z) {
      const int32_t x = zones_[z].x, at = zones_[z].z;
      return along_x ? std::pair{x, at} : std::pair{at, x};
    };
    std::sort(zones.begin(), zones.end(),
              [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
    size_t half = 1;
    for (uint64_t left = bytes_[zones[0]]; half + 1 < zones.size() && 2 * left < sum; ++half) {
      left += bytes_[zones[half]];
    }
    for (const auto& [from, to] : {std::pair{size_t{0}, half}, std::pair{half, zones.size()}}) {
      std::vector<uint32_t> part(zones.begin() + static_cast<ptrdiff_t>(from),
                                 zones.begin() + static_cast<ptrdiff_t>(to));
      std::sort(part.begin(), part.end());
      split(std::move(part));
    }
  }
  [[nodiscard]] std::vector<std::vector<uint32_t>> take() { return std::move(batches_); }

 private:
  const std::vector<NodePlanZone>& zones_;
  const std::vector<uint64_t> bytes_;  // by zone
  const uint64_t max_bytes_;
  std::vector<std::vector<uint32_t>> batches_;
};

}  // namespace

std::vector<std::vector<uint32_t>> node_batches(const Scene& scene, const NodeConfig& config,
                                                const NodePlan& plan, std::vector<uint32_t> zones,
                                                uint64_t max_bytes) {
  std::vector<uint64_t> bytes;
  for (const NodePlanZone& zone : plan.zones) {
    bytes.push_back(working_bytes(scene, config, plan, zone));
  }
  BatchSplitter splitter(plan, std::move(bytes), max_bytes);
  splitter.split(std::move(zones));
  return splitter.take();
}

uint64_t all_working_bytes(const Scene& scene, const NodeConfig& config, const NodePlan& plan) {
  uint64_t sum = 0;
  for (const NodePlanZone& zone : plan.zones) sum += working_bytes(scene, config, plan, zone);
  return sum;
}

uint64_t batch_working_bytes(const Scene& scene, const NodeConfig& config, const NodePlan& plan,
                             std::span<const uint32_t> batch) {
  std::vector<uint8_t> is_seen(plan.zones.size(), 0);
  uint64_t sum = 0;
  const auto see = [&](uint32_t zone) {
    if (is_seen[zone] != 0) return;
    is_seen[zone] = 1;
    sum += working_bytes(scene, config, plan, plan.zones[zone]);
  };
  for (const uint32_t zone : batch) {
    see(zone);
    for (const uint32_t near : plan.zones[zone].near) see(near);
  }
  return sum;
}

}  // namespace throng::bake
