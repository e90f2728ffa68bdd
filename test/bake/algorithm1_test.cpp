// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/random.h"
#include "naive_columns.h"
#include "naive_slices.h"
#include "papers/slices/slice_move.h"
#include "papers/slices/slice_sweep.h"

namespace throng {
namespace {

using Ints = std::vector<int32_t>;
using Cells = std::vector<std::vector<std::pair<int32_t, int32_t>>>;

// Algorithm 1 as printed, but for the direction of its search, which never ends as printed: the
// raised head is compared in cell A only.
bool can_move_as_printed(const SliceSet& slices, size_t i, size_t a, size_t b,
                         const papers::SliceBody& body) {
  const int32_t head_a = slices.kept[i].surface[a] + body.height;
  const int32_t head_b = slices.kept[i].surface[b] + body.height;
  if (std::abs(head_a - head_b) >= body.step) return false;
  if (head_b <= slices.kept[i].height) return true;
  size_t j = i;
  while (head_b > slices.kept[j].height) --j;
  return slices.kept[i].surface[a] == slices.kept[j].surface[a];
}

SliceSet sweep(const naive::Columns& columns, const papers::SweepConfig& config) {
  Context context;
  return *papers::sweep_slices(naive::make_tiles(columns), config, context);
}

SliceSet sweep(const Cells& cells, int32_t avatar_height, papers::SliceRule rule) {
  const auto columns = naive::from_lists(static_cast<int32_t>(cells.size()), 1, cells);
  papers::SweepConfig config = naive::sweep_config(columns, avatar_height, 100);
  config.rule = rule;
  return sweep(columns, config);
}

// The lowest solid above `feet`, by the columns themselves.
int32_t ceiling(const naive::Columns& columns, size_t cell, int32_t feet) {
  const auto highs = columns.highs(cell);
  const auto lows = columns.lows(cell);
  for (size_t i = 0; i < highs.size(); ++i) {
    if (highs[i] > feet) return lows[i];
  }
  return INT32_MAX;
}

// Rolling ground, some of it under roofs, with a few walls: many moves are legal, many nearly so.
naive::Columns rolling_world(uint64_t seed, int32_t width, int32_t depth) {
  Cells cells;
  for (int32_t cell = 0; cell < width * depth; ++cell) {
    const auto below = [&](uint64_t i, uint64_t n) {
      return static_cast<int32_t>(random_below(seed, static_cast<uint64_t>(cell), i, n));
    };
    auto& spans = cells.emplace_back();
    const int32_t ground = below(0, 12) * 70;
    spans.emplace_back(ground - 200, ground);
    // Roofs at a height that varies slowly over the world, so that neighbours differ in detail
    // only.
    const int32_t storey = 2000 + 900 * ((cell % width) / 16) + below(1, 5) * 60;
    if (below(2, 3) != 0) spans.emplace_back(storey, storey + below(3, 2) * 150);
    if (below(4, 4) == 0) spans.emplace_back(storey + 2100, storey + 2100);
    if (below(5, 40) == 0) spans.emplace_back(0, 3000 + below(6, 3000));
  }
  return naive::from_lists(width, depth, cells);
}

// Where a body with its feet at `feet` in `from` gets to in `to`, or nothing.
std::optional<int32_t> answer(const SliceSet& slices, size_t from, int32_t feet, size_t to,
                              const papers::SliceBody& body) {
  const size_t slice = papers::find_slice(slices, feet + body.height);
  if (slices.kept[slice].surface[from] != feet) return {};
  if (!papers::can_move(slices, slice, from, to, body)) return {};
  return slices.kept[slice].surface[to];
}

// Calls visit(cell, feet, neighbour) for every floor of every cell and its four neighbours.
template <class Visit>
void for_each_move(const naive::Columns& columns, Visit visit) {
  for (int32_t z = 0; z < columns.depth; ++z) {
    for (int32_t x = 0; x < columns.width; ++x) {
      const auto cell = static_cast<size_t>(z * columns.width + x);
      for (const int32_t feet : columns.highs(cell)) {
        if (x > 0) visit(cell, feet, cell - 1);
        if (x + 1 < columns.width) visit(cell, feet, cell + 1);
        if (z > 0) visit(cell, feet, cell - static_cast<size_t>(columns.width));
        if (z + 1 < columns.depth) visit(cell, feet, cell + static_cast<size_t>(columns.width));
      }
    }
  }
}

// The cells of tile (tx, tz) as a grid of their own.
naive::Columns crop(const naive::Columns& columns, int32_t tx, int32_t tz) {
  const int32_t x0 = tx * kTileCells, z0 = tz * kTileCells;
  Cells cells;
  for (int32_t z = z0; z < z0 + kTileCells; ++z) {
    for (int32_t x = x0; x < x0 + kTileCells; ++x) {
      auto& spans = cells.emplace_back();
      if (x >= columns.width || z >= columns.depth) continue;
      const auto cell = static_cast<size_t>(z * columns.width + x);
      for (size_t i = 0; i < columns.lows(cell).size(); ++i) {
        spans.emplace_back(columns.lows(cell)[i], columns.highs(cell)[i]);
      }
    }
  }
  return naive::from_lists(kTileCells, kTileCells, cells);
}

// Compares the moves inside each tile, by the whole world's slices and by the tile's own.
template <class Compare>
void for_each_tile_move(const naive::Columns& columns, const SliceSet& global,
                        const papers::SweepConfig& tile_config, const papers::SliceBody& body,
                        Compare compare) {
  for (const papers::SliceTile& tile : naive::make_tiles(columns)) {
    const auto own = crop(columns, tile.tile_x, tile.tile_z);
    papers::SweepConfig config = tile_config;
    if (config.heights.empty()) {
      const papers::SweepConfig bounds =
          naive::sweep_config(own, config.avatar_height, config.resolution);
      config.min_y = bounds.min_y;
      config.max_y = bounds.max_y;
    }
    const SliceSet local = papers::slice_tile(tile, config);
    const auto to_global = [&](size_t cell) {
      const int32_t x = tile.tile_x * kTileCells + static_cast<int32_t>(cell) % kTileCells;
      const int32_t z = tile.tile_z * kTileCells + static_cast<int32_t>(cell) / kTileCells;
      return static_cast<size_t>(z * columns.width + x);
    };
    for_each_move(own, [&](size_t from, int32_t feet, size_t to) {
      if (own.lows(to).empty()) return;
      const auto by_world = answer(global, to_global(from), feet, to_global(to), body);
      compare(own, from, feet, to, by_world, answer(local, from, feet, to, body));
    });
  }
}

Ints heights_of(const std::vector<Slice>& slices) {
  Ints heights;
  for (const Slice& slice : slices) heights.push_back(slice.height);
  return heights;
}

TEST(Algorithm1, ThePrintedRuleAdmitsAHeadIntoACeilingAndOursRefuses) {
  // A: open floor. B: a step up under a roof at 5.7. C: makes the slice at 5.6 worth keeping.
  const SliceSet slices =
      sweep({{{1000, 1000}}, {{1300, 1300}, {5700, 5700}}, {{1000, 1000}, {5700, 5700}}}, 4500,
            papers::SliceRule::kDismissAndReplace);
  ASSERT_EQ(heights_of(slices.kept), (Ints{10300, 5600}));
  const papers::SliceBody body{.height = 4500, .step = 500};
  const size_t slice = papers::find_slice(slices, 1000 + body.height);
  ASSERT_EQ(slice, 1u);
  ASSERT_GT(1300 + body.height, 5700) << "the head would be in the roof";
  EXPECT_TRUE(can_move_as_printed(slices, slice, 0, 1, body));
  EXPECT_FALSE(papers::can_move(slices, slice, 0, 1, body));
  EXPECT_TRUE(papers::can_move(slices, slice, 0, 2, body)) << "C is level with A, and free";
}

TEST(Algorithm1, AStepUpPastTheSliceIsLegalWhereBothColumnsAreFree) {
  const SliceSet slices = sweep({{{1000, 1000}}, {{1300, 1300}}, {{1000, 1000}, {5700, 5700}}},
                                4500, papers::SliceRule::kDismissAndReplace);
  const papers::SliceBody body{.height = 4500, .step = 500};
  EXPECT_EQ(papers::find_slice(slices, 5500), 1u);
  EXPECT_TRUE(papers::can_move(slices, 1, 0, 1, body));
  EXPECT_FALSE(papers::can_move(slices, 1, 2, 1, body))
      << "the roof over C is at 5.7, the head at 5.8";
}

TEST(Algorithm1, StepsMustBeLowerThanTheBodysStepUpAndDown) {
  const SliceSet slices =
      sweep({{{0, 0}}, {{399, 399}}, {{400, 400}}}, 1750, papers::SliceRule::kDismissAndReplace);
  const papers::SliceBody body{.height = 1750, .step = 400};
  EXPECT_TRUE(papers::can_move(slices, 0, 0, 1, body));
  EXPECT_TRUE(papers::can_move(slices, 0, 1, 0, body));
  EXPECT_FALSE(papers::can_move(slices, 0, 0, 2, body));
  EXPECT_FALSE(papers::can_move(slices, 0, 2, 0, body));
}

TEST(Algorithm1, NoBodyStandsOnTheFarPlaneOrWhereTheSliceIsTooLow) {
  const SliceSet slices =
      sweep({{{0, 0}}, {}, {{0, 0}, {2000, 2000}}}, 1750, papers::SliceRule::kDismissAndReplace);
  ASSERT_EQ(slices.far_plane, -100);
  const papers::SliceBody body{.height = 1750, .step = 400};
  EXPECT_FALSE(papers::can_move(slices, 0, 0, 1, body));
  EXPECT_FALSE(papers::can_move(slices, 0, 1, 0, body));
  ASSERT_EQ(slices.kept[1].height, 1900);
  EXPECT_TRUE(papers::can_move(slices, 1, 0, 2, body));
  EXPECT_FALSE(papers::can_move(slices, 1, 0, 2, {.height = 1901, .step = 400}));
}

TEST(Algorithm1, WhereItSaysYesBothColumnsAreFreeFromTheHigherFloorToTheHead) {
  size_t legal = 0, printed_wrong = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const auto columns = rolling_world(seed, 40, 20);
    const papers::SliceBody body{.height = 1750, .step = 300};
    const SliceSet slices = sweep(columns, naive::sweep_config(columns, body.height, 100));
    for_each_move(columns, [&](size_t from, int32_t feet, size_t to) {
      const size_t slice = papers::find_slice(slices, feet + body.height);
      if (slices.kept[slice].surface[from] != feet) return;
      const int32_t feet_to = slices.kept[slice].surface[to];
      const int32_t free = std::min(ceiling(columns, from, feet), ceiling(columns, to, feet_to));
      const bool fits = int64_t{free} - std::max(feet, feet_to) >= body.height;
      if (papers::can_move(slices, slice, from, to, body)) {
        ++legal;
        EXPECT_TRUE(fits) << "seed " << seed << " cell " << from << " to " << to;
      }
      printed_wrong += !fits && can_move_as_printed(slices, slice, from, to, body);
    });
  }
  EXPECT_GT(legal, 10000u);
  EXPECT_GT(printed_wrong, 100u) << "the printed rule is not conservative";
}

TEST(Algorithm1, ReplacingASliceNeverLosesAPlaceToStandForTheSmallestClass) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const auto columns = rolling_world(seed, 40, 20);
    const papers::SweepConfig config = naive::sweep_config(columns, 1750, 100);
    const SliceSet kept = sweep(columns, config);
    for (const Slice& taken : naive::slice(columns, config).taken) {
      for (size_t cell = 0; cell < taken.surface.size(); ++cell) {
        const int32_t feet = taken.surface[cell];
        if (taken.height - feet < config.avatar_height) continue;
        EXPECT_EQ(kept.kept[papers::find_slice(kept, feet + config.avatar_height)].surface[cell],
                  feet);
      }
    }
  }
}

