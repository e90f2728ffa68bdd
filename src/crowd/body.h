// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <type_traits>

#include "steer/sampled.h"
#include "world/walk.h"

/// An avatar of a crowd with goals, as a step touches it.
namespace throng {

/// Where somebody stands.
struct Stand {
  int32_t x = 0, z = 0;  // [units]
  int32_t y = 0;         // feet [mm]
  uint32_t level = 0;    // of the world
};

/// One cache line: whoever is looked at is looked at whole. What is asked rarely (goals, corridors)
/// lies in tables by slot.
struct Body {
  enum Flag : uint8_t {
    kArrived = 1,   // at its goal, once
    kLast = 2,      // `local_target` is the goal itself
    kExternal = 4,  // from outside: `preferred` is given
    kHasGoal = 8,
    kLost = 16,    // asks for another way
    kFlying = 32,  // Another engine's: to those who walk it stands where it is.
    kKeeps = 64,   // to what it decided: it did that in the last step, and goes on if it can
    kFar = 128,    // from all who look: of the coarse level of detail
  };

  enum State : uint8_t {
    kFree,       // nobody can be touched in this step: it takes what it names
    kShut,       // nobody, but walls are all around: it stays
    kUndecided,  // it stays, unless a round decides
    kDecided,
  };

  int32_t x = 0, z = 0;  // [units]
  int32_t y = 0;         // feet [mm]
  uint32_t level = 0;    // of the world
  steer::Plane velocity, preferred;
  int32_t local_target_x = 0,
          local_target_z = 0;  // where it is bound for in a straight line [units]
  float turn = 0;              // of steer::DeadlockAvoidance
  float speed = 1;             // wished, and the most [m/s]
  int32_t radius = 0;          // [units]
  uint32_t slot = 0;
  uint8_t avatar_class = 0;
  uint8_t flags = 0;
  uint16_t height = 0;  // [mm, at most 65 m]
  uint16_t target = 0;  // TargetId: it is bound for a region
  State state : 3 = kFree;
  bool leaves : 1 = false;     // an obstacle that closes around it, or that came up beside it
  bool follows : 1 = false;    // so closely that it could but crawl, when it last decided
  bool climbs : 1 = false;     // kFlying, too: it goes over nodes, ClimberEngine's
  bool on_right : 1 = false;   // of the opening lies its own place, because of such a stream
  bool near_wall : 1 = false;  // and in need of another way, in the last step
  uint8_t : 0;                 // What follows is another place in memory.
  uint8_t steps : 7 = 1;       // that it takes at once in this step; 0: not its turn
  // A stream that comes towards it, when it last looked: others look at this while they decide,
  // when what shares a byte with it must not change.
  bool in_counterflow : 1 = false;

  [[nodiscard]] GroundPoint point() const { return {x, z}; }
  [[nodiscard]] Stand stand() const { return {x, z, y, level}; }
  [[nodiscard]] bool has(Flag flag) const { return (flags & flag) != 0; }
  /// FlyerEngine's?
  [[nodiscard]] bool flies() const { return has(kFlying) && !climbs; }
  void clear(Flag flag) { flags = static_cast<uint8_t>(flags & ~flag); }
};
static_assert(sizeof(Body) == 64 && std::is_trivially_copyable_v<Body>);

}  // namespace throng
