// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "crowd/climb/climb.h"
#include "crowd/fly/flight.h"
#include "path/edits/solid.h"
#include "path/overlay/node_finder.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "throng/world.h"

/// The nodes of a class, as climbers move over them.
namespace throng::crowd {

/// A body stands at `feet` along `axis`. [m]
struct ClimbPose {
  Vec3d feet, axis;
};

/// An upright cylinder that encloses a body, however it leans.
struct ClimbCylinder {
  AirPosition low;     // centre of its bottom
  int32_t radius = 0;  // [units]
  int32_t height = 0;  // [mm]
};

class ClimberGround {
 public:
  /// [the finder is of this class, and outlives this]
  ClimberGround(const World& world, const Nodes& nodes, const path::NodeFinder& finder,
                int32_t avatar_class);

  /// How the class stands on a node; none where it may not.
  [[nodiscard]] std::optional<ClimbPose> pose(uint32_t node1, double s, double t) const;
  [[nodiscard]] std::optional<ClimbPose> pose_of(const Climb& climb, const ClimbStance& at) const;
  /// None if it would lie off the world's grid.
  [[nodiscard]] std::optional<ClimbCylinder> cylinder_of(const ClimbPose& pose,
                                                         double radius) const;
  /// No body of this radius needs a wider or taller cylinder. [m to units, m to mm]
  [[nodiscard]] int32_t widest(double radius) const;
  [[nodiscard]] int32_t tallest(double radius) const;
  /// No point of a body moves farther from one pose to the other. [m]
  [[nodiscard]] double travel(const ClimbPose& from, const ClimbPose& to) const;

  /// The space that a body occupies in a pose. [m]
  [[nodiscard]] path::BodyRoom body_room_of(const ClimbPose& pose, double radius) const;

  struct Step {
    ClimbStance at;
    ClimbPose pose;
  };
  /// As far along the path as no point of the body moves farther than `max_travel`; `retreat`:
  /// back, on a segment through the air. [m]
  [[nodiscard]] std::optional<Step> advance(const Climb& climb, double max_travel) const;
  [[nodiscard]] std::optional<Step> retreat(const Climb& climb, double max_travel) const;
  /// Off the path, on the surface: `displacement` from here, or as far as is proved free.
  [[nodiscard]] std::optional<Step> shift(const Climb& climb, Vec3d displacement,
                                          double max_travel) const;
  /// The vector to the point that it heads to: straight in the patch's parameters, so it begins
  /// along the surface and is as long as the straight line. [m]
  [[nodiscard]] Vec3d path_ahead(const Climb& climb) const;
  /// Has it passed all points of its path, but for those on which it stands?
  [[nodiscard]] bool is_at_end(const Climb& climb) const;
  /// The surface's normal; the body's axis where it is in the air.
  [[nodiscard]] Vec3d normal_at(const Climb& climb) const;

 private:
  struct Square {
    double s0 = 0, t0 = 0, s1 = 0, t1 = 0;
    PatchKind kind = PatchKind::kLevelTile;
    uint32_t source = 0;
    bool partial = false;  ///< Of a partial node: the block, of which some cells may lie outside
                           ///< the node.

    /// (Up to rounding.)
    [[nodiscard]] bool holds(double s, double t) const {
      constexpr double kRounded = 1e-12;
      return s >= s0 - kRounded && s <= s1 + kRounded && t >= t0 - kRounded && t <= t1 + kRounded;
    }
    /// The fraction of the segment from a point inside along (ds, dt) that lies inside, at most 1.
    [[nodiscard]] double part_inside(double s, double t, double ds, double dt) const;
  };
  struct Slope {
    Vec3d along_s, along_t;
  };
  /// The node's square; of a partial node, what is known to be free around a segment to (s, t):
  /// else only the place itself.
  [[nodiscard]] Square square_of(const ClimbStance& at, double s, double t) const;
  [[nodiscard]] Square square_of(uint32_t node1) const;
  [[nodiscard]] Square square_here(const Climb& climb) const;
  [[nodiscard]] Slope slope_at(const Square& square, const ClimbStance& at) const;
  [[nodiscard]] std::optional<ClimbPose> pose_of_point(const Climb& climb, size_t point) const;
  [[nodiscard]] bool enters_next(const Climb& climb, const Square& here, double ds,
                                 double dt) const;
  /// The point to which it heads, or, where it stands on that, the first behind it on which it does
  /// not stand, if there is one; and its pose, so that each is looked up once. [it has a path]
  struct Ahead {
    size_t point;
    std::optional<ClimbPose> pose;
  };
  [[nodiscard]] Ahead point_ahead(const Climb& climb) const;
  [[nodiscard]] bool stands_on(const Climb& climb, const std::optional<ClimbPose>& there) const;
  /// Straight to a pose.
  [[nodiscard]] Vec3d displacement_to(const Climb& climb, const ClimbPose& to) const;
  bool advance_on_surface(const Climb& climb, Step& step, double& max_travel) const;
  bool advance_through_air(const Climb& climb, Step& step, double& max_travel) const;

  const Nodes* nodes_;
  const path::NodeFinder* finder_;
  int32_t avatar_class_;
  Vec3d origin_;
  double unit_ = 0;                         // [m]
  int32_t width_ = 0, depth_ = 0;           // [units]
  double tile_ = 0;                         // [m]
  double height_ = 0, reach_ = 0;           // of the class; of its farthest point from its feet [m]
  double bottom_ = 0, leaning_bottom_ = 0;  // of its body above its feet, upright and not [m]
};

}  // namespace throng::crowd
