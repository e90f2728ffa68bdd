// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "links.h"
#include "throng/crowd.h"
#include "throng/path.h"

// Turns at off-mesh links that cross or share ends, and what may not make an avatar lose its turn,
// its goal or its link.
namespace throng::links {
namespace {

std::vector<EditId> add_links(Edits& edits, const Oracle& oracle) {
  std::vector<EditId> ids;
  for (const OffMeshLink& one : oracle.links) ids.push_back(add_link(edits, one));
  return ids;
}

// Groups on both sides of the gap that change sides.
void add_groups(Crowd& crowd, const World& world, int each, const AvatarSpawn& like = {}) {
  for (int i = 0; i < each; ++i) {
    const double x = 3 + (i % 3) * 1.2, z = 3 + static_cast<double>(i / 3) * 1.5;
    for (const bool back : {false, true}) {
      const double begin = back ? x + 13 : x, end = back ? x : x + 13;
      const AvatarId id = added(crowd, at(world, begin, z), like);
      EXPECT_TRUE(id);
      const Place goal = at(world, end, z + 0.6);
      crowd.set_goals({&id, 1}, {&goal, 1});
    }
  }
}

TEST(CrowdLinkTurns, OneWayLinksWithTheSameEndsAreOneCorridor) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world,
                {{at(world, 9, 5), at(world, 13, 5), 4, false},
                 {at(world, 13, 5), at(world, 9, 5), 4, false}}};
  add_links(edits, oracle);
  Crowd crowd = made(world, {.edits = edits});
  add_groups(crowd, world, 6);
  EXPECT_GT(steps_until(crowd, oracle, 12, 3000), 0);
}

TEST(CrowdLinkTurns, LinksThatCrossAreOneCorridor) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world,
                {{at(world, 9, 3), at(world, 13, 7), 5.7, true},
                 {at(world, 9, 7), at(world, 13, 3), 5.7, true}}};
  add_links(edits, oracle);
  Crowd crowd = made(world, {.edits = edits});
  add_groups(crowd, world, 6);
  EXPECT_GT(steps_until(crowd, oracle, 12, 4000), 0);
}

TEST(CrowdLinkTurns, LinksThatShareTheirFarEndAreOneCorridor) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world,
                {{at(world, 9, 3), at(world, 13, 5), 4.5, false},
                 {at(world, 9, 7), at(world, 13, 5), 4.5, false},
                 {at(world, 13, 9), at(world, 9, 9), 4, false}}};
  add_links(edits, oracle);
  Crowd crowd = made(world, {.edits = edits});
  add_groups(crowd, world, 6);
  EXPECT_GT(steps_until(crowd, oracle, 12, 3000), 0);
}

// Both links are as long, so that avatars take the one or the other for ever: none starves.
TEST(CrowdLinkTurns, AStreamOnALinkLetsAnAvatarCrossIt) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world,
                {{at(world, 9, 3), at(world, 13, 7), 5.7, true},
                 {at(world, 9, 7), at(world, 13, 3), 5.7, false}}};
  add_links(edits, oracle);
  Crowd crowd = made(world, {.edits = edits});
  std::vector<AvatarId> stream;
  for (int i = 0; i < 5; ++i)
    stream.push_back(walker(crowd, at(world, 3 + i, 1), at(world, 16 + i, 9)));
  const AvatarId one = walker(crowd, at(world, 4, 9), at(world, 14.5, 1.5));
  bool arrives = false;
  for (int step = 0; step < 1500 && !arrives; ++step) {
    crowd.step();
    oracle.look(crowd, step);
    if (HasFatalFailure()) return;
    for (const AvatarId id : crowd.arrived()) {
      arrives = arrives || id == one;
      if (id == one) continue;
      const double x = crowd.read(id)->position.x;
      const Place goal = x > 11 ? at(world, 3.0 + id.slot1, 1) : at(world, 15.0 + id.slot1, 9);
      crowd.set_goals({&id, 1}, {&goal, 1});
    }
  }
  EXPECT_TRUE(arrives);
}

