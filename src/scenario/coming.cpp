// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/trig.h"
#include "scenario/simulation_state.h"

// How people come into the crowd: out of sources and out of links.
namespace throng {
namespace {

constexpr int kRounds = 32;      // of drawing places, in a step
constexpr int kPixels = 16;      // drawn, to find one with ground
constexpr double kBeside = 0.7;  // Members of a group come in within so much of another [m]
constexpr double kStorey = 1.5;  // and so much higher or lower. [m]

// The index of one of some weights that a number in [0, 1) falls to; -1: there are none.
int32_t pick(std::span<const Choice> choices, double number) {
  double sum = 0;
  for (const Choice& choice : choices) sum += choice.weight;
  number *= sum;
  for (const Choice& choice : choices) {
    if (number < choice.weight) return choice.index;
    number -= choice.weight;
  }
  return choices.empty() ? -1 : choices.back().index;
}

}  // namespace

// Whoever is due by now lines up outside.
void Simulation::State::call_in() {
  for (size_t n = 0; n < arrivals.size(); ++n) {
    const Source& source = scenario.sources[n];
    while (const uint64_t people = arrivals[n].next_due(time())) {
      const int32_t group = people > 1 ? static_cast<int32_t>(groups.size()) : -1;
      if (people > 1) groups.emplace_back();
      int32_t journey = -1;
      uint64_t first = UINT64_MAX;
      for (uint64_t k = 0; k < people; ++k) {
        Coming one;
        Person& p = one.person;
        one.due = time();
        one.source = static_cast<int32_t>(n);
        one.companion = first;
        one.nth = called[n]++;
        p.number = slot_of.size();
        slot_of.push_back(kNoSlot);
        p.profile = pick(source.profiles, unit(p));
        if (k == 0) journey = pick(source.journeys, unit(p));
        p.journey = journey;
        p.group = group;
        if (group >= 0) groups[static_cast<size_t>(group)].push_back(p.number);
        if (k == 0) first = p.number;
        coming.push_back(one);
      }
    }
  }
}

Place Simulation::State::random_spot(std::span<const int32_t> areas, int32_t density, Person& p) {
  const int32_t avatar_class = class_of(p);
  if (density >= 0) {
    const DensityMap& map = scenario.densities[static_cast<size_t>(density)];
    for (int k = 0; k < kPixels; ++k) {
      const double which = unit(p), along_x = unit(p), along_z = unit(p);
      const auto [x, z] = densities[static_cast<size_t>(density)].point(which, along_x, along_z);
      const Place place = world.find_place(avatar_class, {x, (map.low + map.high) / 2, z},
                                           (map.high - map.low) / 2);
      if (place) return place;
    }
    return {};
  }
  // As likely in each area as it has places.
  size_t count = 0;
  for (const int32_t a : areas) {
    count += places[{area_target[static_cast<size_t>(a)], avatar_class}].size();
  }
  auto n = static_cast<size_t>(unit(p) * static_cast<double>(count));
  for (const int32_t a : areas) {
    const std::vector<Place>& here = places[{area_target[static_cast<size_t>(a)], avatar_class}];
    if (n < here.size()) return here[n];
    n -= here.size();
  }
  return {};
}

// The n-th of as many places as the source has people: rows across the shorter side of the box
// around its area, each place moved by chance as far as two bodies leave room.
Place Simulation::State::place_in_rows(const Source& source, uint64_t nth, Person& p) {
  const ScenarioArea& area = scenario.areas[static_cast<size_t>(source.areas[0])];
  double x0 = INFINITY, x1 = -INFINITY, z0 = INFINITY, z1 = -INFINITY;
  for (const Prism& prism : area.prisms) {
    for (const auto& [x, z] : prism.corners) {
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      z0 = std::min(z0, z);
      z1 = std::max(z1, z);
    }
  }
  const bool along_x = x1 - x0 >= z1 - z0;
  const double length = along_x ? x1 - x0 : z1 - z0, width = along_x ? z1 - z0 : x1 - x0;
  const auto count = static_cast<double>(source.count);
  const double across = std::max(1.0, std::round(width / std::sqrt(length * width / count)));
  const double rows = std::ceil(count / across);
  const double gap_along = length / rows, gap_across = width / across;
  const auto n = static_cast<double>(nth);
  const double row = std::floor(n / across), column = n - row * across;
  const int32_t kind = class_of(p);
  double radius = kinds[static_cast<size_t>(kind)].radius;
  if (p.profile >= 0) {
    const Profile& profile = scenario.profiles[static_cast<size_t>(p.profile)];
    if (profile.radius.a > 0) radius = std::max(profile.radius.a, profile.radius.b);
  }
  const double spare = std::max(0.0, std::min(gap_along, gap_across) - 2 * radius - 0.004);
  const double u = (row + 0.5) * gap_along + spare * (unit(p) - 0.5);
  const double v = (column + 0.5) * gap_across + spare * (unit(p) - 0.5);
  const Prism& first = area.prisms.front();
  const double x = x0 + (along_x ? u : v), z = z0 + (along_x ? v : u);
  return world.find_place(kind, {x, (first.low + first.high) / 2, z}, (first.high - first.low) / 2);
}

Place Simulation::State::place_for(Coming& one) {
  Person& p = one.person;
  if (one.link >= 0) {
    const int32_t to = scenario.links[static_cast<size_t>(one.link)].to;
    return random_spot({&to, 1}, -1, p);
  }
  const Person* companion = one.companion == UINT64_MAX ? nullptr : person(one.companion);
  if (companion != nullptr) {
    if (const auto beside = crowd.read(companion->id)) {
      const double turns = unit(p), size = (0.3 + unit(p)) * kBeside;
      const Vec3d& at = beside->position;
      const Place place = world.find_place(
          class_of(p), {at.x + size * cos_turns(turns), at.y, at.z + size * sin_turns(turns)},
          kStorey);
      if (place) return place;
    }
  }
  const Source& source = scenario.sources[static_cast<size_t>(one.source)];
  if (source.in_rows) return place_in_rows(source, one.nth, p);
  return random_spot(source.areas, source.density, p);
}

// Whoever finds room comes in, the first first; the others try again in the next step.
Result<void> Simulation::State::let_in(std::deque<Coming>& queue, Context& context) {
  size_t tried_in_vain = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<AvatarSpawn> spawns;
    std::vector<size_t> who;
    for (size_t i = 0; i < queue.size(); ++i) {
      Coming& one = queue[i];
      if (one.due > time()) continue;
      const Place place = place_for(one);
      if (!place) continue;
      Person& p = one.person;
      double speed = p.speed, radius = 0;
      if (p.profile >= 0) {
        const Profile& profile = scenario.profiles[static_cast<size_t>(p.profile)];
        if (speed == 0) speed = draw(profile.speed, scenario.seed, p.number, 1);
        radius = draw(profile.radius, scenario.seed, p.number, 2);
      }
      spawns.push_back({place, class_of(p), radius, speed});
      who.push_back(i);
    }
    if (spawns.empty()) break;
    const auto ids = crowd.add(spawns, context);
    if (!ids) return ids.error();
    std::vector<bool> is_in(queue.size(), false);
    size_t came = 0;
    for (size_t k = 0; k < ids->size(); ++k) {
      if (!(*ids)[k]) continue;
      Coming& one = queue[who[k]];
      const AvatarClass& kind = kinds[static_cast<size_t>(spawns[k].avatar_class)];
      one.person.speed = spawns[k].speed > 0 ? spawns[k].speed : kind.speed;
      is_in[who[k]] = true;
      ++came;
      enter(one, (*ids)[k]);
    }
    size_t i = 0;
    std::erase_if(queue, [&](const Coming&) { return is_in[i++]; });
    tried_in_vain = came == 0 ? tried_in_vain + 1 : 0;
    if (tried_in_vain == 4 || came == spawns.size()) break;
  }
  return {};
}

void Simulation::State::enter(const Coming& one, AvatarId id) {
  const uint32_t slot = id.slot1 - 1;
  if (slot >= persons.size()) persons.resize(slot + 1);
  Person& p = persons[slot];
  p = one.person;
  p.id = id;
  slot_of[p.number] = slot;
  if (one.link >= 0) {
    finish_stage(p);
    return;
  }
  const Source& source = scenario.sources[static_cast<size_t>(one.source)];
  ++entered;
  if (visits.size() <= p.number) visits.resize(p.number + 1);
  const double wait = draw(source.premovement, scenario.seed, p.number, 3);
  visits[p.number] = {.person = p.number,
                      .source = one.source,
                      .profile = p.profile,
                      .journey = p.journey,
                      .entered = time(),
                      .started = time() + wait,
                      .left = -1,
                      .exit = -1,
                      .speed = p.speed};
  if (wait > 0) {
    stand(p, Doing::kWaiting);
    p.until = time() + wait;
  } else {
    p.has_started = true;
    begin_stage(p);
  }
}

}  // namespace throng
