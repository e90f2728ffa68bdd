// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "throng/papers.h"
#include "throng/picture.h"

namespace throng {
namespace {

using Colour = std::array<uint8_t, 3>;

Colour at(const Image& image, int32_t x, int32_t y) {
  const auto i =
      3 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x));
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

// The rows of a column that have a colour.
std::vector<int32_t> rows_of(const Image& image, int32_t x, const Colour& colour) {
  std::vector<int32_t> rows;
  for (int32_t y = 0; y < image.height; ++y) {
    if (at(image, x, y) == colour) rows.push_back(y);
  }
  return rows;
}

constexpr Colour kFirst{213, 94, 0}, kSecond{0, 114, 178};

TEST(Chart, LinesLieWhereTheirValuesAreAndStrongOnesAreThicker) {
  Chart chart{.title = "t", .notes = {}, .x_title = "x", .y_title = "y", .x = {0, 10}};
  chart.max = 100;
  chart.lines = {{.name = "", .values = {25, 25}, .spread = {}, .kind = LineKind::kStrong},
                 {.name = "", .values = {75, 75}, .spread = {}, .kind = LineKind::kPlain}};
  const auto image = draw_chart(chart);
  ASSERT_TRUE(image) << image.error().message;
  const auto low = rows_of(*image, 600, kFirst), high = rows_of(*image, 600, kSecond);
  ASSERT_FALSE(low.empty());
  ASSERT_FALSE(high.empty());
  EXPECT_GT(low.size(), high.size());
  // The axis is 520 pixels high at this width: half of it lies between the two.
  EXPECT_NEAR((low.front() + low.back()) / 2.0 - (high.front() + high.back()) / 2.0, 260, 1);
}

TEST(Chart, ABandIsAsWideAsTheSpreadAndHighValuesAreCutOff) {
  Chart chart{.title = "t", .notes = {}, .x_title = "x", .y_title = "y", .x = {0, 10}};
  chart.max = 100;
  chart.lines = {{.name = "", .values = {50, 50}, .spread = {10, 10}, .kind = LineKind::kPlain},
                 {.name = "", .values = {900, 900}, .spread = {}, .kind = LineKind::kPlain},
                 {.name = "", .values = {0, 200}, .spread = {}, .kind = LineKind::kPlain}};
  const auto image = draw_chart(chart);
  ASSERT_TRUE(image) << image.error().message;
  int32_t tinted = 0;
  for (int32_t y = 0; y < image->height; ++y) {
    const Colour c = at(*image, 601, y);
    tinted += c[0] > 240 && c[2] < 230 && c[2] > 200;
  }
  EXPECT_NEAR(tinted, 0.2 * 520, 6);
  EXPECT_TRUE(rows_of(*image, 600, kSecond).empty());
  // The third one leaves at the top in the middle: the plot is 1070 pixels wide, from 90.
  constexpr Colour kThird{0, 158, 115};
  EXPECT_FALSE(rows_of(*image, 90 + 520, kThird).empty());
  EXPECT_TRUE(rows_of(*image, 90 + 550, kThird).empty());
}

TEST(Chart, WhatDoesNotFitIsNamed) {
  const auto refused = [](const Chart& chart) {
    const auto image = draw_chart(chart);
    return image ? std::string("drawn") : image.error().message;
  };
  Chart chart{.title = "t", .notes = {}, .x_title = "x", .y_title = "y", .x = {0, 10}};
  EXPECT_EQ(refused(chart), "drawn");
  chart.lines = {{.name = "cars", .values = {1}, .spread = {}}};
  EXPECT_EQ(refused(chart), "chart: the line 'cars' needs one value for each x");
  chart.lines[0].values = {1, NAN};
  EXPECT_NE(refused(chart).find("'cars'"), std::string::npos);
  chart.lines[0].values = {1, -1};
  EXPECT_NE(refused(chart).find("'cars'"), std::string::npos);
  chart.lines.clear();
  chart.x = {3, 3};
  EXPECT_EQ(refused(chart), "chart: the values of x must be finite and ascend");
  chart.x = {3};
  EXPECT_EQ(refused(chart), "chart: need at least two values of x");
  chart.x = {3, 4};
  chart.width = 10;
  EXPECT_EQ(refused(chart), "chart: width must be from 400 to 8000 px");
}

TEST(CaacdPicture, AvatarsAndObstaclesAreDrawnWhereTheyAre) {
  caacd::Space space;
  space.bodies = {{.position = {100, 0, 300}, .velocity = {}, .fields = {5, 7.5, 12}, .id = 0}};
  space.targets = {{350, 0, 300}};
  space.obstacles = {{{200, 0, 100}, {20, 25, 35}}};
  auto run = caacd::Simulation::create(space, {});
  ASSERT_TRUE(run);
  const auto image = caacd::draw_simulation(*run, {}, {.side = 400, .title = "one"});
  ASSERT_TRUE(image) << image.error().message;
  // 1100 pixels for 400 units, from (50, 130).
  const auto pixel = [&](double x, double z) {
    return at(*image, static_cast<int32_t>(50 + x * 2.75), static_cast<int32_t>(130 + z * 2.75));
  };
  EXPECT_EQ(pixel(98, 300), kSecond);  // travelling; its bearing is drawn to the other side
  EXPECT_EQ(pixel(200, 100), (Colour{214, 216, 220}));
  EXPECT_EQ(pixel(190, 88), (Colour{214, 216, 220}));
  EXPECT_EQ(pixel(300, 350), (Colour{255, 255, 255}));
  EXPECT_EQ(pixel(350, 300), (Colour{31, 36, 46}));
  EXPECT_FALSE(caacd::draw_simulation(*run, {}, {.side = 0}));
}

}  // namespace
}  // namespace throng
