// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "baked.h"
#include "core/hash.h"
#include "core/random.h"
#include "crowd/crowd_check.h"
#include "crowds.h"
#include "simd_targets.h"
#include "throng/crowd.h"
#include "worlds.h"

namespace throng {
namespace {

bool is_up(const Crowd& crowd, EditId id) { return crowd.obstacle(id)->is_up(); }
bool waits(const Crowd& crowd, EditId id) { return crowd.obstacle(id)->waits(); }

// Changes that the crowd knows at once.
void set_active(Crowd& crowd, Edits& edits, EditId id, bool active) {
  EXPECT_TRUE(edits.set_active(id, active));
  follow(crowd);
}
void move(Crowd& crowd, Edits& edits, EditId id, const Prism& prism) {
  const auto moved = edits.move_obstacle(id, prism);
  EXPECT_TRUE(moved) << moved.error().message;
  follow(crowd);
}

void send(Crowd& crowd, AvatarId id, const Place& goal) {
  crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
}

Vec3d position(const Crowd& crowd, AvatarId id) {
  std::vector<AvatarState> states;
  crowd.read(states);
  for (const AvatarState& state : states) {
    if (state.id + 1 == id.slot1) return state.position;
  }
  ADD_FAILURE() << "no avatar has that id";
  return {};
}

bool is_free(const Crowd& crowd) {
  const CrowdCheck found = crowd.check();
  return found.wall_entries + found.overlaps + found.obstacle_entries == 0;
}

// A square of 24 m, cut by a wall at x = 12 with openings of 2 m at z = 4 and z = 20.
World two_openings() {
  Scene scene = worlds::flat(24);
  scene.add_box({11.9, 0, 0}, {12.1, 3, 3});
  scene.add_box({11.9, 0, 5}, {12.1, 3, 19});
  scene.add_box({11.9, 0, 21}, {12.1, 3, 24});
  return test::bake(scene, 0.1);
}

constexpr Vec3d kNearDoor{12, 0, 4}, kFarDoor{12, 0, 20};
Prism crate_at(const Vec3d& middle, double half = 1.2) {
  return Prism::box({middle.x - half, middle.y, middle.z - half},
                    {middle.x + half, middle.y + 1, middle.z + half});
}

// ---- How they act on walkers.

TEST(CrowdObstacles, AvatarsTakeTheOtherOpeningWhileACrateStandsInTheFirst) {
  const World world = two_openings();
  const Place from = world.find_place(0, {4, 0, 4}, 0.5), to = world.find_place(0, {20, 0, 4}, 0.5);
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const auto steps_through = [&](const Vec3d& door) {
    const AvatarId id = added(crowd, from);
    send(crowd, id, to);
    bool passed = false;
    int steps = 0;
    for (bool there = false; !there && steps < 1000; ++steps) {
      crowd.step();
      EXPECT_TRUE(is_free(crowd));
      const Vec3d at = position(crowd, id);
      passed |= std::hypot(at.x - door.x, at.z - door.z) < 1;
      there = !crowd.arrived().empty();
    }
    EXPECT_TRUE(passed);
    crowd.remove(std::span(&id, 1));
    return steps;
  };
  const int straight = steps_through(kNearDoor);
  const EditId crate = put_up(crowd, edits, crate_at(kNearDoor));
  EXPECT_TRUE(is_up(crowd, crate));
  const int around = steps_through(kFarDoor);
  EXPECT_GT(around, straight + 100);
  EXPECT_LT(around, 400);
  EXPECT_TRUE(edits.remove(crate));
  EXPECT_EQ(steps_through(kNearDoor), straight);
}

TEST(CrowdObstacles, AnAvatarTurnsBackWhenADoorAheadCloses) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = added(crowd, world.find_place(0, {2, 0, 4}, 0.5));
  const EditId door = put_up(crowd, edits, crate_at(kNearDoor));
  set_active(crowd, edits, door, false);
  send(crowd, id, world.find_place(0, {20, 0, 4}, 0.5));
  for (int step = 0; step < 10; ++step) crowd.step();
  EXPECT_LT(std::fabs(position(crowd, id).z - 4), 0.3);
  set_active(crowd, edits, door, true);
  EXPECT_TRUE(is_up(crowd, door));
  EXPECT_EQ(crowd.step().planned, 1u) << "it notices at once, 7 m before the door";
  int steps = 0;
  for (bool there = false; !there && steps < 1000; ++steps) {
    crowd.step();
    there = !crowd.arrived().empty();
    ASSERT_TRUE(is_free(crowd));
  }
  EXPECT_LT(steps, 400);
}

TEST(CrowdObstacles, OfTwoDoorsThatTakeTurnsTheOpenOneIsUsed) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = added(crowd, world.find_place(0, {4, 0, 12}, 0.5));
  const Place ends[] = {world.find_place(0, {20, 0, 12}, 0.5),
                        world.find_place(0, {4, 0, 12}, 0.5)};
  const EditId doors[] = {put_up(crowd, edits, crate_at(kNearDoor)),
                          put_up(crowd, edits, crate_at(kFarDoor))};
  for (size_t turn = 0; turn < 6; ++turn) {
    const Vec3d open = turn % 4 < 2 ? kNearDoor : kFarDoor;
    set_active(crowd, edits, doors[0], turn % 4 >= 2);
    set_active(crowd, edits, doors[1], turn % 4 < 2);
    send(crowd, id, ends[turn % 2]);
    bool passed = false, there = false;
    for (int step = 0; step < 500 && !there; ++step) {
      crowd.step();
      ASSERT_TRUE(crowd.goal_unreachable().empty());
      ASSERT_TRUE(is_free(crowd));
      const Vec3d at = position(crowd, id);
      passed |= std::hypot(at.x - open.x, at.z - open.z) < 1;
      there = !crowd.arrived().empty();
    }
    EXPECT_TRUE(passed && there) << turn;
  }
}

