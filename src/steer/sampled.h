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

/// Steering by trying velocities: which of some velocities costs least, by how far it leads from
/// the wish and how soon the body would touch another or a wall. A model of avoidance that knows
/// nothing of how a crowd stores its avatars. docs/log/008-engine.md has how its settings were
/// found. Here as plainly as it can be written; steer/sampled_kernel.h is the same, bit by bit, for
/// machines.
namespace throng::steer {

/// In the plane. [m, m/s]
struct Plane {
  float x = 0, z = 0;
};
inline float size_of(Plane p) { return std::sqrt(p.x * p.x + p.z * p.z); }

/// Sources of all numbers: docs/log/008-engine.md.
struct SampledSettings {
  float horizon = 2;          ///< Touching later than that is of no concern. [s, > 0]
  float straightness = 0.8f;  ///< Share of "less progress", beside "another velocity", in a cost.
  float keep = 0.2f;          ///< Cost of leaving one's present velocity.
  float right = 0.1f;         ///< Cost of passing on the left.
  float threat = 0.5f;        ///< Cost of the most urgent touch.
  float gap = 0.02f;          ///< Wished between two bodies. [m]
  float wall = 0.5f;          ///< Cost of walking up to a wall,
  float wall_horizon = 0.7f;  ///< if it is reached within this. [s, > 0]
  int32_t neighbours = 8;     ///< The nearest so many are looked at. [1 to kMaxNear]
  float headway = 0.43f;      ///< Time between two who walk close behind each other. [s, > 0]
  float body = 0.4f;          ///< Of their distance, what is not room, if they are that wide. [m]
  float lane = 0.75f;         ///< Who is ahead: not further aside than this part of both radii,
  float same_direction = 0.8f;      ///< and wishes to go one's way: cosine of the angle between wishes.
  float unbound = 1.1f;       ///< What room without end allows, by the fastest.
  float foresight = 0.29f;    ///< Share of a leader's being faster that the room does not limit.
};

inline constexpr size_t kMaxNear = 16;
inline constexpr size_t kDirections = 24;
inline constexpr size_t kSpeeds = 4;
/// Velocities that are tried: a direction's speeds beside each other.
inline constexpr size_t kTrials = kDirections * kSpeeds;
inline constexpr float kSoonest = 0.1f;  ///< [s] Nothing is more urgent than a touch within this.

struct Neighbour {
  Plane at, velocity;    ///< `at` from the body's own middle.
  float radii = 0;       ///< Sum of both.
  Plane preferred = {};  ///< Its heading: only the direction counts.
};

/// Those whom a body steers by, as arrays.
struct NearSet {
  size_t size = 0;
  alignas(64) std::array<float, kMaxNear> x{}, z{}, vx{}, vz{}, wx{}, wz{};
  alignas(64) std::array<float, kMaxNear> apart{};  ///< Squares: distance less radii and gap, >= 0.

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

/// What a body steers by.
struct Situation {
  Plane velocity;
  Plane preferred;    ///< The velocity if nobody were there. [at most `fastest`]
  float fastest = 1;  ///< [m/s, > 0]
  NearSet near;
  /// How far it is to a wall in each direction of the fan around the wish, if `has_walls`. [m]
  alignas(64) std::array<float, kDirections> free_distance{};
  bool has_walls = false;
};

/// Which way it is to a wish: a unit vector, along X if there is none.
Plane ahead_of(Plane preferred);

/// Unit vectors, 15 degrees apart, the first along the wish (or X, if there is none).
using Fan = std::array<Plane, kDirections>;
Fan fan_around(Plane preferred);

/// The velocities that are tried, in order: direction d at speed s is number d * kSpeeds + s. Along
/// the wish they are parts of the wish; instead of the slowest way back there is standing.
struct Trials {
  alignas(64) std::array<float, kTrials> x, z;
};
Trials trials_of(const Situation& situation);

/// How soon two discs touch that go on as they do: 1 / the time until then, 0 if they never do.
/// `at` and `velocity`: the other's against one's own. `apart` as in NearSet. [1/s]
float soonness(Plane at, Plane velocity, float apart);
/// How near a touch is: 1 / (time until then + kSoonest). [1/s]
inline float nearness(float soonness) { return soonness / (1 + kSoonest * soonness); }
/// Discs that touch count as this far apart. [m2]
inline constexpr float kTouching = 1e-6f;
/// The same for a wall that is `way` off. [1/s]
float nearness_of_wall(float way, float speed);

/// The wish of one who follows others: no faster than what the nearest ahead leave him room for.
/// With u = room / (headway * fastest) that is unbound * fastest * (1 - 1 / (1 + u + u^2 / 2 + u^3
/// / 2)): in proportion to the room while there is little, and no limit when there is much.
Plane following(const SampledSettings& settings, const Situation& situation);

/// True if whoever does as he wishes touches nobody and no wall within their horizons.
bool preferred_is_open(const SampledSettings& settings, const Situation& situation);

/// What each trial costs. Whole vectors are stored there, so it is aligned as they are.
struct alignas(64) Costs : std::array<float, kTrials> {};
Costs costs_of(const SampledSettings& settings, const Situation& situation, const Trials& trials);

/// Trials in order of their cost, the best first, the first of equals first.
inline constexpr size_t kChoices = 8;
using Choices = std::array<Plane, kChoices>;
Choices best_of(const Costs& costs, const Trials& trials);

/// All of that.
Choices choose_velocity(const SampledSettings& settings, const Situation& situation);

/// The wish of a body that is bound for a place `way` from its own: at `speed`, but not past it
/// within `dt`; turned as by turned_right.
Plane preferred_towards(Plane way, float speed, float dt, float turn);

/// Who is not getting on turns to the right, by and by, up to `most`, and back once he is: what a
/// jam needs to begin to turn as a whole. Who still does not turns on, slowly, up to `farthest`:
/// away from his goal, and so out of a jam that is as dense as bodies can stand; if that led
/// nowhere either, as in a corner, he begins again. All as tan(angle / 2), which needs no sines.
struct Patience {
  float rate = 0.5f;      ///< a second
  float most = 0.42f;     ///< 46 degrees
  float slow = 0.03f;     ///< a second, beyond `most`
  float farthest = 1.2f;  ///< 100 degrees
  float back = 0.25f;     ///< a second
  float content = 0.3f;   ///< Share of the wished speed towards the goal that is getting on.
  float walks = 0.5f;  ///< Share of the wished speed along the turned wish that is, beyond `most`.
  float crawls = 0.05f;  ///< The same as `content`, of who follows others so closely that he could
                         ///< not be content.
};

/// Do those ahead leave less room than contents him? `followed`: what `following` made of
/// `preferred`.
inline bool can_but_crawl(const Patience& patience, Plane preferred, Plane followed,
                          float fastest) {
  const float size = size_of(followed);
  return size < patience.content * fastest && size < size_of(preferred);
}
/// Progress as next_turn takes it: who can but crawl, and does, gets on as well as he can.
inline float progress_felt(const Patience& patience, float progress, bool follows) {
  return follows && progress >= patience.crawls ? 1 : progress;
}

/// The next turn of an avatar. `progress`: its speed towards the goal by the wished one; `along`:
/// the same along its turned wish.
float next_turn(const Patience& patience, float turn, float progress, float along, float dt);

/// `direction` turned to the right (seen from above, X to the right, Z down) by 2 atan(turn).
Plane turned_right(Plane direction, float turn);

}  // namespace throng::steer
