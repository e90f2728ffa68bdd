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
    const auto crate = crowd.add_obstacle(Prism::box({13.3, 0, 4.5}, {13.8, 1, 5.5}),
                                          ObstacleKind::kStatic, policy);
    ASSERT_TRUE(crate);
    EXPECT_FALSE(crowd.obstacle(*crate)->is_up);
    EXPECT_GT(steps_until(crowd, oracle, 1, 400), 0);
    EXPECT_TRUE(crowd.obstacle(*crate)->is_up);
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
    const auto crate = crowd.add_obstacle(Prism::circle({13, 0, 5}, 0.4, 1));
    ASSERT_TRUE(crate);
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

TEST(CrowdLinkTurns, OneThatLeavesAnObstacleLearnsThatItsLinkIsOff) {
  const World world = gap();
  Edits edits;
  Oracle oracle{world, {{at(world, 9, 5), at(world, 13, 5), 4, false}}};
  const EditId link = add_link(edits, oracle.links[0]);
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = walker(crowd, at(world, 4, 5), at(world, 19, 5));
  for (int step = 0; step < 5; ++step) crowd.step();
  const Vec3d here = crowd.read(id)->position;
  ASSERT_TRUE(crowd.add_obstacle(Prism::circle({here.x, 0, here.z}, 0.5, 1)));
  crowd.step();
  EXPECT_TRUE(edits.set_active(link, false));
  uint64_t lost = 0;
  for (int step = 0; step < 150; ++step) {
    lost += crowd.step().no_path;
    oracle.look(crowd, step);
  }
  EXPECT_EQ(lost, 1u);
}

}  // namespace
}  // namespace throng::links
