// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// A test of what the part of a picture drawn so far certainly hides. Source: [GKM93].
namespace throng::draw {

/// A rectangle of a picture and the depth of the nearest point behind it, all from -1 to 1 as
/// OpenGL's normalised device coordinates.
struct NdcBox {
  double left = 0, right = 0, low = 0, high = 0, nearest = 0;
};

/// The furthest depth of each block of samples, in levels: each halves the one before.
class DepthPyramid {
 public:
  static constexpr int32_t kBlock = 8;  ///< Samples along a side of a texel of level 0.

  /// `furthest`: of each block of a picture of `width` x `height` samples, rows from below,
  /// [0 to 1] as the card keeps depth.
  void set(std::span<const float> furthest, int32_t width, int32_t height);
  /// Does every sample of the box show something nearer than the box? Never true of a box that some
  /// sample shows, nor of one outside the picture.
  [[nodiscard]] bool hides(const NdcBox& box) const;

 private:
  struct Level {
    int32_t width = 0, height = 0;
    std::vector<float> furthest;
  };
  std::vector<Level> levels_;
  int32_t width_ = 0, height_ = 0;
};

}  // namespace throng::draw
