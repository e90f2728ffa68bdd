// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "throng/impostor.h"

namespace throng {
namespace {

AtlasConfig small_config() {
  AtlasConfig config;
  config.clips = {"Walk", "Idle"};
  config.frames = 4;
  config.directions = 2;
  config.elevations = 1;
  config.pixels = 16;
  return config;
}

Vec3d place_of(const FigureModel& model, const PosedVertex& v) {
  const Vec3d e = model.high - model.low;
  return model.low + Vec3d{e.x * v.x / 65535, e.y * v.y / 65535, e.z * v.z / 65535};
}

// The octahedron unfolded, as the shader does it.
Vec3d normal_of(const PosedVertex& v) {
  const double x = ((v.normal & 255) - 128) / 127.0, y = ((v.normal >> 8) - 128) / 127.0;
  const double up = 1 - std::fabs(x) - std::fabs(y);
  Vec3d n{x, up, y};
  if (up < 0) {
    n.x = (1 - std::fabs(y)) * (x < 0 ? -1 : 1);
    n.z = (1 - std::fabs(x)) * (y < 0 ? -1 : 1);
  }
  return n * (1 / length(n));
}

TEST(FigureModel, HasTheClipsAndTheSizeOfTheAtlas) {
  Context context;
  const Character character = built_in_character();
  const auto model = create_figure_model(character, small_config(), context);
  ASSERT_TRUE(model) << model.error().message;
  const auto atlas = create_atlas(character, small_config(), context);
  ASSERT_TRUE(atlas);
  ASSERT_EQ(model->clips.size(), atlas->clips.size());
  for (size_t c = 0; c < model->clips.size(); ++c) {
    EXPECT_EQ(model->clips[c].name, atlas->clips[c].name);
    EXPECT_EQ(model->clips[c].stride, atlas->clips[c].stride);
  }
  EXPECT_EQ(model->triangles.size(), character.triangles.size());
  EXPECT_EQ(model->poses.size(), size_t{8} * model->vertices);
  EXPECT_NEAR(model->low.y, 0, 0.02);
  EXPECT_NEAR(model->high.y, 1.75, 0.02);
}

TEST(FigureModel, VerticesAreWhereThePoseHasThem) {
  Context context;
  const Character character = built_in_character();
  const auto model = create_figure_model(character, small_config(), context);
  ASSERT_TRUE(model);
  PosedMesh mesh;
  pose_character(character, 0, character.clips[0].seconds / 4, mesh);  // The walk's second frame.
  // On the spot and scaled: equal but for a shift and a factor, so distances are compared.
  const auto& t0 = character.triangles.front();
  const auto& m0 = model->triangles.front();
  const auto posed = [&](uint32_t v) { return model->poses[model->vertices + v]; };
  const double factor = length(place_of(*model, posed(m0[0])) - place_of(*model, posed(m0[1]))) /
                        length(mesh.positions[t0[0]] - mesh.positions[t0[1]]);
  EXPECT_NEAR(factor, 1, 0.02);  // The figure has the height asked for already.
  double worst = 0, worst_normal = 0;
  const Vec3d from = mesh.positions[t0[0]], there = place_of(*model, posed(m0[0]));
  for (size_t t = 0; t < character.triangles.size(); ++t) {
    for (size_t k = 0; k < 3; ++k) {
      const PosedVertex v = posed(model->triangles[t][k]);
      const uint32_t p = character.triangles[t][k];
      worst = std::max(
          worst, std::fabs(length(place_of(*model, v) - there) - length(mesh.positions[p] - from)));
      worst_normal = std::max(worst_normal, length(normal_of(v) - mesh.normals[p]));
      const ModelPaint& paint = model->paint[model->triangles[t][k]];
      EXPECT_EQ(paint.part, static_cast<uint8_t>(character.materials[character.material[t]].part));
    }
  }
  EXPECT_LT(worst, 0.02);         // The factor again, over a figure's height.
  EXPECT_LT(worst_normal, 0.03);  // Two bytes.
}

TEST(FigureModel, RefusesWhatAnAtlasRefuses) {
  Context context;
  AtlasConfig config = small_config();
  config.frames = 3;
  EXPECT_EQ(create_figure_model(built_in_character(), config, context).error().code,
            Errc::kBadConfig);
  config = small_config();
  config.clips = {"Fly"};
  EXPECT_EQ(create_figure_model(built_in_character(), config, context).error().code,
            Errc::kNotFound);
}

}  // namespace
}  // namespace throng
