// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "baked.h"
#include "core/hash.h"
#include "crowds.h"
#include "density_picture.h"
#include "throng/crowd.h"
#include "worlds.h"

// Avatars that follow a density map: where its weight is 0 none of them ever stands. What is 0, the
// test reads from the picture itself.
namespace throng {
namespace {

using test::DensityPicture;

DensityGrid grid_of(const DensityPicture& picture) {
  return {.x0 = 0,
          .z0 = 0,
          .x1 = picture.width * picture.side,
          .z1 = picture.height * picture.side,
          .width = picture.width,
          .height = picture.height,
          .weights = picture.weights};
}

// 40 by 30 m: a strip of 0 across the hall with a gap of 2 m, and one aslant that ends in the hall.
DensityPicture streets() {
  return {80, 60, 0.5, [](double x, double z) {
            const bool across = std::fabs(x - 20) < 1.5 && std::fabs(z - 15) > 1;
            const bool aslant = std::fabs(z - x - 3) < 0.8 && x < 14;
            return across || aslant ? 0 : 200;
          }};
}

int32_t density_class(Crowd& crowd, int32_t of, const DensityPicture& picture) {
  Context context;
  const auto made = crowd.add_density_class(of, grid_of(picture), context);
  EXPECT_TRUE(made) << made.error().message;
  return made ? *made : 0;
}

size_t on_zero(const Crowd& crowd, const DensityPicture& picture) {
  std::vector<AvatarState> states;
  crowd.read(states);
  size_t count = 0;
  for (const AvatarState& s : states) {
    count += picture.weight(s.position.x, s.position.z) == 0 ? 1 : 0;
  }
  return count;
}

void expect_sound(const Crowd& crowd) {
  const CrowdCheck found = crowd.check();
  EXPECT_EQ(found.overlaps + found.wall_entries, 0U);
}

// Adults and children in the west, whose goals lie in the east behind the gap.
struct Press {
  World world = test::bake(worlds::flat(40), 0.1);
  DensityPicture picture = streets();
  Crowd crowd;
  std::array<int32_t, 2> classes{};
  std::vector<AvatarId> ids;

