// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "baked.h"
#include "core/hash.h"
#include "crowd/ground/body.h"
#include "crowd/link/link_use.h"
#include "crowd/mode/shared_state.h"
#include "crowds.h"
#include "links.h"
#include "throng/crowd.h"
#include "throng/path.h"

// Avatars that have arrived at an end of an off-mesh link and give room to those that use it.
namespace throng::links {
namespace {

double distance_of(const Crowd& crowd, AvatarId id, const Place& from) {
  const Vec3d there = crowd.read(id)->position;
  return std::hypot(there.x - from.position.x, there.z - from.position.z);
}

// In the gap: while it is up, no avatar gets a turn, and paths over links stay as they are.
EditId close_gap(Crowd& crowd, const Edits& edits) {
  return put_up(crowd, edits, Prism::box({10.8, 0, 4.5}, {11.2, 1, 5.5}));
}

// An avatar of 0.02 m is asked at 0.12 m from the end. The squares in which it is found begin at
// another place for each link.
TEST(CrowdLinkRoom, NarrowAvatarsAreAskedAtTheSameMargin) {
  const World world = gap();
  const AvatarSpawn narrow{.radius = 0.02};
  for (int i = 0; i < 4; ++i) {
    Edits edits;
    const Place end = at(world, 13 + 0.02 * i, 5);
    add_link(edits, {at(world, 9, 5), end, 4, false});
    Crowd crowd = made(world, {.edits = edits});
    const Place beside = at(world, end.position.x + 0.12, 5);
    const AvatarId resting = added(crowd, beside, narrow);
    crowd.set_goals({&resting, 1}, {&beside, 1});
    for (int step = 0; step < 5; ++step) crowd.step();
    ASSERT_NEAR(distance_of(crowd, resting, end), 0.12, 0.005) << "it rests there";
    close_gap(crowd, edits);
    const AvatarId waiting = added(crowd, at(world, 7, 5), narrow);
    const Place goal = at(world, 19, 5);
    crowd.set_goals({&waiting, 1}, {&goal, 1});
    for (int step = 0; step < 60; ++step) crowd.step();
    EXPECT_GT(distance_of(crowd, resting, end), 0.02 + 0.02 + 0.1) << i;
  }
}

// It searches in each step, because costs change, or because an obstacle changes the flow field of
// its target. Afterwards it is back.
TEST(CrowdLinkRoom, OneThatSearchesInEachStepGivesRoom) {
  const World world = gap();
  for (const bool by_flow : {false, true}) {
    for (const bool at_start : {true, false}) {
      Edits edits;
      Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, true}}};
      add_link(edits, oracle.links[0]);
      ChangesInEachStep changes(edits);
      Crowd crowd = made(world, {.edits = edits});
      const Place end = at(world, at_start ? 9 : 13, 5);
      const AvatarId resting = walker(crowd, at(world, at_start ? 7 : 15, 7), end);
      if (by_flow) {
        const Vec3d& p = end.position;
        const Prism there = Prism::box({p.x - 0.2, -1, p.z - 0.2}, {p.x + 0.2, 1, p.z + 0.2});
        Context context;
        const auto target = crowd.add_target({&there, 1}, context);
        ASSERT_TRUE(target);
        crowd.set_targets({&resting, 1}, *target);
      }
      ASSERT_GT(steps_until(crowd, oracle, 1, 100), 0);
      for (int i = 0; i < 4; ++i) walker(crowd, at(world, 2 + i, 3 + i), at(world, 17 + i, 3 + i));
      uint64_t arrived = 0;
      int steps_left = 60;  // after the last has arrived
      for (int step = 0; step < 1200 && steps_left > 0; ++step) {
        if (by_flow) {
          changes.change_flows(step);
        } else {
          changes.change_costs(step);
        }
        arrived += crowd.step().arrived;
        oracle.look(crowd, step);
        if (HasFatalFailure()) return;
        if (arrived >= 4) --steps_left;
      }
      EXPECT_EQ(arrived, 4u) << by_flow << ' ' << at_start;
      EXPECT_LT(distance_of(crowd, resting, end), 0.5) << by_flow << ' ' << at_start;
    }
  }
}

