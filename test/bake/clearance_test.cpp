// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/clearance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

// A cell's margin is k if every cell that a point within k cells of it can lie on is legal.
namespace throng {
namespace {

constexpr int32_t kLast = bake::kTileSide - 1;

bool bit(const bake::BitPlane& plane, int32_t x, int32_t z) {
  return ((plane[static_cast<size_t>(z)] >> x) & 1) != 0;
}

// One class on 3 x 3 tiles of any number of layers.
struct Tiles {
  std::array<bake::TileLegality, 9> of;
  std::array<const bake::TileLegality*, 9> around;

  explicit Tiles(size_t layers = 1) {
    for (size_t i = 0; i < 9; ++i) {
      of[i].resize(layers);
      for (bake::LayerLegality& layer : of[i]) {
        layer.classes.resize(1);
        for (auto& link : layer.link) link.fill(0);
        for (auto& rise : layer.rise) rise.fill(0);
      }
      around[i] = &of[i];
    }
  }
};

int32_t tile_of(int32_t x, int32_t z) {
  return (z < 0 ? 0 : (z > kLast ? 6 : 3)) + (x < 0 ? 0 : (x > kLast ? 2 : 1));
}

// Is cell (x, z), counted from the middle tile, legal on a world of one layer a tile?
bool legal_at(const Tiles& tiles, int32_t x, int32_t z) {
  const bake::TileLegality* tile = tiles.around[static_cast<size_t>(tile_of(x, z))];
  return tile != nullptr && !tile->empty() &&
         bit((*tile)[0].classes[0].legal, x & kLast, z & kLast);
}

// Squares at (dx, dz) are so far apart. [cells]
double apart(int32_t dx, int32_t dz) {
  return std::hypot(std::max(std::abs(dx) - 1, 0), std::max(std::abs(dz) - 1, 0));
}

// The margin of a cell, one neighbour after the other. `is_legal` takes a cell.
template <class IsLegal>
int32_t naive_margin(int32_t x, int32_t z, IsLegal is_legal) {
  double nearest = 1e9;  // illegal cell
  for (int32_t dz = -9; dz <= 9; ++dz) {
    for (int32_t dx = -9; dx <= 9; ++dx) {
      const double distance = apart(dx, dz);
      if (distance < nearest && !is_legal(x + dx, z + dz)) nearest = distance;
    }
  }
  // Points nearer than k are those of cells nearer than k: a point just k away only touches more.
  int32_t k = 0;
  while (k < bake::kMaxMargin && nearest >= k + 1) ++k;
  return k;
}

int32_t margin_of(const bake::ClearancePlanes& planes, int32_t x, int32_t z) {
  int32_t margin = 0;
  for (size_t i = 0; i < 3; ++i) margin += static_cast<int32_t>(bit(planes.margin[i], x, z)) << i;
  return margin;
}

// Random holes: `count` in the nine tiles, points and rectangles.
void punch(Tiles& tiles, uint64_t seed, int32_t count) {
  for (bake::TileLegality& tile : tiles.of) {
    for (bake::LayerLegality& layer : tile) layer.classes[0].legal.fill(~uint64_t{0});
  }
  for (int32_t i = 0; i < count; ++i) {
    const auto n = static_cast<uint64_t>(i);
    const auto x0 = static_cast<int32_t>(random_below(seed, n, 1, 192)) - 64;
    const auto z0 = static_cast<int32_t>(random_below(seed, n, 2, 192)) - 64;
    const auto wide = static_cast<int32_t>(random_below(seed, n, 3, i % 2 == 0 ? 1 : 12)) + 1;
    const auto deep = static_cast<int32_t>(random_below(seed, n, 4, i % 2 == 0 ? 1 : 12)) + 1;
    for (int32_t z = z0; z < std::min(z0 + deep, 128); ++z) {
      for (int32_t x = x0; x < std::min(x0 + wide, 128); ++x) {
        bake::BitPlane& legal = tiles.of[static_cast<size_t>(tile_of(x, z))][0].classes[0].legal;
        legal[static_cast<size_t>(z & kLast)] &= ~(uint64_t{1} << (x & kLast));
      }
    }
  }
}

TEST(Clearance, TheMarginIsTheDistanceToTheNearestIllegalCell) {
  std::array<int32_t, 8> seen{};
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    Tiles tiles;
    punch(tiles, seed, static_cast<int32_t>(seed * seed));
    if (seed % 5 == 0) tiles.around[seed % 9 == 4 ? 0 : seed % 9] = nullptr;
    bake::ClearancePlanes planes;
    bake::erode(tiles.around, 0, 0, 400, planes);
    const bake::BitPlane& legal = tiles.of[4][0].classes[0].legal;
    EXPECT_EQ(planes.legal, legal);
    int32_t cells = 0, full = 0;
    for (int32_t z = 0; z < bake::kTileSide; ++z) {
      for (int32_t x = 0; x < bake::kTileSide; ++x) {
        if (!bit(legal, x, z)) {
          ASSERT_EQ(margin_of(planes, x, z), 0) << seed << ": " << x << " " << z;
          continue;
        }
        ++cells;
        const int32_t expected =
            naive_margin(x, z, [&](int32_t cx, int32_t cz) { return legal_at(tiles, cx, cz); });
        full += expected == bake::kMaxMargin ? 1 : 0;
        ++seen[static_cast<size_t>(expected)];
        ASSERT_EQ(margin_of(planes, x, z), expected) << seed << ": " << x << " " << z;
      }
    }
    EXPECT_EQ(planes.cells, cells);
    EXPECT_EQ(planes.all, full == bake::kTileArea);
  }
  for (const int32_t count : seen) EXPECT_GT(count, 500);
}

// Cells of a neighbouring tile count only where a link leads to them, by a step of the class.
TEST(Clearance, WhatNoLinkLeadsToCountsAsIllegal) {
  constexpr int32_t kStep = 400;
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    Tiles tiles;
    punch(tiles, seed, static_cast<int32_t>(seed % 4));
    for (bake::TileLegality& tile : tiles.of) {
      for (size_t side = 0; side < 4; ++side) {
        for (size_t i = 0; i < bake::kTileSide; ++i) {
          const double dice = random_unit(seed, side * 64 + i, 5);
          const double few = seed % 3 == 0 ? 0.3 : 0.02;
          if (dice < few) tile[0].link[side][i] = -1;
          const bool far = dice > 1 - few;
          tile[0].rise[side][i] = static_cast<uint16_t>(far ? kStep + 1 : kStep);
        }
      }
    }
    const auto linked = [&](const bake::LayerLegality& layer, size_t side, int32_t i) {
      const auto at = static_cast<size_t>(i);
      return layer.link[side][at] >= 0 && layer.rise[side][at] <= kStep;
    };
    // From the middle tile up or down along a column, then sideways along the row; a corner's
    // columns hang on the outermost one.
    const auto is_legal = [&](int32_t x, int32_t z) {
      if (!legal_at(tiles, x, z)) return false;
      const bake::LayerLegality* layer = &tiles.of[4][0];
      if (z < 0 || z > kLast) {
        const size_t side = z < 0 ? 2 : 3;
        if (!linked(*layer, side, std::clamp(x, 0, kLast))) return false;
        layer = &tiles.of[z < 0 ? 1 : 7][0];
      }
      if (x >= 0 && x <= kLast) return true;
      return linked(*layer, x < 0 ? 0 : 1, z & kLast);
    };
    bake::ClearancePlanes planes;
    bake::erode(tiles.around, 0, 0, kStep, planes);
    for (int32_t z = 0; z < bake::kTileSide; ++z) {
      for (int32_t x = 0; x < bake::kTileSide; ++x) {
        if (!bit(tiles.of[4][0].classes[0].legal, x, z)) continue;
        ASSERT_EQ(margin_of(planes, x, z), naive_margin(x, z, is_legal))
            << seed << ": " << x << " " << z;
      }
    }
  }
}

