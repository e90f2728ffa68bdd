// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "textured_models.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/files/read_file.h"
#include "import/formats/glb.h"
#include "import/formats/texture_reader.h"
#include "throng/scene.h"

namespace throng {
namespace {

Result<Scene> load(const std::string& path) {
  SceneConfig config;
  config.sources.push_back({.path = path, .up = {}, .scale = {}, .transform = {}});
  config.materials = SceneMaterials::kRead;
  Context context;
  return load_scene(config, context);
}

// The texel that a triangle shows at shares a, b, c of its corners.
std::array<uint8_t, 4> texel_at(const Scene& scene, size_t t, const std::array<double, 3>& shares) {
  const ScenePart& part = *std::find_if(scene.parts.begin(), scene.parts.end(), [&](const auto& p) {
    return t >= p.first_triangle && t < p.first_triangle + p.triangle_count;
  });
  const Texture& texture = scene.textures.at(scene.materials.at(part.material1 - 1).texture1 - 1);
  double x = 0, y = 0;
  for (size_t k = 0; k < 3; ++k) {
    x += shares[k] * scene.texture_corners[t][k][0];
    y += shares[k] * scene.texture_corners[t][k][1];
  }
  const auto texel = [](double at, int32_t size) {
    return static_cast<size_t>(std::clamp((at - std::floor(at)) * size, 0.0, size - 1.0));
  };
  const size_t i =
      (texel(y, texture.height) * static_cast<size_t>(texture.width) + texel(x, texture.width)) * 4;
  return {texture.rgba[i], texture.rgba[i + 1], texture.rgba[i + 2], texture.rgba[i + 3]};
}

void expect_quarters(const Result<Scene>& scene) {
  const Texture quarters = test::texture_of_quarters();
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_TRUE(scene->report.warnings.empty()) << scene->report.warnings.front();
  ASSERT_EQ(scene->triangles.size(), 2U);
  ASSERT_EQ(scene->textures.size(), 1U);
  EXPECT_EQ(scene->textures[0].rgba, quarters.rgba);
  ASSERT_EQ(scene->texture_corners.size(), 2U);
  for (size_t t = 0; t < 2; ++t) {
    for (int32_t step = 0; step < 64; ++step) {
      // All over the triangle, never on the line between two texels.
      const double a = (step % 8 + 0.37) / 8, b = (1 - a) * (step / 8 + 0.41) / 8;
      const std::array<double, 3> shares{a, b, 1 - a - b};
      Vec3d p;
      for (size_t k = 0; k < 3; ++k) {
        p = p + scene->positions[scene->triangles[t][k]] * shares[k];
      }
      EXPECT_NEAR(p.z, 0, 1e-6);
      const auto column = static_cast<size_t>((p.x + 2) * 4);
      const auto row = static_cast<size_t>((4 - p.y) * 4);
      ASSERT_LT(std::max(column, row), 16U);
      const auto* wanted = &quarters.rgba[(row * 16 + column) * 4];
      const auto got = texel_at(*scene, t, shares);
      EXPECT_TRUE(std::equal(got.begin(), got.end(), wanted)) << p.x << ' ' << p.y;
    }
  }
}

TEST(TexturedModels, OfEveryFormatHaveTheSameTexelAtTheSamePlace) {
  for (const test::TexturedModel& model : test::textured_models()) {
    SCOPED_TRACE(model.name);
    const test::ScratchFolder folder;
    expect_quarters(load(model.write(folder)));
  }
}

// A browser has only this reader.
TEST(TexturedModels, OurOwnReaderOfGlbAgrees) {
  size_t read = 0;
  for (const test::TexturedModel& model : test::textured_models()) {
    if (!model.name.starts_with("glb")) continue;
    SCOPED_TRACE(model.name);
    const test::ScratchFolder folder;
    const std::string path = model.write(folder);
    const auto bytes = read_file(path);
    ASSERT_TRUE(bytes);
    importer::ReadOptions options;
    options.name = path;
    options.materials = SceneMaterials::kRead;
    Context context;
    auto raw = importer::read_glb(*bytes, options, context);
    ASSERT_TRUE(raw) << raw.error().message;
    ASSERT_TRUE(importer::read_textures(*raw, path, context));
    expect_quarters(std::move(raw->scene));
    ++read;
  }
  EXPECT_EQ(read, 3U);
}

}  // namespace
}  // namespace throng
