// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/crowd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "crowds.h"
#include "simd_targets.h"
#include "throng/bake.h"
#include "throng/scene.h"
#include "worlds.h"

namespace throng {
namespace {

std::vector<Place> random_goals(const World& world, size_t count, uint64_t seed) {
  std::vector<Place> goals;
  for (size_t i = 0; i < count; ++i) goals.push_back(world.random_place(0, seed, i));
  return goals;
}

Vec3d position(const Crowd& crowd, AvatarId id) {
  std::vector<AvatarState> states;
  crowd.read(states);
  for (const AvatarState& state : states) {
    if (state.id + 1 == id.slot1) return state.position;
  }
  ADD_FAILURE() << "no avatar has that id";
  return {};
}

// Steps until the avatar arrives, at most `max_steps` times. Returns how many steps it took.
int steps_to_arrive(Crowd& crowd, AvatarId id, int max_steps) {
  for (int step = 1; step <= max_steps; ++step) {
    crowd.step();
    for (const AvatarId there : crowd.arrived()) {
      if (there == id) return step;
    }
  }
  return max_steps + 1;
}

void expect_no_faults(const Crowd& crowd) {
  const CrowdCheck check = crowd.check();
  EXPECT_EQ(check.wall_entries, 0u);
  EXPECT_EQ(check.overlaps, 0u);
}

TEST(Crowd, NoAvatarEntersAWallOrAnotherInBuiltInWorlds) {
  uint64_t moved = 0;
  for (const char* name : {"garage", "church", "stairs", "maze", "bridge"}) {
    const World world = test::bake(test::builtin({.name = name, .seed = 3}), 0.1);
    Crowd crowd = made(world);
    const auto ids = scattered(crowd, 150);
    crowd.set_goals(ids, random_goals(world, ids.size(), 5));
    for (int step = 0; step < 120; ++step) {
      const CrowdReport report = crowd.step();
      moved += report.avatars - report.stood;
      if (step % 10 == 9) expect_no_faults(crowd);
    }
  }
  EXPECT_GT(moved, 5u * 120 * 150 / 3);
}

TEST(Crowd, SameStateForAnyWorkersAndMachines) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  test::for_every_simd_target([&](const char* name) {
    for (const int32_t workers : {1, 2, 5}) {
      Crowd crowd = made(world, {.workers = workers});
      const auto ids = scattered(crowd, 300);
      crowd.set_goals(ids, random_goals(world, ids.size(), 5));
      for (int step = 0; step < 40; ++step) crowd.step();
      ASSERT_EQ(crowd.state_hash(), 2493904472131531885u) << name << ' ' << workers;
    }
  });
}

TEST(Crowd, AnAvatarWalksThroughADoorAndUpStairs) {
  const World door = test::bake(worlds::doorway(1.0), 0.1);
  Crowd crowd = made(door);
  const AvatarId id = added(crowd, door.random_place(0, 1, 0));
  const Place goal = door.random_place(0, 1, 3);
  const Vec3d from = position(crowd, id);
  crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
  const double far = std::hypot(goal.position.x - from.x, goal.position.z - from.z);
  EXPECT_LT(steps_to_arrive(crowd, id, 600), 10 * (far / 1.3 + 10));
  expect_no_faults(crowd);

  const World stairs = test::bake(worlds::steps(0.2, 0.4, 10), 0.1);
  Crowd climbers = made(stairs);
  Place low, high;
  for (uint64_t n = 0; n < 100; ++n) {
    const Place place = stairs.random_place(0, 2, n);
    if (!low || place.position.y < low.position.y) low = place;
    if (!high || place.position.y > high.position.y) high = place;
  }
  ASSERT_GT(high.position.y - low.position.y, 1);
  const AvatarId climber = added(climbers, low);
  climbers.set_goals(std::span(&climber, 1), std::span(&high, 1));
  EXPECT_LT(steps_to_arrive(climbers, climber, 400), 400);
  EXPECT_NEAR(position(climbers, climber).y, high.position.y, 0.45);
}

// Among pillars around the corner of four tiles, along lines that run exactly through points that
// four cells share.
TEST(Crowd, PathsThatAreLookedUpAreAsShortAsThoseOfTheSearch) {
  constexpr int32_t kSide = 80, kFirst = 54, kWindow = 20;
  FlatCells cells{.width = kSide, .depth = kSide, .passable = {}};
  for (uint64_t i = 0; i < uint64_t{kSide} * kSide; ++i)
    cells.passable.push_back(random_below(1, 0, i, 60) == 0 ? 0 : 1);
  const auto world = bake_flat_cells(cells, 2);
  ASSERT_TRUE(world);
  std::vector<Crowd> crowds;
  crowds.push_back(made(*world));
  crowds.push_back(made(*world, {.speedup = PathSpeedup::kLabels}));
  crowds.push_back(made(*world, {.speedup = PathSpeedup::kZones}));
  int straight = 0;
  for (uint64_t n = 0; n < 100; ++n) {
    const auto middle = [&](uint64_t use) {
      return 2 *
             (static_cast<double>(kFirst + random_below(2, n, use, kWindow)) + 0.5 + 1.0 / 8192);
    };
    const Place from = world->find_place(0, {middle(0), 0, middle(1)}, 0.1);
    const Place to = world->find_place(0, {middle(2), 0, middle(3)}, 0.1);
    if (!from || !to) continue;
    const double x = to.position.x - from.position.x, z = to.position.z - from.position.z;
    if (world->move(0, from, x, z).end != MoveEnd::kArrived) continue;
    SCOPED_TRACE(testing::Message() << "pair " << n);
    int searched = 0;
    for (Crowd& crowd : crowds) {
      const AvatarId id = added(crowd, from);
      crowd.set_goals(std::span(&id, 1), std::span(&to, 1));
      const int steps = steps_to_arrive(crowd, id, 2000);
      if (&crowd == &crowds[0]) searched = steps;
      EXPECT_EQ(steps, searched) << "crowd " << &crowd - crowds.data();
      crowd.remove(std::span(&id, 1));
    }
    ++straight;
  }
  EXPECT_GT(straight, 20);
}

TEST(Crowd, UnreachableGoalsAreReported) {
  Scene scene = worlds::flat(20);
  scene.add_box({8, 0, 8}, {12, 1.5, 12});
  const World world = test::bake(scene, 0.1);
  const Place low = world.find_place(0, {4, 0, 4}, 0.5);
  const Place high = world.find_place(0, {10, 1.5, 10}, 0.5);
  ASSERT_TRUE(low && high);
  Crowd crowd = made(world);
  const AvatarId id = added(crowd, low);
  crowd.set_goals(std::span(&id, 1), std::span(&high, 1));
  EXPECT_EQ(crowd.step().no_path, 1u);
  ASSERT_EQ(crowd.goal_unreachable().size(), 1u);
  EXPECT_EQ(crowd.goal_unreachable()[0], id);
  crowd.step();
  EXPECT_TRUE(crowd.goal_unreachable().empty());
}

TEST(Crowd, AvatarsOnFloorsAboveEachOtherIgnoreEachOther) {
  const World world = test::bake(worlds::two_floors(), 0.1);
  Crowd crowd = made(world);
  std::vector<AvatarId> ids;
  const std::vector<Place> goals{world.find_place(0, {9, 0, 4}, 0.5),
                                 world.find_place(0, {6, 3, 4}, 0.5)};
  for (const Vec3d& at : {Vec3d{6, 0, 4}, Vec3d{9, 3, 4}}) {  // one below the other
    ids.push_back(added(crowd, world.find_place(0, at, 0.5)));
    ASSERT_TRUE(ids.back());
  }
  crowd.set_goals(ids, goals);
  for (int step = 0; step < 5; ++step) crowd.step();  // until they walk at their speed
  for (int step = 0; step < 15; ++step) EXPECT_GT(crowd.step().progress, 0.99);
}

TEST(Crowd, IdsAreNeverGivenTwiceAndOldOnesNameNoAvatar) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Crowd crowd = made(world);
  const auto ids = scattered(crowd, 50);
  crowd.remove(std::span(ids).first(25));
  EXPECT_EQ(crowd.size(), 25u);
  EXPECT_FALSE(crowd.is_alive(ids[3]));
  EXPECT_TRUE(crowd.is_alive(ids[30]));
  const auto more = scattered(crowd, 30);
  for (const AvatarId id : more) EXPECT_EQ(std::count(ids.begin(), ids.end(), id), 0);
  const auto goals = random_goals(world, ids.size(), 1);
  crowd.set_goals(ids, goals);  // half of them name no avatar
  crowd.remove(ids);
  crowd.remove(ids);
  EXPECT_EQ(crowd.size(), 30u);
  for (int step = 0; step < 20; ++step) crowd.step();
  expect_no_faults(crowd);
  crowd.remove(more);
  EXPECT_EQ(crowd.size(), 0u);
  EXPECT_EQ(crowd.step().avatars, 0u);
}

