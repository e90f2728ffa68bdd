// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "throng/impostor.h"
#include "throng/world.h"
#include "view/timeline_frame.h"

namespace throng::view {

/// A ray from an eye. `direction` is a unit vector.
struct SightLine {
  Vec3d eye, direction;
};

/// The first ground of any class that a sight line meets, not above `cut`. Line and result are in
/// the world's coordinates. Samples the line every quarter of a metre.
[[nodiscard]] std::optional<Vec3d> ground_on(const World& world, const SightLine& line, double cut,
                                             double farthest);

/// The nearest avatar whose axis a sight line passes within 0.35 m, or `crowd.size()`. Avatars
/// farther than `farthest` or above `cut` are skipped. All relative to the stage's origin.
[[nodiscard]] size_t avatar_on(const TimelineFrame& crowd, const std::vector<double>& class_heights,
                               const SightLine& line, double cut, double farthest);

}  // namespace throng::view
