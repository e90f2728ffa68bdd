// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/plan_point.h"
#include "scenario/simulation_state.h"

// Journeys: one stage after the other.
namespace throng {
namespace {

constexpr double kNearSpot = 1.5;     // [m] Who is so near his spot
constexpr double kNearLong = 4;       // [s] for so long, and cannot come nearer, is there.
constexpr double kDoorFlow = 2.0;     // [people / (m s)], of who chooses the quickest exit
constexpr uint64_t kChooseEvery = 3;  // looks around
constexpr uint64_t kRetryEvery = 5;   // looks around
constexpr double kBetter = 0.75;      // Another exit must be that much quicker.

// Not the C library's hypot, which differs between machines.
double size_of(double x, double z) { return std::sqrt(x * x + z * z); }

// How far a place is from a shape, looked at from above; 0 inside. [m]
double distance_to(const Prism& prism, double x, double z) {
  if (prism.covers(x, z)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < prism.corners.size(); ++i) {
    const PlanPoint &a = prism.corners[i], &b = prism.corners[(i + 1) % prism.corners.size()];
    const double ex = b[0] - a[0], ez = b[1] - a[1];
    const double along = ((x - a[0]) * ex + (z - a[1]) * ez) / (ex * ex + ez * ez);
    const double part = std::clamp(along, 0.0, 1.0);
    least = std::min(least, size_of(a[0] + part * ex - x, a[1] + part * ez - z));
  }
  return least;
}

// Longer side of what a shape covers: of an exit, its width. [m]
double width_of(const ScenarioArea& area) {
  double width = 0;
  for (const Prism& prism : area.prisms) {
    double longest = 0;
    for (size_t i = 0; i < prism.corners.size(); ++i) {
      const PlanPoint &a = prism.corners[i], &b = prism.corners[(i + 1) % prism.corners.size()];
      longest = std::max(longest, size_of(b[0] - a[0], b[1] - a[1]));
    }
    width += longest;
  }
  return width;
}

}  // namespace

double door_flow(const ScenarioArea& area) { return std::max(kDoorFlow * width_of(area), 1e-3); }

// Where he is, but for making way for others.
void Simulation::State::stand(Person& p, Doing doing) {
  const auto state = crowd.read(p.id);
  const Place here = world.find_place(class_of(p), state->position, Prism::kFeet);
  crowd.set_goals({&p.id, 1}, {&here, 1});
  p.doing = doing;
}

void Simulation::State::walk_to(Person& p, const Place& place, Doing doing) {
  p.spot = place;
  p.until = -1;
  crowd.set_goals({&p.id, 1}, {&place, 1});
  p.doing = place ? doing : Doing::kGoalUnreachable;
}

void Simulation::State::begin_stage(Person& p) {
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
    case Stage::Kind::kSpot:
      return walk_to(p, random_spot(stage.areas, stage.density, p), Doing::kToSpot);
    case Stage::Kind::kWait:
      stand(p, Doing::kWaiting);
      p.until = time() + draw(stage.seconds, scenario.seed, p.number, 16 + p.draws++);
      return;
    case Stage::Kind::kQueue: {
      WaitingLine& line = lines[static_cast<size_t>(stage.queue)];
      line.coming.push_back(p.number);
      const Queue& queue = scenario.queues[static_cast<size_t>(stage.queue)];
      return walk_to(p, in_line(queue, line.people.size(), class_of(p)), Doing::kToQueue);
    }
  }
}

// Members of a group wait for each other between stages.
void Simulation::State::finish_stage(Person& p) {
  if (p.group < 0 || p.doing == Doing::kWaiting) return next_stage(p);
  // Not in the door through which they come.
  const bool came_in = p.doing == Doing::kWalking;
  const Place aside = came_in ? random_spot(stage_of(p).areas, -1, p) : Place();
  if (aside) {
    walk_to(p, aside, Doing::kGathering);
  } else {
    stand(p, Doing::kGathering);
  }
  if (!group_is_ready(p)) return;
  const uint32_t stage = p.stage;
  for (const uint64_t number : groups[static_cast<size_t>(p.group)]) {
    Person* member = person(number);
    if (member == nullptr || member->doing != Doing::kGathering || member->stage != stage) continue;
    next_stage(*member);
  }
}

void Simulation::State::next_stage(Person& p) {
  const Journey& journey = scenario.journeys[static_cast<size_t>(p.journey)];
  line_up(p, -1, 0);
  if (p.stage + 1 < journey.stages.size()) {
    ++p.stage;
  } else if (journey.repeat) {
    p.stage = 0;
  } else {
    return stand(p, Doing::kNothing);
  }
  begin_stage(p);
}

void Simulation::State::arrive(Person& p) {
  switch (p.doing) {
    case Doing::kWalking:
      if (stage_of(p).kind == Stage::Kind::kLeave) return leave(p);
      if (stage_of(p).kind == Stage::Kind::kLink) {
        landings[static_cast<size_t>(stage_of(p).link)].people.push_back(p.number);
        p.doing = Doing::kBoarding;  // and goes on into the region, so that others find room
        return;
      }
      return finish_stage(p);
    case Doing::kToSpot:
      return finish_stage(p);
    default:
      return;
  }
}

