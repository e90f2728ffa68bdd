// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "scratch_folder.h"
#include "throng/picture.h"

namespace throng {
namespace {

HeatMap map_of(int32_t width, int32_t depth, double most) {
  HeatMap map{.title = "Test", .unit = "1", .cell = 0.5, .width = width, .depth = depth};
  for (int32_t c = 0; c < width * depth; ++c) map.values.push_back(c == 0 ? 0 : most);
  return map;
}

// How many pixels have the colour of the middle of the plot.
size_t pixels_like_the_middle(const Image& image) {
  const auto at = [&](int32_t x, int32_t y) {
    const auto i = static_cast<size_t>(y * image.width + x) * 3;
    return std::array{image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
  };
  size_t count = 0;
  const auto middle = at(image.width / 2, image.height / 2);
  for (int32_t y = 0; y < image.height; ++y) {
    for (int32_t x = 0; x < image.width; ++x) count += at(x, y) == middle ? 1 : 0;
  }
  return count;
}

TEST(HeatMap, CellsFillThePlotAndZeroStaysPaper) {
  const auto image = draw_heat_map(map_of(10, 5, 3));
  ASSERT_TRUE(image) << image.error().message;
  // 980 x 490 pixels, one of fifty cells is paper.
  const double cells = 980.0 * 490.0;
  EXPECT_NEAR(static_cast<double>(pixels_like_the_middle(*image)), cells * 0.98, cells * 0.005);
}

// Coordinates of national grids differ in the last of many digits.
TEST(HeatMap, TicksOfNationalGridsKeepAllTheirDigits) {
  HeatMap map = map_of(60, 60, 0);
  map.x0 = 678000;
  map.z0 = -5403530;
  const auto image = draw_heat_map(map);
  map.x0 += 5;
  const auto right = draw_heat_map(map);
  map.x0 -= 5;
  map.z0 += 5;
  const auto below = draw_heat_map(map);
  ASSERT_TRUE(image && right && below);
  EXPECT_NE(image->rgb, right->rgb);
  EXPECT_NE(image->rgb, below->rgb);
  // No text is cut off at the picture's edge.
  for (int32_t y = 0; y < image->height; ++y) {
    for (int32_t x = 0; x < 4; ++x) {
      const auto i = static_cast<size_t>(y * image->width + x) * 3;
      EXPECT_EQ(image->rgb[i], image->rgb[0]) << x << ' ' << y;
    }
  }
}

TEST(HeatMap, MoreCellsThanPixelsAreAveraged) {
  HeatMap map = map_of(3000, 1500, 3);
  for (size_t c = 0; c < map.values.size(); ++c) map.values[c] = c % 2 == 0 ? 0.0 : 2.0;
  map.max = 2;
  const auto image = draw_heat_map(map);
  ASSERT_TRUE(image);
  std::set<std::array<uint8_t, 3>> colours;
  for (int32_t x = 200; x < 900; ++x) {
    const auto i = static_cast<size_t>(image->height / 2 * image->width + x) * 3;
    colours.insert({image->rgb[i], image->rgb[i + 1], image->rgb[i + 2]});
  }
  EXPECT_FALSE(colours.contains({255, 255, 255}));
  EXPECT_LE(colours.size(), 4u);
}

TEST(HeatMap, EverythingMayBeZeroAndNonsenseIsRefused) {
  EXPECT_TRUE(draw_heat_map(map_of(1, 1, 0)));
  EXPECT_TRUE(draw_heat_map(map_of(1, 4000, 1)));
  HeatMap bad = map_of(3, 3, 1);
  bad.values.pop_back();
  EXPECT_FALSE(draw_heat_map(bad));
  bad = map_of(3, 3, NAN);
  EXPECT_FALSE(draw_heat_map(bad));
  bad = map_of(3, 3, 1);
  bad.cell = 0;
  EXPECT_FALSE(draw_heat_map(bad));
  bad = map_of(3, 3, 1);
  bad.picture_width = 10;
  EXPECT_EQ(draw_heat_map(bad).error().code, Errc::kBadConfig);
}

TEST(Picture, PngBytesAreThoseOfTheFile) {
  const auto image = draw_heat_map(map_of(4, 4, 1));
  ASSERT_TRUE(image);
  const auto bytes = png_bytes(*image);
  ASSERT_GT(bytes.size(), 8u);
  EXPECT_EQ(bytes[1], 'P');
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/map.png";
  ASSERT_TRUE(write_png(*image, path));
  std::vector<uint8_t> file(bytes.size() + 10);
  std::FILE* in = std::fopen(path.c_str(), "rb");
  file.resize(std::fread(file.data(), 1, file.size(), in));
  std::fclose(in);
  EXPECT_EQ(file, bytes);
}

}  // namespace
}  // namespace throng
