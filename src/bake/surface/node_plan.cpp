// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/node_plan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "bake/surface/node_drops.h"
#include "bake/surface/object_ground.h"
#include "bake/surface/patch_cells.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "graph/node_bins.h"
#include "graph/node_data.h"
#include "world/place.h"
#include "world/region_data.h"

// A zone's own input is what its patches are made of: their control points and neighbours, the
// ground's files for its level tiles, and every triangle that a body on one of them, or in a move
// from it, could meet. Its trees depend on nothing else. Its links, and how they number the nodes
// of other zones, depend also on the trees of the zones around it, and so do its widths: the sum of
// the inputs of all zones near is what its file depends on.
namespace throng::bake {
namespace {

constexpr uint64_t kNodeBakeVersion = 3;  // To be raised when equal inputs give other nodes.
constexpr double kLinkEndRadius = 1;      // Places that an off-mesh link's ends may be at. [m]
constexpr double kMargin = 1;             // for rounding, and then some [m]
constexpr double kFar = 1e7;              // above, below and beside all [m]
constexpr uint64_t kLevelTileBytes = 16384, kPatchCellBytes = 48;  // while nodes are made, about

// Of the zones' squares. [m]
double zone_side(const world::WorldData& world) {
  return world.tiles_per_zone * 64 * world.summary.cell;
}

// An upper bound of the length across a cell of a patch, from its control points.
double cell_across(const BezierPatch& patch, int32_t depth) {
  double along_s = 0, along_t = 0;
  const auto& p = patch.points;
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      along_s = std::max(along_s, length(p[4 * i + j + 1] - p[4 * i + j]));
      along_t = std::max(along_t, length(p[4 * j + 4 + i] - p[4 * j + i]));
    }
  }
  return 3 * (along_s + along_t) / (1 << depth);
}

// The scene as it lies over the world's zones: what a plan needs of patches and triangles.
class SceneSurvey {
 public:
  // The patches of a zone.
  struct Patches {
    Box3d box;
    double across = 0;   // at most, of a cell [m]
    uint64_t bytes = 0;  // while they are made
  };

  SceneSurvey(const world::WorldData& world, const NodeScene& scene, const NodeConfig& config)
      : world_(world),
        scene_(scene),
        config_(config),
        objects_(world),
        zones_(static_cast<size_t>(world.zones_x) * static_cast<size_t>(world.zones_z)) {}

  Result<void> run(Context& context) {
    return visit({0, 0, world_.zones_x, world_.zones_z}, context);
  }

  [[nodiscard]] const ObjectSurvey& objects() const { return objects_; }
  [[nodiscard]] bool knows_parts() const { return knows_parts_; }
  [[nodiscard]] const Patches& zone(int32_t x, int32_t z) const {
    return zones_[static_cast<size_t>(z) * static_cast<size_t>(world_.zones_x) +
                  static_cast<size_t>(x)];
  }
  [[nodiscard]] std::vector<PatchSource> take_sources() { return std::move(sources_); }

 private:
  // Zones as large as the memory allows, one after the other.
  Result<void> visit(const world::ZoneRect& zones, Context& context) {
    const int32_t across = zones.x1 - zones.x0, along = zones.z1 - zones.z0;
    const Box3d box = box_of(zones);
    if (scene_.region_bytes(box) > config_.working_bytes && across * along > 1) {
      world::ZoneRect low = zones, high = zones;
      if (across > along) {
        low.x1 = high.x0 = zones.x0 + across / 2;
      } else {
        low.z1 = high.z0 = zones.z0 + along / 2;
      }
      if (auto ok = visit(low, context); !ok) return ok;
      return visit(high, context);
    }
    const auto region = scene_.region(box, context);
    if (!region) return region.error();
    add(zones, **region);
    return {};
  }

  // Zones at the border hold all beyond.
  [[nodiscard]] Box3d box_of(const world::ZoneRect& zones) const {
    const double side = zone_side(world_);
    const Vec3d origin = world_.summary.origin;
    const auto low = [&](int32_t at, double from) {
      return at == 0 ? -kFar : from + at * side - kMargin;
    };
    const auto high = [&](int32_t at, int32_t count, double from) {
      return at == count ? kFar : from + at * side + kMargin;
    };
    return {.min = {low(zones.x0, origin.x), -kFar, low(zones.z0, origin.z)},
            .max = {high(zones.x1, world_.zones_x, origin.x), kFar,
                    high(zones.z1, world_.zones_z, origin.z)}};
  }

