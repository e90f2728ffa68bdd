// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "throng/base.h"

/// Steering of one body by [CAACD], which a crowd of SteeringModel::kCurvilinear uses, too.
namespace throng::caacd {

// ----
// Curvilinear avoidance between avatars: pure functions from one body and its neighbours to a
// steering force. They need no world, no clock and no memory, so any crowd may call them; the
// paper's own space is in papers.h (Space, Simulation). Y is up; walkers have equal y. Units are
// the caller's, but must agree; the paper's time unit is one frame. Only arithmetic and sqrt are
// used, so results are the same bytes on every machine. Coordinates, speeds and settings must be
// finite and below 1e100. Source: [CAACD] II and III, as docs/algorithms.md reads them.

/// Radii of the concentric protection fields of one body, or of a pair. [>= 0, ascending]
struct Fields {
  double repulsive = 0;
  double precaution = 0;
  double alert = 0;
};

/// The fields of a pair of bodies: the sums of their radii, r = A_r + B_r.
[[nodiscard]] THRONG_API Fields joint_fields(const Fields& a, const Fields& b);

/// The state of a pair: by the field of the pair in which their distance lies.
enum class State : uint8_t { kTolerable, kAlert, kCritical, kCollision };

/// The state of a pair at a distance. A bound belongs to the inner state: d <= r_rep is a
/// collision.
[[nodiscard]] THRONG_API State state_at(double distance, const Fields& joint);

/// An avatar as the functions below see it: oneself or another one.
struct Body {
  Vec3d position;
  Vec3d velocity;
  Vec3d forward{1, 0, 0};  ///< Heading, also while it stands. [unit length]
  Fields fields;
  uint32_t id = 0;  ///< Breaks ties; unique among neighbours.
};

/// A fixed circle. Its solid part ends at its repulsive field.
struct Obstacle {
  Vec3d position;
  Fields fields;
};

/// How eq. 10 measures the length of a vector.
enum class Length : uint8_t {
  kTrue,  ///< Its length.
  /// lambda1 max + lambda2 (sum - max) of the absolute coordinates, lambda1 + lambda2 = 1. In a
  /// plane it is at most sqrt(lambda1^2 + lambda2^2) of the true length; it is at least the minimum
  /// of lambda1, 1 / sqrt 2 and, off a plane, (1 + lambda2) / sqrt 3 of it.
  kMaxAndSum,
};

/// What makes an avatar avoid another one. For obstacles the probe alone decides.
enum class Trigger : uint8_t {
  kNever,   ///< For comparison: no avatar avoids anything.
  kThreat,  ///< Any critical or alert threat: [CAACD] III.A, last paragraph.
  kNear,    ///< Such a threat inside the alert field; farther ones are tolerable: [CAACD] II.
  kZones,   ///< Such a threat whose probe meets one's own: [CAACD] II, figure 7.
};

/// The axes along which eq. 11 pushes.
enum class Axes : uint8_t { kSide, kSideAndUp };

/// Settings of the model. The first three are the paper's Mass/MaxSpeed/MaxForce, of which it names
/// 2.0/0.4/0.06 the best; it prints no values for the others, which are ours:
/// docs/design/007-caacd.md.
struct Model {
  double mass = 2.0;        ///< [> 0]
  double max_speed = 0.4;   ///< [length / time, > 0]
  double max_force = 0.06;  ///< [mass length / time^2, > 0]
  double horizon = 60;      ///< T3: a nearest approach later than this is no threat. [time, > 0]
  double lambda1 = 0.75;    ///< Of eq. 10, see Length; lambda2 is 1 - lambda1. [0.5 to 1]
  double lambda3 = 0.5;     ///< Share of max_speed in eq. 12 and 13. [0 to 1]
  /// Psi: distance from the target at which braking begins. [length, > 0]
  double deceleration = 30;
  double probe_time = 0;  ///< The length of a probe is A_pre + speed x probe_time. [time, >= 0]
  Length length = Length::kTrue;
  Trigger trigger = Trigger::kNear;
  Axes axes = Axes::kSide;
};

/// Checks the settings. Fails with kBadConfig and the setting that is out of its limits.
[[nodiscard]] THRONG_API Result<void> check_model(const Model& model);

/// The nearest approach of two straight courses, eq. 1 to 6.
struct Approach {
  double speed = 0;  ///< R_s, eq. 2: the relative speed.
  /// A_tau, eq. 6: time until the nearest approach, negative if the courses diverge. 0 if R_s is 0:
  /// parallel courses have no nearest approach, so the present distance counts.
  double time = 0;
};
/// The nearest approach of `other` to `self`.
[[nodiscard]] THRONG_API Approach nearest_approach(const Body& self, const Body& other);

/// Position of a body after a time, eq. 7 and 8.
[[nodiscard]] THRONG_API Vec3d position_at(const Body& body, double time);

/// The length of B_Rcp = A_cp - B_cp (eq. 9) by eq. 10, measured as model.length says.
[[nodiscard]] THRONG_API double convergence_distance(Vec3d relative, const Model& model);

/// A body or obstacle whose course comes too near.
struct Threat {
  static constexpr uint32_t kObstacle = UINT32_MAX;
  State state = State::kTolerable;  ///< kAlert or kCritical; kTolerable if there is no threat.
  double time = std::numeric_limits<double>::infinity();      ///< A_tau.
  double distance = std::numeric_limits<double>::infinity();  ///< B_d.
  uint32_t id = kObstacle;  ///< Body::id of the threat; kObstacle for an obstacle.
  Vec3d now;                ///< B_p.
  Vec3d self_then;          ///< A_cp.
  Vec3d other_then;         ///< B_cp.
};

/// The threat that `other` is to `self`: critical if B_d <= r_pre, alert if B_d <= r_alert, both
/// with A_tau in [0, T3) and by model.trigger; else tolerable.
[[nodiscard]] THRONG_API Threat threat_of(const Body& self, const Body& other, const Model& model);

/// The threat that an obstacle is to `self`: critical as soon as the probe overlaps its precaution
/// field, if it lies ahead or around.
[[nodiscard]] THRONG_API Threat threat_of(const Body& self, const Obstacle& obstacle,
                                          const Model& model);

/// Is `a` more urgent than `b`? The smaller A_tau is, then the smaller B_d, then the smaller id.
[[nodiscard]] THRONG_API bool more_urgent(const Threat& a, const Threat& b);

/// The most urgent threat. A body in `others` with the id of `self` is ignored, as are bodies
/// farther away than `search_radius`.
[[nodiscard]] THRONG_API Threat greatest_threat(const Body& self, std::span<const Body> others,
                                                std::span<const Obstacle> obstacles,
                                                const Model& model, double search_radius = 1e150);

/// Distance beyond which no body is a threat to `self`, if none is faster than model.max_speed and
/// none has an alert field larger than `alert`.
[[nodiscard]] THRONG_API double threat_radius(const Body& self, double alert, const Model& model);

/// Length of a body's probe: a rectangle as wide as the repulsive field, from the position along
/// the heading.
[[nodiscard]] THRONG_API double probe_length(const Body& body, const Model& model);

/// Do two probes overlap? Heights are ignored.
[[nodiscard]] THRONG_API bool probes_meet(const Body& a, const Body& b, const Model& model);

/// Does the probe of `body` overlap a disc? Heights are ignored.
[[nodiscard]] THRONG_API bool probe_overlaps(const Body& body, Vec3d centre, double radius,
                                             const Model& model);

/// The horizontal unit vector to the right of a heading.
[[nodiscard]] THRONG_API Vec3d right_of(Vec3d forward);

/// The lateral force, eq. 11: along the side axis (and the up axis for flyers), away from where the
/// threat will be. If that product is 0, the other is dead ahead or behind: to the right of one
/// ahead, to the left of one behind; if both are in one point, to the right for the smaller id.
[[nodiscard]] THRONG_API Vec3d lateral_avoidance(const Body& self, const Threat& threat,
                                                 const Model& model);

/// The forward force. Below lambda3 x max_speed by eq. 12: on. From there on by eq. 13: faster if
/// the other will pass behind, slower if it will pass in front.
[[nodiscard]] THRONG_API Vec3d forward_avoidance(const Body& self, const Threat& threat,
                                                 const Model& model);

/// The avoidance force, eq. 14, at most max_force long.
[[nodiscard]] THRONG_API Vec3d avoidance(const Body& self, const Threat& threat,
                                         const Model& model);

/// The force of path amendment: it turns towards `target` at full speed. From psi before the place
/// to stop, which is `stop_before` ahead of the target, it brakes evenly. At most max_force long.
[[nodiscard]] THRONG_API Vec3d path_amendment(const Body& self, Vec3d target, double stop_before,
                                              const Model& model);

/// The new velocity, eq. 15 with the mass that the text and its experiments have: v + steer / mass
/// x dt, at most max_speed long.
[[nodiscard]] THRONG_API Vec3d steered(Vec3d velocity, Vec3d steer, double dt, const Model& model);

/// The heading of a velocity, or `before` if the velocity is (nearly) zero.
[[nodiscard]] THRONG_API Vec3d heading_of(Vec3d velocity, Vec3d before);

/// An acceleration as curvilinear motion: a_t along the heading changes the speed, a_n across it
/// the direction.
struct Curvilinear {
  double tangential = 0;   ///< Negative when braking.
  double centripetal = 0;  ///< [>= 0]
};
/// Splits an acceleration into its parts along and across a heading.
[[nodiscard]] THRONG_API Curvilinear curvilinear(Vec3d forward, Vec3d acceleration);

/// Does `a` go first when both head to one place? The nearer one does, then the smaller id.
[[nodiscard]] THRONG_API bool goes_first(const Body& a, Vec3d target_a, const Body& b,
                                         Vec3d target_b);

}  // namespace throng::caacd
