// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "baked.h"
#include "core/hash.h"
#include "core/random.h"
#include "crowd/link/link_line.h"
#include "crowds.h"
#include "simd_targets.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "worlds.h"

// Walkers on off-mesh links. Turns at links: link_turns_test.cpp.
namespace throng::links {
namespace {

TEST(CrowdLinks, AWalkerCrossesAGapByALink) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4.5, false}}};
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = walker(crowd, at(world, 3, 5), at(world, 19, 5));
  EXPECT_EQ(crowd.step().no_path, 1u);
  add_link(edits, oracle.links[0]);
  const Place goal = at(world, 19, 5), back = at(world, 3, 5);
  crowd.set_goals({&id, 1}, {&goal, 1});
  const int steps = steps_until(crowd, oracle, 1, 400);
  // 16 m, of which 4 take as long as 4.5: it hardly stops.
  EXPECT_NEAR(steps * 0.1, 16.5 / 1.34, 1.5);
  EXPECT_NEAR(static_cast<double>(oracle.riding) * 0.1, 4.5 / 1.34, 0.5);
  crowd.set_goals({&id, 1}, {&back, 1});
  EXPECT_EQ(crowd.step().no_path, 1u) << "it is a one-way link";
}

TEST(CrowdLinks, AWalkerGetsDownALedgeAndUpALadder) {
  const World world = ledge();
  Edits edits;
  Oracle oracle{world,
                {{at(world, 9, 5, 3), at(world, 11.5, 5), 4, false},
                 {at(world, 10.6, 8), at(world, 9.4, 8, 3), 12, false}}};
  for (const OffMeshLink& one : oracle.links) add_link(edits, one);
  Crowd crowd = made(world, {.edits = edits});
  const Place high = at(world, 3, 5, 3), low = at(world, 17, 5);
  const AvatarId id = walker(crowd, high, low);
  EXPECT_GT(steps_until(crowd, oracle, 1, 400), 0);
  const uint64_t down = oracle.riding;
  EXPECT_NEAR(static_cast<double>(down) * 0.1, 4 / 1.34, 0.5);
  crowd.set_goals({&id, 1}, {&high, 1});
  EXPECT_GT(steps_until(crowd, oracle, 1, 600), 0);
  EXPECT_NEAR(static_cast<double>(oracle.riding - down) * 0.1, 12 / 1.34, 0.5) << "dear: slow";
  EXPECT_NEAR(crowd.read(id)->position.y, 3, 0.01);
}

// A wall with an opening far away; a link through the wall costs less, or more, than the detour.
TEST(CrowdLinks, TheCheaperPathIsTaken) {
  Scene scene = worlds::flat(24);
  scene.add_box({11.9, 0, 0}, {12.1, 3, 18});
  scene.add_box({11.9, 0, 20}, {12.1, 3, 24});
  const World world = test::bake(scene, 0.1);
  for (const double cost : {0.5, 3.5, 60.0}) {
    Edits edits;
    Oracle oracle{world, {{at(world, 10.5, 4), at(world, 13.5, 4), cost, true}}};
    add_link(edits, oracle.links[0]);
    Crowd crowd = made(world, {.edits = edits});
    walker(crowd, at(world, 4, 4), at(world, 20, 4));
    EXPECT_GT(steps_until(crowd, oracle, 1, 600), 0);
    EXPECT_EQ(oracle.riding > 0, cost < 30) << cost;
    // No faster than it walks, however cheap.
    if (cost < 3) {
      EXPECT_NEAR(static_cast<double>(oracle.riding) * 0.1, 3 / 1.34, 0.4);
    }
  }
}

