// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "throng/avatar_state.h"
#include "throng/base.h"
#include "throng/context.h"
#include "throng/result.h"
#include "throng/world.h"

/// A crowd of wanderers: avatars without goals that walk straight on and turn at random when
/// blocked. They never enter a wall and never overlap. For avatars with goals see throng/crowd.h.
namespace throng {

/// Settings for Wanderers::create.
struct WanderConfig {
  uint32_t avatars = 1000;
  int32_t avatar_class = 0;  ///< Class of the avatars, index into the world's classes.
  double dt = 0.1;           ///< Length of a step. [s, 0.001 to 10]
  double speed = 0;          ///< Walking speed, 0 for the class's own. [m/s, >= 0]
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// What one step did.
struct WanderReport {
  uint64_t step = 0;  ///< Number of the step just made, from 1.
  uint64_t moved = 0;
  uint64_t blocked_by_wall = 0;  ///< The straight move was illegal.
  uint64_t blocked_by_avatar = 0;
  uint64_t waited = 0;  ///< Neither the straight nor the turned move was free.
  double seconds_sort = 0;
  double seconds_move = 0;
  double seconds_total = 0;
};

/// Wanderers: straight on; left or right at random when blocked. Source: [ML06] section 4, [TC00]
/// 3. Movable, not copyable; several crowds can exist side by side.
class THRONG_API Wanderers {
 public:
  /// Makes the avatars at places where they can stand without overlap. Fails with kLimit and how
  /// many fit, kNotFound (class), kBadConfig.
  [[nodiscard]] static Result<Wanderers> create(const World& world, const WanderConfig& config);
  Wanderers(Wanderers&&) noexcept;
  Wanderers& operator=(Wanderers&&) noexcept;
  ~Wanderers();

  /// Advances all avatars by `dt`. No allocation after the first step. Time: linear in the avatars.
  WanderReport step();
  [[nodiscard]] CrowdCheck check() const;
  /// XXH3 of all avatars in order of id: position, level, heading. Same for any workers.
  [[nodiscard]] uint64_t state_hash() const;
  /// Reads all avatars in order of id into `out` (resized).
  void read(std::vector<AvatarState>& out) const;
  [[nodiscard]] uint32_t size() const;
  [[nodiscard]] uint64_t bytes() const;  ///< Memory held by the crowd itself.

 private:
  struct State;
  explicit Wanderers(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
