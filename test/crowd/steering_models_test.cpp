// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <vector>

#include "baked.h"
#include "crowds.h"
#include "throng/avatar.h"
#include "throng/crowd.h"
#include "worlds.h"

namespace throng {
namespace {

constexpr SteeringModel kModels[] = {SteeringModel::kSampled, SteeringModel::kCurvilinear,
                                     SteeringModel::kSocialForce};

std::vector<AvatarId> with_goals(Crowd& crowd, const World& world, uint32_t count) {
  const auto ids = scattered(crowd, count);
  std::vector<Place> goals;
  for (size_t i = 0; i < ids.size(); ++i) goals.push_back(world.random_place(0, 5, i));
  crowd.set_goals(ids, goals);
  return ids;
}

// Whatever velocity a model prefers, no avatar touches another or enters a wall, and most progress.
TEST(SteeringModels, NoAvatarEntersAWallOrAnotherWithAnyModel) {
  for (const SteeringModel model : kModels) {
    for (const char* name : {"garage", "stairs", "maze"}) {
      const World world = test::bake(test::builtin({.name = name, .seed = 3}), 0.1);
      Crowd crowd = made(world, {.model = model});
      with_goals(crowd, world, 200);
      uint64_t moved = 0;
      for (int step = 0; step < 100; ++step) {
        const CrowdReport report = crowd.step();
        moved += report.avatars - report.stood;
        const CrowdCheck check = crowd.check();
        ASSERT_EQ(check.overlaps + check.wall_entries, 0U) << name_of(model) << ' ' << name;
      }
      EXPECT_GT(moved, 100U * 200 / 4) << name_of(model) << ' ' << name;
    }
  }
}

TEST(SteeringModels, StatesAreTheSameForAnyWorkersAndDifferByModel) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  std::vector<uint64_t> hashes;
  for (const SteeringModel model : kModels) {
    for (const int32_t workers : {1, 3}) {
      Crowd crowd = made(world, {.workers = workers, .model = model});
      with_goals(crowd, world, 300);
      for (int step = 0; step < 40; ++step) crowd.step();
      hashes.push_back(crowd.state_hash());
    }
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[2], hashes[3]);
  EXPECT_EQ(hashes[4], hashes[5]);
  EXPECT_NE(hashes[0], hashes[2]);
  EXPECT_NE(hashes[2], hashes[4]);
}

TEST(SteeringModels, ASavedCrowdContinuesWithItsModelAndNoOther) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  for (const SteeringModel model : kModels) {
    Crowd crowd = made(world, {.model = model});
    with_goals(crowd, world, 100);
    for (int step = 0; step < 20; ++step) crowd.step();
    const auto saved = crowd.save();
    Context context;
    auto again = Crowd::restore(world, {.model = model}, saved, context);
    ASSERT_TRUE(again) << again.error().message;
    for (int step = 0; step < 20; ++step) {
      crowd.step();
      again->step();
    }
    EXPECT_EQ(crowd.state_hash(), again->state_hash());
    for (const SteeringModel other : kModels) {
      EXPECT_EQ(bool(Crowd::restore(world, {.model = other}, saved, context)), other == model);
    }
  }
}

// An externally controlled avatar moves as it is controlled.
TEST(SteeringModels, VelocitiesFromOutsideArePreferredVelocities) {
  const World world = test::bake(worlds::flat(20), 0.1);
  for (const SteeringModel model : kModels) {
    Crowd crowd = made(world, {.model = model});
    const AvatarId id = added(crowd, world.find_place(0, {5, 0, 5}, 0.5));
    const Vec3d velocity{1, 0, 0};
    crowd.set_velocities({&id, 1}, {&velocity, 1});
    for (int step = 0; step < 50; ++step) crowd.step();
    const auto state = crowd.read(id);
    ASSERT_TRUE(state);
    EXPECT_GT(state->position.x, 8.5) << name_of(model);
    EXPECT_NEAR(state->position.z, 5, 0.1) << name_of(model);
  }
}

}  // namespace
}  // namespace throng
