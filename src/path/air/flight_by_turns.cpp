// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "path/air/flight_finder_state.h"

// A path that flies, lands, walks and takes off again: a route over the parts of the ground and of
// the air that take-offs join, then a search in each part of it. Time: that of these searches; the
// route is linear in the parts and their links.
namespace throng::path {

// From part to part of the ground and the air. The take-off or landing between two of them is at
// the place nearest to where the path stands, or to the goal, else at the one to which the leaf
// under the path is linked, or that is known of the two. Parts are those of the world as it was
// baked: where an obstacle blocks the path from one to the next, another path that does without
// that pair is searched for.
void FlightFinder::find_by_turns(const FlightQuery& query, Path& path) {
  Scratch& scratch = *scratch_;
  End from, to;
  if (!locate(query.from, query.vertical_tolerance, from) ||
      !locate(query.to, query.vertical_tolerance, to))
    return;
  const GroundAirLinks::Part start = state_->part_of(from), goal = state_->part_of(to);
  scratch.banned.clear();
  for (int32_t tries = 0; tries < (scratch.is_changed() ? kMaxTries : 1); ++tries) {
    // Air that an obstacle has cut in two is one part: then over some ground under it.
    const bool returns = start == goal && scratch.is_changed() && goal.is_air;
    const GroundAirLinks::Part last = returns ? GroundAirLinks::Part{kNoBox, true} : goal;
    state_->ground_air_links.search(start, last, scratch.banned, scratch.parts);
    const auto& steps = scratch.parts.steps;
    if (steps.size() < 2 || (!returns && steps.back().part != goal)) return;
    scratch.route.clear();
    if (returns) {
      scratch.route.assign({start, steps[1].part, goal});
    } else {
      for (uint32_t i = static_cast<uint32_t>(steps.size()) - 1;; i = steps[i].before) {
        scratch.route.push_back(steps[i].part);
        if (i == 0) break;
      }
      std::reverse(scratch.route.begin(), scratch.route.end());
    }
    const size_t missed = follow_route(query, from, to, path);
    if (path.end != PathEnd::kUnreachable) return;
    const GroundAirLinks::Part& a = scratch.route[missed - 1];
    const GroundAirLinks::Part& b = scratch.route[missed];
    scratch.banned.emplace_back(a.is_air ? b.component : a.component,
                                a.is_air ? a.component : b.component);
  }
}

// If it does not lead on: the place in the route of the part that it did not reach.
size_t FlightFinder::follow_route(const FlightQuery& query, const End& from, const End& to,
                                  Path& path) {
  Scratch& scratch = *scratch_;
  const AirView view = scratch.air(*state_);
  const FlightEndpoints ends = state_->ends(view);
  PathEnd end = PathEnd::kReached;
  Place feet = from.ground;  // where the path is by now, or
  AirPoint air = from.air.value_or(AirPoint{});
  const auto go = [&](const Place& there) {
    if (end != PathEnd::kReached) return;
    const Path& ground = walk(query, feet, there);
    end = ground.end;
    add_walk(ground, 1, path);
    feet = there;
  };
  const auto fly = [&](AirPoint there) {
    if (end != PathEnd::kReached) return;
    if (view.changes() != nullptr && !view.same_component(air, there)) {
      end = PathEnd::kUnreachable;
      return;
    }
    const FlightLog::Entry& found = scratch.fly(view, query, air, there, there);
    end = found.result == SearchResult::kFound    ? PathEnd::kReached
          : found.result == SearchResult::kBudget ? PathEnd::kBudgetExhausted
                                                  : PathEnd::kUnreachable;
    for (size_t i = 1; i < found.flight.size(); ++i) {
      add(ends.to_metres(found.flight[i]), SegmentKind::kFly, path);
    }
    air = there;
  };
  // A place of some ground under some air: it leads into this component of that.
  const auto link_near = [&](const Place& at, GroundAirLinks::Part ground,
                             GroundAirLinks::Part over, uint32_t component) {
    const Place near = at ? scratch.nearest_take_off(ends, at, component).place : Place{};
    if (near || scratch.log.is_pending()) return near;
    const Place known =
        state_->place_of(state_->ground_air_links.cell(ground.component, over.component));
    if (view.changes() == nullptr) return known;
    return scratch.nearest_take_off(ends, known, component).place;
  };
  // A flood that goes on has found none yet.
  const auto nowhere = [&] {
    return scratch.log.is_pending() ? PathEnd::kBudgetExhausted : PathEnd::kUnreachable;
  };
  clear(path);
  add(from.air ? ends.to_metres(air) : feet.position, SegmentKind::kWalk, path);
  const size_t count = scratch.route.size();
  size_t k = 1;
  for (; k < count && end == PathEnd::kReached; ++k) {
    const GroundAirLinks::Part here = scratch.route[k - 1], next = scratch.route[k];
    const bool last = k + 1 == count;
    if (next.is_air) {
      const bool known = last && to.air;
      const Place ground_air_link = link_near(
          feet, here, next, known ? view.component(view.box_at(*to.air)) : next.component);
      const auto up = ends.take_off(ground_air_link);
      if (!up) {
        end = nowhere();
        continue;
      }
      go(ground_air_link);
      air = *up;
      add(ends.to_metres(air), SegmentKind::kTakeOff, path);
    } else {
      Place ground_air_link = last ? Place{} : state_->linked_from(view, air);
      if (!ground_air_link || state_->ground_of(ground_air_link) != next.component) {
        ground_air_link =
            link_near(last ? to.ground : Place{}, next, here, view.component(view.box_at(air)));
      }
      const auto up = ends.take_off(ground_air_link);
      if (!up) {
        end = nowhere();
        continue;
      }
      feet = ground_air_link;
      fly(*up);
      add(feet.position, SegmentKind::kLand, path);
    }
  }
  if (to.air) {
    fly(*to.air);
  } else {
    go(to.ground);
  }
  if (end != PathEnd::kReached) clear(path);
  path.end = end;
  return k - 1;
}

}  // namespace throng::path
