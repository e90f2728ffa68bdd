// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/object_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "core/access.h"
#include "core/parallel.h"
#include "graph/ground_parts.h"
#include "world/ground.h"
#include "world/place.h"

// The world of [PACS00] is patches and objects. A patch carries every class on its own surface, and
// objects block the parts of it that they touch; what lies on an object is level tiles' ground.
namespace throng::bake {
namespace {

constexpr double kSameHeight = 0.03;  // [m] between a floor and the triangle that it is on
constexpr double kOnEdge = 1e-9;      // share of a triangle that counts as inside
constexpr double kLinkSpacing = 0.5;  // [m] between links onto one object, about
constexpr size_t kMaxCandidates = 6;  // cells of patches that are tried for one link
constexpr double kSquare = 16;        // [m] side of the squares by which patches are found

bool is_of_patch(const Scene& scene, size_t triangle) {
  return !scene.patch_of_triangle.empty() && scene.patch_of_triangle[triangle] != kNoPatch;
}

std::array<Vec3d, 3> corners_of(const Scene& scene, size_t triangle) {
  const std::array<uint32_t, 3>& t = scene.triangles[triangle];
  return {scene.positions[t[0]], scene.positions[t[1]], scene.positions[t[2]]};
}

// Heights of a triangle above points of the plan; none beside it, or if it is upright.
class PlanTriangle {
 public:
  explicit PlanTriangle(const LocalTriangle& corners)
      : a_(corners[0]), u_(corners[1] - corners[0]), v_(corners[2] - corners[0]) {
    cross_ = u_.x * v_.z - u_.z * v_.x;
  }
  [[nodiscard]] bool is_upright() const { return cross_ == 0; }
  [[nodiscard]] std::optional<double> height(double x, double z) const {
    const double dx = x - a_.x, dz = z - a_.z;
    const double s = (dx * v_.z - dz * v_.x) / cross_, t = (u_.x * dz - u_.z * dx) / cross_;
    if (s < -kOnEdge || t < -kOnEdge || s + t > 1 + kOnEdge) return std::nullopt;
    return a_.y + s * u_.y + t * v_.y;
  }

 private:
  Vec3d a_, u_, v_;
  double cross_ = 0;
};

}  // namespace

ObjectSurvey::ObjectSurvey(const world::WorldData& world)
    : world_(world),
      tiles_(
          static_cast<size_t>(world.summary.tiles_x) * static_cast<size_t>(world.summary.tiles_z),
          0) {}

void ObjectSurvey::Sum::add(double area) {
  constexpr double kUnits = 1 << 20, kMax = 1e18;  // in a square metre; of a triangle
  const auto units = static_cast<uint64_t>(std::min(area * kUnits, kMax));
  low += units & 0xffffffff;
  high += (units >> 32) + (low >> 32);
  low &= 0xffffffff;
}

void ObjectSurvey::add(const Scene& scene, size_t triangle) {
  const auto [a, b, c] = corners_of(scene, triangle);
  const double seen = std::abs((b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x));
  if (is_of_patch(scene, triangle)) {
    patches_.add(seen);
    return;
  }
  others_.add(seen);
  const int32_t across = world_.summary.tiles_x, along = world_.summary.tiles_z;
  const double side = world_.summary.cell * kTileCells;
  const auto range = [&](std::array<double, 3> at, double origin, int32_t count) {
    const auto [low, high] = std::minmax_element(at.begin(), at.end());
    const auto tile = [&](double v) {
      return static_cast<int32_t>(std::clamp(std::floor((v - origin) / side), 0.0, count - 1.0));
    };
    return std::pair{tile(*low - world_.summary.cell), tile(*high + world_.summary.cell)};
  };
  const auto columns = range({a.x, b.x, c.x}, world_.summary.origin.x, across);
  const auto rows = range({a.z, b.z, c.z}, world_.summary.origin.z, along);
  for (int32_t z = rows.first; z <= rows.second; ++z) {
    for (int32_t x = columns.first; x <= columns.second; ++x) {
      tiles_[static_cast<size_t>(z) * static_cast<size_t>(across) + static_cast<size_t>(x)] = 1;
    }
  }
}

bool ObjectSurvey::is_mostly_patches() const {
  return std::pair(patches_.high, patches_.low) >= std::pair(others_.high, others_.low);
}

world::CellRows find_object_cells(const TriangleSquares& triangles, const world::WorldData& world,
                                  uint32_t level) {
  world::CellRows cells{};
  const world::GroundLevel ground = world::ground_level(world, level, 0);
  if (ground.zone == nullptr) return cells;
  const auto [tile_x, tile_z] = world::tile_of(world, *ground.zone, *ground.view.record);
  const double cell = world.summary.cell;
  const Vec3d corner = world.summary.origin +
                       Vec3d{world::first_cell(tile_x) * cell, 0, world::first_cell(tile_z) * cell};
  const Box3d all = world.summary.bounds;
  const Box3d box{.min = {corner.x, all.min.y, corner.z},
                  .max = {corner.x + kTileCells * cell, all.max.y, corner.z + kTileCells * cell}};
  std::vector<uint32_t> found;
  triangles.find(box, found);
  for (const uint32_t t : found) {
    if (is_of_patch(triangles.scene(), t)) continue;
    const LocalTriangle c = triangles.corners(t);
    const PlanTriangle triangle(c);
    if (triangle.is_upright()) continue;
    const auto range = [&](std::array<double, 3> at, double origin) {
      const auto [low, high] = std::minmax_element(at.begin(), at.end());
      const auto in_tile = [&](double v) {
        return static_cast<int32_t>(
            std::clamp(std::floor((v - origin) / cell), 0.0, kTileCells - 1.0));
      };
      return std::pair{in_tile(*low), in_tile(*high)};
    };
    const auto columns = range({c[0].x, c[1].x, c[2].x}, corner.x);
    const auto rows = range({c[0].z, c[1].z, c[2].z}, corner.z);
    for (int32_t z = rows.first; z <= rows.second; ++z) {
      for (int32_t x = columns.first; x <= columns.second; ++x) {
        if (!ground.view.has(x, z)) continue;
        const auto height =
            triangle.height(corner.x + (x + 0.5) * cell, corner.z + (z + 0.5) * cell);
        if (!height || std::abs(*height - ground.view.sample(x, z) * 1e-3) > kSameHeight) continue;
        cells[static_cast<size_t>(z)] |= uint64_t{1} << x;
      }
    }
  }
  return cells;
}

bool is_object_cell(std::span<const ObjectLevel> objects, uint32_t level, int32_t x, int32_t z) {
  const auto found = std::lower_bound(
      objects.begin(), objects.end(), level,
      [](const ObjectLevel& object, uint32_t number) { return object.level < number; });
  return found != objects.end() && found->level == level &&
         (found->cells[static_cast<size_t>(z)] >> x & 1) != 0;
}

namespace {

// Patches by the squares of the plan that their cells lie in.
class PatchIndex {
 public:
  explicit PatchIndex(std::span<const BezierCells> cells) {
    for (uint32_t p = 0; p < cells.size(); ++p) {
      Box3d box;
      for (const graph::CellShape& shape : cells[p].shape) box.add(shape.middle(cells[p].origin));
      if (cells[p].shape.empty()) continue;
      for_squares(box, [&](int64_t square) { items_.push_back({square, p}); });
    }
    std::sort(items_.begin(), items_.end());
  }