TEST(CrowdObstacles, TheGoalOfAnAvatarWithoutAPathIsUnreachable) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = added(crowd, world.find_place(0, {4, 0, 12}, 0.5));
  send(crowd, id, world.find_place(0, {20, 0, 12}, 0.5));
  crowd.step();
  EXPECT_TRUE(crowd.goal_unreachable().empty());
  put_up(crowd, edits, crate_at(kNearDoor));
  crowd.step();
  EXPECT_TRUE(crowd.goal_unreachable().empty());
  put_up(crowd, edits, crate_at(kFarDoor));
  EXPECT_EQ(crowd.step().no_path, 1u);
  ASSERT_EQ(crowd.goal_unreachable().size(), 1u);
  EXPECT_EQ(crowd.goal_unreachable()[0], id);
  // A goal under an obstacle is unreachable too.
  const Place here = world.find_place(0, {8, 0, 22}, 0.5);
  put_up(crowd, edits, crate_at({8, 0, 22}));
  send(crowd, id, here);
  EXPECT_EQ(crowd.step().no_path, 1u);
}

TEST(CrowdObstacles, ADoorWaitsForAvatarsInItAndOpensAtOnce) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = added(crowd, world.find_place(0, kNearDoor, 0.5));
  const AvatarId other = added(crowd, world.find_place(0, {20, 0, 20}, 0.5));
  ASSERT_TRUE(id && other);
  const EditId door =
      put_up(crowd, edits, crate_at(kNearDoor, 0.5), ObstacleKind::kStatic, ObstaclePolicy::kWait);
  EXPECT_FALSE(is_up(crowd, door));
  EXPECT_TRUE(waits(crowd, door));
  for (int step = 0; step < 20; ++step) {
    EXPECT_EQ(crowd.step().waiting, 1u);
    ASSERT_EQ(crowd.blockers().size(), 1u);
    EXPECT_EQ(crowd.blockers()[0], id);
    ASSERT_TRUE(is_free(crowd));
  }
  send(crowd, id, world.find_place(0, {6, 0, 4}, 0.5));
  int steps = 0;
  for (; !is_up(crowd, door) && steps < 100; ++steps) {
    crowd.step();
    ASSERT_TRUE(is_free(crowd));
  }
  EXPECT_GT(steps, 3);
  EXPECT_LT(steps, 20);
  EXPECT_EQ(crowd.step().waiting, 0u);
  EXPECT_TRUE(crowd.blockers().empty());
  EXPECT_FALSE(added(crowd, world.find_place(0, kNearDoor, 0.5))) << "it is closed";
  set_active(crowd, edits, door, false);
  EXPECT_FALSE(is_up(crowd, door));
  EXPECT_TRUE(added(crowd, world.find_place(0, kNearDoor, 0.5)));
  // Requested to close, and to open again before it could: it is open.
  set_active(crowd, edits, door, true);
  EXPECT_TRUE(waits(crowd, door));
  set_active(crowd, edits, door, false);
  EXPECT_EQ(crowd.step().waiting, 0u);
}

