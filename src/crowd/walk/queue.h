// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "steer/fan.h"
#include "steer/sampled.h"

/// Queues before doors: the order of the bodies that wait, and requests to make room.
/// docs/design/008-engine.md, "Queues".
namespace throng::crowd {

/// The order of bodies that queue: the shorter path that is left, then the smaller slot. It has no
/// cycles, and it confirms itself: a body that moves on comes nearer, one that makes room does not.
struct QueueOrder {
  float left = std::numeric_limits<float>::infinity();  ///< Length of the path that is left. [m]
  uint32_t slot = UINT32_MAX;

  friend bool operator<(const QueueOrder& a, const QueueOrder& b) {
    return a.left < b.left || (a.left == b.left && a.slot < b.slot);
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

/// What an engine knows of a body that may queue or rest, by slot.
struct QueueProgress {
  float stood = 0;   ///< How long it has stood. [s]
  float yields = 0;  ///< For how long it still stands, to let another pass. [s]
  Rest rest = Rest::kNo;
  std::array<uint8_t, 3> unused{};  ///< 0, so that saved rows have no undefined bytes.
};

/// Sources of all numbers: docs/log/015-motion.md.
struct QueueSettings {
  float still_share = 0.2f;    ///< Of its desired speed: slower ones stand.
  float head_stands = 0.3f;    ///< The first of a queue asks after it has stood that long. [s]
  float asks_on = 0.5f;        ///< It asks on while it is slower, by its desired speed.
  float head_range = 0.6f;     ///< None that is ahead in the order lies before it within that. [m]
  float touch_gap = 0.02f;     ///< Bodies this near touch. [m]
  float room_share = 0.3f;     ///< Speed of one that makes room, by its desired speed.
  float creep_share = 0.1f;    ///< The first of a queue creeps if its best velocity is slower, by
                               ///< its preferred one.
  float ahead_margin = 0.07f;  ///< Kept to bodies that are ahead in the order, [m]
  float ahead_range = 0.3f;    ///< and nearer than that. [m]
  float yield_time = 1;        ///< One that made room for an oncoming body stands that long. [s]
  float oncoming = 0.5f;       ///< Cosine of the angle between them that makes it so.
  float detour_stands = 3;     ///< The first of a queue turns aside after that. [s]
};

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
