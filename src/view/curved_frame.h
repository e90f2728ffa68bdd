// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "throng/crowd.h"
#include "throng/papers.h"

/// What avatars that [CAACD] steers have beside their places.
namespace throng::view {

/// Of one avatar.
struct CurvedAvatar {
  caacd::State state = caacd::State::kTolerable;  ///< The worst, of now and predicted.
  caacd::Fields fields;                           ///< [m]
  double probe = 0;                               ///< Length of the probe. [m]
  CurvilinearTuning tuning = {};                  ///< Its Mass, MaxSpeed and MaxForce.
};

/// All avatars of a timeline frame, in its order.
struct CurvedFrame {
  std::vector<CurvedAvatar> avatars;
  std::optional<caacd::Counts> counts = {};  ///< Of the experiment of section V.

  /// How many are in each state, by its number.
  [[nodiscard]] std::array<size_t, 4> count_states() const;
};

/// An avatar of a crowd, as curved_frame() needs it.
struct CurvedWalker {
  Vec3d position, velocity;  ///< [m, m/s]
  double radius = 0.25;      ///< [m, > 0]
  double speed = 1;          ///< The fastest that it goes. [m/s, > 0]
  CurvilinearTuning tuning = {};
};

/// The fields and states of a crowd's avatars, as its steering has them: fields as wide as the
/// body's radius says, and times by its speed. Avatars more than 2 m above or below are not sensed.
/// Time: avatars times those within 3 m.
[[nodiscard]] std::shared_ptr<const CurvedFrame> curved_frame(
    std::span<const CurvedWalker> walkers);

}  // namespace throng::view