TEST(CrowdLinkTurns, ALinkThatIsAddedAgainWaitsForThoseOnTheOldOne) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  const EditId old = add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId first = walker(crowd, at(world, 8, 5), at(world, 19, 5));
  walker(crowd, at(world, 14, 5), at(world, 3, 5));
  step_until_riding(crowd, first);
  EXPECT_TRUE(edits.remove(old));
  add_link(edits, oracle.links[0]);
  EXPECT_GT(steps_until(crowd, oracle, 2, 600), 0);
}

// Obstacles block whole cells: the one at the end, though the body would not touch the box.
TEST(CrowdLinkTurns, AnObstacleBesideTheEndWaitsForTheOneOnTheLink) {
  const World world = gap();
  for (const ObstaclePolicy policy : {ObstaclePolicy::kRefuseEntry, ObstaclePolicy::kWait}) {
    Edits edits;
    Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
    add_link(edits, oracle.links[0]);
    Crowd crowd = made(world, {.edits = edits});
    const AvatarId first = walker(crowd, at(world, 7, 5), at(world, 19, 5));
    step_until_riding(crowd, first);
    const EditId crate = put_up(crowd, edits, Prism::box({13.22, 0, 4.5}, {13.8, 1, 5.5}),
                                ObstacleKind::kStatic, policy);
    EXPECT_FALSE(crowd.obstacle(crate)->is_up());
    EXPECT_GT(steps_until(crowd, oracle, 1, 400), 0);
    EXPECT_TRUE(crowd.obstacle(crate)->is_up());
  }
}

// It lands in the first or the second half of a step.
TEST(CrowdLinkTurns, OneThatLandsInAClosingObstacleKeepsItsGoal) {
  const World world = gap();
  for (int shift = 0; shift < 8; ++shift) {
    Edits edits;
    Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
    add_link(edits, oracle.links[0]);
    Crowd crowd = made(world, {.dt = 0.3, .edits = edits});
    const AvatarId id = walker(crowd, at(world, 7 + shift * 0.05, 5), at(world, 19, 5));
    step_until_riding(crowd, id);
    put_up(crowd, edits, Prism::circle({13, 0, 5}, 0.4, 1));
    uint64_t lost = 0, arrived = 0;
    for (int step = 0; step < 150; ++step) {
      const CrowdReport report = crowd.step();
      lost += report.no_path;
      arrived += report.arrived;
      oracle.look(crowd, step);
    }
    EXPECT_EQ(lost, 0u) << shift;
    EXPECT_EQ(arrived, 1u) << shift;
  }
}

// Goals are set, or costs, or what flow fields lead around, in each step.
TEST(CrowdLinkTurns, OneThatSearchesInEachStepKeepsItsTurn) {
  const World world = gap();
  for (const char* what : {"goals", "costs", "flows"}) {
    Edits edits;
    Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
    add_link(edits, oracle.links[0]);
    ChangesInEachStep changes(edits);
    Crowd crowd = made(world, {.edits = edits});
    Context context;
    const Prism left = Prism::box({1, -1, 1}, {5, 1, 9}),
                right = Prism::box({17, -1, 1}, {21, 1, 9});
    const auto to_left = crowd.add_target({&left, 1}, context);
    const auto to_right = crowd.add_target({&right, 1}, context);
    ASSERT_TRUE(to_left && to_right);
    std::vector<AvatarId> ids;
    std::vector<Place> goals;
    for (int i = 0; i < 4; ++i) {
      const double z = 2 + i * 1.5;
      ids.push_back(added(crowd, at(world, 4, z)));
      goals.push_back(at(world, 18, z + 0.5));
      ids.push_back(added(crowd, at(world, 18, z)));
      goals.push_back(at(world, 4, z + 0.5));
    }
    const bool by_flow = what[0] == 'f';
    crowd.set_goals(ids, goals);
    for (size_t i = 0; by_flow && i < ids.size(); ++i) {
      crowd.set_targets({&ids[i], 1}, i % 2 == 0 ? *to_right : *to_left);
    }
    for (int step = 0; step < 1200; ++step) {
      if (what[0] == 'g') crowd.set_goals(ids, goals);
      if (what[0] == 'c') changes.change_costs(step);
      if (by_flow) changes.change_flows(step);
      crowd.step();
      oracle.look(crowd, step);
      if (HasFatalFailure()) return;
    }
    for (size_t i = 0; i < ids.size(); ++i) {
      EXPECT_EQ(crowd.read(ids[i])->position.x > 11, i % 2 == 0) << what << ' ' << i;
    }
  }
}

