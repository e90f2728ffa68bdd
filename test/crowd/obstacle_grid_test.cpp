// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/obstacle_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "core/random.h"

namespace throng {
namespace {

constexpr double kUnit = 0.2 / 2048;  // [m]
constexpr int32_t kHeight = 1800;     // [mm]

void set(crowd::ObstacleGrid& grid, uint32_t slot, const Prism& prism) {
  grid.set(slot, crowd::AirObstacle(prism, Vec3d{}, kUnit), {prism, {}});
}

crowd::AirPosition position(double x, double y, double z) {
  return {static_cast<int32_t>(x / kUnit), static_cast<int32_t>(z / kUnit),
          static_cast<int32_t>(y * 1000)};
}

struct Draws {
  uint64_t n = 0;
  double operator()(double low, double high) {
    return low + (high - low) * random_unit(3, 14, n++);
  }
};

TEST(ObstacleGrid, FindsWhatALoopOverAllFindsAndInOrderOfSlot) {
  Draws draw;
  crowd::ObstacleGrid grid(kUnit);
  std::map<uint32_t, crowd::AirObstacle> all;
  uint64_t held = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto slot = static_cast<uint32_t>(draw(0, 150));
    if (draw(0, 1) < 0.4) {
      grid.erase(slot);
      all.erase(slot);
    } else {
      // From a centimetre to farther than any body can be.
      const double size = 0.01 * std::pow(10, draw(0, draw(0, 1) < 0.05 ? 9 : 4));
      const Vec3d at{draw(-20, 120), draw(-1, 3), draw(-20, 120)};
      const Prism prism = Prism::circle(at, size, draw(0.1, 4), 3 + static_cast<int>(draw(0, 9)));
      set(grid, slot, prism);
      all.insert_or_assign(slot, crowd::AirObstacle(prism, Vec3d{}, kUnit));
    }
    ASSERT_EQ(grid.is_empty(), all.empty());
    const crowd::AirPosition feet = position(draw(0, 100), draw(0, 4), draw(0, 100));
    const double radius = 0.05 * std::pow(10, draw(0, 2.5));
    std::vector<uint32_t> expected, found;
    for (const auto& [number, shape] : all) {
      if (shape.holds(feet, radius, kHeight)) expected.push_back(number);
    }
    std::vector<const crowd::ObstacleGrid::Item*> near;
    grid.list_near(feet, radius, near);
    for (const crowd::ObstacleGrid::Item* item : near) {
      if (item->shape.holds(feet, radius, kHeight)) found.push_back(item->slot);
    }
    ASSERT_EQ(found, expected) << round;
    const bool any = grid.any_near(feet, radius, [&](const crowd::ObstacleGrid::Item& item) {
      return item.shape.holds(feet, radius, kHeight);
    });
    ASSERT_EQ(any, !expected.empty());
    held += expected.size();
  }
  EXPECT_GT(held, 1000u);
}

TEST(ObstacleGrid, TestsFewHoweverManyStandElsewhere) {
  crowd::ObstacleGrid grid(kUnit);
  const auto tested = [&] {
    uint64_t count = 0;
    (void)grid.any_near(position(30, 0, 30), 0.3, [&](const crowd::ObstacleGrid::Item&) {
      ++count;
      return false;
    });
    return count;
  };
  std::vector<uint64_t> counts;
  for (const int side : {16, 32, 64, 128}) {
    for (int i = 0; i < side * side; ++i) {
      const double x = 1.5 * (i % side) + 10, z = 1.5 * static_cast<double>(i / side) + 10;
      set(grid, static_cast<uint32_t>(i), Prism::box({x, 0, z}, {x + 0.5, 2, z + 0.5}));
    }
    counts.push_back(tested());
  }
  EXPECT_GT(counts[0], 0u);
  EXPECT_LT(counts[0], 40u);
  EXPECT_LE(counts[3], counts[1]);
}

}  // namespace
}  // namespace throng