TEST(CrowdObstacles, ACartDoesNotJumpOverAnyAvatar) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = added(crowd, world.find_place(0, {10, 0, 10}, 0.5));
  const auto cart_at = [](double x) { return Prism::circle({x, 0, 10}, 0.5, 1); };
  const EditId cart = put_up(crowd, edits, cart_at(5), ObstacleKind::kKinematic);
  EXPECT_TRUE(is_up(crowd, cart));
  move(crowd, edits, cart, cart_at(15));
  EXPECT_TRUE(waits(crowd, cart));
  crowd.step();
  EXPECT_NEAR(crowd.obstacle(cart)->prism.corners[0][0], 5.5, 0.02) << "it stays where it is";
  EXPECT_EQ(crowd.obstacle(cart)->phase, ObstaclePhase::kWaitsToMove);
  ASSERT_EQ(crowd.blockers().size(), 1u);
  EXPECT_EQ(crowd.blockers()[0], id);
  move(crowd, edits, cart, cart_at(8));
  EXPECT_NEAR(crowd.obstacle(cart)->prism.corners[0][0], 8.5, 0.02);
  EXPECT_FALSE(waits(crowd, cart));
  crowd.remove(std::span(&id, 1));
  move(crowd, edits, cart, cart_at(15));
  EXPECT_FALSE(waits(crowd, cart));
  EXPECT_TRUE(added(crowd, world.find_place(0, {8, 0, 10}, 0.5)));
  EXPECT_FALSE(added(crowd, world.find_place(0, {15, 0, 10}, 0.5)));
}

TEST(CrowdObstacles, PathsIgnoreCartsButWalkersDoNot) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const AvatarId id = added(crowd, world.find_place(0, {4, 0, 10}, 0.5));
  put_up(crowd, edits, Prism::circle({10, 0, 10.1}, 0.4, 1), ObstacleKind::kKinematic);
  send(crowd, id, world.find_place(0, {16, 0, 10}, 0.5));
  bool there = false;
  for (int step = 0; step < 300 && !there; ++step) {
    crowd.step();
    ASSERT_TRUE(is_free(crowd));
    there = !crowd.arrived().empty();
  }
  EXPECT_TRUE(there);
}

// ---- Heights, borders, sizes.

TEST(CrowdObstacles, OnlyWhatABodyCouldTouchBlocks) {
  const World world = test::bake(worlds::two_floors(), 0.1);  // the deck is at 3
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const Place low = world.find_place(0, {8, 0, 4}, 0.5), high = world.find_place(0, {8, 3, 4}, 0.5);
  ASSERT_TRUE(low && high);
  const auto stand = [&](double bottom, double top) {
    const EditId id = put_up(crowd, edits, Prism::box({7.8, bottom, 3.8}, {8.2, top, 4.2}));
    EXPECT_TRUE(is_up(crowd, id));
    std::string free_levels;
    for (const Place& place : {low, high}) {
      const AvatarId avatar = added(crowd, place);
      free_levels += avatar ? '1' : '0';
      crowd.remove(std::span(&avatar, 1));
    }
    EXPECT_TRUE(edits.remove(id));
    return free_levels;
  };
  EXPECT_EQ(stand(0, 1), "01");
  EXPECT_EQ(stand(3, 4), "10");
  EXPECT_EQ(stand(0, 4), "00");
  EXPECT_EQ(stand(1.7, 1.9), "01") << "heads are at 1.75";
  EXPECT_EQ(stand(1.8, 2.7), "11") << "above the heads";
  EXPECT_EQ(stand(0, 0.3), "11") << "below the step";
  EXPECT_EQ(stand(0, 0.45), "01");
  EXPECT_EQ(stand(-5, -0.1), "11");
}