// It gives room at the far end as long as the gap is closed.
TEST(CrowdLinkRoom, OneThatGivesRoomTakesAnotherGoal) {
  const World world = gap();
  for (const bool by_target : {false, true}) {
    Edits edits;
    Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
    add_link(edits, oracle.links[0]);
    Crowd crowd = made(world, {.edits = edits});
    const Place end = at(world, 13, 5), goal = at(world, 18, 2);
    const AvatarId resting = walker(crowd, at(world, 15, 7), end);
    ASSERT_GT(steps_until(crowd, oracle, 1, 100), 0);
    close_gap(crowd, edits);
    const AvatarId waiting = walker(crowd, at(world, 7, 5), at(world, 19, 5));
    for (int step = 0; step < 100; ++step) crowd.step();
    ASSERT_GT(distance_of(crowd, resting, end), 0.5) << "it has stood aside";
    if (by_target) {
      Context context;
      const Prism there = Prism::box({17.5, -1, 1.5}, {18.5, 1, 2.5});
      const auto target = crowd.add_target({&there, 1}, context);
      ASSERT_TRUE(target);
      crowd.set_targets({&resting, 1}, *target);
    } else {
      crowd.set_goals({&resting, 1}, {&goal, 1});
    }
    EXPECT_GT(steps_until(crowd, oracle, 1, 150), 0) << by_target;
    EXPECT_LT(distance_of(crowd, resting, goal), 1) << by_target;
    EXPECT_LT(crowd.read(waiting)->position.x, 10) << "it still waits";
  }
}

// The wide one is added after the one at the end has stood aside for a narrow one.
TEST(CrowdLinkRoom, WiderAvatarsThatComeLaterGetRoomToo) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const Place end = at(world, 13, 5), goal = at(world, 18, 8);
  const AvatarId resting = walker(crowd, at(world, 15, 7), end);
  ASSERT_GT(steps_until(crowd, oracle, 1, 100), 0);
  const EditId crate = close_gap(crowd, edits);
  walker(crowd, at(world, 7, 5), at(world, 18, 2));
  for (int step = 0; step < 60; ++step) crowd.step();
  const double aside = distance_of(crowd, resting, end);
  ASSERT_GT(aside, 0.5);
  ASSERT_LT(aside, 0.9) << "a wide one has no room there";
  const AvatarId wide = added(crowd, at(world, 4, 5), {.radius = 0.7});
  ASSERT_TRUE(wide);
  crowd.set_goals({&wide, 1}, {&goal, 1});
  for (int step = 0; step < 100; ++step) crowd.step();
  EXPECT_TRUE(edits.remove(crate));
  EXPECT_GT(steps_until(crowd, oracle, 2, 600), 0);
  EXPECT_LT(distance_of(crowd, wide, goal), 0.5);
}

// One waits for a link that is closed, 0.8 m from the end of another: clear of it for avatars as
// narrow as itself, and in the place where a wide one must land.
TEST(CrowdLinkRoom, OneThatWaitsGivesRoomToAWiderOneThatComesLater) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world,
                {{at(world, 9, 5), at(world, 13, 5), 4, false},
                 {at(world, 13, 8), at(world, 8.05, 5.8), 6, false}}};
  for (const OffMeshLink& link : oracle.links) add_link(edits, link);
  Crowd crowd = made(world, {.edits = edits});
  close_gap(crowd, edits);
  const AvatarId waiting = walker(crowd, at(world, 4, 5), at(world, 19, 5));
  for (int step = 0; step < 60; ++step) crowd.step();
  const double aside = distance_of(crowd, waiting, oracle.links[1].to);
  ASSERT_GT(aside, 0.25 + 0.25 + 0.1) << "for those of that time it is far enough";
  ASSERT_LT(aside, 0.25 + 0.7) << "a wide one has no room there";
  const Place goal = at(world, 3, 8);
  const AvatarId wide = added(crowd, at(world, 16, 8), {.radius = 0.7});
  ASSERT_TRUE(wide);
  crowd.set_goals({&wide, 1}, {&goal, 1});
  EXPECT_GT(steps_until(crowd, oracle, 1, 600), 0);
  EXPECT_LT(distance_of(crowd, wide, goal), 0.5);
  EXPECT_LT(crowd.read(waiting)->position.x, 10) << "it still waits";
}

// Crates on three sides of the end leave no place that is clear of the link.
TEST(CrowdLinkRoom, OneThatFoundNoPlaceTriesAgain) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
  add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const Place end = at(world, 13, 5);
  const AvatarId resting = walker(crowd, end, end);
  ASSERT_GT(steps_until(crowd, oracle, 1, 10), 0);
  put_up(crowd, edits, Prism::box({12, 0, 4.2}, {13.8, 1, 4.4}));
  put_up(crowd, edits, Prism::box({12, 0, 5.6}, {13.8, 1, 5.8}));
  const EditId beyond = put_up(crowd, edits, Prism::box({13.6, 0, 4.2}, {13.8, 1, 5.8}));
  ASSERT_TRUE(crowd.obstacle(beyond)->is_up());
  const AvatarId waiting = walker(crowd, at(world, 7, 5), end);
  for (int step = 0; step < 100; ++step) EXPECT_EQ(crowd.step().arrived, 0u);
  ASSERT_LT(distance_of(crowd, resting, end), 0.3);
  ASSERT_LT(crowd.read(waiting)->position.x, 10);
  EXPECT_TRUE(edits.remove(beyond));
  EXPECT_GT(steps_until(crowd, oracle, 1, 200), 0);
  EXPECT_LT(distance_of(crowd, waiting, end), 0.4);
}