TEST(Crowd, NoAvatarIsAddedWhereItWouldTouchAnotherOrCannotStand) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Crowd crowd = made(world);
  const Place place = world.find_place(0, {10, 0, 10}, 0.5);
  EXPECT_TRUE(added(crowd, place));
  EXPECT_FALSE(added(crowd, place));
  EXPECT_FALSE(added(crowd, world.find_place(0, {10.3, 0, 10}, 0.5)));
  EXPECT_TRUE(added(crowd, world.find_place(0, {10.6, 0, 10}, 0.5)));
  EXPECT_FALSE(added(crowd, {}));
  EXPECT_FALSE(added(crowd, {{1e9, 0, 1e9}, 1}));
  EXPECT_FALSE(added(crowd, {{NAN, 0, 5}, 1}));
  Context context;
  const auto none = crowd.scatter(100000, {}, context);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kLimit);
  EXPECT_EQ(crowd.size(), 2u);
}

TEST(Crowd, AnExternallyControlledAvatarMovesAsControlledAndOthersYield) {
  const World world = test::bake(worlds::flat(30), 0.1);
  Crowd crowd = made(world);
  const AvatarId player = added(crowd, world.find_place(0, {5, 0, 15}, 0.5));
  const AvatarId other = added(crowd, world.find_place(0, {10, 0, 15}, 0.5));
  const Vec3d east{50, 0, 0};  // clamped to the speed of the class
  crowd.set_velocities(std::span(&player, 1), std::span(&east, 1));
  const Place goal = world.find_place(0, {2, 0, 15}, 0.5);
  crowd.set_goals(std::span(&other, 1), std::span(&goal, 1));
  for (int step = 0; step < 60; ++step) {
    crowd.step();
    expect_no_faults(crowd);
  }
  EXPECT_GT(position(crowd, player).x, 5 + 6 * 1.2);
  const Vec3d nonsense{NAN, 0, INFINITY};
  crowd.set_velocities(std::span(&player, 1), std::span(&nonsense, 1));
  const Vec3d before = position(crowd, player);
  crowd.step();
  EXPECT_NEAR(position(crowd, player).x, before.x, 0.3);
}