TEST(CrowdLinks, CrowdsFromBothSidesArrive) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  for (int i = 0; i < 16; ++i) {
    const double x = 3 + (i % 4), z = 3 + static_cast<double>(i / 4) * 1.2;
    walker(crowd, at(world, x, z), at(world, 15 + (i % 4), 3 + static_cast<double>(i / 4) * 1.2));
    walker(crowd, at(world, x + 13, z + 0.6),
           at(world, x - 1.5, 3.5 + static_cast<double>(i / 4) * 1.2));
  }
  EXPECT_GT(steps_until(crowd, oracle, 32, 4000), 0);
  EXPECT_GT(oracle.riding, 32u * 25);
}

// Both stand where the other would land.
TEST(CrowdLinks, TwoThatStandAtTheEndsPassEachOther) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  walker(crowd, at(world, 9, 5), at(world, 19, 5));
  walker(crowd, at(world, 13, 5), at(world, 3, 5));
  EXPECT_GT(steps_until(crowd, oracle, 2, 600), 0);
}

// Two one-way links side by side, whose waiting avatars would stand in each other's ends.
TEST(CrowdLinks, PairsOfOneWayLinksDoNotBlockEachOther) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world,
                {{at(world, 9, 4.6), at(world, 13, 4.6), 4, false},
                 {at(world, 13, 5.6), at(world, 9, 5.6), 4, false}}};
  for (const OffMeshLink& one : oracle.links) add_link(edits, one);
  Crowd crowd = made(world, {.edits = edits});
  for (int i = 0; i < 9; ++i) {
    const double x = 5 + (i % 3) * 0.8, z = 3 + static_cast<double>(i / 3) * 1.5;
    walker(crowd, at(world, x, z), at(world, x + 13, z));
    walker(crowd, at(world, x + 11, z), at(world, x - 3, z + 0.7));
  }
  EXPECT_GT(steps_until(crowd, oracle, 18, 3000), 0);
}

TEST(CrowdLinks, ALinkThatIsSwitchedOffLetsThoseOnItArrive) {
  for (const bool removes : {false, true}) {
    const World world = gap();
    Edits edits;
    Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
    const EditId id = add_link(edits, oracle.links[0]);
    Crowd crowd = made(world, {.edits = edits});
    const AvatarId first = walker(crowd, at(world, 7, 5), at(world, 19, 5));
    const AvatarId second = walker(crowd, at(world, 2, 5), at(world, 19, 6));
    step_until_riding(crowd, first);
    EXPECT_TRUE(removes ? edits.remove(id) : edits.set_active(id, false));
    uint64_t unreachable = 0, arrived = 0;
    for (int step = 0; step < 200; ++step) {
      const CrowdReport report = crowd.step();
      unreachable += report.no_path;
      arrived += report.arrived;
      oracle.look(crowd, step);
    }
    EXPECT_EQ(unreachable, 1u);
    EXPECT_EQ(arrived, 1u);
    EXPECT_GT(crowd.read(first)->position.x, 12);
    EXPECT_LT(crowd.read(second)->position.x, 10);
  }
}

TEST(CrowdLinks, WhileTheEndIsOccupiedTheNextOneWaits) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId blocker = added(crowd, at(world, 13, 5));
  const AvatarId one = walker(crowd, at(world, 4, 5), at(world, 19, 5));
  // Others walk past it.
  walker(crowd, at(world, 8, 1), at(world, 8, 9));
  EXPECT_GT(steps_until(crowd, oracle, 1, 200), 0);
  for (int step = 0; step < 100; ++step) crowd.step();
  EXPECT_EQ(oracle.riding, 0u);
  const Vec3d there = crowd.read(one)->position;
  EXPECT_LT(std::hypot(there.x - 9, there.z - 5), 2.5) << "it waits at the start";
  crowd.remove({&blocker, 1});
  EXPECT_GT(steps_until(crowd, oracle, 1, 300), 0);
}

