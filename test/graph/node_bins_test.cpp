// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/node_bins.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "throng/surface.h"

// Codes of inclinations and lengths, and the runs of partial nodes.
namespace throng {
namespace {

TEST(NodeBins, ACodeNeverPromisesMoreThanItsValue) {
  const NodeBins bins =
      graph::make_bins(std::vector<AvatarClass>{{.name = "adult"},
                                                {.name = "child", .height = 1.1, .radius = 0.15},
                                                {.name = "tall", .height = 2.2, .radius = 0.4}});
  for (int i = 0; i <= 2000; ++i) {
    const double degrees = i * 0.09, metres = i * 0.0025;
    const uint8_t slope = bins.inclination_code(degrees);
    EXPECT_GE(bins.inclination_of(slope), degrees);
    if (slope > 0) {
      EXPECT_LT(bins.inclination_of(static_cast<uint8_t>(slope - 1)), degrees);
    }
    const uint8_t height = bins.height_code(metres), width = bins.width_code(metres);
    EXPECT_LE(bins.height_of(height), metres);
    EXPECT_LE(bins.width_of(width), metres);
    // The best that holds: the next promises too much.
    if (height < bins.height.size()) {
      EXPECT_GT(bins.height[height], metres);
    }
    if (width < bins.width.size()) {
      EXPECT_GT(bins.width[width], metres);
    }
  }
}

TEST(NodeBins, AtTheEdgesAndBeyondAllOfThem) {
  const NodeBins bins{.inclination = {10, 40}, .height = {1, 2}, .width = {0.5}};
  EXPECT_EQ(bins.inclination_code(10), 0);
  EXPECT_EQ(bins.inclination_code(10.001), 1);
  EXPECT_EQ(bins.inclination_code(90), 2);
  EXPECT_EQ(bins.inclination_of(2), 180);
  EXPECT_EQ(bins.inclination_of(200), 180) << "of a damaged file";
  EXPECT_EQ(bins.height_code(0.999), 0);
  EXPECT_EQ(bins.height_of(0), 0);
  EXPECT_EQ(bins.height_code(1), 1);
  EXPECT_EQ(bins.height_of(1), 1);
  EXPECT_EQ(bins.height_code(1e9), 2);
  EXPECT_EQ(bins.height_of(200), 2) << "of a damaged file";
  EXPECT_EQ(bins.width_code(0.5), 1);
  EXPECT_EQ(NodeBins{}.width_code(3), 0);
  EXPECT_EQ(NodeBins{}.width_of(7), 0);
  EXPECT_EQ(NodeBins{}.inclination_of(0), 180);
}

TEST(PartialNode, ItsRunsAreItsCellsEachOnce) {
  for (const uint64_t cells : {uint64_t{0}, ~uint64_t{0}, uint64_t{1}, uint64_t{1} << 63,
                               uint64_t{0x8142241818244281}, uint64_t{0xff00ff00b700d5aa}}) {
    uint64_t found = 0;
    int32_t last_t = -1, last_end = 0;
    for_partial_runs(cells, [&](int32_t s, int32_t t, int32_t count) {
      ASSERT_GT(count, 0);
      ASSERT_LE(s + count, 8);
      if (t == last_t) {
        EXPECT_GT(s, last_end) << "a run ends only where a cell is missing";
      }
      EXPECT_GE(t, last_t);
      for (int32_t i = s; i < s + count; ++i) {
        const uint64_t bit = uint64_t{1} << (8 * t + i);
        EXPECT_EQ(found & bit, 0u);
        found |= bit;
      }
      last_t = t;
      last_end = s + count;
    });
    EXPECT_EQ(found, cells);
  }
}

}  // namespace
}  // namespace throng
