// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/access.h"
#include "core/check_class.h"
#include "core/random.h"
#include "path/ground/blocker.h"
#include "path/ground/circle_flood.h"
#include "throng/world.h"
#include "world/tile_grid.h"

// Queries of the ground around a place, cell by cell: the nearest place, rays, slides, walls,
// random places. Linear in the cells within the radius.
namespace throng {
namespace {

// A cell's points, and the nearest of them to a point. [units]
int64_t clamp_to_cell(int64_t at, int32_t cell) {
  const int64_t first = int64_t{cell} << world::kUnitBits;
  return std::clamp(at, first, first + world::kUnitsPerCell - 1);
}
world::GroundPoint clamp_to_cell(world::GroundPoint p, int32_t x, int32_t z) {
  return {clamp_to_cell(p.x, x), clamp_to_cell(p.z, z)};
}

double squared(world::GroundPoint a, world::GroundPoint b) {
  const auto dx = static_cast<double>(a.x - b.x), dz = static_cast<double>(a.z - b.z);
  return dx * dx + dz * dz;
}

// Of an interval [low, high], how far a number is outside.
double outside(double at, double low, double high) { return std::max({low - at, at - high, 0.0}); }

}  // namespace

struct GroundQuery::State {
  World world;
  int32_t avatar_class = 0;
  int32_t step = 0;  // [mm]
  path::CircleFlood flood;
  struct NearCell {
    uint32_t level = 0;
    int32_t x = 0, z = 0;  // of the grid
  };
  std::vector<NearCell> near;

  [[nodiscard]] const world::WorldData& data() const { return *data_of(world); }
  [[nodiscard]] world::WorldGround ground() const { return {data(), avatar_class}; }
  [[nodiscard]] double unit() const { return data().summary.cell / world::kUnitsPerCell; }

  // False if the class cannot stand there.
  bool locate(const Place& place, world::GroundLevel& level, world::GroundPoint& point) const {
    const auto found = world::ground_point(data(), place);
    if (!found) return false;
    point = *found;
    level = world::ground_level(data(), place.level1 - 1, avatar_class);
    return level.is_legal(world::in_tile(point.cell_x()), world::in_tile(point.cell_z()));
  }
  // Where a push from a place leads. One longer than the grid ends a cell beside it: farther off,
  // products of lengths would not fit 64 bits.
  [[nodiscard]] world::GroundPoint pushed(const Place& from, double dx, double dz) const {
    const double longest = (std::max(data().width, data().depth) + 1) * data().summary.cell;
    const double part = std::min({1.0, longest / std::fabs(dx), longest / std::fabs(dz)});
    return world::to_ground(data(), from.position.x + part * dx, from.position.z + part * dz);
  }

  // Where a push that arrived has led: to a point on `last`.
  [[nodiscard]] static Place end_of(const Place& from, double dx, double dz,
                                    const world::GroundLevel& last, world::GroundPoint goal) {
    return {{from.position.x + dx, world::feet_at(last, goal), from.position.z + dz},
            last.world_level + 1};
  }

  // The legal cells of one level that may be nearer than `best`, a place and its distance.
  void nearest_on(const world::GroundLevel& level, int32_t tile_x, int32_t tile_z, Vec3d position,
                  world::GroundPoint at, std::pair<Place, double>& best) const;
  // Into `near`: cells that touch the circle and are connected to its middle.
  bool gather(const Place& centre, double radius);
};

GroundQuery::GroundQuery(std::unique_ptr<State> state) : state_(std::move(state)) {}
GroundQuery::GroundQuery(GroundQuery&&) noexcept = default;
GroundQuery& GroundQuery::operator=(GroundQuery&&) noexcept = default;
GroundQuery::~GroundQuery() = default;

Result<GroundQuery> GroundQuery::create(const World& world, int32_t avatar_class) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "ground query: the world is empty"};
  const std::vector<AvatarClass>& classes = data_of(world)->summary.classes;
  if (auto ok = check_class(classes, avatar_class, "ground query"); !ok) return ok.error();
  auto state = std::make_unique<State>();
  state->world = world;
  state->avatar_class = avatar_class;
  state->step = world::step_mm(classes[static_cast<size_t>(avatar_class)]);
  return GroundQuery(std::move(state));
}