TEST(CrowdObstacles, TinyOnesOnBordersAndHugeOnesCountToo) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const double radius = world.summary().classes[0].radius;
  const Vec3d origin = world.summary().origin;
  // A pin on the corner of four tiles.
  const double x = origin.x + 6.4, z = origin.z + 6.4;
  const EditId pin = put_up(crowd, edits, {{{x, z}, {x + 1e-5, z}, {x, z + 1e-5}}, 0, 1});
  for (const double side : {-1.0, 1.0}) {
    const double far = radius + 0.25, near = radius - 0.02;
    EXPECT_FALSE(added(crowd, world.find_place(0, {x + side * near, 0, z}, 0.5)));
    EXPECT_FALSE(added(crowd, world.find_place(0, {x, 0, z + side * near}, 0.5)));
    const AvatarId id = added(crowd, world.find_place(0, {x + side * far, 0, z}, 0.5));
    EXPECT_TRUE(id);
    crowd.remove(std::span(&id, 1));
  }
  EXPECT_TRUE(edits.remove(pin));
  const EditId all = put_up(crowd, edits, Prism::box({-1e6, -1, -1e6}, {1e6, 50, 1e6}));
  EXPECT_TRUE(is_up(crowd, all));
  Context context;
  EXPECT_FALSE(crowd.scatter(1, {}, context));
  EXPECT_TRUE(edits.remove(all));
  scattered(crowd, 50);
  const EditId away = put_up(crowd, edits, Prism::box({1e6, -1, 1e6}, {2e6, 50, 2e6}));
  EXPECT_TRUE(is_up(crowd, away)) << "beyond the world no avatar blocks it";
  const EditId again = put_up(crowd, edits, Prism::box({-1e6, -1, -1e6}, {1e6, 50, 1e6}));
  EXPECT_FALSE(is_up(crowd, again));
  crowd.step();
  EXPECT_EQ(crowd.blockers().size(), 50u);
}

TEST(CrowdObstacles, WhatIsNoPrismOrNoObstacleIsRefusedWithASentence) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const auto refused = [&](const Prism& prism) {
    const auto id = edits.add_obstacle(prism);
    return id ? std::string("accepted") : id.error().message;
  };
  const std::string not_convex =
      "prism: its corners are not those of a convex polygon, in order; cut it into convex ones";
  EXPECT_EQ(refused({{{1, 1}, {2, 1}}, 0, 1}), "prism: it has 2 corners, give it 3 to 64");
  EXPECT_EQ(refused({{{1, 1}, {2, 1}, {3, 1}}, 0, 1}), not_convex);
  EXPECT_EQ(refused({{{1, 1}, {1, 1}, {1, 1}}, 0, 1}), not_convex);
  EXPECT_EQ(refused({{{0, 0}, {2, 0}, {1, 0.2}, {1, 2}}, 0, 1}), not_convex);
  EXPECT_EQ(refused({{{1, 1}, {2, NAN}, {3, 3}}, 0, 1}), "prism: corner 1 is not a place on Earth");
  EXPECT_EQ(refused({{{1, 1}, {2, 1}, {2, 2}}, 1, 1}),
            "prism: its bottom must lie below its top, both finite");
  EXPECT_EQ(refused({{{1, 1}, {2, 1}, {2, 2}}, 0, INFINITY}),
            "prism: its bottom must lie below its top, both finite");
  EXPECT_TRUE(crowd.obstacles().empty());
  const EditId id = put_up(crowd, edits, crate_at({5, 0, 5}));
  EXPECT_FALSE(edits.move_obstacle(id, {}));
  follow(crowd);
  EXPECT_EQ(crowd.obstacles().size(), 1u);
  EXPECT_TRUE(edits.remove(id));
  EXPECT_FALSE(edits.remove(id));
  EXPECT_FALSE(edits.set_active(id, true));
  EXPECT_FALSE(crowd.obstacle(id));
  EXPECT_FALSE(crowd.obstacle(0));
  EXPECT_FALSE(crowd.obstacle(7));
  const auto moved = edits.move_obstacle(id, crate_at({5, 0, 5}));
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().code, Errc::kNotFound);
  EXPECT_EQ(moved.error().message, "obstacle: no obstacle has the id 1");
  const EditId next = put_up(crowd, edits, crate_at({5, 0, 5}));
  EXPECT_NE(next, id);
  EXPECT_EQ(crowd.obstacle(id).error().code, Errc::kNotFound);
  EXPECT_EQ(crowd.obstacle(id).error().message, "crowd: no obstacle of its edits has the id 1");
  const auto area = edits.add_area(crate_at({9, 0, 9}), 3);
  ASSERT_TRUE(area);
  EXPECT_EQ(crowd.obstacle(*area).error().code, Errc::kNotFound);
}

