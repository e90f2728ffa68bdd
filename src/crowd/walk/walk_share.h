// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "crowd/mode/shared_state.h"
#include "crowd/walk/delay_map.h"
#include "crowd/walk/routes.h"
#include "crowd/walk/step_exchange.h"
#include "steer/sampled.h"

/// Avatars on foot whose crowd is shared by ranks. docs/design/019-ranks.md.
namespace throng::crowd {

/// All that is known of an avatar on foot: another rank goes on with it. Body::slot is its name.
struct MovedWalker {
  Ghost ghost;
  steer::Plane choice;
  Route route;
  PathProgress progress;
};
static_assert(std::is_trivially_copyable_v<MovedWalker>);

/// Of the ranks that share a crowd, each with an engine.
class RankExchange final : public StepExchange {
 public:
  explicit RankExchange(SharedState& shared) : shared_(shared) {}
  /// Before each step of the engine.
  void begin();
  /// Afterwards: the slots of those that it saw are free.
  void end();

  std::span<const Ghost> exchange_bodies(CrowdEngine& engine) override;
  std::span<const GhostMove> exchange_moves(std::span<const GhostMove> shown) override;
  std::span<const uint32_t> exchange_accepted(std::span<const uint32_t> shown) override;

 private:
  template <class T, class Name>
  std::span<const T> send_shown(std::span<const T> all, Name name_of,
                                std::vector<std::vector<T>>& to, std::vector<T>& from);

  SharedState& shared_;
  std::vector<uint32_t> near_;
  std::vector<std::vector<uint32_t>> shown_;  // to each neighbour: names, in order
  std::vector<std::vector<Ghost>> bodies_;    // for each
  std::vector<std::vector<GhostMove>> moves_;
  std::vector<std::vector<uint32_t>> accepted_;
  std::vector<Ghost> ghosts_;
  std::vector<GhostMove> ghost_moves_;
  std::vector<uint32_t> ghosts_accepted_;
  std::vector<uint32_t> slots_;  // of ghosts
};

}  // namespace throng::crowd
