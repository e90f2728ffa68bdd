// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/collision_map.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "core/random.h"

namespace throng {
namespace {

// [TC00]'s map as printed, on one floor: an integer per pixel, 1 added to nine of them.
struct PrintedMap {
  std::map<std::pair<int, int>, int> count;
  void add(int x, int z, int n) {
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dx = -1; dx <= 1; ++dx) count[{x + dx, z + dz}] += n;
    }
  }
  // May an avatar that stands on (x, z) enter (nx, nz)? Its own share is removed first.
  bool may_enter(int x, int z, int nx, int nz) {
    add(x, z, -1);
    const bool free = count[{nx, nz}] == 0;
    add(x, z, 1);
    return free;
  }
};

TEST(CollisionMap, AnswersLikeThePrintedMap) {
  constexpr int kSide = 20;
  crowd::CollisionMap map(kSide, kSide, crowd::PixelGrid(1), 0, 3000, 1750);
  PrintedMap printed;
  const auto mark = [&](int x, int z) {
    return map.mark({(int64_t{x} << world::kUnitBits) + 7, (int64_t{z} << world::kUnitBits) + 2000},
                    120, 1750);
  };
  std::vector<std::pair<int, int>> bodies;
  uint64_t n = 0;
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    const int x = static_cast<int>(random_below(1, 1, n++, kSide));
    const int z = static_cast<int>(random_below(1, 1, n++, kSide));
    if (bodies.size() < 25) {
      const bool free = printed.count[{x, z}] == 0;
      ASSERT_EQ(map.is_free(mark(x, z)), free);
      if (!free) continue;
      map.set(mark(x, z));
      printed.add(x, z, 1);
      bodies.emplace_back(x, z);
      continue;
    }
    auto& [bx, bz] = bodies[random_below(1, 1, n++, bodies.size())];
    map.clear(mark(bx, bz));
    const bool free = map.is_free(mark(x, z));
    ASSERT_EQ(free, printed.may_enter(bx, bz, x, z));
    if (free) {
      printed.add(bx, bz, -1);
      printed.add(x, z, 1);
      bx = x;
      bz = z;
    }
    refused += !free;
    map.set(mark(bx, bz));
  }
  EXPECT_GT(refused, 1000);
}

TEST(CollisionMap, BodiesOnFloorsAboveEachOtherDoNotCollide) {
  crowd::CollisionMap map(10, 10, crowd::PixelGrid(1), 0, 200000, 1750);
  const world::GroundPoint p{5 << world::kUnitBits, 5 << world::kUnitBits};
  for (int32_t y = 0; y < 200000; y += 2250) {  // words of 16 m are crossed many times
    ASSERT_TRUE(map.is_free(map.mark(p, y, 1750))) << y;
    map.set(map.mark(p, y, 1750));
    ASSERT_FALSE(map.is_free(map.mark(p, y + 1749, 1750))) << y;
    ASSERT_FALSE(map.is_free(map.mark({p.x + world::kUnitsPerCell, p.z}, y, 1750))) << y;
    ASSERT_TRUE(map.is_free(map.mark({p.x + 2 * world::kUnitsPerCell, p.z}, y, 1750))) << y;
  }
}

TEST(CollisionMap, AShortBodyFitsUnderWhatATallOneDoesNot) {
  crowd::CollisionMap map(10, 10, crowd::PixelGrid(1), 0, 20000, 3000);
  const world::GroundPoint p{5 << world::kUnitBits, 5 << world::kUnitBits};
  map.set(map.mark(p, 10000, 1100));
  // Slices are 250 mm high, so 1 mm below two of them are certainly others.
  EXPECT_TRUE(map.is_free(map.mark(p, 8400, 1100)));
  EXPECT_FALSE(map.is_free(map.mark(p, 8400, 3000)));
  EXPECT_TRUE(map.is_free(map.mark(p, 11600, 3000)));
  EXPECT_FALSE(map.is_free(map.mark(p, 11099, 3000)));
}

// Bodies on several floors that move one pixel at a time, in turn, in two maps: in one only the new
// pixels around each move are tested, in the other all nine.
TEST(CollisionMap, TestingOnlyTheNewPixelsIsEnough) {
  constexpr int32_t kSide = 12;
  constexpr int32_t kStorey = 2600;
  crowd::CollisionMap quick(kSide, kSide, crowd::PixelGrid(3), 0, 40000, 1750);
  crowd::CollisionMap simple(kSide, kSide, crowd::PixelGrid(3), 0, 40000, 1750);
  struct Body {
    int32_t x, z, y;  // pixel
    [[nodiscard]] world::GroundPoint point() const {
      return {int64_t{x * 3 + 1} << world::kUnitBits, int64_t{z * 3 + 2} << world::kUnitBits};
    }
  };
  std::vector<Body> bodies;
  uint64_t n = 0;
  const auto draw = [&](uint64_t below) {
    return static_cast<int32_t>(random_below(3, 4, n++, below));
  };
  for (int32_t i = 0; i < 100; ++i) {
    const Body body{draw(kSide / 3), draw(kSide / 3), draw(14) * kStorey};
    const auto mark = simple.mark(body.point(), body.y, 1750);
    if (!simple.is_free(mark)) continue;
    simple.set(mark);
    quick.set(mark);
    bodies.push_back(body);
  }
  int32_t moved = 0, refused = 0;
  for (int32_t i = 0; i < 20000; ++i) {
    Body& body = bodies[static_cast<size_t>(draw(bodies.size()))];
    const int32_t dx = draw(3) - 1, dz = draw(3) - 1;
    if (dx == 0 && dz == 0) continue;
    const Body next{body.x + dx, body.z + dz, body.y};
    if (next.x < 0 || next.z < 0 || next.x >= kSide / 3 || next.z >= kSide / 3) continue;
    const auto from = simple.mark(body.point(), body.y, 1750),
               to = simple.mark(next.point(), body.y, 1750);
    simple.clear(from);
    const bool is_free = simple.is_free(to);
    simple.set(is_free ? to : from);
    ASSERT_EQ(
        quick.move_by_one(from.slices, from.pixel, crowd::CollisionMap::direction_index(dx, dz)),
        is_free);
    if (is_free) body = next;
    ++(is_free ? moved : refused);
  }
  EXPECT_GT(moved, 1000);
  EXPECT_GT(refused, 1000);
}

TEST(PixelGrid, DividesExactlyUpToTheLastCell) {
  for (int32_t cells : {1, 2, 3, 5, 7, 10, 50, 4095, 4096}) {
    const crowd::PixelGrid grid(cells);
    for (int32_t cell = 0; cell < (1 << 20); cell += 1 + cell / 4096) {
      ASSERT_EQ(grid.pixel(cell), cell / cells) << cells;
    }
    for (int32_t cell = (1 << 20) - 5000; cell < (1 << 20); ++cell) {
      ASSERT_EQ(grid.pixel(cell), cell / cells) << cells;
    }
  }
}

}  // namespace
}  // namespace throng