  // Some of their cells may lie within a distance.
  void find(Vec3d at, double reach, std::vector<uint32_t>& out) const {
    out.clear();
    Box3d box;
    box.add(at - Vec3d{reach, 0, reach});
    box.add(at + Vec3d{reach, 0, reach});
    for_squares(box, [&](int64_t square) {
      auto item = std::lower_bound(items_.begin(), items_.end(), std::pair{square, uint32_t{0}});
      for (; item != items_.end() && item->first == square; ++item) out.push_back(item->second);
    });
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
  }

 private:
  template <class Visit>
  static void for_squares(const Box3d& box, Visit visit) {
    const auto along = [](double v) { return static_cast<int64_t>(std::floor(v / kSquare)); };
    for (int64_t z = along(box.min.z); z <= along(box.max.z); ++z) {
      for (int64_t x = along(box.min.x); x <= along(box.max.x); ++x)
        visit(z * (int64_t{1} << 32) + x);
    }
  }
  std::vector<std::pair<int64_t, uint32_t>> items_;
};

// Links of one level.
class ObjectLinker {
 public:
  ObjectLinker(const PatchLinkInput& input, const std::vector<PatchBody>& bodies,
               std::span<const ObjectLevel> objects, const PatchIndex& patches)
      : input_(input),
        world_(*data_of(*input.world)),
        bodies_(bodies),
        objects_(objects),
        patches_(patches),
        judge_(*input.triangles) {}

  std::vector<graph::CellPair> link(const ObjectLevel& object) {
    for (size_t c = 0; c < bodies_.size(); ++c) link_class(object, c);
    return std::move(pairs_);
  }

 private:
  // Does the class step from a cell to ground that is not of an object?
  [[nodiscard]] bool is_at_patch(const world::WorldGround& ground, const world::GroundLevel& level,
                                 int32_t x, int32_t z, int32_t step) const {
    constexpr std::array<std::array<int32_t, 2>, 4> kBeside = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    return std::any_of(kBeside.begin(), kBeside.end(), [&](const auto& d) {
      const int32_t i = x + d[0], j = z + d[1];
      if (i < 0 || j < 0 || i >= world_.width || j >= world_.depth) return false;
      const auto to = world::step_to(ground, level, x, z, i, j, step);
      return to && !is_object_cell(objects_, to->world_level, world::in_tile(i), world::in_tile(j));
    });
  }

