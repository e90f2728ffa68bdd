// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/arrays/strong_parts.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace throng {
namespace {

TEST(StrongParts, AreThoseThatReachEachOther) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    auto any = [&, n = uint64_t{0}](uint64_t below) mutable {
      return static_cast<uint32_t>(random_below(seed, 0, n++, below));
    };
    const uint32_t count = 1 + any(40), arcs = any(3 * count);
    std::vector<std::vector<uint32_t>> targets(count);
    for (uint32_t k = 0; k < arcs; ++k) {
      // Some lead nowhere.
      const uint32_t to = any(count + 1);
      targets[any(count)].push_back(to < count ? to : UINT32_MAX);
    }
    std::vector<std::vector<bool>> reaches(count, std::vector<bool>(count));
    for (uint32_t v = 0; v < count; ++v) {
      std::vector<uint32_t> open{v};
      reaches[v][v] = true;
      while (!open.empty()) {
        const uint32_t at = open.back();
        open.pop_back();
        for (const uint32_t to : targets[at]) {
          if (to == UINT32_MAX || reaches[v][to]) continue;
          reaches[v][to] = true;
          open.push_back(to);
        }
      }
    }
    const StrongParts parts = strong_parts(
        count, [&](uint32_t v) { return static_cast<uint32_t>(targets[v].size()); },
        [&](uint32_t v, uint32_t k) { return targets[v][k]; });
    for (uint32_t a = 0; a < count; ++a) {
      ASSERT_LT(parts.of[a], parts.count);
      for (uint32_t b = 0; b < count; ++b) {
        EXPECT_EQ(parts.of[a] == parts.of[b], reaches[a][b] && reaches[b][a])
            << "seed " << seed << ", " << a << " and " << b;
      }
    }
  }
}

TEST(StrongParts, ALongChainNeedsNoLongStack) {
  constexpr uint32_t kCount = 1 << 20;
  const auto parts = [](bool closed) {
    return strong_parts(
        kCount, [](uint32_t) { return 1u; },
        [&](uint32_t v, uint32_t) {
          if (v + 1 < kCount) return v + 1;
          return closed ? 0u : UINT32_MAX;
        });
  };
  EXPECT_EQ(parts(false).count, kCount);
  EXPECT_EQ(parts(true).count, 1u);
}

}  // namespace
}  // namespace throng