TEST(CrowdLinks, ATargetBeyondALinkIsReached) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  Crowd crowd = made(world, {.edits = edits});
  Context context;
  const Prism there = Prism::box({17, -1, 3}, {21, 1, 8});
  const auto target = crowd.add_target({&there, 1}, context);
  ASSERT_TRUE(target);
  std::vector<AvatarId> ids;
  for (int i = 0; i < 6; ++i) ids.push_back(added(crowd, at(world, 2 + i, 3)));
  crowd.step();
  EXPECT_TRUE(std::isinf(crowd.distance(ids[0], *target)));
  const EditId door = add_link(edits, oracle.links[0]);
  crowd.step();
  EXPECT_NEAR(crowd.distance(ids[0], *target), std::hypot(7, 2) + 4 + 4, 0.5);
  crowd.set_targets(ids, *target);
  EXPECT_GT(steps_until(crowd, oracle, 6, 1500), 0);
  EXPECT_GT(oracle.riding, 6u * 25);
  EXPECT_TRUE(edits.set_active(door, false));
  crowd.step();
  const AvatarId late = added(crowd, at(world, 3, 5));
  EXPECT_TRUE(std::isinf(crowd.distance(late, *target)));
}

TEST(CrowdLinks, AnAvatarThatIsRemovedFreesItsLink) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId first = walker(crowd, at(world, 7, 5), at(world, 19, 5));
  walker(crowd, at(world, 19, 6), at(world, 3, 6));
  step_until_riding(crowd, first);
  crowd.remove({&first, 1});
  const AvatarId again = walker(crowd, at(world, 3, 3), at(world, 6, 3));  // in the same slot
  EXPECT_EQ(again.slot1, first.slot1);
  EXPECT_GT(steps_until(crowd, oracle, 2, 400), 0);
  EXPECT_NEAR(crowd.read(again)->position.x, 6, 0.5);
}

TEST(CrowdLinks, OneThatGetsAnotherGoalOnALinkArrivesFirst) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = walker(crowd, at(world, 7, 5), at(world, 19, 5));
  step_until_riding(crowd, id);
  const Place back = at(world, 3, 5);
  crowd.set_goals({&id, 1}, {&back, 1});
  EXPECT_EQ(crowd.read(id)->mode, MoveMode::kLink);
  EXPECT_GT(steps_until(crowd, oracle, 1, 600), 0);
  EXPECT_NEAR(crowd.read(id)->position.x, 3, 0.5);
  EXPECT_GT(oracle.riding, 2u * 25) << "there and back";
  // Without a goal, and externally controlled.
  const Place there = at(world, 19, 5), nowhere = {};
  for (const bool external : {false, true}) {
    crowd.set_goals({&id, 1}, {external ? &back : &there, 1});
    step_until_riding(crowd, id);
    const Vec3d still{0, 0, 0};
    if (external) crowd.set_velocities({&id, 1}, {&still, 1});
    if (!external) crowd.set_goals({&id, 1}, {&nowhere, 1});
    for (int step = 0; step < 60; ++step) {
      crowd.step();
      oracle.look(crowd, step);
    }
    // One without a goal comes to a stop.
    EXPECT_NEAR(crowd.read(id)->position.x, external ? 9 : 13, external ? 0.01 : 0.1);
    EXPECT_EQ(crowd.read(id)->mode, MoveMode::kWalk);
  }
}

