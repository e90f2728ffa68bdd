// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "throng/avatar.h"
#include "throng/crowd.h"
#include "throng/scenario.h"
#include "throng/scene.h"
#include "throng/world.h"

/// A crowd on a plane with walls, and the state of its avatars after every step.
namespace throng::validate {

/// A point of the plane. [m]
struct Point2 {
  double x = 0, z = 0;
};

/// Position and velocity of an avatar, seen from above.
struct AvatarMotion {
  AvatarId id;
  double x = 0, z = 0;    ///< [m]
  double vx = 0, vz = 0;  ///< Over the last step. [m/s]
  double heading_x = 0;   ///< Orientation, as AvatarState has it.
  double heading_z = 0;
};

/// Cell size of the world: walls are exact to this. [m]
inline constexpr double kCell = 0.05;

/// The tuning of the crowds of tests.
CrowdTuning tuning_of(const ValidationConfig& config);

Polygon box(double x0, double z0, double x1, double z1);

/// Bakes a world for one class from polygons.
Result<World> bake_plane(const PlaneConfig& plane, const AvatarClass& body,
                         const ValidationConfig& config, Context& context);

class PlaneCrowd {
 public:
  /// A crowd in a world of bake_plane, with steps of `dt`. [s]
  static Result<PlaneCrowd> create(const World& world, Routing routing,
                                   const ValidationConfig& config, double dt = kStep);
  /// The same in a world of its own, with steps of kStep.
  static Result<PlaneCrowd> create(const PlaneConfig& plane, const AvatarClass& body,
                                   Routing routing, const ValidationConfig& config,
                                   Context& context);

  /// Adds avatars with the given speeds; the id is null where an avatar does not fit.
  Result<std::vector<AvatarId>> add(std::span<const Point2> starts, std::span<const double> speeds,
                                    Context& context);
  /// Adds avatars and leaves out those that do not fit. Returns the ids of those added.
  Result<std::vector<AvatarId>> add_fitting(std::span<const Point2> starts, double speed,
                                            Context& context);
  /// Sets the goal of an avatar. False if no avatar of the class can stand there.
  bool set_goal(AvatarId id, Point2 goal);
  void remove(std::span<const AvatarId> ids) { crowd_.remove(ids); }
  void set_velocities(std::span<const AvatarId> ids, std::span<const Vec3d> velocities) {
    crowd_.set_velocities(ids, velocities);
  }
  /// One step; every tenth step is checked for faults.
  void step();
  /// All avatars, by slot.
  [[nodiscard]] const std::vector<AvatarMotion>& avatars() const { return avatars_; }
  [[nodiscard]] std::span<const AvatarId> arrived() const { return crowd_.arrived(); }
  [[nodiscard]] uint32_t size() const { return crowd_.size(); }
  [[nodiscard]] double time() const { return static_cast<double>(steps_) * dt_; }
  /// Adds the faults found and the number of checks to a result.
  void report(ValidationResult& result) const;

  static constexpr double kStep = 0.1;  ///< Of most tests. [s]

 private:
  PlaneCrowd(const World& world, Crowd crowd, double dt)
      : world_(world), crowd_(std::move(crowd)), dt_(dt) {}
  void observe(bool has_moved);

  World world_;
  Crowd crowd_;
  double dt_ = kStep;
  uint64_t steps_ = 0, checks_ = 0;
  CrowdCheck faults_;
  std::vector<AvatarId> id_of_slot_;
  std::vector<AvatarState> states_;
  std::vector<AvatarMotion> avatars_;
  std::vector<Point2> last_position_;  // by slot
};

}  // namespace throng::validate
