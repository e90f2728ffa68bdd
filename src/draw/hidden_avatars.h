// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "draw/depth_pyramid.h"
#include "throng/impostor.h"

namespace throng::draw {

/// The extent of what is drawn of a figure, from its middle. [m]
struct FigureExtent {
  float across = 0;  ///< On the card that faces the eye.
  float front = 0;   ///< From the card towards the eye.
};

/// One for each view of an atlas.
[[nodiscard]] std::vector<FigureExtent> extents_of(const Atlas& atlas);

/// Tests whether all that could be drawn of a figure lies behind what is in the picture.
class HiddenAvatars {
 public:
  HiddenAvatars(const EyeCamera& camera, const DepthPyramid& depths);
  /// `middle`: of the figure, relative to the same point as the camera.
  [[nodiscard]] bool hides(Vec3d middle, FigureExtent extent) const;
  /// A point has one depth, its middle's.
  [[nodiscard]] bool hides_point(Vec3d middle, double half_size) const;

 private:
  [[nodiscard]] bool hides(Vec3d to, double min_depth, double max_depth, double across,
                           double nearest) const;
  EyeCamera camera_;
  CameraAxes axes_;
  double up_ = 0, right_ = 0;     // Slopes of the picture's borders.
  double scale_ = 0, shift_ = 0;  // From depth along the view to the card's.
  const DepthPyramid& depths_;
};

}  // namespace throng::draw
