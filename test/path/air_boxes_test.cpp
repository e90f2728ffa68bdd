// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/random.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/scene.h"

// The boxes of the air's octree against the boxes that the scene is made of.
namespace throng {
namespace {

const std::vector<Box3d>& solids() {
  static const std::vector<Box3d> boxes = {{{0, -1, 0}, {24, 0, 20}},
                                           {{4, 0, 4}, {7, 3.1, 9}},
                                           {{12, 2, 0}, {13, 6, 20}},
                                           {{18, 1.3, 12}, {20, 1.8, 14}}};
  return boxes;
}

World baked(bool flies) {
  Scene scene;
  for (const Box3d& box : solids()) scene.add_box(box.min, box.max);
  BakeConfig config{.cell = 0.2, .classes = {AvatarClass{}}};
  if (flies) config.classes.push_back(flyer_class());
  Context context;
  auto world = bake_world(scene, config, context);
  EXPECT_TRUE(world) << world.error().message;
  return *std::move(world);
}

bool overlap(const Box3d& a, const Box3d& b) {
  constexpr double kTouch = 1e-6;
  const auto meet = [](double a0, double a1, double b0, double b1) {
    return a0 < b1 - kTouch && b0 < a1 - kTouch;
  };
  return meet(a.min.x, a.max.x, b.min.x, b.max.x) && meet(a.min.y, a.max.y, b.min.y, b.max.y) &&
         meet(a.min.z, a.max.z, b.min.z, b.max.z);
}

// Solids are made of triangles, so they are hollow.
bool meets_shell(const Box3d& box, const Box3d& solid) {
  const bool is_inside = box.min.x > solid.min.x && box.max.x < solid.max.x &&
                         box.min.y > solid.min.y && box.max.y < solid.max.y &&
                         box.min.z > solid.min.z && box.max.z < solid.max.z;
  return overlap(box, solid) && !is_inside;
}

TEST(AirBoxes, AreFreeApartFromEachOtherAndFillMostOfTheAir) {
  const World world = baked(true);
  const auto boxes = air_boxes(world);
  ASSERT_TRUE(boxes) << boxes.error().message;
  const auto air = air_summary(world);
  ASSERT_TRUE(air);
  double volume = 0;
  for (size_t i = 0; i < boxes->size(); ++i) {
    const Box3d& box = (*boxes)[i];
    const Vec3d size = box.max - box.min;
    EXPECT_GT(size.y, 0);
    EXPECT_GE(box.min.y, air->floor - 1e-6);
    EXPECT_LE(box.max.y, air->ceiling + 1e-6);
    volume += size.x * size.y * size.z;
    for (const Box3d& solid : solids()) EXPECT_FALSE(meets_shell(box, solid)) << i;
    for (size_t k = 0; k < i; ++k) EXPECT_FALSE(overlap(box, (*boxes)[k])) << i << ", " << k;
  }
  const double all = 24 * 20 * (air->ceiling - air->floor);
  EXPECT_LT(volume, all);
  EXPECT_GT(volume, 0.6 * all);
  // Points far from every solid lie in a box.
  uint64_t far = 0;
  for (uint64_t n = 0; n < 3000; ++n) {
    const Vec3d p{1 + random_unit(5, 0, n) * 21, random_unit(5, 1, n) * air->ceiling,
                  1 + random_unit(5, 2, n) * 17};
    const Box3d around{p - Vec3d{4, 4, 4}, p + Vec3d{4, 4, 4}};
    if (p.y + 4 > air->ceiling || std::any_of(solids().begin(), solids().end(),
                                              [&](const Box3d& s) { return overlap(around, s); })) {
      continue;
    }
    ++far;
    EXPECT_TRUE(std::any_of(boxes->begin(), boxes->end(), [&](const Box3d& box) {
      return overlap(box, {p - Vec3d{1e-3, 1e-3, 1e-3}, p + Vec3d{1e-3, 1e-3, 1e-3}});
    })) << n;
  }
  RecordProperty("far points", std::to_string(far));
}

TEST(AirBoxes, OfAnAreaAreThoseWhoseMiddleLiesOverIt) {
  const World world = baked(true);
  const auto all = air_boxes(world);
  const Box3d area{{3, 0, 2}, {10, 0, 11}};
  const auto some = air_boxes(world, area);
  ASSERT_TRUE(all && some);
  const auto count = std::count_if(all->begin(), all->end(), [&](const Box3d& box) {
    const Vec3d middle = (box.min + box.max) * 0.5;
    return middle.x >= 3 && middle.x <= 10 && middle.z >= 2 && middle.z <= 11;
  });
  EXPECT_EQ(some->size(), static_cast<size_t>(count));
  EXPECT_GT(some->size(), 0u);
  EXPECT_LT(some->size(), all->size());
  const auto none = air_boxes(baked(false));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace throng