// The later one has the lower slot.
TEST(CrowdLinkTurns, ASearchDoesNotChangeTheOrderOfComing) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId later = walker(crowd, at(world, 3, 6), at(world, 19, 6));
  const AvatarId first = walker(crowd, at(world, 7, 4), at(world, 19, 4));
  const AvatarId blocker = added(crowd, at(world, 13, 5));
  for (int step = 0; step < 120; ++step) crowd.step();
  const Place goal = at(world, 18, 3);
  crowd.set_goals({&first, 1}, {&goal, 1});
  crowd.step();
  crowd.remove({&blocker, 1});
  for (int step = 0; step < 100; ++step) {
    crowd.step();
    EXPECT_NE(crowd.read(later)->mode, MoveMode::kLink);
    if (crowd.read(first)->mode == MoveMode::kLink) break;
  }
  EXPECT_GT(steps_until(crowd, oracle, 2, 600), 0);
}

// One rests at the start, or at the far end, of a link that others take; it goes back then.
TEST(CrowdLinkTurns, AvatarsThatRestAtTheEndsGiveRoom) {
  const World world = gap();
  for (const bool at_start : {true, false}) {
    Edits edits;
    Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
    add_link(edits, oracle.links[0]);
    Crowd crowd = made(world, {.edits = edits});
    const double x = at_start ? 9 : 13;
    const AvatarId resting = walker(crowd, at(world, at_start ? 7 : 15, 7), at(world, x, 5));
    ASSERT_GT(steps_until(crowd, oracle, 1, 100), 0);
    for (int i = 0; i < 4; ++i) walker(crowd, at(world, 2 + i, 3 + i), at(world, 17 + i, 3 + i));
    EXPECT_GT(steps_until(crowd, oracle, 4, 700), 0) << at_start;
    for (int step = 0; step < 60; ++step) crowd.step();
    const Vec3d there = crowd.read(resting)->position;
    EXPECT_LT(std::hypot(there.x - x, there.z - 5), 0.4) << "it is back";
  }
}

TEST(CrowdLinkTurns, ASavedCrowdGivesRoomAsTheOneThatWentOn) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId resting = walker(crowd, at(world, 7, 7), at(world, 9, 5));
  ASSERT_GT(steps_until(crowd, oracle, 1, 100), 0);
  walker(crowd, at(world, 5, 5), at(world, 19, 5));
  const auto is_aside = [&] {
    const Vec3d there = crowd.read(resting)->position;
    return std::hypot(there.x - 9, there.z - 5) > 0.4;
  };
  for (int step = 0; step < 100 && !is_aside(); ++step) crowd.step();
  ASSERT_TRUE(is_aside());
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  auto restored = Crowd::restore(world, {.edits = edits}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->save(), saved);
  for (int step = 0; step < 200; ++step) {
    crowd.step();
    restored->step();
    ASSERT_EQ(crowd.state_hash(), restored->state_hash()) << step;
  }
  EXPECT_FALSE(is_aside());
}

// The end is occupied just after one got its turn. After 10 s it stands aside again; also if steps
// are divided meanwhile, because a fast avatar comes.
TEST(CrowdLinkTurns, ATurnEndsAfterTheSameTimeHoweverStepsAreDivided) {
  const World world = gap();
  const auto seconds_at_start = [&](bool divides) {
    Edits edits;
    add_link(edits, {at(world, 9, 5), at(world, 13, 5), 4, false});
    Crowd crowd = made(world, {.edits = edits});
    const AvatarId id = walker(crowd, at(world, 6, 5), at(world, 19, 5));
    const auto off = [&] {
      const Vec3d there = crowd.read(id)->position;
      return std::hypot(there.x - 9, there.z - 5);
    };
    for (int step = 0; step < 100 && off() > 0.3; ++step) crowd.step();
    EXPECT_TRUE(added(crowd, at(world, 13, 5)));
    for (int step = 0; step < 50; ++step) crowd.step();
    EXPECT_LT(off(), 0.2) << "it stands at the start";
    if (divides) {
      EXPECT_TRUE(added(crowd, at(world, 1, 1), {.speed = 8}));
    }
    int steps = 50;
    for (; steps < 300 && off() < 0.4; ++steps) crowd.step();
    return steps * 0.1;
  };
  const double plain = seconds_at_start(false);
  EXPECT_NEAR(plain, 10, 2);
  EXPECT_NEAR(seconds_at_start(true), plain, 0.5);
}