// An obstacle on the rest of its line waits for it, by either policy; then the link is closed.
TEST(CrowdLinks, AnObstacleAtTheEndWaitsForTheOneOnTheLink) {
  const World world = gap();
  for (const ObstaclePolicy policy : {ObstaclePolicy::kRefuseEntry, ObstaclePolicy::kWait}) {
    for (const double x : {13.0, 11.5}) {
      Edits edits;
      Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
      add_link(edits, oracle.links[0]);
      Crowd crowd = made(world, {.edits = edits});
      const AvatarId first = walker(crowd, at(world, 7, 5), at(world, 19, 5));
      const AvatarId second = walker(crowd, at(world, 1, 9), at(world, 19, 6));
      step_until_riding(crowd, first);
      const EditId crate =
          put_up(crowd, edits, Prism::circle({x, 0, 5}, 0.4, 1), ObstacleKind::kStatic, policy);
      EXPECT_FALSE(crowd.obstacle(crate)->is_up());
      EXPECT_EQ(crowd.obstacle(crate)->occupants, 1u);
      for (int step = 0; step < 250; ++step) {
        crowd.step();
        oracle.look(crowd, step);
      }
      EXPECT_NEAR(crowd.read(first)->position.x, 19, 0.5);
      EXPECT_TRUE(crowd.obstacle(crate)->is_up());
      EXPECT_LT(crowd.read(second)->position.x, 10);
      EXPECT_TRUE(edits.remove(crate));
      const Place goal = at(world, 19, 6);
      crowd.set_goals({&second, 1}, {&goal, 1});
      EXPECT_GT(steps_until(crowd, oracle, 1, 400), 0);
    }
  }
}

// Under a roof at its end a giant cannot stand.
TEST(CrowdLinks, OnlyClassesThatCanStandAtBothEndsTakeThem) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({12, -0.5, 0}, {22, 0, 10});
  scene.add_box({12, 2.4, 0}, {15, 2.6, 10});
  const World world = test::bake(scene, 0.1);
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const int32_t giant = 3;
  const Place from = world.find_place(giant, {3, 0, 3}, 0.5);
  const Place to = world.find_place(giant, {19, 0, 3}, 0.5);
  const AvatarId id = added(crowd, from, {.avatar_class = giant});
  crowd.set_goals({&id, 1}, {&to, 1});
  EXPECT_EQ(crowd.step().no_path, 1u);
  walker(crowd, at(world, 3, 6), at(world, 19, 6));
  EXPECT_GT(steps_until(crowd, oracle, 1, 400), 0);
}

// Flyers cross the gap through the air, walkers by the link, in each other's sight.
TEST(CrowdLinks, FlyersTakeNone) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({12, -0.5, 0}, {22, 0, 10});
  const World world = test::bake(scene, 0.1, {default_classes()[0], flyer_class()});
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  std::vector<AvatarId> flyers;
  for (int i = 0; i < 4; ++i) {
    const double z = 2 + i * 2;
    walker(crowd, at(world, 4, z), at(world, 18, z));
    const AvatarId flyer = added(crowd, world.find_place(1, {6, 0, z}, 0.5), {.avatar_class = 1});
    const Place goal = world.find_place(1, {16, 0, z}, 0.5);
    crowd.set_goals({&flyer, 1}, {&goal, 1});
    flyers.push_back(flyer);
  }
  uint64_t arrived = 0;
  for (int step = 0; step < 900 && arrived < 8; ++step) {
    arrived += crowd.step().arrived;
    oracle.look(crowd, step);
    for (const AvatarId id : flyers) EXPECT_NE(crowd.read(id)->mode, MoveMode::kLink);
  }
  EXPECT_EQ(arrived, 8u);
  EXPECT_GT(oracle.riding, 4u * 25);
}

struct Busy {
  World world = gap();
  Edits edits;
  std::vector<OffMeshLink> links{{at(world, 9, 3), at(world, 13, 3), 4, true},
                                 {at(world, 9, 7), at(world, 13, 7), 6, false}};
  std::vector<EditId> ids;

  Busy() {
    for (const OffMeshLink& one : links) ids.push_back(add_link(edits, one));
  }
  Crowd crowd(int32_t workers) {
    Crowd crowd = made(world, {.workers = workers, .edits = edits});
    const auto avatars = scattered(crowd, 40);
    std::vector<Place> goals;
    for (uint64_t n = 0; n < 40; ++n) goals.push_back(world.random_place(0, 3, n));
    crowd.set_goals(avatars, goals);
    return crowd;
  }
};

