// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>
#include <vector>

#include "crowd/crowd_state.h"
#include "throng/crowd.h"

// Avatars that are in an obstacle when it closes leave it: which ones begin to, and which are out.
// How they get out, their modes decide. docs/design/008-engine.md, "Obstacles".
namespace throng {

bool Crowd::State::is_occupied(uint32_t slot,
                               std::span<const std::pair<uint32_t, uint32_t>> found) const {
  const Prism& prism = shared.obstacles.all()[slot].wanted;
  const crowd::ObstacleGrid::Item wanted{
      crowd::AirObstacle(prism, shared.origin(), shared.unit), {prism, {}}, slot};
  return std::any_of(found.begin(), found.end(), [&](const auto& pair) {
    const crowd::Body& body = walk.bodies()[pair.second];
    return mode_of(body).is_inside(body, wanted);
  });
}

void Crowd::State::mark_leaving(std::span<const std::pair<uint32_t, uint32_t>> found, bool all) {
  const std::span<crowd::Body> bodies = walk.bodies();
  std::vector<std::pair<uint32_t, uint32_t>> by_body;  // index, obstacle
  add_on_zero(by_body);
  for (const auto& pair : found) {
    const crowd::Body& body = bodies[pair.second];
    if (mode_of(body).must_leave(body, shared.obstacles.all()[pair.first].wanted)) {
      by_body.emplace_back(pair.second, pair.first);
    }
  }
  std::sort(by_body.begin(), by_body.end());
  if (all && shared.some_leave) {
    for (uint32_t i = 0; i < bodies.size(); ++i) {
      crowd::Body& body = bodies[i];
      if (!body.leaves) continue;
      const auto at = std::lower_bound(by_body.begin(), by_body.end(), std::pair(i, uint32_t{0}));
      if (at == by_body.end() || at->first != i) {
        body.leaves = false;
        mode_of(body).end_leaving(body);
      }
    }
  }
  shared.some_leave = !by_body.empty() || (!all && shared.some_leave);
  std::vector<uint32_t> slots;
  for (size_t n = 0; n < by_body.size();) {
    crowd::Body& body = bodies[by_body[n].first];
    slots.clear();
    for (const uint32_t i = by_body[n].first; n < by_body.size() && by_body[n].first == i; ++n) {
      slots.push_back(by_body[n].second);
    }
    if (body.leaves) continue;
    body.leaves = true;
    body.clear(crowd::Body::kContinues);
    body.detour_angle = 0;
    constexpr uint8_t kAll = crowd::Body::kHasGoal | crowd::Body::kExternal |
                             crowd::Body::kArrived | crowd::Body::kNeedsPath;
    const bool has_path = (body.flags & kAll) == crowd::Body::kHasGoal;
    // From weight 0 by the shortest exit, whatever its path.
    const bool is_on_zero = slots.back() == crowd::LeftCells::kZeroWeight;
    if (has_path && (is_on_zero || !mode_of(body).leads_out(body, slots))) {
      body.flags |= crowd::Body::kNeedsPath;
    }
  }
}

}  // namespace throng
