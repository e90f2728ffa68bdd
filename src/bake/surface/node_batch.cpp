// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/node_batch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "bake/surface/node_drops.h"
#include "bake/surface/node_file.h"
#include "bake/surface/object_ground.h"
#include "bake/surface/patch_links.h"
#include "core/access.h"
#include "core/arrays/release.h"
#include "core/parallel.h"
#include "graph/node_bins.h"
#include "graph/node_width.h"
#include "graph/patch_pairs.h"
#include "graph/tile_cells.h"
#include "world/place.h"
#include "world/region_data.h"
#include "world/tile_grid.h"

// What decides is per cell and class; everything after that only groups cells, so it is the same
// for Bezier patches and level tiles.
namespace throng::bake {
namespace {

static_assert(graph::kPartialLevel + graph::kPartialDepth == graph::kTileDepth);

// Cells between which a body goes straight though they do not touch.
struct HoleLink {
  uint32_t from_patch = 0, from_cell = 0, to_patch = 0, to_cell = 0;
};

class NodeBatch {
 public:
  NodeBatch(const NodeBatchInput& input, std::span<const uint32_t> zones)
      : world_(input.world),
        data_(*data_of(input.world)),
        region_(input.region),
        scene_(region_.scene()),
        config_(input.config),
        context_(input.context),
        bins_(input.bins),
        plan_(input.plan),
        triangles_(plan_.needs_triangles() ? &region_.triangles(config_.workers) : nullptr),
        store_(input.store),
        is_last_(input.is_last),
        made_(zones),
        zone_places_(with_near_zones(plan_, zones)) {}

  Result<void> check_off_mesh_links() {
    if (auto ok = list_patches(); !ok) return ok.error();
    judge_patches();
    find_objects();
    if (context_.cancel) return cancelled();
    return add_off_mesh_links();
  }

  Result<NodeSlots> run() {
    if (auto ok = list_patches(); !ok) return ok.error();
    judge_patches();
    find_objects();
    if (context_.cancel) return cancelled();
    find_linked();
    grow_trees();
    if (forest_.size() >= graph::kFarNode) return too_many_nodes();
    find_pairs();
    if (context_.cancel) return cancelled();
    add_drops();
    if (auto ok = add_off_mesh_links(); !ok) return ok.error();
    if (context_.cancel) return cancelled();
    if (is_last_) {  // They are not needed again, and links need the memory.
      triangles_ = nullptr;
      region_.release_triangles();
    }
    link();
    measure();
    if (context_.cancel) return cancelled();
    return pack();
  }

 private:
  static Error cancelled() { return {Errc::kCancelled, "nodes: cancelled"}; }

  Result<void> list_patches() {
    bezier_.assign(plan_.has_patches ? scene_.patches.size() : 0, graph::kNoNode);
    level_.assign(plan_.has_tiles ? data_.level_count : 0, graph::kNoNode);
    for (const uint32_t z : zone_places_) {
      const NodePlanZone& zone = plan_.zones[z];
      begins_.push_back(sources_.size());
      for (uint32_t s = zone.first; s < zone.last; ++s) {
        PatchSource source = plan_.sources[s];
        if (source.kind == PatchKind::kBezier) {
          source.source = region_.patch_of(source.source);
          if (source.source == kNoPatch) return region_lacks_patch(plan_.sources[s].source);
        }
        const auto place = static_cast<uint32_t>(sources_.size());
        (source.kind == PatchKind::kBezier ? bezier_ : level_)[source.source] = place;
        if (source.kind == PatchKind::kLevelTile) levels_.push_back(source.source);
        sources_.push_back(source);
      }
      const int32_t slot = zone.has_tiles ? world::slot_at(data_, zone.x, zone.z) : -1;
      if (slot < 0) continue;
      slots_.push_back(static_cast<size_t>(slot));
      if (data_.zone(slots_.back()) == nullptr) {
        return Error{Errc::kBadFile, data_.slots[slots_.back()]->error};
      }
    }
    begins_.push_back(sources_.size());
    is_made_.assign(sources_.size(), 0);
    for (size_t z = 0; z < zone_places_.size(); ++z) {
      if (!std::binary_search(made_.begin(), made_.end(), zone_places_[z])) continue;
      std::fill(is_made_.begin() + static_cast<ptrdiff_t>(begins_[z]),
                is_made_.begin() + static_cast<ptrdiff_t>(begins_[z + 1]), uint8_t{1});
    }
    return {};
  }

