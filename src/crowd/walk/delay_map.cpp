// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/delay_map.h"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "core/files/var_number.h"
#include "core/parallel.h"
#include "core/random.h"
#include "world/tile_grid.h"

// Averages of shares of speeds by squares and directions. Time of a step: linear in the bodies that
// are sampled, and in the levels that are averaged.
namespace throng::crowd {
namespace {

using path::GroundDelays;

constexpr size_t kBins = GroundDelays::kBins;
constexpr double kPeriod = 1;       // [s] between two samples of a body
constexpr int32_t kMemory = 8;      // samples: what is this old counts 1/e
constexpr uint32_t kCountBit = 20;  // of a sum
constexpr uint32_t kShareMask = (uint32_t{1} << kCountBit) - 1;
constexpr int32_t kNearlyFree = GroundDelays::kFree - 1000;
constexpr size_t kGrain = 1024;  // levels that are worth another thread
constexpr uint32_t kMinSearches = 32, kBodiesPerSearch = 2000;  // in a second
constexpr uint64_t kAsking = 0xde1a5;                           // random stream

}  // namespace

int PathProgress::add_sample(float left_now, float speed, float seconds) {
  constexpr int kShareMemory = 4;  // samples
  const float got = std::clamp((left - left_now) / (speed * seconds), -1.0f, 1.0f);
  const auto now = static_cast<int>(std::lrint(got * kWhole));
  share = static_cast<int8_t>(share + (now - share) / kShareMemory);
  left = left_now;
  return now;
}

DelayMap::DelayMap(size_t levels, double dt)
    : delays_(levels),
      steps_(static_cast<uint32_t>(std::max(1L, std::lround(kPeriod / dt)))),
      seconds_(static_cast<float>(steps_ * dt)),
      is_live_(std::make_unique<std::atomic<uint8_t>[]>(levels)),
      sums_(std::make_unique<std::atomic<uint32_t>[]>(levels * kBins)) {}

void DelayMap::note(uint32_t level, world::GroundPoint at, int64_t dx, int64_t dz, int share) {
  const size_t bin =
      GroundDelays::first_bin(world::in_tile(at.cell_x()), world::in_tile(at.cell_z())) +
      GroundDelays::direction(dx, dz);
  const auto part = static_cast<uint32_t>(std::clamp(share, 0, PathProgress::kWhole));
  sums_[level * kBins + bin].fetch_add((uint32_t{1} << kCountBit) + part,
                                       std::memory_order_relaxed);
  is_live_[level].store(1, std::memory_order_relaxed);
}

// Of each level that has some: its number less the one before, which bins, and the sums of these.
void DelayMap::gather_sums(uint64_t first, uint64_t last, RankShare& share) {
  static_assert(kBins <= 64);
  std::vector<uint8_t> bytes;
  uint64_t before = first;
  for (uint64_t level = first; level < last; ++level) {
    if (is_live_[level].load(std::memory_order_relaxed) == 0) continue;
    uint64_t bins = 0;
    for (size_t bin = 0; bin < kBins; ++bin) {
      const bool is_noted = sums_[level * kBins + bin].load(std::memory_order_relaxed) != 0;
      bins |= uint64_t{is_noted} << bin;
    }
    if (bins == 0) continue;
    put_number(bytes, level - std::exchange(before, level));
    put_number(bytes, bins);
    for (; bins != 0; bins &= bins - 1) {
      const auto bin = static_cast<size_t>(std::countr_zero(bins));
      put_number(bytes, sums_[level * kBins + bin].exchange(0, std::memory_order_relaxed));
    }
  }
  for (const RankGroup::Bytes& came : share.gather_bytes(bytes)) {
    uint64_t level = first;
    for (size_t at = 0; at < came.size();) {
      level += take_number(came, at).value_or(0);
      is_live_[level].store(1, std::memory_order_relaxed);
      for (uint64_t bins = take_number(came, at).value_or(0); bins != 0; bins &= bins - 1) {
        const auto bin = static_cast<size_t>(std::countr_zero(bins));
        sums_[level * kBins + bin].fetch_add(
            static_cast<uint32_t>(take_number(came, at).value_or(0)), std::memory_order_relaxed);
      }
    }
  }
}

void DelayMap::begin_step(uint64_t step, size_t bodies, int32_t workers, RankShare* share) {
  const uint64_t part = step % steps_;
  if (part == 0) {
    asked_ = asking_.exchange(0, std::memory_order_relaxed);
    if (share != nullptr) asked_ = static_cast<uint32_t>(share->sum(asked_));
    limit_ = kMinSearches + static_cast<uint32_t>(bodies / kBodiesPerSearch);
  }
  const uint64_t levels = delays_.levels();
  const uint64_t first = levels * part / steps_, last = levels * (part + 1) / steps_;
  if (share != nullptr) gather_sums(first, last, *share);
  parallel_ranges(last - first, kGrain, workers, [&](size_t begin, size_t end) {
    for (uint64_t level = first + begin; level < first + end; ++level) {
      if (is_live_[level].load(std::memory_order_relaxed) != 0) fold(static_cast<uint32_t>(level));
    }
  });
}

// Where no body was sampled the share returns to the whole speed.
void DelayMap::fold(uint32_t level) {
  GroundDelays::Shares& shares = delays_.shares(level);
  bool is_slow = false;
  for (size_t bin = 0; bin < kBins; ++bin) {
    std::atomic<uint32_t>& sum = sums_[level * kBins + bin];
    const uint32_t noted = sum.load(std::memory_order_relaxed);
    int32_t goal = GroundDelays::kFree;
    if (noted != 0) {
      // (Sums of more bodies than fit into a square would be wrong, but never out of range.)
      const uint32_t count = std::max(noted >> kCountBit, uint32_t{1});
      const uint32_t mean =
          std::min((noted & kShareMask) * (GroundDelays::kFree / PathProgress::kWhole) / count,
                   uint32_t{GroundDelays::kFree});
      goal = static_cast<int32_t>(mean);
      sum.store(0, std::memory_order_relaxed);
    }
    int32_t share = shares[bin];
    share += (goal - share) / kMemory;
    if (share > kNearlyFree && goal > kNearlyFree) share = GroundDelays::kFree;
    shares[bin] = static_cast<uint16_t>(share);
    is_slow = is_slow || share != GroundDelays::kFree;
  }
  delays_.set_slow(level, is_slow ? 1 : 0);
  if (!is_slow) is_live_[level].store(0, std::memory_order_relaxed);
}

// The second before says how many want to search: in its first second none may.
bool DelayMap::ask(uint64_t seed, uint32_t name, uint64_t step) {
  asking_.fetch_add(1, std::memory_order_relaxed);
  return asked_ > 0 &&
         (asked_ <= limit_ || random_u64(seed ^ kAsking, name, step) % asked_ < limit_);
}

std::vector<DelayMap::Saved> DelayMap::saved(RankShare* share) const {
  std::vector<Saved> saved;
  for (uint32_t level = 0; level < delays_.levels(); ++level) {
    if (is_live_[level].load(std::memory_order_relaxed) == 0) continue;
    Saved& one = saved.emplace_back();
    one.level = level;
    one.shares = delays_.shares(level);
    for (size_t bin = 0; bin < kBins; ++bin) {
      one.sums[bin] = sums_[level * kBins + bin].load(std::memory_order_relaxed);
    }
  }
  if (share == nullptr) return saved;
  // All have the same shares.
  std::vector<Saved> all = share->gather(std::span<const Saved>(saved));
  std::stable_sort(all.begin(), all.end(),
                   [](const Saved& a, const Saved& b) { return a.level < b.level; });
  saved.clear();
  for (const Saved& one : all) {
    if (saved.empty() || saved.back().level != one.level) {
      saved.push_back(one);
      continue;
    }
    for (size_t bin = 0; bin < kBins; ++bin) saved.back().sums[bin] += one.sums[bin];
  }
  return saved;
}

DelayMap::SavedQuestions DelayMap::saved_questions(RankShare* share) const {
  const uint32_t mine = asking_.load(std::memory_order_relaxed);
  return {asked_, share != nullptr ? static_cast<uint32_t>(share->sum(mine)) : mine, limit_};
}

void DelayMap::forget_sums() {
  asking_.store(0, std::memory_order_relaxed);
  for (size_t n = 0; n < delays_.levels() * kBins; ++n) {
    sums_[n].store(0, std::memory_order_relaxed);
  }
}

bool DelayMap::restore(std::span<const Saved> saved, const SavedQuestions& questions) {
  for (size_t i = 0; i < saved.size(); ++i) {
    const Saved& one = saved[i];
    if (one.level >= delays_.levels() || (i > 0 && one.level <= saved[i - 1].level)) return false;
    delays_.shares(one.level) = one.shares;
    const bool is_slow = std::any_of(one.shares.begin(), one.shares.end(),
                                     [](uint16_t share) { return share != GroundDelays::kFree; });
    delays_.set_slow(one.level, is_slow ? 1 : 0);
    is_live_[one.level].store(1, std::memory_order_relaxed);
    for (size_t bin = 0; bin < kBins; ++bin) {
      sums_[one.level * kBins + bin].store(one.sums[bin], std::memory_order_relaxed);
    }
  }
  asked_ = questions.asked;
  asking_.store(questions.asking, std::memory_order_relaxed);
  limit_ = questions.limit;
  return true;
}

uint64_t DelayMap::bytes() const {
  return delays_.bytes() + delays_.levels() * (1 + kBins * sizeof(uint32_t));
}

}  // namespace throng::crowd