// ---- The test of obstacles in check() can fail.

TEST(CrowdObstacles, TheCheckCountsAvatarsInAnObstacle) {
  const World world = test::bake(worlds::flat(20), 0.1);
  const double unit = 0.1 / 2048, radius = world.summary().classes[0].radius;
  const Vec3d origin = world.summary().origin;
  const auto entries = [&](double x, double z, double feet, const Prism& prism) {
    const crowd::CheckedBody body{.x = static_cast<int32_t>((x - origin.x) / unit),
                                  .z = static_cast<int32_t>((z - origin.z) / unit),
                                  .y = static_cast<int32_t>(feet * 1000),
                                  .level = 0,
                                  .avatar_class = 0,
                                  .radius = radius,
                                  .height = 1.75};
    return crowd::check_bodies(world, std::span(&body, 1), std::span(&prism, 1), 1)
        .obstacle_entries;
  };
  const Prism box = Prism::box({5, 0, 5}, {7, 1, 7});
  Prism reversed = box;
  std::reverse(reversed.corners.begin(), reversed.corners.end());
  for (const Prism& prism : {box, reversed}) {
    EXPECT_EQ(entries(6, 6, 0, prism), 1u);
    EXPECT_EQ(entries(5 - radius + 0.001, 6, 0, prism), 1u);
    EXPECT_EQ(entries(5 - radius - 0.001, 6, 0, prism), 0u);
    EXPECT_EQ(entries(6, 7 + radius - 0.001, 0, prism), 1u);
    EXPECT_EQ(entries(6, 7 + radius + 0.001, 0, prism), 0u);
    const double corner = radius / std::sqrt(2.0);
    EXPECT_EQ(entries(7 + corner - 0.001, 7 + corner - 0.001, 0, prism), 1u);
    EXPECT_EQ(entries(7 + corner + 0.001, 7 + corner + 0.001, 0, prism), 0u);
    EXPECT_EQ(entries(6, 6, 0.59, prism), 1u);
    EXPECT_EQ(entries(6, 6, 0.61, prism), 0u) << "a step up";
    EXPECT_EQ(entries(6, 6, -1.74, prism), 1u);
    EXPECT_EQ(entries(6, 6, -1.76, prism), 0u);
  }
}

// ---- Many of them, while many walk.

// Adds, moves, switches on and off and removes at random; checks after every step.
struct Chaos {
  Crowd& crowd;
  Edits edits;
  const World& world;
  uint64_t seed;
  std::vector<EditId> ids;
  uint64_t n = 0, came_up = 0, moved = 0;

  double draw() { return random_unit(seed, 77, n++); }

