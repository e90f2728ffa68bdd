// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/ground_pick.h"

#include <algorithm>
#include <cmath>

// What is under the pointer. Ground: samples of the sight line, a place query each; avatars: one
// distance of lines each.
namespace throng::view {

std::optional<Vec3d> ground_on(const World& world, const SightLine& line, double cut,
                               double farthest) {
  const WorldSummary summary = world.summary();
  const int32_t classes = static_cast<int32_t>(summary.classes.size());
  constexpr double kStep = 0.25;
  for (double along = 0; along < farthest; along += kStep) {
    const Vec3d p = line.eye + line.direction * along;
    if (p.y > cut || p.y > summary.bounds.max.y + 1) continue;
    if (p.y < summary.bounds.min.y - 1 && line.direction.y <= 0) break;
    for (int32_t c = 0; c < classes; ++c) {
      const Place place = world.find_place(c, p, 0.6 * kStep + 0.05);
      if (place) return place.position;
    }
  }
  return std::nullopt;
}

size_t avatar_on(const TimelineFrame& crowd, const std::vector<double>& class_heights,
                 const SightLine& line, double cut, double farthest) {
  constexpr double kPickRadius = 0.35;  // [m]
  size_t best = crowd.size();
  double nearest = farthest;
  const double flat = std::hypot(line.direction.x, line.direction.z);
  for (size_t i = 0; i < crowd.size(); ++i) {
    if (crowd.y[i] > cut) continue;
    const size_t c = std::min<size_t>(crowd.classes[i], class_heights.size() - 1);
    const double height = class_heights.empty() ? 1.75 : class_heights[c];
    const Vec3d feet{crowd.x[i], crowd.y[i], crowd.z[i]};
    const Vec3d to = feet + Vec3d{0, 0.5 * height, 0} - line.eye;
    // The point of the line nearest to the body's axis, seen from above; of a vertical line, the
    // point at the height of the body's middle.
    double along = dot(to, line.direction);
    if (flat > 0.05) along = (to.x * line.direction.x + to.z * line.direction.z) / (flat * flat);
    if (along < 0 || along >= nearest) continue;
    const Vec3d p = line.eye + line.direction * along - feet;
    const double lean =
        flat > 0.05 ? std::abs(line.direction.y) / flat * kPickRadius : 0.5 * height;
    if (p.y < -lean || p.y > height + lean) continue;
    if (std::hypot(p.x, p.z) > kPickRadius) continue;
    nearest = along;
    best = i;
  }
  return best;
}

}  // namespace throng::view
