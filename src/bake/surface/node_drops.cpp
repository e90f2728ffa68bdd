// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/node_drops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "bake/surface/body_sweep.h"
#include "core/access.h"
#include "core/parallel.h"
#include "graph/ground_parts.h"
#include "graph/node_data.h"
#include "graph/node_width.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Finds drop links: from each node's rim out over the edge and down to the ground below. A body
// that moves level and upright sweeps a prism over a stadium, one that falls a cylinder: both are
// compared with the triangles as they are, so nothing is lost to growth between poses. Only a body
// that has to turn, a climber on a Bezier patch, is proved pose by pose.
namespace throng::bake {
namespace {

constexpr double kNear2 = 1e8;
constexpr double kUpright = 1 - 1e-12;  // of an axis' height

// Where a class may stand.
struct Spot {
  DropEnd end;
  Vec3d feet;
  Vec3d axis{0, 1, 0};

  [[nodiscard]] bool upright() const { return axis.y >= kUpright; }
};

// Places of one class on Bezier patches on which it could also stand upright, by squares.
class BezierSpots {
 public:
  BezierSpots(const DropInput& input, const PatchBody& body, const AvatarClass& avatar, double side)
      : side_(side) {
    const PatchSet& set = input.links.triangles->scene().patches;
    const double gentle =
        std::round(std::cos(avatar.max_slope * std::numbers::pi / 180) * 1e9) / 1e9;
    for (uint32_t p = 0; p < input.links.cells.size(); ++p) {
      const graph::PatchCells& cells = input.links.cells[p].promise;
      const double cells_along = 1 << cells.depth;
      for (uint32_t i = 0; i < cells.cells.size(); ++i) {
        if ((cells.cells[i].classes & body.bit) == 0) continue;
        const double s = ((i & ((1u << cells.depth) - 1)) + 0.5) / cells_along;
        const double t = ((i >> cells.depth) + 0.5) / cells_along;
        const Vec3d normal = set.patches[p].normal(s, t);
        if (normal.y < gentle) continue;
        const Vec3d feet = set.patches[p].at(s, t);
        squares_[square(feet.x, feet.z)].push_back(static_cast<uint32_t>(spots_.size()));
        spots_.push_back({{PatchKind::kBezier, p, i}, feet, body.climbs ? normal : Vec3d{0, 1, 0}});
      }
    }
  }

  [[nodiscard]] const std::vector<Spot>& all() const { return spots_; }

  template <class Visit>
  void for_each_near(Vec3d at, Visit visit) const {
    const auto [x, z] = square(at.x, at.z);
    for (int64_t j = z - 1; j <= z + 1; ++j) {
      for (int64_t i = x - 1; i <= x + 1; ++i) {
        const auto found = squares_.find({i, j});
        if (found == squares_.end()) continue;
        for (const uint32_t spot : found->second) visit(spots_[spot]);
      }
    }
  }

 private:
  [[nodiscard]] std::pair<int64_t, int64_t> square(double x, double z) const {
    return {static_cast<int64_t>(std::floor(x / side_)),
            static_cast<int64_t>(std::floor(z / side_))};
  }

  double side_;  // at least as long as a drop leads sideways [m]
  std::vector<Spot> spots_;
  std::map<std::pair<int64_t, int64_t>, std::vector<uint32_t>> squares_;
};

// One class's drops from one place after the other. One per thread: owns scratch memory.
class DropFinder {
 public:
  DropFinder(const DropInput& input, const BezierSpots& patches, size_t avatar_class,
             const PatchBody& body)
      : input_(input),
        patches_(patches),
        world_(*data_of(*input.links.world)),
        ground_{world_, static_cast<int32_t>(avatar_class)},
        avatar_(input.links.classes[avatar_class]),
        body_(body),
        step_(world::step_mm(avatar_)),
        bottom_(body_bottom(avatar_)),
        motion_(*input.links.triangles) {}

  void drop_from_patch(const Spot& from, std::vector<NodeDrop>& out) {
    if (const auto to = lower_place(from, nullptr)) out.push_back({from.end, to->end, body_.bit});
  }

