// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/fly/flyer_air.h"

#include <algorithm>
#include <cmath>

#include "core/access.h"
#include "core/math/floor_div.h"
#include "world/place.h"
#include "world/tile_grid.h"

// The air of a class in a step's integer units: conversions, lines of sight, and ground-air links.
// Each costs a descent in the air's octree for each air box that a line crosses.
namespace throng::crowd {

FlyerAir::FlyerAir(const World& world, const path::FlightSpace& space, const CrowdGround& ground,
                   int32_t avatar_class)
    : space_(&space),
      ground_(&ground),
      origin_(data_of(world)->summary.origin),
      unit_(data_of(world)->summary.cell / world::kUnitsPerCell),
      per_unit_(1.0 / (static_cast<double>(world::kUnitsPerCell) * space.shape.multiple)),
      width_(static_cast<int32_t>(
          std::min<int64_t>(int64_t{data_of(world)->width} << world::kUnitBits, INT32_MAX))),
      depth_(static_cast<int32_t>(
          std::min<int64_t>(int64_t{data_of(world)->depth} << world::kUnitBits, INT32_MAX))),
      origin_y_(space.shape.origin_y),
      cell_(space.shape.cell) {
  const AvatarClass& avatar = data_of(world)->summary.classes[static_cast<size_t>(avatar_class)];
  height_ = static_cast<int32_t>(std::floor(avatar.height * 1000 + 1e-6));
}

bool FlyerAir::is_open_around(const AirPosition& position, float distance) const {
  const path::AirPoint p = point(position);
  const uint32_t index = space_->box_at(p);
  if (index == path::kNoBox) return false;
  const world::AirCube& box = space_->boxes[index];
  const double cells = static_cast<double>(distance) * 1e3 / cell_;
  const auto inside = [&](double v, int32_t low) {
    return v - cells >= low && v + cells <= low + box.side;
  };
  return inside(p.x, box.x) && inside(p.y, box.y) && inside(p.z, box.z);
}

AirPosition FlyerAir::end_in_box(const AirPosition& from, const AirPosition& to) const {
  constexpr double kMargin = 0.1;  // [air cells] more than what rounding moves the end by
  const path::AirPoint p = point(from), q = point(to);
  const uint32_t index = space_->box_at(p);
  if (index == path::kNoBox) return from;
  const world::AirCube& box = space_->boxes[index];
  double part = 1;
  const auto cut = [&](double a, double b, int32_t low) {
    const double face = b > a ? low + box.side - kMargin : low + kMargin;
    if (b > a ? b > face : b < face) part = std::min(part, (face - a) / (b - a));
  };
  cut(p.x, q.x, box.x);
  cut(p.y, q.y, box.y);
  cut(p.z, q.z, box.z);
  if (!(part > 0)) return from;
  const auto along = [&](int32_t a, int32_t b) {
    return a + static_cast<int32_t>(part * (static_cast<double>(b) - a));
  };
  return {along(from.x, to.x), along(from.z, to.z), along(from.y, to.y)};
}

// As FlightEndpoints::take_off computes it, in whole millimetres.
std::optional<int32_t> FlyerAir::take_off(const AirPosition& feet) const {
  const path::AirPoint p = point(feet);
  const auto x = static_cast<int32_t>(std::floor(p.x)), z = static_cast<int32_t>(std::floor(p.z));
  const int32_t head = feet.y + height_;
  for (int32_t layer = floor_div(feet.y - origin_y_, cell_);; ++layer) {
    const int32_t y = std::max(feet.y, layer * cell_ + origin_y_);
    if (y > head) return {};
    if (space_->box_at(x, layer, z) != path::kNoBox) return y;
  }
}

std::optional<FlyerAir::GroundAirLink> FlyerAir::link_below(const AirPosition& position) const {
  const world::GroundPoint p{position.x, position.z};
  std::optional<GroundAirLink> best;
  const auto range = ground_->feet_range();
  ground_->for_tile(
      world::tile_along(p.cell_x()), world::tile_along(p.cell_z()), range.low, position.y,
      [&](uint32_t level) {
        if (!ground_->is_legal(level, world::in_tile(p.cell_x()), world::in_tile(p.cell_z())))
          return;
        const int32_t feet = ground_->feet(level, p);
        if (feet > position.y || (best && feet <= best->low)) return;
        const auto high = take_off({position.x, position.z, feet});
        if (!high || *high > position.y || !sees(position, {position.x, position.z, *high})) return;
        best = GroundAirLink{feet, *high, level};
      });
  return best;
}

AirPosition FlyerAir::position(const Vec3d& metres) const {
  const auto whole = [](double v) {
    return static_cast<int32_t>(std::clamp(std::floor(v), -2e9, 2e9));
  };
  // Points lie slightly off the faces of cells; rounded down they stay on their side.
  return {whole((metres.x - origin_.x) / unit_), whole((metres.z - origin_.z) / unit_),
          whole(metres.y * 1000)};
}

Vec3d FlyerAir::metres(const AirPosition& position) const {
  // The middle of the millimetre, too: its lower end may be the face of a cell, which a product
  // with an inexact 0.001 misses.
  return {origin_.x + (position.x + 0.5) * unit_, (position.y + 0.5) * 1e-3,
          origin_.z + (position.z + 0.5) * unit_};
}

bool FlyerAir::in_grid(const Vec3d& metres) const {
  if (!std::isfinite(metres.x + metres.y + metres.z) || std::fabs(metres.y) > 1e6) return false;
  const double x = (metres.x - origin_.x) / unit_, z = (metres.z - origin_.z) / unit_;
  return x >= 0 && z >= 0 && x < width_ && z < depth_;
}

int32_t FlyerAir::ceiling() const { return space_->shape.ceiling * cell_ + origin_y_; }

}  // namespace throng::crowd
