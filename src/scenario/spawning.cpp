// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/math/trig.h"
#include "scenario/simulation_state.h"

// How avatars enter the crowd: from sources and out of links. A random place is drawn for each; the
// crowd refuses those that overlap, which are drawn again. Time: by those that enter, see
// EntryQueue; where fewer than EntryQueue::kMinTries wait, kMaxRounds draws each a step at most.
namespace throng {
namespace {

constexpr int kMaxRounds = 32;        // of drawing places in a step
constexpr size_t kFirstBatch = 1024;  // avatars of a round that are tried at once
constexpr double kGroupRadius = 0.7;  // [m] Members of a group enter this near to the first,
constexpr double kGroupHeight = 1.5;  // [m] and at most this much above or below.

// The choice that a number in [0, 1) falls to by the weights; -1: there are none.
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

// Appends the avatars due by now to `pending`.
void Simulation::State::queue_spawns() {
  for (size_t n = 0; n < spawn_times.size(); ++n) {
    const Source& source = scenario.sources[n];
    while (const uint64_t members = spawn_times[n].next_due(time())) {
      const int32_t group = members > 1 ? static_cast<int32_t>(groups.size()) : -1;
      if (members > 1) groups.emplace_back();
      int32_t journey = -1;
      uint64_t first = UINT64_MAX;
      for (uint64_t k = 0; k < members; ++k) {
        PendingSpawn one;
        ScenarioAvatar& p = one.avatar;
        one.source = static_cast<int32_t>(n);
        one.companion = first;
        one.nth = spawn_counts[n]++;
        p.number = slot_of.size();
        slot_of.push_back(kNoSlot);
        p.profile = pick(source.profiles, unit(p));
        if (k == 0) journey = pick(source.journeys, unit(p));
        p.journey = journey;
        p.follows = map_of(source, journey);
        p.group = group;
        if (group >= 0) groups[static_cast<size_t>(group)].push_back(p.number);
        if (k == 0) first = p.number;
        pending.push(n, time(), one);
      }
    }
  }
}

Place Simulation::State::random_place(std::span<const int32_t> areas, int32_t density,
                                      ScenarioAvatar& p) {
  if (density >= 0) return random_place_of(density, p);
  const int32_t avatar_class = crowd_class_of(p);
  // Each area with a probability proportional to its places.
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

// The n-th of `count` places in rows across the shorter side of the box around the source's area,
// each moved at random as far as two bodies leave room.
Place Simulation::State::place_in_rows(const Source& source, uint64_t nth, ScenarioAvatar& p) {
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
  const double spacing_along = length / rows, spacing_across = width / across;
  const auto n = static_cast<double>(nth);
  const double row = std::floor(n / across), column = n - row * across;
  const int32_t kind = class_of(p);
  double radius = kinds[static_cast<size_t>(kind)].radius;
  if (p.profile >= 0) {
    const Profile& profile = scenario.profiles[static_cast<size_t>(p.profile)];
    if (profile.radius.a > 0) radius = std::max(profile.radius.a, profile.radius.b);
  }
  const double spare = std::max(0.0, std::min(spacing_along, spacing_across) - 2 * radius - 0.004);
  const double u = (row + 0.5) * spacing_along + spare * (unit(p) - 0.5);
  const double v = (column + 0.5) * spacing_across + spare * (unit(p) - 0.5);
  const Prism& first = area.prisms.front();
  const double x = x0 + (along_x ? u : v), z = z0 + (along_x ? v : u);
  return world.find_place(kind, {x, (first.low + first.high) / 2, z}, (first.high - first.low) / 2);
}

Place Simulation::State::choose_place(PendingSpawn& one) {
  ScenarioAvatar& p = one.avatar;
  if (one.link >= 0) {
    const int32_t to = scenario.links[static_cast<size_t>(one.link)].to;
    return random_place({&to, 1}, -1, p);
  }
  const ScenarioAvatar* companion =
      one.companion == UINT64_MAX ? nullptr : find_avatar(one.companion);
  if (companion != nullptr) {
    if (const auto beside = crowd.read(companion->id)) {
      const double turns = unit(p), size = (0.3 + unit(p)) * kGroupRadius;
      const Vec3d& at = beside->position;
      const Place place = world.find_place(
          class_of(p), {at.x + size * cos_turns(turns), at.y, at.z + size * sin_turns(turns)},
          kGroupHeight);
      if (place) return place;
    }
  }
  const Source& source = scenario.sources[static_cast<size_t>(one.source)];
  if (source.pattern == SpawnPattern::kRows) return place_in_rows(source, one.nth, p);
  return random_place(source.areas, source.density, p);
}

AvatarSpawn Simulation::State::spawn_of(const ScenarioAvatar& p, const Place& place) const {
  double speed = p.speed, radius = 0;
  if (p.profile >= 0) {
    const Profile& profile = scenario.profiles[static_cast<size_t>(p.profile)];
    if (speed == 0) speed = draw(profile.speed, scenario.seed, p.number, 1);
    radius = draw(profile.radius, scenario.seed, p.number, 2);
  }
  return {place, crowd_class_of(p), radius, speed};
}

// Tries all that are due once, but those of sources that are full.
Result<Simulation::State::EntryTries> Simulation::State::try_entries(
    scenario::EntryQueue<PendingSpawn>& queue, Context& context) {
  queue.begin_round();
  EntryTries tries;
  // In batches that grow, because each looks at all bodies of the crowd.
  for (size_t max_count = kFirstBatch;; max_count *= 2) {
    const std::vector<PendingSpawn*> batch = queue.next(max_count);
    if (batch.empty()) return tries;
    entry_tries += batch.size();
    std::vector<AvatarSpawn> spawns;
    std::vector<size_t> batch_index;
    for (size_t i = 0; i < batch.size(); ++i) {
      const Place place = choose_place(*batch[i]);
      if (!place) continue;
      spawns.push_back(spawn_of(batch[i]->avatar, place));
      batch_index.push_back(i);
    }
    std::vector<bool> is_in(batch.size(), false);
    if (!spawns.empty()) {
      const auto ids = crowd.add(spawns, context);
      if (!ids) return ids.error();
      for (size_t k = 0; k < ids->size(); ++k) {
        if (!(*ids)[k]) continue;
        PendingSpawn& one = *batch[batch_index[k]];
        const AvatarClass& kind = kinds[static_cast<size_t>(class_of(one.avatar))];
        one.avatar.speed = spawns[k].speed > 0 ? spawns[k].speed : kind.speed;
        is_in[batch_index[k]] = true;
        ++tries.entered;
        enter(one, (*ids)[k]);
      }
    }
    tries.placed += spawns.size();
    queue.settle(is_in);
  }
}

// Adds avatars that find room to the crowd, in order; the others try again in the next step.
Result<void> Simulation::State::spawn_due(scenario::EntryQueue<PendingSpawn>& queue,
                                          Context& context) {
  queue.begin_step(time());
  size_t failed_rounds = 0;
  for (int round = 0; round < kMaxRounds; ++round) {
    const auto tries = try_entries(queue, context);
    if (!tries) return tries.error();
    if (tries->placed == 0) break;
    failed_rounds = tries->entered == 0 ? failed_rounds + 1 : 0;
    if (failed_rounds == 4 || tries->entered == tries->placed) break;
  }
  return {};
}

void Simulation::State::enter(const PendingSpawn& one, AvatarId id) {
  const uint32_t slot = id.slot1 - 1;
  if (slot >= avatars.size()) avatars.resize(slot + 1);
  ScenarioAvatar& p = avatars[slot];
  p = one.avatar;
  p.id = id;
  slot_of[p.number] = slot;
  if (one.link >= 0) {
    finish_stage(p);
    return;
  }
  const Source& source = scenario.sources[static_cast<size_t>(one.source)];
  ++entered;
  if (trips.size() <= p.number) trips.resize(p.number + 1);
  const double wait = draw(source.premovement, scenario.seed, p.number, 3);
  trips[p.number] = {.person = p.number,
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