// Out of the crowd; the slot is free then.
void Simulation::State::take_out(Person& p) {
  line_up(p, -1, 0);
  slot_of[p.number] = kNoSlot;
  crowd.remove({&p.id, 1});
  p = {};
}

void Simulation::State::leave(Person& p) {
  Visit& visit = visits[p.number];
  visit.left = time();
  visit.exit = area_under(p);
  ++left;
  take_out(p);
}

// Of the stage's areas that in which he stands, or the nearest: who comes to within a step of its
// border has arrived.
int32_t Simulation::State::area_under(const Person& p) const {
  const Stage& stage = stage_of(p);
  if (p.area >= 0) return p.area;
  int32_t nearest = stage.areas.front();
  const auto state = crowd.read(p.id);
  if (!state) return nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const int32_t area : stage.areas) {
    for (const Prism& prism : scenario.areas[static_cast<size_t>(area)].prisms) {
      const Vec3d& at = state->position;
      if (!prism.reaches(at.y)) continue;
      const double off = distance_to(prism, at.x, at.z);
      if (off >= least) continue;
      least = off;
      nearest = area;
    }
  }
  return nearest;
}

// Is one of those who chose an area, of another than before, or of none (-1).
void Simulation::State::line_up(Person& p, int32_t area, double way) {
  if (p.area >= 0) doors[static_cast<size_t>(p.area)].remove(p.comes);
  p.area = area;
  if (area < 0) return;
  DoorQueue& door = doors[static_cast<size_t>(area)];
  door.forget_before(DoorQueue::tick(time()));
  p.comes = door.add(DoorQueue::tick(time() + way / p.speed));
}

// As far as it is by now.
void Simulation::State::line_up_anew(Person& p) {
  const Stage& stage = stage_of(p);
  const auto k = static_cast<size_t>(std::find(stage.areas.begin(), stage.areas.end(), p.area) -
                                     stage.areas.begin());
  line_up(p, p.area, crowd.distance(p.id, targets_of(p)[k]));
}

// Takes the area that is likely to be passed first, by the way there and by those who will be at
// its door before him. The one that he has chosen, or at first the nearest, is left only for one
// that is clearly quicker.
void Simulation::State::choose_area(Person& p) {
  const Stage& stage = stage_of(p);
  const std::vector<TargetId>& targets = targets_of(p);
  const int32_t before = p.doing == Doing::kWalking ? p.area : -1;
  line_up(p, -1, 0);
  const uint32_t now = DoorQueue::tick(time());
  constexpr double kNever = std::numeric_limits<double>::infinity();
  struct Exit {
    double way = kNever, seconds = kNever;
    size_t k = 0;
  };
  Exit best, present;
  for (size_t k = 0; k < targets.size(); ++k) {
    Exit exit{crowd.distance(p.id, targets[k]), kNever, k};
    if (std::isfinite(exit.way)) {
      const DoorQueue& door = doors[static_cast<size_t>(stage.areas[k])];
      exit.seconds = door.passes(DoorQueue::tick(time() + exit.way / p.speed), now) - time();
    }
    if (exit.seconds < best.seconds) best = exit;
    if (before < 0 ? exit.way < present.way : stage.areas[k] == before) present = exit;
  }
  const bool stays = !(best.seconds < present.seconds * kBetter);
  const Exit& taken = stays ? present : best;
  line_up(p, stage.areas[taken.k], taken.way);
  if (before == p.area) return;
  crowd.set_targets({&p.id, 1}, targets[taken.k]);
  p.doing = Doing::kWalking;
}

void Simulation::State::end_waits() {
  for (Person& p : persons) {
    if (!p.id || p.doing != Doing::kWaiting || p.until > time()) continue;
    if (p.has_started) {
      finish_stage(p);
    } else {
      p.has_started = true;
      begin_stage(p);
    }
  }
}

// Who stands near his spot and cannot come nearer is there; who chose an exit looks at the others.
void Simulation::State::look_around() {
  const auto look = static_cast<uint64_t>(time() + 0.5);
  for (Person& p : persons) {
    if (p.id && p.area >= 0) line_up_anew(p);
  }
  for (Person& p : persons) {
    if (!p.id) continue;
    if (p.doing == Doing::kWalking && p.area >= 0 && stage_of(p).quickest &&
        (look + p.number) % kChooseEvery == 0) {
      choose_area(p);
    }
    // The ground may have changed.
    if (p.doing == Doing::kGoalUnreachable && stage_of(p).kind != Stage::Kind::kQueue &&
        (look + p.number) % kRetryEvery == 0) {
      begin_stage(p);
    }
    if (p.doing != Doing::kToSpot) continue;
    const auto state = crowd.read(p.id);
    const Vec3d& at = state->position;
    const bool near = size_of(at.x - p.spot.position.x, at.z - p.spot.position.z) < kNearSpot &&
                      std::fabs(at.y - p.spot.position.y) < kNearSpot;
    if (!near) {
      p.until = -1;
    } else if (p.until < 0) {
      p.until = time();
    } else if (time() - p.until >= kNearLong) {
      finish_stage(p);
    }
  }
}

}  // namespace throng
