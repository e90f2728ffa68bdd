// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scenario/simulation_state.h"

// Avatars whose goal is unreachable while obstacles are up: people walk up to a shut door and wait
// before it, and go on when it opens. Time of one: a path, and its length x the obstacles.
namespace throng {
namespace {

constexpr double kSample = 0.1;        // [m] between points of a path that are tested
constexpr size_t kKept = 3;            // of them: so many before an obstacle one stops
constexpr double kFloor = 1;           // [m] Vertical tolerance between a path and the floor.
constexpr uint64_t kRetryPeriod = 5;   // [reviews]
constexpr size_t kMaxCompared = 64;    // places of an area, about
constexpr size_t kMaxProlonged = 200;  // places of a line beyond its end

}  // namespace

bool Simulation::State::is_covered(const Vec3d& feet, const AvatarClass& body) const {
  return std::any_of(solids.begin(), solids.end(), [&](const Prism& solid) {
    return solid.low < feet.y + body.height && solid.high > feet.y + Prism::kFeetTolerance &&
           distance_to(solid, feet.x, feet.z) <= body.radius;
  });
}

// Of the obstacles that are up: their prisms, and the places in lines that they cover.
void Simulation::State::note_solids() {
  solids = crowd.obstacles();
  for (size_t q = 0; q < lines.size(); ++q) {
    const Queue& queue = scenario.queues[q];
    std::vector<size_t>& covered = lines[q].covered;
    covered.clear();
    if (solids.empty()) continue;
    double length = 0;
    for (size_t i = 0; i + 1 < queue.line.size(); ++i)
      length += plan_distance(queue.line[i], queue.line[i + 1]);
    const auto count = static_cast<size_t>(length / queue.spacing) + kMaxProlonged;
    AvatarClass widest = kinds[0];
    for (const AvatarClass& kind : kinds) widest.radius = std::max(widest.radius, kind.radius);
    for (size_t n = 0; n < count; ++n) {
      if (is_covered(place_along(queue, n), widest)) covered.push_back(n);
    }
  }
}

// May it find a path by now? All may when an obstacle has gone; those that do not wait before one
// try in turn.
bool Simulation::State::retries(const ScenarioAvatar& p) const {
  if (p.doing != Doing::kGoalUnreachable) return false;
  const auto review = static_cast<uint64_t>(time() + 0.5);
  return has_opened || (!p.waits_before && is_review && (review + p.number) % kRetryPeriod == 0);
}

// Where the avatar's stage leads: its own goal, or about the nearest place of its areas.
Place Simulation::State::goal_of(const ScenarioAvatar& p, const Vec3d& from) const {
  if (p.journey < 0) return {};
  const Stage& stage = stage_of(p);
  if (stage.kind == Stage::Kind::kQueue || stage.kind == Stage::Kind::kRandomPoint) return p.goal;
  Place nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const int32_t area : stage.areas) {
    const auto found = places.find({area_target[static_cast<size_t>(area)], crowd_class_of(p)});
    if (found == places.end()) continue;
    const size_t stride = 1 + found->second.size() / kMaxCompared;
    for (size_t i = 0; i < found->second.size(); i += stride) {
      const double d = plan_distance(found->second[i].position, from);
      if (d >= least) continue;
      least = d;
      nearest = found->second[i];
    }
  }
  return nearest;
}

// The last place before an obstacle on the path that would lead to a goal without obstacles.
Place Simulation::State::place_before_obstacle(const ScenarioAvatar& p) {
  const int32_t avatar_class = class_of(p);
  const AvatarClass& body = kinds[static_cast<size_t>(avatar_class)];
  const auto state = crowd.read(p.id);
  if (!state || solids.empty() || body.flies || goes_over_nodes(body)) return {};
  const Place here = world.find_place(avatar_class, state->position, kFloor);
  const Place goal = goal_of(p, state->position);
  if (!here || !goal) return {};
  auto finder = without_obstacles.find(avatar_class);
  if (finder == without_obstacles.end()) {
    Context context;
    auto made = PathFinder::create(
        world, {.avatar_class = avatar_class, .speedup = PathSpeedup::kOnDemand}, context);
    if (!made) return {};
    finder = without_obstacles.emplace(avatar_class, std::move(*made)).first;
  }
  Path path;
  finder->second.find(here, goal, path, {UINT64_MAX, nullptr, scenario.search_bytes});
  if (path.end != PathEnd::kReached) return {};
  std::array<Vec3d, kKept> passed{};  // the last points, in turn
  size_t count_passed = 0;
  for (size_t i = 1; i < path.points.size(); ++i) {
    const Vec3d a = path.points[i - 1].position, b = path.points[i].position;
    const double length = plan_distance(a, b);
    const auto count = static_cast<size_t>(std::ceil(length / kSample));
    for (size_t k = 0; k < count; ++k) {
      const Vec3d at = a + (b - a) * (static_cast<double>(k) / static_cast<double>(count));
      if (is_covered(at, body)) {
        if (count_passed < kKept) return here;
        return world.find_place(avatar_class, passed[count_passed % kKept], kFloor);
      }
      passed[count_passed++ % kKept] = at;
    }
  }
  return {};
}

// Of avatars whose stage has areas or places of its own; move_lines does it for the others.
void Simulation::State::retry_goals() {
  if (!has_opened && !is_review) return;
  for (ScenarioAvatar& p : avatars) {
    if (!p.id || !retries(p)) continue;
    if (p.journey < 0) {
      begin_stage(p);
      continue;
    }
    if (stage_of(p).kind == Stage::Kind::kQueue) continue;
    const std::vector<TargetId>& targets = targets_of(p);
    // It stays where it waits, rather than to try in vain.
    const bool tries =
        targets.empty() || std::any_of(targets.begin(), targets.end(), [&](TargetId target) {
          return std::isfinite(crowd.distance(p.id, target));
        });
    if (tries) begin_stage(p);
  }
}

// Called when no path leads to its goal. It waits before what blocks its path, else where
// it is.
void Simulation::State::walk_up(ScenarioAvatar& p) {
  p.doing = Doing::kGoalUnreachable;
  const Place place = place_before_obstacle(p);
  p.waits_before = static_cast<bool>(place);
  if (place) crowd.set_goals({&p.id, 1}, {&place, 1});
}

}  // namespace throng
