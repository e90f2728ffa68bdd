// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "throng/base.h"
#include "throng/result.h"
#include "throng/world.h"

/// What is around a body: the nearest place to stand, the nearest wall, how far a line goes, where
/// a push along a wall leads, somewhere near. A wall is whatever stops the class: matter, a step
/// too high, a slope too steep, an edge. All lengths are of the middle of the body, in the ground's
/// plane: the matter of a wall is a radius further.
namespace throng {

/// What keeps a class from standing on a cell, as far as a baked world tells: it knows floors and
/// ceilings, not walls. There, or within the class's radius,
enum class Obstacle {
  kNone,
  kGap,     ///< is no floor near the height of the feet that any class could stand on.
  kStep,    ///< is a floor more than the class's step up or down, but not a wall's top.
  kLow,     ///< is less than the class's height below the ceiling.
  kSteep,   ///< is a floor steeper than the class's limit.
  kNarrow,  ///< is matter: the way is too narrow, or ends at a wall.
};

/// How far a straight line along the ground leads.
struct GroundRay {
  Place place;                          ///< The last place on it; a straight move leads there.
  bool arrived = false;                 ///< At the line's end.
  double normal_x = 0, normal_z = 0;    ///< Of the wall that ended it, towards the body. [unit]
  Obstacle obstacle = Obstacle::kNone;  ///< What ended it.
};

/// The nearest wall around a place.
struct NearestWall {
  bool found = false;                 ///< False: none within the asked distance.
  double distance = 0;                ///< [m]
  double x = 0, z = 0;                ///< Where it is. [m]
  double normal_x = 0, normal_z = 0;  ///< From there towards the body. [unit]
};

/// Asks about the ground of a world for one class. Each has its own memory: give every thread one.
/// No allocation once it is warm. Answers are the same on every machine.
class THRONG_API GroundQuery {
 public:
  /// Reads nothing yet. Fails with kBadConfig: no such class.
  [[nodiscard]] static Result<GroundQuery> make(const World& world, int32_t avatar_class);
  GroundQuery(GroundQuery&&) noexcept;
  GroundQuery& operator=(GroundQuery&&) noexcept;
  ~GroundQuery();

  /// Can all zones of the world be used that come as near to a position, seen from above? Look-ups
  /// take others for empty. Reads these zones. Fails with kBadFile and the first one's name. [m, m]
  [[nodiscard]] Result<void> check_near(Vec3d position, double radius) const;
  /// The place of the class that is nearest to a position, in all three dimensions, or nowhere
  /// within `radius`. Time: the tiles that the circle touches. [m, m]
  [[nodiscard]] Place nearest_place(Vec3d position, double radius);
  /// The straight way from a place by (dx, dz), as far as it goes.
  [[nodiscard]] GroundRay ray(const Place& from, double dx, double dz);
  /// Where a push by (dx, dz) leads along walls: of the places that hold together with `from`
  /// inside the circle over the push, the nearest to its end. `from` itself if there is no better.
  [[nodiscard]] Place slide(const Place& from, double dx, double dz);
  /// The nearest wall within `most` metres that a straight line from the place can meet. Time: the
  /// cells that are as near.
  [[nodiscard]] NearestWall nearest_wall(const Place& from, double max_distance);
  /// The n-th of a reproducible stream of places, uniform over those that hold together with
  /// `centre` inside the circle of that radius around it. Nowhere only if `centre` is no place of
  /// the class.
  [[nodiscard]] Place random_place_near(const Place& centre, double radius, uint64_t seed,
                                        uint64_t n);
  /// Area of those places, to a cell. [m^2]
  [[nodiscard]] double area_near(const Place& centre, double radius);

 private:
  struct State;
  explicit GroundQuery(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
