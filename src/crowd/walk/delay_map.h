// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "crowd/share/rank_share.h"
#include "path/edits/ground_delays.h"
#include "world/walk.h"

/// Where avatars on foot get on slowly, and which of them may search for another path.
/// docs/design/017-congestion.md.
namespace throng::crowd {

/// How a body gets on along its path, by samples about a second apart. By slot.
struct PathProgress {
  static constexpr int kWhole = 127;       // of `share`: the desired speed
  static constexpr uint8_t kMinWait = 10;  // [samples]
  static constexpr uint8_t kMaxWait = 20;  // [samples]

  float left = -1;               // of its path at the last sample [m]; below 0: there was none
  int8_t share = kWhole;         // of the desired speed at which the path grew shorter, lately
  uint8_t wait = 0;              // until it may search [samples]
  uint8_t next_wait = kMinWait;  // if that search finds nothing
  uint8_t is_new = 0;            // Its path was not compared with the delays.

  /// It has come so near to its destination by now, at a desired speed, since the last sample.
  /// Returns the share of that speed. [m, m/s, s]
  int add_sample(float left_now, float speed, float seconds);
  [[nodiscard]] bool is_sound() const { return std::isfinite(left) && share >= -kWhole; }
};
static_assert(sizeof(PathProgress) == 8);

/// Samples are summed up as integers, by any worker in any order, and become an exponential average
/// level by level, some levels in each step. So the average is the same for any number of workers.
class DelayMap {
 public:
  /// For levels of a world and steps of a length. [s]
  DelayMap(size_t levels, double dt);

  /// Each body is sampled once in so many steps.
  [[nodiscard]] uint32_t steps_between() const { return steps_; }
  [[nodiscard]] float seconds_between() const { return seconds_; }
  [[nodiscard]] bool is_turn_of(uint32_t name, uint32_t step) const {
    return (step + name) % steps_ == 0;
  }

  /// Takes what was noted on some of the levels into the average. Before a step of `bodies`; step:
  /// its number. Time: linear in these levels, a few bytes for those where no body walks slowly.
  /// Ranks that share a crowd take what all of them noted.
  void begin_step(uint64_t step, size_t bodies, int32_t workers, RankShare* share);
  [[nodiscard]] const path::GroundDelays& delays() const { return delays_; }

  /// On any worker: a body at a point of a level, which heads in a direction, got on at a share of
  /// its desired speed.
  void note(uint32_t level, world::GroundPoint at, int64_t dx, int64_t dz, int share);

  // Searches are few in each second: of all that want one, some are chosen by chance.
  /// On any worker: a body wants to search. True: it may.
  bool ask(uint64_t seed, uint32_t name, uint64_t step);
  /// Did any body want to search in the second before?
  [[nodiscard]] bool is_asked() const { return asked_ > 0; }

  /// Of a level that is not free.
  struct Saved {
    uint32_t level = 0;
    path::GroundDelays::Shares shares{};
    std::array<uint32_t, path::GroundDelays::kBins> sums{};
  };
  struct SavedQuestions {
    uint32_t asked = 0, asking = 0, limit = 0, unused = 0;
  };
  /// Of what all ranks noted that share a crowd; null: none does.
  [[nodiscard]] std::vector<Saved> saved(RankShare* share) const;
  [[nodiscard]] SavedQuestions saved_questions(RankShare* share) const;
  /// Another rank has what was noted since the last average.
  void forget_sums();
  /// False: no map of this world can have saved this.
  bool restore(std::span<const Saved> saved, const SavedQuestions& questions);

  [[nodiscard]] uint64_t bytes() const;

 private:
  void fold(uint32_t level);
  void gather_sums(uint64_t first, uint64_t last, RankShare& share);

  path::GroundDelays delays_;
  uint32_t steps_ = 1;
  float seconds_ = 1;
  // By level: is there a sum, or a share that is not free? By bin: samples in the upper 12 bits,
  // shares in the others.
  std::unique_ptr<std::atomic<uint8_t>[]> is_live_;
  std::unique_ptr<std::atomic<uint32_t>[]> sums_;
  std::atomic<uint32_t> asking_{0};  // since the last second began
  uint32_t asked_ = 0, limit_ = 0;   // in the second before; of this second
};
static_assert(sizeof(DelayMap::Saved) == 4 + 6 * path::GroundDelays::kBins);

}  // namespace throng::crowd
