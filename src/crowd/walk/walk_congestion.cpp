// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "crowd/walk/walk_mode.h"
#include "world/tile_grid.h"

// Avatars on foot take another route where ground takes long now: docs/design/017-congestion.md.
// Once in a second each body compares how much shorter its path became with its desired speed. One
// that does not get on measures its path by the delays of the ground and searches for a cheaper
// one, a bounded part ahead. Time of a step: linear in the bodies, and in the searches, of which
// there are few in a second.
namespace throng::crowd {
namespace {

constexpr float kNearGoal = 1.5f;     // [m] of its path where others may stand on its goal
constexpr int kHeldUp = 25;           // [PathProgress::share] below this it searches: 0.2
constexpr float kAhead = 1;           // [m] ahead of such a body ground is as slow
constexpr double kJam = 3;            // factor of a delay at a corner that a new path is tested by
constexpr float kReach = 50;          // [m] of its path that it compares
constexpr float kGoalReach = 100;     // [m] of its path, up to which it searches to its goal
constexpr float kSlowRoute = 1.5f;    // delayed by length, from which on it searches
constexpr float kClearlyLess = 0.8f;  // of the cost, at which it takes another route
constexpr uint64_t kMaxNodes = 2000;  // of a search

PathPoint place_of_body(const Body& body) { return {body.x, body.z, body.level}; }

float distance_of(const PathPoint& a, const PathPoint& b) {  // [units]
  return std::sqrt(near_square(b.x - a.x, b.z - a.z));
}

}  // namespace

// Before a step: what was noted, and finders for those that want to search.
void WalkMode::begin_watching() {
  if (shared_.time % SharedState::kTimeUnits != 0) return;
  const size_t bodies = shared_.share ? shared_.names.alive() : engine_.bodies().size();
  delays_->begin_step(shared_.step, bodies, shared_.config.workers, shared_.share.get());
  if (!delays_->is_asked()) return;
  for (size_t c = 0; c < classes_.size(); ++c) {
    if (classes_[c] && classes_[c]->takes_links) make_lives(c);
  }
}

void WalkMode::watch_routes(std::span<Body> bodies, int32_t worker) {
  if (shared_.time % SharedState::kTimeUnits != 0) return;  // once in a step
  const auto step = static_cast<uint32_t>(shared_.step);
  for (Body& body : bodies) {
    if (delays_->is_turn_of(shared_.name_of(body), step))
      watch_route(body, static_cast<size_t>(worker));
  }
}

// Not one that waits for a link, where its turn comes, or gives room at one.
bool WalkMode::may_change_route(const Body& body, const Route& route) const {
  return body.has(Body::kHasGoal) && !body.leaves &&
         (body.flags &
          (Body::kArrived | Body::kExternal | Body::kNeedsPath | Body::kMovedElsewhere)) == 0 &&
         classes_[body.avatar_class]->takes_links && route.next < route.count &&
         !leads_to_link(route) && !takes_links_->uses_link(body);
}

// [m]
float WalkMode::path_left(const Body& body) const {
  const int32_t dx = body.local_target_x - body.x, dz = body.local_target_z - body.z;
  return engine_.path_after(body.slot) +
         std::sqrt(near_square(dx, dz)) * static_cast<float>(shared_.unit);
}

void WalkMode::watch_route(Body& body, size_t worker) {
  PathProgress& row = progress_[body.slot];
  const Route& route = routes_[body.slot];
  if (!may_change_route(body, route)) {
    row.left = -1;
    row.share = PathProgress::kWhole;
    return;
  }
  const int32_t dx = body.local_target_x - body.x, dz = body.local_target_z - body.z;
  const float left = path_left(body);
  if (row.left < 0 || left < kNearGoal) {
    row.left = left;
    row.share = PathProgress::kWhole;
    return;
  }
  const int share = row.add_sample(left, body.speed, delays_->seconds_between());
  delays_->note(body.level, body.point(), dx, dz, share);
  if (row.share < kHeldUp) note_ahead(body, dx, dz, share);
  if (row.wait > 0) --row.wait;
  if (row.wait > 0) return;
  const bool wants = row.share < kHeldUp || (row.is_new != 0 && leads_into_jam(body, route));
  row.is_new = 0;
  if (wants && delays_->ask(shared_.config.seed, shared_.name_of(body), shared_.step))
    avoid_jam(body, worker);
}

// Jams are before doors and bends: does one of its next corners lie in one?
bool WalkMode::leads_into_jam(const Body& body, const Route& route) const {
  PathPoint from = place_of_body(body);
  for (size_t i = route.next; i < route.count; ++i) {
    const PathPoint& to = route.corners[i];
    const world::GroundPoint at{to.x, to.z};
    const auto heading = path::GroundDelays::heading({from.x, from.z}, at);
    const double factor = delays_->delays().factor(to.level, world::in_tile(at.cell_x()),
                                                   world::in_tile(at.cell_z()), heading);
    if (factor >= kJam) return true;
    from = to;
  }
  return false;
}

// What lies ahead up to a corner. A segment that is no legal move, because it was pushed aside,
// counts by its length.
WalkMode::RouteCost WalkMode::measure_route(const Body& body, const Route& route,
                                            path::GroundFinder& live) const {
  const world::WorldData& data = *data_of(shared_.world);
  const auto metre = static_cast<float>(shared_.unit);
  const size_t last = route.count - (route.by_link != 0 ? 2u : 1u);
  PathPoint from = place_of_body(body);
  RouteCost found;
  for (found.end = route.next;; ++found.end) {
    PathPoint to = route.corners[found.end];
    if (found.end == route.next) {
      to.x = body.local_target_x;
      to.z = body.local_target_z;
    }
    const float length = distance_of(from, to) * metre;
    const auto cost = static_cast<float>(
        live.delayed_length(place_of(data, from), place_of(data, to), delays_->delays()));
    found.length += length;
    found.cost += std::isfinite(cost) ? cost : length;
    if (found.end >= last || found.length >= kReach) return found;
    from = to;
  }
}

// What holds a body up is ahead of it, where no body stands that could note it.
void WalkMode::note_ahead(const Body& body, int32_t dx, int32_t dz, int share) {
  const float size = std::sqrt(near_square(dx, dz));
  if (!(size > 0)) return;
  const float ahead = kAhead / static_cast<float>(shared_.unit) / size;
  const world::GroundPoint here = body.point();
  const world::GroundPoint at{here.x + std::lrint(static_cast<float>(dx) * ahead),
                              here.z + std::lrint(static_cast<float>(dz) * ahead)};
  const auto is_same_tile = [](int32_t cell, int32_t other) {
    return world::tile_along(cell) == world::tile_along(other);
  };
  if (is_same_tile(here.cell_x(), at.cell_x()) && is_same_tile(here.cell_z(), at.cell_z())) {
    delays_->note(body.level, at, dx, dz, share);
  }
}

// Does a path lead through the same doors as the route does up to a corner? Before these it may
// lead around those that queue.
bool WalkMode::is_same_route(const Body& body, const Route& route, size_t end, bool to_goal,
                             const Path& path, path::GroundFinder& live) const {
  const world::WorldData& data = *data_of(shared_.world);
  std::array<Place, Route::kCorners + 1> own;
  size_t count = 0;
  own[count++] = place_of(data, place_of_body(body));
  for (size_t i = route.next; i <= end; ++i) {
    PathPoint at = route.corners[i];
    if (i == route.next) {
      at.x = body.local_target_x;
      at.z = body.local_target_z;
    }
    own[count++] = place_of(data, at);
  }
  const bool whole = !to_goal || (route.whole && end + 1 == route.count);
  return live.is_same_side({own.data(), count}, path.points, whole);
}

// Takes another route to its goal, or up to a corner ahead, if that is clearly faster now.
void WalkMode::avoid_jam(Body& body, size_t worker) {
  OfClass& parts = *classes_[body.avatar_class];
  PathProgress& row = progress_[body.slot];
  row.wait = PathProgress::kMinWait;
  if (parts.lives.empty()) return;
  path::GroundFinder& live = parts.lives[worker];
  Route& route = routes_[body.slot];
  const RouteCost now = measure_route(body, route, live);
  if (now.cost < kSlowRoute * now.length) return;
  shared_.jam_searches.fetch_add(1, std::memory_order_relaxed);
  const world::WorldData& data = *data_of(shared_.world);
  Path& path = parts.paths[worker];
  // The last corner that it keeps may lie in the jam, and a detour to its goal pass it by.
  const float left = path_left(body);
  const bool to_goal = left <= kGoalReach && body.target == 0;
  const float cost = now.cost + (to_goal ? std::max(left - now.length, 0.0f) : 0);
  const PathPoint& end = to_goal ? route.goal : route.corners[now.end];
  const bool is_found =
      live.find_by_delays(place_of(data, place_of_body(body)), place_of(data, end),
                          {.delays = &delays_->delays(),
                           .max_cost = kClearlyLess * double{cost},
                           .budget = shared_.search_budget(kMaxNodes)},
                          path);
  shared_.note_spent(path.spent);
  if (!is_found || path.points.size() < 2 ||
      is_same_route(body, route, now.end, to_goal, path, live)) {
    // The longer there was none, the less often it searches.
    row.wait = row.next_wait;
    row.next_wait = static_cast<uint8_t>(std::min<int>(2 * row.next_wait, PathProgress::kMaxWait));
    return;
  }
  shared_.changed_route.fetch_add(1, std::memory_order_relaxed);
  const StrideGround ground = stride_ground(body);
  const size_t via = find_via(body, ground, worker, path);
  if (to_goal) {
    take_whole_path(body, route, ground, path);
  } else {
    take_path(body, route, ground, path, now.end);
  }
  route.via = std::min<size_t>(via, route.count - 1u) & 0x7f;
  body.clear(Body::kContinues);
  body.detour_angle = 0;
  row = {};
  row.wait = PathProgress::kMinWait;
}

// The number plus one of the first corner on the path from which the shortest path to its end leads
// there as it does. Before that the body would be led back into the jam if it lost its path.
size_t WalkMode::find_via(const Body& body, const StrideGround& ground, size_t worker,
                          const Path& path) {
  constexpr double kSameShare = 0.9, kSame = 1;  // [1, m]: paths so much shorter are others
  const world::WorldData& data = *data_of(shared_.world);
  Path& shortest = classes_[body.avatar_class]->compared[worker];
  const size_t last = path.points.size() - 1;
  const PathPoint end = point_of(data, path.points[last]);
  double left = 0;  // of the path [m]
  for (size_t k = last; k > 1; --k) {
    const Vec3d &a = path.points[k - 1].position, &b = path.points[k].position;
    const double dx = b.x - a.x, dz = b.z - a.z;
    left += std::sqrt(dx * dx + dz * dz);
    find_path(body, point_of(data, path.points[k - 1]), end, ground, worker, shortest);
    if (shortest.end != PathEnd::kReached || shortest.length < kSameShare * left - kSame) return k;
  }
  return 1;
}

// It has lost its path on a detour: it heads for that again.
bool WalkMode::plan_to_via(Body& body, Route& route, const StrideGround& ground, size_t worker) {
  Path& path = classes_[body.avatar_class]->paths[worker];
  const size_t via = route.via - 1u;
  route.via = 0;
  find_path(body, place_of_body(body), route.corners[via], ground, worker, path);
  if (path.end != PathEnd::kReached || path.points.size() < 2 || !path.links.empty()) return false;
  const size_t corners = path.points.size() - 1;
  take_path(body, route, ground, path, via);
  route.via = corners < route.count ? corners & 0x7f : 0;
  return true;
}

// A path to one of its corners, and what comes after that.
void WalkMode::take_path(Body& body, Route& route, const StrideGround& ground, const Path& path,
                         size_t end) {
  const float replaced = length_between(route, route.next, end) * static_cast<float>(shared_.unit);
  const float after_end = std::max(engine_.path_after(body.slot) - replaced, 0.0f);
  replace_corners(*data_of(shared_.world), path, end, ground, following(), body, route);
  const Vec3d &a = path.points[0].position, &b = path.points[1].position;
  const double dx = b.x - a.x, dz = b.z - a.z;
  const auto after_first = static_cast<float>(path.length - std::sqrt(dx * dx + dz * dz));
  engine_.set_path_after(body.slot, after_end + std::max(after_first, 0.0f));
  note_onward(body, route);
}

}  // namespace throng::crowd
