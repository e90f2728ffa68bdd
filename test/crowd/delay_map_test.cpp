// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/delay_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

// The average of what bodies note, and which of them may search.
namespace throng::crowd {
namespace {

using path::GroundDelays;

constexpr int kWhole = PathProgress::kWhole;

// A second of steps of 0.1 s.
void pass_second(DelayMap& map, uint64_t& step, size_t bodies = 1) {
  for (int i = 0; i < 10; ++i) map.begin_step(step++, bodies, 1, nullptr);
}

TEST(DelayMap, AveragesExponentiallyAndForgets) {
  DelayMap map(3, 0.1);
  ASSERT_EQ(map.steps_between(), 10u);
  const world::GroundPoint at{20 << world::kUnitBits, 40 << world::kUnitBits};
  const size_t bin = GroundDelays::first_bin(20, 40) + GroundDelays::direction(-5, 1);
  uint64_t step = 1;
  double expected = 1;
  for (int second = 0; second < 30; ++second) {
    map.note(1, at, -5, 1, 0);
    map.note(1, at, -5, 1, kWhole / 2);
    pass_second(map, step);
    expected += (kWhole / 2 / 2.0 / kWhole - expected) / 8;
    EXPECT_NEAR(map.delays().shares(1)[bin] / 65535.0, expected, 2e-3) << second;
  }
  EXPECT_TRUE(map.delays().is_slow(1));
  EXPECT_FALSE(map.delays().is_slow(0));
  EXPECT_EQ(map.saved(nullptr).size(), 1u);
  for (int second = 0; second < 60; ++second) pass_second(map, step);
  EXPECT_FALSE(map.delays().is_slow(1));
  EXPECT_EQ(map.delays().shares(1)[bin], GroundDelays::kFree);
  EXPECT_TRUE(map.saved(nullptr).empty());
}

TEST(DelayMap, BodiesThatGetOnLeaveTheGroundFree) {
  DelayMap map(1, 0.1);
  uint64_t step = 1;
  for (int second = 0; second < 20; ++second) {
    map.note(0, {0, 0}, 1, 0, kWhole);
    pass_second(map, step);
    EXPECT_FALSE(map.delays().is_slow(0));
  }
}

TEST(DelayMap, GivesNoMoreSearchesThanItsLimit) {
  DelayMap map(1, 0.1);
  uint64_t step = 1;
  const auto ask_all = [&] {
    int granted = 0;
    for (uint32_t slot = 0; slot < 10000; ++slot) granted += map.ask(1, slot, step) ? 1 : 0;
    return granted;
  };
  pass_second(map, step, 100000);
  EXPECT_EQ(ask_all(), 0);  // It is not known yet how many ask.
  EXPECT_FALSE(map.is_asked());
  for (int second = 0; second < 20; ++second) {
    pass_second(map, step, 100000);
    EXPECT_TRUE(map.is_asked());
    EXPECT_NEAR(ask_all(), 32 + 50, 40);
  }
  pass_second(map, step, 100);
  EXPECT_FALSE(map.ask(1, 7, step) && map.ask(1, 8, step) && map.ask(1, 9, step));
  pass_second(map, step, 100);
  EXPECT_TRUE(map.ask(1, 7, step));  // Only three asked.
}

TEST(DelayMap, IsRestoredAsItWasSaved) {
  DelayMap map(5, 0.1);
  uint64_t step = 1;
  for (int second = 0; second < 5; ++second) {
    map.note(4, {1000, 1000}, 0, -1, 3);
    map.note(2, {90000, 1000}, 1, 1, 9);
    map.ask(1, 5, step);
    pass_second(map, step);
  }
  map.note(2, {90000, 1000}, 1, 1, 9);
  const std::vector<DelayMap::Saved> saved = map.saved(nullptr);
  ASSERT_EQ(saved.size(), 2u);
  DelayMap restored(5, 0.1);
  ASSERT_TRUE(restored.restore(saved, map.saved_questions(nullptr)));
  EXPECT_EQ(restored.is_asked(), map.is_asked());
  for (int second = 0; second < 3; ++second) {
    uint64_t same = step;
    pass_second(map, step);
    pass_second(restored, same);
    for (uint32_t level = 0; level < 5; ++level) {
      EXPECT_EQ(restored.delays().shares(level), map.delays().shares(level));
      EXPECT_EQ(restored.delays().is_slow(level), map.delays().is_slow(level));
    }
  }
  DelayMap smaller(4, 0.1);
  EXPECT_FALSE(smaller.restore(saved, {}));
  const std::vector<DelayMap::Saved> twice{saved[0], saved[0]};
  EXPECT_FALSE(restored.restore(twice, {}));
}

TEST(PathProgress, IsTheShareOfTheSpeedAtWhichThePathGrewShorter) {
  PathProgress row;
  row.left = 10;
  EXPECT_EQ(row.add_sample(9, 2, 1), std::lrint(0.5 * kWhole));
  EXPECT_EQ(row.add_sample(9, 2, 1), 0);
  EXPECT_EQ(row.add_sample(12, 2, 1), -kWhole);  // away, faster than it may walk
  EXPECT_EQ(row.left, 12);
  for (int i = 0; i < 20; ++i) row.add_sample(12, 2, 1);
  EXPECT_LE(std::abs(row.share), 3);
  EXPECT_TRUE(row.is_sound());
}

}  // namespace
}  // namespace throng::crowd