  explicit Press(int32_t workers, bool queues)
      : crowd(made(world, {.seed = 7, .workers = workers, .tuning = {.queues = queues}})) {
    Context context;
    const int32_t child = *world.find_class("child");
    classes = {density_class(crowd, 0, picture), density_class(crowd, child, picture)};
    std::vector<AvatarSpawn> spawns;
    for (int i = 0; i < 500; ++i) {
      const double x = 1 + (i % 25) * 0.7, z = 3 + static_cast<double>(i / 25) * 1.2;
      const bool is_child = i % 3 == 0;
      spawns.push_back({.place = world.find_place(is_child ? child : 0, {x, 0, z}, 0.5),
                        .avatar_class = classes[is_child ? 1 : 0]});
    }
    const auto added = crowd.add(spawns, context);
    EXPECT_TRUE(added) << added.error().message;
    for (const AvatarId id : *added) {
      if (id) ids.push_back(id);
    }
    std::vector<Place> goals;
    for (size_t i = 0; i < ids.size(); ++i) {
      goals.push_back(world.find_place(
          0, {24 + static_cast<double>(i % 20) * 0.7, 0, 2 + static_cast<double>(i / 20)}, 0.5));
    }
    crowd.set_goals(ids, goals);
  }
};

TEST(DensityClass, AvatarsThatPushAndSeveralClassesNeverEnterWeight0) {
  for (const bool queues : {true, false}) {
    Press run(2, queues);
    EXPECT_GT(run.ids.size(), 380U);
    EXPECT_LT(run.ids.size(), 500U) << "some would stand on weight 0";
    for (int step = 0; step < 600; ++step) {
      run.crowd.step();
      ASSERT_EQ(on_zero(run.crowd, run.picture), 0U) << "step " << step;
      if (step % 20 == 0) expect_sound(run.crowd);
    }
    std::vector<AvatarState> states;
    run.crowd.read(states);
    size_t east = 0;
    for (const AvatarState& s : states) {
      east += s.position.x > 21 ? 1 : 0;
      EXPECT_LT(s.avatar_class, 8) << "it is that of the world";
    }
    EXPECT_GT(east, run.ids.size() / 4) << "they come through the gap";
  }
}

TEST(DensityClass, OneThatIsControlledStopsBeforeWeight0) {
  const World world = test::bake(worlds::flat(40), 0.1);
  const DensityPicture picture = streets();
  Crowd crowd = made(world);
  const int32_t number = density_class(crowd, 0, picture);
  const AvatarId id = added(crowd, world.find_place(0, {15, 0, 5}, 0.5), {.avatar_class = number});
  const Vec3d east{1, 0, 0.1};
  crowd.set_velocities({&id, 1}, {&east, 1});
  for (int step = 0; step < 200; ++step) {
    crowd.step();
    ASSERT_EQ(on_zero(crowd, picture), 0U);
  }
  EXPECT_GT(crowd.read(id)->position.x, 18);
}

TEST(DensityClass, GroundThatBecomes0IsLeftAndNotEntered) {
  Press run(2, /*queues=*/true);
  // Then a belt of the east is 0, in which some walk by now, and the gap stays.
  const DensityPicture later(80, 60, 0.5, [&](double x, double z) {
    const bool belt = x > 17 && x < 30;
    const bool gap = std::fabs(z - 15) < 1 && x < 22;
    return run.picture.weight(x, z) == 0 || (belt && !gap) ? 0 : 200;
  });
  for (int step = 0; step < 250; ++step) run.crowd.step();
  ASSERT_TRUE(run.crowd.set_density(run.classes[0], later.weights));
  ASSERT_TRUE(run.crowd.set_density(run.classes[1], later.weights));
  std::map<uint32_t, bool> was_on_zero;
  std::vector<AvatarState> states;
  run.crowd.read(states);
  size_t first = 0, last = 0;
  for (const AvatarState& s : states) {
    was_on_zero[s.id] = later.weight(s.position.x, s.position.z) == 0;
    first += was_on_zero[s.id] ? 1 : 0;
  }
  EXPECT_GT(first, 20U);
  for (int step = 0; step < 400; ++step) {
    run.crowd.step();
    run.crowd.read(states);
    last = 0;
    for (const AvatarState& s : states) {
      const bool is_on_zero = later.weight(s.position.x, s.position.z) == 0;
      ASSERT_TRUE(was_on_zero[s.id] || !is_on_zero) << "avatar " << s.id << " step " << step;
      was_on_zero[s.id] = is_on_zero || (was_on_zero[s.id] && later.is_beside_zero(s.position));
      last += is_on_zero ? 1 : 0;
    }
    if (step % 20 == 0) expect_sound(run.crowd);
  }
  EXPECT_EQ(last, 0U) << "of " << first;
  // And back: the belt is open again.
  ASSERT_TRUE(run.crowd.set_density(run.classes[0], run.picture.weights));
  for (int step = 0; step < 50; ++step) run.crowd.step();
  EXPECT_EQ(on_zero(run.crowd, run.picture), 0U);
}

TEST(DensityClass, SameBytesForAnyWorkersAndWhenRestored) {
  uint64_t hash = 0;
  for (const int32_t workers : {1, 2, 5}) {
    Press run(workers, /*queues=*/true);
    for (int step = 0; step < 100; ++step) run.crowd.step();
    DensityPicture later = run.picture;
    for (size_t i = 0; i < later.weights.size(); i += 7) later.weights[i] = 0;
    ASSERT_TRUE(run.crowd.set_density(run.classes[0], later.weights));
    for (int step = 0; step < 5; ++step) run.crowd.step();
    const std::vector<uint8_t> saved = run.crowd.save();
    Context context;
    auto again = Crowd::restore(run.world, {.seed = 7, .workers = 3, .tuning = {.queues = true}},
                                saved, context);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->save(), saved);
    for (int step = 0; step < 60; ++step) {
      run.crowd.step();
      again->step();
      ASSERT_EQ(again->state_hash(), run.crowd.state_hash()) << "step " << step;
    }
    if (hash == 0) hash = run.crowd.state_hash();
    EXPECT_EQ(run.crowd.state_hash(), hash) << workers << " workers";
  }
}

TEST(DensityClass, SavedNonsenseIsRefusedOrHarmless) {
  const World world = test::bake(worlds::flat(12), 0.25);
  const DensityPicture picture(6, 6, 2, [](double x, double) { return x > 4 && x < 8 ? 0 : 9; });
  Crowd crowd = made(world, {.workers = 1});
  const int32_t number = density_class(crowd, 0, picture);
  scattered(crowd, 20, {.avatar_class = number});
  std::vector<uint8_t> saved = crowd.save();
  // The map is at the end, before the checksum: a head of 64 bytes, 36 weights, and 4 more.
  const size_t begin = saved.size() - 8 - 64 - 40;
  int accepted = 0, refused = 0;
  Context context;
  for (size_t bit = 8 * begin; bit < 8 * (saved.size() - 8); bit += 3) {
    std::vector<uint8_t> bad = saved;
    bad[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    const uint64_t sum = hash_bytes(bad.data(), bad.size() - 8);
    std::memcpy(bad.data() + bad.size() - 8, &sum, 8);
    auto restored = Crowd::restore(world, {.workers = 1}, bad, context);
    restored ? ++accepted : ++refused;
    if (restored) restored->step();
  }
  EXPECT_GT(accepted, 20);
  EXPECT_GT(refused, 10);
}

TEST(DensityClass, PathsPreferWhereManyWalk) {
  const World world = test::bake(worlds::flat(40), 0.1);
  // Few walk in the lane z < 10, many in that from 10 to 20.
  const auto mean_z = [&](int few) {
    const DensityPicture picture(80, 80, 0.5, [&](double /*x*/, double z) {
      return z < 10 ? few : z < 20 ? 240 : 0;
    });
    Crowd crowd = made(world);
    const int32_t number = density_class(crowd, 0, picture);
    const AvatarId id = added(crowd, world.find_place(0, {2, 0, 7}, 0.5), {.avatar_class = number});
    const Place goal = world.find_place(0, {38, 0, 7}, 0.5);
    crowd.set_goals({&id, 1}, {&goal, 1});
    double sum = 0;
    int steps = 0;
    for (; crowd.arrived().empty() && steps < 1000; ++steps) {
      crowd.step();
      sum += crowd.read(id)->position.z;
    }
    EXPECT_LT(steps, 1000);
    return sum / steps;
  };
  EXPECT_NEAR(mean_z(240), 7, 0.2);
  EXPECT_GT(mean_z(10), 9);
}

TEST(DensityClass, TargetsAndObstaclesWorkAsForOthers) {
  Press run(2, /*queues=*/true);
  Context context;
  const Prism east = Prism::box({30, -1, 10}, {36, 2, 20});
  const auto target = run.crowd.add_target(std::span(&east, 1), context);
  ASSERT_TRUE(target) << target.error().message;
  run.crowd.set_targets(run.ids, *target);
  for (int step = 0; step < 150; ++step) {
    run.crowd.step();
    ASSERT_EQ(on_zero(run.crowd, run.picture), 0U) << "step " << step;
  }
  const auto places = run.crowd.places(*target, run.classes[0], 100, context);
  ASSERT_TRUE(places);
  EXPECT_FALSE(places->empty());
  EXPECT_TRUE(run.crowd.may_stand(run.classes[0], run.world.find_place(0, {30, 0, 5}, 0.5)));
  EXPECT_FALSE(run.crowd.may_stand(run.classes[0], run.world.find_place(0, {20, 0, 5}, 0.5)));
  EXPECT_TRUE(std::isfinite(run.crowd.distance(run.ids[0], *target)));
}

TEST(DensityClass, WhatMakesNoSenseIsRefused) {
  const World world = test::bake(worlds::flat(10), 0.25);
  Crowd crowd = made(world);
  Context context;
  DensityGrid map = grid_of(DensityPicture(4, 4, 2.5, [](double, double) { return 9; }));
  const auto refuse = [&](int32_t of, const DensityGrid& bad, Errc code) {
    const auto made = crowd.add_density_class(of, bad, context);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, code) << made.error().message;
  };
  refuse(-1, map, Errc::kNotFound);
  refuse(99, map, Errc::kNotFound);
  DensityGrid bad = map;
  bad.weights.pop_back();
  refuse(0, bad, Errc::kBadInput);
  bad = map;
  bad.x1 = bad.x0;
  refuse(0, bad, Errc::kBadInput);
  bad.x1 = NAN;
  refuse(0, bad, Errc::kBadInput);
  EXPECT_FALSE(crowd.set_density(0, map.weights)) << "a class of the world";
  const size_t classes = world.summary().classes.size();
  for (size_t n = classes; n < size_t{kMaxAvatarClasses}; ++n) {
    ASSERT_EQ(*crowd.add_density_class(0, map, context), static_cast<int32_t>(n));
  }
  refuse(0, map, Errc::kLimit);
  EXPECT_FALSE(crowd.set_density(15, std::vector<uint8_t>(3, 1)));
  EXPECT_TRUE(crowd.set_density(15, std::vector<uint8_t>(16, 0)));
  EXPECT_FALSE(crowd.may_stand(15, world.find_place(0, {5, 0, 5}, 0.5)));
}

}  // namespace
}  // namespace throng