TEST(CrowdLinks, SameStatesForAnyWorkers) {
  uint64_t expected = 0;
  test::for_every_simd_target([&](const char* name) {
    for (const int32_t workers : {1, 2, 3}) {
      Busy busy;
      Crowd crowd = busy.crowd(workers);
      uint64_t hash = 0, riding = 0;
      for (int step = 0; step < 200; ++step) {
        riding += crowd.step().on_links;
        hash = hash * 31 + crowd.state_hash();
        if (step == 100) {
          EXPECT_TRUE(busy.edits.set_active(busy.ids[1], false));
        }
      }
      EXPECT_GT(riding, 100u);
      if (expected == 0) expected = hash;
      ASSERT_EQ(hash, expected) << name << ' ' << workers;
    }
  });
}

TEST(CrowdLinks, ACrowdSavedOnLinksGoesOnAlike) {
  Busy busy;
  Crowd crowd = busy.crowd(1);
  uint64_t restored_riding = 0;
  for (int step = 0; step < 160; ++step) {
    crowd.step();
    if (step % 40 != 30) continue;
    const std::vector<uint8_t> saved = crowd.save();
    Context context;
    auto restored = Crowd::restore(busy.world, {.workers = 2, .edits = busy.edits}, saved, context);
    ASSERT_TRUE(restored) << restored.error().message;
    EXPECT_EQ(restored->save(), saved);
    Crowd other = std::move(*restored);
    auto same = Crowd::restore(busy.world, {.workers = 3, .edits = busy.edits}, saved, context);
    ASSERT_TRUE(same);
    crowd = std::move(*same);
    for (int more = 0; more < 60; ++more) {
      restored_riding += other.step().on_links;
      crowd.step();
      ASSERT_EQ(crowd.state_hash(), other.state_hash()) << step << ' ' << more;
    }
    EXPECT_EQ(crowd.save(), other.save());
  }
  EXPECT_GT(restored_riding, 50u);
}

