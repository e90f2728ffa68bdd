// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "baked.h"
#include "core/access.h"
#include "crowds.h"
#include "throng/avatar.h"
#include "throng/crowd.h"
#include "world/zone_data.h"
#include "worlds.h"

namespace throng {
namespace {

constexpr double kRadius = 1.5;  // [m] of the circles in which carts turn

std::vector<AvatarClass> carts() {
  return {{.name = "cart", .radius = 0.3, .turning_radius = kRadius}, {.name = "adult"}};
}

// The turn from one move to the next, if both are long enough to have a direction. [radians]
double turn_between(const Vec3d& a, const Vec3d& b) {
  if (std::hypot(a.x, a.z) < 0.03 || std::hypot(b.x, b.z) < 0.03) return 0;
  return std::fabs(std::atan2(a.x * b.z - a.z * b.x, a.x * b.x + a.z * b.z));
}

TEST(CrowdTurningRadius, ACartTurnsAlongACircleAndOtherClassesAtOnce) {
  const World world = test::bake(worlds::flat(20), 0.1, carts());
  for (const double dt : {0.005, 0.02, 0.1}) {
    for (const bool is_cart : {true, false}) {
      Crowd crowd = made(world, {.dt = dt});
      const int32_t number = is_cart ? 0 : 1;
      const AvatarId id =
          added(crowd, world.find_place(number, {5, 0, 5}, 0.5), {.avatar_class = number});
      ASSERT_TRUE(id);
      const auto walk = [&](const Vec3d& velocity, double seconds) {
        crowd.set_velocities({&id, 1}, {&velocity, 1});
        std::vector<Vec3d> velocities;
        for (double time = 0; time < seconds; time += dt) {
          crowd.step();
          velocities.push_back(crowd.read(id)->velocity);
        }
        return velocities;
      };
      const Vec3d ahead{1, 0, 0}, aside{std::sqrt(0.5), 0, std::sqrt(0.5)};
      EXPECT_NEAR(walk(ahead, 1).back().x, 1, 0.01);
      const std::vector<Vec3d> turning = walk(aside, 4);
      // Whole units: of 1024 in a step of 0.05 s.
      const double rounded = 1e-4 / dt;
      EXPECT_NEAR(turning.back().x, aside.x, 0.01 + rounded) << dt;
      EXPECT_NEAR(turning.back().z, aside.z, 0.01 + rounded) << dt;
      const double first = std::atan2(turning[0].z, turning[0].x);
      if (!is_cart) {
        EXPECT_NEAR(first, std::atan2(1, 1), 0.01 + rounded) << dt;
        continue;
      }
      EXPECT_LE(std::fabs(first), dt / kRadius + 2 * rounded) << dt;
      // An eighth of a circle of 1.5 m is 1.2 m long.
      const auto after = static_cast<size_t>(0.8 / dt);
      EXPECT_LT(std::atan2(turning[after].z, turning[after].x), 0.95 * std::atan2(1, 1)) << dt;
      // The opposite direction: it stops first.
      const std::vector<Vec3d> back = walk({-aside.x, 0, -aside.z}, 0.5);
      EXPECT_EQ(back[0], (Vec3d{}));
      EXPECT_NEAR(back.back().x, -aside.x, 0.01 + rounded) << dt;
    }
  }
}

TEST(CrowdTurningRadius, CartsArriveAmongEachOther) {
  const World world = test::bake(worlds::flat(30), 0.1, carts());
  Crowd crowd = made(world);
  const auto ids = scattered(crowd, 30);
  std::vector<Place> goals;
  for (size_t i = 0; i < ids.size(); ++i) goals.push_back(world.random_place(0, 3, i));
  crowd.set_goals(ids, goals);
  std::vector<AvatarState> before, now;
  std::vector<Vec3d> moves(ids.size());
  crowd.read(before);
  std::set<uint32_t> arrived;
  double sharpest = 0;
  for (int step = 0; step < 600; ++step) {
    crowd.step();
    for (const AvatarId id : crowd.arrived()) arrived.insert(id.slot1);
    crowd.read(now);
    for (size_t i = 0; i < now.size(); ++i) {
      const Vec3d move = now[i].position - before[i].position;
      sharpest = std::max(sharpest, turn_between(moves[i], move));
      moves[i] = move;
    }
    std::swap(before, now);
    const CrowdCheck found = crowd.check();
    ASSERT_EQ(found.overlaps + found.wall_entries, 0u) << step;
  }
  EXPECT_LE(sharpest, 1.34 * 0.1 / kRadius + 0.01);
  EXPECT_GT(sharpest, 0.05);
  EXPECT_GE(arrived.size(), ids.size() * 8 / 10);
}

TEST(CrowdTurningRadius, AManifestStoresItOnlyIfThereIsOne) {
  const auto manifest_of = [](const std::vector<AvatarClass>& classes) {
    return world::write_manifest(*data_of(test::bake(worlds::flat(5), 0.1, classes)));
  };
  const std::vector<uint8_t> stored = manifest_of(carts());
  const auto read = world::read_manifest(stored, "m.thm");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ((*read)->summary.classes[0].turning_radius, kRadius);
  EXPECT_EQ((*read)->summary.classes[1].turning_radius, 0);
  std::vector<AvatarClass> free = carts();
  free[0].turning_radius = 0;
  EXPECT_LT(manifest_of(free).size(), stored.size());
}

}  // namespace
}  // namespace throng
