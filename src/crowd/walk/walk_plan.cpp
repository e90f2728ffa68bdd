// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "crowd/walk/walk_mode.h"

// How avatars on foot find and follow their paths. A target has a flow field for each class: one
// Dijkstra search outwards from it.
namespace throng::crowd {
namespace {

constexpr size_t kGoals = 4096;  // places of a target that paths lead to, about

}  // namespace

// Follows paths, and finds those that are missing.
void WalkMode::plan(std::span<Body> bodies, int32_t worker) {
  const uint64_t step_now = shared_.sub_step - 1;
  uint64_t asked = 0;
  if (delays_) watch_routes(bodies, worker);
  for (Body& body : bodies) {
    if (body.has(Body::kMovedElsewhere) || body.steps == 0) continue;
    const OfClass& parts = *classes_[body.avatar_class];
    if (body.leaves) {
      plan_exit(body);
      continue;
    }
    if (parts.flies && (body.has(Body::kHasGoal) || body.has(Body::kExternal)) &&
        takes_off_->plan_on_foot(body)) {
      body.clear(Body::kContinues);
      continue;
    }
    if (!body.has(Body::kHasGoal) || body.has(Body::kContinues) ||
        shared_.config.routing == Routing::kStraight)
      continue;
    Route& route = routes_[body.slot];
    const StrideGround ground = stride_ground(body);
    const uint64_t nth = (step_now + shared_.name_of(body)) / engine_.steps_of_reaction(body);
    const bool takes_links = links_are_used_ && parts.takes_links;
    if (!body.has(Body::kNeedsPath)) {
      if (takes_links && takes_links_->plan_at_start(body, route, ground, nth)) continue;
      if (!body.has(Body::kNeedsPath)) follow_path(body, route, ground, nth);
    }
    // The link was switched off while it could not search.
    if (!takes_links && leads_to_link(route)) body.flags |= Body::kNeedsPath;
    if (!body.has(Body::kNeedsPath)) continue;
    if (takes_links) takes_links_->begin_search(body);
    ++asked;
    const bool is_found = plan_path(body, route, ground, worker);
    if (takes_links) takes_links_->end_search(body, is_found ? &route : nullptr);
    if (is_found) {
      // One that searches in each step comes to a link, too.
      if (takes_links) takes_links_->plan_at_start(body, route, ground, nth);
      continue;
    }
    // A target that cannot be walked to may be flown to.
    const bool takes_off = parts.flies && body.target != 0 && takes_off_->take_off(body);
    if (!takes_off) shared_.drop_goal(body);
  }
  if (asked > 0) shared_.note_planned(asked);
}

// Its next corner may become its local target: then less of the path comes after that.
void WalkMode::follow_path(Body& body, Route& route, const StrideGround& ground, uint64_t nth) {
  const size_t corner = route.next;
  follow(body, route, ground, nth, following());
  if (route.next == corner) return;
  const PathPoint &from = route.corners[corner], &to = route.corners[route.next];
  const float square = near_square(to.x - from.x, to.z - from.z);
  const auto passed = std::sqrt(square) * static_cast<float>(shared_.unit);
  engine_.set_path_after(body.slot, std::max(engine_.path_after(body.slot) - passed, 0.0f));
  note_onward(body, route);
}

// A path from where the body is to its target or goal. False: there is none.
bool WalkMode::plan_path(Body& body, Route& route, const StrideGround& ground, int32_t worker) {
  const auto w = static_cast<size_t>(worker);
  const world::WorldData& data = *data_of(shared_.world);
  OfClass& parts = *classes_[body.avatar_class];
  Path& path = parts.paths[w];
  const PathPoint here{body.x, body.z, body.level};
  if (plan_aside(body, route, ground, w)) return true;
  if (route.via != 0 && plan_to_via(body, route, ground, w)) return true;
  progress_[body.slot].is_new = 1;
  if (body.target != 0) {
    parts.flows[body.target - 1u].find_path(parts.lives[w], place_of(data, here), path);
    route.goal = here;  // if it stands there already
  } else {
    find_path(body, here, route.goal, ground, w, path);
  }
  return take_whole_path(body, route, ground, path);
}

bool WalkMode::take_whole_path(Body& body, Route& route, const StrideGround& ground,
                               const Path& path) {
  if (!use_path(*data_of(shared_.world), path, ground, following(), body, route)) return false;
  double first = 0;  // [m]
  if (path.points.size() > 1) {
    first = std::hypot(path.points[1].position.x - path.points[0].position.x,
                       path.points[1].position.z - path.points[0].position.z);
  }
  engine_.set_path_after(body.slot, static_cast<float>(std::max(path.length - first, 0.0)));
  note_onward(body, route);
  return true;
}

// Where its path leads some metres beyond its local target: corners around one wall are near each
// other, and do not yet show that.
void WalkMode::note_onward(const Body& body, const Route& route) {
  constexpr float kFar = 2;  // [m]
  const auto metre = static_cast<float>(shared_.unit);
  const PathPoint& from = route.corners[route.next];
  steer::Plane onward;
  for (size_t i = route.next + 1u; i < route.count && steer::size_of(onward) < kFar; ++i) {
    const PathPoint& to = route.corners[i];
    onward = {static_cast<float>(to.x - from.x) * metre, static_cast<float>(to.z - from.z) * metre};
  }
  engine_.set_onward(body.slot, onward);
}

// A path of low cost over the ground of the body's class, around its obstacles.
void WalkMode::find_path(const Body& body, const PathPoint& from, const PathPoint& to,
                         const StrideGround& ground, size_t worker, Path& path) {
  const world::WorldData& data = *data_of(shared_.world);
  OfClass& parts = *classes_[body.avatar_class];
  const Place start = place_of(data, from), goal = place_of(data, to);
  const SearchBudget budget = shared_.search_budget();
  const bool by_cost = plans_by_cost(parts);
  if (by_cost) parts.lives[worker].find(start, goal, path, budget);
  if (!by_cost) parts.finders[worker].find(start, goal, path, budget);
  SpentBudget spent = path.spent;
  if (!by_cost && shared_.obstacles.cuts_paths() && path.end == PathEnd::kReached) {
    lead_around(data, parts.lives[worker], ground, budget, path, parts.repairs[worker]);
    if (path.spent != SpentBudget::kNone) spent = path.spent;
  }
  shared_.note_spent(spent);
}

void WalkMode::make_lives(size_t number) {
  std::vector<path::GroundFinder>& lives = classes_[number]->lives;
  if (!lives.empty()) return;
  auto made = path::GroundFinder::create(
      shared_.world, {.avatar_class = static_cast<int32_t>(shared_.baked_class(number)),
                      .slope_cost = shared_.config.slope_cost});
  THRONG_ASSERT(made);  // The class is one of the world's.
  made->set_density(shared_.density_of(number));
  lives.assign(static_cast<size_t>(worker_count(shared_.config.workers)), *made);
  std::vector<path::AppliedEdits>& areas = classes_[number]->areas;
  // An off-mesh link may lead over ground of weight 0.
  const bool takes_links = classes_[number]->takes_links && !classes_[number]->follows_density;
  const auto which =
      takes_links ? path::AppliedEdits::Which::kAreasAndLinks : path::AppliedEdits::Which::kAreas;
  areas.assign(lives.size(), path::AppliedEdits(which));
  for (size_t w = 0; w < lives.size(); ++w) areas[w].follow(shared_.edits(), lives[w]);
}

Result<void> WalkMode::find_flows(size_t number, Context& context) {
  OfClass& parts = *classes_[number];
  if (!shared_.targets.empty()) make_lives(number);
  SharedClass& shared = *shared_.classes[number];
  while (parts.flows.size() < shared_.targets.size()) {
    const Target& target = shared_.targets[parts.flows.size()];
    const std::vector<Place> goals = places_inside(*data_of(shared_.world), shared.ground,
                                                   target.regions, kGoals, &parts.lives[0]);
    auto flow = path::FlowPoints::create(parts.lives[0], goals, path::FlowPoints::kNever, context);
    if (!flow) return Error{Errc::kCancelled, "crowd: cancelled"};
    parts.flows.push_back(std::move(*flow));
    if (parts.flies || shared_.climbs(number)) shared.landings.push_back(goals);
  }
  return {};
}

// The flow fields refer to rectangles of the ground as it was.
bool WalkMode::renew_flows() {
  if (!flows_are_old_) return false;
  flows_are_old_ = false;
  Context context;
  for (size_t c = 0; c < classes_.size(); ++c) {
    if (!classes_[c] || classes_[c]->flows.empty()) continue;
    classes_[c]->flows.clear();
    shared_.classes[c]->landings.clear();
    const auto ok = find_flows(c, context);
    THRONG_ASSERT(ok);  // It was possible before, and nothing cancels it.
  }
  return true;
}

void WalkMode::drop_flows() {
  const size_t count = shared_.targets.size();
  for (size_t c = 0; c < classes_.size(); ++c) {
    if (!classes_[c]) continue;
    std::vector<std::vector<Place>>& landings = shared_.classes[c]->landings;
    if (classes_[c]->flows.size() > count) classes_[c]->flows.pop_back();
    if (landings.size() > count) landings.pop_back();
  }
}

double WalkMode::distance(const Body& body, TargetId target) {
  OfClass& parts = *classes_[body.avatar_class];
  const Place place = place_of(*data_of(shared_.world), {body.x, body.z, body.level});
  return parts.flows[target - 1u].distance(parts.lives[0], place);
}

}  // namespace throng::crowd