  void judge_patches() {
    if (!plan_.has_patches) return;
    cells_.resize(scene_.patches.size());
    std::vector<uint8_t> blocked(cells_.size(), 0);
    for (size_t t = 0; t < scene_.patch_of_triangle.size(); ++t) {
      const uint32_t p = scene_.patch_of_triangle[t];
      if (p != kNoPatch && scene_.area[t] == kAreaBlocked) blocked[p] = 1;
    }
    std::vector<PatchJudge> judges(
        static_cast<size_t>(worker_count(config_.workers)),
        PatchJudge(*triangles_, data_.summary.classes, bins_, config_.size));
    parallel_for_worker(cells_.size(), config_.workers, [&](size_t p, int32_t worker) {
      if (context_.cancel || bezier_[p] == graph::kNoNode) return;
      const auto patch = static_cast<uint32_t>(p);
      if (store_ != nullptr && store_->read(region_, patch, cells_[p])) return;
      cells_[p] = judges[static_cast<size_t>(worker)].judge(patch);
      for (graph::Promise& cell : cells_[p].promise.cells) {
        cell.classes = blocked[p] != 0 ? uint16_t{0} : cell.classes & plan_.on_patches;
      }
      if (store_ != nullptr) store_->keep(region_, patch, cells_[p]);
    });
  }

  // Of a zone that is only near, the links count of those patches alone that lie near made zones.
  void find_linked() {
    is_linked_.assign(cells_.size(), 0);
    parallel_for(cells_.size(), config_.workers, [&](size_t p) {
      if (bezier_[p] == graph::kNoNode) return;
      Box3d box;
      for (const graph::CellShape& cell : cells_[p].shape) {
        const Vec3d middle = cell.middle(cells_[p].origin);
        const Vec3d out = Vec3d{1, 0, 1} * (double{cell.radius} + plan_.near_reach);
        box.add(middle - out);
        box.add(middle + out);
      }
      const bool is_near = std::any_of(made_.begin(), made_.end(), [&](uint32_t z) {
        const Box3d& zone = plan_.zones[z].box;
        return box.min.x <= zone.max.x && box.max.x >= zone.min.x && box.min.z <= zone.max.z &&
               box.max.z >= zone.min.z;
      });
      is_linked_[p] = is_near || is_made_[bezier_[p]] != 0 ? 1 : 0;
    });
  }

  // The cells of level tiles that are not a patch's ground, if that is most of the ground.
  void find_objects() {
    if (!plan_.has_objects) return;
    std::sort(levels_.begin(), levels_.end());
    objects_.resize(levels_.size());
    parallel_for(levels_.size(), config_.workers, [&](size_t i) {
      if (context_.cancel) return;
      objects_[i] = {levels_[i], find_object_cells(*triangles_, data_, levels_[i])};
    });
  }

  [[nodiscard]] graph::PatchCells cells_of_level(uint32_t level) const {
    graph::PatchCells cells = graph::tile_cells(world_, level, config_.classes, bins_);
    if (!plan_.has_objects) return cells;
    for (size_t i = 0; i < cells.cells.size(); ++i) {
      if (!is_object_cell(objects_, level, world::x_of_cell(i), world::z_of_cell(i))) {
        cells.cells[i].classes = 0;
      }
    }
    return cells;
  }

