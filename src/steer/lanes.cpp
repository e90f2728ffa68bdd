// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/lanes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace throng::steer {
namespace {

constexpr float kOne = 4096;  // Sums of whole numbers do not depend on their order.

// Cosine of the angle between a direction and a way, 0 if the way leads nowhere.
float cosine(Plane direction, Plane way) {
  const float size = size_of(way);
  return size > 1e-6f ? (way.x * direction.x + way.z * direction.z) / size : 0;
}

}  // namespace

bool comes_towards(Plane at, Plane way, Plane his, float cosine) {
  const float towards = -(his.x * way.x + his.z * way.z);
  if (towards <= 0 || at.x * way.x + at.z * way.z <= 0) return false;
  const float both = (his.x * his.x + his.z * his.z) * (way.x * way.x + way.z * way.z);
  return towards * towards > cosine * cosine * both;
}

bool is_opposed(const LaneSettings& settings, const Situation& s) {
  int32_t opposers = 0;
  for (size_t n = 0; n < s.near.size; ++n) {
    const Plane at{s.near.x[n], s.near.z[n]}, his{s.near.wx[n], s.near.wz[n]};
    opposers += comes_towards(at, s.preferred, his, settings.opposed) ? 1 : 0;
  }
  return opposers >= settings.opposers;
}

Lanes::Lanes(const LaneSettings& settings, Plane preferred)
    : settings_(settings), desired_(size_of(preferred)) {
  ahead_ = {preferred.x / desired_, preferred.z / desired_};
}

void Lanes::add(Plane at, Plane bound) {
  const float along = at.x * ahead_.x + at.z * ahead_.z;
  if (!(along > 0 && along < settings_.far)) return;
  const float aside = ahead_.x * at.z - ahead_.z * at.x;
  const float same = cosine(ahead_, bound);
  const float kind = same < -settings_.opposed ? 1
                     : same > settings_.same   ? -settings_.follows
                                               : settings_.crosses;
  const float weight = kind * (1 - along / settings_.far) * kOne;
  for (int32_t lane = 0; lane < kLanes; ++lane) {
    const float share = 1 - std::abs(aside - off(lane)) / settings_.wide;
    if (share > 0) costs_[static_cast<size_t>(lane)] += static_cast<int32_t>(weight * share);
  }
}

Plane Lanes::preferred() const {
  // One's own first, then the others from there, of equals the first.
  constexpr std::array<int32_t, kLanes> kOrder = {3, 4, 2, 5, 1, 6, 0};
  const auto cost = [&](int32_t lane) {
    const float by_others = static_cast<float>(costs_[static_cast<size_t>(lane)]) / kOne;
    return by_others + settings_.aside * std::abs(off(lane)) - settings_.right * off(lane);
  };
  const int32_t best = *std::min_element(kOrder.begin(), kOrder.end(),
                                         [&](int32_t a, int32_t b) { return cost(a) < cost(b); });
  const float aside = off(best);
  const float scale = desired_ / std::sqrt(settings_.ahead * settings_.ahead + aside * aside);
  return {(ahead_.x * settings_.ahead - ahead_.z * aside) * scale,
          (ahead_.z * settings_.ahead + ahead_.x * aside) * scale};
}

Plane making_room(const RoomSettings& settings, const Situation& s) {
  int64_t sum_x = 0, sum_z = 0;
  for (size_t n = 0; n < s.near.size; ++n) {
    const float x = s.near.x[n], z = s.near.z[n];
    const float square = x * x + z * z;
    const float far = std::sqrt(square);
    const float gap = far - std::sqrt(std::max(square - s.near.apart[n], 0.0f));
    if (gap >= settings.gap || far <= 1e-6f) continue;
    const float push = settings.rate * (settings.gap - gap) / far * kOne;
    sum_x -= std::lrint(push * x);
    sum_z -= std::lrint(push * z);
  }
  return {static_cast<float>(sum_x) / kOne, static_cast<float>(sum_z) / kOne};
}

}  // namespace throng::steer
