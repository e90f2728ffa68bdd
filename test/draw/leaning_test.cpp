// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "draw/leaning_avatars.h"
#include "throng/avatar.h"
#include "throng/impostor.h"
#include "throng_draw/draw.h"

namespace throng {
namespace {

constexpr int32_t kSide = 240;  // [px]

// One figure, with a mesh or without.
class Figure {
 public:
  explicit Figure(bool mesh) : drawing_(*Drawing::create()) {
    Context context;
    AtlasConfig config;
    config.clips = {"Walk"};
    auto atlas = create_atlas(built_in_character(), config, context);
    EXPECT_TRUE(atlas);
    atlas_ = *std::move(atlas);
    EXPECT_TRUE(drawing_.add_atlas(atlas_));
    if (!mesh) return;
    config.frames = 24;
    const auto model = create_figure_model(built_in_character(), config, context);
    EXPECT_TRUE(model);
    EXPECT_TRUE(drawing_.set_model(0, *model));
  }
  [[nodiscard]] double centre() const { return atlas_.shape.centre; }
  Drawing& drawing() { return drawing_; }

  // At the origin, with a heading [turns], along `ups`; if empty, drawn as an upright avatar.
  DrawingReport draw(const DrawingConfig& config, double heading, std::span<const Vec3d> ups,
                     Image& image) {
    const std::vector<float> zero{0};
    const std::vector<uint16_t> turn{static_cast<uint16_t>(heading * 65536)}, phase{9000}, look{7};
    const DrawnCrowd crowd{
        .atlas = 0, .clip = 0, .avatars = {zero, zero, zero, turn, phase, look}, .up_vectors = ups};
    DrawingReport report;
    auto drawn = drawing_.draw({&crowd, 1}, config, &report);
    EXPECT_TRUE(drawn) << drawn.error().message;
    image = *std::move(drawn);
    return report;
  }