Result<void> GroundQuery::check_near(Vec3d position, double radius) const {
  const world::WorldData& world = state_->data();
  const double side = world.tiles_per_zone * kTileCells * world.summary.cell;
  for (size_t s = 0; s < world.slots.size(); ++s) {
    const format::ZoneEntry& zone = world.slots[s]->entry;
    const double x = world.summary.origin.x + zone.x() * side;
    const double z = world.summary.origin.z + zone.z() * side;
    const double dx = outside(position.x, x, x + side), dz = outside(position.z, z, z + side);
    // A place in the next zone's first cell may be a cell nearer.
    if (std::hypot(dx, dz) > radius + world.summary.cell) continue;
    if (world.zone(s) == nullptr) return Error{Errc::kBadFile, world.slots[s]->error};
  }
  return {};
}

void GroundQuery::State::nearest_on(const world::GroundLevel& level, int32_t tile_x, int32_t tile_z,
                                    Vec3d position, world::GroundPoint at,
                                    std::pair<Place, double>& best) const {
  if (level.kind == format::CellsKind::None) return;
  const double cell = data().summary.cell;
  const auto corner = [&](int32_t tile, uint32_t block) {
    return (tile * kTileCells + static_cast<int32_t>(block) * 8) * cell;
  };
  for (uint32_t block = 0; block < world::kBlocks; ++block) {
    uint64_t cells = level.kind == format::CellsKind::All ? ~uint64_t{0}
                                                          : world::block_cells(level.legal, block);
    if (cells == 0) continue;
    const double x = data().summary.origin.x + corner(tile_x, block % 8);
    const double z = data().summary.origin.z + corner(tile_z, block / 8);
    const double bx = outside(position.x, x, x + 8 * cell);
    const double bz = outside(position.z, z, z + 8 * cell);
    if (bx * bx + bz * bz >= best.second * best.second) continue;
    for (; cells != 0; cells &= cells - 1) {
      const int32_t bit = std::countr_zero(cells);
      const int32_t cx = tile_x * kTileCells + static_cast<int32_t>(block % 8) * 8 + bit % 8;
      const int32_t cz = tile_z * kTileCells + static_cast<int32_t>(block / 8) * 8 + bit / 8;
      const world::GroundPoint point = clamp_to_cell(at, cx, cz);
      const double plan = std::sqrt(squared(point, at)) * unit();
      if (plan >= best.second) continue;
      Place place = world::place_at(data(), level, point);
      if (point.x == at.x) place.position.x = position.x;  // the same unit: no need to move
      if (point.z == at.z) place.position.z = position.z;
      const double distance = length(place.position - position);
      if (distance < best.second) best = {place, distance};
    }
  }
}

Place GroundQuery::nearest_place(Vec3d position, double radius) {
  const State& s = *state_;
  const world::WorldData& world = s.data();
  if (!std::isfinite(position.x + position.y + position.z) || !(radius >= 0)) return {};
  // A place may lie on the very edge of the search radius.
  std::pair<Place, double> best{{}, std::nextafter(std::min(radius, 1e9), 2e9)};
  const world::GroundPoint at = world::to_ground(world, position.x, position.z);
  const int32_t tiles_x = (world.width + kTileCells - 1) / kTileCells;
  const int32_t tiles_z = (world.depth + kTileCells - 1) / kTileCells;
  const auto tile_of_point = [](int64_t units, int32_t count) {
    return static_cast<int32_t>(
        std::clamp<int64_t>(units >> (world::kUnitBits + 6), 0, int64_t{count} - 1));
  };
  const int32_t middle_x = tile_of_point(at.x, tiles_x), middle_z = tile_of_point(at.z, tiles_z);
  const double side = world.summary.cell * kTileCells;
  const double far_x = world.summary.origin.x, far_z = world.summary.origin.z;
  const int32_t rings = std::max(tiles_x, tiles_z);
  for (int32_t ring = 0; ring < rings; ++ring) {
    // Nothing in this ring or beyond is nearer than its rim.
    if (ring > 0 && (ring - 1) * side > best.second) break;
    for (int32_t z = middle_z - ring; z <= middle_z + ring; ++z) {
      if (z < 0 || z >= tiles_z) continue;
      const bool whole = z == middle_z - ring || z == middle_z + ring;
      for (int32_t x = middle_x - ring; x <= middle_x + ring; x += whole ? 1 : 2 * ring) {
        if (x < 0 || x >= tiles_x) continue;
        const double dx = outside(position.x, far_x + x * side, far_x + (x + 1) * side);
        const double dz = outside(position.z, far_z + z * side, far_z + (z + 1) * side);
        if (dx * dx + dz * dz >= best.second * best.second) continue;
        s.ground().for_tile(x, z, 0, 0, [&](const world::GroundLevel& level) {
          s.nearest_on(level, x, z, position, at, best);
        });
      }
    }
  }
  return best.first;
}

