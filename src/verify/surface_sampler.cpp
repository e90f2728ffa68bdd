// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/surface_sampler.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "verify/cylinder.h"

// Draws points uniform by area: a binary search over sums of the triangles' areas.
namespace throng::verify {

SurfaceSampler::SurfaceSampler(const Scene& scene, double levelness_limit) : scene_(&scene) {
  double sum = 0;
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (scene.area[t] == kAreaBlocked) continue;
    const auto& [a, b, c] = scene.triangles[t];
    const Corners corners{scene.positions[a], scene.positions[b], scene.positions[c]};
    if (!(levelness(corners) >= levelness_limit)) continue;
    sum += length(cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
    triangles_.push_back(t);
    up_to_.push_back(sum);
  }
}

SurfaceSampler::Point SurfaceSampler::point(uint64_t seed, uint64_t n) const {
  const double target = random_unit(seed, n, 0) * area();
  const auto found = std::upper_bound(up_to_.begin(), up_to_.end(), target);
  const auto index = std::min(static_cast<size_t>(found - up_to_.begin()), triangles_.size() - 1);
  const auto& [a, b, c] = scene_->triangles[triangles_[index]];
  const Vec3d p = scene_->positions[a];
  // The square root folds the unit square onto a triangle without crowding a corner.
  const double s = std::sqrt(random_unit(seed, n, 1));
  const double t = random_unit(seed, n, 2);
  return {p + (scene_->positions[b] - p) * (s * (1 - t)) + (scene_->positions[c] - p) * (s * t),
          triangles_[index]};
}

}  // namespace throng::verify
