// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "draw/texture_layers.h"
#include "golden_image.h"
#include "scratch_folder.h"
#include "textured_models.h"
#include "throng/scene.h"
#include "throng_draw/draw.h"

namespace throng {
namespace {

using Texel = std::array<uint8_t, 4>;

// Sixteen texels a side in four quarters: red, green; blue, and nothing at all.
Texture quarters() {
  Texture out{.name = "quarters", .width = 16, .height = 16, .rgba = {}};
  for (int32_t i = 0; i < 256; ++i) {
    const bool right = i % 16 >= 8, low = i / 16 >= 8;
    const Texel texel = right ? low ? Texel{255, 255, 255, 0} : Texel{0, 200, 0, 255}
                        : low ? Texel{0, 0, 220, 255}
                              : Texel{220, 0, 0, 255};
    out.rgba.insert(out.rgba.end(), texel.begin(), texel.end());
  }
  return out;
}

// An upright square of 4 m that faces +z, with the texture on it once, before a yellow wall.
Scene sign(Opacity opacity) {
  Scene scene;
  scene.add_quad({-2, 0, 0}, {2, 0, 0}, {2, 4, 0}, {-2, 4, 0});
  scene.add_quad({-6, 0, -3}, {6, 0, -3}, {6, 6, -3}, {-6, 6, -3});
  scene.textures = {quarters()};
  scene.materials = {{.name = "sign", .texture1 = 1, .opacity = opacity},
                     {.name = "wall", .colour = {0.8F, 0.7F, 0.05F, 1}}};
  scene.parts = {{.file = {},
                  .node = {},
                  .material = {},
                  .first_triangle = 0,
                  .triangle_count = 2,
                  .material1 = 1},
                 {.file = {},
                  .node = {},
                  .material = {},
                  .first_triangle = 2,
                  .triangle_count = 2,
                  .material1 = 2}};
  const std::array<std::array<float, 2>, 4> at{{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  for (const auto& corner : scene.triangles) {
    TextureCorners& places = scene.texture_corners.emplace_back();
    for (size_t k = 0; k < 3; ++k) places[k] = at[corner[k] % 4];
  }
  return scene;
}

DrawingConfig before_sign() {
  DrawingConfig config;
  config.width = 160;
  config.height = 120;
  config.camera.eye = {0.4, 2.4, 8};
  config.camera.target = {0, 2, 0};
  config.culling = HiddenCulling::kNever;
  return config;
}

Image picture_of(const Scene& scene, const DrawingConfig& config) {
  Result<Drawing> drawing = Drawing::create();
  EXPECT_TRUE(drawing) << drawing.error().message;
  EXPECT_TRUE(drawing->set_scene(scene, {}));
  auto image = drawing->draw({}, config);
  EXPECT_TRUE(image) << image.error().message;
  return *std::move(image);
}

std::array<int, 3> pixel(const Image& image, int32_t x, int32_t y) {
  const size_t i =
      (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x)) * 3;
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

// The picture is simple, and may be off by less than others.
void expect_golden(const Image& image, const std::string& name) {
  test::expect_golden(image, THRONG_TEST_DATA "/" + name, {.mean = 0.05});
}

constexpr int32_t kLeft = 60, kRight = 98, kHigh = 40, kLow = 80;  // Pixels of the quarters.

TEST(GlSurfaces, ATexturedQuadLooksAsItDid) {
  const Image image = picture_of(sign(Opacity::kOpaque), before_sign());
  const auto red = pixel(image, kLeft, kHigh), green = pixel(image, kRight, kHigh);
  const auto blue = pixel(image, kLeft, kLow), white = pixel(image, kRight, kLow);
  EXPECT_GT(red[0], 2 * red[1]);
  EXPECT_GT(green[1], 2 * green[0]);
  EXPECT_GT(blue[2], 2 * blue[1]);
  // An opaque material does not ask how opaque its texture is.
  EXPECT_LT(std::abs(white[0] - white[2]), 60);
  EXPECT_GT(white[2], 100);
  expect_golden(image, "textured.png");
}

TEST(GlSurfaces, TexturedModelsOfEveryFormatLookTheSame) {
  std::vector<uint8_t> first;
  for (const test::TexturedModel& model : test::textured_models()) {
    SCOPED_TRACE(model.name);
    const test::ScratchFolder folder;
    SceneConfig load;
    load.sources.push_back({.path = model.write(folder), .up = {}, .scale = {}, .transform = {}});
    load.materials = SceneMaterials::kRead;
    Context context;
    const auto scene = load_scene(load, context);
    ASSERT_TRUE(scene) << scene.error().message;
    const Image image = picture_of(*scene, before_sign());
    const auto red = pixel(image, kLeft, kHigh), green = pixel(image, kRight, kHigh);
    const auto blue = pixel(image, kLeft, kLow), white = pixel(image, kRight, kLow);
    EXPECT_GT(red[0], 2 * std::max(red[1], red[2]));
    EXPECT_GT(green[1], 2 * std::max(green[0], green[2]));
    EXPECT_GT(blue[2], 2 * std::max(blue[0], blue[1]));
    EXPECT_GT(std::min({white[0], white[1], white[2]}), 150);
    // The same square, but for how each format splits it and how its numbers are rounded.
    if (first.empty()) first = image.rgb;
    int64_t differences = 0;
    for (size_t i = 0; i < first.size(); ++i) differences += std::abs(first[i] - image.rgb[i]);
    EXPECT_LT(static_cast<double>(differences) / static_cast<double>(first.size()), 0.2);
    const char* pictures = std::getenv("THRONG_TEST_PICTURES");
    if (pictures == nullptr) continue;
    EXPECT_TRUE(write_png(image, std::string(pictures) + "/" + model.name + ".png"));
  }
}

TEST(GlSurfaces, HolesShowWhatIsBehindThemAndLetTheSunThrough) {
  const Image image = picture_of(sign(Opacity::kHoles), before_sign());
  const auto green = pixel(image, kRight, kHigh), hole = pixel(image, kRight, kLow);
  EXPECT_GT(green[1], 2 * green[0]);
  EXPECT_GT(hole[0], 2 * hole[2]);  // The yellow wall.
  expect_golden(image, "holes.png");
  // Its shadow on the wall beside it has the hole, too.
  DrawingConfig config = before_sign();
  config.to_sun = {-0.6, 0.05, 0.6};
  const auto light = [&](Opacity opacity) {
    const Image of = picture_of(sign(opacity), config);
    int64_t sum = 0;
    for (int32_t y = 62; y < 80; ++y) {
      for (int32_t x = 122; x < 138; ++x) sum += pixel(of, x, y)[0];
    }
    return sum;
  };
  EXPECT_GT(2 * light(Opacity::kHoles), 3 * light(Opacity::kOpaque));
}

TEST(GlSurfaces, ABlendedSurfaceLetsLightThroughByItsTransparency) {
  Scene scene = sign(Opacity::kBlended);
  scene.materials[0] = {
      .name = "pane", .colour = {0, 0, 1, 0.5F}, .texture1 = 0, .opacity = Opacity::kBlended};
  const Image image = picture_of(scene, before_sign());
  int64_t red = 0, blue = 0;
  for (int32_t y = kHigh; y < kHigh + 16; ++y) {
    for (int32_t x = kLeft; x < kLeft + 16; ++x) {
      red += pixel(image, x, y)[0];
      blue += pixel(image, x, y)[2];
    }
  }
  EXPECT_GT(red, 256 * 60);   // Of the wall.
  EXPECT_GT(blue, 256 * 60);  // Of the pane.
}

TEST(GlSurfaces, CullingChangesNoByteOfAPictureWithHoles) {
  Scene scene = sign(Opacity::kHoles);
  for (int32_t i = 0; i < 12000; ++i) {
    const double x = i % 110 * 0.1 - 5.5, y = i / 110 * 0.05;
    scene.add_triangle({x, y, -2.5}, {x + 0.08, y, -2.5}, {x, y + 0.04, -2.5});
  }
  scene.texture_corners.resize(scene.triangles.size());
  DrawingConfig config = before_sign();
  const Image whole = picture_of(scene, config);
  config.culling = HiddenCulling::kAlways;
  EXPECT_EQ(picture_of(scene, config).rgb, whole.rgb);
}

TEST(TextureLayers, AreOfOneSizeWithinTheBudget) {
  Scene scene = sign(Opacity::kOpaque);
  draw::TextureLayers layers = draw::make_texture_layers(scene, 1 << 20);
  EXPECT_EQ(layers.side, 16);
  EXPECT_EQ(layers.layers, 1);
  ASSERT_EQ(layers.levels.size(), 5U);
  EXPECT_EQ(layers.levels[0], quarters().rgba);
  // Of two by two texels; what is see-through keeps its own colour to itself.
  const std::vector<uint8_t> small{220, 0, 0,   255, 0,   200, 0,   255,
                                   0,   0, 220, 255, 255, 255, 255, 0};
  EXPECT_EQ(layers.levels[3], small);
  EXPECT_EQ(layers.levels[4].size(), 4U);
  EXPECT_EQ(layers.levels[4][3], 191);

  Texture large{.name = "large", .width = 300, .height = 5, .rgba = {}};
  large.rgba.assign(size_t{300} * 5 * 4, 77);
  scene.textures.push_back(large);
  EXPECT_EQ(draw::make_texture_layers(scene, 1 << 30).layers, 1);  // No part uses the other.
  scene.materials[1].texture1 = 2;
  layers = draw::make_texture_layers(scene, 1 << 30);
  EXPECT_EQ(layers.side, 512);
  EXPECT_EQ(layers.layers, 2);
  EXPECT_EQ(layers.levels[0].back(), 77);
  EXPECT_EQ(draw::make_texture_layers(scene, 2 * 64 * 64 * 4).side, 64);
  EXPECT_EQ(draw::make_texture_layers(scene, 0).side, 16);

  scene.textures[1].rgba.clear();  // Not of its size.
  layers = draw::make_texture_layers(scene, 1 << 30);
  EXPECT_EQ(layers.layers, 1);
  EXPECT_EQ(layers.of_texture[1].layer1, 0U);
}

TEST(TextureLayers, MoreTexturesThanLayersGiveTheirMeans) {
  Scene scene = sign(Opacity::kOpaque);
  for (size_t i = 0; i < draw::kMaxLayers; ++i) {
    scene.textures.push_back(quarters());
    scene.materials.push_back(
        {.name = {}, .texture1 = static_cast<uint32_t>(scene.textures.size())});
    scene.parts.push_back({.file = {},
                           .node = {},
                           .material = {},
                           .first_triangle = 4,
                           .material1 = static_cast<uint32_t>(scene.materials.size())});
  }
  const draw::TextureLayers layers = draw::make_texture_layers(scene, 64 << 20);
  EXPECT_EQ(layers.layers, static_cast<int32_t>(draw::kMaxLayers));
  EXPECT_EQ(layers.of_texture.back().layer1, 0U);
  EXPECT_EQ(layers.of_texture.back().mean[3], 191);
  EXPECT_LT(layers.of_texture.back().mean[0], 140);
}

}  // namespace
}  // namespace throng