 private:
  Atlas atlas_;
  Drawing drawing_;
};

DrawingConfig looking(Vec3d eye, Vec3d target) {
  DrawingConfig config;
  config.width = config.height = kSide;
  config.samples = 1;
  config.avatar_shadows = false;
  config.view_blend = 0;
  config.camera.eye = eye;
  config.camera.target = target;
  config.camera.field_of_view = 0.5;
  return config;
}

// Which pixels a picture has that another has not.
std::vector<uint8_t> mask_of(const Image& image, const Image& empty) {
  std::vector<uint8_t> mask(image.rgb.size() / 3);
  for (size_t i = 0; i < mask.size(); ++i) {
    int32_t off = 0;
    for (size_t c = 0; c < 3; ++c) off += std::abs(image.rgb[3 * i + c] - empty.rgb[3 * i + c]);
    mask[i] = off > 12 ? 1 : 0;
  }
  return mask;
}

std::vector<uint8_t> drawn(Figure& figure, const DrawingConfig& config, double heading,
                           std::span<const Vec3d> ups) {
  Image image;
  EXPECT_EQ(figure.draw(config, heading, ups, image).drawn, 1U);
  const auto empty = figure.drawing().draw({}, config);
  EXPECT_TRUE(empty);
  return mask_of(image, *empty);
}

size_t count(const std::vector<uint8_t>& mask) {
  return static_cast<size_t>(std::count(mask.begin(), mask.end(), 1));
}

// The least turn from up to +X is one by a right angle around -Z: an eye along Z sees the upright
// figure's picture, turned.
TEST(GlLeaning, ALeaningAvatarLooksLikeAnUprightOneTurned) {
  for (const bool mesh : {false, true}) {
    Figure figure(mesh);
    const double c = figure.centre();
    for (const double heading : {0.05, 0.3, 0.6, 0.9}) {
      const auto stands = drawn(figure, looking({0, c, 6}, {0, c, 0}), heading, {});
      const Vec3d up{1, 0, 0};
      const auto leans = drawn(figure, looking({c, 0, 6}, {c, 0, 0}), heading, {&up, 1});
      size_t differ = 0;
      for (int32_t y = 0; y < kSide; ++y) {
        for (int32_t x = 0; x < kSide; ++x) {
          // Up in one is right in the other.
          const auto at = [](int32_t column, int32_t row) {
            return static_cast<size_t>(row * kSide + column);
          };
          differ += stands[at(x, y)] != leans[at(kSide - 1 - y, x)] ? 1 : 0;
        }
      }
      EXPECT_GT(count(stands), 2000U);
      EXPECT_LT(differ * 12, count(stands)) << mesh << ' ' << heading << ": " << differ;
    }
  }
}

// With an axis straight up the picture is that without an axis, from any eye.
TEST(GlLeaning, AnAvatarWithAnUprightAxisIsDrawnAsWithoutOne) {
  for (const bool mesh : {false, true}) {
    Figure figure(mesh);
    const double c = figure.centre();
    const Vec3d up{0, 1, 0};
    for (const Vec3d from : {Vec3d{3, 0.2, 5}, Vec3d{-4, 4, 1}, Vec3d{0.1, 7, -0.2}}) {
      DrawingConfig config = looking(Vec3d{0, c, 0} + from, {0, c, 0});
      config.avatar_shadows = true;
      Image without, with;
      figure.draw(config, 0.2, {}, without);
      figure.draw(config, 0.2, {&up, 1}, with);
      size_t differ = 0;
      for (size_t i = 0; i < with.rgb.size(); ++i) {
        differ += std::abs(with.rgb[i] - without.rgb[i]) > 4 ? 1 : 0;
      }
      EXPECT_LT(differ, with.rgb.size() / 2000) << mesh;
    }
  }
}

// Where a figure's pixels reach, seen along Z with the feet in the middle. [m]
struct Reach {
  double left = 0, right = 0, down = 0, up = 0;
};
Reach reach_of(const std::vector<uint8_t>& mask, double metres_high) {
  Reach reach;
  for (int32_t y = 0; y < kSide; ++y) {
    for (int32_t x = 0; x < kSide; ++x) {
      if (mask[static_cast<size_t>(y * kSide + x)] == 0) continue;
      const double pixel = metres_high / kSide;
      const double right = (x + 0.5 - kSide / 2.0) * pixel, up = (kSide / 2.0 - y - 0.5) * pixel;
      reach.left = std::min(reach.left, right);
      reach.right = std::max(reach.right, right);
      reach.down = std::min(reach.down, up);
      reach.up = std::max(reach.up, up);
    }
  }
  return reach;
}

// A wall that faces +X, one that faces -X, a slope, a ceiling: figures reach away from them.
TEST(GlLeaning, AnAvatarOnAWallExtendsAwayFromItAndNotUp) {
  for (const bool mesh : {false, true}) {
    Figure figure(mesh);
    DrawingConfig config = looking({0, 0, 10}, {0, 0, 0});
    const double high = 2 * 10 * std::tan(0.25);
    const auto reach = [&](Vec3d up) {
      return reach_of(drawn(figure, config, 0.1, {&up, 1}), high);
    };
    const double tall = 1.6, wide = 0.6;
    const Reach east = reach({1, 0, 0}), west = reach({-1, 0, 0}), below = reach({0, -1, 0});
    EXPECT_GT(east.right, tall);
    EXPECT_LT(east.up, wide);
    EXPECT_GT(east.left, -0.2);
    EXPECT_LT(west.left, -tall);
    EXPECT_LT(west.up, wide);
    EXPECT_LT(west.right, 0.2);
    EXPECT_LT(below.down, -tall);
    EXPECT_LT(below.up, 0.2);
    const double r = std::sqrt(0.5);
    const Reach slope = reach({r, r, 0});
    EXPECT_GT(slope.right, tall * r - 0.1);
    EXPECT_GT(slope.up, tall * r - 0.1);
    EXPECT_LT(slope.up, 1.75);
    // Towards the eye and away from it: a head or soles.
    for (const double z : {1.0, -1.0}) {
      const Reach end = reach({0, 0, z});
      EXPECT_LT(std::max({-end.left, end.right, end.up, -end.down}), 1.0) << z;
    }
  }
}

// The sun straight above: an avatar on a wall casts a long shadow on the ground below, an upright
// one a short shadow.
TEST(GlLeaning, ALeaningAvatarCastsItsOwnShadow) {
  Figure figure(false);
  Scene ground;
  ground.add_quad({-9, -3, -9}, {-9, -3, 9}, {9, -3, 9}, {9, -3, -9});
  ASSERT_TRUE(figure.drawing().set_scene(ground, {}));
  DrawingConfig config = looking({8, 20, 0}, {0, -3, 0});
  config.to_sun = {0, 1, 0.001};
  config.culling = HiddenCulling::kNever;
  const auto shadow = [&](Vec3d up) {
    Image with, without;
    config.avatar_shadows = true;
    figure.draw(config, 0, {&up, 1}, with);
    config.avatar_shadows = false;
    figure.draw(config, 0, {&up, 1}, without);
    return count(mask_of(with, without));
  };
  EXPECT_GT(shadow({1, 0, 0}), 2 * shadow({0, 1, 0}));
}

// An avatar whose middle is in the picture is drawn; one well outside is not.
TEST(GlLeaning, OnlyAvatarsOutsideThePictureAreLeftOut) {
  Context context;
  AtlasConfig made;
  const auto atlas = create_atlas(built_in_character(), made, context);
  ASSERT_TRUE(atlas);
  std::vector<float> x, y, z;
  std::vector<uint16_t> heading, phase, look;
  std::vector<Vec3d> ups;
  for (int32_t i = 0; i < 4000; ++i) {
    const auto at = [&](double k) { return std::fmod(i * k, 1.0) * 60 - 30; };
    x.push_back(static_cast<float>(at(0.618)));
    y.push_back(static_cast<float>(at(0.755)));
    z.push_back(static_cast<float>(at(0.570)));
    heading.push_back(static_cast<uint16_t>(i * 999));
    phase.push_back(static_cast<uint16_t>(i * 77));
    look.push_back(static_cast<uint16_t>(i % 2048));
    const Vec3d up{at(0.33), at(0.21), at(0.87)};
    ups.push_back(up * (1 / length(up)));
  }
  const DrawnCrowd crowd{
      .atlas = 0, .clip = 0, .avatars = {x, y, z, heading, phase, look}, .up_vectors = ups};
  EyeCamera camera{.eye = {3, 5, 20}, .target = {-2, 1, -4}, .field_of_view = 0.7, .aspect = 1.5};
  std::vector<draw::LeaningInstance> views(x.size());
  const LevelCounts counts = draw::pack_leaning(
      *atlas, crowd, {.camera = camera, .from_direction = {}}, {}, {.meshes = {}, .views = views});
  const CameraAxes axes = camera_axes(camera);
  const double slope = std::tan(0.35), reach = 0.5 * atlas->shape.side;
  size_t next = 0, inside = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const bool packed = next < counts.views && views[next].body.x == x[i] &&
                        views[next].body.y == y[i] && views[next].body.z == z[i];
    next += packed ? 1 : 0;
    const Vec3d from = Vec3d{x[i], y[i], z[i]} + ups[i] * atlas->shape.centre - camera.eye;
    const double depth = dot(from, axes.forward);
    const double right = std::fabs(dot(from, axes.right)), up = std::fabs(dot(from, axes.up));
    const bool seen = depth > 0 && right < depth * slope * 1.5 && up < depth * slope;
    const bool far = right > (depth + 2 * reach) * slope * 1.5 + 2 * reach || depth < -reach;
    EXPECT_TRUE(packed || !seen) << i;
    EXPECT_FALSE(packed && far) << i;
    inside += seen ? 1 : 0;
  }
  EXPECT_EQ(next, counts.views);
  EXPECT_GT(inside, 100U);
}

}  // namespace
}  // namespace throng
