// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "blank_atlas.h"
#include "throng_draw/draw.h"

namespace throng {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

struct OneAvatar {
  std::vector<float> x{0}, y{0}, z{0};
  std::vector<uint16_t> heading{0}, phase{0}, look{77};
  [[nodiscard]] DrawnCrowd crowd() const {
    return {.atlas = 0, .clip = 0, .avatars = {x, y, z, heading, phase, look}};
  }
};

Drawing drawing_of(const Atlas& atlas) {
  Result<Drawing> drawing = Drawing::create();
  EXPECT_TRUE(drawing) << drawing.error().message;
  EXPECT_TRUE(drawing->add_atlas(atlas));
  return *std::move(drawing);
}

// One avatar in the middle, its view's side `side_pixels` of the picture's 96.
DrawingConfig facing(const AtlasShape& shape, double azimuth, double elevation,
                     double side_pixels) {
  DrawingConfig config;
  config.width = config.height = 96;
  config.samples = 1;
  config.avatar_shadows = false;
  config.sun_pixels = 256;
  config.camera.target = {0, shape.centre, 0};
  const Vec3d towards{std::sin(azimuth * kTurn) * std::cos(elevation * kTurn),
                      std::sin(elevation * kTurn),
                      std::cos(azimuth * kTurn) * std::cos(elevation * kTurn)};
  constexpr double kDistance = 30;
  config.camera.eye = config.camera.target + towards * kDistance;
  config.camera.field_of_view = 2 * std::atan(0.5 * shape.side * 96 / side_pixels / kDistance);
  return config;
}

// Views of plain colours: red in odd columns, green in odd rows, blue in their left half.
Atlas plain_views() {
  Atlas atlas = test::blank_atlas(2);
  for (size_t i = 0; i < atlas.views.size(); ++i) {
    for (int32_t t = 0; t < 256; ++t) {
      uint8_t* rgb = test::texel_of(atlas, atlas.views[i], t);
      rgb[0] = i % 2 != 0 ? 255 : 0;
      rgb[1] = i / 16 % 2 != 0 ? 255 : 0;
      rgb[2] = t % 16 < 8 ? 255 : 0;
    }
  }
  return atlas;
}

// What share of the card's left half and right half is red, green and blue.
struct Shares {
  double left[3] = {}, right[3] = {};
};
Shares shares_of(const Image& image) {
  Shares out;
  for (int32_t y = 24; y < 72; ++y) {
    for (int32_t x = 24; x < 72; ++x) {
      for (size_t c = 0; c < 3; ++c) {
        const bool set = image.rgb[static_cast<size_t>(y * 96 + x) * 3 + c] > 110;
        (x < 48 ? out.left : out.right)[c] += set ? 1.0 / (24 * 48) : 0;
      }
    }
  }
  return out;
}

// All 32 borders of columns by all 7 of rows: the pixels are divided among the four views around
// in the shares that follow from the eye's direction.
TEST(ViewBlend, EveryBorderShowsTheViewsOnBothSidesByTheirShares) {
  const Atlas atlas = plain_views();
  Drawing drawing = drawing_of(atlas);
  OneAvatar avatar;
  const DrawnCrowd crowd = avatar.crowd();
  int32_t checked = 0;
  for (int32_t border = 0; border < 32; ++border) {
    for (int32_t row = 0; row < 7; ++row) {
      // From a quarter to three quarters of the upper one.
      const double column_share = 0.25 + 0.5 * (border * 5 % 8) / 7, row_share = 0.25 + row / 12.0;
      DrawingConfig config = facing(atlas.shape, (border + 0.5 * (column_share - 0.5)) / 32,
                                    (row + 1 + 0.5 * (row_share - 0.5)) / 32, 60);
      config.view_blend = 0.5;
      config.to_sun = config.camera.eye - config.camera.target;
      const auto image = drawing.draw({&crowd, 1}, config);
      ASSERT_TRUE(image) << image.error().message;
      const int32_t lower = (border + 31) % 32;
      const auto column_of = [](int32_t sector) { return sector < 16 ? sector : 31 - sector; };
      const auto share = [](double upper, bool lower_has, bool upper_has) {
        return (upper_has ? upper : 0) + (lower_has ? 1 - upper : 0);
      };
      const double red = share(column_share, column_of(lower) % 2 != 0, column_of(border) % 2 != 0);
      const double green = share(row_share, row % 2 != 0, row % 2 == 0);
      const double blue_left = share(column_share, lower < 16, border < 16);
      const Shares seen = shares_of(*image);
      constexpr double kSixteenth = 1.0 / 16 + 0.01;
      for (const double* side : {seen.left, seen.right}) {
        EXPECT_NEAR(side[0], red, kSixteenth) << border << ' ' << row;
        EXPECT_NEAR(side[1], green, kSixteenth) << border << ' ' << row;
      }
      EXPECT_NEAR(seen.left[2], blue_left, kSixteenth) << border << ' ' << row;
      EXPECT_NEAR(seen.right[2], 1 - blue_left, kSixteenth) << border << ' ' << row;
      ++checked;
    }
  }
  EXPECT_EQ(checked, 32 * 7);
}

const Atlas& figure() {
  static const Atlas atlas = [] {
    AtlasConfig config;
    config.frames = 2;
    Context context;
    auto built = create_atlas(built_in_character(), config, context);
    return *std::move(built);
  }();
  return atlas;
}

// The largest and the mean change of a picture from one step of the eye to the next, of half a
// degree each: what all channels of all pixels differ by.
struct Changes {
  double largest = 0, mean = 0;
};
template <class At>
Changes changes_along(Drawing& drawing, int32_t steps, double view_blend, At at) {
  OneAvatar avatar;
  const DrawnCrowd crowd = avatar.crowd();
  Changes out;
  Image last;
  for (int32_t i = 0; i <= steps; ++i) {
    DrawingConfig config = at(i * 0.5 / 360);
    config.view_blend = view_blend;
    config.samples = 2;
    auto image = drawing.draw({&crowd, 1}, config);
    EXPECT_TRUE(image);
    double sum = 0;
    for (size_t k = 0; k < last.rgb.size(); ++k) sum += std::abs(last.rgb[k] - image->rgb[k]);
    out.largest = std::max(out.largest, sum);
    out.mean += sum / steps;
    last = *std::move(image);
  }
  return out;
}

TEST(ViewBlend, ATurningEyeChangesThePictureGradually) {
  Drawing drawing = drawing_of(figure());
  const auto around = [](double turns) { return facing(figure().shape, turns, 0.03, 60); };
  const auto over = [](double turns) { return facing(figure().shape, 0.1, turns, 60); };
  const auto compare = [&](const char* name, const auto& at, int32_t steps) {
    const Changes nearest = changes_along(drawing, steps, 0, at);
    const Changes blended = changes_along(drawing, steps, 0.5, at);
    std::printf("%s: largest change %.0f by the nearest view, %.0f blended; mean %.0f, %.0f\n",
                name, nearest.largest, blended.largest, nearest.mean, blended.mean);
    EXPECT_LT(blended.largest, 0.3 * nearest.largest) << name;
  };
  compare("around", around, 180);
  compare("over", over, 120);
}

// Beyond 24 pixels nothing blends, and just before it little does: no step there either.
TEST(ViewBlend, EndsWhereViewsAreSmall) {
  Drawing drawing = drawing_of(figure());
  OneAvatar avatar;
  const DrawnCrowd crowd = avatar.crowd();
  const auto differ = [&](double side_pixels) {
    DrawingConfig config = facing(figure().shape, 0.5 / 32 + 0.52 / 32, 0.03, side_pixels);
    config.point_pixels = 0;
    config.view_blend = 0;
    const auto nearest = drawing.draw({&crowd, 1}, config);
    config.view_blend = 0.5;
    const auto blended = drawing.draw({&crowd, 1}, config);
    EXPECT_TRUE(nearest && blended);
    size_t count = 0;
    for (size_t k = 0; k < nearest->rgb.size(); ++k) {
      count += nearest->rgb[k] != blended->rgb[k] ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(differ(23.5), 0U);
  EXPECT_GT(differ(40), 0U);
}

}  // namespace
}  // namespace throng