TEST(Clearance, AllMeansTheFullMarginEverywhere) {
  Tiles open;
  punch(open, 1, 0);
  bake::ClearancePlanes planes;
  bake::erode(open.around, 0, 0, 400, planes);
  EXPECT_TRUE(planes.all);
  EXPECT_EQ(planes.cells, bake::kTileArea);
  // One illegal cell 8 cells out still lets a margin of 7 pass, 7 cells out it does not.
  for (const int32_t side : {1, 3, 5, 7}) {
    for (const int32_t out : {7, 8}) {
      Tiles tiles;
      punch(tiles, 1, 0);
      const int32_t far = out - 1;
      const int32_t x = side == 3 ? kLast - far : (side == 5 ? far : 30);
      const int32_t z = side == 1 ? kLast - far : (side == 7 ? far : 30);
      tiles.of[static_cast<size_t>(side)][0].classes[0].legal[static_cast<size_t>(z)] &=
          ~(uint64_t{1} << x);
      bake::erode(tiles.around, 0, 0, 400, planes);
      EXPECT_EQ(planes.all, out == 8) << "side " << side;
    }
  }
}

TEST(Clearance, AMarginThroughAStackOfLayersFollowsTheLinkedOne) {
  // Two layers a tile; layer 0 goes on in layer 1 next door for z < 32, in layer 0 beyond.
  Tiles tiles(2);
  for (bake::TileLegality& tile : tiles.of) {
    tile[0].classes[0].legal.fill(~uint64_t{0});
    tile[1].classes[0].legal.fill(~uint64_t{0});
  }
  for (size_t z = 0; z < bake::kTileSide; ++z) tiles.of[4][0].link[1][z] = z < 32 ? 1 : 0;
  tiles.of[5][1].classes[0].legal[10] = ~uint64_t{0} << 1;  // column 0 of row 10
  tiles.of[5][0].classes[0].legal[50] = ~uint64_t{0} << 1;
  bake::ClearancePlanes planes;
  bake::erode(tiles.around, 0, 0, 400, planes);
  EXPECT_EQ(margin_of(planes, kLast, 10), 0);
  EXPECT_EQ(margin_of(planes, kLast, 50), 0);
  EXPECT_EQ(margin_of(planes, kLast, 30), 7);
  EXPECT_EQ(margin_of(planes, kLast - 1, 10), 1);
  bake::erode(tiles.around, 1, 0, 400, planes);  // Layer 1 goes on in layer 0.
  EXPECT_EQ(margin_of(planes, kLast, 10), 7);
  EXPECT_EQ(margin_of(planes, kLast, 50), 0);
}

