// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <queue>

#include "core/random.h"
#include "graph/flood.h"
#include "graph/lane_flood.h"

namespace throng {
namespace {

bool has(const world::CellRows& rows, int32_t x, int32_t z) {
  return ((rows[static_cast<size_t>(z)] >> x) & 1) != 0;
}
void set(world::CellRows& rows, int32_t x, int32_t z) {
  rows[static_cast<size_t>(z)] |= uint64_t{1} << x;
}

// Cell by cell.
world::CellRows naive_flood(const world::CellRows& open, const graph::StepCuts* cuts, int32_t x,
                            int32_t z) {
  world::CellRows filled{};
  std::queue<std::pair<int32_t, int32_t>> queue;
  set(filled, x, z);
  queue.push({x, z});
  const auto visit = [&](int32_t nx, int32_t nz, bool is_cut) {
    if (nx < 0 || nz < 0 || nx > 63 || nz > 63 || is_cut) return;
    if (!has(open, nx, nz) || has(filled, nx, nz)) return;
    set(filled, nx, nz);
    queue.push({nx, nz});
  };
  const auto across = [&](int32_t cx, int32_t cz) {
    return cuts != nullptr && cx >= 0 && has(cuts->across, cx, cz);
  };
  const auto along = [&](int32_t cx, int32_t cz) {
    return cuts != nullptr && cz >= 0 && has(cuts->along, cx, cz);
  };
  while (!queue.empty()) {
    const auto [cx, cz] = queue.front();
    queue.pop();
    visit(cx + 1, cz, across(cx, cz));
    visit(cx - 1, cz, across(cx - 1, cz));
    visit(cx, cz + 1, along(cx, cz));
    visit(cx, cz - 1, along(cx, cz - 1));
  }
  return filled;
}

// About `share` of 256 bits set.
world::CellRows random_rows(uint64_t seed, uint64_t n, uint32_t share) {
  world::CellRows rows{};
  for (uint64_t cell = 0; cell < 4096; ++cell) {
    if (random_below(seed, n * 4096 + cell, 0, 256) < share)
      set(rows, static_cast<int32_t>(cell % 64), static_cast<int32_t>(cell / 64));
  }
  return rows;
}

// By the same finder, as its scratch is used again, behind what the list holds.
class Parts {
 public:
  std::vector<world::CellRows> of(const world::CellRows& open, const graph::StepCuts* cuts) {
    const size_t before = list_.parts.size();
    finder_.find(open, cuts, list_);
    std::vector<world::CellRows> found;
    for (size_t p = before; p < list_.parts.size(); ++p) {
      const graph::PartList::Part& part = list_.parts[p];
      world::CellRows rows{};
      uint32_t cells = 0;
      uint64_t west = 0, east = 0;
      for (size_t z = part.begin; z < part.end; ++z) {
        rows[z] = list_.row(part, z);
        cells += static_cast<uint32_t>(std::popcount(rows[z]));
        west |= (rows[z] & 1) << z;
        east |= (rows[z] >> 63) << z;
      }
      EXPECT_EQ(cells, part.cells);
      EXPECT_EQ(part.side, (std::array<uint64_t, 4>{west, east, rows[0], rows[63]}));
      EXPECT_TRUE(rows[part.begin] != 0 && rows[part.end - 1u] != 0);
      found.push_back(rows);
    }
    return found;
  }

