// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "crowd/crowd_ground.h"
#include "crowd/flight.h"
#include "path/flight_space.h"
#include "throng/world.h"

/// The air of a class as a step reads it, and what joins it to the ground.
namespace throng {

class FlyerAir {
 public:
  /// Both outlive it.
  FlyerAir(const World& world, const FlightSpace& space, const CrowdGround& ground,
           int32_t avatar_class);

  /// May the feet be there, in the air?
  [[nodiscard]] bool is_legal(const AirSpot& spot) const {
    return space_->box_at(point(spot)) != kNoBox;
  }
  /// Is the straight way legal, and both ends?
  [[nodiscard]] bool sees(const AirSpot& from, const AirSpot& to) const {
    return space_->sees(point(from), point(to));
  }
  /// Is all legal that is less than so far from a legal point? A quick look: may say no. [m]
  [[nodiscard]] bool is_open_around(const AirSpot& spot, float reach) const;

  /// Straight above feet on the ground the air begins there, not more than a body higher; nothing
  /// where matter is in the way. [mm]
  [[nodiscard]] std::optional<int32_t> take_off(const AirSpot& feet) const;
  /// The ground straight below a point of the air, and where the air begins above it.
  struct Port {
    int32_t low = 0, high = 0;  // [mm]
    uint32_t level = 0;
  };
  [[nodiscard]] std::optional<Port> port_below(const AirSpot& spot) const;

  /// Is the ground of a level legal there now?
  [[nodiscard]] bool may_stand(uint32_t level, const AirSpot& spot) const {
    return ground_->is_legal(level, (spot.x >> kUnitBits) & 63, (spot.z >> kUnitBits) & 63);
  }

  [[nodiscard]] AirSpot spot(const Vec3d& metres) const;
  [[nodiscard]] Vec3d metres(const AirSpot& spot) const;
  /// Off the world's grid, or too far up or down for millimetres?
  [[nodiscard]] bool in_grid(const Vec3d& metres) const;
  /// The lowest height that is open sky. [mm]
  [[nodiscard]] int32_t ceiling() const;

 private:
  [[nodiscard]] AirPoint point(const AirSpot& spot) const {
    return {(spot.x + 0.5) * per_unit_, static_cast<double>(spot.y - origin_y_) / cell_,
            (spot.z + 0.5) * per_unit_};
  }

  const FlightSpace* space_;
  const CrowdGround* ground_;
  Vec3d origin_;
  double unit_, per_unit_;            // [m], [air cells]
  int32_t width_, depth_;             // [units], not more than int32_t holds
  int32_t origin_y_, cell_, height_;  // [mm]
};

}  // namespace throng