GroundRay GroundQuery::ray(const Place& from, double dx, double dz) {
  const State& s = *state_;
  GroundRay result{.place = from};
  world::GroundLevel level;
  world::GroundPoint start;
  if (!std::isfinite(dx + dz) || !s.locate(from, level, start)) return result;
  const world::GroundPoint goal = s.pushed(from, dx, dz);
  const world::WorldGround ground = s.ground();
  world::GroundLevel last = level;
  const world::WalkStop stop = world::walk_far(ground, last, start, goal, s.step);
  if (stop.arrived) {
    result.arrived = true;
    result.place = State::end_of(from, dx, dz, last, goal);
    return result;
  }
  const double sides = std::sqrt(std::abs(stop.toward_x) + std::abs(stop.toward_z));
  result.normal_x = -stop.toward_x / sides;
  result.normal_z = -stop.toward_z / sides;
  result.blocked_by = path::blocker_beyond(ground, last, stop);
  // Where the line meets the border, inside the cell. Rounding may take the line there over
  // another corner than the one to the goal; then less of it is safe.
  const auto along_x = static_cast<double>(goal.x - start.x);
  const auto along_z = static_cast<double>(goal.z - start.z);
  double t = 1;
  const auto crossing = [&](int32_t toward, int32_t cell, int64_t at, double along) {
    if (toward == 0 || along == 0) return;
    const int64_t line = int64_t{toward > 0 ? cell + 1 : cell} << world::kUnitBits;
    t = std::min(t, static_cast<double>(line - at) / along);
  };
  crossing(stop.toward_x, stop.x, start.x, along_x);
  crossing(stop.toward_z, stop.z, start.z, along_z);
  for (int tries = 0; tries < 8; ++tries, t -= 1.0 / 64) {
    if (t <= 0) break;
    world::GroundPoint end{start.x + std::llround(t * along_x),
                           start.z + std::llround(t * along_z)};
    if (tries == 0) end = clamp_to_cell(end, stop.x, stop.z);
    world::GroundLevel at = level;
    if (!world::in_grid(s.data(), end) || !world::walk(ground, at, start, end, s.step)) continue;
    result.place = world::place_at(s.data(), at, end);
    return result;
  }
  return result;
}

Place GroundQuery::slide(const Place& from, double dx, double dz) {
  State& s = *state_;
  world::GroundLevel level;
  world::GroundPoint start;
  if (!std::isfinite(dx + dz) || !s.locate(from, level, start)) return from;
  const world::GroundPoint goal = s.pushed(from, dx, dz);
  world::GroundLevel last = level;
  if (world::walk(s.ground(), last, start, goal, s.step))
    return State::end_of(from, dx, dz, last, goal);
  const world::GroundPoint middle{(start.x + goal.x) / 2, (start.z + goal.z) / 2};
  // A cell more than half the push: else a push shorter than a cell could leave none.
  const double limit = std::sqrt(squared(start, goal)) / 2 + world::kUnitsPerCell;
  const auto within = [&](int32_t x, int32_t z) {
    return squared(clamp_to_cell(middle, x, z), middle) <= limit * limit;
  };
  world::GroundLevel best_level = level;
  world::GroundPoint best = start;
  double best_distance = squared(start, goal);
  s.flood.start(level, start.cell_x(), start.cell_z());
  s.flood.run(
      s.ground(), s.step, within,
      [&](const path::CircleFlood::Cell& cell) {
        const world::GroundPoint point = clamp_to_cell(goal, cell.x, cell.z);
        const double distance = squared(point, goal);
        if (distance >= best_distance) return;
        best_distance = distance;
        best = point;
        best_level = cell.level;
      },
      [](const path::CircleFlood::Cell&, int32_t, int32_t) {});
  if (best.x == start.x && best.z == start.z) return from;
  return world::place_at(s.data(), best_level, best);
}

