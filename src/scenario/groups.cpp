// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "scenario/simulation_state.h"

// Groups stay together: members ahead of the middle walk slower, those behind it faster. Time:
// linear in the members.
namespace throng {
namespace {

constexpr double kSlowdownPerMetre =
    0.35;  // [1/m] share of the speed lost for each metre ahead of the middle
constexpr double kMinFactor = 0.35, kMaxFactor = 1.15;

// The direction of its last move, in plan; that of one that stands is +Z.
Vec3d direction_of(const AvatarState& at) {
  const Vec3d move = unleaned(at.velocity, at.up);
  const double size = std::hypot(static_cast<float>(move.x), static_cast<float>(move.z));
  return size > 0 ? Vec3d{move.x / size, 0, move.z / size} : Vec3d{0, 0, 1};
}

}  // namespace

// Are all present members of its group at this stage's end, or beyond, or unable to get there?
bool Simulation::State::group_is_ready(const ScenarioAvatar& p) {
  const auto& members = groups[static_cast<size_t>(p.group)];
  return std::all_of(members.begin(), members.end(), [&](uint64_t number) {
    const ScenarioAvatar* other = find_avatar(number);
    return other == nullptr || other->stage > p.stage || other->doing == Doing::kGathering ||
           other->doing == Doing::kGoalUnreachable || other->doing == Doing::kNothing;
  });
}

void Simulation::State::adjust_group_speeds() {
  for (const std::vector<uint64_t>& members : groups) {
    Vec3d middle, heading;
    double slowest = INFINITY;
    std::vector<std::pair<AvatarId, AvatarState>> walkers;
    for (const uint64_t number : members) {
      const ScenarioAvatar* p = find_avatar(number);
      const bool walks =
          p != nullptr && (p->doing == Doing::kWalking || p->doing == Doing::kToRandomPlace ||
                           p->doing == Doing::kToWaypoint);
      if (!walks) continue;
      walkers.emplace_back(p->id, *crowd.read(p->id));
      const AvatarState& at = walkers.back().second;
      middle = {middle.x + at.position.x, 0, middle.z + at.position.z};
      heading = heading + direction_of(at);
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
      const ScenarioAvatar& p = avatars[id.slot1 - 1];
      const double speed = p.speed_factor * slowest *
                           std::clamp(1 - kSlowdownPerMetre * ahead, kMinFactor, kMaxFactor);
      crowd.set_speeds({&id, 1}, {&speed, 1});
    }
  }
}

}  // namespace throng
