// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "worlds.h"

// Stairs and slopes slow avatars on foot. The oracle: the time that a known length takes at the
// speeds of the literature.
namespace throng {
namespace {

constexpr double kSpeed = 1.3;                             // desired [m/s]
constexpr double kUp = 0.61 / 1.34, kDown = 0.694 / 1.34;  // Weidmann 1993, on stairs
constexpr double kStairs = 0.17 / 0.29;                    // their gradient

// Of a ramp that rises 1 in `run`.
double factor_on_ramp(double run, double on_stairs) {
  return 1 - (1 - on_stairs) * (1 / run / kStairs);
}

World ramp(double run, double length = 12) {
  return test::bake(worlds::ramp(std::atan(1 / run) * 180 / M_PI, length), 0.1, {AvatarClass{}});
}
World stairs(double cell) {
  return test::bake(worlds::steps(0.17, 0.29, 20), cell, {AvatarClass{}});
}
constexpr double kStairsEnd = 3 + 20 * 0.29, kStairsTop = 20 * 0.17;

struct Walk {
  Crowd crowd;
  AvatarId id;
};

Walk walk(const World& world, Vec3d from, Vec3d to, const CrowdConfig& config = {}) {
  Walk made{throng::made(world, config), {}};
  made.id = added(made.crowd, world.find_place(0, from, 0.5), {.speed = kSpeed});
  EXPECT_TRUE(made.id);
  const Place goal = world.find_place(0, to, 0.5);
  EXPECT_TRUE(goal);
  made.crowd.set_goals(std::span(&made.id, 1), std::span(&goal, 1));
  return made;
}

// Mean speed along X between two planes across the path, either of which may be the first. [m/s]
double speed_between(Walk walk, double first, double second, double dt = 0.1) {
  double begin = -1, x = walk.crowd.read(walk.id)->position.x;
  const double sign = second > first ? 1 : -1;
  for (int step = 0; step < 1000; ++step) {
    walk.crowd.step();
    const double next = walk.crowd.read(walk.id)->position.x;
    const auto crossed_at = [&](double plane) { return (step + (plane - x) / (next - x)) * dt; };
    if (begin < 0 && sign * (next - first) >= 0) begin = crossed_at(first);
    if (sign * (next - second) >= 0) return std::abs(second - first) / (crossed_at(second) - begin);
    x = next;
  }
  ADD_FAILURE() << "it never came there";
  return 0;
}

TEST(Slopes, ARampTakesTheTimeOfItsGradientUpAndDown) {
  for (const double run : {12.0, 20.0, 4.0}) {
    const World world = ramp(run);
    const double top = 12 / run;
    const Vec3d low{1, 0, 1.5}, high{17, top, 1.5};
    const double up = speed_between(walk(world, low, high), 4, 14);
    const double down = speed_between(walk(world, high, low), 14, 4);
    EXPECT_NEAR(up, kSpeed * factor_on_ramp(run, kUp), 0.01 * kSpeed) << "1 in " << run;
    EXPECT_NEAR(down, kSpeed * factor_on_ramp(run, kDown), 0.01 * kSpeed) << "1 in " << run;
  }
}

TEST(Slopes, StairsTakeTheTimeOfTheLiteratureUpAndDown) {
  for (const double cell : {0.05, 0.1}) {
    const World world = stairs(cell);
    const Vec3d low{1, 0, 1.5}, high{kStairsEnd + 2, kStairsTop, 1.5};
    const double first = 3.5, last = kStairsEnd - 0.5;
    const double up = speed_between(walk(world, low, high), first, last);
    const double down = speed_between(walk(world, high, low), last, first);
    EXPECT_NEAR(up, kSpeed * kUp, 0.02 * kSpeed) << cell;
    EXPECT_NEAR(down, kSpeed * kDown, 0.02 * kSpeed) << cell;
  }
}

TEST(Slopes, BeforeAndBehindStairsAnAvatarHasItsWholeSpeed) {
  const World world = stairs(0.05);
  const Vec3d low{0.5, 0, 1.5}, high{kStairsEnd + 2.5, kStairsTop, 1.5};
  EXPECT_NEAR(speed_between(walk(world, low, high), 0.7, 2.2), kSpeed, 0.01);
  EXPECT_NEAR(speed_between(walk(world, low, high), kStairsEnd + 1, kStairsEnd + 2), kSpeed, 0.01);
}

TEST(Slopes, EachClassHasItsOwnFactors) {
  AvatarClass old;
  old.name = "old";
  const World world = test::bake(worlds::steps(0.17, 0.29, 20), 0.1, {AvatarClass{}, old});
  const CrowdConfig config{.slope_factors = {SlopeFactors{}, {.stairs_up = 0.3}}};
  for (const int32_t avatar_class : {0, 1}) {
    Walk walk{made(world, config), {}};
    walk.id = added(walk.crowd, world.find_place(avatar_class, {1, 0, 1.5}, 0.5),
                    {.avatar_class = avatar_class, .speed = kSpeed});
    const Place goal = world.find_place(avatar_class, {kStairsEnd + 2, kStairsTop, 1.5}, 0.5);
    walk.crowd.set_goals(std::span(&walk.id, 1), std::span(&goal, 1));
    const double factor = avatar_class == 0 ? kUp : 0.3;
    EXPECT_NEAR(speed_between(std::move(walk), 3.5, kStairsEnd - 0.5), kSpeed * factor,
                0.02 * kSpeed);
  }
}

TEST(Slopes, NothingIsSlowedIfItIsSwitchedOff) {
  const World world = stairs(0.05);
  const Vec3d low{1, 0, 1.5}, high{kStairsEnd + 2, kStairsTop, 1.5};
  const CrowdConfig off{.slow_on_slopes = false};
  EXPECT_NEAR(speed_between(walk(world, low, high, off), 3.5, kStairsEnd - 0.5), kSpeed, 0.01);
  EXPECT_NEAR(speed_between(walk(world, high, low, off), kStairsEnd - 0.5, 3.5), kSpeed, 0.01);
}

std::vector<Place> random_goals(const World& world, size_t count, uint64_t seed) {
  std::vector<Place> goals;
  for (size_t i = 0; i < count; ++i) goals.push_back(world.random_place(0, seed, i));
  return goals;
}

TEST(Slopes, LevelGroundIsWalkedAsWithoutThem) {
  const World world = test::bake(worlds::flat(20), 0.1, {AvatarClass{}});
  uint64_t hashes[2];
  for (const bool slow : {false, true}) {
    Crowd crowd = made(world, {.slow_on_slopes = slow});
    const auto ids = scattered(crowd, 80);
    crowd.set_goals(ids, random_goals(world, ids.size(), 5));
    for (int step = 0; step < 100; ++step) crowd.step();
    hashes[slow ? 1 : 0] = crowd.state_hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Slopes, AnExternallyControlledAvatarKeepsItsSpeed) {
  const World world = stairs(0.05);
  Walk up = walk(world, {1, 0, 1.5}, {kStairsEnd + 2, kStairsTop, 1.5});
  while (up.crowd.read(up.id)->position.x < 5) up.crowd.step();  // It is slow now.
  const Vec3d east{kSpeed, 0, 0};
  up.crowd.set_velocities(std::span(&up.id, 1), std::span(&east, 1));
  const double x = up.crowd.read(up.id)->position.x;
  for (int step = 0; step < 10; ++step) up.crowd.step();
  EXPECT_NEAR(up.crowd.read(up.id)->position.x, x + kSpeed, 0.01);
}

// As areas of scenarios do.
TEST(Slopes, AnotherDesiredSpeedIsSlowedAsTheFirstWas) {
  const World world = stairs(0.05);
  for (const double part : {0.5, 1.5}) {
    Walk up = walk(world, {1, 0, 1.5}, {kStairsEnd + 2, kStairsTop, 1.5});
    while (up.crowd.read(up.id)->position.x < 4) up.crowd.step();
    const double speed = part * kSpeed;
    up.crowd.set_speeds(std::span(&up.id, 1), std::span(&speed, 1));
    EXPECT_NEAR(speed_between(std::move(up), 4.5, kStairsEnd - 0.5), speed * kUp, 0.02 * speed);
  }
}

TEST(Slopes, CrowdsOnStairsHaveNoFaultsAndTheSameStateForAnyWorkers) {
  const World world = test::bake(test::builtin({.name = "stairs", .seed = 3}), 0.1);
  for (const SteeringModel model : {SteeringModel::kSampled, SteeringModel::kSocialForce}) {
    uint64_t expected = 0;
    for (const int32_t workers : {1, 3}) {
      Crowd crowd = made(world, {.workers = workers, .model = model});
      const auto ids = scattered(crowd, 150);
      crowd.set_goals(ids, random_goals(world, ids.size(), 5));
      const std::vector<CrowdView> views{{.position = {5, 0, 5}, .radius = 5}};
      for (int step = 0; step < 120; ++step) {
        if (step == 60) crowd.set_views(views);
        crowd.step();
        if (step % 10 != 9) continue;
        EXPECT_EQ(crowd.check().overlaps, 0u);
        EXPECT_EQ(crowd.check().wall_entries, 0u);
      }
      if (workers == 1) expected = crowd.state_hash();
      EXPECT_EQ(crowd.state_hash(), expected);
    }
  }
}

TEST(Slopes, ACrowdThatIsRestoredOnStairsContinuesAsTheSavedOne) {
  const World world = stairs(0.1);
  Walk up = walk(world, {1, 0, 1.5}, {kStairsEnd + 2, kStairsTop, 1.5});
  while (up.crowd.read(up.id)->position.x < 5) up.crowd.step();
  const std::vector<uint8_t> saved = up.crowd.save();
  Context context;
  EXPECT_FALSE(Crowd::restore(world, {.slow_on_slopes = false}, saved, context));
  EXPECT_FALSE(Crowd::restore(world, {.slope_factors = {{.stairs_up = 0.3}}}, saved, context));
  auto restored = Crowd::restore(world, {}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  for (int step = 0; step < 100; ++step) {  // up, and over the level ground behind
    up.crowd.step();
    restored->step();
    ASSERT_EQ(restored->state_hash(), up.crowd.state_hash()) << step;
  }
}

TEST(Slopes, FactorsThatNoneCanHaveAreRefused) {
  const World world = test::bake(worlds::flat(5), 0.1, {AvatarClass{}});
  for (const double bad : {0.0, -1.0, 1.01, double{NAN}}) {
    for (const SlopeFactors& factors :
         {SlopeFactors{.stairs_up = bad}, SlopeFactors{.stairs_down = bad}}) {
      const auto crowd = Crowd::create(world, {.slope_factors = {factors}});
      ASSERT_FALSE(crowd);
      EXPECT_EQ(crowd.error().message, "crowd: slope_factors must be 0.01 to 1");
    }
  }
  const auto crowd = Crowd::create(world, {.slope_factors = {SlopeFactors{}, SlopeFactors{}}});
  ASSERT_FALSE(crowd);
  EXPECT_EQ(crowd.error().code, Errc::kBadConfig);
}

}  // namespace
}  // namespace throng
