// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/wall_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "exact_bodies.h"
#include "simd_targets.h"
#include "throng/verify.h"
#include "verify/body_check.h"

// Cells beside walls. The oracle is verify's exact cylinder, which knows neither cells nor parts.
namespace throng {
namespace {

using test::add_box, test::expect_no_body_enters, test::for_legal_cells, test::ground;

Scene floor_of(double side) {
  return ground(side, side, 1, [](double, double) { return 10.0; });
}

// Walls at any angle, low and high, thin and thick, and beams that hang over the ground.
Scene clutter(uint64_t seed, double slope) {
  Scene scene = ground(10, seed % 2 == 0 ? 10 : 0.5, seed,
                       [&](double x, double z) { return 10 + slope * (x + 0.3 * z); });
  for (uint64_t n = 0; n < 14; ++n) {
    const auto random = [&](uint64_t k) { return random_unit(seed, k, n); };
    const double high = n % 3 == 0 ? 2.5 : 0.9 * random(1);
    const double x = 10 * random(2), z = 10 * random(3), length = 0.2 + 2 * random(4);
    const double thick = n % 4 == 0 ? 0 : 0.4 * random(5), turn = 2 * std::numbers::pi * random(6);
    const double foot = 10 + slope * (x + 0.3 * z);
    if (n % 5 == 4) {
      add_box(scene, {x, foot + 0.2 + 2 * random(7), z}, {length, 0.1, thick}, turn);
    } else {
      add_box(scene, {x, foot - 0.9, z}, {length, 0.9 + high, thick}, turn);
    }
  }
  return scene;
}

TEST(WallParts, NoBodyEntersWallsKerbsAndBeamsAtAnyAngle) {
  std::vector<AvatarClass> classes = default_classes();
  classes.push_back(
      {.name = "wide", .height = 1.2, .radius = 0.61, .step_height = 0.1, .max_slope = 30});
  classes.push_back(
      {.name = "slim", .height = 1.9, .radius = 0.16, .step_height = 0.3, .max_slope = 40});
  std::vector<int64_t> cells(classes.size());
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const Scene scene = clutter(seed, std::array{0.0, 0.04, 0.12, 0.3}[seed % 4]);
    const World world = test::bake(scene, seed % 3 == 0 ? 0.07 : 0.1, classes, true);
    for (size_t c = 0; c < classes.size(); ++c) {
      cells[c] += expect_no_body_enters(world, scene, static_cast<int32_t>(c),
                                        "seed " + std::to_string(seed));
    }
  }
  for (const size_t c : {0, 1, 3, 4, 5}) EXPECT_GT(cells[c], 20000) << classes[c].name;
}

// Nothing is denied but what a part's width excuses: where the body, wider by a part's diagonal and
// taller by the heights that share a filling, is free from all over a cell, the cell is legal.
TEST(WallParts, BesideUprightWallsACellIsLegalIfABodyWiderByAPartIsFreeOnIt) {
  constexpr double kCell = 0.1, kSide = 8, kRim = 0.6;
  int64_t denied = 0, free = 0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    Scene scene = floor_of(kSide);
    for (uint64_t n = 0; n < 8; ++n) {
      const double x = kSide * random_unit(seed, 1, n), z = kSide * random_unit(seed, 2, n);
      add_box(scene, {x, 9, z}, {0.1 + 2 * random_unit(seed, 3, n), 4, 0.2},
              6.3 * random_unit(seed, 4, n));
    }
    const World world = test::bake(scene, kCell, default_classes(), true);
    AvatarClass grown = world.summary().classes[0];
    grown.radius += 1.5 / 8 * kCell;
    const verify::TriangleTree tree(scene, 0);
    const verify::BodyCheck body(tree, grown, kCell);
    const Vec3d origin = world.summary().origin;
    for (double x = kRim; x < kSide - kRim; x += kCell) {
      for (double z = kRim; z < kSide - kRim; z += kCell) {
        const double x0 = origin.x + std::floor((x - origin.x) / kCell) * kCell;
        const double z0 = origin.z + std::floor((z - origin.z) / kCell) * kCell;
        bool is_free = true;
        for (int32_t i = 0; i < 49 && is_free; ++i) {
          is_free = !body.intruder({x0 + i % 7 / 6.0 * kCell, 10, z0 + i / 7 / 6.0 * kCell});
        }
        if (!is_free) continue;
        ++free;
        denied += world.find_place(0, {x0 + kCell / 2, 10, z0 + kCell / 2}, 0.1) ? 0 : 1;
      }
    }
  }
  EXPECT_GT(free, 10000);
  EXPECT_EQ(denied, 0);
}

TEST(WallParts, ACorridorAtAnyAngleKeepsWhatAGrownBodyCanUse) {
  for (const double turn : {0.0, 0.2, 0.5, std::numbers::pi / 4, 1.2}) {
    Scene scene = floor_of(16);
    const double c = std::cos(turn), s = std::sin(turn);
    for (int32_t n = 0; n < 8; ++n) {  // eight walls, 1 m apart
      const double across = n * 1.1;
      add_box(scene, {6 - s * across, 9, 3 + c * across}, {8, 4, 0.1}, turn);
    }
    const World world = test::bake(scene, 0.1, default_classes(), true);
    Context context;
    const auto report = verify_world(world, scene, {.samples = 6000}, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->entered + report->unsupported + report->broken, 0u) << turn;
    EXPECT_GT(report->standable_area_grown, 60) << turn;
    EXPECT_LE(report->lost_grown, 0.005) << turn;
  }
}

TEST(WallParts, ACellBesideAWallLeadsOverNoDrop) {
  // A platform of 2 m without a rail, and one with a pane that stands 4 cells beyond its rim.
  Scene scene = floor_of(12);
  add_box(scene, {3, 9, 3}, {3, 3, 3});
  add_box(scene, {6.42, 9, 3}, {0, 6, 3});
  const World world = test::bake(scene, 0.1, default_classes(), true);
  const double radius = world.summary().classes[0].radius;
  int64_t above = 0;
  for_legal_cells(world, 0, [&](Vec3d p, double cell) {
    if (p.y < 11.5) return;
    ++above;
    EXPECT_LE(p.x + radius, 6 + 1.5 * cell);
    EXPECT_GE(p.x - radius, 3 - 1.5 * cell);
  });
  EXPECT_GT(above, 400);
}

TEST(WallParts, EveryVectorWidthFindsTheSame) {
  const Scene scene = clutter(4, 0.04);
  const auto cells = [&] {
    std::vector<Vec3d> found;
    for (int32_t c = 0; c < 4; ++c) {
      for_legal_cells(test::bake(scene, 0.1, default_classes(), true), c,
                      [&](Vec3d at, double) { found.push_back(at); });
    }
    return found;
  };
  const std::vector<Vec3d> all = cells();
  EXPECT_GT(all.size(), 10000u);
  test::for_every_simd_target([&](const char* target) {
    const std::vector<Vec3d> again = cells();
    ASSERT_EQ(again.size(), all.size()) << target;
    for (size_t i = 0; i < all.size(); ++i) {
      ASSERT_TRUE(again[i].x == all[i].x && again[i].z == all[i].z) << target;
    }
  });
}

}  // namespace
}  // namespace throng
