// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "scenario/simulation_state.h"

// Groups stay together: who is ahead of the others slows down, who is behind hurries.
namespace throng {
namespace {

constexpr double kPerMetre = 0.35;  // of the speed, for each metre ahead of the middle
constexpr double kSlowest = 0.35, kFastest = 1.15;

}  // namespace

// Has everybody of his group who is about come as far?
bool Simulation::State::group_is_ready(const Person& p) {
  const auto& members = groups[static_cast<size_t>(p.group)];
  return std::all_of(members.begin(), members.end(), [&](uint64_t number) {
    const Person* other = person(number);
    return other == nullptr || other->stage > p.stage || other->doing == Doing::kGathering ||
           other->doing == Doing::kGoalUnreachable || other->doing == Doing::kNothing;
  });
}

void Simulation::State::keep_together() {
  for (const std::vector<uint64_t>& members : groups) {
    Vec3d middle, heading;
    double slowest = INFINITY;
    std::vector<std::pair<AvatarId, AvatarState>> walkers;
    for (const uint64_t number : members) {
      const Person* p = person(number);
      if (p == nullptr || (p->doing != Doing::kWalking && p->doing != Doing::kToSpot)) continue;
      walkers.emplace_back(p->id, *crowd.read(p->id));
      const AvatarState& at = walkers.back().second;
      middle = {middle.x + at.position.x, 0, middle.z + at.position.z};
      heading = {heading.x + at.heading_x, 0, heading.z + at.heading_z};
      slowest = std::min(slowest, p->speed);
    }
    if (walkers.size() < 2) continue;
    const auto count = static_cast<double>(walkers.size());
    const double size = std::sqrt(heading.x * heading.x + heading.z * heading.z);
    for (const auto& [id, at] : walkers) {
      double ahead = 0;
      if (size > 0.1) {
        ahead = ((at.position.x - middle.x / count) * heading.x +
                 (at.position.z - middle.z / count) * heading.z) /
                size;
      }
      const Person& p = persons[id.slot1 - 1];
      const double speed = p.pace * slowest * std::clamp(1 - kPerMetre * ahead, kSlowest, kFastest);
      crowd.set_speeds({&id, 1}, {&speed, 1});
    }
  }
}

}  // namespace throng
