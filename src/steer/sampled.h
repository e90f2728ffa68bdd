// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "throng/base.h"

/// Steering by trying velocities: the cheapest of a set of velocities, by their difference from the
/// preferred velocity and by how soon the body would touch another or a wall. Independent of how a
/// crowd stores its avatars. docs/log/008-engine.md states how the settings were found. This is the
/// plain version; steer/sampled_kernel.h gives the same bits, vectorised.
namespace throng::steer {

/// In the plane. [m, m/s]
struct Plane {
  float x = 0, z = 0;
};
inline float size_of(Plane p) { return std::sqrt(p.x * p.x + p.z * p.z); }

/// Sources of all numbers: docs/log/008-engine.md.
struct SampledSettings {
  float horizon = 2;            ///< Later touches do not count. [s, > 0]
  float straightness = 0.8f;    ///< Share of "less progress", beside "another velocity", in a cost.
  float excess = 0;             ///< Cost of more progress than the preferred velocity makes.
  float keep = 0.2f;            ///< Cost of a change of the present velocity.
  float right = 0.1f;           ///< Cost of passing on the left.
  float threat = 0.5f;          ///< Cost of the most urgent touch.
  float gap = 0.02f;            ///< Preferred between two bodies. [m]
  float wall = 0.5f;            ///< Cost of walking up to a wall,
  float wall_horizon = 0.7f;    ///< if it is reached within this. [s, > 0]
  int32_t neighbours = 8;       ///< How many of the nearest count. [1 to kMaxNear]
  float headway = 0.43f;        ///< Time between two that follow each other closely. [s, > 0]
  float body = 0.4f;            ///< Part of their distance that is body, if they are that wide. [m]
  float lane = 0.75f;           ///< A leader is not farther aside than this part of both radii,
  float same_direction = 0.8f;  ///< and prefers the same direction: cosine of the angle.
  float unbound = 1.1f;         ///< Speed at unlimited spacing, by `fastest`.
  float max_flow = 1.2f;        ///< Of a lane, however fast its bodies want to be. [1/s, > 0]
  float foresight = 0.29f;      ///< Share of a leader's excess speed that is added to the limit.
};

inline constexpr size_t kMaxNear = 16;
inline constexpr size_t kDirections = 24;
inline constexpr size_t kSpeeds = 4;
/// Velocities that are tried: a direction's speeds beside each other.
inline constexpr size_t kTrials = kDirections * kSpeeds;
/// [s] Bounds the urgency of a touch: see nearness().
inline constexpr float kMinTouchTime = 0.1f;

struct Neighbour {
  Plane at, velocity;    ///< `at`: offset from the body's centre.
  float radii = 0;       ///< Sum of both.
  Plane preferred = {};  ///< Its heading: only the direction counts.
};

/// The neighbours that count, as arrays.
struct NearSet {
  size_t size = 0;
  alignas(64) std::array<float, kMaxNear> x{}, z{}, vx{}, vz{}, wx{}, wz{};
  alignas(64) std::array<float, kMaxNear> apart{};  ///< Distance^2 - (radii + gap)^2, >= 0.