  // And links within each patch, while its cells are at hand: all of them would fill the memory.
  void grow_trees() {
    std::vector<graph::PatchTree> trees(sources_.size());
    inside_.resize(sources_.size());
    parallel_for(sources_.size(), config_.workers, [&](size_t p) {
      if (context_.cancel) return;
      const PatchSource& source = sources_[p];
      graph::PatchCells of_tile;
      if (source.kind != PatchKind::kBezier) of_tile = cells_of_level(source.source);
      const graph::PatchCells& cells =
          source.kind == PatchKind::kBezier ? cells_[source.source].promise : of_tile;
      graph::NodeForest alone;
      alone.add(graph::build_tree(cells));
      if (is_made_[p] != 0) {
        graph::NodeLinker linker(alone);
        linker.link_inside(0, cells);
        inside_[p] = linker.take();
      }
      trees[p] = std::move(alone.trees[0]);
    });
    forest_.first = {0};
    for (size_t p = 0; p < trees.size(); ++p) {
      for (graph::NodeLink& link : inside_[p]) {
        link.a += forest_.size();
        link.b += forest_.size();
      }
      forest_.add(std::move(trees[p]));
    }
    promises_.reserve(forest_.size());
    for (const graph::PatchTree& tree : forest_.trees) {
      for (const graph::PatchNode& node : tree.nodes) promises_.push_back(node.promise);
    }
  }

  void find_pairs() {
    const auto take = [&](std::vector<graph::CellPair> list, const std::vector<uint32_t>& of_a,
                          const std::vector<uint32_t>& of_b) {
      for (graph::CellPair& pair : list) {
        pair.patch_a = of_a[pair.patch_a];
        pair.patch_b = of_b[pair.patch_b];
        if (pair.patch_a == graph::kNoNode || pair.patch_b == graph::kNoNode)
          continue;  // Another zone's affair.
        if (pair.side_a == 4) {
          hole_links_.push_back({pair.patch_a, pair.cell_a, pair.patch_b, pair.cell_b});
          pair.hole_link1 = static_cast<uint32_t>(hole_links_.size());
        }
        pairs_.push_back(pair);
      }
    };
    if (plan_.has_patches) {
      const PatchLinkInput input = link_input();
      EdgeLinks edges = link_edges(input, config_.workers);
      doors_ = std::move(edges.doors);
      if (plan_.drops) edges_ = edges.pairs;
      take(std::move(edges.pairs), bezier_, bezier_);
      take(link_holes(input, config_.workers), bezier_, bezier_);
      if (plan_.has_tiles) {
        const auto carries = [&](const Place& place) { return is_carried(place); };
        take(link_tiles(input, carries, config_.workers), bezier_, level_);
      }
      if (plan_.has_objects) take(link_objects(input, objects_, config_.workers), bezier_, level_);
    }
    if (!plan_.has_tiles) return;
    std::vector<std::pair<int32_t, int32_t>> tiles;
    for (const size_t slot : slots_) {
      const auto& entry = data_.slots[slot]->entry;
      const auto side = static_cast<int32_t>(data_.tiles_per_zone);
      const int32_t end_x = std::min((entry.x() + 1) * side, data_.summary.tiles_x);
      const int32_t end_z = std::min((entry.z() + 1) * side, data_.summary.tiles_z);
      for (int32_t z = entry.z() * side; z < end_z; ++z) {
        for (int32_t x = entry.x() * side; x < end_x; ++x) {
          if (plan_.is_carrier(data_, x, z)) tiles.push_back({x, z});
        }
      }
    }
    std::vector<std::vector<graph::CellPair>> lists(tiles.size());
    parallel_for(lists.size(), config_.workers, [&](size_t i) {
      if (!context_.cancel) lists[i] = graph::tile_pairs(data_, tiles[i].first, tiles[i].second);
    });
    size_t count = pairs_.size();
    for (const auto& list : lists) count += list.size();
    pairs_.reserve(count);
    for (auto& list : lists) take(std::move(list), level_, level_);
  }

  [[nodiscard]] PatchLinkInput link_input() const {
    return {.triangles = triangles_,
            .world = &world_,
            .classes = data_.summary.classes,
            .cells = cells_,
            .size = config_.size,
            .is_linked = is_linked_};
  }

