// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/mode/orientation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "worlds.h"

namespace throng {
namespace {

using crowd::Orientation;
using steer::Plane;

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kRate = 120;      // [degrees/s] that orientations turn by at most
constexpr double kBackRate = 240;  // and with 120 degrees and more to go

double max_rate(double apart) {
  return std::clamp(kRate * (1 + (std::fabs(apart) - 90) / 30), kRate, kBackRate);
}

// From one angle to another by the smaller of the two rotations. [degrees]
double between(double from, double to) { return std::remainder(to - from, 360); }
double degrees_of(Orientation o) { return 360 * o.turns(); }
double degrees_of(double x, double z) { return std::atan2(x, z) / kRadians; }
double degrees_of(const AvatarState& s) { return degrees_of(s.heading_x, s.heading_z); }

// One body, whose velocity is set.
struct OneBody {
  std::vector<Orientation> orientations = {Orientation::along({0, 1})};
  crowd::Body body;

  explicit OneBody(float speed = 1.34f) { body.speed = speed; }
  double turn(Plane velocity, float dt) {
    body.velocity = velocity;
    crowd::Turning(orientations, dt).turn(body, dt);
    return degrees_of(orientations[0]);
  }
};

// The lag by the C library, step by step.
TEST(Orientation, FollowsTheWalkWithALagAndABoundedRate) {
  uint64_t at_the_bound = 0, slow = 0, draws = 0;
  for (const float dt : {0.0005f, 0.02f, 0.1f}) {
    OneBody one;
    double before = 0;
    for (int step = 0; step < 3000; ++step) {
      if (step % 7 == 0) {
        const double angle = 2 * std::numbers::pi * random_unit(1, 1, draws);
        const double speed = 1.34 * random_unit(1, 2, draws++);
        one.body.velocity = {static_cast<float>(speed * std::sin(angle)),
                             static_cast<float>(speed * std::cos(angle))};
      }
      const Plane v = one.body.velocity;
      const double speed = std::hypot(v.x, v.z), part = std::min(1.0, speed * speed / 0.25);
      const double apart = between(before, degrees_of(v.x, v.z));
      const double now = one.turn(v, dt), change = between(before, now);
      before = now;
      if (std::fabs(apart) > 179.9) continue;  // either side is as near
      const double wanted = apart * (1 - std::exp(-dt * part / 0.43)),
                   most = max_rate(apart) * double{dt};
      ASSERT_NEAR(change, std::clamp(wanted, -most, most), 0.01 * std::fabs(wanted) + 0.001)
          << dt << ' ' << step;
      at_the_bound += std::fabs(wanted) > most ? 1 : 0;
      slow += speed < 0.2 ? 1 : 0;
    }
  }
  EXPECT_GT(at_the_bound, 500u);
  EXPECT_GT(slow, 500u);
}

TEST(Orientation, FacesTheWalkWithinASecondAtAnyStep) {
  for (const float dt : {0.001f, 0.01f, 0.05f, 0.1f, 0.25f, 0.5f, 1.0f}) {
    const auto steps = static_cast<int>(std::lround(1 / dt));
    for (const float speed : {0.2f, 1.34f, 5.0f}) {
      OneBody aside(speed), back(speed);
      double before_aside = 0, before_back = 0;
      for (int step = 0; step < 2 * steps; ++step) {
        const double now_aside = aside.turn({speed, 0}, dt);
        const double now_back = back.turn({0.001f * speed, -speed}, dt);
        EXPECT_LE(std::fabs(between(before_aside, now_aside)), kRate * double{dt} + 1e-4);
        EXPECT_LE(std::fabs(between(before_back, now_back)), kBackRate * double{dt} + 1e-4);
        before_aside = now_aside;
        before_back = now_back;
        if (step == steps - 1) {
          EXPECT_NEAR(now_aside, 90, 16) << dt << ' ' << speed;
        }
      }
      EXPECT_NEAR(std::fabs(between(0, before_back)), 180, 16) << dt << ' ' << speed;
    }
  }
}

TEST(Orientation, StaysWhileTheBodyStands) {
  OneBody one;
  one.turn({0.7f, 0.4f}, 0.1f);
  const uint32_t before = one.orientations[0].code;
  one.body.preferred = {-1, 0};
  for (int step = 0; step < 100; ++step) one.turn({}, 0.1f);
  EXPECT_EQ(one.orientations[0].code, before);
}

// From a stand to full speed within a third of a second, straight back.
TEST(Orientation, ABodyThatStartsTurnsToWhereItWantsToWalk) {
  for (const float dt : {0.01f, 0.05f, 0.1f}) {
    OneBody one;
    one.body.preferred = {0.01f, -1.34f};
    double off = 0;  // [s] more than 90 degrees
    for (float time = 0; time < 2; time += dt) {
      const float speed = std::min(1.34f, 4 * (time + dt));
      const double now = one.turn({0.0075f * speed, -speed}, dt);
      off += std::fabs(between(now, 180)) > 90 ? double{dt} : 0;
    }
    EXPECT_LT(off, 0.61) << dt;
    EXPECT_NEAR(std::fabs(between(0, degrees_of(one.orientations[0]))), 180, 8) << dt;
  }
}

TEST(Orientation, AShakenBodyKeepsIt) {
  struct Shake {
    Plane left, right;
    double seconds;  // of each move
  };
  const Shake shakes[] = {{{-1, 0}, {1, 0}, 0.1},
                          {{-0.6f, 0.8f}, {0.6f, 0.8f}, 0.4},
                          {{-0.15f, 0}, {0.15f, 0}, 1},
                          {{-0.05f, -0.05f}, {0.05f, -0.05f}, 2}};
  for (const Shake& shake : shakes) {
    for (const float dt : {0.02f, 0.1f}) {
      OneBody one;
      const auto steps = static_cast<int>(std::lround(shake.seconds / double{dt}));
      for (int step = 0; step < 10 * steps; ++step) {
        const double now = one.turn(step / steps % 2 == 0 ? shake.right : shake.left, dt);
        ASSERT_LT(std::fabs(between(0, now)), 30) << shake.seconds << ' ' << step;
      }
    }
  }
}

TEST(Orientation, ANewBodyFacesItsPreferredVelocityOrElseItsMove) {
  OneBody one;
  one.orientations[0] = {};
  EXPECT_EQ(one.orientations[0].x(), 0);
  EXPECT_NEAR(one.orientations[0].z(), 1, 1e-12);
  one.turn({}, 0.1f);
  EXPECT_FALSE(one.orientations[0].exists());
  one.body.preferred = {1, 0};
  one.turn({0, -1}, 0.1f);
  EXPECT_EQ(one.orientations[0].turns(), 0.25);
  one.orientations[0] = {};
  one.body.preferred = {};
  one.turn({0, -1}, 0.1f);
  EXPECT_EQ(one.orientations[0].turns(), 0.5);
}

// From the floor up a wall, onto the ceiling, and straight on.
TEST(Orientation, ABodyWhoseAxisTurnsFacesTheSameDirectionOnIt) {
  const Vec3d floor{0, 1, 0}, wall{-1, 0, 0}, ceiling{0, -1, 0};
  const auto facing = [](Orientation o, const Vec3d& up) { return leaned({o.x(), 0, o.z()}, up); };
  const auto expect_near = [](const Vec3d& a, const Vec3d& b) {
    EXPECT_NEAR(length(a - b), 0, 1e-4) << a.x << ' ' << a.y << ' ' << a.z;
  };
  const Orientation up = transported(Orientation::along({1, 0}), floor, wall);
  expect_near(facing(up, wall), {0, 1, 0});
  expect_near(facing(transported(up, wall, ceiling), ceiling), {-1, 0, 0});
  // Along the edge between two of them nothing changes.
  const Orientation along = transported(Orientation::along({0, 1}), floor, wall);
  expect_near(facing(along, wall), {0, 0, 1});
  expect_near(facing(transported(along, wall, ceiling), ceiling), {0, 0, 1});
  // In small steps around the straight-down axis, where the angle before the lean turns fast.
  Orientation now = Orientation::along({0.6f, 0.8f});
  Vec3d axis{0.02, -1, 0};
  axis = axis * (1 / length(axis));
  for (int step = 1; step <= 60; ++step) {
    const double angle = 2 * std::numbers::pi * step / 60;
    Vec3d next{0.02 * std::cos(angle), -1, 0.02 * std::sin(angle)};
    next = next * (1 / length(next));
    const Vec3d before = facing(now, axis);
    now = transported(now, axis, next);
    EXPECT_LT(length(facing(now, next) - before), 0.01) << step;
    axis = next;
  }
}

TEST(Orientation, AnAvatarTurnsWithinASecondAndKeepsItWhileItStands) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Crowd crowd = made(world, {.dt = 0.05});
  const AvatarId id = added(crowd, world.find_place(0, {5, 0, 5}, 0.5));
  EXPECT_NEAR(crowd.read(id)->heading_z, 1, 1e-12);
  const auto walk = [&](Vec3d velocity, int steps) {
    crowd.set_velocities({&id, 1}, {&velocity, 1});
    crowd.step();
    AvatarState before = *crowd.read(id);
    for (int step = 1; step < steps; ++step) {
      crowd.step();
      const AvatarState now = *crowd.read(id);
      EXPECT_LE(std::fabs(between(degrees_of(before), degrees_of(now))), kRate * 0.05 + 1e-3);
      before = now;
    }
    return before;
  };
  EXPECT_GT(walk({1, 0, 0}, 20).heading_x, 0.999);
  EXPECT_GT(walk({0, 0, 1}, 20).heading_z, std::cos(16 * kRadians));
  const AvatarState turned = walk({0, 0, 1}, 40);
  EXPECT_GT(turned.heading_z, 0.999);
  EXPECT_GT(turned.velocity.z, 0.99);
  const AvatarState stands = walk({0, 0, 0}, 40);
  EXPECT_EQ(stands.velocity, (Vec3d{}));
  EXPECT_EQ(stands.heading_x, turned.heading_x);
  EXPECT_EQ(stands.heading_z, turned.heading_z);
}

// Two corridors, which meet at a right angle.
TEST(Orientation, AWalkerTurnsAroundACornerAtABoundedRate) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {20, 0, 20});
  scene.add_box({0, 0, 3}, {17, 3, 20});
  const World world = test::bake(scene, 0.1);
  Crowd crowd = made(world);
  const AvatarId id = added(crowd, world.find_place(0, {1, 0, 1.5}, 0.5));
  const Place goal = world.find_place(0, {18.5, 0, 19}, 0.5);
  ASSERT_TRUE(id && goal);
  crowd.set_goals({&id, 1}, {&goal, 1});
  crowd.step();
  AvatarState before = *crowd.read(id);
  const double at_first = degrees_of(before);
  EXPECT_NEAR(at_first, 90, 10);
  double late = 0, latest = 0;  // [s] for which it has faced elsewhere
  for (int step = 0; step < 400 && crowd.arrived().empty(); ++step) {
    crowd.step();
    const AvatarState now = *crowd.read(id);
    EXPECT_LE(std::fabs(between(degrees_of(before), degrees_of(now))), 0.1 * kRate + 1e-3);
    const Vec3d move = now.position - before.position;
    const bool walks = std::hypot(move.x, move.z) > 0.05;
    const bool is_late =
        walks && std::fabs(between(degrees_of(now), degrees_of(move.x, move.z))) > 16;
    late = is_late ? late + 0.1 : 0;
    latest = std::max(latest, late);
    before = now;
  }
  EXPECT_FALSE(crowd.arrived().empty());
  EXPECT_LE(latest, 1.05);
  EXPECT_GT(latest, 0.15);  // It does not turn at once.
  EXPECT_NEAR(degrees_of(before), 0, 10);
}