  void add(const SampledSettings& settings, const Neighbour& other) {
    THRONG_ASSERT(size < kMaxNear);
    const float radii = other.radii + settings.gap;
    x[size] = other.at.x;
    z[size] = other.at.z;
    vx[size] = other.velocity.x;
    vz[size] = other.velocity.z;
    wx[size] = other.preferred.x;
    wz[size] = other.preferred.z;
    apart[size++] =
        std::max(other.at.x * other.at.x + other.at.z * other.at.z - radii * radii, 0.0f);
  }
};

/// The input of steering for one body.
struct Situation {
  Plane velocity;
  Plane preferred;    ///< The velocity without others. [at most `fastest`]
  float fastest = 1;  ///< [m/s, > 0]
  NearSet near;
  /// Distance to a wall in each direction of fan_around(preferred), if `has_walls`. [m]
  alignas(64) std::array<float, kDirections> free_distance{};
  bool has_walls = false;
};

/// The direction of a preferred velocity: a unit vector, X if the velocity is 0.
Plane ahead_of(Plane preferred);

/// Unit vectors, 15 degrees apart, the first along the preferred velocity (X if it is 0).
using Fan = std::array<Plane, kDirections>;
Fan fan_around(Plane preferred);

/// The velocities that are tried, in order: direction d at speed s is number d * kSpeeds + s. Along
/// the preferred velocity they are parts of it; the slowest one straight back is replaced by 0.
struct Trials {
  alignas(64) std::array<float, kTrials> x, z;
};
Trials trials_of(const Situation& situation);

/// How soon two discs of constant velocities touch: 1 / the time until then, 0 if they never do.
/// `at` and `velocity` of the other are relative to the body; `apart` as in NearSet. [1/s]
float soonness(Plane at, Plane velocity, float apart);
/// Urgency of a touch: 1 / (time until then + kMinTouchTime). [1/s]
inline float nearness(float soonness) { return soonness / (1 + kMinTouchTime * soonness); }
/// Discs that touch count as this far apart. [m2]
inline constexpr float kMinApart = 1e-6f;
/// The same for a wall at a distance. [1/s]
float nearness_of_wall(float distance, float speed);

/// The preferred velocity, limited by the spacing to the nearest leaders. With u = spacing /
/// (headway
/// * fastest) the limit is unbound * fastest * (1 - 1 / (1 + u + u^2 / 2 + u^3 / 2)): proportional
/// to a small spacing, and without effect at a large one.
Plane following(const SampledSettings& settings, const Situation& situation);

/// True if the preferred velocity leads to no touch with a body or a wall within their horizons.
bool preferred_is_open(const SampledSettings& settings, const Situation& situation);

/// The cost of each trial, aligned for stores of whole vectors.
struct alignas(64) Costs : std::array<float, kTrials> {};
Costs costs_of(const SampledSettings& settings, const Situation& situation, const Trials& trials);

/// The cheapest trials in order of their cost; of equals the first comes first.
inline constexpr size_t kChoices = 8;
using Choices = std::array<Plane, kChoices>;
Choices best_of(const Costs& costs, const Trials& trials);

/// Trials, costs and choices at once.
Choices choose_velocity(const SampledSettings& settings, const Situation& situation);

/// The preferred velocity of a body with the offset `to_target` to its target: at `speed`, but not
/// past the target within `dt`; turned as by turned_right.
Plane preferred_towards(Plane to_target, float speed, float dt, float detour_angle);

/// The velocity that comes nearest to `wanted` if it may differ from `velocity` by `most`; `known`:
/// as exactly `velocity` is known, because moves are rounded. It is never faster than `speed`,
/// though that may have been more a step ago.
inline Plane within_acceleration(Plane velocity, Plane wanted, float most, float known,
                                 float speed) {
  const Plane change{wanted.x - velocity.x, wanted.z - velocity.z};
  const float size = size_of(change);
  if (size <= most + known) return wanted;
  const float part = most / size;
  const Plane near{velocity.x + change.x * part, velocity.z + change.z * part};
  const float fast = size_of(near);
  return fast > speed ? Plane{near.x * (speed / fast), near.z * (speed / fast)} : near;
}

/// The greatest speed at which a body can walk for `dt` and then stop within `left` in all, if its
/// acceleration is bounded; 0: it is not.
inline float braking_speed(float left, float acceleration, float dt, float speed) {
  if (!(acceleration > 0) || left * acceleration > speed * (dt * acceleration + 0.5f * speed)) {
    return speed;
  }
  return acceleration * (std::sqrt(dt * dt + 2 * left / acceleration) - dt);
}

/// Deadlock avoidance. An avatar without progress turns its preferred velocity to the right, by a
/// detour angle that grows up to `side_angle` and shrinks with progress: so a jam starts to rotate.
/// Without progress at `side_angle` it grows slowly up to `max_angle`: away from the goal, out of a
/// jam of the highest density. If that fails too, as in a corner, the angle starts again at 0. All
/// angles are stored as tan(angle / 2), which needs no sines.
struct DeadlockAvoidance {
  float rate = 0.5f;          ///< Growth up to `side_angle`. [1/s]
  float side_angle = 0.42f;   ///< 46 degrees
  float slow_rate = 0.03f;    ///< Growth beyond `side_angle`. [1/s]
  float max_angle = 1.2f;     ///< 100 degrees
  float return_rate = 0.25f;  ///< Decrease with progress. [1/s]
  float min_progress = 0.3f;  ///< Speed towards the goal that is progress, by the desired one.
  float min_walk = 0.5f;      ///< Speed along the turned velocity that is progress beyond
                              ///< `side_angle`, by the desired one.
  float min_crawl = 0.05f;    ///< As min_progress, for an avatar that follows others too closely
                              ///< to reach it.
};

/// True if the spacing to those ahead allows less than `min_progress`. `followed`: following() of
/// `preferred`.
inline bool can_but_crawl(const DeadlockAvoidance& settings, Plane preferred, Plane followed,
                          float fastest) {
  const float size = size_of(followed);
  return size < settings.min_progress * fastest && size < size_of(preferred);
}
/// Progress as input of next_detour_angle: full for an avatar that can only crawl and does so.
inline float progress_felt(const DeadlockAvoidance& settings, float progress, bool follows) {
  return follows && progress >= settings.min_crawl ? 1 : progress;
}

/// The next detour angle of an avatar. `progress`: its speed towards the goal by the desired one;
/// `along`: the same along its turned preferred velocity.
float next_detour_angle(const DeadlockAvoidance& settings, float detour_angle, float progress,
                        float along, float dt);

/// `direction` turned to the right (seen from above, X to the right, Z down) by 2
/// atan(detour_angle).
Plane turned_right(Plane direction, float detour_angle);

}  // namespace throng::steer
