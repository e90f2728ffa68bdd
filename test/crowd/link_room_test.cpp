// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "baked.h"
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

}  // namespace
}  // namespace throng::links
