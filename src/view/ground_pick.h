// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "throng/impostor_pack.h"
#include "throng/world.h"
#include "view/timeline_frame.h"

namespace throng {

/// A half-line from an eye. `direction` is a unit vector.
struct SightLine {
  Vec3d eye, direction;
};

/// The first ground that a sight line meets, of any of the first `classes` classes, not above
/// `cut`; in the world's coordinates, as the line. Found by steps of a quarter of a metre.
[[nodiscard]] std::optional<Vec3d> ground_on(const World& world, const SightLine& line, double cut,
                                             double farthest);

/// The nearest avatar that a sight line passes within a third of a metre, or `crowd.size()`. Who
/// stands farther than `farthest` or above `cut` is passed over. All relative to the stage's
/// origin.
[[nodiscard]] size_t avatar_on(const TimelineFrame& crowd, const std::vector<double>& class_heights,
                               const SightLine& line, double cut, double farthest);

}  // namespace throng