NearestWall GroundQuery::nearest_wall(const Place& from, double max_distance) {
  State& s = *state_;
  NearestWall wall;
  world::GroundLevel level;
  world::GroundPoint at;
  if (!(max_distance >= 0) || !s.locate(from, level, at)) return wall;
  const double limit = std::min(max_distance, 1e9) / s.unit();
  double best = std::nextafter(limit * limit, 1e300);
  const auto within = [&](int32_t x, int32_t z) {
    return squared(clamp_to_cell(at, x, z), at) < best;
  };
  world::GroundPoint nearest;
  int32_t toward_x = 0, toward_z = 0;
  s.flood.start(level, at.cell_x(), at.cell_z());
  s.flood.run(
      s.ground(), s.step, within, [](const path::CircleFlood::Cell&) {},
      [&](const path::CircleFlood::Cell& cell, int32_t side_x, int32_t side_z) {
        // The side's own points, not those of the cell before it.
        world::GroundPoint point = clamp_to_cell(at, cell.x, cell.z);
        if (side_x != 0) point.x = int64_t{side_x > 0 ? cell.x + 1 : cell.x} << world::kUnitBits;
        if (side_z != 0) point.z = int64_t{side_z > 0 ? cell.z + 1 : cell.z} << world::kUnitBits;
        const double distance = squared(point, at);
        if (distance >= best) return;
        best = distance;
        nearest = point;
        toward_x = side_x;
        toward_z = side_z;
        wall.found = true;
      });
  if (!wall.found) return wall;
  const double distance = std::sqrt(best);
  wall.distance = distance * s.unit();
  wall.x = s.data().summary.origin.x + static_cast<double>(nearest.x) * s.unit();
  wall.z = s.data().summary.origin.z + static_cast<double>(nearest.z) * s.unit();
  wall.normal_x = distance > 0 ? static_cast<double>(at.x - nearest.x) / distance : -toward_x;
  wall.normal_z = distance > 0 ? static_cast<double>(at.z - nearest.z) / distance : -toward_z;
  return wall;
}

bool GroundQuery::State::gather(const Place& centre, double radius) {
  near.clear();
  world::GroundLevel level;
  world::GroundPoint at;
  if (!(radius >= 0) || !locate(centre, level, at)) return false;
  const double limit = std::min(radius, 1e9) / unit();
  const auto within = [&](int32_t x, int32_t z) {
    return squared(clamp_to_cell(at, x, z), at) <= limit * limit;
  };
  flood.start(level, at.cell_x(), at.cell_z());
  flood.run(
      ground(), step, within,
      [&](const path::CircleFlood::Cell& cell) {
        near.push_back({cell.level.world_level, cell.x, cell.z});
      },
      [](const path::CircleFlood::Cell&, int32_t, int32_t) {});
  return true;
}

Place GroundQuery::random_place_near(const Place& centre, double radius, uint64_t seed,
                                     uint64_t n) {
  State& s = *state_;
  if (!s.gather(centre, radius)) return {};
  const world::GroundPoint at = world::to_ground(s.data(), centre.position.x, centre.position.z);
  const double limit = std::min(radius, 1e9) / s.unit();
  // Points outside the circle are drawn again: cells of its rim lie partly inside.
  constexpr uint64_t kMaxDraws = 256;
  for (uint64_t t = 0; t < kMaxDraws; ++t) {
    const State::NearCell& cell = s.near[random_below(seed, n, 4 * t, s.near.size())];
    const auto unit_of = [&](int32_t first, uint64_t draw) {
      return (int64_t{first} << world::kUnitBits) +
             static_cast<int64_t>(random_below(seed, n, 4 * t + draw, world::kUnitsPerCell));
    };
    const world::GroundPoint p{unit_of(cell.x, 1), unit_of(cell.z, 2)};
    if (squared(p, at) > limit * limit) continue;
    return world::place_at(s.data(), world::ground_level(s.data(), cell.level, s.avatar_class), p);
  }
  return centre;  // a circle far smaller than a cell
}

double GroundQuery::area_near(const Place& centre, double radius) {
  State& s = *state_;
  if (!s.gather(centre, radius)) return 0;
  const world::GroundPoint at = world::to_ground(s.data(), centre.position.x, centre.position.z);
  const double limit = std::min(radius, 1e9) / s.unit();
  const auto inside = [&](const State::NearCell& cell) {
    const world::GroundPoint middle{
        (int64_t{cell.x} << world::kUnitBits) + world::kUnitsPerCell / 2,
        (int64_t{cell.z} << world::kUnitBits) + world::kUnitsPerCell / 2};
    return squared(middle, at) <= limit * limit;
  };
  const double side = s.data().summary.cell;
  return static_cast<double>(std::count_if(s.near.begin(), s.near.end(), inside)) * side * side;
}

}  // namespace throng
