// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/lanes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

// Lanes: a cost for each of seven parallel lanes, linear in the avatars added.
namespace throng::steer {
namespace {

constexpr float kOne = 4096;  // Unit of integer sums, which do not depend on their order.

// Cosine of the angle between a unit vector and a vector, 0 if the vector is 0.
float cosine(Plane direction, Plane v) {
  const float size = size_of(v);
  return size > 1e-6f ? (v.x * direction.x + v.z * direction.z) / size : 0;
}

}  // namespace

bool is_opposed(const LaneSettings& settings, const Situation& s) {
  int32_t opposers = 0;
  for (size_t n = 0; n < s.near.size; ++n) {
    const Plane at{s.near.x[n], s.near.z[n]}, other{s.near.wx[n], s.near.wz[n]};
    opposers += comes_towards(at, s.preferred, other, settings.opposed) ? 1 : 0;
  }
  return opposers >= settings.opposers;
}

Lanes::Lanes(const LaneSettings& settings, Plane preferred)
    : settings_(settings), desired_(size_of(preferred)) {
  ahead_ = {preferred.x / desired_, preferred.z / desired_};
}

void Lanes::add(Plane at, Plane heading) {
  const float along = at.x * ahead_.x + at.z * ahead_.z;
  if (!(along > 0 && along < settings_.max_ahead)) return;
  const float aside = ahead_.x * at.z - ahead_.z * at.x;
  const float same = cosine(ahead_, heading);
  const float kind = same < -settings_.opposed ? 1
                     : same > settings_.same   ? -settings_.follows
                                               : settings_.crosses;
  const float weight = kind * (1 - along / settings_.max_ahead) * kOne;
  for (int32_t lane = 0; lane < kLanes; ++lane) {
    const float share = 1 - std::abs(aside - off(lane)) / settings_.max_aside;
    if (share > 0) costs_[static_cast<size_t>(lane)] += static_cast<int32_t>(weight * share);
  }
}

Plane Lanes::preferred() const {
  // The avatar's own lane first, then the others from there; of equals the first.
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

Plane keep_spacing(const SpacingSettings& settings, const Situation& s) {
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
