// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "throng/impostor.h"
#include "throng_draw/draw.h"

// Parts that avatars exchange, in pictures of every level of detail.
namespace throng {
namespace {

// With and without parts, of the same texels.
struct Figures {
  Atlas bare, dressed;
  Drawing views = *Drawing::create(), meshes = *Drawing::create();
  Figures() {
    Context context;
    AtlasConfig config;
    config.frames = 2;
    const Character character = built_in_character_with_parts();
    dressed = *create_atlas(character, config, context);
    bare = dressed;
    bare.parts.clear();
    bare.views.resize(bare.shape.view(bare.shape.frames, 0, 0));
    const FigureModel model = *create_figure_model(character, config, context);
    FigureModel body = model;
    body.triangles.resize(character.body_triangles());
    body.worn.clear();
    for (Drawing* drawing : {&views, &meshes}) {
      EXPECT_TRUE(drawing->add_atlas(bare));
      EXPECT_TRUE(drawing->add_atlas(dressed));
    }
    EXPECT_TRUE(meshes.set_model(0, body));
    EXPECT_TRUE(meshes.set_model(1, model));
  }
};

Figures& figures() {
  static Figures all;
  return all;
}

// The first look that wears exactly this.
uint32_t look_with(const std::string& name) {
  const std::vector<AtlasPart>& parts = figures().dressed.parts;
  uint32_t wanted = 0;
  for (size_t i = 0; i < parts.size(); ++i) wanted |= parts[i].name == name ? 1U << i : 0;
  uint32_t look = 0;
  while (look < 2048 && worn_by(parts, look) != wanted) ++look;
  EXPECT_LT(look, 2048U) << name;
  return look;
}

struct Shot {
  double distance = 4;
  bool mesh = false, leans = false;
  double blend = 0.4;
};

// One avatar that walks across the picture. `dressed`: by the atlas and the model with parts.
Image picture_of(uint32_t look, bool dressed, const Shot& shot, double heading = 0.25) {
  Drawing& drawing = shot.mesh ? figures().meshes : figures().views;
  const float zero = 0;
  const auto turned = static_cast<uint16_t>(heading * 65536), phase = uint16_t{9000},
             number = static_cast<uint16_t>(look);
  const Vec3d up{0, 1, 0};
  DrawnCrowd crowd{
      .atlas = dressed ? 1U : 0U,
      .clip = 0,
      .avatars = {{&zero, 1}, {&zero, 1}, {&zero, 1}, {&turned, 1}, {&phase, 1}, {&number, 1}}};
  if (shot.leans) crowd.up_vectors = {&up, 1};
  DrawingConfig config;
  config.width = 320, config.height = 240;
  config.samples = 1;
  config.avatar_shadows = false;
  config.view_blend = shot.blend;
  config.point_pixels = 0;
  config.camera.eye = {0, 1.2, shot.distance};
  config.camera.target = {0, 0.9, 0};
  DrawingReport report;
  auto image = drawing.draw({&crowd, 1}, config, &report);
  EXPECT_TRUE(image);
  EXPECT_EQ(report.drawn, 1U);
  return *std::move(image);
}

struct Difference {
  int32_t pixels = 0, top = 1 << 20, bottom = -1;
};

Difference between(const Image& a, const Image& b) {
  Difference out;
  for (int32_t i = 0; i < a.width * a.height; ++i) {
    if (std::equal(&a.rgb[size_t{3} * i], &a.rgb[size_t{3} * i] + 3, &b.rgb[size_t{3} * i]))
      continue;
    ++out.pixels;
    out.top = std::min(out.top, i / a.width);
    out.bottom = std::max(out.bottom, i / a.width);
  }
  return out;
}

constexpr Shot kShots[] = {{.distance = 3},
                           {.distance = 3, .blend = 0},
                           {.distance = 10},
                           {.distance = 3, .mesh = true},
                           {.distance = 3, .leans = true}};

TEST(GlWornParts, AnAvatarThatWearsNothingLooksAsItsBody) {
  const uint32_t look = look_with("");
  for (const Shot& shot : kShots) {
    EXPECT_EQ(between(picture_of(look, true, shot), picture_of(look, false, shot)).pixels, 0)
        << shot.distance << shot.mesh;
  }
}

// Of a figure of 1.75 m: between which shares of its height a part may show.
TEST(GlWornParts, EachPartIsDrawnWhereItIsWornAtEveryLevelOfDetail) {
  struct Where {
    const char* name;
    double low, high;
  };
  for (const Where& part :
       {Where{"long hair", 0.74, 1.02}, Where{"hat", 0.93, 1.06}, Where{"cap", 0.93, 1.04},
        Where{"coat", 0.38, 0.90}, Where{"rucksack", 0.57, 0.84}, Where{"skirt", 0.27, 0.62}}) {
    const uint32_t look = look_with(part.name);
    for (const Shot& shot : kShots) {
      const Image with = picture_of(look, true, shot), without = picture_of(look, false, shot);
      const Difference found = between(with, without);
      const double metre = 120 / (std::tan(0.4) * shot.distance);  // [px]
      EXPECT_GT(found.pixels, 3 * metre * metre / 1000) << part.name << " at " << shot.distance;
      // The eye is 1.2 m high and looks at 0.9 m: rows of both heights follow from the middle.
      const double slope = (1.2 - 0.9) / shot.distance;
      const auto row_of = [&](double height) {
        const double down = (1.2 - height) / shot.distance;
        return 120 + 120 / std::tan(0.4) * (down - slope) / (1 + down * slope);
      };
      const double margin = 2 + 0.05 * metre;
      EXPECT_GT(found.top, row_of(1.75 * part.high) - margin) << part.name << " " << shot.distance;
      EXPECT_LT(found.bottom, row_of(1.75 * part.low) + margin)
          << part.name << " " << shot.distance;
    }
  }
}

// A rucksack is behind its avatar: from the front it shows beside the arms at most.
TEST(GlWornParts, TheBodyHidesARucksackFromTheFront) {
  const uint32_t look = look_with("rucksack");
  const Shot shot{.distance = 3, .blend = 0};
  const auto seen = [&](double heading) {
    return between(picture_of(look, true, shot, heading), picture_of(look, false, shot, heading))
        .pixels;
  };
  EXPECT_LT(10 * seen(0.02), seen(0.52));
}

// As a point it has the colours of what it wears.
TEST(GlWornParts, PointsHaveTheirColours) {
  Shot far{.distance = 60};
  const auto colours = [&](uint32_t look, bool dressed) {
    const float zero = 0;
    const uint16_t turned = 0, number = static_cast<uint16_t>(look);
    const DrawnCrowd crowd{
        .atlas = dressed ? 1U : 0U,
        .clip = 0,
        .avatars = {{&zero, 1}, {&zero, 1}, {&zero, 1}, {&turned, 1}, {&turned, 1}, {&number, 1}}};
    DrawingConfig config;
    config.width = 320, config.height = 240;
    config.avatar_shadows = false;
    config.camera.eye = {0, 1.2, far.distance};
    return figures().views.draw({&crowd, 1}, config)->rgb;
  };
  EXPECT_EQ(colours(look_with(""), true), colours(look_with(""), false));
  EXPECT_NE(colours(look_with("coat"), true), colours(look_with("coat"), false));
}

}  // namespace
}  // namespace throng