  Prism prism(const Vec3d& at) {
    const double low = at.y - 0.2 + draw() * draw() * 2, high = low + 0.2 + 2.5 * draw();
    const double size = 0.05 + 1.5 * draw() * draw();
    if (draw() < 0.5) {
      return Prism::box({at.x - size, low, at.z - size * draw()}, {at.x + size, high, at.z + size});
    }
    return Prism::circle({at.x, low, at.z}, size, high - low, 3 + static_cast<int>(20 * draw()));
  }
  Vec3d somewhere() { return world.random_place(0, seed, n++).position; }
  Prism shifted(Prism p) {
    const double dx = 0.4 * draw() - 0.2, dz = 0.4 * draw() - 0.2;
    for (auto& [x, z] : p.corners) {
      x += dx;
      z += dz;
    }
    return p;
  }

  void act() {
    for (int k = 0; k < 3; ++k) {
      if (ids.size() < 40) {
        const auto kind = draw() < 0.6 ? ObstacleKind::kStatic : ObstacleKind::kKinematic;
        const auto policy = draw() < 0.7 ? ObstaclePolicy::kRefuseEntry : ObstaclePolicy::kWait;
        ids.push_back(put_up(crowd, edits, prism(somewhere()), kind, policy));
        came_up += is_up(crowd, ids.back()) ? 1 : 0;
      }
      const size_t i = static_cast<size_t>(draw() * static_cast<double>(ids.size()));
      const double what = draw();
      if (what < 0.5) {
        const Prism before = crowd.obstacle(ids[i])->prism;
        move(crowd, edits, ids[i], shifted(before));
        moved += crowd.obstacle(ids[i])->waits() ? 0 : 1;
      } else if (what < 0.65) {
        set_active(crowd, edits, ids[i], draw() < 0.5);
      } else if (what < 0.8) {
        EXPECT_TRUE(edits.remove(ids[i]));
        follow(crowd);
        ids.erase(ids.begin() + static_cast<ptrdiff_t>(i));
      }
    }
  }
};

TEST(CrowdObstacles, NoAvatarEntersOneWhileTheyAppearMoveAndDisappear) {
  uint64_t avatar_steps = 0, came_up = 0, moved = 0, waited = 0, walked = 0;
  for (const char* name : {"garage", "church", "stairs", "bridge"}) {
    const World world = test::bake(test::builtin({.name = name, .seed = 3}), 0.1);
    Edits edits;
    Crowd crowd = made(world, {.edits = edits});
    auto ids = scattered(crowd, 120);
    const auto thin = scattered(crowd, 20, {.radius = 0.15, .speed = 2});
    ids.insert(ids.end(), thin.begin(), thin.end());
    const auto children = scattered(crowd, 20, {.avatar_class = 1});
    ids.insert(ids.end(), children.begin(), children.end());
    Chaos chaos{crowd, edits, world, 11, {}};
    for (int step = 0; step < 120; ++step) {
      if (step % 40 == 0) {
        std::vector<Place> goals;
        for (size_t i = 0; i < ids.size(); ++i) {
          const int32_t of = i < 140 ? 0 : 1;
          goals.push_back(world.random_place(of, 5 + static_cast<uint64_t>(step), i));
        }
        crowd.set_goals(ids, goals);
      }
      chaos.act();
      const CrowdReport report = crowd.step();
      const CrowdCheck found = crowd.check();
      ASSERT_EQ(found.wall_entries, 0u) << name << ' ' << step;
      ASSERT_EQ(found.overlaps, 0u) << name << ' ' << step;
      ASSERT_EQ(found.obstacle_entries, 0u) << name << ' ' << step;
      avatar_steps += report.avatars;
      walked += report.avatars - report.stood;
      waited += report.waiting;
    }
    came_up += chaos.came_up;
    moved += chaos.moved;
  }
  EXPECT_EQ(avatar_steps, 4u * 160 * 120);
  EXPECT_GT(walked, avatar_steps / 4);
  EXPECT_GT(came_up, 100u);
  EXPECT_GT(moved, 200u);
  EXPECT_GT(waited, 50u);
}

