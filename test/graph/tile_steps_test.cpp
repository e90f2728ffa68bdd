// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/tile_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"

namespace throng {
namespace {

// Floor of a tile by heights in whole millimetres.
struct Floor {
  template <class Height>
  explicit Floor(Height height) {
    for (int32_t z = 0; z < 64; ++z) {
      for (int32_t x = 0; x < 64; ++x) {
        samples[static_cast<size_t>(z * 64 + x)] =
            static_cast<uint16_t>(std::lround(30000 + height(x + 0.5, z + 0.5)));
      }
    }
  }
  [[nodiscard]] world::LevelView view() const {
    world::LevelView view;
    view.floor = &block;
    view.samples = samples.data();
    return view;
  }
  std::array<uint16_t, 4096> samples{};
  uint64_t block = 0;
};

constexpr graph::StepLimits kLimits{.step = 20,
                                    .slope = 100};  // a wheelchair; 45 degrees in cells of 0.1

TEST(TileSteps, LimitsAreTheLeastStepAndTheSteepestSlope) {
  const graph::StepLimits limits = graph::step_limits(default_classes(), 0.25);
  EXPECT_EQ(limits.step, 20);
  EXPECT_NEAR(limits.slope, 250, 1);
}

TEST(TileSteps, SlopesHaveNone) {
  for (uint64_t seed = 1; seed <= 400; ++seed) {
    // A ramp in any direction between two level floors, as long as it is steep.
    const double turn = 6.283 * random_unit(seed, 1, 0), steep = 95 * random_unit(seed, 1, 1);
    const double begin = 60 * random_unit(seed, 1, 2) - 20,
                 end = begin + 6 + 30 * static_cast<double>(seed % 4);
    const Floor floor([&](double x, double z) {
      return steep * std::clamp(x * std::cos(turn) + z * std::sin(turn) - begin, 0.0, end - begin);
    });
    EXPECT_FALSE(graph::tile_steps(floor.view(), kLimits)) << "seed " << seed;
    // Hills.
    const double high = 300 + 500 * random_unit(seed, 1, 3);
    const Floor hills(
        [&](double x, double z) { return high * std::sin(x / 9 + turn) * std::cos(z / 11); });
    EXPECT_FALSE(graph::tile_steps(hills.view(), kLimits)) << "seed " << seed;
  }
}

TEST(TileSteps, RisersAreStepsWhereverTheyAre) {
  for (int32_t tread = 2; tread < 9; ++tread) {
    for (const double riser : {30.0, 170.0, -250.0}) {
      const Floor stairs([&](double x, double) { return riser * std::floor(x / tread); });
      const Floor turned([&](double, double z) { return riser * std::floor(z / tread); });
      const auto across = graph::tile_steps(stairs.view(), kLimits);
      const auto along = graph::tile_steps(turned.view(), kLimits);
      ASSERT_TRUE(across && along);
      // At a tile's rim, where the floor beyond is not known, a slope is taken for one.
      for (int32_t x = 2; x < 61; ++x) {
        const bool steps = (x + 1) % tread == 0;
        EXPECT_EQ(across->across[7] >> x & 1, steps ? 1u : 0u) << tread << " cells, " << x;
        EXPECT_EQ(along->along[static_cast<size_t>(x)] >> 7 & 1, steps ? 1u : 0u);
      }
      for (size_t z = 0; z < 64; ++z) {
        EXPECT_EQ(across->along[z], 0u);
        EXPECT_EQ(along->across[z], 0u);
      }
    }
  }
}

TEST(TileSteps, AStepOnASlopeIsMoreThanTheSlope) {
  for (const double slope : {-60.0, -10.0, 10.0, 60.0}) {
    const Floor floor([&](double x, double) { return slope * x + (x > 30 ? 40 : 0); });
    const auto steps = graph::tile_steps(floor.view(), kLimits);
    // Where the ground falls away a step up may be less than none: 60 down and 40 up are 20 down.
    if (slope == -60) {
      EXPECT_FALSE(steps);
      continue;
    }
    ASSERT_TRUE(steps) << slope;
    for (size_t z = 0; z < 64; ++z) EXPECT_EQ(steps->across[z], uint64_t{1} << 29);
  }
}

// Over the border of two tiles both are asked.
TEST(TileSteps, BordersOfTilesAreAskedOnBothSides) {
  const Floor level([](double, double) { return 0.0; });
  const Floor kerb([](double, double) { return 60.0; });
  const Floor ramp([](double x, double) { return 80 * x; });
  const Floor below([](double x, double) { return 80 * (x - 64); });
  EXPECT_TRUE(graph::is_step(level.view(), 63, 5, kerb.view(), 0, 5, kLimits));
  EXPECT_TRUE(graph::is_step(kerb.view(), 63, 5, level.view(), 0, 5, kLimits));
  EXPECT_FALSE(graph::is_step(level.view(), 63, 5, level.view(), 0, 5, kLimits));
  EXPECT_FALSE(graph::is_step(level.view(), 63, 5, ramp.view(), 0, 5, kLimits));
  EXPECT_FALSE(graph::is_step(below.view(), 63, 5, ramp.view(), 0, 5, kLimits));
}

}  // namespace
}  // namespace throng
