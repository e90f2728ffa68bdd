// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "crowd/walk/aside_search.h"
#include "crowds.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"
#include "validate/maze.h"

// Avatars that stand aside for those that do not get on, in mazes whose corridors are as wide as
// one body.
namespace throng {
namespace {

struct MazeCrowd {
  explicit MazeCrowd(uint64_t seed, int32_t workers = 1, bool stands_aside = true) {
    const validate::Maze maze = validate::make_maze(seed);
    Context context;
    world = need(bake_world(need(create_plane_scene(maze.plane)),
                            {.cell = 0.05, .zone = 51.2, .classes = {AvatarClass{}}}, context));
    config = {.seed = seed, .workers = workers, .avoid_jams = stands_aside};
    crowd.emplace(need(Crowd::create(world, config)));
    const validate::Trips trips = validate::maze_trips(maze, 30, seed);
    for (size_t i = 0; i < trips.starts.size(); ++i) {
      const auto at = [&](const validate::Point2& p) {
        return world.find_place(0, {p.x, 0, p.z}, 0.2);
      };
      const AvatarId id = added(*crowd, at(trips.starts[i]));
      const Place goal = at(trips.goals[i]);
      EXPECT_TRUE(id && goal) << i;
      ids.push_back(id);
      crowd->set_goals({&id, 1}, {&goal, 1});
    }
  }
  template <class T>
  static T need(Result<T> made) {
    EXPECT_TRUE(made) << made.error().message;
    return *std::move(made);
  }
  // Those that arrive leave.
  void step() {
    arrived += crowd->step().arrived;
    const std::vector<AvatarId> there(crowd->arrived().begin(), crowd->arrived().end());
    crowd->remove(there);
  }
  void walk(int steps) {
    for (int i = 0; i < steps && crowd->size() > 0; ++i) {
      step();
      if (i % 20 != 0) continue;
      const CrowdCheck found = crowd->check();
      ASSERT_EQ(found.overlaps + found.wall_entries, 0u) << i;
    }
  }

  World world;
  CrowdConfig config;
  std::optional<Crowd> crowd;
  std::vector<AvatarId> ids;
  uint64_t arrived = 0;
};

TEST(Yielding, AllArriveInMazesWhereOthersStayForEver) {
  size_t left = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    MazeCrowd all(seed);
    all.walk(3000);
    EXPECT_EQ(all.arrived, 30u) << seed;
    EXPECT_EQ(all.crowd->size(), 0u) << seed;
    MazeCrowd others(seed, 1, /*stands_aside=*/false);
    others.walk(3000);
    left += others.crowd->size();
  }
  EXPECT_GT(left, 10u) << "else the test shows nothing";
}

TEST(Yielding, SameStateForAnyWorkersAndWhenRestored) {
  MazeCrowd one(7, 1), many(7, 3);
  Context context;
  for (int i = 0; i < 250; ++i) {
    one.step();
    many.step();
    ASSERT_EQ(one.crowd->state_hash(), many.crowd->state_hash()) << i;
  }
  const std::vector<uint8_t> saved = one.crowd->save();
  many.crowd.emplace(MazeCrowd::need(Crowd::restore(many.world, many.config, saved, context)));
  for (int i = 0; i < 600; ++i) {
    one.step();
    many.step();
    ASSERT_EQ(one.crowd->state_hash(), many.crowd->state_hash()) << i;
  }
  EXPECT_EQ(one.crowd->save(), many.crowd->save());
}

// One that stands aside and gets another goal, or none, forgets it.
TEST(Yielding, OtherGoalsComeFirst) {
  MazeCrowd maze(2);
  uint64_t n = 0;
  for (int i = 0; i < 600; ++i) {
    maze.step();
    if (i % 7 != 0) continue;
    const AvatarId id = maze.ids[n++ % maze.ids.size()];
    const Place goal = n % 5 == 0 ? Place{} : maze.world.random_place(0, 3, n);
    maze.crowd->set_goals({&id, 1}, {&goal, 1});
    const CrowdCheck found = maze.crowd->check();
    ASSERT_EQ(found.overlaps + found.wall_entries, 0u) << i;
  }
}

TEST(PathLine, TheNearestPointIsThatOfManySamples) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    crowd::PathLine line;
    line.clear(100);
    for (uint64_t i = 0; i < 5; ++i) {
      line.add(1000 * random_unit(seed, 1, i), 1000 * random_unit(seed, 2, i), 0);
    }
    const double x = 1000 * random_unit(seed, 3, 0), z = 1000 * random_unit(seed, 3, 1);
    double least = 1e300, along = 0;
    const auto& points = line.points();
    for (size_t i = 1; i < points.size(); ++i) {
      for (int k = 0; k <= 20000; ++k) {
        const double part = k / 20000.0;
        const double px = points[i - 1].x + part * (points[i].x - points[i - 1].x);
        const double pz = points[i - 1].z + part * (points[i].z - points[i - 1].z);
        const double square = (px - x) * (px - x) + (pz - z) * (pz - z);
        if (square >= least) continue;
        least = square;
        along = points[i - 1].along + part * (points[i].along - points[i - 1].along);
      }
    }
    const auto found = line.nearest(x, z, 0, 1750);
    EXPECT_NEAR(std::sqrt(found.square), std::sqrt(least), 0.1) << seed;
    EXPECT_NEAR(found.along, along, 0.5) << seed;
    EXPECT_GT(line.nearest(x, z, 2000, 1750).square, 1e299) << "another storey";
  }
}

}  // namespace
}  // namespace throng
