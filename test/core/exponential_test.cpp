// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/math/exponential.h"

#include <gtest/gtest.h>

#include <cmath>

namespace throng {
namespace {

TEST(Exponential, IsThatOfTheLibrary) {
  for (double x = -699; x < 699; x += 0.0371) {
    EXPECT_NEAR(exp_of(x) / std::exp(x), 1, 4e-15) << x;
  }
  EXPECT_EQ(exp_of(0), 1);
}

TEST(Exponential, WhatIsBeyondReasonIsHeld) {
  EXPECT_EQ(exp_of(-701), 0);
  EXPECT_EQ(exp_of(-INFINITY), 0);
  EXPECT_EQ(exp_of(NAN), 0);
  EXPECT_EQ(exp_of(1e9), exp_of(700));
}

}  // namespace
}  // namespace throng