TEST(CrowdObstacles, SameStateForAnyWorkersAndMachines) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  uint64_t first = 0;
  test::for_every_simd_target([&](const char* name) {
    for (const int32_t workers : {1, 2, 4}) {
      Edits edits;
      Crowd crowd = made(world, {.workers = workers, .edits = edits});
      const auto ids = scattered(crowd, 200);
      std::vector<Place> goals;
      for (size_t i = 0; i < ids.size(); ++i) goals.push_back(world.random_place(0, 5, i));
      crowd.set_goals(ids, goals);
      Chaos chaos{crowd, edits, world, 5, {}};
      for (int step = 0; step < 30; ++step) {
        chaos.act();
        crowd.step();
      }
      if (first == 0) first = crowd.state_hash();
      ASSERT_EQ(crowd.state_hash(), first) << name << ' ' << workers;
    }
  });
}

TEST(CrowdObstacles, ARestoredCrowdHasThemAsTheSavedOne) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const auto ids = scattered(crowd, 150);
  std::vector<Place> goals;
  for (size_t i = 0; i < ids.size(); ++i) goals.push_back(world.random_place(0, 5, i));
  crowd.set_goals(ids, goals);
  Chaos chaos{crowd, edits, world, 21, {}};
  uint64_t held_up = 0;
  for (int step = 0; step < 30 || (held_up == 0 && step < 300); ++step) {
    chaos.act();
    held_up = crowd.step().waiting;
  }
  EXPECT_GT(held_up, 0u);
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  Edits others;
  auto restored = Crowd::restore(world, {.workers = 3, .edits = others}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->obstacles().size(), crowd.obstacles().size());
  EXPECT_EQ(restored->save(), saved);
  Chaos other{*restored, others, world, 21, chaos.ids, chaos.n};
  for (int step = 0; step < 30; ++step) {
    chaos.act();
    other.act();
    const uint64_t waiting = crowd.step().waiting;
    ASSERT_EQ(restored->step().waiting, waiting);
    ASSERT_EQ(restored->state_hash(), crowd.state_hash()) << step;
    ASSERT_EQ(other.ids, chaos.ids);
  }
  EXPECT_TRUE(is_free(*restored));
}

// ---- With targets.

TargetId target_at(Crowd& crowd, const Vec3d& low, const Vec3d& high) {
  Context context;
  const Prism box = Prism::box(low, high);
  const auto target = crowd.add_target(std::span(&box, 1), context);
  EXPECT_TRUE(target) << target.error().message;
  return target ? *target : TargetId{};
}

TEST(CrowdObstacles, AvatarsThatHeadToATargetTakeTheOtherOpeningToo) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const TargetId target = target_at(crowd, {18, -1, 2}, {22, 2, 6});
  const auto ids = scattered(crowd, 40);
  crowd.set_targets(ids, target);
  for (int step = 0; step < 10; ++step) crowd.step();
  const AvatarId first = added(crowd, world.find_place(0, {1, 0, 23}, 0.5));
  const EditId door = put_up(crowd, edits, crate_at(kNearDoor));
  uint64_t arrived = 0;
  for (int step = 0; step < 900; ++step) {
    crowd.step();
    ASSERT_TRUE(is_free(crowd)) << step;
    ASSERT_TRUE(crowd.goal_unreachable().empty());
    arrived += crowd.arrived().size();
  }
  EXPECT_FALSE(waits(crowd, door));
  EXPECT_GT(arrived, 30u);
  if (!first) return;
  const double around = crowd.distance(first, target);
  set_active(crowd, edits, door, false);
  EXPECT_LT(crowd.distance(first, target), around + 1e-9);
  put_up(crowd, edits, crate_at(kFarDoor, 1));
  EXPECT_GT(crowd.distance(first, target), around);
}

