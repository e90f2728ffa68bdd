// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "core/function_ref.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/stopwatch.h"
#include "crowd/fly/flyer_grid.h"
#include "crowd/ground/body.h"
#include "crowd/walk/crowd_engine.h"
#include "steer/air.h"

/// What the engines of flyers and of climbers have in common: their bodies move after all others,
/// in conflict resolution rounds.
namespace throng::crowd {

/// The nearest few neighbours; of equally near ones, the lowest slots.
class NearestInAir {
 public:
  /// Nothing farther than `far` counts. [m]
  explicit NearestInAir(float far) : max_square_(far * far) {}

  /// `square`: of its distance. [m^2]
  void add(float square, uint32_t slot, uint32_t body) {
    const Seen one{square, slot, body};
    if (square > max_square_ || (seen_ == nearest_.size() && !(one < nearest_.back()))) return;
    size_t at = seen_ < nearest_.size() ? seen_++ : seen_ - 1;
    for (; at > 0 && one < nearest_[at - 1]; --at) nearest_[at] = nearest_[at - 1];
    nearest_[at] = one;
    if (seen_ == nearest_.size()) max_square_ = nearest_.back().square;
  }
  [[nodiscard]] size_t size() const { return seen_; }
  [[nodiscard]] uint32_t body(size_t n) const { return nearest_[n].body; }
  /// Neighbours that are farther no longer count. [m^2]
  [[nodiscard]] float max_square() const { return max_square_; }

  /// Runs query(entry, is_near), which calls add(), for all entries: first those that may be within
  /// `near`, then, unless these are enough, those beyond.
  template <class Query>
  void query_neighbours(const FlyerGrid& grid, const Body& body, float near, float unit,
                        Query query) const {
    grid.for_near(body.x, body.z, body.y,
                  [&](const FlyerGrid::Entry& entry) { query(entry, true); });
    if (seen_ == nearest_.size() && nearest_.back().square <= near * near) return;
    const float per_metre = 1 / (unit * unit) * 1.0001f;
    grid.for_far(
        body.x, body.z, body.y, [&] { return max_square_ * per_metre; },
        [&](const FlyerGrid::Entry& entry) { query(entry, false); });
  }

 private:
  struct Seen {
    float square;
    uint32_t slot, body;
    bool operator<(const Seen& other) const {
      return square != other.square ? square < other.square : slot < other.slot;
    }
  };
  std::array<Seen, steer::kMaxNearInAir> nearest_;
  size_t seen_ = 0;
  float max_square_;
};

/// A body that could touch others in this step. Its candidate moves are the engine's.
struct MoverContest {
  uint32_t mover = 0;            // of MoverRounds::movers
  uint32_t first = 0, last = 0;  // of the worker's `others`: the bodies that it could touch
};

/// Whether a mover's move in this step is decided.
struct MoverState {
  enum State : uint8_t { kUndecided, kDecided, kStays };
  State state = kStays;
  uint8_t round = 0;
  bool arrives = false;
};

/// `Contest`: a MoverContest, `Move`: a MoverState.
template <class Contest, class Move>
class MoverRounds {
 public:
  struct Worker {
    std::vector<uint32_t> others;  // bodies
    std::vector<Contest> contests;
    EngineCounts counts;

    [[nodiscard]] std::span<const uint32_t> others_of(const Contest& contest) const {
      return {others.data() + contest.first, others.data() + contest.last};
    }
  };

  std::vector<uint32_t> movers;    // bodies
  std::vector<uint32_t> mover_of;  // by body, of those that move
  std::vector<Move> moves;         // by mover
  std::vector<Worker> workers;

  /// The parts of a step, each called on any worker. What they refer to must have a name: it is
  /// called until the step is over.
  struct Parts {
    bool (*is_mover)(const Body& body);
    FunctionRef<void(uint32_t mover, int32_t worker)> plan;
    FunctionRef<void(uint32_t mover, Worker& worker)> decide;
    /// Proposes the first candidate that is clear of where all bodies are now.
    FunctionRef<bool(const Contest& contest, const Worker& owner)> propose;
    /// Do the moves that these two propose, of which the second moves too, overlap?
    FunctionRef<bool(const Contest& contest, uint32_t other)> overlaps_with;
    FunctionRef<void(uint32_t mover, EngineCounts& counts)> settle;
  };

  /// One step. `grain`: how many movers are worth another thread; `seed` and `step` make the order
  /// of proposed moves.
  void step(std::span<const Body> bodies, const Parts& parts, FlyerGrid& grid, size_t grain,
            int32_t threads, int32_t rounds, std::pair<uint64_t, uint64_t> seed_and_step,
            EngineCounts& counts, EngineTimes& times);

  [[nodiscard]] uint64_t bytes() const {
    uint64_t bytes =
        (movers.capacity() + mover_of.capacity()) * 4 + moves.capacity() * sizeof(Move);
    for (const Worker& worker : workers) {
      bytes += worker.others.capacity() * 4 + worker.contests.capacity() * sizeof(Contest);
    }
    return bytes;
  }

