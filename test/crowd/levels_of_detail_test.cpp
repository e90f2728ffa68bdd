// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "worlds.h"

namespace throng {
namespace {

// Pairs that overlap: all pairs, by public state alone.
uint64_t overlapping(const Crowd& crowd, double radius, double height) {
  std::vector<AvatarState> all;
  crowd.read(all);
  uint64_t found = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    for (size_t j = i + 1; j < all.size(); ++j) {
      const Vec3d d = all[i].position - all[j].position;
      const bool same_floor = std::fabs(d.y) < height - 1e-3;
      found += same_floor && d.x * d.x + d.z * d.z < 4 * radius * radius - 1e-6;
    }
  }
  return found;
}

void give_goals(Crowd& crowd, const World& world, std::span<const AvatarId> ids, uint64_t turn) {
  std::vector<Place> goals;
  for (const AvatarId id : ids) goals.push_back(world.random_place(0, turn, id.slot1));
  crowd.set_goals(ids, goals);
}

// Views come, go, jump and grow at random, so that avatars change their level of detail all the
// time.
TEST(LevelsOfDetail, NoAvatarTouchesAnotherWhileViewsMoveAtRandom) {
  for (const SteeringModel model : {SteeringModel::kSampled, SteeringModel::kSocialForce}) {
    for (const char* name : {"garage", "maze", "stairs"}) {
      const World world = test::bake(test::builtin({.name = name, .seed = 3}), 0.1);
      Crowd crowd = made(world, {.dt = 0.05, .model = model, .tuning = {.low_detail_steps = 6}});
      const auto ids = scattered(crowd, 250);
      give_goals(crowd, world, ids, 1);
      const AvatarClass body = world.summary().classes[0];
      uint64_t draws = 0, low_detail = 0, skipped = 0, moved = 0;
      const auto unit = [&] { return random_unit(9, 1, draws++); };
      for (int step = 0; step < 200; ++step) {
        if (unit() < 0.3) {
          std::vector<CrowdView> views;
          for (int n = static_cast<int>(4 * unit()); n > 0; --n) {
            const Place at = world.random_place(0, 77, draws++);
            views.push_back({at.position, 12 * unit()});
          }
          crowd.set_views(views);
        }
        const CrowdReport report = crowd.step();
        low_detail += report.low_detail;
        skipped += report.skipped;
        moved += report.avatars - report.stood - report.skipped;
        give_goals(crowd, world, crowd.arrived(), report.step + 2);
        ASSERT_EQ(overlapping(crowd, body.radius, body.height), 0U) << name << ' ' << step;
        const CrowdCheck check = crowd.check();
        ASSERT_EQ(check.overlaps + check.wall_entries, 0U) << name << ' ' << step;
      }
      EXPECT_GT(low_detail, 200U * 250 / 5) << name;
      EXPECT_GT(skipped, low_detail / 3) << name;
      EXPECT_LT(skipped, low_detail) << name;
      EXPECT_GT(moved, 200U * 250 / 6) << name;
    }
  }
}

// A view of all changes nothing; and avatars in low detail reach their goals, too.
TEST(LevelsOfDetail, AViewOfAllChangesNothingAndLowDetailAvatarsArrive) {
  const World world = test::bake(worlds::flat(30), 0.1);
  Crowd none = made(world), all = made(world), low_detail = made(world);
  const CrowdView everything{{15, 0, 15}, 100}, nothing{{-500, 0, 0}, 1};
  all.set_views({&everything, 1});
  low_detail.set_views({&nothing, 1});
  uint64_t arrived = 0;
  for (Crowd* crowd : {&none, &all, &low_detail})
    give_goals(*crowd, world, scattered(*crowd, 100), 4);
  for (int step = 0; step < 600; ++step) {
    none.step();
    all.step();
    const CrowdReport report = low_detail.step();
    EXPECT_EQ(report.low_detail, 100U);
    arrived += report.arrived;
    if (step < 100) {
      ASSERT_EQ(none.state_hash(), all.state_hash()) << step;
    }
  }
  EXPECT_EQ(arrived, 100U);
}

TEST(LevelsOfDetail, ViewsThatAreNoneAreLeftOut) {
  const World world = test::bake(worlds::flat(30), 0.1);
  Crowd crowd = made(world);
  give_goals(crowd, world, scattered(crowd, 20), 4);
  const CrowdView bad[] = {
      {{NAN, 0, 0}, 10}, {{0, INFINITY, 0}, 10}, {{15, 0, 15}, NAN}, {{15, 0, 15}, -100}};
  const CrowdView far{{-500, 0, 0}, 1};
  crowd.set_views(bad);
  EXPECT_EQ(crowd.step().low_detail, 0U) << "there is no view";
  std::vector<CrowdView> all(std::begin(bad), std::end(bad));
  all.push_back(far);
  crowd.set_views(all);
  EXPECT_EQ(crowd.step().low_detail, 20U) << "the one view is far off";
}

TEST(LevelsOfDetail, StatesAreTheSameForAnyWorkersAndWhenRestored) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  const CrowdView view{world.random_place(0, 5, 5).position, 8};
  std::vector<uint64_t> hashes;
  std::vector<uint8_t> saved;
  for (const int32_t workers : {1, 3}) {
    Crowd crowd = made(world, {.dt = 0.05, .workers = workers});
    give_goals(crowd, world, scattered(crowd, 300), 4);
    crowd.set_views({&view, 1});
    for (int step = 0; step < 30; ++step) crowd.step();
    saved = crowd.save();
    for (int step = 0; step < 30; ++step) crowd.step();
    hashes.push_back(crowd.state_hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  Context context;
  auto restored = Crowd::restore(world, {.dt = 0.05}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  for (int step = 0; step < 30; ++step) restored->step();
  EXPECT_EQ(restored->state_hash(), hashes[0]);
  EXPECT_FALSE(
      Crowd::restore(world, {.dt = 0.05, .tuning = {.low_detail_steps = 2}}, saved, context));
}

// No avatar moves farther at once than the narrowest body is wide.
TEST(LevelsOfDetail, NoAvatarJumpsThroughAnother) {
  const World world = test::bake(worlds::flat(30), 0.1);
  Crowd crowd = made(world, {.dt = 0.05, .tuning = {.low_detail_steps = 16}});
  const AvatarId id = added(crowd, world.find_place(0, {5, 0, 15}, 0.5), {.radius = 0.3});
  added(crowd, world.find_place(0, {25, 0, 25}, 0.5), {.radius = 0.2});
  const Place goal = world.find_place(0, {25, 0, 15}, 0.5);
  crowd.set_goals({&id, 1}, {&goal, 1});
  const CrowdView nothing{{-500, 0, 0}, 1};
  crowd.set_views({&nothing, 1});
  double last = 5, longest = 0;
  for (int step = 0; step < 100; ++step) {
    crowd.step();
    const double x = crowd.read(id)->position.x;
    longest = std::max(longest, x - last);
    last = x;
  }
  EXPECT_LE(longest, 0.2);
  EXPECT_GT(longest, 0.12);  // 1.3 m/s: three steps at once
  EXPECT_GT(last, 5 + 4.5);  // 5 s
}

TEST(LevelsOfDetail, LimitsAreNamed) {
  const World world = test::bake(worlds::flat(10), 0.1);
  const auto why = [&](const CrowdConfig& config) {
    const auto crowd = Crowd::create(world, config);
    return crowd ? std::string() : crowd.error().message;
  };
  EXPECT_EQ(why({.tuning = {.low_detail_steps = 0}}), "crowd: low_detail_steps must be 1 to 16");
  EXPECT_EQ(why({.tuning = {.low_detail_steps = 17}}), "crowd: low_detail_steps must be 1 to 16");
  EXPECT_EQ(why({.tuning = {.low_detail_reaction = -1}}),
            "crowd: low_detail_reaction must be 0 to 10 s");
}

}  // namespace
}  // namespace throng