  void add_drops() {
    if (!plan_.drops) return;
    const DropInput input{.links = link_input(),
                          .edges = edges_,
                          .tiles = plan_.has_tiles,
                          .levels = levels_,
                          .has_objects = plan_.has_objects,
                          .objects = objects_,
                          .wanted = config_.classes};
    uint32_t wide = 1;  // [cells]
    while (wide < 8 && 2 * wide * data_.summary.cell <= 0.5) wide *= 2;
    for (const NodeDrop& drop : find_drops(input, config_.workers)) {
      const auto patch_of = [&](const DropEnd& end) {
        return (end.kind == PatchKind::kBezier ? bezier_ : level_)[end.source];
      };
      if (patch_of(drop.from) == graph::kNoNode || patch_of(drop.to) == graph::kNoNode) continue;
      // Of level tiles one every half metre will do.
      const bool on_tile = drop.from.kind == PatchKind::kLevelTile;
      const uint32_t block =
          drop.from.cell / kTileCells / wide * kTileCells + drop.from.cell % kTileCells / wide;
      hole_links_.push_back({patch_of(drop.from), drop.from.cell, patch_of(drop.to), drop.to.cell});
      pairs_.push_back({.patch_a = patch_of(drop.from),
                        .cell_a = drop.from.cell,
                        .patch_b = patch_of(drop.to),
                        .cell_b = drop.to.cell,
                        .classes = drop.classes,
                        .kind = LinkKind::kDrop,
                        .hole_link1 = static_cast<uint32_t>(hole_links_.size()),
                        .one_way = true,
                        .spot = on_tile ? block : drop.from.cell});
    }
  }

  // The cell nearest to a point, of those on which a class may stand within a metre.
  [[nodiscard]] std::optional<std::pair<uint32_t, uint32_t>> cell_near(int32_t avatar_class,
                                                                       Vec3d at) const {
    constexpr double kReach = 1;
    std::optional<std::pair<uint32_t, uint32_t>> best;
    double nearest = kReach * kReach;
    if (plan_.has_tiles) {
      const Place place = world_.find_place(avatar_class, at, kReach);
      if (place && level_[place.level1 - 1] != graph::kNoNode && is_carried(place)) {
        const world::GroundPoint p = world::to_ground(data_, place.position.x, place.position.z);
        best = {level_[place.level1 - 1],
                static_cast<uint32_t>(
                    world::cell_index(world::in_tile(p.cell_x()), world::in_tile(p.cell_z())))};
        nearest = (place.position.y - at.y) * (place.position.y - at.y);
      }
    }
    for (size_t patch = 0; patch < cells_.size(); ++patch) {
      for (size_t i = 0; i < cells_[patch].shape.size(); ++i) {
        const Vec3d d = cells_[patch].shape[i].middle(cells_[patch].origin) - at;
        const double far = dot(d, d);
        const uint16_t classes = cells_[patch].promise.cells[i].classes;
        if (far >= nearest || (classes >> avatar_class & 1) == 0) continue;
        nearest = far;
        best = {bezier_[patch], static_cast<uint32_t>(i)};
      }
    }
    return best;
  }

  // Do nodes of its level tile hold it?
  [[nodiscard]] bool is_carried(const Place& place) const {
    if (!plan_.has_objects) return true;
    const world::GroundPoint p = world::to_ground(data_, place.position.x, place.position.z);
    return is_object_cell(objects_, place.level1 - 1, world::in_tile(p.cell_x()),
                          world::in_tile(p.cell_z()));
  }

  // Does an off-mesh link begin and end in or near zones none of which is made here?
  [[nodiscard]] bool is_elsewhere(uint32_t off_mesh_link) const {
    bool is_near = false;
    for (uint32_t z = 0; z < plan_.zones.size(); ++z) {
      const auto& off_mesh_links = plan_.zones[z].off_mesh_links;
      if (!std::binary_search(off_mesh_links.begin(), off_mesh_links.end(), off_mesh_link))
        continue;
      if (std::binary_search(made_.begin(), made_.end(), z)) return false;
      is_near = true;
    }
    return is_near;
  }