TEST(Algorithm1, ReplacingASliceCanLoseAStepFromUnderTheSkyToUnderARoof) {
  // A: open, floor at 2.5. B: floor at 1 under a roof at 8. C, anywhere: floor at 1, roof at 6.
  // A body of 4.5 at A has its head at 7, below B's roof. The slice at 7.9 shows this. The one at
  // 5.9, which replaces it for C's sake, does not: at A the head is above it.
  const Cells cells = {{{2500, 2500}}, {{1000, 1000}, {8000, 8000}}, {{1000, 1000}, {6000, 6000}}};
  const papers::SliceBody body{.height = 4500, .step = 2000};
  const SliceSet printed = sweep(cells, body.height, papers::SliceRule::kDismissAndReplace);
  ASSERT_EQ(heights_of(printed.kept), (Ints{12600, 5900}));
  EXPECT_FALSE(answer(printed, 0, 2500, 1, body));
  const SliceSet dismissed = sweep(cells, body.height, papers::SliceRule::kDismissOnly);
  ASSERT_EQ(heights_of(dismissed.kept), (Ints{12600, 7900, 5900}));
  EXPECT_EQ(answer(dismissed, 0, 2500, 1, body), 1000);
}

TEST(Algorithm1, DismissingSlicesLosesNoMove) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const auto columns = rolling_world(seed, 40, 20);
    const papers::SliceBody body{.height = 1750, .step = 300};
    papers::SweepConfig config = naive::sweep_config(columns, body.height, 100);
    SliceSet all;
    all.far_plane = config.far_plane;
    all.kept = naive::slice(columns, config).taken;
    config.rule = papers::SliceRule::kDismissOnly;
    const SliceSet dismissed = sweep(columns, config);
    ASSERT_LT(dismissed.kept.size(), all.kept.size());
    for_each_move(columns, [&](size_t from, int32_t feet, size_t to) {
      EXPECT_EQ(answer(dismissed, from, feet, to, body), answer(all, from, feet, to, body));
    });
  }
}

