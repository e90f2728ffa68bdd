// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/result.h"

/// Avatar classes: the kinds of bodies that a world is baked for.
namespace throng {

/// An avatar class: the body, an upright cylinder, and its abilities. A world has at most
/// kMaxAvatarClasses.
struct AvatarClass {
  std::string name = "adult";
  double height = 1.75;  ///< [m, 0.1 to 30]
  double radius = 0.25;  ///< [m, 0.01 to 5]
  /// The step height: largest climb or descent between neighbouring places. [m, 0 to height / 2]
  double step = 0.4;
  double max_slope = 45;  ///< Steepest surface on which it stands upright. [degrees, 0 to 89]
  double speed = 1.34;    ///< Desired speed. [m/s, > 0]
  /// Steepest surface of a patch that it climbs, its axis along the surface's normal: 90 is a wall,
  /// 180 a ceiling. 0: it does not climb. [degrees, 0 to 180]
  double climb_slope = 0;
  /// Largest descent over an edge by a drop link, which is one-way; only paths over nodes use
  /// these. 0: none. [m, 0 to 1000]
  double max_drop = 0;
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

/// The default classes: adult, child (1.10 m), wheelchair (0.02 m step, 6 % slope), giant (3 m).
[[nodiscard]] THRONG_API std::vector<AvatarClass> default_classes();
/// An adult that flies, radius 0.4 m. It is none of the default classes.
[[nodiscard]] THRONG_API AvatarClass flyer_class();

/// Reads classes from a TOML or JSON file: `[[class]] name = "adult" height = 1.75 ...`; missing
/// values are those of AvatarClass. Fails with kBadFile and the line, key and limit.
[[nodiscard]] THRONG_API Result<std::vector<AvatarClass>> load_classes(const std::string& path);

/// Checks limits, names (non-empty, distinct) and count. Fails with kBadConfig and the class.
[[nodiscard]] THRONG_API Result<void> check_classes(std::span<const AvatarClass> classes);

}  // namespace throng
