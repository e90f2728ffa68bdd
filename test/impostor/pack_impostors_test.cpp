// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <span>
#include <vector>

#include "core/random.h"
#include "simd_targets.h"
#include "throng/impostor.h"

namespace throng {
namespace {

struct Avatars {
  std::vector<float> x, y, z;
  std::vector<uint16_t> heading, phase, appearance;
  [[nodiscard]] ImpostorArrays view() const { return {x, y, z, heading, phase, appearance}; }
};

// Around the eye, some very near and some on round coordinates.
Avatars random_avatars(size_t count, double spread) {
  Avatars a;
  for (size_t i = 0; i < count; ++i) {
    const auto coordinate = [&](uint64_t k) {
      const double value = (random_unit(5, i, k) * 2 - 1) * spread;
      return static_cast<float>(i % 7 == 0 ? std::round(value) : value);
    };
    a.x.push_back(coordinate(0));
    a.y.push_back(coordinate(1) * 0.1F);
    a.z.push_back(coordinate(2));
    a.heading.push_back(static_cast<uint16_t>(random_u64(5, i, 3)));
    a.phase.push_back(static_cast<uint16_t>(random_u64(5, i, 4)));
    a.appearance.push_back(static_cast<uint16_t>(i % 2048));
  }
  return a;
}

Atlas atlas_of(int32_t directions, int32_t elevations) {
  Atlas atlas;
  atlas.shape = {.pixels = 64,
                 .directions = directions,
                 .elevations = elevations,
                 .frames = 14,
                 .side = 2,
                 .centre = 0.875,
                 .height = 1.75};
  atlas.clips = {{.name = "Walk", .first_frame = 0, .frames = 10, .seconds = 1, .stride = 1.5},
                 {.name = "Idle", .first_frame = 10, .frames = 4, .seconds = 4, .stride = 0}};
  return atlas;
}

std::vector<ImpostorInstance> pack(const Atlas& atlas, const Avatars& avatars,
                                   const PackConfig& config) {
  std::vector<ImpostorInstance> out(avatars.x.size());
  out.resize(pack_impostors(atlas, avatars.view(), config, out));
  return out;
}

// One by one, by choose_view.
TEST(PackImpostors, ShowsEachAvatarByTheViewThatIsChosenForItAlone) {
  const Avatars avatars = random_avatars(5000, 40);
  for (const int32_t directions : {16, 5}) {
    for (const size_t clip : {0, 1}) {
      const Atlas atlas = atlas_of(directions, 8);
      PackConfig config;
      config.clip = clip;
      config.camera.eye = {3, 12, 30};
      const auto packed = pack(atlas, avatars, config);
      ASSERT_GT(packed.size(), 500U);
      ASSERT_LT(packed.size(), 4500U);
      size_t i = 0;
      for (const ImpostorInstance& instance : packed) {
        while (avatars.x[i] != instance.x || avatars.z[i] != instance.z) ++i;  // In order.
        ASSERT_LT(i, avatars.x.size());
        const Vec3d to_eye{3.0F - avatars.x[i], 12.0F - (avatars.y[i] + 0.875F),
                           30.0F - avatars.z[i]};
        const ViewChoice choice =
            choose_view(atlas.shape, atlas.clips[clip], to_eye, avatars.heading[i] / 65536.0,
                        avatars.phase[i] / 65536.0);
        EXPECT_EQ(instance.view & 0xfffff,
                  atlas.shape.view(choice.frame, choice.row, choice.column));
        EXPECT_EQ(instance.view >> 20 & 1, choice.mirrored ? 1U : 0U);
        EXPECT_EQ(instance.view >> 21, avatars.appearance[i]);
        ++i;
      }
    }
  }
}

// Is a point in the picture? By projecting it.
bool in_picture(const EyeCamera& camera, Vec3d p) {
  const CameraAxes axes = camera_axes(camera);
  const Vec3d d = p - camera.eye;
  const double depth = dot(d, axes.forward), up = std::tan(0.5 * camera.field_of_view);
  return depth >= camera.nearest && depth <= camera.furthest &&
         std::fabs(dot(d, axes.up)) <= depth * up &&
         std::fabs(dot(d, axes.right)) <= depth * up * camera.aspect;
}

TEST(PackImpostors, NoVisibleAvatarIsLeftOutAndFewInvisibleOnesAreKept) {
  const Atlas atlas = atlas_of(16, 8);
  const Avatars avatars = random_avatars(4000, 60);
  size_t seen = 0, kept = 0;
  for (uint64_t n = 0; n < 12; ++n) {
    PackConfig config;
    config.camera.eye = {random_unit(9, n, 0) * 20, random_unit(9, n, 1) * 20, 5};
    config.camera.target = {random_unit(9, n, 2) * 20 - 10, 0, random_unit(9, n, 3) * 20 - 10};
    config.camera.aspect = n % 3 == 0 ? 0.5 : 1.8;
    config.camera.field_of_view = n % 2 == 0 ? 0.3 : 1.5;
    config.camera.furthest = n % 4 == 0 ? 30 : 1000;
    if (n == 11) config.camera.target = config.camera.eye - Vec3d{0, 5, 0};
    std::map<std::pair<float, float>, bool> is_kept;
    for (const ImpostorInstance& i : pack(atlas, avatars, config)) is_kept[{i.x, i.z}] = true;
    kept += is_kept.size();
    for (size_t i = 0; i < avatars.x.size(); ++i) {
      bool inside = false;
      for (uint64_t s = 0; s < 60 && !inside; ++s) {
        const Vec3d off = {random_unit(s, 1, 0) * 2 - 1, random_unit(s, 1, 1) * 2 - 1,
                           random_unit(s, 1, 2) * 2 - 1};
        const Vec3d p{avatars.x[i], avatars.y[i] + 0.875, avatars.z[i]};
        inside = in_picture(config.camera, p + off * (1 / std::max(1.0, length(off))));
      }
      seen += inside ? 1 : 0;
      EXPECT_TRUE(!inside || is_kept.count({avatars.x[i], avatars.z[i]}) == 1) << i;
    }
  }
  EXPECT_GT(seen, 1000U);
  EXPECT_LT(kept, seen + seen / 5);
}

TEST(PackImpostors, SameBytesForAnyNumberOfWorkersAndNoAvatarsAtAll) {
  const Atlas atlas = atlas_of(16, 8);
  const Avatars avatars = random_avatars(40001, 100);
  PackConfig config;
  config.camera.eye = {0, 60, 90};
  config.workers = 1;
  const auto one = pack(atlas, avatars, config);
  ASSERT_GT(one.size(), 100U);
  for (const int32_t workers : {2, 3, 8, 0}) {
    config.workers = workers;
    const auto many = pack(atlas, avatars, config);
    ASSERT_EQ(many.size(), one.size());
    EXPECT_EQ(std::memcmp(many.data(), one.data(), one.size() * sizeof one[0]), 0) << workers;
  }
  EXPECT_TRUE(pack(atlas, Avatars{}, config).empty());
}

// Each level, compared with a test of every avatar on its own.
TEST(PackImpostors, EachIsDrawnAtTheLevelOfItsDistance) {
  const Atlas atlas = atlas_of(16, 8);
  const Avatars avatars = random_avatars(20'000, 60);
  const size_t count = avatars.x.size();
  PackConfig config;
  config.camera.eye = {2, 3, 4};
  config.camera.target = {0, 0, -10};
  const LevelDistances levels{.mesh_near = 8, .mesh_far = 10, .point_near = 30, .point_far = 40};
  const std::vector<ImpostorInstance> all = pack(atlas, avatars, config);
  for (const int32_t workers : {1, 2, 0}) {
    config.workers = workers;
    std::vector<ImpostorInstance> meshes(count), views(count), points(count);
    const LevelCounts counts =
        pack_levels(atlas, avatars.view(), config, levels, {meshes, views, points});
    size_t m = 0, v = 0, p = 0;
    for (const ImpostorInstance& one : all) {
      // As the loop has it, in floats: the bounds belong to what begins there.
      const float dx = 2 - one.x, dy = 3 - (one.y + 0.875F), dz = 4 - one.z;
      const float far = dx * dx + dy * dy + dz * dz;
      const auto is_same = [&](const ImpostorInstance& other) {
        return other.x == one.x && other.y == one.y && other.z == one.z &&
               other.view >> 21 == one.view >> 21;
      };
      if (far < 100) {
        ASSERT_LT(m, counts.meshes);
        EXPECT_TRUE(is_same(meshes[m++]));
      }
      if (far >= 64 && far < 1600) {
        ASSERT_LT(v, counts.views);
        EXPECT_EQ(std::memcmp(&views[v++], &one, sizeof one), 0);
      }
      if (far >= 900) {
        ASSERT_LT(p, counts.points);
        EXPECT_TRUE(is_same(points[p++]));
      }
    }
    EXPECT_EQ(m, counts.meshes);
    EXPECT_EQ(v, counts.views);
    EXPECT_EQ(p, counts.points);
    EXPECT_GT(m, 20U);
    EXPECT_GT(v, 500U);
    EXPECT_GT(p, 500U);
  }
}

TEST(PackImpostors, MeshesKnowHeadingAndPhase) {
  const Atlas atlas = atlas_of(16, 8);
  const std::vector<float> x{0, 0, 0}, y{0, 0, 0}, z{-3, -3, -3};
  const std::vector<uint16_t> heading{0, 32768, 65530}, phase{0, 32768, 65535},
      appearance{1, 2, 2047};
  PackConfig config;
  config.camera.eye = {0, 1, 0};
  config.camera.target = {0, 1, -1};
  std::vector<ImpostorInstance> meshes(3), views(3);
  const LevelCounts counts = pack_levels(atlas, {x, y, z, heading, phase, appearance}, config,
                                         {.mesh_near = 4, .mesh_far = 5},
                                         {.meshes = meshes, .views = views, .points = {}});
  ASSERT_EQ(counts.meshes, 3U);
  EXPECT_EQ(counts.views, 0U);
  EXPECT_EQ(meshes[0].view, 1U << 21);
  EXPECT_EQ(meshes[1].view, 2U << 21 | 512U << 11 | 1024U);
  EXPECT_EQ(meshes[2].view, 2047U << 21 | 1023U << 11 | 0U);  // To the nearest step.
}

TEST(PackImpostors, LevelsFollowTheSizeOfATexel) {
  const AtlasShape shape = atlas_of(16, 8).shape;  // 2 m in 64 texels.
  EyeCamera camera;
  camera.field_of_view = 2 * std::atan(0.5);  // A metre at a metre is as many pixels as are high.
  const LevelDistances d = level_distances(shape, camera, 640, 2, 8);
  EXPECT_NEAR(d.mesh_far, 2 * 640.0 / 128, 1e-9);  // A side of 128 pixels.
  EXPECT_NEAR(d.mesh_near, 8, 1e-9);
  EXPECT_NEAR(d.point_far, 160, 1e-9);
  EXPECT_NEAR(d.point_near, 128, 1e-9);
  const LevelDistances none = level_distances(shape, camera, 640, 0, 0);
  EXPECT_EQ(none.mesh_far, 0);
  EXPECT_GE(none.point_near, 1e18);
  const LevelDistances odd = level_distances(shape, camera, 640, 0.1, 64);  // Meshes win.
  EXPECT_LE(odd.mesh_far, odd.point_near);
}

TEST(PackImpostors, SameBytesForAnyVectorInstructions) {
  const Atlas atlas = atlas_of(16, 8);
  const Avatars avatars = random_avatars(3000, 50);
  PackConfig config;
  config.camera.eye = {0, 20, 60};
  const auto best = pack(atlas, avatars, config);
  test::for_every_simd_target([&](const char* target) {
    const auto other = pack(atlas, avatars, config);
    ASSERT_EQ(other.size(), best.size()) << target;
    EXPECT_EQ(std::memcmp(other.data(), best.data(), best.size() * sizeof best[0]), 0) << target;
  });
}

TEST(PackImpostors, FromTheSunAllShowTheSideThatItSees) {
  const Atlas atlas = atlas_of(16, 8);
  Avatars avatars = random_avatars(500, 10);
  for (uint16_t& heading : avatars.heading) heading = 0;
  PackConfig config;
  config.camera.eye = {0, 5, 30};
  config.from_direction = Vec3d{1, 1, 0};  // From +X, at 45 degrees.
  for (const ImpostorInstance& i : pack(atlas, avatars, config)) {
    const uint32_t view = i.view & 0xfffff;
    EXPECT_EQ(view % 16, 8U);
    EXPECT_EQ(view / 16 % 8, 4U);
  }
}

// Each of the four by choose_view, from half a view to either side.
TEST(PackImpostors, BlendsTheFourViewsAroundTheEyesDirection) {
  const Atlas atlas = atlas_of(16, 8);
  const Avatars avatars = random_avatars(60000, 40);
  const size_t count = avatars.x.size();
  PackConfig config;
  config.camera.eye = {3, 12, 30};
  const LevelDistances levels{.blend_far = 35, .blend_share = 0.5};
  std::vector<ImpostorInstance> views(count);
  std::vector<BlendedInstance> blends(count);
  const LevelCounts counts =
      pack_levels(atlas, avatars.view(), config, levels,
                  {.meshes = {}, .views = views, .points = {}, .blends = blends});
  EXPECT_EQ(counts.views + counts.blends, pack(atlas, avatars, config).size());
  ASSERT_GT(counts.blends, 2000U);
  size_t i = 0, corners = 0, borders[2] = {};
  for (const BlendedInstance& b : std::span(blends).first(counts.blends)) {
    while (avatars.x[i] != b.nearest_below.x || avatars.z[i] != b.nearest_below.z) ++i;
    const Vec3d d{3.0F - avatars.x[i], 12.0F - (avatars.y[i] + 0.875F), 30.0F - avatars.z[i]};
    const double flat = std::hypot(d.x, d.z), far = length(d);
    EXPECT_LT(far, 35.001);
    const double turn = 2 * std::numbers::pi;
    const double column = (std::atan2(d.x, d.z) / turn - avatars.heading[i] / 65536.0) * 32;
    const double row = std::atan2(std::max(d.y, 0.0), flat) / turn * 32;
    // From the middle of the lower view to that of the upper one, a band in the middle.
    const double band = 0.5 * std::min(1.0, 5 * (1 - far / 35));
    const auto share = [&](double at) {
      return std::clamp(0.5 + (at - std::round(at)) / std::max(band, 1e-6), 0.0, 1.0);
    };
    const bool row_ends = row < 0.5 || row >= 7.5;
    const auto view = [&](double c, double r) {
      const double azimuth = (c / 32 + avatars.heading[i] / 65536.0) * turn, up = r / 32 * turn;
      const ViewChoice v = choose_view(
          atlas.shape, atlas.clips[0],
          {std::sin(azimuth) * std::cos(up), std::sin(up), std::cos(azimuth) * std::cos(up)},
          avatars.heading[i] / 65536.0, avatars.phase[i] / 65536.0);
      return static_cast<uint32_t>(atlas.shape.view(v.frame, v.row, v.column)) |
             static_cast<uint32_t>(v.mirrored) << 20;
    };
    const uint32_t to_column = b.shares & 511, to_row = b.shares >> 9;
    const double c0 = to_column > 0 ? std::round(column) - 0.5 : std::floor(column) + 0.5;
    const double r0 = to_row > 0 ? std::round(row) - 0.5 : std::floor(row) + 0.5;
    const double c1 = to_column > 0 ? c0 + 1 : c0, r1 = to_row > 0 ? r0 + 1 : r0;
    EXPECT_NEAR(to_column / 256.0, to_column > 0 ? share(column) : 0, 0.01 / band);
    EXPECT_NEAR(to_row / 256.0, to_row > 0 && !row_ends ? share(row) : 0, 0.01 / band);
    if (to_column == 0) {
      EXPECT_LT(std::min(share(column), 1 - share(column)), 0.01 / band);
    }
    if (to_row == 0 && !row_ends) {
      EXPECT_LT(std::min(share(row), 1 - share(row)), 0.01 / band);
    }
    const auto near_floor = [](double at) { return std::fabs(at - std::round(at)) < 1e-3; };
    if ((to_column == 0 && near_floor(column)) || (to_row == 0 && near_floor(row))) continue;
    EXPECT_EQ(b.nearest_below.view, view(c0, r0) | static_cast<uint32_t>(avatars.appearance[i])
                                                       << 21);
    EXPECT_EQ(b.others[0], view(c1, r0));
    EXPECT_EQ(b.others[1], view(c0, r1));
    EXPECT_EQ(b.others[2], view(c1, r1));
    ++(to_column > 0 && to_row > 0 ? corners : borders[to_row > 0 ? 1 : 0]);
    ++i;
  }
  EXPECT_GT(corners, 300U);
  EXPECT_GT(borders[0], 800U);
  EXPECT_GT(borders[1], 300U);
}

}  // namespace
}  // namespace throng
