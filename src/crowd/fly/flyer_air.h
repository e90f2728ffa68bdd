// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "crowd/fly/flight.h"
#include "crowd/ground/crowd_ground.h"
#include "path/air/flight_space.h"
#include "throng/world.h"
#include "world/tile_grid.h"

/// The air of a class as a step reads it, and its links to the ground.
namespace throng::crowd {

class FlyerAir {
 public:
  /// The space and the ground outlive it.
  FlyerAir(const World& world, const path::FlightSpace& space, const CrowdGround& ground,
           int32_t avatar_class);

  /// May feet be at this position in the air?
  [[nodiscard]] bool is_legal(const AirPosition& position) const {
    return space_->box_at(point(position)) != path::kNoBox;
  }
  /// Is the straight line legal, with both ends?
  [[nodiscard]] bool sees(const AirPosition& from, const AirPosition& to) const {
    return space_->sees(point(from), point(to));
  }
  /// Is all legal that is nearer than `distance` to a legal point? A quick test: false may be
  /// wrong. [m]
  [[nodiscard]] bool is_open_around(const AirPosition& position, float distance) const;

  /// The end of the part of a line that lies in the box of the air in which it begins.
  [[nodiscard]] AirPosition end_in_box(const AirPosition& from, const AirPosition& to) const;

  /// Where the air begins straight above feet on the ground, at most a body's height higher; none
  /// if a solid blocks it. [mm]
  [[nodiscard]] std::optional<int32_t> take_off(const AirPosition& feet) const;
  /// The ground straight below a point of the air, and where the air begins above that ground.
  struct GroundAirLink {
    int32_t low = 0, high = 0;  // [mm]
    uint32_t level = 0;
  };
  [[nodiscard]] std::optional<GroundAirLink> link_below(const AirPosition& position) const;

  /// Is the ground of a level legal at this position now?
  [[nodiscard]] bool may_stand(uint32_t level, const AirPosition& position) const {
    return ground_->is_legal(level, world::in_tile(position.x >> world::kUnitBits),
                             world::in_tile(position.z >> world::kUnitBits));
  }

  [[nodiscard]] AirPosition position(const Vec3d& metres) const;
  [[nodiscard]] Vec3d metres(const AirPosition& position) const;
  /// Inside the world's grid, and at a height that millimetres can hold?
  [[nodiscard]] bool in_grid(const Vec3d& metres) const;
  /// The lowest height that is open sky. [mm]
  [[nodiscard]] int32_t ceiling() const;

 private:
  [[nodiscard]] path::AirPoint point(const AirPosition& position) const {
    return {(position.x + 0.5) * per_unit_, static_cast<double>(position.y - origin_y_) / cell_,
            (position.z + 0.5) * per_unit_};
  }

  const path::FlightSpace* space_;
  const CrowdGround* ground_;
  Vec3d origin_;
  double unit_, per_unit_;            // [m], [air cells]
  int32_t width_, depth_;             // [units], clamped to int32_t
  int32_t origin_y_, cell_, height_;  // [mm]
};

}  // namespace throng::crowd
