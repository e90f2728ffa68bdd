// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "throng/base.h"

namespace throng {
namespace {

TEST(Prism, ACircleLiesInItsPrismAndTouchesAllSides) {
  for (int corners = 3; corners <= 64; ++corners) {
    const Prism prism = Prism::circle({1e4, 2, -3}, 0.5, 1.5, corners);
    ASSERT_TRUE(check_prism(prism)) << corners;
    ASSERT_EQ(prism.corners.size(), static_cast<size_t>(corners));
    EXPECT_EQ(prism.low, 2);
    EXPECT_EQ(prism.high, 3.5);
    for (size_t i = 0; i < prism.corners.size(); ++i) {
      const auto [ax, az] = prism.corners[i];
      const auto [bx, bz] = prism.corners[(i + 1) % prism.corners.size()];
      const double far =
          std::fabs((bx - ax) * (-3 - az) - (bz - az) * (1e4 - ax)) / std::hypot(bx - ax, bz - az);
      EXPECT_GE(far, 0.5) << corners;
      EXPECT_LT(far, 0.5 + 1e-6) << corners;
    }
  }
  const Prism sixteen = Prism::circle({0, 0, 0}, 1, 1);
  EXPECT_LT(std::hypot(sixteen.corners[3][0], sixteen.corners[3][1]), 1.02);
}

TEST(Prism, CoversHeightsOfFeetThatRoundingMayHaveMovedOutside) {
  const Prism prism = Prism::box({-1, 2, -1}, {1, 3.5, 1});
  for (const double y : {1.951, 2.0, 2.7, 3.5, 3.549}) EXPECT_TRUE(prism.covers_height(y)) << y;
  for (const double y : {-1e9, 1.949, 3.551, 1e9, std::nan("")}) {
    EXPECT_FALSE(prism.covers_height(y)) << y;
  }
  EXPECT_EQ(Prism::kFeetTolerance, 0.05);
  // To stand in it takes both: the height, and the place seen from above.
  EXPECT_TRUE(prism.contains({0.5, 1.96, 1}));
  EXPECT_FALSE(prism.contains({0.5, 1.94, 1}));
  EXPECT_FALSE(prism.contains({0.5, 2.5, 1.01}));
}

}  // namespace
}  // namespace throng
