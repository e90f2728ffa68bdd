// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "worlds.h"

// What a crowd does with classes that climb: on level tiles they are as others.
namespace throng {
namespace {

TEST(Climbers, WalkWhereTheyCanAsThoseWhoDoNotClimb) {
  AvatarClass climber = default_classes()[0], adult = climber;
  climber.name = "climber";
  climber.climb_slope = 120;
  const World world = test::bake(worlds::two_floors(), 0.1, {adult, climber});
  for (const int32_t avatar_class : {0, 1}) {
    Crowd crowd = made(world);
    std::vector<AvatarId> ids;
    std::vector<Place> goals;
    for (int i = 0; i < 8; ++i) {
      const double x = 2.0 + 0.8 * (i % 4), z = 3.0 + i / 4;
      ids.push_back(added(crowd, world.find_place(avatar_class, {x, 0, z}, 0.5),
                          {.avatar_class = avatar_class}));
      goals.push_back(world.find_place(avatar_class, {x + 4.5, 3, z}, 0.5));  // upstairs
      ASSERT_TRUE(ids.back() && goals.back());
    }
    crowd.set_goals(ids, goals);
    std::set<uint32_t> there;
    for (int step = 0; step < 600 && there.size() < ids.size(); ++step) {
      crowd.step();
      for (const AvatarId id : crowd.arrived()) there.insert(id.slot1);
      const CrowdCheck check = crowd.check();
      ASSERT_EQ(check.overlaps + check.wall_entries, 0u);
    }
    EXPECT_EQ(there.size(), ids.size()) << avatar_class;
    std::vector<AvatarState> states;
    crowd.read(states);
    for (const AvatarState& state : states) EXPECT_NEAR(state.position.y, 3, 0.01);
  }
}

}  // namespace
}  // namespace throng
