// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

/// Between the ground and the air: where feet that rise from the ground come into legal voxels.
namespace throng::world {

/// Points keep so far off the faces of voxels, so that a line between two never runs along one.
/// [voxels]
inline constexpr double kAirSkin = 1.0 / 1024;

/// The nearest such coordinate in the same voxel. [voxels]
inline double off_faces(double v) {
  const double low = std::floor(v);
  return std::clamp(v, low + kAirSkin, low + 1 - kAirSkin);
}

/// Straight up from feet on the ground: the height at which they come into the first legal voxel of
/// their column, if that is not above the head. The body on the ground is clear from its bottom to
/// its height, the body in the air from its feet to its height: if the feet in the air are not
/// above the head on the ground, so is everything between the two. is_legal(y): of the column's
/// voxel with the middle y + 0.5. [voxels]
template <class IsLegal>
[[nodiscard]] std::optional<double> take_off_height(double feet, double head, IsLegal is_legal) {
  for (double y = std::floor(feet); y <= head; y += 1) {
    const double at = std::max(y + kAirSkin, off_faces(feet));
    if (at > head) break;
    if (is_legal(y)) return at;
  }
  return std::nullopt;
}

}  // namespace throng::world