TEST(Crowd, FastAndSmallOnesDoNotPassThroughOthers) {
  const World world = test::bake(worlds::flat(30), 0.1);
  Crowd crowd = made(world, {.dt = 0.5});
  const auto slow = scattered(crowd, 60, {.speed = 0.5});
  const auto fast = scattered(crowd, 60, {.radius = 0.1, .speed = 8});
  crowd.set_goals(slow, random_goals(world, slow.size(), 1));
  crowd.set_goals(fast, random_goals(world, fast.size(), 2));
  for (int step = 0; step < 40; ++step) {
    crowd.step();
    expect_no_faults(crowd);
  }
}

// In one of two steps it continues with its last move, which is longer than its new speed allows.
TEST(Crowd, AnAvatarThatSuddenlyHasToWalkSlowlyTouchesNoOther) {
  const World world = test::bake(worlds::flat(30), 0.1);
  for (int steps = 10; steps < 14; ++steps) {
    Crowd crowd = made(world, {.dt = 0.1});
    const AvatarId walker = added(crowd, world.find_place(0, {5, 0, 15}, 0.5), {.speed = 2});
    const Place goal = world.find_place(0, {25, 0, 15}, 0.5);
    crowd.set_goals(std::span(&walker, 1), std::span(&goal, 1));
    for (int step = 0; step < steps; ++step) crowd.step();
    const double x = position(crowd, walker).x;
    EXPECT_GT(x, 6);
    const double gap = 0.05;
    const Place ahead = world.find_place(0, {x + 2 * 0.25 + gap, 0, 15}, 0.5);
    ASSERT_TRUE(added(crowd, ahead, {.speed = 0.05}));
    const double slow = 0.1;
    crowd.set_speeds(std::span(&walker, 1), std::span(&slow, 1));
    crowd.step();
    expect_no_faults(crowd);
    EXPECT_LE(position(crowd, walker).x, x + slow * 0.1 + 0.001) << steps;
  }
}

