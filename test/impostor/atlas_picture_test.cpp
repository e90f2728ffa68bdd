// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "blank_atlas.h"
#include "throng/impostor.h"

// Pictures of atlases for inspection.
namespace throng {
namespace {

constexpr int32_t kSide = test::kBlankPixels;

std::array<int32_t, 3> pixel(const Image& image, int32_t x, int32_t y) {
  const uint8_t* at = &image.rgb[3 * static_cast<size_t>(y * image.width + x)];
  return {at[0], at[1], at[2]};
}

bool is_red(const std::array<int32_t, 3>& p) { return p[0] > p[1] + 50 && p[0] > p[2] + 50; }

AtlasView& view_of(Atlas& atlas, int32_t frame, int32_t row, int32_t column) {
  return atlas.views[atlas.shape.view(frame, row, column)];
}

void paint(Atlas& atlas, const AtlasView& view, std::array<uint8_t, 4> rgba) {
  for (int32_t t = 0; t < kSide * kSide; ++t) {
    uint8_t* texel = test::texel_of(atlas, view, t);
    for (size_t c = 0; c < 4; ++c) texel[c] = rgba[c];
  }
}

TEST(AtlasPicture, ShowsEachViewOfAFrameOnceOneRowPerElevation) {
  Atlas atlas = test::blank_atlas(2);
  paint(atlas, view_of(atlas, 1, 3, 5), {200, 20, 20, 255});
  for (const int32_t frame : {0, 1}) {
    const Image image = draw_atlas(atlas, frame);
    ASSERT_EQ(image.width, 16 * kSide);
    ASSERT_EQ(image.height, 8 * kSide);
    ASSERT_EQ(image.rgb.size(), size_t{3} * 16 * kSide * 8 * kSide);
    for (int32_t y = 0; y < image.height; ++y) {
      for (int32_t x = 0; x < image.width; ++x) {
        const bool inside = frame == 1 && x / kSide == 5 && y / kSide == 3;
        ASSERT_EQ(is_red(pixel(image, x, y)), inside) << frame << ": " << x << ' ' << y;
      }
    }
  }
}

TEST(AtlasPicture, IsLitOnGrey) {
  Atlas atlas = test::blank_atlas(1);
  const AtlasView upper = view_of(atlas, 0, 0, 0), lower = view_of(atlas, 0, 0, 1);
  for (const AtlasView& view : {upper, lower}) paint(atlas, view, {128, 128, 128, 255});
  for (int32_t t = 0; t < kSide * kSide; ++t) {
    const auto normal = [&](const AtlasView& view) {
      return &atlas.normal[static_cast<size_t>(test::texel_of(atlas, view, t) -
                                               atlas.colour.data()) /
                           2];
    };
    normal(upper)[1] = 255;  // straight up
    normal(lower)[1] = 1;    // straight down
  }
  paint(atlas, view_of(atlas, 0, 0, 2), {255, 0, 0, 0});
  const Image image = draw_atlas(atlas, 0);
  const int32_t middle = kSide / 2;
  EXPECT_GT(pixel(image, middle, middle)[0], pixel(image, kSide + middle, middle)[0] + 30);
  const auto paper = pixel(image, 2 * kSide + middle, middle);
  EXPECT_EQ(paper[0], paper[1]);
  EXPECT_EQ(paper[0], paper[2]);
  EXPECT_GT(paper[0], 60);
  EXPECT_LT(paper[0], 240);
}

TEST(AtlasPicture, OfBlocksLooksLikeThatOfTheirTexels) {
  Atlas atlas = test::blank_atlas(1);
  paint(atlas, view_of(atlas, 0, 3, 5), {200, 20, 20, 255});
  const Image exact = draw_atlas(atlas, 0);
  for (const AtlasFormat format : {AtlasFormat::kRgb5a1, AtlasFormat::kBc1, AtlasFormat::kBc3,
                                   AtlasFormat::kEtc2a1, AtlasFormat::kEtc2}) {
    const Image image = draw_atlas(convert_atlas(atlas, format), 0);
    ASSERT_EQ(image.rgb.size(), exact.rgb.size()) << word_for(format);
    int32_t farthest = 0;
    for (size_t i = 0; i < image.rgb.size(); ++i) {
      farthest = std::max(farthest, std::abs(image.rgb[i] - exact.rgb[i]));
    }
    EXPECT_LT(farthest, 16) << word_for(format);
  }
}

// As atlases from elsewhere may have them.
TEST(AtlasPicture, AViewThatIsEmptyOrReachesBeyondItsSquareDisturbsNoOther) {
  Atlas atlas = test::blank_atlas(1);
  AtlasView& beyond = view_of(atlas, 0, 3, 5);
  paint(atlas, beyond, {200, 20, 20, 255});
  beyond.left = kSide / 2, beyond.top = kSide / 4;
  view_of(atlas, 0, 0, 0).width = 0;
  AtlasView& outside = view_of(atlas, 0, 7, 15);
  paint(atlas, outside, {200, 20, 20, 255});
  outside.left = outside.top = UINT16_MAX;
  const Image image = draw_atlas(atlas, 0);
  for (int32_t y = 0; y < image.height; ++y) {
    for (int32_t x = 0; x < image.width; ++x) {
      const bool inside =
          x / kSide == 5 && y / kSide == 3 && x % kSide >= kSide / 2 && y % kSide >= kSide / 4;
      ASSERT_EQ(is_red(pixel(image, x, y)), inside) << x << ' ' << y;
    }
  }
  const auto empty = pixel(image, 1, 1), white = pixel(image, kSide + 1, 1);
  EXPECT_LT(empty[0], white[0]) << "grey where a view has no texels";
}

}  // namespace
}  // namespace throng