// The part of a saved crowd that is such a row, whatever lies before it.
template <class Row>
struct SavedRow {
  size_t at = 0;
  Row row;

  template <class Test>
  SavedRow(const std::vector<uint8_t>& saved, Test test) {
    int found = 0;
    for (size_t i = 0; i + sizeof(Row) <= saved.size(); i += 4) {
      Row here;
      std::memcpy(&here, saved.data() + i, sizeof here);
      if (!test(here)) continue;
      at = i;
      row = here;
      ++found;
    }
    EXPECT_EQ(found, 1);
  }
};

// Is a crowd restored in which these bytes are others, and its checksum is right?
struct Forgery {
  const World& world;
  const Edits& edits;
  const std::vector<uint8_t>& saved;

  template <class Row>
  [[nodiscard]] bool is_accepted(size_t at, const Row& row) const {
    std::vector<uint8_t> forged = saved;
    std::memcpy(forged.data() + at, &row, sizeof row);
    const uint64_t sum = hash_bytes(forged.data(), forged.size() - 8);
    std::memcpy(forged.data() + forged.size() - 8, &sum, 8);
    Context context;
    const auto restored = Crowd::restore(world, {.edits = edits}, forged, context);
    if (!restored) {
      EXPECT_EQ(restored.error().code, Errc::kBadFile);
    }
    return static_cast<bool>(restored);
  }
};

// One gives room at the far end of a link, and one waits for it.
TEST(CrowdLinkRoom, SavedRowsThatNoCrowdHasAreRefused) {
  using crowd::Body;
  using crowd::LinkUse;
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
  const EditId link = add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId resting = walker(crowd, at(world, 15, 7), at(world, 13, 5));
  ASSERT_GT(steps_until(crowd, oracle, 1, 100), 0);
  close_gap(crowd, edits);
  walker(crowd, at(world, 7, 5), at(world, 19, 5));
  uint64_t steps = 0;
  for (int step = 0; step < 60; ++step) steps = crowd.step().step;
  const std::vector<uint8_t> saved = crowd.save();
  const Forgery forgery{world, edits, saved};
  for (const LinkUse::State state : {LinkUse::kGivesRoom, LinkUse::kWaits}) {
    const SavedRow<LinkUse> use(saved, [&](const LinkUse& row) {
      return row.state == state && row.link == link && row.back == 0 && row.stands == 1 &&
             row.along == 0 && row.factor > 0.999f && row.factor <= 1;
    });
    const auto is_accepted = [&](auto change) {
      LinkUse row = use.row;
      change(row);
      return forgery.is_accepted(use.at, row);
    };
    constexpr uint64_t kUnits = crowd::SharedState::kTimeUnits;
    EXPECT_TRUE(is_accepted([](LinkUse& /*row*/) {}));
    EXPECT_TRUE(is_accepted([&](LinkUse& row) { row.since = (steps + 1) * kUnits - 1; }));
    EXPECT_FALSE(is_accepted([&](LinkUse& row) { row.since = (steps + 1) * kUnits; }));
    EXPECT_FALSE(is_accepted([](LinkUse& row) { row.since = UINT64_MAX; }));
    EXPECT_FALSE(is_accepted([](LinkUse& row) { row.stands = 2; }));
    EXPECT_FALSE(is_accepted([](LinkUse& row) { row.arrived = 2; }));
  }
  const SavedRow<Body> body(saved, [&](const Body& row) {
    return row.slot == resting.slot1 - 1 && row.speed == 1.34f && row.height == 1750 &&
           row.has(Body::kArrived) && row.has(Body::kHasGoal);
  });
  Body other = body.row;
  EXPECT_TRUE(forgery.is_accepted(body.at, other));
  other.clear(Body::kHasGoal);
  EXPECT_FALSE(forgery.is_accepted(body.at, other));
  other = body.row;
  other.clear(Body::kArrived);
  EXPECT_FALSE(forgery.is_accepted(body.at, other));
  other = body.row;
  other.flags |= Body::kExternal;
  EXPECT_FALSE(forgery.is_accepted(body.at, other));
}

// Its times would wrap.
TEST(CrowdLinkRoom, ASavedCrowdAfterTooManyStepsIsRefused) {
  const World world = gap();
  const Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  walker(crowd, at(world, 3, 5), at(world, 7, 5));
  for (int step = 0; step < 3; ++step) crowd.step();
  const std::vector<uint8_t> saved = crowd.save();
  constexpr size_t kAtStep = 48;  // bytes of the header before it
  uint64_t step = 0;
  std::memcpy(&step, saved.data() + kAtStep, sizeof step);
  ASSERT_EQ(step, 3u);
  const Forgery forgery{world, edits, saved};
  EXPECT_TRUE(forgery.is_accepted(kAtStep, (uint64_t{1} << 43) - 1));
  EXPECT_FALSE(forgery.is_accepted(kAtStep, uint64_t{1} << 43));
}

}  // namespace
}  // namespace throng::links