// A step is no longer than 16 bits hold: longer ones are split.
TEST(Crowd, GiantsWithLongStepsTouchNoOther) {
  const World world = test::bake(worlds::flat(60), 0.02);
  Crowd crowd = made(world, {.dt = 0.5});
  const auto giants = scattered(crowd, 6, {.radius = 2, .speed = 8});
  const auto others = scattered(crowd, 60, {.speed = 1.5});
  crowd.set_goals(giants, random_goals(world, giants.size(), 1));
  crowd.set_goals(others, random_goals(world, others.size(), 2));
  for (int step = 0; step < 30; ++step) {
    crowd.step();
    expect_no_faults(crowd);
  }
}

TEST(Crowd, AnAvatarTakesNoMoreThan284BytesBesideItsPath) {
  const World world = test::bake(worlds::flat(200), 0.1);
  for (const uint32_t count : {20'000u, 21'846u, 32'769u}) {
    Crowd crowd = made(world, {.workers = 2});
    const auto ids = scattered(crowd, count, {.radius = 0.2});
    crowd.set_goals(ids, random_goals(world, count, 3));
    for (int step = 0; step < 5; ++step) crowd.step();
    EXPECT_LE(crowd.memory().avatars, 284 * count);
    EXPECT_GE(crowd.memory().paths, 100 * count);
  }
}

TEST(Crowd, ARestoredCrowdContinuesAsTheSavedOneWould) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  Crowd crowd = made(world);
  const auto ids = scattered(crowd, 150);
  crowd.set_goals(ids, random_goals(world, ids.size(), 5));
  for (int step = 0; step < 30; ++step) crowd.step();
  crowd.remove(std::span(ids).first(20));
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  auto restored = Crowd::restore(world, {.workers = 3}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->state_hash(), crowd.state_hash());
  for (Crowd* c : {&crowd, &*restored}) {
    for (int step = 0; step < 30; ++step) c->step();
    scattered(*c, 10);
    for (int step = 0; step < 10; ++step) c->step();
  }
  EXPECT_EQ(restored->state_hash(), crowd.state_hash());
  EXPECT_FALSE(restored->is_alive(ids[3]));
  EXPECT_TRUE(restored->is_alive(ids[30]));
  expect_no_faults(*restored);
}

TEST(Crowd, WhatIsNoSavedCrowdIsRefused) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Crowd crowd = made(world);
  scattered(crowd, 5);
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  const auto refused = [&](const World& in, const CrowdConfig& config,
                           std::span<const uint8_t> bytes) {
    const auto restored = Crowd::restore(in, config, bytes, context);
    return restored ? std::string("accepted") : restored.error().message;
  };
  EXPECT_EQ(refused(world, {}, saved), "accepted");
  for (size_t size = 0; size < saved.size(); ++size) {
    ASSERT_NE(refused(world, {}, std::span(saved).first(size)), "accepted") << size;
  }
  for (size_t i = 0; i < saved.size(); ++i) {
    std::vector<uint8_t> other = saved;
    other[i] ^= 1;
    ASSERT_NE(refused(world, {}, other), "accepted") << i;
  }
  EXPECT_NE(refused(test::bake(worlds::flat(21), 0.1), {}, saved), "accepted");
  EXPECT_EQ(refused(world, {.seed = 2}, saved),
            "crowd: what was saved has other settings; give those that it was made with");
}

