// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/lane_offset.h"

#include <gtest/gtest.h>

#include <vector>

#include "baked.h"
#include "core/access.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "throng/scene.h"
#include "world/place.h"

namespace throng {
namespace {

// A corridor along X that turns along Z around the block that ends at (10, 2); both `width` wide.
struct Bend {
  explicit Bend(double width) {
    const double out = 10 + width;
    PlaneConfig plane;
    plane.ground = {{{0, 0}, {20, 0}, {20, 16}, {0, 16}}, {}};
    plane.obstacles = {{{{0, width}, {10, width}, {10, 16}, {0, 16}}, {}},
                       {{{out, 0}, {20, 0}, {20, 16}, {out, 16}}, {}}};
    const auto scene = create_plane_scene(plane);
    EXPECT_TRUE(scene) << scene.error().message;
    AvatarClass walker;
    walker.radius = 0.19;
    world = test::bake(*scene, 0.05, {walker});
    ground = *crowd::CrowdGround::create(*data_of(world), 0, 400);
    stride = crowd::StrideGround(ground, 400);
    metre = static_cast<float>(world::kUnitsPerCell / 0.05);
    corner = point_at({10.22, 0, width - 0.22});
    next = point_at({10.4, 0, 12});
    body.radius = static_cast<int32_t>(0.19 * metre);
  }
  [[nodiscard]] crowd::PathPoint point_at(Vec3d position) const {
    const Place place = world.find_place(0, position, 0.2);
    EXPECT_TRUE(place) << position.x << " " << position.z;
    return crowd::point_of(*data_of(world), place);
  }
  // Of a body in the first corridor, at this distance from its inner wall (at z = width). [m]
  crowd::PathPoint own(double x, double z) {
    const crowd::PathPoint at = point_at({x, 0, z});
    body.x = at.x;
    body.z = at.z;
    body.level = at.level;
    crowd::Route route;
    route.corners[0] = corner;
    route.corners[1] = next;
    route.count = 2;
    return crowd::lane_offset(body, route, stride, {metre});
  }
  // The same if the corner is the first of two that are 5 cm from each other.
  crowd::PathPoint own_before_bend(double x, double z, bool queues) {
    own(x, z);
    crowd::Route route;
    route.corners[0] = corner;
    route.corners[1] = corner;
    route.corners[1].x += static_cast<int32_t>(0.05 * metre);
    route.corners[1].z += static_cast<int32_t>(0.05 * metre);
    route.corners[2] = next;
    route.count = 3;
    return crowd::lane_offset(body, route, stride, {metre, queues});
  }
  [[nodiscard]] double off(const crowd::PathPoint& place) const {  // from the corner [m]
    return std::hypot(place.x - corner.x, place.z - corner.z) / metre;
  }