// One that waits at a link and gets a goal on its own side goes there.
TEST(CrowdLinkTurns, AnotherPathEndsTheWait) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = walker(crowd, at(world, 7, 5), at(world, 19, 5));
  const AvatarId blocker = added(crowd, at(world, 13, 5));
  for (int step = 0; step < 60; ++step) crowd.step();
  const Place here = at(world, 2, 2), nowhere = {};
  crowd.set_goals({&id, 1}, {&here, 1});
  EXPECT_GT(steps_until(crowd, oracle, 1, 200), 0);
  EXPECT_NEAR(crowd.read(id)->position.x, 2, 0.5);
  const Place there = at(world, 19, 5);
  crowd.set_goals({&id, 1}, {&there, 1});
  for (int step = 0; step < 120; ++step) crowd.step();
  crowd.set_goals({&id, 1}, {&nowhere, 1});
  crowd.remove({&blocker, 1});
  for (int step = 0; step < 60; ++step) EXPECT_EQ(crowd.step().on_links, 0u);
}

TEST(CrowdLinkTurns, OneThatLeavesAnObstacleLearnsThatItsLinkIsOff) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
  const EditId link = add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = walker(crowd, at(world, 4, 5), at(world, 19, 5));
  for (int step = 0; step < 5; ++step) crowd.step();
  const Vec3d here = crowd.read(id)->position;
  put_up(crowd, edits, Prism::circle({here.x, 0, here.z}, 0.5, 1));
  crowd.step();
  EXPECT_TRUE(edits.set_active(link, false));
  uint64_t lost = 0;
  for (int step = 0; step < 150; ++step) {
    lost += crowd.step().no_path;
    oracle.look(crowd, step);
  }
  EXPECT_EQ(lost, 1u);
}

// The crowd keeps the measures of those that were removed.
TEST(CrowdLinkTurns, ASavedCrowdKnowsTheWidestThatWasRemoved) {
  const World world = gap();
  for (const AvatarSpawn& like :
       {AvatarSpawn{.radius = 0.7}, AvatarSpawn{.radius = 0.1}, AvatarSpawn{.speed = 6}}) {
    Edits edits;
    Oracle oracle{world,
                  {{at(world, 9, 4.5), at(world, 13, 4.5), 4, true},
                   {at(world, 9, 5.6), at(world, 13, 5.6), 4, true}}};
    add_links(edits, oracle);
    Crowd crowd = made(world, {.edits = edits});
    const AvatarId other = added(crowd, at(world, 1, 1), like);
    ASSERT_TRUE(other);
    crowd.remove({&other, 1});
    add_groups(crowd, world, 6);
    for (int step = 0; step < 40; ++step) crowd.step();
    Context context;
    auto restored = Crowd::restore(world, {.edits = edits}, crowd.save(), context);
    ASSERT_TRUE(restored) << restored.error().message;
    EXPECT_EQ(restored->save(), crowd.save());
    for (int step = 0; step < 200; ++step) {
      crowd.step();
      restored->step();
      ASSERT_EQ(crowd.state_hash(), restored->state_hash()) << step;
    }
  }
}

TEST(CrowdLinkTurns, ALinkThatIsAddedBeforeSavingChangesNothing) {
  const World world = gap();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  walker(crowd, at(world, 3, 5), at(world, 7, 5));
  crowd.step();
  add_link(edits, {at(world, 9, 5), at(world, 13, 5), 4, true});
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  auto restored = Crowd::restore(world, {.edits = edits}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->save(), saved);
  EXPECT_EQ(restored->state_hash(), crowd.state_hash());
  crowd.step();
  restored->step();
  EXPECT_EQ(restored->state_hash(), crowd.state_hash());
}