TEST(Crowd, BadSettingsAreNamed) {
  const World world = test::bake(worlds::flat(10), 0.1);
  const auto refused = [&](const CrowdConfig& config) {
    const auto crowd = Crowd::create(world, config);
    return crowd ? std::string("accepted") : crowd.error().message;
  };
  EXPECT_EQ(refused({.dt = 0}), "crowd: dt must be 0.001 to 1 s");
  EXPECT_EQ(refused({.dt = NAN}), "crowd: dt must be 0.001 to 1 s");
  EXPECT_EQ(refused({.workers = -1}), "crowd: workers must be 0 (all cores) or more");
  EXPECT_EQ(refused({.tuning = {.sight = 0}}), "crowd: sight must be 1 to 50 m");
  EXPECT_EQ(refused({.tuning = {.rounds = 0}}), "crowd: rounds must be 1 to 100");
  EXPECT_FALSE(Crowd::create({}, {}));
  Crowd crowd = made(world);
  Context context;
  const auto spawn = [&](const AvatarSpawn& like) {
    const auto ids = crowd.scatter(1, like, context);
    return ids ? std::string("accepted") : ids.error().message;
  };
  EXPECT_EQ(spawn({.speed = -1}), "crowd: speed must be 0 (the class's) to 100 m/s");
  EXPECT_EQ(spawn({.radius = NAN}),
            "crowd: radius must be 0 (the class's) to 100 m, and at most 4000 cells");
  EXPECT_NE(spawn({.avatar_class = 9}), "accepted");
}

TEST(Crowd, SpeedsBoundTheMovesAndUnknownIdsAreIgnored) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  Crowd crowd = made(world, {.dt = 0.1});
  const auto ids = scattered(crowd, 60);
  crowd.set_goals(ids, random_goals(world, ids.size(), 5));
  std::vector<double> speeds;
  for (size_t i = 0; i < ids.size(); ++i) speeds.push_back(0.2 + 0.05 * static_cast<double>(i));
  crowd.set_speeds(ids, speeds);
  const AvatarId unknown[] = {{}, {.slot1 = 5, .generation = 77}, {.slot1 = 1000, .generation = 0}};
  const double any[] = {50, 50, 50};
  crowd.set_speeds(unknown, any);

  std::vector<double> farthest(ids.size());
  std::vector<Vec3d> before(ids.size());
  for (int step = 0; step < 100; ++step) {
    for (size_t i = 0; i < ids.size(); ++i) before[i] = crowd.read(ids[i])->position;
    crowd.step();
    for (size_t i = 0; i < ids.size(); ++i) {
      const Vec3d d = crowd.read(ids[i])->position - before[i];
      farthest[i] = std::max(farthest[i], std::hypot(d.x, d.z) / 0.1);
    }
  }
  size_t near_their_speed = 0;
  for (size_t i = 0; i < ids.size(); ++i) {
    EXPECT_LE(farthest[i], speeds[i] * 1.001 + 0.01) << i;
    near_their_speed += farthest[i] > 0.9 * speeds[i] ? 1 : 0;
  }
  EXPECT_GT(near_their_speed, ids.size() / 2);
  expect_no_faults(crowd);
  const CrowdMemory memory = crowd.memory();
  EXPECT_EQ(memory.total(), memory.avatars + memory.paths + memory.ground);
  EXPECT_GT(memory.avatars, 0u);
  EXPECT_FALSE(crowd.may_lean());
}

