// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "throng/base.h"
#include "throng/scene.h"

/// Points on the surfaces of a scene, uniform by area.
namespace throng::verify {

class SurfaceSampler {
 public:
  /// Takes the triangles, wherever they face, that are not blocked and not steeper than the slope
  /// with this cosine. Triangles that coincide count each.
  SurfaceSampler(const Scene& scene, double levelness);

  struct Point {
    Vec3d position;
    uint32_t triangle = 0;
  };

  [[nodiscard]] double area() const { return up_to_.empty() ? 0 : up_to_.back(); }  ///< [m^2]
  /// The n-th point of the stream `seed`. There must be some area.
  [[nodiscard]] Point point(uint64_t seed, uint64_t n) const;

 private:
  const Scene* scene_;
  std::vector<uint32_t> triangles_;
  std::vector<double> up_to_;  ///< Area of triangles_[0] to triangles_[i] together. [m^2]
};

}  // namespace throng::verify