std::vector<AvatarState> all_of(const Crowd& crowd) {
  std::vector<AvatarState> all;
  crowd.read(all);
  return all;
}

void expect_same_orientations(const Crowd& a, const Crowd& b) {
  const std::vector<AvatarState> of_a = all_of(a), of_b = all_of(b);
  ASSERT_EQ(of_a.size(), of_b.size());
  for (size_t i = 0; i < of_a.size(); ++i) {
    ASSERT_EQ(of_a[i].heading_x, of_b[i].heading_x) << i;
    ASSERT_EQ(of_a[i].heading_z, of_b[i].heading_z) << i;
  }
}

TEST(Orientation, IsTheSameForAnyWorkersAndInARestoredCrowd) {
  const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  const auto walking = [&](int32_t workers) {
    Crowd crowd = made(world, {.workers = workers});
    const auto ids = scattered(crowd, 300);
    std::vector<Place> goals;
    for (size_t i = 0; i < ids.size(); ++i) goals.push_back(world.random_place(0, 5, i));
    crowd.set_goals(ids, goals);
    for (int step = 0; step < 40; ++step) crowd.step();
    return crowd;
  };
  Crowd crowd = walking(1);
  expect_same_orientations(crowd, walking(3));
  uint64_t differ = 0;  // from the direction of the move
  for (const AvatarState& s : all_of(crowd)) {
    const double size = std::hypot(s.velocity.x, s.velocity.z);
    const double angle = between(degrees_of(s), degrees_of(s.velocity.x, s.velocity.z));
    differ += size > 0 && std::fabs(angle) > 1 ? 1 : 0;
  }
  EXPECT_GT(differ, 10u);
  Context context;
  auto restored = Crowd::restore(world, {.workers = 2}, crowd.save(), context);
  ASSERT_TRUE(restored) << restored.error().message;
  expect_same_orientations(crowd, *restored);
  for (int step = 0; step < 20; ++step) {
    crowd.step();
    restored->step();
  }
  expect_same_orientations(crowd, *restored);
}

TEST(Orientation, AnAvatarWithTheSlotOfAnotherBeginsWithoutOne) {
  const World world = test::bake(worlds::flat(20), 0.1);
  Crowd crowd = made(world);
  const AvatarId first = added(crowd, world.find_place(0, {5, 0, 5}, 0.5));
  const Vec3d velocity{0, 0, -1};
  crowd.set_velocities({&first, 1}, {&velocity, 1});
  for (int step = 0; step < 3; ++step) crowd.step();
  EXPECT_LT(crowd.read(first)->heading_z, -0.99);
  crowd.remove({&first, 1});
  const AvatarId second = added(crowd, world.find_place(0, {8, 0, 8}, 0.5));
  ASSERT_EQ(second.slot1, first.slot1);
  EXPECT_NEAR(crowd.read(second)->heading_z, 1, 1e-12);
  const Vec3d other{1, 0, 0};
  crowd.set_velocities({&second, 1}, {&other, 1});
  crowd.step();
  EXPECT_NEAR(crowd.read(second)->heading_x, 1, 1e-9);
}

}  // namespace
}  // namespace throng