 private:
  void begin(std::span<const Body> bodies, bool (*is_mover)(const Body&));
  template <class Do>
  void for_contests(int32_t threads, Do act);
  [[nodiscard]] bool is_accepted(std::span<const Body> bodies, const Parts& parts,
                                 const Contest& contest, const Worker& owner,
                                 std::pair<uint64_t, uint64_t> seed_and_step) const;
};

template <class Contest, class Move>
void MoverRounds<Contest, Move>::begin(std::span<const Body> bodies,
                                       bool (*is_mover)(const Body&)) {
  movers.clear();
  mover_of.resize(bodies.size());
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (!is_mover(bodies[i])) continue;
    mover_of[i] = static_cast<uint32_t>(movers.size());
    movers.push_back(static_cast<uint32_t>(i));
  }
  moves.resize(movers.size());
  for (Worker& worker : workers) {
    worker.others.clear();
    worker.contests.clear();
    worker.counts = {};
  }
}

template <class Contest, class Move>
template <class Do>
void MoverRounds<Contest, Move>::for_contests(int32_t threads, Do act) {
  constexpr size_t kPiece = 64;
  for (Worker& owner : workers) {
    parallel_ranges(owner.contests.size(), kPiece, threads, [&](size_t begin, size_t end) {
      for (size_t c = begin; c < end; ++c) act(owner.contests[c], owner);
    });
  }
}

// Is its proposed move clear of those that precede it in the order, of the same round?
template <class Contest, class Move>
bool MoverRounds<Contest, Move>::is_accepted(std::span<const Body> bodies, const Parts& parts,
                                             const Contest& contest, const Worker& owner,
                                             std::pair<uint64_t, uint64_t> seed_and_step) const {
  const auto [seed, step] = seed_and_step;
  const auto order = [seed = seed, step = step](const Body& b) {
    return std::pair(random_u64(seed, b.slot, step), b.slot);
  };
  const auto mine = order(bodies[movers[contest.mover]]);
  const uint8_t round = moves[contest.mover].round;
  const auto others = owner.others_of(contest);
  return std::none_of(others.begin(), others.end(), [&](uint32_t j) {
    return parts.is_mover(bodies[j]) && moves[mover_of[j]].round == round &&
           parts.overlaps_with(contest, j) && order(bodies[j]) > mine;
  });
}

// By induction no body ever touches another: a proposed place is clear of where all are that could
// touch it, and it is accepted only if it is clear of what those before it in the order proposed,
// accepted or not. No other body moves any more.
template <class Contest, class Move>
void MoverRounds<Contest, Move>::step(std::span<const Body> bodies, const Parts& parts,
                                      FlyerGrid& grid, size_t grain, int32_t threads,
                                      int32_t rounds, std::pair<uint64_t, uint64_t> seed_and_step,
                                      EngineCounts& counts, EngineTimes& times) {
  auto start = Clock::now();
  const auto lap = [&](double& seconds) {
    seconds += seconds_since(start);
    start = Clock::now();
  };
  begin(bodies, parts.is_mover);
  const auto for_movers = [&](const auto& act) {
    const size_t pieces = (movers.size() + grain - 1) / grain;
    parallel_for_worker(pieces, threads, [&](size_t piece, int32_t worker) {
      const size_t end = std::min(movers.size(), (piece + 1) * grain);
      for (size_t m = piece * grain; m < end; ++m) act(static_cast<uint32_t>(m), worker);
    });
  };
  for_movers([&](uint32_t m, int32_t worker) { parts.plan(m, worker); });
  lap(times.plan);
  grid.build(bodies, movers, parts.is_mover);
  lap(times.sort);
  for_movers(
      [&](uint32_t m, int32_t worker) { parts.decide(m, workers[static_cast<size_t>(worker)]); });
  lap(times.steer);
  for (int32_t r = 1; r <= rounds; ++r) {
    const auto round = static_cast<uint8_t>(r);
    for_contests(threads, [&](const Contest& contest, const Worker& owner) {
      Move& move = moves[contest.mover];
      if (move.state == Move::kUndecided && parts.propose(contest, owner)) move.round = round;
    });
    for_contests(threads, [&](const Contest& contest, const Worker& owner) {
      Move& move = moves[contest.mover];
      if (move.state == Move::kUndecided && move.round == round &&
          is_accepted(bodies, parts, contest, owner, seed_and_step)) {
        move.state = Move::kDecided;
      }
    });
  }
  lap(times.resolve);
  std::mutex adding;
  parallel_ranges(movers.size(), grain, threads, [&](size_t begin, size_t end) {
    EngineCounts here;
    for (size_t m = begin; m < end; ++m) parts.settle(static_cast<uint32_t>(m), here);
    const std::lock_guard lock(adding);
    counts.add(here);
  });
  for (const Worker& worker : workers) counts.add(worker.counts);
  lap(times.settle);
}

}  // namespace throng::crowd
