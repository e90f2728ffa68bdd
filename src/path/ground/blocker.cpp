// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/blocker.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "world/place.h"
#include "world/tile_grid.h"

// What blocks a straight walk: rays over the cells around its end. Time: if the body's radius is r
// cells, about 4 r rays of r cells, longer where no floor is known.
namespace throng::path {
namespace {

int32_t ceiling_at(const world::GroundLevel& level, int32_t x, int32_t z) {
  const format::Level& record = *level.view.record;
  if (record.ceiling_kind() == format::HeightKind::None) return kOpenSky;
  if (record.ceiling_kind() == format::HeightKind::Constant) return record.ceiling_base();
  const uint16_t above = world::value_at(level.zone->words(record.ceiling_offset()), x, z);
  return above == world::kNoValue ? kOpenSky : record.ceiling_base() + above;
}

// The floor nearest to a height over a cell of the grid, on any level.
std::optional<world::GroundLevel> nearest_floor(const world::WorldGround& ground, int32_t x,
                                                int32_t z, int32_t feet) {
  std::optional<world::GroundLevel> best;
  int32_t best_rise = INT32_MAX;
  if (x < 0 || z < 0 || x >= ground.world.width || z >= ground.world.depth) return best;
  ground.for_tile(world::tile_along(x), world::tile_along(z), feet, feet,
                  [&](const world::GroundLevel& level) {
                    if (!level.view.has(world::in_tile(x), world::in_tile(z))) return;
                    const int32_t rise =
                        std::abs(ground.sample(level, world::in_tile(x), world::in_tile(z)) - feet);
                    if (rise >= best_rise) return;
                    best_rise = rise;
                    best = level;
                  });
  return best;
}

// Rise of a level's floor over a cell of it. [mm per cell]
double slope_at(const world::GroundLevel& level, int32_t x, int32_t z) {
  const auto sample = [&](int32_t i, int32_t k) { return level.view.sample(i, k); };
  const auto has = [&](int32_t i, int32_t k) { return level.view.has(i, k); };
  const int32_t gx = world::sheet_slope(
      x, [&](int32_t i) { return sample(i, z); }, [&](int32_t i) { return has(i, z); });
  const int32_t gz = world::sheet_slope(
      z, [&](int32_t k) { return sample(x, k); }, [&](int32_t k) { return has(x, k); });
  return std::sqrt(static_cast<double>(gx) * gx + static_cast<double>(gz) * gz);
}

// What a body may meet around the cell that it stands on.
struct Around {
  bool low = false, steep = false, step = false, wall = false, raised = false, edge = false;
  bool unknown = false;
};

// Levels keep floors where an avatar can stand, and those beside; they hold no solids. So what
// blocks a body is inferred from what is seen where its own floor ends.
class Surroundings {
 public:
  Surroundings(const world::WorldGround& ground, int32_t x, int32_t z, int32_t feet)
      : ground_(ground),
        x_(x),
        z_(z),
        feet_(feet),
        step_(world::step_mm(avatar())),
        height_(static_cast<int32_t>(std::ceil(avatar().height * 1000))),
        cell_(ground.world.summary.cell * 1000),
        steepest_(std::tan(avatar().max_slope * std::numbers::pi / 180) * cell_) {}

  // Where the body would be in the cell ahead, and a cell more: a solid in the middle of a cell
  // shows in the floor of the next.
  [[nodiscard]] Around cast_ahead(int32_t ahead_x, int32_t ahead_z) const {
    const auto radius = static_cast<int32_t>(std::ceil(avatar().radius * 1000 / cell_)) + 2;
    Around around;
    for (int32_t i = -radius; i <= radius; ++i) {
      for (const auto& [dx, dz] : {std::pair{i, -radius}, {i, radius}, {-radius, i}, {radius, i}}) {
        if (dx * ahead_x + dz * ahead_z > 0) cast_along(dx, dz, radius, around);
      }
    }
    return around;
  }

 private:
  // Of several floors over a cell the one that comes last here decides.
  enum class Sight : uint8_t { kUnknown, kRaised, kEdge, kWall, kStep, kFloor };
  struct Column {
    Sight sight = Sight::kUnknown;
    int32_t feet = 0;  // of the floor that decides
  };