  Result<void> add_off_mesh_links() {
    for (size_t j = 0; j < config_.off_mesh_links.size(); ++j) {
      const NodeOffMeshLink& off_mesh_link = config_.off_mesh_links[j];
      const auto& classes = data_.summary.classes;
      const auto bad = [&](const std::string& what) {
        return Error{Errc::kBadInput,
                     "nodes: off-mesh link " + std::to_string(j + 1) + ": " + what};
      };
      if (off_mesh_link.avatar_class < 0 ||
          static_cast<size_t>(off_mesh_link.avatar_class) >= classes.size()) {
        return bad("the world has no such avatar class");
      }
      if (is_elsewhere(static_cast<uint32_t>(j))) continue;
      const auto from = cell_near(off_mesh_link.avatar_class, off_mesh_link.from);
      const auto to = cell_near(off_mesh_link.avatar_class, off_mesh_link.to);
      if (!from || !to) {
        return bad(classes[static_cast<size_t>(off_mesh_link.avatar_class)].name +
                   " has no place within a metre of where it " + (from ? "ends" : "begins"));
      }
      hole_links_.push_back({from->first, from->second, to->first, to->second});
      pairs_.push_back({.patch_a = from->first,
                        .cell_a = from->second,
                        .patch_b = to->first,
                        .cell_b = to->second,
                        .classes = static_cast<uint16_t>(1u << off_mesh_link.avatar_class),
                        .kind = LinkKind::kOffMesh,
                        .hole_link1 = static_cast<uint32_t>(hole_links_.size()),
                        .one_way = !off_mesh_link.two_way});
    }
    return {};
  }

  void link() {
    // Where no walker stands, a link is a climb.
    double steepest = 0;
    for (const AvatarClass& avatar : data_.summary.classes) {
      steepest = std::max(steepest, avatar.max_slope);
    }
    const uint8_t code = bins_.inclination_code(steepest);
    const auto name_climbs = [&](std::vector<graph::NodeLink>& links) {
      bool changed = false;
      for (graph::NodeLink& l : links) {
        if (l.kind != LinkKind::kWalk || worst(l).inclination <= code) continue;
        l.kind = LinkKind::kClimb;
        changed = true;
      }
      if (changed) graph::merge_node_links(links);
    };
    parallel_for(sources_.size(), config_.workers, [&](size_t p) { name_climbs(inside_[p]); });
    across_ = link_across();
    name_climbs(across_);
  }

  // Pairs of different patches, in runs that are then merged two by two. A run drops a hole link
  // only for earlier ones that serve its classes, so what is left of all does not depend on the
  // runs.
  [[nodiscard]] std::vector<graph::NodeLink> link_across() const {
    constexpr size_t kRun = size_t{1} << 14;
    std::vector<std::vector<graph::NodeLink>> runs(pairs_.size() / kRun + 1);
    parallel_for(runs.size(), config_.workers, [&](size_t r) {
      graph::NodeLinker linker(forest_);
      const size_t end = std::min(pairs_.size(), (r + 1) * kRun);
      for (size_t i = r * kRun; i < end; ++i) linker.link(pairs_[i]);
      runs[r] = linker.take();
    });
    for (size_t step = 1; step < runs.size(); step *= 2) {
      parallel_for((runs.size() + 2 * step - 1) / (2 * step), config_.workers, [&](size_t k) {
        const size_t low = 2 * step * k, high = low + step;
        if (high >= runs.size()) return;
        runs[low].insert(runs[low].end(), runs[high].begin(), runs[high].end());
        release(runs[high]);
        graph::merge_node_links(runs[low]);
      });
    }
    return std::move(runs[0]);
  }

  [[nodiscard]] graph::Promise worst(const graph::NodeLink& l) const {
    return graph::both(promises_[l.a], promises_[l.b]);
  }

