// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <type_traits>

#include "steer/sampled.h"
#include "world/walk.h"

/// An avatar of a crowd with goals, as a step reads and writes it.
namespace throng::crowd {

/// The position of a body on the ground.
struct Stand {
  int32_t x = 0, z = 0;  // [units]
  int32_t y = 0;         // feet [mm]
  uint32_t level = 0;    // of the world
};

/// One cache line: a neighbour is read as a whole. What is seldom read (goals, corridors) lies in
/// tables by slot.
struct Body {
  enum Flag : uint8_t {
    kArrived = 1,   // it is at its goal, or was since it got it
    kLast = 2,      // `local_target` is the goal itself
    kExternal = 4,  // externally controlled: `preferred` is given
    kHasGoal = 8,
    kNeedsPath = 16,       // it requests a path
    kMovedElsewhere = 32,  // another engine moves it: for those that walk it stands where it is
    kContinues = 64,       // with its last decision: it moved so in the last step, and does so
                           // again if it can
    kLowDetail = 128,      // beyond all views
  };

  enum State : uint8_t {
    kFree,       // it can touch no body in this step: it takes its first move
    kEnclosed,   // it can touch no body, but walls are all around: it stays
    kUndecided,  // it stays, unless a conflict resolution round decides
    kDecided,
  };

  int32_t x = 0, z = 0;  // [units]
  int32_t y = 0;         // feet [mm]
  uint32_t level = 0;    // of the world
  steer::Plane velocity, preferred;
  int32_t local_target_x = 0,
          local_target_z = 0;  // where it heads to in a straight line [units]; of an externally
                               // controlled one: CarriedMove::rest
  float detour_angle = 0;      // of steer::DeadlockAvoidance
  float speed = 1;             // desired speed where it is, and the maximum [m/s]
  int32_t radius = 0;          // [units]
  uint32_t slot = 0;
  // These share a byte that does not change while bodies decide.
  uint8_t avatar_class : 4 = 0;  // at most kMaxAvatarClasses
  bool in_stream : 1 = false;    // it meets a stream, or follows one that does
  bool at_rest : 1 = false;      // at the end of its path, see Rest
  bool is_ghost : 1 = false;     // another process moves it
  bool is_shown : 1 = false;     // another process has it as a ghost
  uint8_t flags = 0;
  uint16_t height = 0;  // [mm, at most 65 m]
  uint16_t target = 0;  // TargetId: its goal is a target
  State state : 2 = kFree;
  bool on_link : 1 = false;    // LinkMode moves it along an off-mesh link; with kMovedElsewhere
  bool follows : 1 = false;    // so closely that it could but crawl, when it last decided
  bool climbs : 1 = false;     // ClimberEngine moves it over nodes; with kMovedElsewhere
  bool on_right : 1 = false;   // in counterflow, its lane lies in the right half of the opening
  bool near_wall : 1 = false;  // and in need of another path, in the last step
  bool slowed : 1 = false;     // by the slope: CrowdEngine::level_speed is more than `speed`
  uint8_t : 0;                 // What follows lies in another byte.
  uint8_t steps : 5 = 1;       // that it takes at once in this step; 0: it is skipped
  // Others read the next three while they decide, so what shares their byte must not change then.
  bool asks : 1 = false;    // others to make room, by the request of the last step
  bool leaves : 1 = false;  // an obstacle that closes around it, or that became active beside it
  // A stream came towards it when it last sensed.
  bool in_counterflow : 1 = false;

  [[nodiscard]] world::GroundPoint point() const { return {x, z}; }
  [[nodiscard]] Stand stand() const { return {x, z, y, level}; }
  [[nodiscard]] bool has(Flag flag) const { return (flags & flag) != 0; }
  /// Does FlyerEngine move it?
  [[nodiscard]] bool flies() const { return has(kMovedElsewhere) && !climbs && !on_link; }
  void clear(Flag flag) { flags = static_cast<uint8_t>(flags & ~flag); }
};
static_assert(sizeof(Body) == 64 && std::is_trivially_copyable_v<Body>);

}  // namespace throng::crowd
