// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "throng/base.h"

/// Avatars: their classes, the state of one, the lean of a body, the rule by which it steers.
namespace throng {

// ----
// Avatar classes: the kinds of bodies that a world is baked for.

/// An avatar class: the body, an upright cylinder, and its abilities. A world has at most
/// kMaxAvatarClasses.
struct AvatarClass {
  std::string name = "adult";
  double height = 1.75;  ///< [m, 0.1 to 30]
  /// The default is a disc with the area of an adult seen from above in street dress, 0.113 m2
  /// [PM78]; flows at doors and speeds by density are tested with it. [m, 0.01 to 5]
  double radius = 0.19;
  /// The step height: largest climb or descent between neighbouring places. [m, 0 to height / 2]
  double step_height = 0.4;
  double max_slope = 45;  ///< Steepest surface on which it stands upright. [degrees, 0 to 89]
  double speed = 1.34;    ///< Desired speed. [m/s, > 0]
  /// Steepest surface of a patch that it climbs, its axis along the surface's normal: 90 is a wall,
  /// 180 a ceiling. 0: it does not climb. [degrees, 0 to 180]
  double climb_slope = 0;
  /// Largest descent over an edge by a drop link, which is one-way; only paths over nodes use
  /// these. 0: none. [m, 0 to 1000]
  double max_drop = 0;
  /// On foot, the direction of its velocity turns in a step by at most speed x dt / turning_radius,
  /// as that of a cart. A sharper turn slows it down, a much sharper one stops it, and from a stop
  /// it starts in any direction. 0: no bound. [m, 0 to 100]
  double turning_radius = 0;
  bool flies = false;  ///< It also moves through the air.
};

/// Maximum number of classes of a world.
inline constexpr int32_t kMaxAvatarClasses = 16;

/// Does the class climb or drop, so that paths over level tiles lack some of its links and it needs
/// Nodes?
[[nodiscard]] inline bool goes_over_nodes(const AvatarClass& avatar) {
  return avatar.climb_slope > 0 || avatar.max_drop > 0;
}

/// Height above the feet from which a body's cylinder begins, so that lower solids do not stop it:
/// max(step, radius * tan(max_slope)). [m]
[[nodiscard]] THRONG_API double body_bottom(const AvatarClass& avatar);

/// The default classes: adult; child (1.10 m tall); wheelchair (0.60 m wide, for doors of 0.8 m and
/// ramps of 1:12 at cells of 0.1 m; 0.02 m step); giant (3 m tall), for games.
[[nodiscard]] THRONG_API std::vector<AvatarClass> default_classes();
/// An adult that flies, radius 0.4 m. It is none of the default classes.
[[nodiscard]] THRONG_API AvatarClass flyer_class();

/// Reads classes from a TOML or JSON file: `[[class]] name = "adult" height = 1.75 ...`; missing
/// values are those of AvatarClass. Fails with kBadFile and the line, key and limit.
[[nodiscard]] THRONG_API Result<std::vector<AvatarClass>> load_classes(const std::string& path);

/// Checks limits, names (non-empty, distinct) and count. Fails with kBadConfig and the class.
[[nodiscard]] THRONG_API Result<void> check_classes(std::span<const AvatarClass> classes);

// ----
// The state of an avatar that a crowd reports, and the result of its self-check.

/// Faults found by an independent check of the present positions. All must be 0.
struct CrowdCheck {
  uint64_t wall_entries = 0;      ///< Avatars on a cell where their class is not legal.
  uint64_t overlaps = 0;          ///< Pairs whose discs and heights both overlap.
  uint64_t obstacle_entries = 0;  ///< Pairs of an avatar and an obstacle that overlap.
};

/// How an avatar moves at this moment.
enum class MoveMode {
  kWalk,   ///< On the ground of its class.
  kFly,    ///< In the air, or in a take-off or landing.
  kClimb,  ///< Over nodes.
  kLink,   ///< Along an off-mesh link of Edits.
};

/// The state of one avatar.
struct AvatarState {
  uint32_t id = 0;
  int32_t avatar_class = 0;
  Vec3d position;     ///< Y at the feet. [m]
  double radius = 0;  ///< Of the body. [m]
  /// Orientation, a unit vector in the ground plane. An avatar of a crowd with goals turns by at
  /// most 120 degrees a second towards the direction in which it walks, little by little if it is
  /// slow, and keeps its orientation while it stands; a new one faces its preferred velocity after
  /// its first step, before that +Z. For an avatar that leans: before the lean; leaned() of
  /// avatar.h gives the direction in which it faces.
  double heading_x = 0, heading_z = 0;
  /// Over the last step, in crowds with goals. Y is 0 but in the air and over nodes. [m/s]
  Vec3d velocity;
  MoveMode mode = MoveMode::kWalk;
  /// Unit vector along the body from the feet; for climbers the surface's normal.
  Vec3d up{0, 1, 0};
};

// ----
// The lean of bodies whose axis is not upright: climbers stand along the surface's normal.

/// Turns a vector as a body leans: by the smallest rotation that takes straight up to `up`, and by
/// half a turn around X if `up` is straight down. [up: unit length]
inline Vec3d leaned(Vec3d v, Vec3d up) {
  if (up.y < -0.999999) return {v.x, -v.y, -v.z};
  const Vec3d by{up.z, 0, -up.x}, turned = cross(by, v);
  return v + turned + cross(by, turned) * (1 / (1 + up.y));
}
/// The inverse of leaned().
inline Vec3d unleaned(Vec3d v, Vec3d up) { return leaned(v, {-up.x, up.y, -up.z}); }

// ----
// Steering models: how avatars on foot avoid each other.

/// The function that decides at which velocity an avatar would walk. Whatever the model, the moves
/// pass the same tests: avatars never overlap and never enter a wall. docs/algorithms.md, "Models".
enum class SteeringModel : uint8_t {
  kSampled,      ///< "sampled": our own; velocities are sampled and their costs compared.
  kCurvilinear,  ///< "caacd": [CAACD] as printed, scaled to bodies and speeds.
  kSocialForce,  ///< "social-force": [HM95] as printed, walls included.
};

/// The name of a model in scenario files and on the command line.
[[nodiscard]] THRONG_API const char* name_of(SteeringModel model);
/// The model with a name, or none.
[[nodiscard]] THRONG_API std::optional<SteeringModel> find_steering_model(std::string_view name);
/// All names, "a, b or c", for messages.
[[nodiscard]] THRONG_API const char* steering_model_names();

}  // namespace throng
