// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "throng/base.h"
#include "throng/result.h"
#include "throng/world.h"

/// Queries of the ground around a body: the nearest place, the nearest wall, how far a straight
/// line leads, sliding along walls, random places nearby. A wall is whatever stops the class: a
/// solid, a step that is too high, a slope that is too steep, an edge. All lengths are of the
/// body's middle, in the ground's plane: the solid of a wall is a radius farther.
namespace throng {

/// What makes a cell illegal for a class, as far as a baked world knows: it stores floors and
/// ceilings, not walls. There, or within the class's radius,
enum class Obstacle {
  kNone,
  kGap,     ///< is no floor near the height of the feet on which any class could stand.
  kStep,    ///< is a floor more than the step height up or down, but not the top of a wall.
  kLow,     ///< is less than the class's height below the ceiling.
  kSteep,   ///< is a floor steeper than the class's limit.
  kNarrow,  ///< is a solid: the passage is too narrow, or ends at a wall.
};

/// The result of a straight walk along the ground.
struct GroundRay {
  Place place;           ///< The last place on the line; a straight move leads there.
  bool arrived = false;  ///< The walk reached the end of the line.
  /// Normal of the wall that stopped it, towards the body. [unit]
  double normal_x = 0, normal_z = 0;
  Obstacle obstacle = Obstacle::kNone;  ///< What stopped it.
};

/// The nearest wall around a place.
struct NearestWall {
  bool found = false;                 ///< False: none within the given distance.
  double distance = 0;                ///< [m]
  double x = 0, z = 0;                ///< Its nearest point. [m]
  double normal_x = 0, normal_z = 0;  ///< From there towards the body. [unit]
};

/// Queries of a world's ground for one class. Each has its own memory: give every thread one. No
/// allocation once it is warm. Results are the same on every machine.
class THRONG_API GroundQuery {
 public:
  /// Makes queries for a class; reads nothing yet. Fails with kBadConfig: no such class.
  [[nodiscard]] static Result<GroundQuery> make(const World& world, int32_t avatar_class);
  GroundQuery(GroundQuery&&) noexcept;
  GroundQuery& operator=(GroundQuery&&) noexcept;
  ~GroundQuery();

  /// Checks that all zones within `radius` of a position, seen from above, can be used; queries
  /// take a zone that cannot be used as empty. Reads these zones. Fails with kBadFile and the first
  /// one's name. [m, m]
  [[nodiscard]] Result<void> check_near(Vec3d position, double radius) const;
  /// The place of the class nearest to a position in three dimensions, or nowhere if none is within
  /// `radius`. Time: the tiles that the circle touches. [m, m]
  [[nodiscard]] Place nearest_place(Vec3d position, double radius);
  /// Walks straight from a place by (dx, dz), as far as the ground allows. [m, m]
  [[nodiscard]] GroundRay ray(const Place& from, double dx, double dz);
  /// Slides a body that is pushed by (dx, dz) along walls: of the places connected with `from`
  /// inside the circle whose diameter is the push, the nearest to its end. `from` itself if there
  /// is no better one. [m, m]
  [[nodiscard]] Place slide(const Place& from, double dx, double dz);
  /// The nearest wall within `max_distance` that a straight line from the place can meet. Time: the
  /// cells within that distance. [m]
  [[nodiscard]] NearestWall nearest_wall(const Place& from, double max_distance);
  /// The n-th of a reproducible stream of places, uniform over those connected with `centre` inside
  /// the circle around it. Nowhere only if `centre` is no place of the class. [m]
  [[nodiscard]] Place random_place_near(const Place& centre, double radius, uint64_t seed,
                                        uint64_t n);
  /// Area of these places, to one cell. [m^2]
  [[nodiscard]] double area_near(const Place& centre, double radius);

 private:
  struct State;
  explicit GroundQuery(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
