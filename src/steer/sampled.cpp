// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/sampled.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "throng/base.h"

namespace throng::steer {
namespace {

constexpr int32_t kDirections = 24;
constexpr double kSoonest = 0.1;  // [s] nothing is more urgent than what touches within this

double size_of(Plane p) { return std::sqrt(p.x * p.x + p.z * p.z); }

// The directions around `ahead`, by turning it by 15 degrees again and again.
struct Fan {
  std::array<Plane, kDirections> at;
  explicit Fan(Plane ahead) {
    const double cosine = (std::sqrt(6.0) + std::sqrt(2.0)) / 4;
    const double sine = (std::sqrt(6.0) - std::sqrt(2.0)) / 4;
    for (Plane& direction : at) {
      direction = ahead;
      ahead = {ahead.x * cosine - ahead.z * sine, ahead.x * sine + ahead.z * cosine};
    }
  }
};

}  // namespace

double time_to_touch(Plane at, Plane velocity, double radii) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  // |at + velocity t| = radii, in the form that stays exact where the bodies touch already.
  const double approach = -(at.x * velocity.x + at.z * velocity.z);
  if (!(approach > 0)) return kNever;
  const double apart = std::max(at.x * at.x + at.z * at.z - radii * radii, 0.0);
  const double speed = velocity.x * velocity.x + velocity.z * velocity.z;
  const double inside = approach * approach - speed * apart;
  if (!(inside > 0)) return kNever;
  return apart / (approach + std::sqrt(inside));
}

Choices choose_velocity(const SampledSettings& settings, Plane velocity, Plane wish, double fastest,
                        std::span<const Neighbour> neighbours) {
  THRONG_ASSERT(settings.speeds >= 1);
  const double wished = size_of(wish);
  const Plane ahead = wished > 1e-9 ? Plane{wish.x / wished, wish.z / wished} : Plane{1, 0};
  std::vector<std::pair<double, Plane>> tried{{0, wish}, {0, {0, 0}}};
  const Fan fan(ahead);
  for (int32_t s = 1; s <= settings.speeds; ++s) {
    const double speed = fastest * s / settings.speeds;
    for (const Plane& d : fan.at) tried.push_back({0, {d.x * speed, d.z * speed}});
  }
  const size_t near = std::min(neighbours.size(), static_cast<size_t>(settings.neighbours));
  const double least_urgent = 1 / (settings.horizon + kSoonest);
  for (auto& [cost, v] : tried) {
    const double along = v.x * ahead.x + v.z * ahead.z;
    const double left = ahead.z * v.x - ahead.x * v.z;
    cost = (1 - settings.straightness) * size_of({v.x - wish.x, v.z - wish.z}) +
           settings.straightness * std::max(wished - along, 0.0) +
           settings.keep * size_of({v.x - velocity.x, v.z - velocity.z}) +
           settings.right * std::max(left, 0.0);
    cost /= fastest;
    double urgency = 0, sum = 0;
    for (size_t n = 0; n < near; ++n) {
      // If the other does its share, too, one's own present velocity stands for the rest.
      const double mine = 1 / settings.share, rest = 1 - mine;
      const Neighbour& other = neighbours[n];
      const Plane relative{other.velocity.x - (mine * v.x + rest * velocity.x),
                           other.velocity.z - (mine * v.z + rest * velocity.z)};
      const double time = time_to_touch(other.at, relative, other.radii + settings.gap);
      if (time < settings.horizon) {
        const double urgent = 1 / (time + kSoonest) - least_urgent;
        urgency = std::max(urgency, urgent);
        sum += urgent;
      }
    }
    cost += settings.threat * urgency + settings.threats * sum;
  }
  // The first of equals wins, so the order is that of the trials.
  std::stable_sort(tried.begin(), tried.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Choices choices;
  for (size_t i = 0; i < kChoices; ++i) choices[i] = tried[i].second;
  return choices;
}

double next_turn(const Patience& patience, double turn, double progress, double dt) {
  return progress < patience.content ? std::min(patience.most, turn + patience.rate * dt)
                                     : std::max(0.0, turn - patience.back * dt);
}

Plane turned_right(Plane direction, double turn) {
  const double scale = 1 / (1 + turn * turn);
  const double cosine = (1 - turn * turn) * scale, sine = 2 * turn * scale;
  return {direction.x * cosine - direction.z * sine, direction.x * sine + direction.z * cosine};
}

}  // namespace throng::steer