  [[nodiscard]] int32_t zone_x(double x) const {
    return zone_at(x, world_.summary.origin.x, world_.zones_x);
  }
  [[nodiscard]] int32_t zone_z(double z) const {
    return zone_at(z, world_.summary.origin.z, world_.zones_z);
  }
  [[nodiscard]] int32_t zone_at(double at, double origin, int32_t zones) const {
    const double tile = (at - origin) / world_.summary.cell / 64;
    return std::clamp(
        static_cast<int32_t>(std::floor(tile / static_cast<int32_t>(world_.tiles_per_zone))), 0,
        zones - 1);
  }

  // Patches by their middles, triangles by the corner of their boxes, so that each is in one part.
  void add(const world::ZoneRect& zones, const NodeRegion& region) {
    const Scene& scene = region.scene();
    knows_parts_ |= !scene.patches.empty() && bake::knows_parts(scene);
    for (uint32_t p = 0; p < scene.patches.size(); ++p) {
      const BezierPatch& patch = scene.patches.patches[p];
      const Box3d box = patch.bounds();
      const Vec3d middle = (box.min + box.max) * 0.5;
      const int32_t x = zone_x(middle.x), z = zone_z(middle.z);
      if (!zones.contains(x, z)) continue;
      sources_.push_back({z, x, PatchKind::kBezier, region.number_of(p)});
      Patches& patches = zones_[static_cast<size_t>(z) * static_cast<size_t>(world_.zones_x) +
                                static_cast<size_t>(x)];
      const int32_t depth = patch_depth(patch, config_.size);
      patches.box.add(box.min);
      patches.box.add(box.max);
      patches.across = std::max(patches.across, cell_across(patch, depth));
      patches.bytes += kPatchCellBytes << (2 * depth);
    }
    for (size_t t = 0; t < scene.triangles.size(); ++t) {
      if (scene_.is_whole() || is_in(zones, scene, t)) objects_.add(scene, t);
    }
  }

  [[nodiscard]] bool is_in(const world::ZoneRect& zones, const Scene& scene,
                           size_t triangle) const {
    Box3d box;
    for (const uint32_t corner : scene.triangles[triangle]) box.add(scene.positions[corner]);
    return zones.contains(zone_x(box.min.x), zone_z(box.min.z));
  }

  const world::WorldData& world_;
  const NodeScene& scene_;
  const NodeConfig& config_;
  ObjectSurvey objects_;
  bool knows_parts_ = false;
  std::vector<Patches> zones_;  // row by row
  std::vector<PatchSource> sources_;
};

