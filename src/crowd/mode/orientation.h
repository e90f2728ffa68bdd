// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/arrays/prefetch.h"
#include "core/math/trig.h"
#include "crowd/ground/body.h"
#include "steer/sampled.h"
#include "throng/base.h"

/// Where avatars face: a state of its own, which follows the direction of the walk at a bounded
/// rate. No step depends on it. docs/design/008-engine.md, "Orientation".
namespace throng::crowd {

/// An angle in plan from +Z towards +X, of a body that leans before it does. The lowest bit is set
/// once there is one.
struct Orientation {
  uint32_t code = 0;  // angle [2^32 a turn]

  [[nodiscard]] bool exists() const { return code != 0; }
  /// 0 along +Z; also if there is none yet. [turns, 0 to 1)
  [[nodiscard]] double turns() const { return (code & ~1u) * 0x1p-32; }
  /// Unit vector; along +Z if there is none yet.
  [[nodiscard]] double x() const { return sin_turns(turns()); }
  [[nodiscard]] double z() const { return cos_turns(turns()); }

  /// Of a vector that is not 0.
  static Orientation along(steer::Plane v) {
    // A float of up to one turn is exact in these units; a whole turn wraps.
    return {static_cast<uint32_t>(static_cast<uint64_t>(turns_of(v.x, v.z) * 0x1p32f)) | 1u};
  }
};

/// The orientation of a body whose axis turns by the least rotation from one to another: it faces
/// the same direction on the body. (Parallel transport.) [unit length]
Orientation transported(Orientation orientation, const Vec3d& from, const Vec3d& to);

/// Turns orientations by slot in a step of `dt`. Without orientations it does nothing.
class Turning {
 public:
  // [FW03] fitted d2a/dt2 = -3.25/s da/dt - 7.5/s2 a to the angle between people that walk and a
  // goal 1.3 m ahead: slow changes are followed with a lag of 3.25 / 7.5 s, and a turn by a right
  // angle has 124 degrees a second in its fastest moment.
  static constexpr float kLag = 0.43f;         // [s]
  static constexpr float kMaxRate = 1.0f / 3;  // [turns/s]
  /// A half turn has twice that by the same equation: from here on the rate rises, until it is so
  /// at the second angle. Else people that start walk backwards for a while. [turns]
  static constexpr float kBack = 0.25f, kFarBack = 1.0f / 3;
  /// At this speed, or half of its desired speed if that is less, a body turns with the whole rate:
  /// slower, it sways or steps aside, and turns less by the square of its speed.
  static constexpr float kFullSpeed = 0.5f;  // [m/s]
  /// Of the rate by its lag, of a body that starts: towards where it wants to walk.
  static constexpr float kStart = 0.5f;

  Turning(std::span<Orientation> by_slot, float dt)
      : by_slot_(by_slot), dt_(dt), share_(share_of(dt / kLag)) {}

  void prefetch(uint32_t slot) const {
    if (!by_slot_.empty()) throng::prefetch(&by_slot_[slot]);
  }

  /// After a body has moved in `dt`. One that stands keeps its orientation.
  void turn(const Body& body, float dt) const {
    if (by_slot_.empty()) return;
    if (dt != dt_) return Turning(by_slot_, dt).turn(body, dt);
    turn(body, body.velocity, body.preferred);
  }
  /// The same with the directions given as the orientation is.
  void turn(const Body& body, steer::Plane velocity, steer::Plane preferred) const {
    if (by_slot_.empty()) return;
    Orientation& now = by_slot_[body.slot];
    if (!now.exists()) {
      begin(now, velocity, preferred);
      return;
    }
    const float square = square_of(velocity);
    if (!(square > 0)) return;
    const float full = std::min(kFullSpeed, 0.5f * body.speed), full_square = full * full;
    float share = share_;
    steer::Plane towards = velocity;
    if (square < full_square) {
      float part = square / full_square;
      if (square_of(preferred) >= full_square) {
        towards = {velocity.x * part + preferred.x * (1 - part),
                   velocity.z * part + preferred.z * (1 - part)};
        part = std::max(part, kStart);
      }
      share = share_of(dt_ / kLag * part);
    }
    if (!(square_of(towards) > 0)) return;
    const auto apart = static_cast<int32_t>(Orientation::along(towards).code - now.code);
    const float wanted = share * static_cast<float>(apart);
    const float most = most_at(std::abs(static_cast<float>(apart)) * 0x1p-32f);
    now.code =
        (now.code + static_cast<uint32_t>(static_cast<int32_t>(std::clamp(wanted, -most, most)))) |
        1u;
  }

 private:
  static float square_of(steer::Plane v) { return v.x * v.x + v.z * v.z; }
  // 1 - exp(-lags) to 8 %, and never above 1.
  static float share_of(float lags) {
    const float sum = lags * (1 + 0.5f * lags);
    return sum / (1 + sum);
  }
  // Below half a turn, so that it fits into 32 bits.
  [[nodiscard]] float most_at(float apart) const {
    const float far = std::clamp((apart - kBack) * (1 / (kFarBack - kBack)), 0.0f, 1.0f);
    return std::min(kMaxRate * dt_ * (1 + far), 0.499f) * 0x1p32f;
  }
  // A new avatar faces where it would walk, or else where it does.
  static void begin(Orientation& now, steer::Plane velocity, steer::Plane preferred) {
    if (square_of(preferred) > 0) {
      now = Orientation::along(preferred);
    } else if (square_of(velocity) > 0) {
      now = Orientation::along(velocity);
    }
  }

  std::span<Orientation> by_slot_;
  float dt_;     // [s]
  float share_;  // of the angle to the direction of the walk
};

}  // namespace throng::crowd
