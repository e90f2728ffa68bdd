// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/air.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "steer/sampled.h"

// Steering in the air by trying velocities, as steer/sampled.cpp in the plane. Cost: directions
// times speeds times neighbours. Only arithmetic and square roots: the same bytes on every machine.
namespace throng::steer {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
constexpr auto kHalf = static_cast<float>(kDiagonal);

// Cosine and sine of a ring's angle from the preferred velocity: 20, 45, 70, 100, 140 degrees.
constexpr std::array<std::array<float, 2>, 5> kRings = {{{0.93969262f, 0.34202014f},
                                                         {kHalf, kHalf},
                                                         {0.34202014f, 0.93969262f},
                                                         {-0.17364818f, 0.98480775f},
                                                         {-0.76604444f, 0.64278761f}}};
constexpr std::array<float, kAirSpeeds> kSpeedParts = {1, 0.6f, 0.25f};

// Ahead, to the right and, at right angles to both, up. Seen from above with X to the right and Z
// down, the right of X is Z.
struct Frame {
  Space ahead, right, up;
};
Frame frame_of(Space preferred) {
  const float size = size_of(preferred);
  const Space ahead = size > 1e-6f ? (1 / size) * preferred : Space{1, 0, 0};
  const float level = std::sqrt(ahead.x * ahead.x + ahead.z * ahead.z);
  const Space right = level > 1e-3f ? Space{-ahead.z / level, 0, ahead.x / level} : Space{0, 0, 1};
  const Space up = {right.y * ahead.z - right.z * ahead.y, right.z * ahead.x - right.x * ahead.z,
                    right.x * ahead.y - right.y * ahead.x};
  return {ahead, right, up};
}

float soonness_of_wall(float distance, float speed, float horizon) {
  if (!(speed > 0) || distance >= speed * horizon) return 0;
  return distance > 1e-3f ? speed / distance : speed * 1e3f;
}

}  // namespace

float size_of(Space p) { return std::sqrt(dot(p, p)); }

AirFan air_fan(Space preferred) {
  const Frame frame = frame_of(preferred);
  AirFan fan;
  size_t n = 0;
  fan[n++] = frame.ahead;
  for (const auto& [cosine, sine] : kRings) {
    for (const auto& eighth : kEighths) {  // right, over right, up, ...
      const auto right = static_cast<float>(eighth[0]), up = static_cast<float>(eighth[1]);
      fan[n++] = cosine * frame.ahead + sine * (right * frame.right + up * frame.up);
    }
  }
  fan[n] = -1.0f * frame.ahead;
  return fan;
}

// Cylinders touch while both their circles in the plan and their heights overlap: two spans of
// time. Each includes the preferred gap, but no more than the present one.
float soonness(const AirSettings& settings, const AirSituation& situation,
               const AirNeighbour& other, Space velocity) {
  const Space relative = other.velocity - velocity;
  const float square = other.at.x * other.at.x + other.at.z * other.at.z;
  const float radii = other.radii + settings.gap;
  // The circles overlap without the gap: one body is over the other.
  const bool stacked = square < other.radii * other.radii;
  float from = 0, to = kNever;
  const float a = relative.x * relative.x + relative.z * relative.z;
  const float b = other.at.x * relative.x + other.at.z * relative.z;
  if (stacked) {
    const float c = square - other.radii * other.radii;
    if (a > 0) to = (std::sqrt(b * b - a * c) - b) / a;
  } else {
    const float c = std::max(square - radii * radii, kMinApart);
    const float root = b * b - a * c;
    if (b >= 0 || root <= 0) return 0;
    from = c / (std::sqrt(root) - b);
    to = (std::sqrt(root) - b) / a;
  }
  const float y = other.at.y;
  const bool above = y >= situation.height, below = y <= -other.height;
  const float top = above ? std::min(situation.height + settings.gap, y) : situation.height;
  const float bottom = below ? std::max(-other.height - settings.gap, y) : -other.height;
  if (relative.y == 0) {
    if (above || below) return 0;
  } else {
    const float t0 = (top - y) / relative.y, t1 = (bottom - y) / relative.y;
    from = std::max(from, std::min(t0, t1));
    to = std::min(to, std::max(t0, t1));
  }
  if (from >= to || from >= settings.horizon) return 0;
  return from > 1e-3f ? 1 / from : 1e3f;
}

