// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/parallel.h"
#include "crowd/fly/fly_mode.h"

// Searches for the paths of flyers, at the end of a step, in the order in which they were asked
// for, of one step by slots. Each has one slice in the memory of a worker, in which most end. Those
// that do not go on in slices, a few of each class at a time, in memory of their own. All slices of
// a step together expand kBoxesPerSecond boxes a simulated second at most. What is done in a step
// depends on the boxes that are expanded alone, so results are the same for any number of workers
// and on every machine. Time in a step: these boxes, and linear in the bodies while there is a
// search.
namespace throng::crowd {
namespace {

constexpr double kBoxesPerSecond = 163840;  // 16 slices in 0.1 s: 4 to 27 ms on one thread
constexpr uint64_t kMinBoxesInStep = 4 * kSliceBoxes;  // in a sub-step, however short

}  // namespace

void FlyMode::advance_searches(std::span<Body> bodies) {
  if (searches_.empty() && !some_ask_.load(std::memory_order_relaxed)) return;
  list_searches(bodies);
  const double seconds = shared_.config.dt / shared_.sub_steps;
  const auto all =
      std::max(static_cast<uint64_t>(std::lround(kBoxesPerSecond * seconds)), kMinBoxesInStep);
  const bool some_go_on = std::any_of(searches_.begin(), searches_.end(),
                                      [](const LongSearch& search) { return search.slices > 0; });
  const uint64_t kept = some_go_on ? all / 2 : 0;
  uint64_t left = kept + begin_searches(bodies, all - kept);
  while (choose_searches(bodies, left)) {
    parallel_for(active_.size(), shared_.config.workers,
                 [&](size_t a) { advance(active_[a], bodies[active_[a].body]); });
    for (const ActiveSearch& active : active_) left -= active.boxes;
  }
  shared_.flight_boxes += all - left;
}

// Takes out the searches of flyers that are gone, have another goal or have their path, and adds
// those that were asked for.
void FlyMode::list_searches(std::span<const Body> bodies) {
  constexpr uint8_t kKept = kTakesOff + 1;  // also against a list that has a slot twice
  some_ask_.store(false, std::memory_order_relaxed);
  searching_.clear();
  for (size_t i = 0; i < bodies.size(); ++i) {
    uint8_t& search = flights_[bodies[i].slot].search;
    if (search != kAsked && search != kListed) continue;
    if (bodies[i].has(Body::kHasGoal)) {
      searching_.emplace_back(bodies[i].slot, i);
    } else {
      search = kNoSearch;
    }
  }
  std::sort(searching_.begin(), searching_.end());
  body_of_search_.clear();
  size_t kept = 0;
  for (const LongSearch& search : searches_) {
    const auto at =
        std::lower_bound(searching_.begin(), searching_.end(), std::pair(search.slot, size_t{0}));
    if (at == searching_.end() || at->first != search.slot) continue;
    Flight& flight = flights_[search.slot];
    if (flight.search != kListed) continue;
    flight.search = kKept;
    searches_[kept++] = search;
    body_of_search_.push_back(at->second);
  }
  searches_.resize(kept);
  for (const auto& [slot, body] : searching_) {
    Flight& flight = flights_[slot];
    if (flight.search != kKept) {
      searches_.push_back({.ends = {}, .slot = slot, .slices = 0});
      body_of_search_.push_back(body);
    }
    flight.search = kListed;
  }
}

// The first slice of each search that has not begun, as long as boxes are left. Returns how many
// are left.
uint64_t FlyMode::begin_searches(std::span<Body> bodies, uint64_t left) {
  size_t next = 0;
  while (left >= kSliceBoxes) {
    active_.clear();
    for (; next < searches_.size() && (active_.size() + 1) * kSliceBoxes <= left; ++next) {
      if (searches_[next].slices > 0) continue;
      const Body& body = bodies[body_of_search_[next]];
      // What a searcher may have of an earlier search for this flyer is of no use.
      auto& slots = classes_[body.avatar_class]->slot_of_searcher;
      std::replace(slots.begin(), slots.end(), body.slot, kNoSlot);
      active_.push_back({.search = next, .body = body_of_search_[next]});
    }
    if (active_.empty()) break;
    parallel_for_worker(active_.size(), shared_.config.workers, [&](size_t a, int32_t worker) {
      begin(active_[a], bodies[active_[a].body], static_cast<size_t>(worker));
    });
    for (const ActiveSearch& active : active_) left -= active.boxes;
  }
  return left;
}

// The first searches of each class that go on, each in the memory in which it was begun. False:
// there are none for which enough boxes are left.
bool FlyMode::choose_searches(std::span<const Body> bodies, uint64_t left) {
  for (const auto& parts : classes_) {
    if (parts) parts->active = parts->taken = 0;
  }
  active_.clear();
  for (size_t s = 0; s < searches_.size(); ++s) {
    const LongSearch& search = searches_[s];
    if (search.slices == 0 || flights_[search.slot].search != kListed) continue;
    OfClass& parts = *classes_[bodies[body_of_search_[s]].avatar_class];
    if (parts.active == kSearchers) continue;
    const uint64_t boxes = (search.slices == 1 ? 2 : 1) * kSliceBoxes;  // see advance
    if (boxes > left) break;
    left -= boxes;
    ++parts.active;
    const auto has_it =
        std::find(parts.slot_of_searcher.begin(), parts.slot_of_searcher.end(), search.slot);
    const auto searcher = static_cast<size_t>(has_it - parts.slot_of_searcher.begin());
    if (searcher < kSearchers) parts.taken |= 1u << searcher;
    active_.push_back({.search = s,
                       .body = body_of_search_[s],
                       .searcher = searcher,
                       .is_begun = searcher < kSearchers});
  }
  for (ActiveSearch& active : active_) {
    if (active.is_begun) continue;
    OfClass& parts = *classes_[bodies[active.body].avatar_class];
    active.searcher = 0;
    while ((parts.taken >> active.searcher & 1) != 0) ++active.searcher;
    parts.taken |= 1u << active.searcher;
    parts.slot_of_searcher[active.searcher] = searches_[active.search].slot;
  }
  return !active_.empty();
}

void FlyMode::begin(ActiveSearch& active, Body& body, size_t lane) {
  LongSearch& search = searches_[active.search];
  const Flight& flight = flights_[body.slot];
  OfClass& parts = *classes_[body.avatar_class];
  if (!body.flies()) {
    search.ends = {feet_of(body), feet_of(body), flight.goal};
  } else {
    // One that flies on needs the rest of its path.
    const bool waits = body.has(Body::kNeedsPath) || flight.count == 0;
    const AirPosition from = waits ? first_in_air(body, flight) : flight.points[flight.count - 1u];
    search.ends = ends_of(body, flight, from, lane);
  }
  begin_search(parts, lane, search.ends.begin, search.ends.to);
  search.slices = 1;
  if (advance_search(parts, lane, active.boxes)) use_path(search, body, lane);
}

// A search that is in no searcher's memory repeats the slices that were done: the first one, which
// a worker has done, or all of them, in a crowd that was restored. Only the first one counts, so
// that such a crowd goes on as the one that was saved.
void FlyMode::advance(ActiveSearch& active, Body& body) {
  LongSearch& search = searches_[active.search];
  OfClass& parts = *classes_[body.avatar_class];
  const size_t lane = parts.first_searcher + active.searcher;
  if (search.slices == 1) active.boxes += kSliceBoxes;
  bool is_done = false;
  if (!active.is_begun) {
    begin_search(parts, lane, search.ends.begin, search.ends.to);
    uint64_t repeated = 0;
    for (uint32_t s = 0; s < search.slices && !is_done; ++s) {
      is_done = advance_search(parts, lane, repeated);
    }
  }
  ++search.slices;
  if (is_done || advance_search(parts, lane, active.boxes)) use_path(search, body, lane);
}

// The search is over.
void FlyMode::use_path(const LongSearch& search, Body& body, size_t lane) {
  Flight& flight = flights_[body.slot];
  if (!body.flies()) return use_path_on_foot(body, flight, lane);
  flight.search = kNoSearch;
  if (take_points(body, flight, search.ends, lane)) {
    if (!join_path(body, flight, search.ends.from, lane)) ask_for_search(flight);
  } else if (body.has(Body::kNeedsPath)) {
    shared_.drop_goal(body);
  } else {
    body.flags |= Body::kNeedsPath;  // from where it is
  }
}

// Sets the path that was found, from where the flyer is now. False: it was pushed to where it does
// not see the path's beginning, and stays there.
bool FlyMode::join_path(Body& body, Flight& flight, const AirPosition& from, size_t lane) {
  OfClass& parts = *classes_[body.avatar_class];
  Buffers& buffers = parts.buffers[lane];
  if (body.has(Body::kNeedsPath)) {
    const AirPosition at = first_in_air(body, flight);
    const auto sees = [&](const AirPosition& there) {
      return parts.air.sees(at, there) && is_clear_of_obstacles(body, at, there);
    };
    if (!sees(buffers.points.front())) {
      if (!sees(from)) {
        body.local_target_x = at.x;
        body.local_target_z = at.z;
        flight.local_target_y = at.y;
        return false;
      }
      buffers.points.insert(buffers.points.begin(), from);
    }
  } else {
    put_before(flight, buffers.points);
  }
  set_path(flight, buffers.points, buffers.lands);
  body.clear(Body::kNeedsPath);
  body.detour_angle = 0;
  turn_to(body, flight);
  return true;
}

// The air has changed.
void FlyMode::restart_searches() {
  for (LongSearch& search : searches_) search.slices = 0;
}

}  // namespace throng::crowd
