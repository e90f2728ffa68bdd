// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "papers/slices/slice_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/random.h"
#include "naive_columns.h"
#include "naive_slices.h"

namespace throng {
namespace {

using Ints = std::vector<int32_t>;
using Cells = std::vector<std::vector<std::pair<int32_t, int32_t>>>;

SliceSet sweep(const naive::Columns& columns, const papers::SweepConfig& config) {
  Context context;
  auto set = papers::sweep_slices(naive::make_tiles(columns), config, context);
  EXPECT_TRUE(set) << set.error().message;
  return *std::move(set);
}

SliceSet sweep(const Cells& cells, int32_t avatar_height, int32_t resolution) {
  const auto columns = naive::from_lists(static_cast<int32_t>(cells.size()), 1, cells);
  return sweep(columns, naive::sweep_config(columns, avatar_height, resolution));
}

Ints kept_heights(const SliceSet& set) {
  Ints heights;
  for (const Slice& slice : set.kept) heights.push_back(slice.height);
  return heights;
}

// Walls, floors, roofs and stairs with heights on a coarse grid, so that equal values are common.
naive::Columns random_columns(uint64_t seed, int32_t width, int32_t depth) {
  uint64_t counter = 0;
  const auto below = [&](uint64_t n) {
    return static_cast<int32_t>(random_below(seed, 1, counter++, n));
  };
  const int32_t grid = 1 + below(400);
  Cells cells;
  for (int32_t cell = 0; cell < width * depth; ++cell) {
    auto& spans = cells.emplace_back();
    const int32_t count = below(5);
    for (int32_t i = 0; i < count; ++i) {
      const int32_t low = below(static_cast<uint64_t>(9000 / grid + 1)) * grid - 1000;
      const int32_t kind = below(4);  // A sheet, a slab, a wall, or like the cell before.
      if (kind == 3 && cell > 0 && !cells[static_cast<size_t>(cell) - 1].empty()) {
        spans.push_back(cells[static_cast<size_t>(cell) - 1][0]);
      } else {
        const int32_t high = kind == 0 ? low : low + below(kind == 1 ? 300 : 4000);
        spans.emplace_back(low, high);
      }
    }
  }
  return naive::from_lists(width, depth, cells);
}

TEST(SliceSweep, TheSeedsWorkedExampleTakes32AndKeepsTwo) {
  // Figures 4 to 6: a block from just under 6 up to 9, over floors at 1 and 4, beside open floors.
  const SliceSet set = sweep(
      {{{900, 1000}}, {{900, 1000}, {5950, 9000}}, {{900, 4000}, {5950, 9000}}, {{900, 4000}}},
      4500, 100);
  EXPECT_EQ(set.taken, 32);
  EXPECT_EQ(kept_heights(set), (Ints{13600, 5900}));
  EXPECT_EQ(set.kept[0].surface, (Ints{1000, 9000, 9000, 4000}));
  EXPECT_EQ(set.kept[1].surface, (Ints{1000, 1000, 4000, 4000}));
}

TEST(SliceSweep, ThinRoofsSideBySideReplaceEachOther) {
  const SliceSet set =
      sweep({{{0, 0}, {8000, 8000}}, {{0, 0}, {7000, 7000}}, {{0, 0}, {6000, 6000}}}, 4500, 100);
  EXPECT_EQ(set.taken_heights, (Ints{12600, 7900, 6900, 5900}));
  EXPECT_EQ(kept_heights(set), (Ints{12600, 5900}));
}

TEST(SliceSweep, ThinRoofsAboveEachOtherAreDismissedUntilTheFloorIsSeen) {
  const SliceSet set = sweep({{{0, 0}, {6000, 6000}, {7000, 7000}, {8000, 8000}}}, 4500, 100);
  EXPECT_EQ(set.taken_heights, (Ints{12600, 7900, 6900, 5900}));
  EXPECT_EQ(kept_heights(set), (Ints{12600, 5900}));
}

TEST(SliceSweep, AHollowCubeTakes42AndKeepsTwo) {
  Cells cells(25, {{0, 0}, {5800, 5800}});
  for (size_t i = 0; i < 25; ++i) {
    if (i % 5 == 0 || i % 5 == 4 || i / 5 == 0 || i / 5 == 4) cells[i] = {{0, 5800}};
  }
  const auto columns = naive::from_lists(5, 5, cells);
  const SliceSet set = sweep(columns, naive::sweep_config(columns, 1750, 100));
  EXPECT_EQ(set.taken, 42);
  EXPECT_EQ(kept_heights(set), (Ints{7650, 5700}));
}

TEST(SliceSweep, OnOpenStairsTheMiddleSliceIsReplaced) {
  // Figures 7 and 8: treads without risers, 1 apart, from 8 down to 1, over a floor.
  Cells cells;
  for (int32_t tread = 8; tread >= 1; --tread)
    cells.push_back({{0, 0}, {tread * 1000, tread * 1000}});
  const SliceSet set = sweep(cells, 4500, 100);
  EXPECT_EQ(set.taken_heights, (Ints{12600, 7900, 6900, 5900, 4900}));
  EXPECT_EQ(kept_heights(set), (Ints{12600, 4900}));
  EXPECT_EQ(set.kept[1].surface, (Ints{0, 0, 0, 0, 4000, 3000, 2000, 1000}));
}

TEST(SliceSweep, ASliceThatTheNextOneDoesNotRepeatIsKept) {
  // Under the upper roof lies a floor at 4, which no longer has an avatar's height at 5.9.
  const SliceSet set = sweep({{{4000, 4000}, {9000, 9000}}, {{0, 0}, {6000, 6000}}}, 4500, 100);
  EXPECT_EQ(set.taken_heights, (Ints{13600, 8900, 5900}));
  EXPECT_EQ(kept_heights(set), (Ints{13600, 8900, 5900}));
}

TEST(SliceSweep, ACutInsideAWallRecordsItsOwnHeightFromTheWallsFootToItsTop) {
  const auto columns = naive::from_lists(1, 1, {{{0, 0}, {1000, 3000}}});
  const Ints heights = {5000, 3000, 2999, 1000, 999};
  papers::SweepConfig config = naive::sweep_config(columns, 500, 100);
  config.heights = heights;
  const SliceSet set = sweep(columns, config);
  EXPECT_EQ(set.taken, 5);
  EXPECT_EQ(kept_heights(set), (Ints{5000, 999})) << "the inside of a wall is useless";
  for (size_t i = 0; i < heights.size(); ++i) {
    const Ints expected = {std::vector<Ints>{{3000}, {3000}, {2999}, {1000}, {0}}[i]};
    EXPECT_EQ(naive::cut(columns, heights[i], -100).surface, expected);
  }
}

TEST(SliceSweep, AnEmptyCellRecordsTheFarPlane) {
  const SliceSet set = sweep({{}, {{2000, 2000}}, {{0, 0}}}, 1000, 100);
  EXPECT_EQ(set.far_plane, -100);
  EXPECT_EQ(set.kept.back().surface, (Ints{-100, -100, 0}));
}

TEST(SliceSweep, EqualsAlgorithms2And3CutByCutOnRandomWorlds) {
  size_t replaced = 0, dismissed = 0;
  for (uint64_t seed = 0; seed < 600; ++seed) {
    const auto roll = [&](uint64_t i, uint64_t n) {
      return static_cast<int32_t>(random_below(seed, 2, i, n));
    };
    const bool many_tiles = seed % 50 == 0;
    const auto columns =
        random_columns(seed, many_tiles ? 130 : 1 + roll(0, 12), many_tiles ? 70 : 1 + roll(1, 12));
    papers::SweepConfig config =
        naive::sweep_config(columns, 300 + roll(2, 4000), many_tiles ? 300 : 20 + roll(3, 500));
    const auto expected = naive::slice(columns, config);
    const SliceSet set = sweep(columns, config);
    ASSERT_EQ(static_cast<size_t>(set.taken), expected.taken.size()) << "seed " << seed;
    for (size_t i = 0; i < expected.taken.size(); ++i) {
      ASSERT_EQ(set.taken_heights[i], expected.taken[i].height) << "seed " << seed;
    }
    ASSERT_EQ(set.kept.size(), expected.kept.size()) << "seed " << seed;
    for (size_t i = 0; i < expected.kept.size(); ++i) {
      ASSERT_EQ(set.kept[i].height, expected.kept[i].height) << "seed " << seed;
      ASSERT_EQ(set.kept[i].surface, expected.kept[i].surface) << "seed " << seed;
    }
    config.rule = papers::SliceRule::kDismissOnly;
    const size_t undismissed = sweep(columns, config).kept.size();
    replaced += undismissed - set.kept.size();
    dismissed += expected.taken.size() - undismissed;
  }
  EXPECT_GT(replaced, 100u) << "the worlds must exercise both answers of algorithm 2";
  EXPECT_GT(dismissed, 100u);
}

TEST(SliceSweep, SameSlicesForAnyNumberOfWorkers) {
  const auto columns = random_columns(7, 200, 150);
  papers::SweepConfig config = naive::sweep_config(columns, 1200, 100);
  config.workers = 1;
  const SliceSet one = sweep(columns, config);
  ASSERT_GT(one.kept.size(), 1u);
  for (const int32_t workers : {2, 3, 8, 0}) {
    config.workers = workers;
    const SliceSet many = sweep(columns, config);
    EXPECT_EQ(many.taken_heights, one.taken_heights);
    ASSERT_EQ(many.kept.size(), one.kept.size());
    for (size_t i = 0; i < one.kept.size(); ++i) {
      EXPECT_EQ(many.kept[i].surface, one.kept[i].surface);
    }
  }
}

TEST(SliceSweep, StopsWhenCancelled) {
  const auto columns = naive::from_lists(1, 1, {{{0, 90000}}});
  Context context;
  int calls = 0;
  context.on_progress = [&](const Progress& progress) {
    EXPECT_LE(progress.done, progress.total);
    if (++calls == 3) context.cancel = true;
  };
  const auto set = papers::sweep_slices(naive::make_tiles(columns),
                                        naive::sweep_config(columns, 1750, 100), context);
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code, Errc::kCancelled);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace throng