TEST(CrowdObstacles, RestoredWithTargetsAndForAnyWorkersItIsTheSame) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  const Vec3d at = world.random_place(0, 3, 3).position;
  uint64_t first = 0;
  for (const int32_t workers : {1, 2, 4}) {
    Edits edits;
    Crowd crowd = made(world, {.workers = workers, .edits = edits});
    const auto ids = scattered(crowd, 150);
    const TargetId target =
        target_at(crowd, {at.x - 4, at.y - 1, at.z - 4}, {at.x + 4, at.y + 2, at.z + 4});
    put_up(crowd, edits, Prism::circle({at.x + 1, at.y, at.z}, 0.5, 1));
    put_up(crowd, edits, Prism::circle({at.x - 2, at.y, at.z}, 0.5, 1), ObstacleKind::kKinematic);
    crowd.set_targets(ids, target);
    Chaos chaos{crowd, edits, world, 33, {}};
    for (int step = 0; step < 20; ++step) {
      chaos.act();
      crowd.step();
    }
    Context context;
    Edits others;
    auto restored =
        Crowd::restore(world, {.workers = workers, .edits = others}, crowd.save(), context);
    ASSERT_TRUE(restored) << restored.error().message;
    Chaos other{*restored, others, world, 33, chaos.ids, chaos.n};
    for (int step = 0; step < 20; ++step) {
      // For a while without changes, then with.
      if (step >= 8) chaos.act();
      if (step >= 8) other.act();
      crowd.step();
      restored->step();
      ASSERT_EQ(restored->state_hash(), crowd.state_hash()) << workers << ' ' << step;
    }
    if (first == 0) first = crowd.state_hash();
    EXPECT_EQ(crowd.state_hash(), first) << workers;
    EXPECT_TRUE(is_free(crowd));
  }
}

TEST(CrowdObstacles, AClassThatCouldNotBeOpenedCanBeLater) {
  const World world = two_openings();
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  const EditId crate = put_up(crowd, edits, crate_at({6, 0, 6}));
  target_at(crowd, {18, -1, 2}, {22, 2, 6});
  Context cancelled;
  cancelled.cancel = true;
  EXPECT_FALSE(crowd.scatter(1, {}, cancelled));
  crowd.step();
  EXPECT_FALSE(added(crowd, world.find_place(0, {6, 0, 6}, 0.5)));
  const AvatarId id = added(crowd, world.find_place(0, {9, 0, 6}, 0.5));
  ASSERT_TRUE(id);
  EXPECT_TRUE(edits.remove(crate));
  EXPECT_TRUE(added(crowd, world.find_place(0, {6, 0, 6}, 0.5)));
}

TEST(CrowdObstacles, SavedNonsenseIsRefusedOrHarmless) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Edits edits;
  Crowd crowd = made(world, {.edits = edits});
  put_up(crowd, edits, crate_at({5, 0, 5}));
  const EditId cart =
      put_up(crowd, edits, Prism::circle({10, 0, 10}, 0.5, 1), ObstacleKind::kKinematic);
  const AvatarId id = added(crowd, world.find_place(0, {12, 0, 10}, 0.5));
  move(crowd, edits, cart, Prism::circle({12, 0, 10}, 0.5, 1));
  EXPECT_TRUE(edits.remove(put_up(crowd, edits, crate_at({15, 0, 5}))));
  crowd.remove(std::span(&id, 1));
  std::vector<uint8_t> saved = crowd.save();
  uint64_t accepted = 0, refused = 0;
  Context context;
  for (size_t bit = 0; bit < (saved.size() - 8) * 8; bit += bit % 3 + 1) {
    saved[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    const uint64_t sum = hash_bytes(saved.data(), saved.size() - 8);
    std::memcpy(saved.data() + saved.size() - 8, &sum, 8);
    auto restored = Crowd::restore(world, {}, saved, context);
    if (restored) {
      restored->step();
      ++accepted;
    } else {
      EXPECT_EQ(restored.error().code, Errc::kBadFile);
      ++refused;
    }
    saved[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
  }
  EXPECT_GT(accepted, 100u) << "a corner that moved a little";
  EXPECT_GT(refused, 100u);
}

}  // namespace
}  // namespace throng
