// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/plan_point.h"
#include "scenario/simulation_state.h"

// Journeys: the stages of an avatar one after the other, and the choice of the quickest exit
// ([Lindley52], door_queue.h). Time of a choice: exits x (a path length + log of the queue).
namespace throng {
namespace {

constexpr double kNearRadius = 1.5;    // [m] An avatar this near its place
constexpr double kNearTime = 4;        // [s] for this long has arrived.
constexpr double kDoorFlow = 2.0;      // [avatars / (m s)], assumed for the choice of an exit
constexpr uint64_t kChoosePeriod = 3;  // [reviews]
constexpr double kSwitchRatio = 0.75;  // Another exit must take less than this share of the time.

// Sum of the longest sides of an area's prisms: the width of an exit. [m]
double width_of(const ScenarioArea& area) {
  double width = 0;
  for (const Prism& prism : area.prisms) {
    double longest = 0;
    for (size_t i = 0; i < prism.corners.size(); ++i) {
      const PlanPoint &a = prism.corners[i], &b = prism.corners[(i + 1) % prism.corners.size()];
      longest = std::max(longest, plan_length(b[0] - a[0], b[1] - a[1]));
    }
    width += longest;
  }
  return width;
}

}  // namespace

double distance_to(const Prism& prism, double x, double z) {
  if (prism.covers(x, z)) return 0;
  double min_distance = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < prism.corners.size(); ++i) {
    const PlanPoint &a = prism.corners[i], &b = prism.corners[(i + 1) % prism.corners.size()];
    const double ex = b[0] - a[0], ez = b[1] - a[1];
    const double along = ((x - a[0]) * ex + (z - a[1]) * ez) / (ex * ex + ez * ez);
    const double part = std::clamp(along, 0.0, 1.0);
    min_distance = std::min(min_distance, plan_length(a[0] + part * ex - x, a[1] + part * ez - z));
  }
  return min_distance;
}

double door_flow(const ScenarioArea& area) { return std::max(kDoorFlow * width_of(area), 1e-3); }

// Makes the present place the goal: the avatar yields to others and returns.
void Simulation::State::stand(ScenarioAvatar& p, Doing doing) {
  const auto state = crowd.read(p.id);
  const Place here = world.find_place(class_of(p), state->position, Prism::kFeetTolerance);
  crowd.set_goals({&p.id, 1}, {&here, 1});
  p.doing = doing;
}

void Simulation::State::walk_to(ScenarioAvatar& p, const Place& place, Doing doing) {
  p.goal = place;
  p.until = -1;
  crowd.set_goals({&p.id, 1}, {&place, 1});
  p.doing = place ? doing : Doing::kGoalUnreachable;
}

void Simulation::State::begin_stage(ScenarioAvatar& p) {
  if (p.journey < 0) return stand(p, Doing::kNothing);
  const Stage& stage = stage_of(p);
  switch (stage.kind) {
    case Stage::Kind::kGo:
    case Stage::Kind::kLeave:
      if (stage.quickest) {
        choose_area(p);
        return;
      }
      [[fallthrough]];
    case Stage::Kind::kLink:
      crowd.set_targets({&p.id, 1}, targets_of(p)[0]);
      p.doing = Doing::kWalking;
      return;
    case Stage::Kind::kRandomPoint:
      walk_to(p, random_place(stage.areas, stage.density, p), Doing::kToRandomPlace);
      if (p.doing == Doing::kToRandomPlace) go_on_trip(p);
      return;
    case Stage::Kind::kWait:
      stand(p, Doing::kWaiting);
      p.until = time() + draw(stage.seconds, scenario.seed, p.number, 16 + p.draws++);
      return;
    case Stage::Kind::kQueue: {
      WaitingLine& line = lines[static_cast<size_t>(stage.queue)];
      line.approaching.push_back(p.number);
      const auto number = static_cast<size_t>(stage.queue);
      return walk_to(p, in_line(number, line.members.size(), class_of(p)), Doing::kToQueue);
    }
  }
}

// Members of a group wait for each other after each stage.
void Simulation::State::finish_stage(ScenarioAvatar& p) {
  if (p.group < 0 || p.doing == Doing::kWaiting) return next_stage(p);
  // Not in the entrance, where it would block the others.
  const bool is_in_region = p.doing == Doing::kWalking;
  const Place aside = is_in_region ? random_place(stage_of(p).areas, -1, p) : Place();
  if (aside) {
    walk_to(p, aside, Doing::kGathering);
  } else {
    stand(p, Doing::kGathering);
  }
  if (!group_is_ready(p)) return;
  const uint32_t stage = p.stage;
  for (const uint64_t number : groups[static_cast<size_t>(p.group)]) {
    ScenarioAvatar* member = find_avatar(number);
    if (member == nullptr || member->doing != Doing::kGathering || member->stage != stage) continue;
    next_stage(*member);
  }
}

void Simulation::State::next_stage(ScenarioAvatar& p) {
  const Journey& journey = scenario.journeys[static_cast<size_t>(p.journey)];
  set_door(p, -1, 0);
  if (p.stage + 1 < journey.stages.size()) {
    ++p.stage;
  } else if (journey.repeat) {
    p.stage = 0;
  } else {
    return stand(p, Doing::kNothing);
  }
  begin_stage(p);
}

void Simulation::State::arrive(ScenarioAvatar& p) {
  switch (p.doing) {
    case Doing::kWalking:
      if (stage_of(p).kind == Stage::Kind::kLeave) return leave(p);
      if (stage_of(p).kind == Stage::Kind::kLink) {
        boarding[static_cast<size_t>(stage_of(p).link)].members.push_back(p.number);
        p.doing = Doing::kBoarding;  // and walks on into the region, so that others find room
        return;
      }
      return finish_stage(p);
    case Doing::kToRandomPlace:
      return finish_stage(p);
    case Doing::kToWaypoint:
      return go_on_trip(p);
    default:
      return;
  }
}

