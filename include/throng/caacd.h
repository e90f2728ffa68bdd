// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "throng/base.h"
#include "throng/math.h"
#include "throng/result.h"

/// Curvilinear avoidance between avatars: pure functions from one body and what is near it to a
/// steering force. No world, no clock, no memory: throng/caacd_experiment.h has the space of the
/// paper, and any crowd may call these. Y is up; walkers live in a plane of equal y. Units are the
/// caller's, if they agree; the paper's time is one frame. Nothing here but sqrt is more than
/// arithmetic, so results are the same bytes everywhere. Coordinates, speeds and settings must be
/// finite and below 1e100. Source: [CAACD] II and III, as docs/algorithms.md reads them.
namespace throng::caacd {

/// Radii of the concentric protection fields of one body, or of a pair. [>= 0, ascending]
struct Fields {
  double repulsive = 0;
  double precaution = 0;
  double alert = 0;
};

/// The fields of a pair: sums, r = A_r + B_r.
[[nodiscard]] THRONG_API Fields joint_fields(const Fields& a, const Fields& b);

/// How near two bodies are, or will be.
enum class State : uint8_t { kTolerable, kAlert, kCritical, kCollision };

/// The state of a pair at a distance. Bounds belong to the inner state: d <= r_rep is a collision.
[[nodiscard]] THRONG_API State state_at(double distance, const Fields& joint);

/// What one avatar knows of another, and of itself.
struct Body {
  Vec3d position;
  Vec3d velocity;
  Vec3d forward{1, 0, 0};  ///< Heading, also while it stands. [unit length]
  Fields fields;
  uint32_t id = 0;  ///< Breaks ties; unique among neighbours.
};

/// A fixed circle; what is solid of it ends at its repulsive field.
struct Obstacle {
  Vec3d position;
  Fields fields;
};

/// How long a vector counts in eq. 10.
enum class Length : uint8_t {
  kTrue,  ///< Its length.
  /// lambda1 max + lambda2 (sum - max) of the absolute coordinates, lambda1 + lambda2 = 1. Never
  /// above sqrt(lambda1^2 + lambda2^2) of the length in a plane, never below the least of lambda1,
  /// 1 / sqrt 2 and, off a plane, (1 + lambda2) / sqrt 3 of it.
  kMaxAndSum,
};

/// What makes an avatar avoid another. Obstacles go by zones alone.
enum class Trigger : uint8_t {
  kNever,   ///< A control: nobody avoids anything.
  kThreat,  ///< Any critical or alert threat: [CAACD] III.A, its last paragraph.
  kNear,    ///< Such a threat within the alert field: who is farther is tolerable, [CAACD] II.
  kZones,   ///< Such a threat whose repulsive zone meets one's own: [CAACD] II, figure 7.
};

/// Along which axes eq. 11 pushes.
enum class Axes : uint8_t { kSide, kSideAndUp };

/// Settings of the model. The first three are the paper's Mass/MaxSpeed/MaxForce, of which it names
/// 2.0/0.4/0.06 the best; it prints no value for the others: ours, see docs/design/007-caacd.md.
struct Model {
  double mass = 2.0;         ///< [> 0]
  double max_speed = 0.4;    ///< [length / time, > 0]
  double max_force = 0.06;   ///< [mass length / time^2, > 0]
  double horizon = 60;       ///< T3: a nearest approach later than this is no threat. [time, > 0]
  double lambda1 = 0.75;     ///< Of eq. 10, see Length. [0.5 to 1; lambda2 is 1 - lambda1]
  double lambda3 = 0.5;      ///< Of eq. 12 and 13: part of max_speed. [0 to 1]
  double deceleration = 30;  ///< Psi: distance to the target at which braking begins. [length, > 0]
  double zone_time = 0;      ///< A repulsive zone reaches A_pre + speed x zone_time. [time, >= 0]
  Length length = Length::kTrue;
  Trigger trigger = Trigger::kNear;
  Axes axes = Axes::kSide;
};

/// Fails with kBadConfig and the setting that is out of its limits.
[[nodiscard]] THRONG_API Result<void> check_model(const Model& model);

/// When two straight courses come nearest, eq. 1 to 6.
struct Approach {
  double speed = 0;  ///< R_s, eq. 2.
  /// A_tau, eq. 6: negative when they part. 0 if R_s is 0: parallel courses have no nearest
  /// approach, and their present distance is judged.
  double time = 0;
};
[[nodiscard]] THRONG_API Approach nearest_approach(const Body& self, const Body& other);

/// Eq. 7 and 8: where a body will be.
[[nodiscard]] THRONG_API Vec3d position_at(const Body& body, double time);

/// Eq. 10: the length of B_Rcp = A_cp - B_cp (eq. 9), as model.length says.
[[nodiscard]] THRONG_API double convergence_distance(Vec3d relative, const Model& model);

/// Somebody or something whose course comes too near.
struct Threat {
  static constexpr uint32_t kObstacle = UINT32_MAX;
  State level = State::kTolerable;  ///< kAlert or kCritical; kTolerable if there is no threat.
  double time = std::numeric_limits<double>::infinity();      ///< A_tau.
  double distance = std::numeric_limits<double>::infinity();  ///< B_d.
  uint32_t id = kObstacle;                                    ///< Whose; kObstacle for an obstacle.
  Vec3d now;                                                  ///< B_p.
  Vec3d self_then;                                            ///< A_cp.
  Vec3d other_then;                                           ///< B_cp.
};

/// What `other` means to `self`: critical if B_d <= r_pre, alert if B_d <= r_alert, both with
/// A_tau in [0, T3) and as model.trigger asks; else tolerable.
[[nodiscard]] THRONG_API Threat threat_of(const Body& self, const Body& other, const Model& model);

/// An obstacle is a critical threat from when the zone overlaps its precaution field, if it lies
/// ahead or around.
[[nodiscard]] THRONG_API Threat threat_of(const Body& self, const Obstacle& obstacle,
                                          const Model& model);

/// Does `a` press more than `b`? The smaller A_tau, then the smaller B_d, then the smaller id.
[[nodiscard]] THRONG_API bool more_urgent(const Threat& a, const Threat& b);

/// The most urgent threat of all. A body in `others` with the id of `self` is left out, as is who
/// is farther away than `reach`.
[[nodiscard]] THRONG_API Threat greatest_threat(const Body& self, std::span<const Body> others,
                                                std::span<const Obstacle> obstacles,
                                                const Model& model, double reach = 1e150);

/// No body farther away than this is a threat to `self`, if none is faster than model.max_speed and
/// none has an alert field beyond `alert`.
[[nodiscard]] THRONG_API double threat_radius(const Body& self, double alert, const Model& model);

/// How far ahead the repulsive zone of a body reaches: a rectangle as wide as the repulsive field,
/// from the position along the heading.
[[nodiscard]] THRONG_API double zone_length(const Body& body, const Model& model);

/// Do two repulsive zones meet? Heights are ignored.
[[nodiscard]] THRONG_API bool zones_meet(const Body& a, const Body& b, const Model& model);

/// Does the zone of `body` overlap a disc? Heights are ignored.
[[nodiscard]] THRONG_API bool zone_overlaps(const Body& body, Vec3d centre, double radius,
                                            const Model& model);

/// The direction to the right of a heading, level.
[[nodiscard]] THRONG_API Vec3d right_of(Vec3d forward);

/// Eq. 11 along the side axis (and the up axis for flyers): away from where the threat will be. If
/// that product is 0, the other dead ahead or behind: to the right of one ahead, to the left of one
/// behind; if both stand in one point, right for the smaller id.
[[nodiscard]] THRONG_API Vec3d lateral_avoidance(const Body& self, const Threat& threat,
                                                 const Model& model);

/// Eq. 12 below lambda3 x max_speed: on. Eq. 13 from there on: faster if the other will pass
/// behind, slower if it will pass in front.
[[nodiscard]] THRONG_API Vec3d forward_avoidance(const Body& self, const Threat& threat,
                                                 const Model& model);

/// Eq. 14, at most max_force long.
[[nodiscard]] THRONG_API Vec3d avoidance(const Body& self, const Threat& threat,
                                         const Model& model);

/// Path amendment: the force that turns towards `target` at full speed, and from psi before the
/// place to stop, `stop_before` ahead of the target, brakes evenly. At most max_force long.
[[nodiscard]] THRONG_API Vec3d path_amendment(const Body& self, Vec3d target, double stop_before,
                                              const Model& model);

/// Eq. 15 with the mass that the text and its experiments have: v + steer / mass x dt, at most
/// max_speed long.
[[nodiscard]] THRONG_API Vec3d steered(Vec3d velocity, Vec3d steer, double dt, const Model& model);

/// The heading of a velocity; `before` if that is (nearly) zero.
[[nodiscard]] THRONG_API Vec3d heading_of(Vec3d velocity, Vec3d before);

/// A change of velocity as curvilinear motion: a_t along the heading changes the speed, a_n across
/// it the direction.
struct Curvilinear {
  double tangential = 0;   ///< Negative when braking.
  double centripetal = 0;  ///< [>= 0]
};
[[nodiscard]] THRONG_API Curvilinear curvilinear(Vec3d forward, Vec3d acceleration);

/// Who goes first when two want one place: the nearer one, then the smaller id.
[[nodiscard]] THRONG_API bool goes_first(const Body& a, Vec3d target_a, const Body& b,
                                         Vec3d target_b);

}  // namespace throng::caacd