// Those beyond all views take longer steps, and not all in each step.
TEST(CrowdLinkTurns, AvatarsOfLowDetailTakeThem) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
  add_links(edits, oracle);
  Crowd crowd = made(world, {.tuning = {.low_detail_steps = 4}, .edits = edits});
  const CrowdView view{.position = {20, 2, 1}, .radius = 4};
  crowd.set_views({&view, 1});
  add_groups(crowd, world, 6);
  EXPECT_GT(steps_until(crowd, oracle, 12, 4000), 0);
}

TEST(CrowdLinkTurns, WideAndNarrowAvatarsPass) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world,
                {{at(world, 9, 4.4), at(world, 13, 4.4), 4, true},
                 {at(world, 9, 5.6), at(world, 13, 5.6), 4, true}}};
  add_links(edits, oracle);
  Crowd crowd = made(world, {.edits = edits});
  for (int i = 0; i < 6; ++i) {
    const double z = 2 + i * 1.2;
    for (const bool back : {false, true}) {
      const AvatarSpawn like{.radius = 0.12 + 0.06 * i};
      const AvatarId id = added(crowd, at(world, back ? 17 : 5, z), like);
      ASSERT_TRUE(id);
      const Place goal = at(world, back ? 4 : 18, z);
      crowd.set_goals({&id, 1}, {&goal, 1});
    }
  }
  EXPECT_GT(steps_until(crowd, oracle, 12, 4000), 0);
}

// A link straight up through the floor above.
TEST(CrowdLinkTurns, OnAVerticalLinkAnAvatarKeepsItsHeading) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({4, 2.8, 0}, {10, 3, 10});
  const World world = test::bake(scene, 0.1);
  Edits edits;
  Oracle oracle{world, {{at(world, 6, 5), at(world, 6, 5, 3), 3, true}}};
  add_links(edits, oracle);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = walker(crowd, at(world, 1, 5), at(world, 9, 5, 3));
  EXPECT_GT(step_until_riding(crowd, id).heading_x, 0.9);
  crowd.step();
  EXPECT_GT(crowd.read(id)->heading_x, 0.9);
  walker(crowd, at(world, 9, 2, 3), at(world, 1, 2));
  EXPECT_GT(steps_until(crowd, oracle, 2, 800), 0);
  EXPECT_GT(oracle.riding, 30u);
}

// A fast one behind a slow one, both so flat that a whole step would lead over it.
TEST(CrowdLinkTurns, FlatBodiesDoNotPassThroughEachOther) {
  Scene scene;
  scene.add_box({0, 0, 0}, {10, 3, 10});
  scene.add_box({10, -0.5, 0}, {20, 0, 10});
  const AvatarClass flat{
      .name = "flat", .height = 0.1, .radius = 0.5, .step_height = 0.05, .max_slope = 5};
  const World world = test::bake(scene, 0.1, {flat});
  Edits edits;
  Oracle oracle{world, {{at(world, 9.2, 5, 3), at(world, 10.8, 5), 3.4, false}}};
  add_links(edits, oracle);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId slow = added(crowd, at(world, 8, 5, 3), {.speed = 0.4});
  const AvatarId fast = added(crowd, at(world, 2, 5, 3), {.speed = 5});
  const Place goals[] = {at(world, 18, 3), at(world, 18, 7)};
  const AvatarId ids[] = {slow, fast};
  crowd.set_goals(ids, goals);
  int both = 0;
  for (int step = 0; step < 300; ++step) {
    crowd.step();
    const AvatarState a = *crowd.read(slow), b = *crowd.read(fast);
    if (a.mode != MoveMode::kLink || b.mode != MoveMode::kLink) continue;
    ++both;
    ASSERT_GT(b.position.y, a.position.y) << step;
  }
  EXPECT_GT(both, 3);
  EXPECT_GT(crowd.read(fast)->position.x, 17);
}

}  // namespace
}  // namespace throng::links
