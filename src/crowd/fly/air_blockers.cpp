// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/fly/air_blockers.h"

// Which bodies in the air are where an obstacle waits to appear or to move. Of one that moves, the
// volume that it passes is the convex hull of both places. Linear in the obstacles that wait near a
// body.
namespace throng::crowd {

AirBlockers::AirBlockers(const SharedState& shared, std::span<const uint32_t> slots)
    : passed_(shared.unit) {
  for (const uint32_t slot : slots) {
    const CrowdObstacle& obstacle = shared.obstacles.all()[slot];
    if (!obstacle.waits()) continue;
    const Prism& prism =
        obstacle.is_up ? hull_of(obstacle.place, obstacle.wanted) : obstacle.wanted;
    passed_.set(slot, AirObstacle(prism, shared.origin(), shared.unit), {});
  }
}

void AirBlockers::add(const Body& body, uint32_t index, double radius, BlockerPairs& found) {
  passed_.list_near(feet_of(body), radius, near_);
  for (const ObstacleGrid::Item* obstacle : near_) {
    if (obstacle->shape.holds(feet_of(body), radius, body.height)) {
      found.emplace_back(obstacle->slot, index);
    }
  }
}

}  // namespace throng::crowd