// Beside a crowd that was given only what it can use: the same steps, and the crowd can be
// restored.
TEST(Crowd, SpeedsThatNoneCanHaveAreIgnored) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  Crowd crowd = made(world), twin = made(world);
  const auto ids = scattered(crowd, 40);
  ASSERT_EQ(scattered(twin, 40), ids);
  const auto goals = random_goals(world, ids.size(), 5);
  crowd.set_goals(ids, goals);
  twin.set_goals(ids, goals);
  crowd.step();
  twin.step();
  for (const double bad :
       {double{NAN}, 0.0, -1.0, -double{INFINITY}, 1e-320, 1e-60, 100.001, 1e9, double{INFINITY}}) {
    crowd.set_speeds(ids, std::vector(ids.size(), bad));
    ASSERT_EQ(crowd.state_hash(), twin.state_hash()) << bad;
  }
  // One that is ignored does not keep the next from its own.
  const AvatarId two[] = {ids[1], ids[2]};
  const double speeds[] = {NAN, 0.5};
  crowd.set_speeds(two, speeds);
  EXPECT_NE(crowd.state_hash(), twin.state_hash());
  twin.set_speeds(std::span(two).last(1), std::span(speeds).last(1));
  for (int step = 0; step < 20; ++step) crowd.step();
  for (int step = 0; step < 20; ++step) twin.step();
  EXPECT_EQ(crowd.state_hash(), twin.state_hash());
  Context context;
  auto restored = Crowd::restore(world, {}, crowd.save(), context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->state_hash(), crowd.state_hash());
}

TEST(Crowd, NoAvatarGetsASpeedThatAddRefuses) {
  const World world = test::bake(worlds::flat(10), 0.1);
  Crowd crowd = made(world, {.dt = 1});
  const auto ids = scattered(crowd, 1, {.radius = 0.05});
  ASSERT_EQ(ids.size(), 1u);
  const auto hash_at = [&](double speed) {
    crowd.set_speeds(ids, std::span(&speed, 1));
    return crowd.state_hash();
  };
  Context context;
  const auto add_takes = [&](double speed) {
    return static_cast<bool>(crowd.scatter(1, {.radius = 0.05, .speed = speed}, context));
  };
  const uint64_t slow = hash_at(1);
  // 1000 radii a step are 50 m/s.
  ASSERT_FALSE(add_takes(60));
  EXPECT_EQ(hash_at(60), slow);
  EXPECT_NE(hash_at(49), slow);
  ASSERT_TRUE(add_takes(49));
  // As a float it is 0.
  EXPECT_FALSE(add_takes(1e-60));
}

TEST(Crowd, GoalsAndVelocitiesThatAreNotFiniteStandForNone) {
  const World world = test::bake(worlds::flat(10), 0.1);
  Crowd crowd = made(world), twin = made(world);
  const auto ids = scattered(crowd, 5);
  ASSERT_EQ(scattered(twin, 5), ids);
  const Place here = world.find_place(0, {5, 0, 5}, 0.5);
  std::vector<Place> bad(5, here), none(5);
  bad[0].position.x = NAN;
  bad[1].position.z = INFINITY;
  bad[2].position.x = -1e300;
  bad[3].level1 = 77;
  bad[4].level1 = kAirLevel1;
  crowd.set_goals(ids, bad);
  twin.set_goals(ids, none);
  crowd.step();
  twin.step();
  EXPECT_EQ(crowd.state_hash(), twin.state_hash());
  EXPECT_EQ(crowd.step().planned, 0u);
  twin.step();
  const std::vector<Vec3d> wild = {
      {NAN, 0, 0}, {0, 0, INFINITY}, {-INFINITY, 0, INFINITY}, {1e300, 0, 0}, {0, 0, NAN}};
  crowd.set_velocities(ids, wild);
  twin.set_velocities(ids, std::vector<Vec3d>(5));
  for (int step = 0; step < 5; ++step) {
    crowd.step();
    twin.step();
    ASSERT_EQ(crowd.state_hash(), twin.state_hash()) << step;
  }
}

}  // namespace
}  // namespace throng