  void drop_from_level(uint32_t level, std::vector<NodeDrop>& out) {
    const world::GroundLevel ground = world::ground_level(world_, level, ground_.avatar_class);
    if (ground.zone == nullptr || ground.kind == format::CellsKind::None) return;
    const world::CellRows legal = graph::legal_rows(ground);
    const auto [tile_x, tile_z] = world::tile_of(world_, *ground.zone, *ground.view.record);
    for (int32_t z = 0; z < kTileCells; ++z) {
      for (int32_t x = 0; x < kTileCells; ++x) {
        if ((legal[static_cast<size_t>(z)] >> x & 1) == 0 || !carries(level, x, z)) continue;
        const int32_t gx = world::first_cell(tile_x) + x, gz = world::first_cell(tile_z) + z;
        if (!is_edge(ground, gx, gz)) continue;
        const Spot from = spot_on(ground, gx, gz);
        if (const auto to = lower_place(from, &ground)) {
          out.push_back({from.end, to->end, body_.bit});
        }
      }
    }
  }

 private:
  struct Lower {
    int64_t far2 = 0;  // in the plane [m^2 / kNear2]: as far is as far, whatever is rounded
    Spot spot;
  };

  // Does a level tile carry nodes there?
  [[nodiscard]] bool carries(uint32_t level, int32_t x, int32_t z) const {
    return !input_.has_objects || is_object_cell(input_.objects, level, x, z);
  }

  static world::GroundPoint middle_of(int32_t x, int32_t z) {
    constexpr int64_t kMiddle = world::kUnitsPerCell / 2;
    return {(int64_t{x} << world::kUnitBits) + kMiddle, (int64_t{z} << world::kUnitBits) + kMiddle};
  }

  [[nodiscard]] Spot spot_on(const world::GroundLevel& level, int32_t x, int32_t z) const {
    return {{PatchKind::kLevelTile, level.world_level,
             static_cast<uint32_t>(world::cell_index(world::in_tile(x), world::in_tile(z)))},
            world::place_at(world_, level, middle_of(x, z)).position};
  }

  // Is there a side over which the class cannot step and come back?
  [[nodiscard]] bool is_edge(const world::GroundLevel& level, int32_t x, int32_t z) const {
    constexpr std::array<std::array<int32_t, 2>, 4> kBeside = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    return std::any_of(kBeside.begin(), kBeside.end(), [&](const auto& d) {
      const int32_t i = x + d[0], j = z + d[1];
      if (i < 0 || j < 0) return true;
      const auto to = world::step_to(ground_, level, x, z, i, j, step_);
      if (!to) return true;
      const auto back = world::step_to(ground_, *to, i, j, x, z, step_);
      return !back || back->world_level != level.world_level;
    });
  }

  void consider(const Spot& from, const Spot& to, double reach) {
    const double dx = to.feet.x - from.feet.x, dz = to.feet.z - from.feet.z;
    const double far2 = dx * dx + dz * dz, down = from.feet.y - to.feet.y;
    if (far2 > reach * reach || !(down > avatar_.step_height && down <= avatar_.max_drop)) return;
    lower_.push_back({std::llround(far2 * kNear2), to});
  }

  // The place that a body drops to. `level`: of a place on a level tile.
  [[nodiscard]] std::optional<Spot> lower_place(const Spot& from, const world::GroundLevel* level) {
    lower_.clear();
    const double cell = world_.summary.cell;
    const double far = drop_reach(avatar_, std::max(cell, input_.links.size));
    const double on_tiles = level != nullptr ? drop_reach(avatar_, cell) : far;
    if (input_.tiles) tiles_near(from, on_tiles);
    patches_.for_each_near(from.feet, [&](const Spot& to) { consider(from, to, far); });
    if (lower_.empty()) return std::nullopt;
    std::sort(lower_.begin(), lower_.end(), [](const Lower& a, const Lower& b) {
      return std::tie(a.far2, a.spot.end) < std::tie(b.far2, b.spot.end);
    });
    near_found_ = false;
    for (const Lower& lower : lower_) {
      if (!is_free(from, lower.spot)) continue;
      if (level == nullptr || !walks_to(*level, from, lower.spot)) return lower.spot;
    }
    return std::nullopt;
  }

