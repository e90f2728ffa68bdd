// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "baked.h"
#include "core/hash.h"
#include "crowds.h"
#include "throng/avatar.h"
#include "throng/crowd.h"
#include "worlds.h"

// [CAACD]'s application layer: Mass, MaxForce and MaxSpeed of one avatar or all, while they walk.
namespace throng {
namespace {

const CrowdConfig kCurved{.model = SteeringModel::kCurvilinear};
constexpr CurvilinearTuning kHeavy{.mass = 4, .max_speed = 0.4, .max_force = 0.03};

const World& garage() {
  static const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  return world;
}

std::vector<AvatarId> with_goals(Crowd& crowd, uint32_t count) {
  const auto ids = scattered(crowd, count);
  std::vector<Place> goals;
  for (size_t i = 0; i < ids.size(); ++i) goals.push_back(garage().random_place(0, 5, i));
  crowd.set_goals(ids, goals);
  return ids;
}

void walk(Crowd& crowd, int steps) {
  for (int step = 0; step < steps; ++step) crowd.step();
}

bool same(const CurvilinearTuning& a, const CurvilinearTuning& b) {
  return a.mass == b.mass && a.max_speed == b.max_speed && a.max_force == b.max_force &&
         a.by_state == b.by_state;
}

// Degrees that it turns in a second, when its controller asks for the opposite direction.
double turned(double mass) {
  const World world = test::bake(worlds::flat(30), 0.1);
  Crowd crowd = made(world, kCurved);
  const AvatarId id = added(crowd, world.find_place(0, {15, 0, 15}, 0.5));
  const Vec3d there{1.3, 0, 0}, across{0, 0, 1.3};
  crowd.set_velocities({&id, 1}, {&there, 1});
  walk(crowd, 20);
  const CurvilinearTuning tuning{.mass = mass, .max_speed = 0.4, .max_force = 0.06};
  crowd.set_curvilinear({&id, 1}, {&tuning, 1});
  crowd.set_velocities({&id, 1}, {&across, 1});
  walk(crowd, 2);
  const auto state = crowd.read(id);
  return state ? std::atan2(state->velocity.z, state->velocity.x) : 0;
}

TEST(OwnCurves, AHeavyAvatarTurnsLaterThanALightOne) {
  EXPECT_GT(turned(0.5), 1.5 * turned(8));
  EXPECT_GT(turned(8), 0);
}

TEST(OwnCurves, ASetHoldsForTheAvatarsThatGetItAndNoOther) {
  Crowd crowd = made(garage(), kCurved), twin = made(garage(), kCurved);
  const auto ids = with_goals(crowd, 60);
  with_goals(twin, 60);
  crowd.set_curvilinear({&ids[7], 1}, {&kHeavy, 1});
  EXPECT_TRUE(same(*crowd.curvilinear(ids[7]), kHeavy));
  EXPECT_TRUE(same(*crowd.curvilinear(ids[8]), CurvilinearTuning{}));
  walk(crowd, 40);
  walk(twin, 40);
  EXPECT_NE(crowd.state_hash(), twin.state_hash());
  // Another avatar in its slot has the crowd's values again.
  crowd.remove({&ids[7], 1});
  EXPECT_FALSE(crowd.curvilinear(ids[7]));
  const auto next = scattered(crowd, 1);
  EXPECT_EQ(next[0].slot1, ids[7].slot1);
  EXPECT_TRUE(same(*crowd.curvilinear(next[0]), CurvilinearTuning{}));
}

TEST(OwnCurves, TheCrowdsOwnValuesGivenToAllChangeNothing) {
  Crowd crowd = made(garage(), kCurved), twin = made(garage(), kCurved);
  const auto ids = with_goals(crowd, 80);
  with_goals(twin, 80);
  crowd.set_curvilinear(ids, std::vector<CurvilinearTuning>(ids.size()));
  walk(crowd, 30);
  walk(twin, 30);
  EXPECT_EQ(crowd.state_hash(), twin.state_hash());
}

TEST(OwnCurves, ValuesOutOfTheirLimitsAndUnknownIdsAreIgnored) {
  Crowd crowd = made(garage(), kCurved);
  const auto ids = with_goals(crowd, 5);
  for (const CurvilinearTuning& bad :
       {CurvilinearTuning{.mass = 0}, CurvilinearTuning{.mass = NAN},
        CurvilinearTuning{.max_speed = 101}, CurvilinearTuning{.max_force = 1e-4}}) {
    crowd.set_curvilinear({&ids[0], 1}, {&bad, 1});
    EXPECT_TRUE(same(*crowd.curvilinear(ids[0]), CurvilinearTuning{}));
  }
  const AvatarId unknown{.slot1 = 400, .generation = 1};
  crowd.set_curvilinear({&unknown, 1}, {&kHeavy, 1});
  EXPECT_FALSE(crowd.curvilinear(unknown));
  EXPECT_FALSE(crowd.curvilinear({}));
}

TEST(OwnCurves, StatesAreTheSameForAnyWorkersWhileSetsChange) {
  std::vector<uint64_t> hashes;
  for (const int32_t workers : {1, 3, 8}) {
    CrowdConfig config = kCurved;
    config.workers = workers;
    Crowd crowd = made(garage(), config);
    const auto ids = with_goals(crowd, 200);
    for (size_t k = 0; k < 20; ++k) {
      crowd.set_curvilinear({&ids[9 * k], 1}, {&kHeavy, 1});
      walk(crowd, 2);
    }
    hashes.push_back(crowd.state_hash());
    EXPECT_EQ(crowd.check().overlaps, 0U);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(OwnCurves, ASavedCrowdKeepsThem) {
  Crowd crowd = made(garage(), kCurved);
  const auto ids = with_goals(crowd, 60);
  const size_t without = crowd.save().size();
  CurvilinearTuning by_state = kHeavy;
  by_state.by_state = true;
  crowd.set_curvilinear({&ids[50], 1}, {&by_state, 1});
  crowd.set_curvilinear({&ids[3], 1}, {&kHeavy, 1});
  walk(crowd, 10);
  const auto saved = crowd.save();
  EXPECT_EQ(saved.size(), without + 2 * 32);
  Context context;
  auto again = Crowd::restore(garage(), kCurved, saved, context);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_TRUE(same(*again->curvilinear(ids[50]), by_state));
  EXPECT_TRUE(same(*again->curvilinear(ids[3]), kHeavy));
  EXPECT_EQ(again->save(), saved);
  walk(crowd, 30);
  walk(*again, 30);
  EXPECT_EQ(crowd.state_hash(), again->state_hash());
  // What no crowd can have saved is refused, even with the right sum.
  const size_t first = saved.size() - 8 - 2 * 32;
  const auto refused = [&](size_t at, uint32_t value) {
    auto bytes = saved;
    std::memcpy(bytes.data() + at, &value, 4);
    const uint64_t sum = hash_bytes(bytes.data(), bytes.size() - 8);
    std::memcpy(bytes.data() + bytes.size() - 8, &sum, 8);
    const auto bad = Crowd::restore(garage(), kCurved, bytes, context);
    return !bad && bad.error().message.find("not sound") != std::string::npos;
  };
  EXPECT_TRUE(refused(first, 60)) << "a slot that does not exist";
  EXPECT_TRUE(refused(first, 50)) << "a slot twice";
  EXPECT_TRUE(refused(first + 4, 2)) << "an order that does not exist";
  EXPECT_TRUE(refused(first + 12, 0)) << "a mass of 0";
}

// The fields of two avatars that fly towards each other meet over the floor.
double passed_aside(FlyerAxes axes, double& above) {
  Scene scene = worlds::flat(30);
  scene.add_box({0, 12, 0}, {1, 12.3, 1});  // so that there is air up to there
  AvatarClass flyer = default_classes()[0];
  flyer.flies = true;
  const World world = test::bake(scene, 0.2, {flyer});
  CrowdConfig config = kCurved;
  config.tuning.flyer_axes = axes;
  Crowd crowd = made(world, config);
  const AvatarId a = added(crowd, air_place({8, 5, 15})),
                 b = added(crowd, air_place({22, 5.3, 15}));
  const std::vector<AvatarId> ids{a, b};
  crowd.set_goals(ids, std::vector<Place>{air_place({22, 5, 15}), air_place({8, 5.3, 15})});
  double aside = 0;
  above = 0;
  for (int step = 0; step < 300; ++step) {
    crowd.step();
    EXPECT_EQ(crowd.check().overlaps, 0U);
    const auto state = crowd.read(a), other = crowd.read(b);
    aside = std::max(aside, std::abs(state->position.z - other->position.z));
    above = std::max(above, std::abs(state->position.y - other->position.y));
  }
  const auto state = crowd.read(a);
  EXPECT_LT(length(state->position - Vec3d{22, 5, 15}), 0.5) << static_cast<int>(axes);
  return aside;
}

TEST(FlyerAxes, FlyersPassBesideOrAlsoOverEachOther) {
  double above = 0;
  const double side = passed_aside(FlyerAxes::kSide, above);
  EXPECT_GT(side, 0.4);
  EXPECT_LT(above, 0.5) << "only the rounds of a step lead up or down";
  const double both = passed_aside(FlyerAxes::kSideAndUp, above);
  EXPECT_GT(above, 1);
  EXPECT_LT(both, side + 2);
  passed_aside(FlyerAxes::kOurs, above);
}

TEST(FlyerAxes, ASavedCrowdContinuesWithItsAxesAndNoOthers) {
  const FlyerAxes all[] = {FlyerAxes::kOurs, FlyerAxes::kSide, FlyerAxes::kSideAndUp};
  for (const FlyerAxes axes : all) {
    CrowdConfig config = kCurved;
    config.tuning.flyer_axes = axes;
    Crowd crowd = made(garage(), config);
    with_goals(crowd, 5);
    const auto saved = crowd.save();
    for (const FlyerAxes other : all) {
      Context context;
      config.tuning.flyer_axes = other;
      EXPECT_EQ(bool(Crowd::restore(garage(), config, saved, context)), other == axes);
    }
  }
}

}  // namespace
}  // namespace throng