bool preferred_is_open(const AirSettings& settings, const AirSituation& situation) {
  const float speed = size_of(situation.preferred);
  if (situation.has_walls && situation.free_distance[0] < speed * settings.wall_horizon)
    return false;
  for (size_t n = 0; n < situation.size; ++n) {
    if (soonness(settings, situation, situation.near[n], situation.preferred) > 0) return false;
  }
  return true;
}

AirChoices best_of(const AirSettings& settings, const AirSituation& situation) {
  const AirFan fan = air_fan(situation.preferred);
  const Frame frame = frame_of(situation.preferred);
  const float desired = size_of(situation.preferred), fastest = situation.fastest;
  // Bodies too far away to be met within the horizon are left out of all trials.
  std::array<const AirNeighbour*, kMaxNearInAir> met;
  size_t count = 0;
  for (size_t n = 0; n < situation.size; ++n) {
    const AirNeighbour& other = situation.near[n];
    const float level = std::sqrt(other.at.x * other.at.x + other.at.z * other.at.z);
    const float radius = settings.horizon * (fastest + size_of(other.velocity));
    if (level <= other.radii + settings.gap + radius) met[count++] = &other;
  }
  // The best so far, in order. Of equals the first is better, so a trial that costs as much as the
  // last of them without its neighbours cannot be among them.
  struct Choice {
    float cost = kNever;
    Space velocity;
  };
  std::array<Choice, kAirChoices> best;
  for (size_t t = 0; t <= kAirTrials; ++t) {
    const size_t d = t / kAirSpeeds;
    // Along the preferred velocity the trials are parts of it; the last of all hovers.
    const float speed =
        t == kAirTrials ? 0 : (d == 0 ? desired : fastest) * kSpeedParts[t % kAirSpeeds];
    const Space v = t == kAirTrials ? Space{} : speed * fan[d];
    const float progress = dot(v, frame.ahead) / fastest;
    float cost = settings.straightness * (desired / fastest - progress) +
                 (1 - settings.straightness) * size_of(v - situation.preferred) / fastest +
                 settings.keep * size_of(v - situation.velocity) / fastest +
                 settings.right * std::max(0.0f, -dot(v, frame.right)) / fastest;
    if (situation.has_walls && t < kAirTrials) {
      cost += settings.wall *
              nearness(soonness_of_wall(situation.free_distance[d], speed, settings.wall_horizon));
    }
    if (cost >= best.back().cost) continue;
    float soonest = 0;
    for (size_t n = 0; n < count; ++n) {
      soonest = std::max(soonest, soonness(settings, situation, *met[n], v));
    }
    cost += settings.threat * nearness(soonest);
    if (cost >= best.back().cost) continue;
    size_t at = best.size() - 1;
    for (; at > 0 && cost < best[at - 1].cost; --at) best[at] = best[at - 1];
    best[at] = {cost, v};
  }
  AirChoices choices;
  for (size_t n = 0; n < choices.size(); ++n) choices[n] = best[n].velocity;
  return choices;
}

Space preferred_towards(Space to_target, float speed, float dt, float detour_angle, int32_t roll,
                        bool stops) {
  constexpr float kMinApproachSpeed = 0.2f;  // [m/s] So that a stop takes finite time.
  const float left = size_of(to_target);
  if (left <= 1e-6f) return {};
  float limit = std::min(speed, left / dt);
  if (stops) limit = std::min(limit, std::max(left / kAirStop, kMinApproachSpeed));
  const float part = limit / left;
  if (detour_angle == 0) return part * to_target;
  const Frame frame = frame_of(to_target);
  const Space side =
      roll == 0 ? frame.right : kHalf * (frame.right + (roll == 1 ? 1.0f : -1.0f) * frame.up);
  const float square = detour_angle * detour_angle, scale = 1 / (1 + square);
  const float cosine = (1 - square) * scale, sine = 2 * detour_angle * scale;
  return limit * (cosine * frame.ahead + sine * side);
}

}  // namespace throng::steer
