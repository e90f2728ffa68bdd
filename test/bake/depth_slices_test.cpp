// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/files/read_file.h"
#include "core/random.h"
#include "naive_columns.h"
#include "naive_slices.h"
#include "papers/slices/slice_ground.h"
#include "papers/slices/slice_move.h"
#include "papers/slices/slice_sweep.h"
#include "papers/slices/sparse_slices.h"
#include "scratch_folder.h"
#include "throng/papers.h"

namespace throng {
namespace {

using Cells = std::vector<std::vector<std::pair<int32_t, int32_t>>>;

constexpr int32_t kWidth = 24, kDepth = 20;

// Uneven ground and roofs over it, beside towers of up to 300 m and pits: floors lie further below
// the cuts than 16 bits can say.
naive::Columns tall_world(uint64_t seed) {
  Cells cells;
  for (uint64_t cell = 0; cell < kWidth * kDepth; ++cell) {
    const auto below = [&](uint64_t i, uint64_t n) {
      return static_cast<int32_t>(random_below(seed, cell, i, n));
    };
    const int32_t base = static_cast<int32_t>(random_below(seed, 1u << 20, cell / 96, 3)) * 90000;
    const int32_t ground = base + below(0, 6) * 90;
    auto& spans = cells.emplace_back();
    spans.emplace_back(ground - 200, ground);
    if (below(1, 2) == 0) spans.emplace_back(ground + 1800 + below(2, 300), ground + 2300);
    if (below(3, 60) == 0) spans.emplace_back(0, 120000 + below(4, 180000));
    if (below(5, 12) == 0) spans.emplace_back(base + 70000, base + 70200);
  }
  return naive::from_lists(kWidth, kDepth, cells);
}

SliceSet sweep(const naive::Columns& columns, int32_t avatar_height) {
  Context context;
  return *papers::sweep_slices(naive::make_tiles(columns),
                               naive::sweep_config(columns, avatar_height, 100), context);
}

using Answer = std::optional<int32_t>;

Answer answer(const SliceSet& slices, size_t from, int32_t feet, size_t to,
              const papers::SliceBody& body) {
  const size_t slice = papers::find_slice(slices, feet + body.height);
  if (slices.kept[slice].surface[from] != feet) return {};
  if (!papers::can_move(slices, slice, from, to, body)) return {};
  return slices.kept[slice].surface[to];
}

papers::CellBox box_of(size_t cell) {
  const auto x = static_cast<int32_t>(cell % kWidth), z = static_cast<int32_t>(cell / kWidth);
  return {x, z, x, z};
}

Answer answer(const papers::SliceGround& ground, size_t from, int32_t feet, size_t to,
              const papers::SliceBody& body) {
  const DepthSlice& read = ground.slices().slices[ground.slice_above(feet + body.height)];
  if (read.depths[from] == DepthSlice::kNone || read.surface(from) != feet) return {};
  return ground.feet_after(feet, papers::box_of(box_of(from), box_of(to)), box_of(to), body);
}

// Compares every move of every body; returns how many are legal.
uint64_t compare_moves(const naive::Columns& columns, const SliceSet& slices,
                       const papers::SliceGround& ground, const papers::SliceBody& body) {
  uint64_t legal = 0;
  for (size_t from = 0; from < size_t{kWidth} * kDepth; ++from) {
    for (const int32_t feet : columns.highs(from)) {
      for (const size_t to : {from + 1, from + kWidth}) {
        if (to >= size_t{kWidth} * kDepth || (to == from + 1 && to % kWidth == 0)) continue;
        // Above the first slice the printed algorithm has no answer.
        if (feet + body.step + body.height > slices.kept[0].height) continue;
        const Answer expected = answer(slices, from, feet, to, body);
        EXPECT_EQ(answer(ground, from, feet, to, body), expected)
            << "from " << from << " to " << to << ", feet " << feet << ", height " << body.height;
        legal += expected ? 1 : 0;
      }
    }
  }
  return legal;
}

TEST(DepthSlices, ExtraSlicesKeepEveryMoveOfEveryBody) {
  int32_t extra = 0;
  uint64_t legal = 0, deep = 0;
  for (uint64_t seed = 0; seed < 30; ++seed) {
    const naive::Columns columns = tall_world(seed);
    const SliceSet slices = sweep(columns, 1750);
    const papers::SliceGround ground(*store_depths(slices));
    extra += ground.slices().extra;
    for (const Slice& slice : slices.kept) {
      deep += static_cast<uint64_t>(
          std::count_if(slice.surface.begin(), slice.surface.end(), [&](int32_t value) {
            return value != slices.far_plane && slice.height - value >= DepthSlice::kNone;
          }));
    }
    for (const int32_t height : {1750, 1900, 3000, 19200}) {
      legal += compare_moves(columns, slices, ground, {.height = height, .step = 400});
    }
  }
  EXPECT_GT(extra, 30);
  EXPECT_GT(deep, 1000u);
  EXPECT_GT(legal, 10000u);
}

// One triangle far above the others, as of a stray point of a scan: nothing is between.
TEST(DepthSlices, AnEmptyGapTakesNoSlices) {
  Cells cells(size_t{kWidth} * kDepth, {{0, 100}});
  cells[5].emplace_back(400'000'000, 400'000'000);
  const SliceSet slices = sweep(naive::from_lists(kWidth, kDepth, cells), 1750);
  const auto stored = store_depths(slices);
  ASSERT_TRUE(stored);
  EXPECT_LE(stored->extra, 2);
  const papers::SliceGround ground(*stored);
  EXPECT_TRUE(answer(ground, 30, 100, 31, {.height = 1750, .step = 400}));
}

TEST(DepthSlices, WithoutDeepFloorsTheyAreTheSlicesThemselves) {
  const auto columns = naive::from_lists(3, 1, {{{0, 100}}, {{0, 100}, {3000, 3200}}, {}});
  const SliceSet slices = sweep(columns, 1750);
  const DepthSlices stored = *store_depths(slices);
  EXPECT_EQ(stored.extra, 0);
  ASSERT_EQ(stored.slices.size(), slices.kept.size());
  EXPECT_EQ(stored.avatar_height, 1750);
  EXPECT_EQ(stored.resolution, 100);
  EXPECT_EQ(stored.bytes(), slices.kept.size() * 3 * 2);
  for (size_t i = 0; i < stored.slices.size(); ++i) {
    EXPECT_EQ(stored.slices[i].height, slices.kept[i].height);
    for (size_t cell = 0; cell < 3; ++cell) {
      const int32_t value = slices.kept[i].surface[cell];
      if (value == slices.far_plane) {
        EXPECT_EQ(stored.slices[i].depths[cell], DepthSlice::kNone);
      } else {
        EXPECT_EQ(stored.slices[i].surface(cell), value);
      }
    }
  }
}

TEST(SparseSlices, AnswerAsFullGridsDoWithFewerBytes) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const DepthSlices full = *store_depths(sweep(tall_world(seed), 1750));
    const papers::SparseSlices sparse(full);
    ASSERT_EQ(sparse.size(), full.slices.size());
    for (size_t s = 0; s < sparse.size(); ++s) {
      EXPECT_EQ(sparse.height(s), full.slices[s].height);
      for (int32_t z = 0; z < kDepth; ++z) {
        for (int32_t x = 0; x < kWidth; ++x) {
          const auto cell = static_cast<size_t>(z * kWidth + x);
          const bool is_none = full.slices[s].depths[cell] == DepthSlice::kNone;
          ASSERT_EQ(sparse.surface(s, x, z),
                    is_none ? papers::SparseSlices::kNone : full.slices[s].surface(cell));
        }
      }
    }
  }
  // A plain of one height: every slice shares all of it.
  const auto plain = naive::from_lists(64, 64, Cells(size_t{64} * 64, {{0, 100}}));
  const DepthSlices full = *store_depths(sweep(plain, 1750));
  EXPECT_LT(papers::SparseSlices(full).bytes() * 10, full.bytes());
}

