// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "throng/bake.h"
#include "throng/scene.h"
#include "throng/verify.h"

/// The oracle on baked worlds, through the public API alone.
namespace throng {
namespace {

// A hall with what bodies meet in buildings: a wall askew, pillars, stairs to a gallery, a ramp, a
// low ceiling, a kerb, a pit.
Scene hall() {
  Scene scene;
  scene.add_quad({0, 0, 0}, {20, 0, 0}, {20, 0, 14}, {0, 0, 14});
  for (int i = 0; i < 10; ++i) {  // stairs up along x
    scene.add_box({2 + 0.3 * i, 0, 1}, {2.3 + 0.3 * i, 0.17 * (i + 1), 3});
  }
  scene.add_box({5, 1.4, 0.5}, {12, 1.7, 3.5});  // the gallery: only children walk under it
  for (int i = 0; i < 3; ++i) {                  // and pillars
    scene.add_box({6 + 2.0 * i, 0, 5}, {6.3 + 2.0 * i, 4, 5.3});
  }
  scene.add_quad({12, 1.7, 1}, {16, 0, 1}, {16, 0, 3}, {12, 1.7, 3});        // a ramp of 23 degrees
  scene.add_quad({3, 0, 8}, {9, 0, 11}, {9, 3, 11}, {3, 3, 8});              // a wall askew
  scene.add_box({14, 0, 8}, {19, 0.15, 13});                                 // a kerb
  scene.add_quad({10, 1.2, 9}, {13, 1.2, 9}, {13, 1.2, 12}, {10, 1.2, 12});  // a table's top
  return scene;
}

const World& hall_world() {
  static const World world = [] {
    Context context;
    auto baked = bake_world(hall(), {}, context);
    EXPECT_TRUE(baked) << baked.error().message;
    return baked ? *baked : World();
  }();
  return world;
}

VerifyReport judge(const World& world, const Scene& source, int32_t avatar_class,
                   uint64_t samples = 5000) {
  Context context;
  const auto report =
      verify_world(world, source, {.samples = samples, .avatar_class = avatar_class}, context);
  EXPECT_TRUE(report) << report.error().message;
  return report ? *report : VerifyReport{};
}

TEST(VerifyWorld, BakedHallHoldsForEveryClass) {
  const World& world = hall_world();
  const auto classes = world.summary().classes;
  ASSERT_EQ(classes.size(), 4u);
  for (size_t c = 0; c < classes.size(); ++c) {
    const VerifyReport report = judge(world, hall(), static_cast<int32_t>(c));
    EXPECT_EQ(report.states, 5000u) << classes[c].name;
    EXPECT_GT(report.moves, 4900u) << classes[c].name;
    EXPECT_EQ(report.entered, 0u) << classes[c].name;
    EXPECT_EQ(report.unsupported, 0u) << classes[c].name;
    EXPECT_EQ(report.broken, 0u) << classes[c].name;
    EXPECT_LE(report.feet_error_mean, 0.01) << classes[c].name;
    EXPECT_LE(report.feet_error_p95, 0.03) << classes[c].name;
    EXPECT_LE(report.lost_grown, 0.03) << classes[c].name;  // A small hall is mostly rims.
    EXPECT_GT(report.standable_area_grown, 150) << classes[c].name;
  }
}

// Floors above each other in one tile, close enough that level tiles meet: where a step was once
// taken from a floor to the one above it.
TEST(VerifyWorld, BuiltInWorldsHoldForEveryClass) {
  for (const char* name : {"stairs", "church", "garage"}) {
    const auto scene = create_builtin_world({.name = name});
    ASSERT_TRUE(scene) << scene.error().message;
    Context context;
    const auto world = bake_world(*scene, {}, context);
    ASSERT_TRUE(world) << world.error().message;
    for (int32_t c = 0; c < 4; ++c) {
      const VerifyReport report = judge(*world, *scene, c, 6000);
      EXPECT_EQ(report.states, 6000u) << name << c;
      EXPECT_EQ(report.entered, 0u) << name << c;
      EXPECT_EQ(report.unsupported, 0u) << name << c;
      EXPECT_EQ(report.broken, 0u) << name << c;
      EXPECT_LE(report.feet_error_mean, 0.01) << name << c;
      EXPECT_LE(report.feet_error_p95, 0.03) << name << c;
    }
  }
}

TEST(VerifyWorld, WorldOfAnotherModelIsFoundOut) {
  Scene more = hall();
  more.add_box({17, 0, 4}, {18, 2, 5});
  const VerifyReport entered = judge(hall_world(), more, 0);
  EXPECT_GT(entered.entered, 0u);
  EXPECT_EQ(entered.unsupported, 0u);

  Scene higher = hall();
  for (Vec3d& p : higher.positions) p.y += 0.05;
  const VerifyReport floats = judge(hall_world(), higher, 0, 1000);
  EXPECT_NEAR(floats.feet_error_mean, 0.05, 0.01);

  Scene wider = hall();
  wider.add_quad({20, 0, 0}, {30, 0, 0}, {30, 0, 14}, {20, 0, 14});
  const VerifyReport lost = judge(hall_world(), wider, 0, 500);
  EXPECT_GT(lost.lost_grown, 0.25);
  EXPECT_EQ(lost.entered, 0u);

  Scene no_floor = hall();
  no_floor.area[0] = no_floor.area[1] = kAreaBlocked;
  EXPECT_GT(judge(hall_world(), no_floor, 0, 500).unsupported, 300u);
}

TEST(VerifyWorld, BlockedSurfacesAreNotWalkedOn) {
  Scene scene = hall();
  scene.area[0] = scene.area[1] = kAreaBlocked;
  Context context;
  const auto world = bake_world(scene, {}, context);
  ASSERT_TRUE(world) << world.error().message;
  const VerifyReport report = judge(*world, scene, 0, 2000);
  EXPECT_EQ(report.unsupported, 0u);
  EXPECT_EQ(report.entered, 0u);
  EXPECT_LT(report.standable_area_exact, 65);
}

PathReport walk_paths(const World& world, const Scene& source, int32_t avatar_class,
                      uint64_t pairs) {
  Context context;
  const auto report =
      verify_paths(world, source, {.samples = pairs, .avatar_class = avatar_class}, context);
  EXPECT_TRUE(report) << report.error().message;
  return report ? *report : PathReport{};
}

TEST(VerifyPaths, EveryPathIsWalkedByLegalMovesAndItsBody) {
  for (const char* name : {"stairs", "church", "garage", "maze"}) {
    const auto scene = create_builtin_world({.name = name});
    ASSERT_TRUE(scene) << scene.error().message;
    Context context;
    const auto world = bake_world(*scene, {}, context);
    ASSERT_TRUE(world) << world.error().message;
    for (int32_t c = 0; c < 4; ++c) {
      const PathReport report = walk_paths(*world, *scene, c, 60);
      EXPECT_EQ(report.pairs, 60u) << name << c;
      EXPECT_GE(report.reached, 20u) << name << c;
      EXPECT_EQ(report.reached + report.disconnected, report.pairs) << name << c;
      EXPECT_EQ(report.illegal, 0u) << name << c;
      EXPECT_EQ(report.entered, 0u) << name << c;
      EXPECT_EQ(report.unsupported, 0u) << name << c;
      EXPECT_EQ(report.broken, 0u) << name << c;
      EXPECT_EQ(report.disagree, 0u) << name << c;
      EXPECT_GE(report.length, report.straight) << name << c;
    }
  }
}

TEST(VerifyPaths, PathsThroughAnotherModelAreDetected) {
  Scene more = hall();
  more.add_box({0, 0, 3.8}, {20, 2, 4});
  const PathReport entered = walk_paths(hall_world(), more, 0, 100);
  EXPECT_GT(entered.entered, 20u);
  EXPECT_EQ(entered.illegal + entered.unsupported + entered.broken + entered.disagree, 0u);
  ASSERT_FALSE(entered.faults.empty());
  EXPECT_EQ(entered.faults[0].what, "entered");

  Scene no_floor = hall();
  no_floor.area[0] = no_floor.area[1] = kAreaBlocked;
  EXPECT_GT(walk_paths(hall_world(), no_floor, 0, 100).unsupported, 50u);
}

TEST(VerifyPaths, SameForAnyWorkers) {
  Context context;
  const auto one = verify_paths(hall_world(), hall(), {.samples = 300, .workers = 1}, context);
  const auto three = verify_paths(hall_world(), hall(), {.samples = 300, .workers = 3}, context);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->length, three->length);
  EXPECT_EQ(one->bodies, three->bodies);
  EXPECT_EQ(one->reached, three->reached);
}

TEST(VerifyPaths, BadSettingsAreRefusedAndACancelEndsIt) {
  Context context;
  for (const int32_t bad : {-1, 4}) {
    const auto report = verify_paths(hall_world(), hall(), {.avatar_class = bad}, context);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, Errc::kBadConfig);
  }
  const auto empty = verify_paths(hall_world(), Scene{}, {}, context);
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, Errc::kBadInput);
  context.cancel = true;
  const auto cancelled = verify_paths(hall_world(), hall(), {}, context);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, Errc::kCancelled);
}

TEST(VerifyWorld, UnknownClassIsRefused) {
  Context context;
  for (const int32_t bad : {-1, 4}) {
    const auto report = verify_world(hall_world(), hall(), {.avatar_class = bad}, context);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, Errc::kBadConfig);
  }
}

}  // namespace
}  // namespace throng
