// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>

#include "core/parallel.h"
#include "support/counted_allocations.h"

// A program of its own, because it counts every allocation: a loop makes none once its threads
// have started, however much its body captures.
namespace throng {
namespace {

constexpr int kRounds = 20, kLoops = 50;  // loops of each kind in a round
constexpr size_t kCount = 100;            // indices of a loop

// Larger than anything that a std::function keeps without an allocation.
using Large = std::array<uint64_t, 32>;

// One loop of each kind. Returns the sum that they must find.
uint64_t run_loops(int32_t workers, std::atomic<uint64_t>& sum) {
  Large large{};
  for (size_t i = 0; i < large.size(); ++i) large[i] = i;
  const auto at = [&large](size_t i) { return large[i % large.size()]; };
  parallel_ranges(kCount, 1, workers, [large, &sum](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) sum += large[i % large.size()];
  });
  parallel_for(kCount, workers, [large, &sum](size_t i) { sum += large[i % large.size()]; });
  parallel_for_worker(kCount, workers,
                      [large, &sum](size_t i, int32_t) { sum += large[i % large.size()]; });
  uint64_t expected = 0;
  for (size_t i = 0; i < kCount; ++i) expected += 3 * at(i);
  return expected;
}

// The minimum of the rounds' allocations: oneTBB may allocate when it starts a thread, which it
// does when it wants to; what a loop itself allocates, it allocates in each.
uint64_t min_allocations(int32_t workers, bool& is_right) {
  uint64_t allocations = UINT64_MAX;
  for (int round = 0; round < kRounds; ++round) {
    const uint64_t before = g_allocations;
    for (int loop = 0; loop < kLoops; ++loop) {
      std::atomic<uint64_t> sum{0};
      const uint64_t expected = run_loops(workers, sum);
      is_right = is_right && sum == expected;
    }
    allocations = std::min<uint64_t>(allocations, g_allocations - before);
  }
  return allocations;
}

int run() {
  bool is_right = true;
  uint64_t sum = 0;
  for (const int32_t workers : {1, 2, 4}) {
    const uint64_t allocations = min_allocations(workers, is_right);
    std::printf("%d workers: %llu allocations in %d loops\n", workers,
                static_cast<unsigned long long>(allocations), 3 * kLoops);
    sum += allocations;
  }
  return sum > 0 || !is_right ? 1 : 0;
}

}  // namespace
}  // namespace throng

int main() { return throng::run(); }