// Links: for each border cell the layer across it whose feet are nearest, if within the step.
bool is_useful(const bake::Layer& layer, size_t cell) {
  return (layer.useful[cell / 64] >> cell % 64 & 1) != 0;
}

TEST(Clearance, LinksLeadToTheNearestFeetAcrossTheBorderWithinTheStep) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    uint64_t n = 0;
    const auto below = [&](uint64_t limit) {
      return static_cast<int32_t>(random_below(seed, 8, n++, limit));
    };
    const auto make = [&] {
      auto layer = std::make_unique<bake::Layer>();
      layer->base = below(600) - 300;
      for (uint16_t& feet : layer->feet) {
        feet = static_cast<uint16_t>(4000 + below(900));
        if (below(10) == 0) feet = bake::kNone16;
      }
      for (uint64_t& row : layer->useful) row = ~(uint64_t{1} << below(64));
      bake::summarise(*layer);
      bake::set_borders(*layer);
      return layer;
    };
    const auto own = make();
    std::array<bake::TileLayers, 4> beside;
    std::array<const bake::TileLayers*, 4> sides;
    for (size_t side = 0; side < 4; ++side) {
      for (int32_t s = 0; s < 3; ++s) beside[side].push_back(make());
      sides[side] = &beside[side];
    }
    if (seed % 4 == 0) sides[seed % 3] = nullptr;
    constexpr int32_t kStep = 150;
    bake::LayerLegality out;
    bake::link_layer(*own, sides, kStep, out);
    for (size_t side = 0; side < 4; ++side) {
      for (size_t i = 0; i < bake::kTileSide; ++i) {
        const size_t left = i * 64, right = i * 64 + 63, up = i, down = 63 * 64 + i;
        const size_t mine[] = {left, right, up, down}, theirs[] = {right, left, down, up};
        int32_t best = kStep + 1, layer = -1;
        for (size_t s = 0; s < 3 && sides[side] != nullptr; ++s) {
          const bake::Layer& other = *beside[side][s];
          const uint16_t a = own->feet[mine[side]], b = other.feet[theirs[side]];
          if (a == bake::kNone16 || b == bake::kNone16) continue;
          if (!is_useful(*own, mine[side]) || !is_useful(other, theirs[side])) continue;
          const int32_t rise = std::abs(own->base + a - other.base - b);
          if (rise < best) {
            best = rise;
            layer = static_cast<int32_t>(s);
          }
        }
        ASSERT_EQ(out.link[side][i], layer) << "side " << side << " cell " << i;
        ASSERT_EQ(out.rise[side][i], layer < 0 ? 0 : best);
      }
    }
  }
}

}  // namespace
}  // namespace throng
