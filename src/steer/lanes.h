// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "steer/sampled.h"

/// Lanes of a counter-flow. The nearest neighbours mostly have the avatar's own direction until it
/// is too late to yield to those that come towards it. So an opposed avatar rates the lanes beside
/// it by the directions of avatars farther ahead, and joins the lane in which most have its own
/// direction. docs/log/008-engine.md states how the settings were found.
namespace throng::steer {

struct LaneSettings {
  float max_ahead = 5;     ///< Farther ahead avatars do not count; nearer ones count more. [m]
  float spacing = 0.4f;    ///< From lane to lane. [m]
  float max_aside = 0.5f;  ///< Farther aside of a lane avatars do not count. [m]
  float ahead = 1.5f;      ///< A lane is joined this far ahead. [m]
  float opposed = 0.8f;    ///< Opposed: the cosine of the directions is below minus this.
  float same = 0.5f;       ///< Same direction: the cosine is above this.
  float follows = 0.5f;    ///< Gain for one of the same direction, by the cost of an opposed one.
  float crosses = 0.3f;    ///< Cost of one of neither, by the cost of an opposed one.
  float aside = 0.15f;     ///< Cost of a lane that is a metre aside,
  float right = 0.2f;      ///< less on the right.
  float narrow = 3;        ///< With walls this near on both sides, and one that comes [m]
  float narrow_opposed = 0.9f;  ///< with this cosine, the avatar keeps to the right half,
  float to_right = 2;           ///< turned by so much for each metre to the left of it. [1/m]
  int32_t opposers = 3;         ///< Among the nearest: with fewer no lanes form.
};

/// True if another avatar, ahead at the offset `at`, walks against the avatar. `own`, `other`:
/// their directions; `cosine`: the smallest one of the angle between `own` and the reverse of
/// `other`. No branches: about half of the neighbours meet each condition.
inline bool comes_towards(Plane at, Plane own, Plane other, float cosine) {
  const float towards = -(other.x * own.x + other.z * own.z);
  const float along = at.x * own.x + at.z * own.z;
  const float both = (other.x * other.x + other.z * other.z) * (own.x * own.x + own.z * own.z);
  const int is_near_enough = towards * towards > cosine * cosine * both ? 1 : 0;
  return ((towards > 0 ? 1 : 0) & (along > 0 ? 1 : 0) & is_near_enough) != 0;
}

/// True if enough of the nearest come towards the avatar.
bool is_opposed(const LaneSettings& settings, const Situation& situation);

class Lanes {
 public:
  /// `preferred`: not 0.
  Lanes(const LaneSettings& settings, Plane preferred);

  /// Adds another avatar at the offset `at`; of its `heading` only the direction counts. The order
  /// of adding does not matter.
  void add(Plane at, Plane heading);
  /// The preferred velocity, turned to the best lane.
  [[nodiscard]] Plane preferred() const;

 private:
  static constexpr int32_t kLanes = 7;           // the avatar's own in the middle
  [[nodiscard]] float off(int32_t lane) const {  // [m to the right]
    return settings_.spacing * static_cast<float>(lane - kLanes / 2);
  }

  LaneSettings settings_;
  Plane ahead_;
  float desired_;
  std::array<int32_t, kLanes> costs_{};  // in parts of kOne
};

/// Spacing that an avatar standing between walls keeps: it moves away from all nearer than `gap`.
struct SpacingSettings {
  float gap = 0.06f;  ///< [m]
  float rate = 3;     ///< Speed by the missing distance. [1/s]
};
Plane keep_spacing(const SpacingSettings& settings, const Situation& situation);

}  // namespace throng::steer