TEST(DepthSlices, AFileHoldsThemAllAndADamagedOneIsRefused) {
  const test::ScratchFolder folder;
  DepthSlices set = *store_depths(sweep(tall_world(3), 1750));
  set.cell = 0.1;
  set.origin_x = -12.5;
  set.origin_z = 1e6;
  const std::string path = folder.path() + "/a.slices";
  ASSERT_TRUE(save_slices(set, path));
  EXPECT_TRUE(is_slice_file(path));
  const auto again = load_slices(path);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->origin_z, set.origin_z);
  EXPECT_EQ(again->extra, set.extra);
  ASSERT_EQ(again->slices.size(), set.slices.size());
  for (size_t i = 0; i < set.slices.size(); ++i) {
    EXPECT_EQ(again->slices[i].height, set.slices[i].height);
    EXPECT_EQ(again->slices[i].depths, set.slices[i].depths);
  }

  const std::string bytes = *read_file(path);
  int found = 0;
  for (size_t k = 0; k < 300; ++k) {
    std::string damaged = bytes;
    damaged[random_below(9, k, 0, bytes.size())] ^= static_cast<char>(1 << (k % 8));
    const auto refused = load_slices(folder.write("damaged.slices", damaged));
    if (!refused) {
      EXPECT_EQ(refused.error().code, Errc::kBadFile);
      ++found;
    } else {  // a bit between two fields has no meaning
      EXPECT_EQ(refused->slices[0].depths, set.slices[0].depths);
    }
    EXPECT_FALSE(load_slices(folder.write("short.slices", bytes.substr(0, k))));
  }
  EXPECT_GT(found, 290);
  for (size_t k = 1; k < 20; ++k) {
    const auto longer = load_slices(folder.write("long.slices", bytes + std::string(k, '\0')));
    ASSERT_FALSE(longer) << k;
    EXPECT_NE(longer.error().message.find("after its end"), std::string::npos);
  }
  EXPECT_FALSE(is_slice_file(folder.write("a.obj", "v 0 0 0\n")));
  EXPECT_FALSE(is_slice_file(folder.path()));
  EXPECT_FALSE(load_slices(folder.path() + "/none.slices"));
}

}  // namespace
}  // namespace throng