 private:
  graph::PartFinder finder_;
  graph::PartList list_;
};

std::vector<world::CellRows> connected_parts(const world::CellRows& open,
                                             const graph::StepCuts* cuts) {
  return Parts().of(open, cuts);
}

void expect_parts_as_naive(const world::CellRows& open, const graph::StepCuts* cuts) {
  const auto parts = connected_parts(open, cuts);
  world::CellRows together{};
  for (const world::CellRows& part : parts) {
    int32_t x = 0, z = 0;
    while (!has(part, x, z)) {
      x = (x + 1) % 64;
      z += x == 0 ? 1 : 0;
    }
    ASSERT_EQ(part, naive_flood(open, cuts, x, z));
    for (size_t i = 0; i < 64; ++i) {
      ASSERT_EQ(together[i] & part[i], 0u);
      together[i] |= part[i];
    }
  }
  ASSERT_EQ(together, open);
  // In the order of their first cells, also where the finder and its list were used before.
  uint32_t last = 0;
  for (const world::CellRows& part : parts) {
    uint32_t cell = 0;
    while (!has(part, static_cast<int32_t>(cell % 64), static_cast<int32_t>(cell / 64))) ++cell;
    ASSERT_TRUE(last == 0 || cell > last);
    last = cell;
  }
  static Parts kept;
  ASSERT_EQ(kept.of(open, cuts), parts);
}

TEST(CellFlood, FindsTheSamePartsAsCellByCell) {
  for (uint64_t n = 0; n < 60; ++n) {
    for (const uint32_t share : {20u, 110u, 150u, 170u, 200u, 250u}) {
      const world::CellRows open = random_rows(share, n, share);
      expect_parts_as_naive(open, nullptr);
      const graph::StepCuts cuts{random_rows(share + 1, n, share / 3),
                                 random_rows(share + 2, n, 40)};
      expect_parts_as_naive(open, &cuts);
    }
  }
}

TEST(CellFlood, FindsTheSamePartsWhereRowsAreAlike) {
  for (uint64_t n = 0; n < 60; ++n) {
    for (const uint32_t share : {20u, 110u, 170u, 250u}) {
      world::CellRows open = random_rows(share, n, share);
      for (size_t z = 1; z < 64; ++z) {
        if (random_below(n, z, 0, 4) != 0) open[z] = open[z - 1];
      }
      expect_parts_as_naive(open, nullptr);
      // Cuts are not alike.
      const graph::StepCuts cuts{random_rows(share + 1, n, share / 3),
                                 random_rows(share + 2, n, 40)};
      expect_parts_as_naive(open, &cuts);
    }
  }
}

TEST(CellFlood, FindsTheSamePartsOfSeveralSetsAtOnce) {
  graph::LaneScratch scratch;
  graph::PartFinder finder;
  graph::PartList list;
  for (uint64_t n = 0; n < 40; ++n) {
    std::vector<world::CellRows> rows;
    for (size_t set = 0; set <= n % 17; ++set) {
      const auto share = static_cast<uint32_t>(random_below(n, set, 1, 257));
      rows.push_back(random_rows(n, set, share));
    }
    std::vector<const world::CellRows*> sets;
    for (const world::CellRows& of_set : rows) sets.push_back(&of_set);
    std::vector<uint32_t> first(sets.size() + 1);
    graph::find_parts_of(sets, scratch, list, first);
    ASSERT_EQ(first.back(), list.parts.size());
    for (size_t set = 0; set < sets.size(); ++set) {
      graph::PartList alone;
      finder.find(rows[set], nullptr, alone);
      ASSERT_EQ(first[set + 1] - first[set], alone.parts.size());
      for (size_t i = 0; i < alone.parts.size(); ++i) {
        const graph::PartList::Part &part = list.parts[first[set] + i], &same = alone.parts[i];
        ASSERT_EQ(part.begin, same.begin);
        ASSERT_EQ(part.end, same.end);
        ASSERT_EQ(part.cells, same.cells);
        ASSERT_EQ(part.side, same.side);
        for (size_t z = part.begin; z < part.end; ++z) {
          ASSERT_EQ(list.row(part, z), alone.row(same, z));
        }
      }
    }
  }
}

TEST(CellFlood, FindsFewPartsOrNone) {
  graph::PartFinder finder;
  graph::PartList list;
  world::CellRows rows{};
  EXPECT_TRUE(finder.find_few(rows, list));
  EXPECT_TRUE(list.parts.empty());
  rows.fill(5);  // two columns, all rows alike
  EXPECT_TRUE(finder.find_few(rows, list));
  EXPECT_EQ(list.parts.size(), 2u);
  for (size_t z = 0; z < 64; z += 2) rows[z] = 21;  // and spots
  EXPECT_FALSE(finder.find_few(rows, list));
  EXPECT_EQ(list.parts.size(), 2u);
}

TEST(CellFlood, FollowsSpiralsAndFullAndEmptyTiles) {
  world::CellRows full;
  full.fill(~uint64_t{0});
  EXPECT_EQ(connected_parts(full, nullptr), std::vector<world::CellRows>{full});
  EXPECT_TRUE(connected_parts(world::CellRows{}, nullptr).empty());
  // A corridor one cell wide that winds from the rim to the middle.
  world::CellRows spiral{};
  int32_t x = 0, z = 0, dx = 1, dz = 0;
  for (int32_t turn = 0, length = 63; length > 0; ++turn) {
    for (int32_t i = 0; i < length; ++i) {
      set(spiral, x, z);
      x += dx;
      z += dz;
    }
    const int32_t old = dx;
    dx = -dz;
    dz = old;
    if (turn >= 2 && turn % 2 == 0) length -= 2;
  }
  set(spiral, x, z);
  EXPECT_EQ(connected_parts(spiral, nullptr).size(), 1u);
  expect_parts_as_naive(spiral, nullptr);
  // Cuts between all rows: each row is a part.
  graph::StepCuts cuts;
  cuts.along.fill(~uint64_t{0});
  EXPECT_EQ(connected_parts(full, &cuts).size(), 64u);
}

}  // namespace
}  // namespace throng
