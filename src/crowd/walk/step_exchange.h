// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>

#include "crowd/ground/body.h"
#include "crowd/walk/queue.h"

/// What engines that share a crowd give each other in a step. Each moves bodies of its own and
/// knows those near them that others move, its ghosts: docs/design/019-ranks.md.
namespace throng::crowd {

class CrowdEngine;

/// A body that another engine moves, with all that its neighbours read of it. What this engine
/// returns has slots of this engine.
struct Ghost {
  Body body;
  QueueProgress progress;
  RoomRequest request;    ///< Of the step before, valid if it asks.
  float level_speed = 0;  ///< [m/s]
};

/// Where a body would move, or stays, in a round of conflict resolution.
struct GhostMove {
  uint32_t name = 0;
  uint32_t round = 0;
  Stand place;
};
static_assert(std::is_trivially_copyable_v<Ghost> && std::is_trivially_copyable_v<GhostMove>);

/// Called in each step in this order, by the thread that steps. All engines call it as often. Spans
/// that it returns stay until the next call.
class StepExchange {
 public:
  virtual ~StepExchange() = default;

  /// Once all bodies know what they prefer: marks those that others must see
  /// (CrowdEngine::show_to_others), and returns those that this engine must see.
  virtual std::span<const Ghost> exchange_bodies(CrowdEngine& engine) = 0;
  /// What those shown propose: in the first round all that are undecided, then those that propose
  /// another place. And which ghosts do.
  virtual std::span<const GhostMove> exchange_moves(std::span<const GhostMove> shown) = 0;
  /// Names of those whose moves were accepted in a round.
  virtual std::span<const uint32_t> exchange_accepted(std::span<const uint32_t> shown) = 0;
};

}  // namespace throng::crowd