// Frees the avatar's slot.
void Simulation::State::remove_from_crowd(ScenarioAvatar& p) {
  set_door(p, -1, 0);
  slot_of[p.number] = kNoSlot;
  crowd.remove({&p.id, 1});
  p = {};
}

void Simulation::State::leave(ScenarioAvatar& p) {
  Trip& trip = trips[p.number];
  trip.left = time();
  trip.exit = area_under(p);
  ++left;
  remove_from_crowd(p);
}

// The stage's area in which the avatar stands, else the nearest: a target counts as reached within
// one move of its border.
int32_t Simulation::State::area_under(const ScenarioAvatar& p) const {
  const Stage& stage = stage_of(p);
  if (p.area >= 0) return p.area;
  int32_t nearest = stage.areas.front();
  const auto state = crowd.read(p.id);
  if (!state) return nearest;
  double min_distance = std::numeric_limits<double>::infinity();
  for (const int32_t area : stage.areas) {
    for (const Prism& prism : scenario.areas[static_cast<size_t>(area)].prisms) {
      const Vec3d& at = state->position;
      if (!prism.covers_height(at.y)) continue;
      const double off = distance_to(prism, at.x, at.z);
      if (off >= min_distance) continue;
      min_distance = off;
      nearest = area;
    }
  }
  return nearest;
}

// Moves the avatar from the queue of its exit to that of another, or of none (-1).
void Simulation::State::set_door(ScenarioAvatar& p, int32_t area, double distance) {
  if (p.area >= 0) doors[static_cast<size_t>(p.area)].remove(p.door_tick);
  p.area = area;
  if (area < 0) return;
  scenario::DoorQueue& door = doors[static_cast<size_t>(area)];
  door.forget_before(scenario::DoorQueue::tick(time()));
  p.door_tick = door.add(scenario::DoorQueue::tick(time() + distance / p.speed));
}

// Puts the avatar in the queue by its present distance.
void Simulation::State::update_door_time(ScenarioAvatar& p) {
  const Stage& stage = stage_of(p);
  const auto k = static_cast<size_t>(std::find(stage.areas.begin(), stage.areas.end(), p.area) -
                                     stage.areas.begin());
  set_door(p, p.area, crowd.distance(p.id, targets_of(p)[k]));
}

// Chooses the area with the earliest expected exit time, from the distance to it and the avatars
// expected at its door before. The present choice, at first the nearest area, is dropped only for
// one that is quicker by kSwitchRatio.
void Simulation::State::choose_area(ScenarioAvatar& p) {
  const Stage& stage = stage_of(p);
  const std::vector<TargetId>& targets = targets_of(p);
  const int32_t before = p.doing == Doing::kWalking ? p.area : -1;
  set_door(p, -1, 0);
  const uint32_t now = scenario::DoorQueue::tick(time());
  constexpr double kNever = std::numeric_limits<double>::infinity();
  struct Exit {
    double distance = kNever, seconds = kNever;
    size_t k = 0;
  };
  Exit best, present;
  for (size_t k = 0; k < targets.size(); ++k) {
    Exit exit{crowd.distance(p.id, targets[k]), kNever, k};
    if (std::isfinite(exit.distance)) {
      const scenario::DoorQueue& door = doors[static_cast<size_t>(stage.areas[k])];
      exit.seconds =
          door.pass_time(scenario::DoorQueue::tick(time() + exit.distance / p.speed), now) - time();
    }
    if (exit.seconds < best.seconds) best = exit;
    if (before < 0 ? exit.distance < present.distance : stage.areas[k] == before) present = exit;
  }
  const bool stays = !(best.seconds < present.seconds * kSwitchRatio);
  const Exit& chosen = stays ? present : best;
  set_door(p, stage.areas[chosen.k], chosen.distance);
  if (before == p.area) return;
  crowd.set_targets({&p.id, 1}, targets[chosen.k]);
  p.doing = Doing::kWalking;
}

void Simulation::State::end_waits() {
  for (ScenarioAvatar& p : avatars) {
    if (!p.id || p.doing != Doing::kWaiting || p.until > time()) continue;
    if (p.has_started) {
      finish_stage(p);
    } else {
      p.has_started = true;
      begin_stage(p);
    }
  }
}

bool Simulation::State::is_near(const ScenarioAvatar& p, const Place& place) const {
  const auto state = crowd.read(p.id);
  return plan_distance(state->position, place.position) < kNearRadius &&
         std::fabs(state->position.y - place.position.y) < kNearRadius;
}

// Ends the stage of avatars that stay near their place; lets the others compare exits again,
// each in turn.
void Simulation::State::review_stages() {
  const auto review = static_cast<uint64_t>(time() + 0.5);
  for (ScenarioAvatar& p : avatars) {
    if (p.id && p.area >= 0) update_door_time(p);
  }
  for (ScenarioAvatar& p : avatars) {
    if (!p.id) continue;
    if (p.doing == Doing::kWalking && p.area >= 0 && stage_of(p).quickest &&
        (review + p.number) % kChoosePeriod == 0) {
      choose_area(p);
    }
    if (p.doing == Doing::kToWaypoint && is_near(p, p.waypoint)) go_on_trip(p);
    if (p.doing != Doing::kToRandomPlace) continue;
    if (!is_near(p, p.goal)) {
      p.until = -1;
    } else if (p.until < 0) {
      p.until = time();
    } else if (time() - p.until >= kNearTime) {
      finish_stage(p);
    }
  }
}

}  // namespace throng