TEST(TileLocalSlices, AtTheGlobalHeightsAnswerEveryMoveOfTheSmallestClassAlike) {
  size_t legal = 0, local_slices = 0, tiles = 0;
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const auto columns = rolling_world(seed, 190, 70);
    const papers::SliceBody body{.height = 1750, .step = 300};
    papers::SweepConfig config = naive::sweep_config(columns, body.height, 100);
    // Whatever the world keeps, by either rule, a tile may dismiss what says nothing new *there*.
    for (const papers::SliceRule rule :
         {papers::SliceRule::kDismissAndReplace, papers::SliceRule::kDismissOnly}) {
      config.rule = rule;
      config.heights = {};
      const SliceSet global = sweep(columns, config);
      const Ints heights =
          rule == papers::SliceRule::kDismissOnly ? global.taken_heights : heights_of(global.kept);
      config.heights = heights;
      config.rule = papers::SliceRule::kDismissOnly;
      for_each_tile_move(
          columns, global, config, body,
          [&](const naive::Columns&, size_t, int32_t, size_t, auto world, auto tile) {
            EXPECT_EQ(world, tile);
            legal += world.has_value();
          });
      for (const papers::SliceTile& tile : naive::make_tiles(columns)) {
        local_slices += papers::slice_tile(tile, config).kept.size();
        tiles += global.kept.size();
      }
    }
  }
  EXPECT_GT(legal, 10000u);
  EXPECT_LT(local_slices, tiles) << "a tile keeps fewer slices than the world";
}

