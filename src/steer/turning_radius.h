// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "core/math/trig.h"
#include "steer/sampled.h"

/// Bodies on wheels, whose velocity turns by no more than along a circle of their turning radius.
namespace throng::steer {

/// The velocity that such a body takes for a step of `dt` if it moves at `last` and would move at
/// `wanted`. Where the turn is too sharp it goes slower, as far towards `wanted` as the slower
/// speed permits. For a turn that is too sharp by 60 degrees or more it stops, and from a stop it
/// starts in any direction: it turns on the spot. [m/s; s, > 0; m, > 0]
inline Plane within_turning_radius(Plane last, Plane wanted, float dt, float radius) {
  constexpr float kStops = 1.0f / 6, kCircle = 6.2831853f;
  const float now = size_of(last), speed = size_of(wanted);
  if (!(now > 0 && speed > 0)) return wanted;
  const float ahead = last.x * wanted.x + last.z * wanted.z;
  const float aside = last.z * wanted.x - last.x * wanted.z;
  const float turn = turns_of(std::fabs(aside), ahead);  // [turns, 0 to 1/2]
  const float most = speed * dt / (radius * kCircle);
  if (turn <= most) return wanted;
  if (turn - most >= kStops) return {};
  const auto slower = static_cast<float>(double{speed} * cos_turns(double{turn} - double{most}));
  const double angle = double{slower} * double{dt} / (double{radius} * double{kCircle});
  const auto sine = static_cast<float>(sin_turns(aside < 0 ? -angle : angle));
  const auto cosine = static_cast<float>(cos_turns(angle));
  const float part = slower / now;
  return {part * (last.x * cosine + last.z * sine), part * (last.z * cosine - last.x * sine)};
}

}  // namespace throng::steer
