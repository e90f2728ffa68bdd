// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/ground_slope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "crowd/ground/crowd_ground.h"
#include "world/tile_grid.h"

// The slope of the ground where a body walks, out of a few heights along its direction. Most ground
// is level: a flag of each level, found once, and the level's flat blocks say so without reading a
// height. Constant time; to find the flags, linear in the levels and those of the tiles around.
namespace throng::crowd {
namespace {

constexpr int32_t kLevelRise = 5;    // [mm] less over the whole range is no slope
constexpr int32_t kTreadRise = 10;   // [mm] a tread does not rise more between two heights
constexpr int32_t kMinRiser = 50;    // [mm]
constexpr int32_t kMaxRiser = 250;   // [mm] what rises more is two risers
constexpr int32_t kRiserLength = 2;  // heights, over which the edge of a tread may spread
constexpr int32_t kMinTreads = 2;    // one riser alone is a kerb

// Risers up less those down: short rises between treads. A ramp is one long rise.
int32_t count_risers(std::span<const int32_t> heights) {
  int32_t risers = 0;
  for (size_t i = 1; i < heights.size();) {
    const auto rise = [&](size_t at) { return heights[at] - heights[at - 1]; };
    const int32_t sign = rise(i) > 0 ? 1 : -1;
    const size_t begin = i;
    while (i < heights.size() && sign * rise(i) > kTreadRise) ++i;
    if (i == begin) {
      ++i;  // a tread
      continue;
    }
    const int32_t total = sign * (heights[i - 1] - heights[begin - 1]);
    if (i - begin > kRiserLength || total < kMinRiser) continue;
    risers += total > kMaxRiser ? 2 * sign : sign;
  }
  return risers;
}

}  // namespace

SlopeRange SlopeRange::of_cell(double cell) {
  constexpr double kSpacing = 0.1, kReach = 0.5;      // [m]
  constexpr double kMaxStep = 450, kSteepest = 1000;  // [mm], [mm/m]
  SlopeRange range;
  range.spacing = std::max(1, static_cast<int32_t>(std::lround(kSpacing / cell)));
  const double metres = range.spacing * cell;
  range.count = std::clamp(static_cast<int32_t>(std::lround(kReach / metres)), 1, kMaxCount);
  range.max_jump = static_cast<int32_t>(kMaxStep + kSteepest * metres);
  range.metres = static_cast<float>(metres);
  return range;
}

GroundSlope slope_of(std::span<const int32_t> heights, float spacing) {
  if (heights.size() < 2) return {};
  const int32_t rise = heights.back() - heights.front();
  if (std::abs(rise) <= kLevelRise) return {};
  const float run = spacing * static_cast<float>(heights.size() - 1);
  const int32_t risers = count_risers(heights);
  return {static_cast<float>(rise) * 1e-3f / run, (rise > 0 ? risers : -risers) >= kMinTreads};
}

// The floor of a cell beyond another one: of the same level, else the nearest in height. None is
// within a jump: the ground ends.
std::optional<CrowdGround::FloorCell> CrowdGround::floor_beside(const FloorCell& from, int32_t x,
                                                                int32_t z) const {
  const int32_t tile_x = world::tile_along(x), tile_z = world::tile_along(z);
  const int32_t lx = world::in_tile(x), lz = world::in_tile(z);
  std::optional<FloorCell> best;
  int32_t best_jump = slope_range_.max_jump + 1;
  const auto consider = [&](Level level) {
    if (!views_[level].has(lx, lz)) return;
    const int32_t height = sample(level, lx, lz);
    const int32_t jump = std::abs(height - from.height);
    if (jump >= best_jump) return;
    best_jump = jump;
    best = FloorCell{level, x, z, height};
  };
  if (tile_x == world::tile_along(from.x) && tile_z == world::tile_along(from.z)) {
    consider(from.level);
    if (best) return best;
  }
  for_tile(tile_x, tile_z, from.height - slope_range_.max_jump, from.height + slope_range_.max_jump,
           consider);
  return best;
}

// The heights along a direction, if all are of one level and inside its tile, as nearly all are.
bool CrowdGround::read_on_level(Level level, int32_t x, int32_t z, steer::Plane direction,
                                int32_t* middle) const {
  const int32_t reach = slope_range_.count * slope_range_.spacing;
  const world::LevelView& view = views_[level];
  if (view.samples == nullptr || std::min(x, z) < reach ||
      std::max(x, z) + reach > world::kInTile) {
    return false;
  }
  const auto spacing = static_cast<float>(slope_range_.spacing);
  const int32_t start = view.samples[world::cell_index(x, z)];
  bool is_whole = true;
  for (const int32_t sign : {-1, 1}) {
    int32_t last = start;
    for (int32_t i = 1; i <= slope_range_.count; ++i) {
      const float far = static_cast<float>(sign * i) * spacing;
      const int32_t next =
          view.samples[world::cell_index(x + static_cast<int32_t>(std::lrint(direction.x * far)),
                                         z + static_cast<int32_t>(std::lrint(direction.z * far)))];
      is_whole &= next != world::kNoValue && std::abs(next - last) <= slope_range_.max_jump;
      middle[sign * i] = view.floor_base + next;
      last = next;
    }
  }
  return is_whole;
}

GroundSlope CrowdGround::slope_along(Level level, world::GroundPoint at,
                                     steer::Plane direction) const {
  constexpr int32_t kMiddle = SlopeRange::kMaxCount;
  std::array<int32_t, 2 * kMiddle + 1> heights{};
  const int32_t x = at.cell_x(), z = at.cell_z();
  const FloorCell here{level, x, z, sample(level, world::in_tile(x), world::in_tile(z))};
  heights[kMiddle] = here.height;
  const auto between = [&](int32_t behind, int32_t ahead) {
    return slope_of(std::span(heights).subspan(static_cast<size_t>(kMiddle - behind),
                                               static_cast<size_t>(behind + ahead + 1)),
                    slope_range_.metres);
  };
  if (read_on_level(level, world::in_tile(x), world::in_tile(z), direction, &heights[kMiddle])) {
    return between(slope_range_.count, slope_range_.count);
  }
  // How many heights there are to one side.
  const auto read = [&](int32_t sign) {
    FloorCell last = here;
    for (int32_t i = 1; i <= slope_range_.count; ++i) {
      const auto far = static_cast<float>(sign * i * slope_range_.spacing);
      const auto next = floor_beside(last, x + static_cast<int32_t>(std::lrint(direction.x * far)),
                                     z + static_cast<int32_t>(std::lrint(direction.z * far)));
      if (!next) return i - 1;
      last = *next;
      heights[static_cast<size_t>(kMiddle + sign * i)] = last.height;
    }
    return slope_range_.count;
  };
  const int32_t behind = read(-1);
  return between(behind, read(1));
}

// Is the square of cells that slope_along may read inside the tile, and in flat blocks? These touch
// each other, so all are equally high.
bool CrowdGround::box_is_level(Level level, world::GroundPoint at) const {
  const int32_t reach = slope_range_.count * slope_range_.spacing;
  const int32_t x = world::in_tile(at.cell_x()), z = world::in_tile(at.cell_z());
  if (std::min(x, z) < reach || std::max(x, z) + reach > world::kInTile) return false;
  const uint32_t wanted =
      (~uint32_t{0} >> (31 - ((x + reach) >> 2))) & (~uint32_t{0} << ((x - reach) >> 2));
  const LevelLine& line = lines_[level];
  for (int32_t block = (z - reach) >> 2; block <= (z + reach) >> 2; ++block) {
    if ((line.flat[static_cast<size_t>(block)] & wanted) != wanted) return false;
  }
  return true;
}

void CrowdGround::find_uneven() {
  for (Level level = 0; level < records_.size(); ++level) {
    if (is_uneven_around(level)) lines_[level].legal_set |= kUneven;
  }
}

// Is a level, or one within a jump of it on its tile or those around, not all at one height?
bool CrowdGround::is_uneven_around(Level level) const {
  if (!views_[level].is_constant()) return true;
  const int32_t height = views_[level].floor_base, jump = slope_range_.max_jump;
  const Record& record = records_[level];
  bool is_uneven = false;
  for (int32_t z = record.tile_z - 1; z <= record.tile_z + 1; ++z) {
    for (int32_t x = record.tile_x - 1; x <= record.tile_x + 1; ++x) {
      for_tile(x, z, height - jump, height + jump, [&](Level other) {
        const world::LevelView& view = views_[other];
        is_uneven = is_uneven || !view.is_constant() || view.floor_base != height;
      });
    }
  }
  return is_uneven;
}

}  // namespace throng::crowd