  void measure() {
    std::vector<std::pair<int32_t, int32_t>> tile_place(level_.size());
    for (const size_t s : slots_) {
      const world::Zone& zone = *data_.zone(s);
      for (uint32_t l = 0; l < zone.level_count(); ++l) {
        tile_place[data_.slots[s]->first_level + l] = world::tile_of(data_, zone, zone.level(l));
      }
    }
    std::vector<graph::CellBalls> balls;
    for (const PatchSource& source : sources_) {
      if (source.kind == PatchKind::kBezier) {
        const BezierCells& cells = cells_[source.source];
        balls.push_back({.listed = cells.shape, .origin = cells.origin});
        continue;
      }
      const auto [x, z] = tile_place[source.source];
      balls.push_back({.listed = {},
                       .origin = {},
                       .x = double{kTileCells} * x,
                       .z = double{kTileCells} * z,
                       .side = data_.summary.cell});
    }
    const graph::CrossCells cross(pairs_, sources_.size(), config_.workers);
    const double max_width = bins_.width.back();
    widths_.resize(forest_.trees.size());
    parallel_for(widths_.size(), config_.workers, [&](size_t p) {
      if (context_.cancel || is_made_[p] == 0) return;
      widths_[p] = graph::node_widths(forest_, static_cast<uint32_t>(p), cross, max_width, balls);
    });
  }

  [[nodiscard]] double area_of(const PatchSource& source, const graph::PatchTree& tree,
                               const graph::PatchNode& n) const {
    const int32_t size = 1 << (tree.depth - n.level);
    if (source.kind == PatchKind::kLevelTile) {
      const int32_t cells = n.cells != 0 ? std::popcount(n.cells) : size * size;
      return cells * data_.summary.cell * data_.summary.cell;
    }
    double area = 0;
    const BezierCells& cells = cells_[source.source];
    for (int32_t t = n.t * size; t < (n.t + 1) * size; ++t) {
      for (int32_t s = n.s * size; s < (n.s + 1) * size; ++s) {
        area += cells.shape[cells.promise.index(s, t)].area;
      }
    }
    return area;
  }

  Result<NodeSlots> pack() {
    std::vector<size_t> own;  // Of the zones that are seen those that are made.
    for (size_t z = 0; z < zone_places_.size(); ++z) {
      const NodePlanZone& zone = plan_.zones[zone_places_[z]];
      zones_.push_back({zone.x, zone.z, forest_.first[begins_[z]], forest_.first[begins_[z + 1]]});
      if (std::binary_search(made_.begin(), made_.end(), zone_places_[z])) own.push_back(z);
    }
    find_links_from_before();
    std::vector<std::optional<Error>> failed(own.size());
    NodeSlots packed(own.size());
    parallel_for(own.size(), config_.workers, [&](size_t i) {
      if (zones_[own[i]].first == zones_[own[i]].last) return;
      auto slot = pack_zone(own[i]);
      if (!slot) {
        failed[i] = slot.error();
      } else {
        packed[i] = std::move(*slot);
      }
    });
    for (const auto& failure : failed) {
      if (failure) return *failure;
    }
    return packed;
  }

  // By zone the links across patches whose larger end lies in it and whose smaller end does not.
  void find_links_from_before() {
    from_before_.resize(zones_.size());
    size_t z = 0;  // Zone of the smaller end: links are sorted by it.
    for (size_t l = 0; l < across_.size(); ++l) {
      while (across_[l].a >= zones_[z].last) ++z;
      if (across_[l].b >= zones_[z].last) from_before_[zone_of(across_[l].b)].push_back(l);
    }
  }

  [[nodiscard]] size_t zone_of(uint32_t node) const {
    const auto after = std::upper_bound(zones_.begin(), zones_.end(), node,
                                        [](uint32_t n, const ZoneRange& r) { return n < r.last; });
    return static_cast<size_t>(after - zones_.begin());
  }

