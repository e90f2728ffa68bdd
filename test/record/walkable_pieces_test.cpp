// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "baked.h"
#include "core/random.h"
#include "throng/bake.h"
#include "worlds.h"

namespace throng {
namespace {

std::vector<WalkablePiece> pieces_of(const World& world, double low = -1e9, double high = 1e9) {
  Context context;
  auto pieces = walkable_pieces(world, 0, low, high, context);
  EXPECT_TRUE(pieces) << pieces.error().message;
  return *std::move(pieces);
}

// How often a ray from the point crosses the ring.
int32_t crossings(const Ring& ring, double x, double z) {
  int32_t count = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a[1] > z) == (b[1] > z)) continue;
    if (a[0] + (z - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) > x) ++count;
  }
  return count;
}

bool holds(const Polygon& polygon, double x, double z) {
  int32_t count = crossings(polygon.outer, x, z);
  for (const Ring& hole : polygon.holes) count += crossings(hole, x, z);
  return count % 2 == 1;
}

double area_of(const Ring& ring) {
  double twice = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a[0] * b[1] - b[0] * a[1];
  }
  return twice / 2;
}

// Random cells of any density, many of which touch at corners only, against a flood fill.
TEST(WalkablePieces, AreTheConnectedCells) {
  uint64_t cells_seen = 0;
  for (uint64_t seed = 0; seed < 30; ++seed) {
    constexpr int32_t kSide = 21;
    FlatCells cells{.width = kSide, .depth = kSide, .passable = {}};
    for (uint64_t i = 0; i < kSide * kSide; ++i) {
      cells.passable.push_back(random_below(seed, 0, i, 30) < 3 + seed % 24 ? 1 : 0);
    }
    const auto world = bake_flat_cells(cells, 1, 1);
    ASSERT_TRUE(world);
    std::vector<int32_t> part(kSide * kSide, -1);
    int32_t parts = 0;
    const std::function<void(int32_t, int32_t)> flood = [&](int32_t x, int32_t z) {
      if (x < 0 || z < 0 || x >= kSide || z >= kSide) return;
      const auto i = static_cast<size_t>(z * kSide + x);
      if (cells.passable[i] == 0 || part[i] >= 0) return;
      part[i] = parts;
      flood(x + 1, z), flood(x - 1, z), flood(x, z + 1), flood(x, z - 1);
    };
    for (int32_t c = 0; c < kSide * kSide; ++c) {
      if (cells.passable[static_cast<size_t>(c)] == 0 || part[static_cast<size_t>(c)] >= 0)
        continue;
      flood(c % kSide, c / kSide);
      ++parts;
    }

    const auto pieces = pieces_of(*world);
    ASSERT_EQ(pieces.size(), static_cast<size_t>(parts));
    std::set<int32_t> found;
    for (size_t p = 0; p < pieces.size(); ++p) {
      const WalkablePiece& piece = pieces[p];
      EXPECT_LE(piece.area, pieces[p == 0 ? 0 : p - 1].area);
      int32_t mine = -1;
      double area = 0;
      for (int32_t c = 0; c < kSide * kSide; ++c) {
        if (!holds(piece.polygon, c % kSide + 0.5, c / kSide + 0.5)) continue;
        area += 1;
        ++cells_seen;
        if (mine < 0) mine = part[static_cast<size_t>(c)];
        EXPECT_EQ(part[static_cast<size_t>(c)], mine);
      }
      EXPECT_TRUE(found.insert(mine).second);
      EXPECT_EQ(area, piece.area);
      EXPECT_EQ(std::count(part.begin(), part.end(), mine), static_cast<ptrdiff_t>(area));
      EXPECT_GT(area_of(piece.polygon.outer), 0);
      // A ring passes no corner twice and has corners only where it turns.
      std::vector<Ring> rings = piece.polygon.holes;
      for (const Ring& hole : rings) EXPECT_LT(area_of(hole), 0);
      rings.push_back(piece.polygon.outer);
      for (const Ring& ring : rings) {
        EXPECT_EQ((std::set<std::array<double, 2>>(ring.begin(), ring.end()).size()), ring.size());
        for (size_t i = 0; i < ring.size(); ++i) {
          const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
          const auto& c = ring[(i + 2) % ring.size()];
          EXPECT_NE((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]), 0);
        }
      }
    }
  }
  EXPECT_GT(cells_seen, 5000u);
}

TEST(WalkablePieces, LayLevelsOverEachOtherOrShowThoseBetweenTwoHeights) {
  const World world = test::bake(worlds::two_floors(), 0.1);
  const double both = world.summary().walkable_area[0];
  const auto sum = [](const std::vector<WalkablePiece>& pieces) {
    double area = 0;
    for (const WalkablePiece& piece : pieces) area += piece.area;
    return area;
  };
  const double lower = sum(pieces_of(world, -1, 1)), upper = sum(pieces_of(world, 1.0005, 100));
  EXPECT_GT(lower, 1);
  EXPECT_GT(upper, 1);
  EXPECT_NEAR(lower + upper, both, 1e-6 * both);
  EXPECT_LT(sum(pieces_of(world)), both);
  EXPECT_TRUE(pieces_of(world, 500, 600).empty());
  Context context;
  EXPECT_FALSE(walkable_pieces(world, 99, 0, 1, context));
  EXPECT_FALSE(walkable_pieces(World(), 0, 0, 1, context));
}

TEST(WalkablePieces, AreWrittenAsWellKnownText) {
  EXPECT_EQ(to_wkt({.outer = {{0, 0}, {3, 0}, {3, 2.5}}, .holes = {{{1, 1}, {1, 1.25}, {2, 1}}}}),
            "POLYGON ((0.000 0.000, 3.000 0.000, 3.000 2.500, 0.000 0.000), "
            "(1.000 1.000, 1.000 1.250, 2.000 1.000, 1.000 1.000))");
}

}  // namespace
}  // namespace throng
