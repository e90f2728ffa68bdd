// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <string>

#include "core/access.h"
#include "core/parallel.h"
#include "crowd/crowd_state.h"
#include "throng/crowd.h"

// Targets: regions that many avatars head to. A flow field costs one Dijkstra search for each
// class.
namespace throng {
namespace {

constexpr size_t kMaxTargets = UINT16_MAX;
constexpr size_t kGoals = 4096;        // places of a target that paths lead to, about
constexpr size_t kTargetGrain = 4096;  // bodies

}  // namespace

Result<TargetId> Crowd::add_target(std::span<const Prism> areas, Context& context) {
  State& s = *state_;
  if (s.config.routing != Routing::kPaths) {
    return Error{Errc::kBadConfig, "crowd: Routing::kStraight supports no targets; give goals"};
  }
  auto made = crowd::Target::make(*data_of(s.world), areas);
  if (!made) return made.error();
  if (s.targets.size() >= kMaxTargets) {
    return Error{Errc::kLimit, "crowd: it has 65535 targets; use those that it has again"};
  }
  s.targets.push_back(std::move(*made));
  for (size_t c = 0; c < s.classes.size(); ++c) {
    if (!s.classes[c]) continue;
    auto ok = s.find_flows(static_cast<int32_t>(c), context);
    if (ok) continue;
    s.targets.pop_back();
    for (const auto& parts : s.classes) {
      if (parts && parts->flows.size() > s.targets.size()) parts->flows.pop_back();
      if (parts && parts->landings.size() > s.targets.size()) parts->landings.pop_back();
    }
    return ok.error();
  }
  return static_cast<TargetId>(s.targets.size());
}

void Crowd::State::make_lives(size_t number) {
  std::vector<path::LiveFinder>& lives = classes[number]->lives;
  if (!lives.empty()) return;
  auto made = path::LiveFinder::create(
      world, {.avatar_class = static_cast<int32_t>(number), .slope_cost = config.slope_cost});
  THRONG_ASSERT(made);  // The class is one of the world's.
  lives.assign(static_cast<size_t>(worker_count(config.workers)), *made);
  std::vector<path::AppliedEdits>& areas = classes[number]->areas;
  areas.assign(lives.size(), path::AppliedEdits(path::AppliedEdits::Which::kAreas));
  for (size_t w = 0; w < lives.size(); ++w) areas[w].follow(edits(), lives[w]);
}

// All avatars on foot search again.
void Crowd::State::areas_changed() {
  if (config.routing != Routing::kPaths) return;
  for (size_t c = 0; c < classes.size(); ++c) {
    if (!classes[c]) continue;
    ClassParts& parts = *classes[c];
    if (!has_costs() && parts.lives.empty()) continue;
    make_lives(c);
    for (size_t w = 0; w < parts.lives.size(); ++w) parts.areas[w].follow(edits(), parts.lives[w]);
  }
  flows_are_old = true;
  for (crowd::Body& body : engine.bodies()) {
    if (body.has(crowd::Body::kHasGoal) && !body.has(crowd::Body::kFlying) && !body.climbs &&
        !body.leaves) {
      body.flags |= crowd::Body::kNeedsPath;
    }
  }
}

Result<void> Crowd::State::find_flows(int32_t number, Context& context) {
  ClassParts& parts = *classes[static_cast<size_t>(number)];
  if (!targets.empty()) make_lives(static_cast<size_t>(number));
  while (parts.flows.size() < targets.size()) {
    const crowd::Target& target = targets[parts.flows.size()];
    const std::vector<Place> goals = crowd::places_inside(*data_of(world), parts.ground,
                                                          target.regions, kGoals, &parts.lives[0]);
    auto flow = path::FlowPoints::make(parts.lives[0], goals, path::FlowPoints::kNever, context);
    if (!flow) return Error{Errc::kCancelled, "crowd: cancelled"};
    parts.flows.push_back(std::move(*flow));
    if (parts.air || parts.nodes) parts.landings.push_back(goals);
  }
  return {};
}

void Crowd::set_targets(std::span<const AvatarId> ids, TargetId target) {
  State& s = *state_;
  THRONG_ASSERT(target >= 1 && target <= s.targets.size());
  for (const AvatarId id : ids) {
    crowd::Body* body = s.body(id);
    if (body == nullptr) continue;
    s.routes[body->slot] = {};
    body->detour_angle = 0;
    body->target = target;
    body->local_target_x = body->x;
    body->local_target_z = body->z;
    if (s.air_of(*body) != nullptr) s.set_goal_of_flyer(*body, {});
    if (body->climbs) s.set_goal_of_climber(*body, {});
    body->flags =
        (body->flags & crowd::Body::kFlying) | crowd::Body::kHasGoal | crowd::Body::kNeedsPath;
  }
}

double Crowd::distance(AvatarId id, TargetId target) const {
  State& s = *state_;
  THRONG_ASSERT(target >= 1 && target <= s.targets.size());
  s.renew_flows();
  const crowd::Body* body = s.body(id);
  if (body == nullptr || body->has(crowd::Body::kFlying)) {
    return std::numeric_limits<double>::infinity();
  }
  ClassParts& parts = *s.classes[body->avatar_class];
  const Place place = crowd::place_of(*data_of(s.world), *body, {body->x, body->z, body->level});
  return parts.flows[target - 1u].distance(parts.lives[0], place);
}

Result<std::vector<Place>> Crowd::places(TargetId target, int32_t avatar_class, size_t max_count,
                                         Context& context) {
  State& s = *state_;
  THRONG_ASSERT(target >= 1 && target <= s.targets.size());
  if (auto ok = s.open_class(avatar_class, context); !ok) return ok.error();
  return crowd::places_inside(*data_of(s.world),
                              s.classes[static_cast<size_t>(avatar_class)]->ground,
                              s.targets[target - 1u].regions, std::max<size_t>(1, max_count));
}

void Crowd::set_speeds(std::span<const AvatarId> ids, std::span<const double> speeds) {
  THRONG_ASSERT(ids.size() == speeds.size());
  State& s = *state_;
  for (size_t i = 0; i < ids.size(); ++i) {
    THRONG_ASSERT(speeds[i] > 0 && speeds[i] <= 100);
    crowd::Body* body = s.body(ids[i]);
    if (body == nullptr) continue;
    body->speed = static_cast<float>(speeds[i]);
    s.make_room(*body);
  }
}

// A path from where the body is to its target or goal. False: there is none.
bool Crowd::State::plan_path(crowd::Body& body, crowd::Route& route,
                             const crowd::StrideGround& ground, int32_t worker) {
  const auto w = static_cast<size_t>(worker);
  const world::WorldData& data = *data_of(world);
  ClassParts& parts = *classes[body.avatar_class];
  Path& path = parts.paths[w];
  const crowd::PathPoint here{body.x, body.z, body.level};
  const Place from = crowd::place_of(data, body, here);
  if (body.target != 0) {
    parts.flows[body.target - 1u].find_path(parts.lives[w], from, path);
    route.goal = here;  // if it stands there already
  } else {
    const Place to = crowd::place_of(data, body, route.goal);
    const bool by_cost = has_costs();
    if (by_cost) parts.lives[w].find(from, to, path, search_budget());
    if (!by_cost) parts.finders[w].find(from, to, path, search_budget());
    SpentBudget spent = path.spent;
    if (!by_cost && obstacles.cuts_paths() && path.end == PathEnd::kReached) {
      crowd::lead_around(data, parts.lives[w], ground, search_budget(), path, parts.repairs[w]);
      if (path.spent != SpentBudget::kNone) spent = path.spent;
    }
    note_spent(spent);
  }
  return crowd::use_path(data, path, ground, body, route);
}

// The flow fields refer to rectangles of the ground as it was.
void Crowd::State::renew_flows() {
  if (!flows_are_old) return;
  flows_are_old = false;
  Context context;
  for (size_t c = 0; c < classes.size(); ++c) {
    if (!classes[c] || classes[c]->flows.empty()) continue;
    classes[c]->flows.clear();
    classes[c]->landings.clear();
    const auto ok = find_flows(static_cast<int32_t>(c), context);
    THRONG_ASSERT(ok);  // It was possible before, and nothing cancels it.
  }
  for (crowd::Body& body : engine.bodies()) {
    if (body.target != 0 && body.has(crowd::Body::kHasGoal) && !body.leaves)
      body.flags |= crowd::Body::kNeedsPath;
  }
}

void Crowd::State::arrive_in_targets() {
  if (targets.empty()) return;
  parallel_ranges(engine.bodies().size(), kTargetGrain, config.workers,
                  [&](size_t begin, size_t end) {
                    for (crowd::Body& body : engine.bodies().subspan(begin, end - begin)) {
                      if (body.target == 0 || !body.has(crowd::Body::kHasGoal) ||
                          body.has(crowd::Body::kArrived) ||
                          !targets[body.target - 1u].contains(at_feet(body))) {
                        continue;
                      }
                      body.flags |= crowd::Body::kArrived;
                      const std::lock_guard lock(goal_mutex);
                      arrived.push_back(id_of(body.slot));
                    }
                  });
}

}  // namespace throng
