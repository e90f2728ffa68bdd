// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/obstacle.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "world/place.h"

namespace throng {
namespace {

int32_t ceiling_at(const GroundLevel& level, int32_t x, int32_t z) {
  const format::Level& record = *level.view.record;
  if (record.ceiling_kind() == format::HeightKind::None) return kOpenSky;
  if (record.ceiling_kind() == format::HeightKind::Constant) return record.ceiling_base();
  const uint16_t above = value_at(level.zone->words(record.ceiling_offset()), x, z);
  return above == kNoValue ? kOpenSky : record.ceiling_base() + above;
}

// The floor nearest to a height over a cell of the grid, on any level.
std::optional<GroundLevel> nearest_floor(const WorldGround& ground, int32_t x, int32_t z,
                                         int32_t feet) {
  std::optional<GroundLevel> best;
  int32_t best_rise = INT32_MAX;
  if (x < 0 || z < 0 || x >= ground.world.width || z >= ground.world.depth) return best;
  ground.for_tile(x >> 6, z >> 6, feet, feet, [&](const GroundLevel& level) {
    if (!level.view.has(x & 63, z & 63)) return;
    const int32_t rise = std::abs(ground.sample(level, x & 63, z & 63) - feet);
    if (rise >= best_rise) return;
    best_rise = rise;
    best = level;
  });
  return best;
}

// Rise of a level's floor over a cell of it. [mm per cell]
double slope_at(const GroundLevel& level, int32_t x, int32_t z) {
  const auto sample = [&](int32_t i, int32_t k) { return level.view.sample(i, k); };
  const auto has = [&](int32_t i, int32_t k) { return level.view.has(i, k); };
  const int32_t gx = sheet_slope(
      x, [&](int32_t i) { return sample(i, z); }, [&](int32_t i) { return has(i, z); });
  const int32_t gz = sheet_slope(
      z, [&](int32_t k) { return sample(x, k); }, [&](int32_t k) { return has(x, k); });
  return std::sqrt(static_cast<double>(gx) * gx + static_cast<double>(gz) * gz);
}

// What a body may meet beside the cell that it stands on.
struct Around {
  bool low = false, steep = false, step = false, wall = false, edge = false;
};

class Surroundings {
 public:
  Surroundings(const WorldGround& ground, int32_t feet)
      : ground_(ground),
        avatar_(ground.world.summary.classes[static_cast<size_t>(ground.avatar_class)]),
        feet_(feet),
        step_(step_mm(avatar_)),
        height_(static_cast<int32_t>(std::ceil(avatar_.height * 1000))),
        steepest_(std::tan(avatar_.max_slope * std::numbers::pi / 180) * ground.world.summary.cell *
                  1000) {}

  void add(int32_t x, int32_t z, Around& around) const {
    const auto floor = nearest_floor(ground_, x, z, feet_);
    const int32_t rise = floor ? ground_.sample(*floor, x & 63, z & 63) - feet_ : INT32_MIN;
    if (rise > step_ && rise <= height_) {
      (2 * rise <= height_ ? around.step : around.wall) = true;
    } else if (std::abs(int64_t{rise}) > step_) {
      // The matter of a thin wall leaves no floor either, but there is one on both its sides.
      (is_between_floors(x, z) ? around.wall : around.edge) = true;
    } else {
      const int32_t ceiling = ceiling_at(*floor, x & 63, z & 63);
      if (ceiling != kOpenSky && int64_t{ceiling} - feet_ < height_) around.low = true;
      if (slope_at(*floor, x & 63, z & 63) > steepest_) around.steep = true;
    }
  }

 private:
  [[nodiscard]] bool is_floor(int32_t x, int32_t z) const {
    const auto floor = nearest_floor(ground_, x, z, feet_);
    return floor && std::abs(ground_.sample(*floor, x & 63, z & 63) - feet_) <= step_;
  }
  [[nodiscard]] bool is_between_floors(int32_t x, int32_t z) const {
    constexpr int32_t kThin = 3;  // cells
    const auto toward = [&](int32_t dx, int32_t dz) {
      for (int32_t i = 1; i <= kThin; ++i) {
        if (is_floor(x + i * dx, z + i * dz)) return true;
      }
      return false;
    };
    return (toward(1, 0) && toward(-1, 0)) || (toward(0, 1) && toward(0, -1));
  }

  const WorldGround& ground_;
  const AvatarClass& avatar_;
  int32_t feet_, step_, height_;
  double steepest_;  // [mm per cell]
};

}  // namespace

Obstacle obstacle_at(const WorldGround& ground, int32_t x, int32_t z, int32_t feet) {
  const WorldSummary& summary = ground.world.summary;
  const AvatarClass& avatar = summary.classes[static_cast<size_t>(ground.avatar_class)];
  const std::optional<GroundLevel> floor = nearest_floor(ground, x, z, feet);
  if (!floor) return Obstacle::kGap;
  const int32_t here = ground.sample(*floor, x & 63, z & 63);
  if (std::abs(here - feet) > avatar.height * 1000) return Obstacle::kGap;
  if (std::abs(here - feet) > step_mm(avatar)) return Obstacle::kStep;
  if (floor->is_legal(x & 63, z & 63)) return Obstacle::kNone;
  Around around;
  const Surroundings surroundings(ground, here);
  // One cell more: matter in the middle of a cell shows in the floor of the next.
  const auto reach = static_cast<int32_t>(std::ceil(avatar.radius / summary.cell)) + 1;
  for (int32_t dz = -reach; dz <= reach; ++dz) {
    for (int32_t dx = -reach; dx <= reach; ++dx) {
      if (dx * dx + dz * dz <= reach * reach) surroundings.add(x + dx, z + dz, around);
    }
  }
  if (around.low) return Obstacle::kLow;
  if (around.steep) return Obstacle::kSteep;
  if (around.step && !around.wall) return Obstacle::kStep;
  return around.edge && !around.wall ? Obstacle::kGap : Obstacle::kNarrow;
}

Obstacle obstacle_beyond(const WorldGround& ground, const GroundLevel& level,
                         const WalkStop& stop) {
  const int32_t feet = ground.sample(level, stop.x & 63, stop.z & 63);
  const auto toward = [&](int32_t dx, int32_t dz) {
    return dx == 0 && dz == 0 ? Obstacle::kNone
                              : obstacle_at(ground, stop.x + dx, stop.z + dz, feet);
  };
  Obstacle found = toward(stop.toward_x, 0);
  if (found == Obstacle::kNone) found = toward(0, stop.toward_z);
  if (found == Obstacle::kNone) found = toward(stop.toward_x, stop.toward_z);
  return found == Obstacle::kNone ? Obstacle::kStep : found;
}

}  // namespace throng