  [[nodiscard]] const AvatarClass& avatar() const {
    return ground_.world.summary.classes[static_cast<size_t>(ground_.avatar_class)];
  }

  // What is over a cell for a body whose feet are at a height beside it.
  [[nodiscard]] Column column_at(int32_t x, int32_t z, int32_t feet) const {
    if (x < 0 || z < 0 || x >= ground_.world.width || z >= ground_.world.depth) {
      return {Sight::kEdge, feet - 2 * height_};
    }
    Column found;
    const auto take = [&](Sight sight, int32_t floor) {
      const bool is_nearer = std::abs(floor - feet) < std::abs(found.feet - feet);
      if (sight > found.sight || (sight == found.sight && is_nearer)) {
        found = {sight, floor};
      }
    };
    ground_.for_tile(
        world::tile_along(x), world::tile_along(z), feet, feet,
        [&](const world::GroundLevel& level) {
          if (!level.view.has(world::in_tile(x), world::in_tile(z))) return;
          const int32_t floor = ground_.sample(level, world::in_tile(x), world::in_tile(z));
          const int32_t rise = floor - feet;
          if (std::abs(rise) <= step_) {
            take(Sight::kFloor, floor);
          } else if (rise > 0) {
            take(rise > height_        ? Sight::kRaised
                 : 2 * rise <= height_ ? Sight::kStep
                                       : Sight::kWall,
                 floor);
          } else {
            const int32_t ceiling = ceiling_at(level, world::in_tile(x), world::in_tile(z));
            const bool is_open = ceiling == kOpenSky || int64_t{ceiling} - feet >= height_;
            if (is_open) {
              take(-2 * rise <= height_ ? Sight::kStep : Sight::kEdge, floor);
            } else if (ceiling - feet > step_) {
              take(Sight::kWall, ceiling);
            }
          }
        });
    return found;
  }

  // Over the floor to its end, and from there to what is seen first.
  void cast_along(int32_t dx, int32_t dz, int32_t radius, Around& around) const {
    const auto beyond = static_cast<int32_t>(std::ceil(kThickWall / cell_));
    int32_t x = x_, z = z_, feet = feet_;
    bool is_known = true;
    for (int32_t i = 1; i <= (is_known ? radius : radius + beyond); ++i) {
      const int32_t next_x = x_ + rounded(i * dx, radius), next_z = z_ + rounded(i * dz, radius);
      const Column column = column_at(next_x, next_z, feet);
      if (column.sight == Sight::kUnknown) {
        is_known = false;
        continue;
      }
      if (is_known && column.sight >= Sight::kStep) {
        if (is_slope(next_x, next_z, next_x - x, next_z - z, feet, column.feet)) {
          around.steep = true;
          return;
        }
      }
      if (is_known && column.sight == Sight::kFloor) {
        if (is_low_at(next_x, next_z, feet)) around.low = true;
        if (is_too_steep(next_x, next_z, feet)) around.steep = true;
        x = next_x;
        z = next_z;
        feet = column.feet;
        continue;
      }
      note(column.sight, around);
      return;
    }
    if (!is_known) around.unknown = true;
  }

  static void note(Sight sight, Around& around) {
    switch (sight) {
      case Sight::kFloor:
        around.wall = true;
        break;  // The same floor behind something thin.
      case Sight::kStep:
        around.step = true;
        break;
      case Sight::kWall:
        around.wall = true;
        break;
      case Sight::kRaised:
        around.raised = true;
        break;
      case Sight::kEdge:
        around.edge = true;
        break;
      case Sight::kUnknown:
        break;
    }
  }

  [[nodiscard]] bool is_low_at(int32_t x, int32_t z, int32_t feet) const {
    const auto floor = nearest_floor(ground_, x, z, feet);
    if (!floor) return false;
    const int32_t ceiling = ceiling_at(*floor, world::in_tile(x), world::in_tile(z));
    return ceiling != kOpenSky && int64_t{ceiling} - feet < height_;
  }
  [[nodiscard]] bool is_too_steep(int32_t x, int32_t z, int32_t feet) const {
    const auto floor = nearest_floor(ground_, x, z, feet);
    return floor && slope_at(*floor, world::in_tile(x), world::in_tile(z)) > steepest_;
  }

