// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/random.h"
#include "draw/depth_pyramid.h"
#include "draw/scene_chunks.h"
#include "throng/impostor.h"
#include "throng/scene.h"
#include "throng_draw/draw.h"

namespace throng {
namespace {

// The blocks of a picture, one by one.
TEST(DepthPyramid, HidesWhatEverySampleOfItsRectangleIsInFrontOf) {
  constexpr int32_t kWidth = 200, kHeight = 120, kWide = 25, kHigh = 15;
  size_t hidden = 0, asked = 0;
  for (uint64_t n = 0; n < 40; ++n) {
    std::vector<float> blocks(size_t{kWide} * kHigh);
    for (size_t i = 0; i < blocks.size(); ++i) {
      // Mostly near, some far, one block of sky.
      blocks[i] = static_cast<float>(0.2 + 0.3 * random_unit(n, i, 0));
      if (i == random_below(n, 0, 1, blocks.size())) blocks[i] = 1;
    }
    draw::DepthPyramid pyramid;
    pyramid.set(blocks, kWidth, kHeight);
    for (uint64_t k = 0; k < 500; ++k, ++asked) {
      const auto at = [&](uint64_t j) { return random_unit(n, k, j) * 2.4 - 1.2; };
      const double x = at(2), y = at(3), size = std::pow(random_unit(n, k, 4), 3);
      const draw::NdcBox box{x - size, x + size, y - size, y + size, random_unit(n, k, 5) * 2 - 1};
      bool all = true, any = false;
      for (int32_t sy = 0; sy < kHeight; ++sy) {
        for (int32_t sx = 0; sx < kWidth; ++sx) {
          const double px = (sx + 0.5) / kWidth * 2 - 1, py = (sy + 0.5) / kHeight * 2 - 1;
          if (px < box.left || px > box.right || py < box.low || py > box.high) continue;
          any = true;
          const float depth = blocks[static_cast<size_t>(sy / 8 * kWide + sx / 8)];
          all = all && depth < box.nearest * 0.5 + 0.5;
        }
      }
      if (pyramid.hides(box)) {
        ++hidden;
        EXPECT_TRUE(all) << n << ' ' << k;
      }
      // A rectangle that nothing hides by far is not hidden either.
      if (any && box.nearest < -0.7) {
        EXPECT_FALSE(pyramid.hides(box));
      }
    }
  }
  EXPECT_GT(hidden, asked / 20);
}

// Everywhere: on the ground, inside of buildings, in the air, beside walls.
struct Avatars {
  std::vector<float> x, y, z;
  std::vector<uint16_t> heading, phase, look;
  Avatars(const Box3d& box, size_t count) {
    for (size_t i = 0; i < count; ++i) {
      const auto in = [&](double low, double high, uint64_t k) {
        return low + (high - low) * random_unit(11, i, k);
      };
      x.push_back(static_cast<float>(in(box.min.x, box.max.x, 0)));
      y.push_back(i % 4 != 0 ? static_cast<float>(box.min.y)
                             : static_cast<float>(in(box.min.y, box.max.y, 1)));
      z.push_back(static_cast<float>(in(box.min.z, box.max.z, 2)));
      heading.push_back(static_cast<uint16_t>(random_u64(11, i, 3)));
      phase.push_back(static_cast<uint16_t>(random_u64(11, i, 4)));
      look.push_back(static_cast<uint16_t>(random_below(11, i, 5, 2048)));
    }
  }
  [[nodiscard]] DrawnCrowd crowd() const {
    return {.atlas = 0, .clip = 0, .avatars = {x, y, z, heading, phase, look}};
  }
};

struct Tally {
  size_t pictures = 0, wrong_pixels = 0, drawn = 0, hidden = 0, triangles = 0, all_triangles = 0;
};

// Random eyes, half of them at the height of a street or a storey.
Tally compare(const std::string& name, const Result<Scene>& scene, size_t avatars, uint64_t eyes) {
  Tally tally;
  if (const char* more = std::getenv("THRONG_EYES")) eyes = std::strtoull(more, nullptr, 10);
  EXPECT_TRUE(scene) << scene.error().message;
  auto drawing = Drawing::create();
  EXPECT_TRUE(drawing) << drawing.error().message;
  Context context;
  AtlasConfig atlas_config;
  atlas_config.frames = 2;
  const auto atlas = create_atlas(built_in_character_with_parts(), atlas_config, context);
  EXPECT_TRUE(drawing->add_atlas(*atlas));
  const auto model = create_figure_model(built_in_character_with_parts(), atlas_config, context);
  EXPECT_TRUE(drawing->set_model(0, *model));
  const Box3d box = scene->bounds();
  EXPECT_TRUE(drawing->set_scene(*scene, {}));
  const Avatars people(box, avatars);
  const DrawnCrowd crowd = people.crowd();
  for (uint64_t n = 0; n < eyes; ++n) {
    const auto at = [&](uint64_t k) { return random_unit(31, n, k); };
    DrawingConfig config;
    config.width = 320, config.height = 180;
    config.samples = n % 3 == 0 ? 2 : 1;
    config.sun_pixels = 256;
    config.avatar_shadows = n % 5 == 0;
    config.camera.eye = {box.min.x + at(0) * (box.max.x - box.min.x),
                         n % 2 == 0 ? box.min.y + 1.7 : box.min.y + at(1) * 40,
                         box.min.z + at(2) * (box.max.z - box.min.z)};
    config.camera.target =
        config.camera.eye + Vec3d{at(3) - 0.5, (at(4) - 0.5) * 0.4, at(5) - 0.5} * 20.0;
    config.camera.field_of_view = n % 4 == 0 ? 1.4 : 0.8;
    config.avatars = n % 6 == 5 ? AvatarStyle::kPlainQuads : AvatarStyle::kPeople;
    if (n % 7 == 3) config.cut_height = box.min.y + 4;
    if (n % 8 == 6) config.point_pixels = 100;
    DrawingReport all, culled;
    config.culling = HiddenCulling::kNever;
    const auto whole = drawing->draw({&crowd, 1}, config, &all);
    config.culling = HiddenCulling::kAlways;
    const auto part = drawing->draw({&crowd, 1}, config, &culled);
    EXPECT_TRUE(whole && part);
    for (size_t i = 0; i < whole->rgb.size(); i += 3) {
      tally.wrong_pixels += whole->rgb[i] != part->rgb[i] ||
                            whole->rgb[i + 1] != part->rgb[i + 1] ||
                            whole->rgb[i + 2] != part->rgb[i + 2];
    }
    EXPECT_EQ(all.drawn, culled.drawn + culled.hidden);
    EXPECT_EQ(all.hidden, 0U);
    ++tally.pictures;
    tally.drawn += all.drawn;
    tally.hidden += culled.hidden;
    tally.triangles += culled.triangles;
    tally.all_triangles += all.triangles;
  }
  std::printf(
      "%s: %zu pictures, %zu wrong pixels; of %zu avatars %zu hidden; %zu of %zu triangles\n",
      name.c_str(), tally.pictures, tally.wrong_pixels, tally.drawn, tally.hidden, tally.triangles,
      tally.all_triangles);
  return tally;
}

TEST(HiddenCulling, LeavesNothingOutThatAPictureOfACityShows) {
  const Tally tally =
      compare("city", create_builtin_world({.name = "city", .triangles = 60'000}), 3000, 24);
  EXPECT_EQ(tally.wrong_pixels, 0U);
  EXPECT_GT(tally.hidden, tally.drawn / 4);
  EXPECT_LT(tally.triangles, tally.all_triangles);
}

TEST(HiddenCulling, LeavesNothingOutThatAPictureOfAGarageShows) {
  const Tally tally = compare("garage", create_builtin_world({.name = "garage"}), 2000, 24);
  EXPECT_EQ(tally.wrong_pixels, 0U);
  EXPECT_GT(tally.hidden, tally.drawn / 4);
}

TEST(HiddenCulling, LeavesNothingOutThatAPictureOfARealCityShows) {
  const std::string path = THRONG_SHARED_WORLDS "/cities/denhaag_01.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  Context context;
  SceneConfig config;
  config.sources.emplace_back().path = path;
  config.sources.back().up = 'z';
  const auto scene = load_scene(config, context);
  const Tally tally = compare("denhaag_01", scene, 4000, 12);
  EXPECT_EQ(tally.wrong_pixels, 0U);
  EXPECT_GT(tally.hidden, tally.drawn / 10);
}

TEST(SceneChunks, HoldEachTriangleOnceAndLeaveOutOnlyWhatIsNotInThePicture) {
  const auto scene = create_builtin_world({.name = "city", .triangles = 30'000});
  ASSERT_TRUE(scene);
  auto corners = draw::scene_corners(*scene, {});
  ASSERT_TRUE(corners);
  const auto key = [](const draw::SceneCorner& c) { return std::pair(c.position, c.normal); };
  std::vector<std::pair<std::array<float, 3>, std::array<int8_t, 3>>> before, after;
  for (const draw::SceneCorner& c : corners->corners) before.push_back(key(c));
  draw::sort_into_chunks(*corners);
  for (const draw::SceneCorner& c : corners->corners) after.push_back(key(c));
  uint32_t next = 0;
  for (const draw::SceneChunk& chunk : corners->chunks) {
    EXPECT_EQ(chunk.first, next);
    EXPECT_EQ(chunk.count % 3, 0U);
    next += chunk.count;
  }
  EXPECT_EQ(next, corners->corners.size());
  EXPECT_GT(corners->chunks.size(), 5U);
  size_t all_left_out = 0;
  for (uint64_t n = 0; n < 20; ++n) {
    EyeCamera camera;
    camera.eye = {random_unit(3, n, 0) * 200, random_unit(3, n, 1) * 60,
                  random_unit(3, n, 2) * 200};
    camera.target =
        camera.eye + Vec3d{random_unit(3, n, 3) - 0.5, -0.1, random_unit(3, n, 4) - 0.5};
    const draw::Matrix m = draw::perspective(camera);
    std::vector<uint8_t> kept(corners->chunks.size());
    for (const uint32_t i : draw::chunks_in_view(corners->chunks, m, camera.eye)) kept[i] = 1;
    size_t left_out = 0;
    for (size_t i = 0; i < kept.size(); ++i) {
      if (kept[i] != 0) continue;
      ++left_out;
      const draw::SceneChunk& chunk = corners->chunks[i];
      for (uint32_t c = chunk.first; c < chunk.first + chunk.count; ++c) {
        const auto& p = corners->corners[c].position;
        double at[4];
        for (size_t r = 0; r < 4; ++r) {
          at[r] = m[r] * p[0] + m[r + 4] * p[1] + m[r + 8] * p[2] + m[r + 12];
        }
        const bool inside =
            std::fabs(at[0]) <= at[3] && std::fabs(at[1]) <= at[3] && std::fabs(at[2]) <= at[3];
        EXPECT_FALSE(inside) << n << ' ' << i;
      }
    }
    all_left_out += left_out;
  }
  EXPECT_GT(all_left_out, 100U);
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace throng
