// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "steer/sampled.h"

/// Lanes of a counter-flow. The nearest few are mostly one's own people until it is too late to
/// make way for those who come towards one; so whoever is opposed counts, farther off, who goes
/// which way on which side of him, and walks where most go his own.
/// docs/log/008-engine.md has how the settings were found.
namespace throng::steer {

struct LaneSettings {
  float far = 5;                ///< Farther ahead nobody counts; nearer the more. [m]
  float apart = 0.4f;           ///< From lane to lane. [m]
  float wide = 0.5f;            ///< Farther aside of a lane nobody counts. [m]
  float ahead = 1.5f;           ///< A lane is joined this far ahead. [m]
  float opposed = 0.8f;         ///< Comes towards one: cosine between the ways, downwards.
  float same = 0.5f;            ///< Goes one's own way: the same, upwards;
  float follows = 0.5f;         ///< so much he is worth, against one who comes.
  float crosses = 0.3f;         ///< What who does neither costs, against one who comes.
  float aside = 0.15f;          ///< Cost of a lane that is a metre off,
  float right = 0.2f;           ///< less on the right.
  float narrow = 3;             ///< With a wall as near on either side, and one who comes, [m]
  float narrow_opposed = 0.9f;  ///< with this cosine, one keeps to the right half,
  float to_right = 2;           ///< turned by so much for each metre that one is left of it. [1/m]
  int32_t opposers = 3;  ///< Among the nearest: with fewer there is nothing to make lanes for.
};

/// Does somebody who is ahead, `at` from one's own middle, come towards one? `way`, `his`: where
/// the two go; `cosine`: of how near that is to straight at each other.
bool comes_towards(Plane at, Plane way, Plane his, float cosine);

/// Do enough of the nearest come towards one?
bool is_opposed(const LaneSettings& settings, const Situation& situation);

class Lanes {
 public:
  /// `wish`: not 0.
  Lanes(const LaneSettings& settings, Plane wish);

  /// `at`: from one's own middle. `bound`: which way the other is bound; only its direction counts.
  /// The order of adding does not matter.
  void add(Plane at, Plane bound);
  /// The wish, turned to the best lane.
  [[nodiscard]] Plane wish() const;

 private:
  static constexpr int32_t kLanes = 7;           // one's own in the middle
  [[nodiscard]] float off(int32_t lane) const {  // [m to the right]
    return settings_.apart * static_cast<float>(lane - kLanes / 2);
  }

  LaneSettings settings_;
  Plane ahead_;
  float wished_;
  std::array<int32_t, kLanes> costs_{};  // in parts of kOne
};

/// Room that who stands between walls makes for others: away from all who are nearer than `gap`.
struct RoomSettings {
  float gap = 0.06f;  ///< [m]
  float rate = 3;     ///< Speed by what is missing. [1/s]
};
Plane making_room(const RoomSettings& settings, const Situation& situation);

}  // namespace throng::steer