TEST(TileLocalSlices, AtTheirOwnHeightsDifferOnlyWhereSpareHeadroomIsBelowTheResolution) {
  size_t same = 0, differ = 0;
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const auto columns = rolling_world(seed, 190, 70);
    const papers::SliceBody body{.height = 1750, .step = 300};
    papers::SweepConfig config = naive::sweep_config(columns, body.height, 100);
    config.rule = papers::SliceRule::kDismissOnly;
    const SliceSet global = sweep(columns, config);
    for_each_tile_move(
        columns, global, config, body,
        [&](const naive::Columns& own, size_t from, int32_t feet, size_t to, auto world,
            auto tile) {
          if (world == tile) {
            same += world.has_value();
            return;
          }
          ++differ;
          ASSERT_NE(world.has_value(), tile.has_value()) << "never two different floors";
          const int32_t feet_to = world ? *world : *tile;
          const int64_t free = std::min(ceiling(own, from, feet), ceiling(own, to, feet_to));
          const int64_t spare = free - std::max(feet, feet_to) - body.height;
          EXPECT_GE(spare, 0);
          EXPECT_LT(spare, config.resolution);
        });
  }
  EXPECT_GT(same, 10000u);
  EXPECT_GT(differ, 10u) << "a remote wall shifts the phase of the global cut";
}

}  // namespace
}  // namespace throng
