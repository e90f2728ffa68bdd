// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <array>

#include "crowd/climb/climb_mode.h"
#include "crowd/climb/climb_path.h"

// Climbers that are in an obstacle when it closes leave it: along their paths, beside it on their
// node, or by the shortest exit over nodes. Which moves are allowed, ClimberEngine::is_blocked
// decides. docs/design/008-engine.md, "Obstacles".
namespace throng::crowd {
namespace {

constexpr double kNoSpacing = 1e9;        // [m] points of a path only at its corners
constexpr uint64_t kMaxExitNodes = 8000;  // crossings that a search for an exit may expand
constexpr uint64_t kExitInterval = 4;     // steps of one that finds no exit
constexpr std::array<double, 4> kSearchRadii = {1, 2, 4, 8};  // [m] to a node's free place

}  // namespace

bool ClimbMode::leads_out(const Body& /*body*/, std::span<const uint32_t> /*slots*/) const {
  return true;  // plan_exit looks again before each step.
}

void ClimbMode::end_leaving(Body& body) {
  if (body.has(Body::kExternal)) return;
  Climb& climb = climbs_[body.slot];
  const bool rests = !body.has(Body::kHasGoal) || body.has(Body::kArrived);
  if (!rests || !climb.is_on_ground()) return;
  climb.count = 0;
  climb.at.next = 0;
  climb.whole = body.has(Body::kArrived) ? 1 : 0;
}

bool ClimbMode::plan_exit(Body& body, Climb& climb, int32_t worker) {
  if (!climb.is_on_ground()) return false;
  const bool rests = !body.has(Body::kHasGoal) || body.has(Body::kArrived);
  const bool goes = climb.count > 0 && climb.at.next < climb.count;
  if (!rests && goes && !body.has(Body::kNeedsPath)) return false;  // on along its path
  if (rests && goes && climb.whole == 0) return true;               // on its exit
  if ((shared_.sub_step + body.slot) % kExitInterval != 0) return true;
  for (const double search_radius : kSearchRadii) {
    if (step_aside(body, climb, worker, search_radius)) return true;
  }
  find_exit_over_nodes(body, climb, worker);
  return true;
}

// To the nearest place that is left, by a finder that does not mind what closes around it.
void ClimbMode::find_exit_over_nodes(Body& body, Climb& climb, int32_t worker) {
  OfClass& parts = of(body);
  const auto w = static_cast<size_t>(worker);
  path::NodeFinder& finder = parts.finders[w];
  NodePlace to;
  for (size_t i = 0; i < kSearchRadii.size() && !to; ++i) {
    to = finder.find_place(climb.feet, kSearchRadii[i]);
  }
  const NodePlace from = place_of(body, climb);
  if (!to || !from) return;
  const auto let_through = [&](bool lets) {
    for (const uint32_t slot : shared_.obstacles.waiting()) {  // One that closes waits.
      const CrowdObstacle& obstacle = shared_.obstacles.all()[slot];
      if (!obstacle.closes()) continue;
      if (meets(body, obstacle.place))
        finder.set_active(obstacle.of_class[body.avatar_class].node_change, !lets);
    }
  };
  Path& path = parts.paths[w];
  let_through(true);
  finder.find(from, to, path, kNoSpacing, kMaxExitNodes);
  let_through(false);
  if (path.end != PathEnd::kReached || path.points.size() < 2) return;
  take_path(climb, path);
  climb.whole = 0;
  body.clear(Body::kNeedsPath);
}

}  // namespace throng::crowd