  // All links with an end in a zone.
  [[nodiscard]] std::vector<graph::NodeLink> links_of(size_t z) const {
    const ZoneRange& zone = zones_[z];
    const auto first_from = [&](uint32_t node) {
      return std::lower_bound(across_.begin(), across_.end(), node,
                              [](const graph::NodeLink& l, uint32_t n) { return l.a < n; });
    };
    const auto begin = first_from(zone.first), end = first_from(zone.last);
    size_t count = from_before_[z].size() + static_cast<size_t>(end - begin);
    for (size_t p = begins_[z]; p < begins_[z + 1]; ++p) count += inside_[p].size();
    std::vector<graph::NodeLink> links;
    links.reserve(count);
    for (const size_t l : from_before_[z]) links.push_back(across_[l]);
    links.insert(links.end(), begin, end);
    for (size_t p = begins_[z]; p < begins_[z + 1]; ++p) {
      links.insert(links.end(), inside_[p].begin(), inside_[p].end());
    }
    graph::merge_node_links(links);
    return links;
  }

  Result<std::unique_ptr<graph::NodeData::Slot>> pack_zone(size_t z) const {
    const ZoneRange& zone = zones_[z];
    const ZoneArcs arcs = arcs_of(links_of(z), zone);
    const int32_t slot = world::slot_at(data_, zone.x, zone.z);
    const uint32_t first_level = slot < 0 ? 0 : data_.slots[static_cast<size_t>(slot)]->first_level;
    ZoneContent content;
    content.x = zone.x;
    content.z = zone.z;
    for (size_t p = begins_[z]; p < begins_[z + 1]; ++p) {
      const PatchSource& source = sources_[p];
      const graph::PatchTree& tree = forest_.trees[p];
      if (tree.nodes.empty()) continue;
      const uint32_t first = forest_.first[p] - zone.first;
      const bool bezier = source.kind == PatchKind::kBezier;
      content.patches.emplace_back(
          static_cast<uint8_t>(source.kind), static_cast<uint8_t>(tree.depth), first,
          static_cast<uint32_t>(tree.nodes.size()),
          bezier ? region_.number_of(source.source) : source.source - first_level,
          bezier ? static_cast<uint32_t>(content.points.size()) : 0);
      if (bezier) {
        for (const Vec3d& point : scene_.patches.patches[source.source].points) {
          content.points.insert(content.points.end(), {point.x, point.y, point.z});
        }
        add_doors(source.source, zone, content);
      }
      for (size_t n = 0; n < tree.nodes.size(); ++n) {
        const graph::PatchNode& node = tree.nodes[n];
        const uint32_t id = forest_.first[p] + static_cast<uint32_t>(n);
        const uint8_t width = bins_.width_code(widths_[p][n]);
        if (node.cells != 0) {
          content.partial.emplace_back(static_cast<uint32_t>(content.nodes.size()),
                                       static_cast<uint32_t>(node.cells),
                                       static_cast<uint32_t>(node.cells >> 32));
        }
        content.nodes.emplace_back(
            node.promise.classes, node.level, node.s, node.t,
            static_cast<uint8_t>(node.promise.inclination << 4 | node.promise.height),
            static_cast<uint8_t>(node.promise.headroom << 4 | width),
            static_cast<uint8_t>((node.terminal ? graph::kTerminalFlag : 0) |
                                 (node.cells != 0 ? graph::kPartialFlag : 0)),
            node.parent == graph::kNoNode ? UINT32_MAX : first + node.parent,
            static_cast<float>(area_of(source, tree, node)),
            static_cast<uint32_t>(content.arcs.size()));
        for (const ArcRecord& arc : arcs.of(id - zone.first)) {
          if (arc.hole_link1 != 0) add_hole_link(arc, content);
          const graph::Promise least = worst({.a = arc.from, .b = arc.to});
          content.arcs.emplace_back(target(arc.to, zone, content), arc.classes,
                                    static_cast<uint8_t>(arc.kind),
                                    static_cast<uint8_t>(least.inclination << 4 | least.height));
        }
      }
    }
    return node_slot(content);
  }

