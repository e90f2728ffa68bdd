// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/streams.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "throng/scenario.h"

namespace throng {
namespace {

using validate::DoorOffset;
using validate::Passer;

TEST(Streams, OrderIsOneForPureRowsAndZeroForRandomOnes) {
  std::vector<Passer> pure, even;
  for (int n = 0; n < 40; ++n) {
    const double across = 0.1 + n % 4;
    pure.push_back({across, n % 4 < 2});
    even.push_back({across, n < 20});
  }
  EXPECT_DOUBLE_EQ(validate::lane_order(pure, 1), 1);
  // Four rows of 5 up and 5 down: (0 - 4) / (40 - 4).
  EXPECT_DOUBLE_EQ(validate::lane_order(even, 1), -1.0 / 9);
  // One row of 3 and 1: (4 / 4 - 1) / (4 - 1) = 0; of 4 and 1: (9 / 5 - 1) / 4 = 0.2.
  EXPECT_DOUBLE_EQ(
      validate::lane_order(std::vector<Passer>{{0, true}, {0, true}, {0, true}, {0, false}}, 1), 0);
  EXPECT_DOUBLE_EQ(
      validate::lane_order(
          std::vector<Passer>{{0.1, true}, {0.2, true}, {0.3, true}, {0.4, true}, {0.5, false}}, 1),
      0.2);
  EXPECT_EQ(validate::lane_order({}, 1), 0);
  double mean = 0;
  for (uint64_t k = 0; k < 400; ++k) {
    std::vector<Passer> mixed;
    for (uint64_t n = 0; n < 100; ++n) {
      mixed.push_back({6 * random_unit(k, 1, n), random_unit(k, 2, n) < 0.5});
    }
    mean += validate::lane_order(mixed, 0.6) / 400;
  }
  EXPECT_NEAR(mean, 0, 0.02);
}

TEST(Streams, AHalfCircleIsAsWideAsItIsDeep) {
  std::vector<DoorOffset> half, column;
  for (double x = -4.975; x < 5; x += 0.05) {
    for (double y = 0.025; y < 5; y += 0.05) {
      if (std::hypot(x, y) < 5) half.push_back({x, y});
      if (std::fabs(x) < 0.6) column.push_back({x, y});
    }
  }
  EXPECT_NEAR(validate::arch_shape(half), 1, 0.01);
  EXPECT_NEAR(validate::arch_shape(column), 0.3 / 2.5, 0.02);
  EXPECT_EQ(validate::arch_shape({}), 0);
}

TEST(Streams, CrowdsAreTheSameForAnyWorkersAndHaveNoOverlaps) {
  for (const char* name : {"crossing", "arch"}) {
    Context context;
    const auto one = run_validation(name, {.workers = 1, .brief = true}, context);
    ASSERT_TRUE(one) << one.error().message;
    EXPECT_EQ(one->faults.overlaps + one->faults.wall_entries, 0U);
    for (const int32_t workers : {2, 4}) {
      const auto other = run_validation(name, {.workers = workers, .brief = true}, context);
      ASSERT_TRUE(other);
      for (size_t i = 0; i < one->measures.size(); ++i) {
        EXPECT_EQ(other->measures[i].value, one->measures[i].value) << one->measures[i].name;
      }
    }
  }
}

}  // namespace
}  // namespace throng