  void tiles_near(const Spot& from, double reach) {
    const double cell = world_.summary.cell;
    const auto range = [&](double at, double origin, int32_t cells) {
      const double middle = (at - origin) / cell, more = reach / cell + 1;
      return std::pair{static_cast<int32_t>(std::clamp(middle - more, 0.0, cells - 1.0)),
                       static_cast<int32_t>(std::clamp(middle + more, 0.0, cells - 1.0))};
    };
    const auto columns = range(from.feet.x, world_.summary.origin.x, world_.width);
    const auto rows = range(from.feet.z, world_.summary.origin.z, world_.depth);
    const int32_t x0 = columns.first, x1 = columns.second, z0 = rows.first, z1 = rows.second;
    for (int32_t tile_z = world::tile_along(z0); tile_z <= world::tile_along(z1); ++tile_z) {
      for (int32_t tile_x = world::tile_along(x0); tile_x <= world::tile_along(x1); ++tile_x) {
        ground_.for_tile(tile_x, tile_z, 0, 0, [&](const world::GroundLevel& level) {
          if (level.kind == format::CellsKind::None) return;
          for (int32_t z = std::max(z0, world::first_cell(tile_z));
               z <= std::min(z1, world::last_cell(tile_z)); ++z) {
            for (int32_t x = std::max(x0, world::first_cell(tile_x));
                 x <= std::min(x1, world::last_cell(tile_x)); ++x) {
              if (!level.is_legal(world::in_tile(x), world::in_tile(z))) continue;
              if (!carries(level.world_level, world::in_tile(x), world::in_tile(z))) continue;
              // Feet in the middle of a cell are at its sample.
              const double down =
                  from.feet.y - level.view.sample(world::in_tile(x), world::in_tile(z)) * 1e-3;
              if (!(down > avatar_.step_height && down <= avatar_.max_drop)) continue;
              consider(from, spot_on(level, x, z), reach);
            }
          }
        });
      }
    }
  }

  [[nodiscard]] bool walks_to(const world::GroundLevel& level, const Spot& from,
                              const Spot& to) const {
    if (to.end.kind != PatchKind::kLevelTile) return false;
    const auto point = [&](const Spot& spot) {
      const world::GroundPoint p = world::to_ground(world_, spot.feet.x, spot.feet.z);
      return middle_of(p.cell_x(), p.cell_z());
    };
    world::GroundLevel at = level;
    return world::walk(ground_, at, point(from), point(to), step_) &&
           at.world_level == to.end.source;
  }

  // Corners as seen from the place where the drop begins, heights last.
  void gather(Vec3d from) {
    const double cell = std::max(world_.summary.cell, input_.links.size);
    const double side = drop_reach(avatar_, cell) + avatar_.radius;
    Box3d box;
    box.add(from - Vec3d{side, avatar_.max_drop, side});
    box.add(from + Vec3d{side, avatar_.height, side});
    found_.clear();
    input_.links.triangles->find(box, found_);
    near_.clear();
    for (const uint32_t triangle : found_) {
      LocalTriangle local = input_.links.triangles->corners(triangle);
      for (Vec3d& p : local) {
        p = {p.x - from.x, p.z - from.z, p.y - from.y};
      }
      near_.push_back(local);
    }
    near_found_ = true;
  }

  [[nodiscard]] bool is_free(const Spot& from, const Spot& to) {
    const bool on_tiles =
        from.end.kind == PatchKind::kLevelTile && to.end.kind == PatchKind::kLevelTile;
    if (!body_.climbs || on_tiles) {
      // Where a climber walks it is a walker.
      return is_free_upright(from.feet, to.feet, bottom_);
    }
    if (from.upright() && to.upright()) return is_free_upright(from.feet, to.feet, body_.bottom);
    const BodyPose over{{to.feet.x, from.feet.y, to.feet.z}, {0, 1, 0}};
    return motion_.is_free(body_, {from.feet, from.axis}, over) &&
           motion_.is_free(body_, over, {to.feet, to.axis});
  }

  [[nodiscard]] bool is_free_upright(Vec3d from, Vec3d to, double bottom) {
    if (!near_found_) gather(from);
    const Vec3d along{to.x - from.x, to.z - from.z, 0};
    const BodySweep out{.radius = avatar_.radius, .low = bottom, .high = avatar_.height};
    const BodySweep down{
        .radius = avatar_.radius, .low = to.y - from.y + bottom, .high = avatar_.height};
    for (size_t i = 0; i < near_.size(); ++i) {
      LocalTriangle below = near_[i];
      for (Vec3d& p : below) p = p - along;
      if (lowest_entry(below, down) == kNever && !enters_on_move(near_[i], out, along)) continue;
      std::swap(near_[0], near_[i]);  // What stops one stops the next, mostly.
      return false;
    }
    return true;
  }

