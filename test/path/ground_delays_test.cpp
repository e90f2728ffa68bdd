// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/ground_delays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "baked.h"
#include "core/random.h"
#include "path/edits/ground_finder.h"

// Lengths times delays. The oracle adds up small parts of a segment.
namespace throng::path {
namespace {

using world::GroundPoint;

constexpr int64_t kTileUnits = int64_t{kTileCells} << world::kUnitBits;

GroundDelays random_delays(uint64_t seed) {
  GroundDelays delays(1);
  for (size_t bin = 0; bin < GroundDelays::kBins; ++bin) {
    delays.shares(0)[bin] = static_cast<uint16_t>(random_below(seed, 1, bin, 65536));
  }
  delays.set_slow(0, 1);
  return delays;
}

TEST(GroundDelays, LengthIsTheSumOverSmallParts) {
  const GroundDelays delays = random_delays(1);
  for (uint64_t n = 0; n < 200; ++n) {
    const auto at = [&](uint64_t k) {
      return static_cast<int64_t>(random_below(2, n, k, kTileUnits));
    };
    const GroundPoint from{at(0), at(1)}, to{at(2), at(3)};
    const auto heading = GroundDelays::heading(from, to);
    constexpr int kParts = 20000;
    double sum = 0;
    for (int i = 0; i < kParts; ++i) {
      const double t = (i + 0.5) / kParts;
      const GroundPoint middle{from.x + std::llround(t * static_cast<double>(to.x - from.x)),
                               from.z + std::llround(t * static_cast<double>(to.z - from.z))};
      sum += delays.factor(0, middle.cell_x(), middle.cell_z(), heading) / kParts;
    }
    const double length = std::hypot(to.x - from.x, to.z - from.z) / world::kUnitsPerCell;
    EXPECT_NEAR(delays.length(0, from, to), sum * length, 1e-2 * sum * length) << n;
  }
}

TEST(GroundDelays, FreeGroundKeepsItsLength) {
  GroundDelays delays(2);
  const GroundPoint from{100, 200}, to{50000, 90000};
  const double length = std::hypot(49900, 89800) / world::kUnitsPerCell;
  EXPECT_DOUBLE_EQ(delays.length(1, from, to), length);
  delays.set_slow(1, 1);
  EXPECT_DOUBLE_EQ(delays.length(1, from, to), length);
}

// One square in which avatars that head along X stand.
TEST(GroundDelays, CountsWholeAlongAJamHardlyAgainstItAndNoZigzagPays) {
  GroundDelays delays(1);
  delays.shares(0)[0] = 0;
  delays.set_slow(0, 1);
  const double along = delays.factor(0, 3, 3, GroundDelays::heading({0, 0}, {1000, 0}));
  EXPECT_EQ(along, GroundDelays::kMaxFactor);
  EXPECT_LT(delays.factor(0, 3, 3, GroundDelays::heading({1000, 0}, {0, 0})),
            GroundDelays::kMaxFactor / 40);
  EXPECT_EQ(delays.factor(0, 16, 3, GroundDelays::heading({0, 0}, {1000, 0})), 1);
  for (int degrees = 1; degrees < 90; ++degrees) {
    const double angle = degrees * M_PI / 180;
    const GroundPoint to{std::llround(1e6 * std::cos(angle)), std::llround(1e6 * std::sin(angle))};
    const double factor = delays.factor(0, 3, 3, GroundDelays::heading({0, 0}, to));
    EXPECT_GE(factor / std::cos(angle), along * (1 - 1e-6)) << degrees;
  }
}

// Two doors in a wall across X, at z = 2 and z = 8.
Scene two_doors() {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({4.9, 0, 0}, {5.1, 3, 1.5});
  scene.add_box({4.9, 0, 2.5}, {5.1, 3, 7.5});
  scene.add_box({4.9, 0, 8.5}, {5.1, 3, 10});
  return scene;
}

double z_at_wall(const Path& path) {
  for (size_t i = 1; i < path.points.size(); ++i) {
    const Vec3d &a = path.points[i - 1].position, &b = path.points[i].position;
    if (a.x <= 5 && b.x > 5) return a.z + (b.z - a.z) * (5 - a.x) / (b.x - a.x);
  }
  return std::nan("");
}

TEST(GroundDelays, ASearchTakesTheOtherDoorWhereOneIsJammed) {
  const World world = test::bake(two_doors(), 0.1, {AvatarClass{}});
  auto finder = GroundFinder::create(world, {});
  ASSERT_TRUE(finder) << finder.error().message;
  const Place from = world.find_place(0, {3, 0, 2}, 0.5), to = world.find_place(0, {8, 0, 2}, 0.5);
  ASSERT_TRUE(from && to);
  GroundDelays delays(size_t{from.level1} + 64);  // more than the world's
  Path path;
  const GroundFinder::DelayedSearch free{.delays = &delays, .max_cost = 6, .budget = {}};
  ASSERT_TRUE(finder->find_by_delays(from, to, free, path));
  EXPECT_NEAR(path.length, 5, 0.05);
  EXPECT_NEAR(path.cost, 5, 0.05);
  EXPECT_NEAR(z_at_wall(path), 2, 0.5);
  // The squares of the first door, 1.6 m wide, where all that head along X stand.
  const Vec3d& origin = world.summary().origin;
  const auto cell = [](double at) { return static_cast<int32_t>(at / 0.1) % kTileCells; };
  for (const double z : {1.501, 2.499}) {
    delays.shares(from.level1 -
                  1)[GroundDelays::first_bin(cell(4.95 - origin.x), cell(z - origin.z))] = 0;
  }
  delays.set_slow(from.level1 - 1, 1);
  const double straight = 5 + 1.6 * (GroundDelays::kMaxFactor - 1);
  EXPECT_NEAR(finder->delayed_length(from, to, delays), straight, 0.1);
  ASSERT_TRUE(finder->find_by_delays(
      from, to, {.delays = &delays, .max_cost = straight, .budget = {}}, path));
  EXPECT_NEAR(z_at_wall(path), 8, 0.5);
  EXPECT_LT(path.cost, 20);
  EXPECT_GE(path.cost, path.length - 1e-6);
  // Not if it may not cost so much, nor within too few points.
  EXPECT_FALSE(finder->find_by_delays(
      from, to, {.delays = &delays, .max_cost = path.length - 1, .budget = {}}, path));
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_FALSE(finder->find_by_delays(
      from, to, {.delays = &delays, .max_cost = straight, .budget = 2}, path));
  EXPECT_EQ(path.spent, SpentBudget::kNodes);
  // Other searches know nothing of it.
  finder->find(from, to, path);
  EXPECT_NEAR(path.length, 5, 0.05);
}

}  // namespace
}  // namespace throng::path
