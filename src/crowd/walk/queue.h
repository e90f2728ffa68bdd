// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "steer/fan.h"
#include "steer/sampled.h"

/// Queues before doors: the order of the bodies that wait, and requests to make room.
/// docs/design/008-engine.md, "Queues".
namespace throng::crowd {

/// The place of a body in a queue. Of two that go the same direction the first is the one for which
/// the sum over both local targets of its distance less the other's is below 0: their goals may
/// differ, and what comes after a door does not matter before it. Of two that come towards each
/// other it is the one with the shorter path that is left. It confirms itself: a body that moves on
/// comes nearer, one that makes room does not. Three and more may form a cycle: see
/// QueueSettings::turn_stands.
struct QueueOrder {
  struct Spot {
    int32_t x = 0, z = 0;  // [units]
  };
  uint32_t name = UINT32_MAX;  ///< Of the body; none: behind all.
  Spot at, target;             ///< The body and its local target.
  steer::Plane beyond;         ///< From the body to its path beyond its local target. [m]
  float left = 0;  ///< Length of the path that is left; less kTurn: before all others. [m]
  static constexpr float kTurn = 1e4f;

  friend bool operator<(const QueueOrder& a, const QueueOrder& b) {
    if (a.name == UINT32_MAX || b.name == UINT32_MAX) return a.name < b.name;
    float more = a.left - b.left;
    if ((a.left < 0) != (b.left < 0)) return a.left < 0;
    if (a.beyond.x * b.beyond.x + a.beyond.z * b.beyond.z > 0) {
      more =
          (far(a.at, a.target) - far(b.at, a.target)) + (far(a.at, b.target) - far(b.at, b.target));
    }
    return more < 0 || (more == 0 && a.name < b.name);
  }
  /// [units]
  static float far(Spot from, Spot to) {
    const auto x = static_cast<float>(int64_t{to.x} - from.x);
    const auto z = static_cast<float>(int64_t{to.z} - from.z);
    return std::sqrt(x * x + z * z);
  }
};

/// A body asks those that touch it in the half plane before it to make room.
struct RoomRequest {
  QueueOrder order;    ///< Of the head of the queue that asked first.
  steer::Plane ahead;  ///< Where the body wants to go: a unit vector.
};

/// What a body does at the end of its path.
enum class Rest : uint8_t {
  kNo,        ///< It heads to its goal.
  kRests,     ///< It stands, at its goal or as near as others permit.
  kMadeRoom,  ///< It was moved from there, and stands for a while before it returns.
};

/// What an engine knows of the path of a body and of its place in a queue, by slot. A body's
/// neighbours seldom need it: what they do is in Body.
struct alignas(32) QueueProgress {
  steer::Plane onward;   ///< From its local target to its path some metres on; 0 at its end. [m]
  float after = 0;       ///< Length of its path after its local target. [m]
  float stood = 0;       ///< How long it has stood. [s]
  float yields = 0;      ///< For how long it still stands, to let another pass. [s]
  float stream = 0;      ///< For how long it is still in a stream that meets another. [s]
  float vain = 0;        ///< For how long, at its decisions, it has come no nearer to its goal. [s]
  uint16_t nearest = 0;  ///< To its goal so far, and 1; 0: not near yet. [cm]
  Rest rest = Rest::kNo;
  uint8_t unused = 0;  ///< So that saved rows have no undefined bytes.

  /// Of a step of `dt` in which it decided, at the beginning `left` before its goal. [m, s]
  void set_rest(Rest next, float left, float dt) {
    constexpr float kNearer = 0.2f;  // [m]
    const float far = std::min(left, 600.0f);
    vain = rest == Rest::kNo ? vain + dt : 0;
    if (nearest == 0 || far < 0.01f * static_cast<float>(nearest - 1) - kNearer) {
      nearest = static_cast<uint16_t>(100 * far + 1.5f);
      vain = 0;
    }
    // If it counted as standing still, it would rest again after a step.
    if (rest == Rest::kMadeRoom && next == Rest::kNo) stood = 0;
    rest = next;
  }
  /// It heads to another goal.
  void wake() {
    rest = Rest::kNo;
    stood = 0;
    nearest = 0;
    vain = 0;
  }
};
static_assert(sizeof(QueueProgress) == 32);

/// Sources of all numbers: docs/log/015-motion.md.
struct QueueSettings {
  float still_share = 0.2f;  ///< Of its desired speed: slower ones stand.
  float head_stands = 0.1f;  ///< The first of a queue asks after it has stood that long. [s]
  float asks_on = 0.5f;      ///< It asks on while it is slower, by its desired speed.
  float head_range = 0.4f;   ///< None that is ahead in the order lies before it within that. [m]
  float held_stands = 1.5f;  ///< After that two at a narrow door hold each other, [s]
  float turn_time = 0.5f;    ///< and are the first in turn for that long. [s]
  float turn_stands = 3;     ///< After that bodies of which none asks become the first in turn. [s]
  float touch_gap = 0.04f;   ///< Bodies this near touch. [m]
  float room_share = 0.2f;   ///< Speed of one that makes room, by its desired speed,
  float back_share = 0.5f;   ///< if the other comes towards it.
  float creep_share = 0.1f;  ///< The first of a queue creeps if its best velocity is slower, by
                             ///< its preferred one,
  float creep_speed = 0.5f;  ///< at most at that, by its desired speed.
  float ahead_margin = 0.04f;  ///< Kept to bodies that are ahead in the order, [m]
  float ahead_range = 0.3f;    ///< and nearer than that. [m]
  float yield_time = 1;        ///< One that made room for an oncoming body stands that long. [s]
  float oncoming = 0.5f;       ///< Cosine of the angle between them that makes it so.
  float alike = 0.5f;          ///< Paths go on alike: cosine of the angle between them.
  int32_t min_oncoming = 2;    ///< So many that come towards a body are a stream. [> 0]
  float held_up = 0.5f;        ///< It looks for one while it is slower, by its desired speed, or
                               ///< another is within `ahead_range`.
  float stream_time = 2;       ///< As long a body counts as in a stream after it saw it. [s]
  float detour_stands = 3;     ///< The first of a queue turns aside after that. [s]
};

/// Steering of bodies that queue: they come to touch, and heed those ahead more than those beside
/// them. Found so that flows and speeds by density are those of experiments.
inline steer::SampledSettings queueing(steer::SampledSettings settings) {
  settings.gap = 0;
  settings.threat = 0.3f;
  settings.lane = 0.72f;
  settings.foresight = 0.7f;
  settings.excess = 1;
  return settings;
}

/// Directions in the order in which a body tries them: along `away`, then to both sides in turn, 15
/// degrees more each time, up to 105 degrees.
inline constexpr size_t kRoomDirections = 15;
inline std::array<steer::Plane, kRoomDirections> room_directions(steer::Plane away) {
  constexpr steer::Turns kTurns = steer::turns();
  std::array<steer::Plane, kRoomDirections> all{away};
  for (size_t n = 1; n < kRoomDirections; ++n) {
    const size_t turn = (n + 1) / 2;
    const float cosine = kTurns.cosine[turn];
    const float sine = n % 2 == 1 ? kTurns.sine[turn] : -kTurns.sine[turn];
    all[n] = {away.x * cosine - away.z * sine, away.z * cosine + away.x * sine};
  }
  return all;
}

}  // namespace throng::crowd