  World world;
  crowd::CrowdGround ground;
  crowd::StrideGround stride;
  crowd::PathPoint corner, next;
  crowd::Body body;
  float metre = 1;
};

TEST(LaneOffset, ABodyThatWalksFartherOutTurnsFartherOut) {
  Bend bend(2);
  double before = -1;
  for (const double z : {1.7, 1.4, 1.0, 0.6, 0.25}) {  // the inner wall is at z = 2
    const double off = bend.off(bend.own(5, z));
    EXPECT_GT(off, before) << z;
    before = off;
  }
  EXPECT_LT(bend.off(bend.own(5, 1.7)), 0.2);
  EXPECT_GT(before, 1);
  EXPECT_LT(before, 1.9);  // of the widest, ten radii
}

TEST(LaneOffset, IsSeenFromHereAndSeesTheNextCorner) {
  Bend bend(2);
  uint64_t others = 0;
  for (int n = 0; n < 200; ++n) {
    const double x = 2 + 0.04 * n, z = 0.25 + 0.007 * ((n * 37) % 200);
    const crowd::PathPoint place = bend.own(x, z);
    const world::GroundPoint at{place.x, place.z}, body = bend.body.point();
    if (bend.off(place) == 0) continue;
    EXPECT_TRUE(bend.stride.sees(bend.body.level, body, at, place.level, 3 * bend.metre)) << n;
    EXPECT_TRUE(bend.stride.sees(place.level, at, {bend.next.x, bend.next.z}, bend.next.level,
                                 3 * bend.metre))
        << n;
    others += bend.off(place) > 0.05 ? 1 : 0;
  }
  EXPECT_GT(others, 150u);
}

TEST(LaneOffset, IsTheCornerWhereFewFitOrNothingBends) {
  Bend narrow(1.2);  // Centres have 0.82 m: two abreast, not three.
  EXPECT_EQ(narrow.off(narrow.own(5, 0.4)), 0);
  Bend bend(2);
  const crowd::PathPoint ahead = bend.next;
  bend.next = bend.point_at({10.9, 0, 1.8});  // straight on
  EXPECT_EQ(bend.off(bend.own(5, 1.6)), 0);
  bend.next = ahead;
  EXPECT_GT(bend.off(bend.own(5, 1.0)), 0);
}

// Corners around one wall are a few centimetres from each other.
TEST(LaneOffset, CornersNearEachOtherAreOneBendForThoseThatQueue) {
  Bend bend(2), narrow(1.2);
  for (const double z : {1.7, 1.4, 1.0, 0.6}) {
    const double alone = bend.off(bend.own(5, z));
    EXPECT_NEAR(bend.off(bend.own_before_bend(5, z, true)), alone, 0.1) << z;
    EXPECT_GT(std::abs(bend.off(bend.own_before_bend(5, z, false)) - alone), 0) << z;
  }
  EXPECT_EQ(narrow.off(narrow.own_before_bend(5, 0.4, true)), 0);
}

TEST(LaneOffset, ABodyInCounterflowKeepsToTheRightHalf) {
  Bend bend(2);  // to the right
  for (const double z : {1.7, 1.4, 1.0, 0.6, 0.25}) {
    bend.body.on_right = false;
    const double anywhere = bend.off(bend.own(5, z));
    bend.body.on_right = true;
    EXPECT_NEAR(bend.off(bend.own(5, z)), anywhere / 2, 0.01) << z;
  }
}

// Two rooms and a corridor of 2 m between them: with each avatar at the place that the walls leave
// it, sixty that met sixty there stood for ever.
TEST(LaneOffset, GroupsThatMeetInACorridorPass) {
  PlaneConfig plane;
  plane.ground = {{{0, 0}, {30, 0}, {30, 10}, {0, 10}}, {}};
  plane.obstacles = {{{{10, 0}, {20, 0}, {20, 4}, {10, 4}}, {}},
                     {{{10, 6}, {20, 6}, {20, 10}, {10, 10}}, {}}};
  const auto scene = create_plane_scene(plane);
  ASSERT_TRUE(scene) << scene.error().message;
  AvatarClass walker;
  walker.radius = 0.19;
  const World world = test::bake(*scene, 0.05, {walker});
  Crowd crowd = made(world, {.dt = 0.1});
  std::vector<AvatarId> ids;
  std::vector<Place> goals;
  for (int n = 0; n < 120; ++n) {
    const bool west = n % 2 == 0;
    const double x = 1 + 0.8 * (n / 2 % 10), z = 2 + 1.0 * (n / 20);
    ids.push_back(added(crowd, world.find_place(0, {west ? x : 30 - x, 0, z}, 0.3)));
    goals.push_back(world.find_place(0, {west ? 30 - x : x, 0, z}, 0.3));
  }
  crowd.set_goals(ids, goals);
  uint64_t arrived = 0;
  for (int step = 0; step < 2000 && arrived < ids.size(); ++step) {
    arrived += crowd.step().arrived;
    if (step % 100 == 0) {
      const CrowdCheck found = crowd.check();
      EXPECT_EQ(found.overlaps + found.wall_entries, 0u) << step;
    }
  }
  EXPECT_EQ(arrived, ids.size());
}

}  // namespace
}  // namespace throng