  const DropInput& input_;
  const BezierSpots& patches_;
  const world::WorldData& world_;
  world::WorldGround ground_;
  const AvatarClass& avatar_;
  PatchBody body_;
  int32_t step_;   // [mm]
  double bottom_;  // where it walks [m]
  MotionJudge motion_;
  std::vector<Lower> lower_;
  std::vector<uint32_t> found_;
  std::vector<LocalTriangle> near_;
  bool near_found_ = false;  // for the current place
};

// Is there a side of a patch's cell over which the class has no neighbour?
bool is_patch_edge(const DropInput& input, const graph::CrossCells& cross, const DropEnd& at,
                   uint16_t bit) {
  const graph::PatchCells& cells = input.links.cells[at.source].promise;
  const int32_t side = cells.side();
  const int32_t s = static_cast<int32_t>(at.cell) % side, t = static_cast<int32_t>(at.cell) / side;
  constexpr std::array<std::array<int32_t, 2>, 4> kBeside = {{{-1, 0}, {0, 1}, {1, 0}, {0, -1}}};
  const auto beyond = cross.beside(at.source, at.cell);
  for (uint8_t edge = 0; edge < 4; ++edge) {
    const int32_t i = s + kBeside[edge][0], j = t + kBeside[edge][1];
    if (i >= 0 && j >= 0 && i < side && j < side) {
      if ((cells.cells[cells.index(i, j)].classes & bit) == 0) return true;
    } else if (std::none_of(beyond.begin(), beyond.end(), [&](const graph::CrossCells::Cell& next) {
                 return next.side == edge && (next.classes & bit) != 0;
               })) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<NodeDrop> find_drops(const DropInput& input, int32_t workers) {
  const world::WorldData& world = *data_of(*input.links.world);
  const std::vector<PatchBody> bodies = patch_bodies(input.links.classes);
  const graph::CrossCells cross(input.edges, input.links.cells.size(), workers);
  std::vector<NodeDrop> drops;
  for (size_t c = 0; c < bodies.size(); ++c) {
    const AvatarClass& avatar = input.links.classes[c];
    if (!(avatar.max_drop > 0) || (input.wanted & bodies[c].bit) == 0) continue;
    const double far = drop_reach(avatar, std::max(world.summary.cell, input.links.size));
    const BezierSpots patches(input, bodies[c], avatar, far);
    const auto levels = input.tiles ? input.levels : std::span<const uint32_t>();
    std::vector<DropFinder> finders(static_cast<size_t>(worker_count(workers)),
                                    DropFinder(input, patches, c, bodies[c]));
    std::vector<std::vector<NodeDrop>> lists(patches.all().size() + levels.size());
    parallel_for_worker(lists.size(), workers, [&](size_t i, int32_t worker) {
      DropFinder& finder = finders[static_cast<size_t>(worker)];
      if (i >= patches.all().size()) {
        finder.drop_from_level(levels[i - patches.all().size()], lists[i]);
        return;
      }
      const Spot& from = patches.all()[i];
      if (!input.links.links(from.end.source)) return;
      if (is_patch_edge(input, cross, from.end, bodies[c].bit)) {
        finder.drop_from_patch(from, lists[i]);
      }
    });
    for (const auto& list : lists) drops.insert(drops.end(), list.begin(), list.end());
  }
  const auto key = [](const NodeDrop& d) { return std::tie(d.from, d.to); };
  std::stable_sort(drops.begin(), drops.end(),
                   [&](const NodeDrop& a, const NodeDrop& b) { return key(a) < key(b); });
  size_t kept = 0;
  for (const NodeDrop& drop : drops) {
    if (kept > 0 && key(drops[kept - 1]) == key(drop)) {
      drops[kept - 1].classes |= drop.classes;
    } else {
      drops[kept++] = drop;
    }
  }
  drops.resize(kept);
  return drops;
}

}  // namespace throng::bake