  void link_class(const ObjectLevel& object, size_t c) {
    const world::WorldGround ground{world_, static_cast<int32_t>(c)};
    const world::GroundLevel level = world::ground_level(world_, object.level, ground.avatar_class);
    if (level.zone == nullptr || level.kind == format::CellsKind::None) return;
    const world::CellRows legal = graph::legal_rows(level);
    const auto [tile_x, tile_z] = world::tile_of(world_, *level.zone, *level.view.record);
    const int32_t step = world::step_mm(input_.classes[c]);
    int32_t wide = 1;  // [cells]
    while (wide < 8 && 2 * wide * world_.summary.cell <= kLinkSpacing) wide *= 2;
    // By rows of squares of cells: is there a link from one of these?
    std::array<uint64_t, kTileCells> linked{};
    for (int32_t z = 0; z < kTileCells; ++z) {
      for (int32_t x = 0; x < kTileCells; ++x) {
        const auto row = static_cast<size_t>(z);
        uint64_t& squares = linked[static_cast<size_t>(z / wide)];
        if (((legal[row] & object.cells[row]) >> x & 1) == 0 || (squares >> (x / wide) & 1) != 0) {
          continue;
        }
        const int32_t gx = world::first_cell(tile_x) + x, gz = world::first_cell(tile_z) + z;
        if (!is_at_patch(ground, level, gx, gz, step)) continue;
        if (link_cell(level, c, gx, gz)) squares |= uint64_t{1} << (x / wide);
      }
    }
  }

  bool link_cell(const world::GroundLevel& level, size_t c, int32_t x, int32_t z) {
    const PatchBody& body = bodies_[c];
    constexpr int64_t kMiddle = world::kUnitsPerCell / 2;
    const world::GroundPoint middle{(int64_t{x} << world::kUnitBits) + kMiddle,
                                    (int64_t{z} << world::kUnitBits) + kMiddle};
    const Vec3d feet = world::place_at(world_, level, middle).position;
    const double reach = hole_link_reach(body.radius, input_.size);
    find_nearest(feet, reach, body.bit);
    for (size_t k = 0; k < std::min(kMaxCandidates, nearest_.size()); ++k) {
      const auto [far, patch, cell] = nearest_[k];
      const BodyPose on = pose_on(input_, body, patch, cell);
      if (!goes_straight(judge_, body, {feet, {0, 1, 0}}, on, input_.classes[c].step_height)) {
        continue;
      }
      pairs_.push_back(
          {.patch_a = patch,
           .cell_a = cell,
           .patch_b = level.world_level,
           .cell_b = static_cast<uint32_t>(world::cell_index(world::in_tile(x), world::in_tile(z))),
           .classes = body.bit,
           .kind = LinkKind::kClimb});
      return true;
    }
    return false;
  }

  // Cells of patches on which a class may stand, the nearest first.
  void find_nearest(Vec3d feet, double reach, uint16_t bit) {
    nearest_.clear();
    patches_.find(feet, reach, found_);
    for (const uint32_t patch : found_) {
      const BezierCells& cells = input_.cells[patch];
      for (uint32_t i = 0; i < cells.shape.size(); ++i) {
        if ((cells.promise.cells[i].classes & bit) == 0) continue;
        const Vec3d d = cells.shape[i].middle(cells.origin) - feet;
        const double far = dot(d, d);
        if (far <= reach * reach) nearest_.push_back({far, patch, i});
      }
    }
    std::sort(nearest_.begin(), nearest_.end());
  }

  const PatchLinkInput& input_;
  const world::WorldData& world_;
  const std::vector<PatchBody>& bodies_;
  const std::span<const ObjectLevel> objects_;
  const PatchIndex& patches_;
  MotionJudge judge_;
  std::vector<uint32_t> found_;
  std::vector<std::tuple<double, uint32_t, uint32_t>> nearest_;
  std::vector<graph::CellPair> pairs_;
};

}  // namespace

std::vector<graph::CellPair> link_objects(const PatchLinkInput& input,
                                          std::span<const ObjectLevel> objects, int32_t workers) {
  const std::vector<PatchBody> bodies = patch_bodies(input.classes);
  const PatchIndex patches(input.cells);
  std::vector<std::vector<graph::CellPair>> lists(objects.size());
  parallel_for(objects.size(), workers, [&](size_t i) {
    lists[i] = ObjectLinker(input, bodies, objects, patches).link(objects[i]);
  });
  std::vector<graph::CellPair> all;
  for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
  graph::merge_cell_pairs(all);
  return all;
}

}  // namespace throng::bake