// Against the same crowd that was never saved.
TEST(CrowdLinks, ASavedCrowdIsTheOneThatWentOn) {
  Busy busy;
  Crowd crowd = busy.crowd(1);
  for (int step = 0; step < 50; ++step) crowd.step();
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  auto restored = Crowd::restore(busy.world, {.edits = busy.edits}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_GT(crowd.step().on_links, 0u);
  restored->step();
  for (int step = 0; step < 200; ++step) {
    if (step == 20) {
      EXPECT_TRUE(busy.edits.set_active(busy.ids[1], false));
    }
    crowd.step();
    restored->step();
    ASSERT_EQ(crowd.state_hash(), restored->state_hash()) << step;
  }
  EXPECT_EQ(crowd.save(), restored->save());
}

TEST(CrowdLinks, SavedNonsenseIsRefusedOrHarmless) {
  const World world = gap();
  Edits edits;
  add_link(edits, {at(world, 9, 5), at(world, 13, 5), 4, true});
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId first = walker(crowd, at(world, 8, 5), at(world, 19, 5));
  walker(crowd, at(world, 14, 5), at(world, 3, 5));
  step_until_riding(crowd, first);
  for (int step = 0; step < 6; ++step) crowd.step();
  std::vector<uint8_t> saved = crowd.save();
  uint64_t accepted = 0, refused = 0;
  Context context;
  for (size_t bit = 0; bit < (saved.size() - 8) * 8; bit += bit % 5 + 1) {
    saved[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    const uint64_t sum = hash_bytes(saved.data(), saved.size() - 8);
    std::memcpy(saved.data() + saved.size() - 8, &sum, 8);
    auto restored = Crowd::restore(world, {.edits = edits}, saved, context);
    if (restored) {
      for (int step = 0; step < 3; ++step) restored->step();
      ++accepted;
    } else {
      EXPECT_EQ(restored.error().code, Errc::kBadFile);
      ++refused;
    }
    saved[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
  }
  EXPECT_GT(accepted, 100u);
  EXPECT_GT(refused, 100u);
  // A crowd of the version before.
  ASSERT_EQ(std::memcmp(saved.data(), "CROWDW18", 8), 0);
  std::memcpy(saved.data(), "CROWDW17", 8);
  const auto old = Crowd::restore(world, {.edits = edits}, saved, context);
  ASSERT_FALSE(old);
  EXPECT_NE(old.error().message.find("no crowd of this version"), std::string::npos);
}

// Links switch, crates come and go, goals change, avatars are removed and added.
TEST(CrowdLinks, NothingTouchesWhateverHappens) {
  uint64_t pairs = 0, riding = 0, arrived = 0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    Scene scene;
    scene.add_box({0, 0, 0}, {10, 3, 10});
    scene.add_box({10, -0.5, 0}, {20, 0, 10});
    scene.add_box({21.5, -0.5, 0}, {31, 0, 10});
    const World world = test::bake(scene, 0.1);
    Edits edits;
    Oracle oracle{world,
                  {{at(world, 9, 3, 3), at(world, 11, 3), 4, true},
                   {at(world, 9, 7, 3), at(world, 12, 7), 9, false},
                   {at(world, 19, 4), at(world, 22.5, 4), 2, true},
                   {at(world, 19, 5), at(world, 22.5, 6), 4, false},
                   {at(world, 23, 8), at(world, 8, 8, 3), 10, true}}};
    std::vector<EditId> ids;
    for (const OffMeshLink& one : oracle.links) ids.push_back(add_link(edits, one));
    Crowd crowd = made(world, {.edits = edits});
    std::vector<AvatarId> avatars = scattered(crowd, 45);
    uint64_t n = 0;
    const auto draw = [&](uint64_t count) { return random_below(seed, 77, n++, count); };
    std::vector<EditId> crates;
    for (int step = 0; step < 500; ++step) {
      if (step % 10 == 0) {
        for (const AvatarId id : avatars) {
          if (draw(6) != 0) continue;
          const Place goal = world.random_place(0, seed, n++);
          crowd.set_goals({&id, 1}, {&goal, 1});
        }
      }
      if (draw(40) == 0) edits.set_active(ids[draw(ids.size())], draw(3) != 0);
      if (draw(15) == 0) {
        const OffMeshLink& one = oracle.links[draw(oracle.links.size())];
        const Vec3d middle = one.from.position * 0.5 + one.to.position * 0.5;
        const Vec3d places[] = {one.from.position, one.to.position, middle};
        const auto crate = edits.add_obstacle(Prism::circle(places[draw(3)], 0.4, 1));
        ASSERT_TRUE(crate);
        crates.push_back(*crate);
      }
      if (!crates.empty() && draw(12) == 0) {
        edits.remove(crates[draw(crates.size())]);
      }
      if (draw(20) == 0) {
        const size_t i = draw(avatars.size());
        crowd.remove({&avatars[i], 1});
        const AvatarId id = added(crowd, world.random_place(0, seed, n++));
        if (id) avatars[i] = id;
      }
      arrived += crowd.step().arrived;
      oracle.look(crowd, step);
      if (HasFatalFailure()) return;
    }
    pairs += oracle.pairs;
    riding += oracle.riding;
  }
  EXPECT_GT(pairs, 3000000u);
  EXPECT_GT(riding, 3000u);
  EXPECT_GT(arrived, 250u);
}

TEST(CrowdLinks, ALineMeetsAPrismExactly) {
  const Prism box = Prism::box({1, 0, 1}, {2, 1, 2});
  const auto touches = [&](Vec3d from, Vec3d to) {
    return crowd::meets({from, to, 0.25, 0.4, 1.75}, box);
  };
  EXPECT_TRUE(touches({0, 0, 1.5}, {3, 0, 1.5}));
  EXPECT_TRUE(touches({1.5, 0, 1.5}, {1.5, 0, 1.5}));
  EXPECT_TRUE(touches({0, 0, 0.76}, {3, 0, 0.76}));
  EXPECT_FALSE(touches({0, 0, 0.74}, {3, 0, 0.74}));
  EXPECT_FALSE(touches({0, 0, 1.5}, {0.74, 0, 1.5}));
  EXPECT_TRUE(touches({0, 0, 1.5}, {0.76, 0, 1.5}));
  // Over it: its bottom passes at 0.6 above the feet's height, or lower.
  EXPECT_FALSE(touches({0, 0.61, 1.5}, {3, 0.61, 1.5}));
  EXPECT_TRUE(touches({0, 0.59, 1.5}, {3, 0.59, 1.5}));
  EXPECT_FALSE(touches({0, -1.76, 1.5}, {3, -1.76, 1.5}));
  // It comes down beyond it, or upon it.
  EXPECT_FALSE(touches({0, 3, 1.5}, {3, 0.6, 1.5}));
  EXPECT_TRUE(touches({0, 3, 1.5}, {3, -0.5, 1.5}));
  EXPECT_TRUE(touches({1.5, 3, 1.5}, {1.5, 0.5, 1.5}));
}

TEST(CrowdLinks, LinesOfTwoBodiesMeetWhereTheirHeightsDo) {
  const auto meet = [](Vec3d from, Vec3d to) {
    const crowd::LinkLine line{{0, 0, 0}, {4, 0, 4}, 0.25, 0, 1.75};
    const crowd::LinkLine other{from, to, 0.25, 0, 1.75};
    EXPECT_EQ(crowd::meets(line, other), crowd::meets(other, line));
    return crowd::meets(line, other);
  };
  EXPECT_TRUE(meet({0, 0, 4}, {4, 0, 0}));
  EXPECT_TRUE(meet({0, 1.7, 4}, {4, 1.7, 0}));
  EXPECT_FALSE(meet({0, 1.8, 4}, {4, 1.8, 0}));
  EXPECT_FALSE(meet({0, -1.8, 4}, {4, -1.8, 0}));
  EXPECT_TRUE(meet({0.6, 0, 0}, {4.6, 0, 4}));
  EXPECT_FALSE(meet({0.8, 0, 0}, {4.8, 0, 4}));
  EXPECT_TRUE(meet({8, 9, 4}, {4, 0, 4}));  // to the same end
  EXPECT_FALSE(meet({4, 9, 0}, {0, 1.8, 4}));
  EXPECT_TRUE(meet({2, 9, 2}, {2, 1, 2}));
  EXPECT_FALSE(meet({2, 9, 2}, {2, 2, 2}));
}

TEST(CrowdLinks, WhereLinksMakeNoSenseNothingHappens) {
  const World world = gap();
  Edits edits;
  // To itself, from another world's places, and while the crowd walks straight.
  add_link(edits, {at(world, 9, 5), at(world, 9, 5), 1, true});
  add_link(edits, {Place{{9, 0, 5}, 70000}, Place{{1e9, 0, 5}, 1}, 1, true});
  const EditId bridge = add_link(edits, {at(world, 9, 5), at(world, 13, 5), 4, true});
  Crowd straight = made(world, {.routing = Routing::kStraight, .edits = edits});
  const AvatarId id = walker(straight, at(world, 3, 5), at(world, 19, 5));
  for (int step = 0; step < 100; ++step) EXPECT_EQ(straight.step().on_links, 0u);
  EXPECT_LT(straight.read(id)->position.x, 10);
  Crowd crowd = made(world, {.edits = edits});
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  walker(crowd, at(world, 3, 5), at(world, 19, 5));
  EXPECT_GT(steps_until(crowd, oracle, 1, 300), 0);
  EXPECT_TRUE(edits.remove(bridge));
  EXPECT_FALSE(edits.remove(bridge));
}

}  // namespace
}  // namespace throng::links