  // Is the rise to a cell, too steep for the class, that of a slope, and not of a step, after which
  // the floor is flat? Of a slope where no avatar can stand only the first cell is known.
  [[nodiscard]] bool is_slope(int32_t x, int32_t z, int32_t dx, int32_t dz, int32_t from,
                              int32_t to) const {
    constexpr double kMaxFloorRise = 4;  // A floor that rises more is a wall, about 76 degrees.
    const double run = std::sqrt(static_cast<double>(dx * dx + dz * dz));
    const int32_t rise = to - from;
    if (std::abs(rise) <= steepest_ * run || std::abs(rise) > kMaxFloorRise * cell_ * run)
      return false;
    const auto next = nearest_floor(ground_, x + dx, z + dz, to + rise);
    if (!next) return true;
    const int32_t goes_on =
        ground_.sample(*next, world::in_tile(x + dx), world::in_tile(z + dz)) - to;
    return std::abs(goes_on - rise) <= std::abs(rise) / 2;
  }

  static int32_t rounded(int32_t a, int32_t b) { return (2 * a + (a < 0 ? -b : b)) / (2 * b); }

  static constexpr double kThickWall = 600;  // [mm]

  const world::WorldGround& ground_;
  int32_t x_, z_, feet_, step_, height_;
  double cell_, steepest_;  // [mm; mm per cell]
};

}  // namespace

Blocker blocker_beyond(const world::WorldGround& ground, const world::GroundLevel& level,
                       const world::WalkStop& stop) {
  const int32_t feet = ground.sample(level, world::in_tile(stop.x), world::in_tile(stop.z));
  const AvatarClass& avatar =
      ground.world.summary.classes[static_cast<size_t>(ground.avatar_class)];
  const auto toward = [&](int32_t dx, int32_t dz) {
    if (dx == 0 && dz == 0) return Blocker::kNone;
    const auto floor = nearest_floor(ground, stop.x + dx, stop.z + dz, feet);
    if (floor && floor->is_legal(world::in_tile(stop.x + dx), world::in_tile(stop.z + dz))) {
      const int32_t there =
          ground.sample(*floor, world::in_tile(stop.x + dx), world::in_tile(stop.z + dz));
      if (std::abs(there - feet) <= world::step_mm(avatar)) return Blocker::kNone;
    }
    const Around around = Surroundings(ground, stop.x, stop.z, feet).cast_ahead(dx, dz);
    if (around.low) return Blocker::kLow;
    if (around.steep) return Blocker::kSteep;
    if (around.step && !around.wall) return Blocker::kStep;
    if (around.wall) return Blocker::kNarrow;
    if (around.edge) return Blocker::kGap;
    // A floor higher up most likely stands on a solid; and where the floor continues, something
    // stands on it.
    return around.raised || !around.unknown ? Blocker::kNarrow : Blocker::kGap;
  };
  Blocker found = toward(stop.toward_x, 0);
  if (found == Blocker::kNone) found = toward(0, stop.toward_z);
  if (found == Blocker::kNone) found = toward(stop.toward_x, stop.toward_z);
  return found == Blocker::kNone ? Blocker::kStep : found;
}

Blocker blocker_towards(const world::WorldGround& ground, const Place& from, const Place& to) {
  const auto start = world::ground_point(ground.world, from);
  const auto goal = world::ground_point(ground.world, to);
  if (!start || !goal) return Blocker::kNone;
  const AvatarClass& avatar =
      ground.world.summary.classes[static_cast<size_t>(ground.avatar_class)];
  world::GroundLevel level =
      world::ground_level(ground.world, from.level1 - 1, ground.avatar_class);
  const world::WalkStop stop =
      world::walk_far(ground, level, *start, *goal, world::step_mm(avatar));
  if (stop.arrived) return Blocker::kGap;  // under or over the goal
  return blocker_beyond(ground, level, stop);
}

}  // namespace throng::path
