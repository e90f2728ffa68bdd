// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/result.h"

/// Avatar classes: the bodies that one bake serves together.
namespace throng {

/// A body as an upright cylinder, and what it can climb. At most kMaxAvatarClasses in one world.
struct AvatarClass {
  std::string name = "adult";
  double height = 1.75;  ///< [m, 0.1 to 30]
  double radius = 0.25;  ///< [m, 0.01 to 5]
  double step = 0.4;  ///< Largest climb and drop between neighbouring places. [m, 0 to height / 2]
  double max_slope = 45;  ///< Steepest surface it stands on upright. [degrees, 0 to 89]
  double speed = 1.34;    ///< Preferred walking speed. [m/s, > 0]
  /// Steepest surface of a curved patch that it climbs, its axis along the normal: 90 is a wall,
  /// 180 a ceiling. 0: it does not climb. [degrees, 0 to 180]
  double climb_slope = 0;
  /// Deepest that it lets itself down over an edge, one way: a longer way down than its step that
  /// ways over nodes may take. 0: it does not. [m, 0 to 1000]
  double max_drop = 0;
  bool flies = false;  ///< Moves through the air, too.
};

inline constexpr int32_t kMaxAvatarClasses = 16;

/// Do only nodes ([Nodes]) know all the ways of a class that are not through the air?
[[nodiscard]] inline bool goes_over_nodes(const AvatarClass& avatar) {
  return avatar.climb_slope > 0 || avatar.max_drop > 0;
}

/// How high above the feet matter may reach before it stops a body: max(step, radius * tan(slope)).
[[nodiscard]] THRONG_API double body_bottom(const AvatarClass& avatar);

/// adult, child (1.10 m), wheelchair (0.02 m step, 6 % slope), giant (3 m).
[[nodiscard]] THRONG_API std::vector<AvatarClass> default_classes();
/// An adult with wings, radius 0.4 m: not one of the default classes.
[[nodiscard]] THRONG_API AvatarClass flyer_class();

/// Reads classes from a TOML or JSON file: `[[class]] name = "adult" height = 1.75 ...`; missing
/// values take AvatarClass's defaults. Fails with kBadFile and the line, key and limit.
[[nodiscard]] THRONG_API Result<std::vector<AvatarClass>> load_classes(const std::string& path);

/// Checks limits, names (non-empty, distinct) and count. Fails with kBadConfig and the class.
[[nodiscard]] THRONG_API Result<void> check_classes(std::span<const AvatarClass> classes);

}  // namespace throng