  // The doors of the patch that was written last.
  void add_doors(uint32_t patch, const ZoneRange& zone, ZoneContent& content) const {
    const auto of = [](const PatchDoor& door, uint32_t p) { return door.patch < p; };
    for (auto door = std::lower_bound(doors_.begin(), doors_.end(), patch, of);
         door != doors_.end() && door->patch == patch; ++door) {
      content.doors.emplace_back(static_cast<uint32_t>(content.patches.size() - 1),
                                 target(forest_.first[bezier_[door->to_patch]], zone, content),
                                 door->classes, door->edge, door->to_edge, door->first, door->last,
                                 door->to_first, door->to_last);
    }
  }

  void add_hole_link(const ArcRecord& arc, ZoneContent& content) const {
    HoleLink hole_link = hole_links_[arc.hole_link1 - 1];
    if (arc.backward)
      hole_link = {hole_link.to_patch, hole_link.to_cell, hole_link.from_patch,
                   hole_link.from_cell};
    const auto part = [&](uint32_t patch, uint32_t cell) {
      const int32_t depth = forest_.trees[patch].depth;
      return std::pair{static_cast<uint8_t>(cell & ((1u << depth) - 1)),
                       static_cast<uint8_t>(cell >> depth)};
    };
    const auto [from_s, from_t] = part(hole_link.from_patch, hole_link.from_cell);
    const auto [to_s, to_t] = part(hole_link.to_patch, hole_link.to_cell);
    content.hole_links.emplace_back(static_cast<uint32_t>(content.arcs.size()), from_s, from_t,
                                    to_s, to_t);
  }

  // An arc's end as the zone writes it.
  uint32_t target(uint32_t node, const ZoneRange& zone, ZoneContent& content) const {
    if (node >= zone.first && node < zone.last) return node - zone.first;
    const ZoneRange& other = zones_[zone_of(node)];
    return content.far_node({other.x, other.z, node - other.first});
  }

  const World& world_;
  const world::WorldData& data_;
  NodeRegion& region_;
  const Scene& scene_;  // the region's
  const NodeConfig& config_;
  Context& context_;
  const NodeBins& bins_;
  const NodePlan& plan_;
  const TriangleSquares* triangles_;  // null: not needed, or not again
  CellStore* const store_;            // may be null
  const bool is_last_;
  const std::span<const uint32_t> made_;     // zones of the plan, ascending
  const std::vector<uint32_t> zone_places_;  // zones that are seen: these and those near
  std::vector<BezierCells> cells_;           // by Bezier patch of the region
  std::vector<PatchSource> sources_;         // patches of the forest, by numbers of the region
  std::vector<uint8_t> is_made_;             // by patch of the forest: of a zone that is made
  std::vector<uint8_t> is_linked_;           // by Bezier patch: near such a zone
  std::vector<uint32_t> bezier_, level_;     // where they are in the forest, or kNoNode
  std::vector<uint32_t> levels_;             // those of the forest
  std::vector<ObjectLevel> objects_;         // of these the cells that carry nodes, if not all do
  std::vector<size_t> slots_;                // of the world, whose levels these are
  graph::NodeForest forest_;
  std::vector<graph::Promise> promises_;        // by node
  std::vector<graph::CellPair> pairs_, edges_;  // (those over Bezier edges again, for drops)
  std::vector<PatchDoor> doors_;                // by patch of the region
  std::vector<HoleLink> hole_links_;
  std::vector<std::vector<graph::NodeLink>> inside_;  // links by patch of the forest
  std::vector<graph::NodeLink> across_;               // all others
  std::vector<std::vector<double>> widths_;
  std::vector<ZoneRange> zones_;  // that are seen
  std::vector<size_t> begins_;    // first patch of each, and the end
  std::vector<std::vector<size_t>> from_before_;
};

}  // namespace

Error too_many_nodes() {
  return {Errc::kLimit, "nodes: more than 2^31 nodes; use a larger cell or node size"};
}

Result<NodeSlots> make_node_batch(const NodeBatchInput& input, std::span<const uint32_t> zones) {
  return NodeBatch(input, zones).run();
}

Result<void> check_batch_links(const NodeBatchInput& input, std::span<const uint32_t> zones) {
  return NodeBatch(input, zones).check_off_mesh_links();
}

}  // namespace throng::bake