// Where most ground is Bezier patches, they carry all classes, and level tiles what lies on
// objects. Else, as where a level made of polygons has some curved parts, level tiles carry walkers
// and patches carry climbers.
void choose_layers(const world::WorldData& world, const NodeScene& scene, const SceneSurvey& survey,
                   const NodeConfig& config, NodePlan& plan) {
  const auto& classes = world.summary.classes;
  plan.has_patches = scene.patches() > 0;
  plan.has_tiles = scene.patch_triangles() < scene.triangles();
  plan.knows_parts = survey.knows_parts();
  plan.has_objects = plan.has_patches && survey.objects().is_mostly_patches();
  for (size_t c = 0; c < classes.size(); ++c) {
    const auto bit = static_cast<uint16_t>(1u << c);
    if ((config.classes & bit) == 0) continue;
    if (classes[c].max_drop > 0) plan.drops = true;
    if (classes[c].climb_slope > 0 || plan.has_objects) plan.on_patches |= bit;
  }
  if (plan.on_patches == 0) plan.has_patches = plan.has_objects = false;
  if (plan.has_objects) plan.object_tiles = survey.objects().tiles();
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

// Bezier patches, and level tiles as the ground's zones.
void list_sources(const world::WorldData& world, SceneSurvey& survey, NodePlan& plan) {
  if (plan.has_patches) plan.sources = survey.take_sources();
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

// A zone's patches, Bezier ones first.
void list_zones(const world::WorldData& world, const SceneSurvey& survey, NodePlan& plan) {
  const double side = zone_side(world);
  for (uint32_t s = 0; s < plan.sources.size(); ++s) {
    const PatchSource& source = plan.sources[s];
    const bool is_new = plan.zones.empty() || plan.zones.back().x != source.zone_x ||
                        plan.zones.back().z != source.zone_z;
    if (is_new) plan.zones.push_back({.x = source.zone_x, .z = source.zone_z, .first = s});
    NodePlanZone& zone = plan.zones.back();
    zone.last = s + 1;
    if (source.kind == PatchKind::kBezier) {
      if (!is_new) continue;
      const SceneSurvey::Patches& patches = survey.zone(zone.x, zone.z);
      zone.box = patches.box;
      zone.bytes = patches.bytes;
    } else {
      zone.has_tiles = true;
      const Vec3d corner = world.summary.origin + Vec3d{zone.x * side, 0, zone.z * side};
      zone.box.add(corner);
      zone.box.add(corner + Vec3d{side, 0, side});
      zone.bytes += kLevelTileBytes;
    }
  }
}

// Finds how far around its patches a zone's nodes depend on triangles, and returns how far on other
// nodes: linked, or flooded for widths. [m]
double find_reaches(const world::WorldData& world, const SceneSurvey& survey,
                    const NodeConfig& config, NodePlan& plan) {
  double body = 0, hole_reach = 0;
  for (const AvatarClass& avatar : world.summary.classes) {
    body = std::max(body, avatar.height + avatar.radius + body_bottom(avatar));
    hole_reach = std::max(hole_reach, hole_link_reach(avatar.radius, config.size));
    hole_reach =
        std::max(hole_reach, drop_reach(avatar, std::max(world.summary.cell, config.size)));
  }
  double farthest = 0;
  for (NodePlanZone& zone : plan.zones) {
    double across = 1.5 * world.summary.cell;
    if (plan.has_patches) across = std::max(across, survey.zone(zone.x, zone.z).across);
    farthest = std::max(farthest, across);
    zone.reach = hole_reach + 2 * body + 4 * across + kMargin;
  }
  // A flood visits cells that come as near, and those beside them.
  const double widest = graph::make_bins(world.summary.classes).width.back();
  return std::max(widest, hole_reach) + farthest + kMargin;
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
uint64_t common_input(const world::WorldData& world, const NodeConfig& config,
                      const NodePlan& plan) {
  Words words;
  words.add(kNodeBakeVersion);
  words.add(uint64_t{graph::kNodeVersion});
  words.add(uint64_t{config.classes});
  words.add(config.size);
  words.add(uint64_t{plan.on_patches});
  // Which zones have objects is a part of their own inputs.
  const bool tiles = plan.has_tiles && !plan.has_objects;
  for (const bool flag : {plan.has_patches, tiles, plan.drops, plan.knows_parts}) {
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

// By their numbers in the whole scene.
void add_patch(const NodeRegion& region, uint32_t patch, Words& words) {
  const PatchSet& set = region.scene().patches;
  words.add(uint64_t{region.number_of(patch)});
  for (const Vec3d& p : set.patches[patch].points) words.add(p);
  // Those around it too: they are tested differently from others.
  std::vector<uint32_t> around;
  find_patches_around(set, patch, around);
  for (const uint32_t beside : around) words.add(uint64_t{region.number_of(beside)});
  for (const PatchEdge& edge : set.edges[patch]) {
    words.add(static_cast<uint64_t>(edge.bind));
    for (const PatchSide& next : edge.next) {
      const uint32_t number = next.patch == kNoPatch ? kNoPatch : region.number_of(next.patch);
      words.add(uint64_t{number} << 32 | next.edge);
    }
  }
}

// The sum of the triangles' hashes: in which order they come says nothing.
void add_triangles(const NodeRegion& region, const TriangleSquares& triangles,
                   const NodePlanZone& of, Words& words) {
  const Scene& scene = region.scene();
  const Box3d& zone = of.box;
  const double reach = of.reach;
  const bool parts = knows_parts(scene), patches = !scene.patch_of_triangle.empty();
  const Box3d box{.min = {zone.min.x - reach, -kFar, zone.min.z - reach},
                  .max = {zone.max.x + reach, kFar, zone.max.z + reach}};
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
    const uint32_t local = patches ? scene.patch_of_triangle[t] : kNoPatch;
    const uint64_t patch = local == kNoPatch ? kNoPatch : region.number_of(local);
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

// Halves zones along their longer side until each part is small enough.
class BatchSplitter {
 public:
  using Bytes = std::function<uint64_t(std::span<const uint32_t>)>;

  BatchSplitter(const NodePlan& plan, Bytes bytes, uint64_t max_bytes)
      : zones_(plan.zones), bytes_(std::move(bytes)), max_bytes_(max_bytes) {}

  void split(std::vector<uint32_t> zones) {
    if (zones.size() < 2 || bytes_(zones) <= max_bytes_) {
      batches_.push_back(std::move(zones));
      return;
    }
    uint64_t sum = 0;
    Box3d box;
    for (const uint32_t z : zones) {
      sum += zones_[z].bytes;
      box.add({static_cast<double>(zones_[z].x), 0, static_cast<double>(zones_[z].z)});
    }
    const bool along_x = box.max.x - box.min.x > box.max.z - box.min.z;
    const auto place = [&](uint32_t z) {
      const int32_t x = zones_[z].x, at = zones_[z].z;
      return along_x ? std::pair{x, at} : std::pair{at, x};
    };
    std::sort(zones.begin(), zones.end(),
              [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
    size_t half = 1;
    for (uint64_t left = zones_[zones[0]].bytes; half + 1 < zones.size() && 2 * left < sum;
         ++half) {
      left += zones_[zones[half]].bytes;
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
  const Bytes bytes_;
  const uint64_t max_bytes_;
  std::vector<std::vector<uint32_t>> batches_;
};

// What the trees of a zone depend on.
Result<uint64_t> own_input(const world::WorldData& world, const NodePlan& plan,
                           const NodePlanZone& zone, const NodeRegion& region,
                           const TriangleSquares* triangles, uint64_t common) {
  Words words;
  words.add(common);
  words.add(uint64_t{static_cast<uint32_t>(zone.x)} << 32 | static_cast<uint32_t>(zone.z));
  for (uint32_t s = zone.first; s < zone.last; ++s) {
    if (plan.sources[s].kind != PatchKind::kBezier) continue;
    const uint32_t patch = region.patch_of(plan.sources[s].source);
    if (patch == kNoPatch) return region_lacks_patch(plan.sources[s].source);
    add_patch(region, patch, words);
    if (plan.knows_parts) words.add(region.scene().patch_off[patch]);
  }
  const int32_t slot = zone.has_tiles ? world::slot_at(world, zone.x, zone.z) : -1;
  words.add(slot < 0 ? 0 : world.slots[static_cast<size_t>(slot)]->entry.hash());
  if (triangles != nullptr) add_triangles(region, *triangles, zone, words);
  return words.hash();
}

// All zones, in parts of which each can be hashed with its triangles in memory.
std::vector<std::vector<uint32_t>> scene_parts(const NodePlan& plan, const NodeScene& scene,
                                               uint64_t max_bytes) {
  std::vector<uint32_t> all(plan.zones.size());
  std::iota(all.begin(), all.end(), 0u);
  BatchSplitter splitter(
      plan,
      [&](std::span<const uint32_t> part) { return scene.region_bytes(box_around(plan, part)); },
      max_bytes);
  splitter.split(std::move(all));
  return splitter.take();
}

}  // namespace

Box3d box_around(const NodePlan& plan, std::span<const uint32_t> zones) {
  Box3d box;
  for (const uint32_t z : zones) {
    const NodePlanZone& zone = plan.zones[z];
    // The margin again: whatever touches these triangles is in the region, too.
    const double reach = zone.reach + kMargin;
    box.add(zone.box.min - Vec3d{reach, 0, reach});
    box.add(zone.box.max + Vec3d{reach, 0, reach});
  }
  return box;
}

std::vector<uint32_t> with_near_zones(const NodePlan& plan, std::span<const uint32_t> zones) {
  std::vector<uint8_t> is_seen(plan.zones.size(), 0);
  for (const uint32_t z : zones) {
    is_seen[z] = 1;
    for (const uint32_t near : plan.zones[z].near) is_seen[near] = 1;
  }
  std::vector<uint32_t> seen;
  for (uint32_t z = 0; z < is_seen.size(); ++z) {
    if (is_seen[z] != 0) seen.push_back(z);
  }
  return seen;
}

Result<NodePlan> plan_nodes(const world::WorldData& world, const NodeScene& scene,
                            const NodeConfig& config, Context& context) {
  NodePlan plan;
  SceneSurvey survey(world, scene, config);
  if (scene.patches() > 0) {
    if (auto ok = survey.run(context); !ok) return ok.error();
  }
  choose_layers(world, scene, survey, config, plan);
  list_sources(world, survey, plan);
  list_zones(world, survey, plan);
  plan.near_reach = find_reaches(world, survey, config, plan);
  find_near(plan.near_reach, plan.zones);
  find_off_mesh_links(config, plan.zones);
  return plan;
}

Result<void> find_node_inputs(const world::WorldData& world, const NodeScene& scene,
                              const NodeConfig& config, Context& context, NodePlan& plan) {
  const uint64_t common = common_input(world, config, plan);
  const bool needs_scene = plan.needs_triangles();
  for (const auto& zones : scene_parts(plan, scene, config.working_bytes)) {
    const auto region = scene.region(needs_scene ? box_around(plan, zones) : Box3d{}, context);
    if (!region) return region.error();
    const TriangleSquares* triangles =
        needs_scene ? &(*region)->triangles(config.workers) : nullptr;
    std::vector<std::optional<Error>> failed(zones.size());
    parallel_for(zones.size(), config.workers, [&](size_t i) {
      NodePlanZone& zone = plan.zones[zones[i]];
      const auto own = own_input(world, plan, zone, **region, triangles, common);
      if (own) {
        zone.own = *own;
      } else {
        failed[i] = own.error();
      }
    });
    for (const auto& failure : failed) {
      if (failure) return *failure;
    }
  }
  for (NodePlanZone& zone : plan.zones) {
    Words words;
    for (const uint32_t near : zone.near) words.add(plan.zones[near].own);
    for (const uint32_t j : zone.off_mesh_links) {
      const NodeOffMeshLink& off_mesh_link = config.off_mesh_links[j];
      words.add(off_mesh_link.from);
      words.add(off_mesh_link.to);
      words.add(uint64_t{static_cast<uint32_t>(off_mesh_link.avatar_class)} << 1 |
                uint64_t{off_mesh_link.two_way});
    }
    zone.input = words.hash();
  }
  return {};
}

namespace {

uint64_t sum_of_bytes(const NodePlan& plan, std::span<const uint32_t> zones) {
  uint64_t sum = 0;
  for (const uint32_t z : zones) sum += plan.zones[z].bytes;
  return sum;
}

}  // namespace

std::vector<std::vector<uint32_t>> node_batches(const NodePlan& plan, const NodeScene& scene,
                                                std::vector<uint32_t> zones, uint64_t max_bytes) {
  const bool reads = !scene.is_whole() && plan.needs_triangles();
  BatchSplitter splitter(
      plan,
      [&](std::span<const uint32_t> part) {
        if (!reads) return sum_of_bytes(plan, part);
        // The triangles of all are there while cells are judged.
        const auto seen = with_near_zones(plan, part);
        return sum_of_bytes(plan, seen) + scene.region_bytes(box_around(plan, seen));
      },
      max_bytes);
  splitter.split(std::move(zones));
  return splitter.take();
}

uint64_t all_working_bytes(const NodePlan& plan) {
  uint64_t sum = 0;
  for (const NodePlanZone& zone : plan.zones) sum += zone.bytes;
  return sum;
}

uint64_t batch_working_bytes(const NodePlan& plan, std::span<const uint32_t> batch) {
  return sum_of_bytes(plan, with_near_zones(plan, batch));
}

}  // namespace throng::bake
