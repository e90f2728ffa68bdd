// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/air/air_clearance.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.h"

namespace throng {
namespace {

// Posts and beams here and there, and none in the highest layer.
world::AirRows litter(int32_t side, int32_t height, int32_t apron, uint64_t seed) {
  const int32_t across = side + 2 * apron;
  world::AirRows rows(across, height, across, true);
  for (uint64_t i = 0; i < 14; ++i) {
    const auto dice = [&](uint64_t k, int32_t max_value) {
      return static_cast<int32_t>(random_unit(seed, i, k) * max_value);
    };
    const int32_t x = dice(0, across), y = dice(1, height - 1), z = dice(2, across);
    const int32_t wide = 1 + dice(3, 5), high = 1 + dice(4, 4), deep = 1 + dice(5, 3);
    for (int32_t j = y; j < std::min(y + high, height - 1); ++j) {
      for (int32_t k = z; k < z + deep; ++k) rows.fill(x, x + wide, j, k, false);
    }
  }
  return rows;
}

// Cell by cell: how far a solid is from an air box's footprint in a layer of the world.
int32_t distance(const world::AirTreeSource& source, int32_t max_value, const world::AirCube& cube,
                 int32_t y) {
  const int32_t height = source.rows->height;
  const int32_t row = y < source.base || y >= source.base + height ? height - 1 : y - source.base;
  for (int32_t r = 0; r <= max_value; ++r) {
    for (int32_t z = cube.z - r; z < cube.z + cube.side + r; ++z) {
      for (int32_t x = cube.x - r; x < cube.x + cube.side + r; ++x) {
        if (!source.rows->is_free(source.x + x, row, source.z + z)) return r;
      }
    }
  }
  return max_value + 1;
}

TEST(AirClearance, IsWhatATestOfEveryCellFinds) {
  size_t cubes = 0, wide = 0, high = 0;
  for (uint64_t seed = 1; seed <= 24; ++seed) {
    const int32_t apron = seed % 3 == 0 ? 16 : seed % 3 == 1 ? 4 : 7;
    const int32_t side = seed % 2 == 0 ? 64 : 40, height = 12;
    const world::AirRows rows = litter(side, height, apron, seed);
    const world::AirTreeSource source{.rows = &rows,
                                      .x = apron,
                                      .z = apron,
                                      .side = side,
                                      .width = side,
                                      .depth = side,
                                      .base = -8,
                                      .largest = 16,
                                      .free_beyond = true};
    world::AirTreeData data = world::build_air_tree(source);
    bake::measure_clearance(source, apron, 2, data);
    const world::AirTree tree = data.view();
    const int32_t max_value = std::min(apron, world::kMaxAirClearance);
    tree.for_each([&](const world::AirCube& cube, uint32_t word) {
      if (world::air_kind(word) != world::AirKind::kFree) return;
      const world::AirClearance room = world::air_clearance(world::air_number(word));
      int32_t width = world::kMaxAirClearance, free = 0;
      for (int32_t y = cube.y; y < cube.y + cube.side; ++y) {
        width = std::min(width, distance(source, max_value, cube, y) - 1);
      }
      while (free < world::kMaxAirClearance &&
             distance(source, max_value, cube, cube.y + cube.side + free) > width) {
        ++free;
      }
      ASSERT_EQ(room.width, width) << seed << ": " << cube.x << ", " << cube.y << ", " << cube.z;
      ASSERT_EQ(room.height, free) << seed << ": " << cube.x << ", " << cube.y << ", " << cube.z;
      ++cubes;
      wide += room.width > 2 ? 1 : 0;
      high += room.height > 2 ? 1 : 0;
    });
  }
  EXPECT_GT(cubes, 3000u);
  EXPECT_GT(wide, 500u);
  EXPECT_GT(high, 500u);
}

}  // namespace
}  // namespace throng
