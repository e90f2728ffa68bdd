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

/// The crowd without goals: never into a wall and never into each other. A crowd with goals is in
/// throng/crowd.h.
namespace throng {

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
  uint64_t blocked_by_wall = 0;  ///< Straight on was illegal.
  uint64_t blocked_by_avatar = 0;
  uint64_t waited = 0;  ///< Neither straight on nor the turned way was free.
  double seconds_sort = 0;
  double seconds_move = 0;
  double seconds_total = 0;
};

/// Wanderers: straight on; a random left or right when blocked. Source: [ML06] section 4, [TC00] 3.
/// Movable, not copyable; two crowds can live side by side.
class THRONG_API Wanderers {
 public:
  /// Places the avatars where they can stand, clear of each other. Fails with kLimit and how many
  /// fit, kNotFound (class), kBadConfig.
  [[nodiscard]] static Result<Wanderers> create(const World& world, const WanderConfig& config);
  Wanderers(Wanderers&&) noexcept;
  Wanderers& operator=(Wanderers&&) noexcept;
  ~Wanderers();

  /// One step. No allocation after the first. Time: linear in the avatars.
  WanderReport step();
  [[nodiscard]] CrowdCheck check() const;
  /// XXH3 of all avatars in order of id: position, level, heading. Same for any workers.
  [[nodiscard]] uint64_t state_hash() const;
  /// All avatars in order of id, into `out` (resized).
  void read(std::vector<AvatarState>& out) const;
  [[nodiscard]] uint32_t size() const;
  [[nodiscard]] uint64_t bytes() const;  ///< Memory held by the crowd itself.

 private:
  struct State;
  explicit Wanderers(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
