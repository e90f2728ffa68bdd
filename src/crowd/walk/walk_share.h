// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "crowd/mode/shared_state.h"
#include "crowd/walk/delay_map.h"
#include "crowd/walk/ghost_codec.h"
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

/// Rows by name, as WalkMode::save writes them, of avatars that several ranks have.
class SavedWalkers {
 public:
  explicit SavedWalkers(size_t names)
      : routes_(names),
        progress_(names),
        level_speeds_(names),
        queue_(names),
        choices_(names),
        requests_(names) {}
  void add(const MovedWalker& walker);
  void save(bool queues, std::vector<uint8_t>& out) const;

 private:
  std::vector<Route> routes_;
  std::vector<PathProgress> progress_;
  std::vector<float> level_speeds_;
  std::vector<QueueProgress> queue_;
  std::vector<steer::Plane> choices_;
  std::vector<RoomRequest> requests_;
};

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
  /// One on the other side of the border to a neighbour.
  struct Neighbour {
    std::vector<Ghost> shown, seen;  // by name
    GhostCodec of_shown, of_seen;
  };
  std::span<const RankGroup::Bytes> send();

  SharedState& shared_;
  std::vector<Neighbour> neighbours_;
  uint64_t version_ = 0;  // of the columns' owners
  std::vector<uint32_t> near_;
  std::vector<RankGroup::Bytes> outgoing_;  // to each
  std::vector<Ghost> ghosts_;
  std::vector<GhostMove> moves_;
  std::vector<uint32_t> names_;
  std::vector<uint32_t> slots_;  // of ghosts
};

}  // namespace throng::crowd
