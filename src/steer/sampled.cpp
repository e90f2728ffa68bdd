// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/sampled.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "steer/fan.h"

// Steering by trying 24 directions at 4 speeds each; docs/design/008-engine.md. Cost: trials times
// neighbours.
namespace throng::steer {
namespace {

constexpr Turns kTurns = turns();

}  // namespace

Plane ahead_of(Plane preferred) {
  const float desired = size_of(preferred);
  return desired > 1e-6f ? Plane{preferred.x / desired, preferred.z / desired} : Plane{1, 0};
}

Fan fan_around(Plane preferred) {
  const Plane ahead = ahead_of(preferred);
  Fan fan;
  for (size_t k = 0; k < kDirections; ++k) {
    fan[k] = {ahead.x * kTurns.cosine[k] - ahead.z * kTurns.sine[k],
              ahead.x * kTurns.sine[k] + ahead.z * kTurns.cosine[k]};
  }
  return fan;
}

Trials trials_of(const Situation& s) {
  const Fan fan = fan_around(s.preferred);
  const bool has_preferred = size_of(s.preferred) > 1e-6f;
  Trials trials;
  for (size_t k = 0; k < kDirections; ++k) {
    for (size_t i = 0; i < kSpeeds; ++i) {
      const float part = part_of_speed(i);
      const Plane full =
          k == 0 && has_preferred ? s.preferred : Plane{fan[k].x * s.fastest, fan[k].z * s.fastest};
      trials.x[k * kSpeeds + i] = full.x * part;
      trials.z[k * kSpeeds + i] = full.z * part;
    }
  }
  trials.x[kTrials / 2] = trials.z[kTrials / 2] = 0;
  return trials;
}

// |at + velocity t| = radii, solved for 1 / t = (approach + root) / apart. Both terms are divided
// by `apart` first, so the most urgent of many is found without a division for each trial.
float soonness(Plane at, Plane velocity, float apart) {
  const float share = 1 / std::max(apart, kMinApart);
  const float approach = -(at.x * share * velocity.x + at.z * share * velocity.z);
  const float speed = velocity.x * velocity.x + velocity.z * velocity.z;
  const float inside = approach * approach - speed * share;
  return approach > 0 && inside > 0 ? approach + std::sqrt(inside) : 0;
}

float nearness_of_wall(float distance, float speed) {
  return speed > 0 ? speed / (distance + kMinTouchTime * speed) : 0;
}

Plane following(const SampledSettings& settings, const Situation& s) {
  const float desired = size_of(s.preferred);
  if (!(desired > 1e-6f)) return s.preferred;
  const Plane ahead{s.preferred.x / desired, s.preferred.z / desired};
  const float per_metre = 1 / (settings.headway * s.fastest);
  float max_speed = desired;
  for (size_t n = 0; n < s.near.size; ++n) {
    const float x = s.near.x[n], z = s.near.z[n], wx = s.near.wx[n], wz = s.near.wz[n];
    const float along = x * ahead.x + z * ahead.z;
    const float square = x * x + z * z;
    const float radii = std::sqrt(std::max(square - s.near.apart[n], 0.0f));
    const float aside = settings.lane * radii;
    if (!(along > 0 && square - along * along < aside * aside)) continue;
    const float same = wx * ahead.x + wz * ahead.z;
    const float min_square =
        settings.same_direction * settings.same_direction * (wx * wx + wz * wz);
    if (!(same > 0 && same * same > min_square)) continue;
    const float spacing = std::max(std::sqrt(square) - std::min(radii, settings.body), 0.0f);
    const float u = spacing * per_metre;
    const float half = 0.5f * u;
    const float limit = settings.unbound * s.fastest * (1 - 1 / (1 + (u + half * (u + u * u))));
    const float leader = s.near.vx[n] * ahead.x + s.near.vz[n] * ahead.z;
    const float allowed = limit + settings.foresight * std::max(leader - limit, 0.0f);
    max_speed = std::min(max_speed, std::min(allowed, settings.max_flow * std::sqrt(square)));
  }
  return max_speed < desired ? Plane{ahead.x * max_speed, ahead.z * max_speed} : s.preferred;
}

bool preferred_is_open(const SampledSettings& settings, const Situation& s) {
  const float min_soonness = 1 / settings.horizon;
  for (size_t n = 0; n < s.near.size; ++n) {
    const Plane relative{s.near.vx[n] - s.preferred.x, s.near.vz[n] - s.preferred.z};
    if (soonness({s.near.x[n], s.near.z[n]}, relative, s.near.apart[n]) > min_soonness)
      return false;
  }
  return !s.has_walls || nearness_of_wall(s.free_distance[0], size_of(s.preferred)) <=
                             1 / (settings.wall_horizon + kMinTouchTime);
}

Costs costs_of(const SampledSettings& settings, const Situation& s, const Trials& trials) {
  const float desired = size_of(s.preferred);
  const Plane ahead = ahead_of(s.preferred);
  const float min_nearness = 1 / (settings.horizon + kMinTouchTime);
  const float min_of_wall = 1 / (settings.wall_horizon + kMinTouchTime);
  Costs costs;
  for (size_t t = 0; t < kTrials; ++t) {
    const Plane v{trials.x[t], trials.z[t]};
    const float along = v.x * ahead.x + v.z * ahead.z;
    const float left = ahead.z * v.x - ahead.x * v.z;
    float cost =
        (1 - settings.straightness) * size_of(Plane{v.x - s.preferred.x, v.z - s.preferred.z});
    cost = cost + settings.straightness * std::max(desired - along, 0.0f);
    cost = cost + settings.excess * std::max(along - desired, 0.0f);
    cost = cost + settings.keep * size_of(Plane{v.x - s.velocity.x, v.z - s.velocity.z});
    cost = cost + settings.right * std::max(left, 0.0f);
    cost = cost / s.fastest;
    float soonest = 0;
    for (size_t n = 0; n < s.near.size; ++n) {
      const Plane relative{s.near.vx[n] - v.x, s.near.vz[n] - v.z};
      soonest = std::max(soonest, soonness({s.near.x[n], s.near.z[n]}, relative, s.near.apart[n]));
    }
    cost = cost + settings.threat * std::max(nearness(soonest) - min_nearness, 0.0f);
    if (s.has_walls) {
      const float near = nearness_of_wall(s.free_distance[t / kSpeeds], size_of(v));
      cost = cost + settings.wall * std::max(near - min_of_wall, 0.0f);
    }
    costs[t] = cost;
  }
  return costs;
}

Choices best_of(const Costs& costs, const Trials& trials) {
  Costs left = costs;
  Choices choices;
  for (Plane& choice : choices) {
    const auto best =
        static_cast<size_t>(std::min_element(left.begin(), left.end()) - left.begin());
    choice = {trials.x[best], trials.z[best]};
    left[best] = std::numeric_limits<float>::infinity();
  }
  return choices;
}

Choices choose_velocity(const SampledSettings& settings, const Situation& situation) {
  const Trials trials = trials_of(situation);
  return best_of(costs_of(settings, situation, trials), trials);
}

Plane preferred_towards(Plane to_target, float speed, float dt, float detour_angle) {
  const float left = size_of(to_target);
  if (left < 1e-6f) return {};
  const float size = std::min(speed, left / dt) / left;
  return turned_right({to_target.x * size, to_target.z * size}, detour_angle);
}

float next_detour_angle(const DeadlockAvoidance& settings, float detour_angle, float progress,
                        float along, float dt) {
  const float side = settings.side_angle;
  const bool has_progress =
      progress >= settings.min_progress || (detour_angle > side && along >= settings.min_walk);
  if (has_progress) return std::max(0.0f, detour_angle - settings.return_rate * dt);
  if (detour_angle < side) return std::min(side, detour_angle + settings.rate * dt);
  const float next = detour_angle + settings.slow_rate * dt;
  return next < settings.max_angle ? next : 0;
}

Plane turned_right(Plane direction, float detour_angle) {
  const float square = detour_angle * detour_angle, scale = 1 / (1 + square);
  const float cosine = (1 - square) * scale, sine = 2 * detour_angle * scale;
  return {direction.x * cosine - direction.z * sine, direction.x * sine + direction.z * cosine};
}

}  // namespace throng::steer
