// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <span>

#include "core/parallel.h"
#include "crowd/fly/fly_mode.h"

// Searches for the paths of flyers that did not end in the step in which they were begun. They go
// on in slices, a few of each class at a time, in the order in which they were asked for, of one
// step by slots. What a slice does depends on the boxes that are expanded alone, so results are the
// same for any number of workers and on every machine. Time in a step: kSearchers slices for each
// class, and linear in the bodies while there is a search.
namespace throng::crowd {

void FlyMode::advance_searches(std::span<Body> bodies) {
  if (searches_.empty() && !some_ask_.load(std::memory_order_relaxed)) return;
  list_searches(bodies);
  choose_searches(bodies);
  parallel_for(active_.size(), shared_.config.workers,
               [&](size_t a) { advance(active_[a], bodies[active_[a].body]); });
}

// Takes out the searches of flyers that are gone, have another goal or have their path, and adds
// those that were asked for.
void FlyMode::list_searches(std::span<const Body> bodies) {
  constexpr uint8_t kKept = kListed + 1;  // also against a list that has a slot twice
  some_ask_.store(false, std::memory_order_relaxed);
  searching_.clear();
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    if (!body.flies() || flights_[body.slot].search == kNoSearch) continue;
    if (body.has(Body::kHasGoal)) {
      searching_.emplace_back(body.slot, i);
    } else {
      flights_[body.slot].search = kNoSearch;
    }
  }
  std::sort(searching_.begin(), searching_.end());
  size_t kept = 0;
  for (const LongSearch& search : searches_) {
    const auto at =
        std::lower_bound(searching_.begin(), searching_.end(), std::pair(search.slot, size_t{0}));
    if (at == searching_.end() || at->first != search.slot) continue;
    Flight& flight = flights_[search.slot];
    if (flight.search != kListed) continue;
    flight.search = kKept;
    searches_[kept++] = search;
  }
  searches_.resize(kept);
  for (const auto& [slot, body] : searching_) {
    Flight& flight = flights_[slot];
    if (flight.search != kKept) searches_.push_back({.ends = {}, .slot = slot, .slices = 0});
    flight.search = kListed;
  }
}

// The first searches of each class go on, each where it was begun.
void FlyMode::choose_searches(std::span<const Body> bodies) {
  for (const auto& parts : classes_) {
    if (parts) parts->active = parts->taken = 0;
  }
  active_.clear();
  for (size_t s = 0; s < searches_.size(); ++s) {
    const uint32_t slot = searches_[s].slot;
    const size_t body =
        std::lower_bound(searching_.begin(), searching_.end(), std::pair(slot, size_t{0}))->second;
    OfClass& parts = *classes_[bodies[body].avatar_class];
    if (parts.active == kSearchers) continue;
    ++parts.active;
    const auto has_it =
        std::find(parts.slot_of_searcher.begin(), parts.slot_of_searcher.end(), slot);
    const auto searcher = static_cast<size_t>(has_it - parts.slot_of_searcher.begin());
    if (searcher < kSearchers) parts.taken |= 1u << searcher;
    active_.push_back({.search = s, .body = body, .searcher = searcher, .is_begun = true});
  }
  for (ActiveSearch& active : active_) {
    if (active.searcher < kSearchers) continue;
    OfClass& parts = *classes_[bodies[active.body].avatar_class];
    active.searcher = 0;
    while ((parts.taken >> active.searcher & 1) != 0) ++active.searcher;
    active.is_begun = false;
    parts.taken |= 1u << active.searcher;
    parts.slot_of_searcher[active.searcher] = searches_[active.search].slot;
  }
}

void FlyMode::advance(const ActiveSearch& active, Body& body) {
  LongSearch& search = searches_[active.search];
  Flight& flight = flights_[body.slot];
  OfClass& parts = *classes_[body.avatar_class];
  const size_t lane = parts.first_searcher + active.searcher;
  if (search.slices == 0) {
    // One that flies on needs the rest of its path.
    const bool waits = body.has(Body::kNeedsPath) || flight.count == 0;
    const AirPosition from = waits ? first_in_air(body, flight) : flight.points[flight.count - 1u];
    search.ends = ends_of(body, flight, from, lane);
  }
  bool is_done = false;
  if (search.slices == 0 || !active.is_begun) {
    begin_search(parts, lane, search.ends.begin, search.ends.to);
    // The crowd was restored.
    for (uint32_t s = 0; s < search.slices && !is_done; ++s) is_done = advance_search(parts, lane);
  }
  is_done = is_done || advance_search(parts, lane);
  ++search.slices;
  if (!is_done) return;
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
  turn_to(body, flight);
  return true;
}

// The air has changed.
void FlyMode::restart_searches() {
  for (LongSearch& search : searches_) search.slices = 0;
}

}  // namespace throng::crowd
