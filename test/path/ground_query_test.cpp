// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <queue>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/world.h"
#include "worlds.h"

// Queries around a place, against brute force over all cells.
namespace throng {
namespace {

using test::bake;

GroundQuery query(const World& world, int32_t avatar_class = 0) {
  auto made = GroundQuery::create(world, avatar_class);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

double real(uint64_t seed, uint64_t n, uint64_t counter, double low, double high) {
  return low +
         (high - low) * static_cast<double>(random_below(seed, n, counter, 1 << 20)) / (1 << 20);
}

std::vector<World> some_worlds() {
  return {bake(worlds::two_floors(), 0.1), bake(worlds::doorway(0.9), 0.1),
          bake(worlds::ramp(20, 4), 0.1), bake(test::builtin({.name = "garage"}), 0.2),
          bake(worlds::random_soup(7, 400, 12), 0.15)};
}

// The nearest place by testing every cell of the world.
double nearest_of_all(const World& world, int32_t avatar_class, Vec3d position) {
  const WorldSummary summary = world.summary();
  const double unit = summary.cell / 2048;
  double best = std::numeric_limits<double>::infinity();
  for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
    const LevelTileContent tile = world.level_tile(l);
    for (int32_t c = 0; c < kTileCells * kTileCells; ++c) {
      if (tile.clearance[static_cast<size_t>(avatar_class)][static_cast<size_t>(c)] == 0) continue;
      const double x0 =
          summary.origin.x + (tile.tile_x * kTileCells + c % kTileCells) * summary.cell;
      const double z0 =
          summary.origin.z + (tile.tile_z * kTileCells + c / kTileCells) * summary.cell;
      Place place;
      place.level1 = l + 1;
      place.position = {std::clamp(position.x, x0 + unit / 2, x0 + summary.cell - unit / 2), 0,
                        std::clamp(position.z, z0 + unit / 2, z0 + summary.cell - unit / 2)};
      place.position.y = world.feet(place);
      best = std::min(best, length(place.position - position));
    }
  }
  return best;
}

TEST(GroundQuery, FindsTheNearestPlaceOfAll) {
  uint64_t tested = 0;
  for (const World& world : some_worlds()) {
    const Box3d box = world.summary().bounds;
    for (int32_t c = 0; c < static_cast<int32_t>(world.summary().classes.size()); ++c) {
      GroundQuery ask = query(world, c);
      for (uint64_t n = 0; n < 12; ++n) {
        const Vec3d at{real(3, n, 0, box.min.x - 3, box.max.x + 3),
                       real(3, n, 1, box.min.y - 1, box.max.y + 1),
                       real(3, n, 2, box.min.z - 3, box.max.z + 3)};
        const double nearest = nearest_of_all(world, c, at);
        const Place found = ask.nearest_place(at, 1000);
        if (!std::isfinite(nearest)) {
          EXPECT_FALSE(found);
          continue;
        }
        ASSERT_TRUE(found);
        EXPECT_NEAR(length(found.position - at), nearest, world.summary().cell / 1000);
        EXPECT_FALSE(ask.nearest_place(at, nearest * 0.99));
        const Place again = world.find_place(c, found.position, 0.001);
        EXPECT_EQ(again.level1, found.level1);
        ++tested;
      }
    }
  }
  EXPECT_GT(tested, 150u);
}

// How far a straight move leads, by trying longer and longer ones. [0 to 1]
double farthest(const World& world, int32_t avatar_class, const Place& from, double dx, double dz,
                int32_t parts) {
  int32_t n = 0;
  while (n < parts &&
         world.move(avatar_class, from, dx * (n + 1) / parts, dz * (n + 1) / parts).end ==
             MoveEnd::kArrived) {
    ++n;
  }
  return static_cast<double>(n) / parts;
}

TEST(GroundQuery, RaysEndWhereMovesEnd) {
  uint64_t stopped = 0;
  for (const World& world : some_worlds()) {
    const double cell = world.summary().cell;
    GroundQuery ask = query(world);
    for (uint64_t n = 0; n < 150; ++n) {
      const Place from = world.random_place(0, 5, n);
      const double dx = real(5, n, 3, -4, 4), dz = real(5, n, 4, -4, 4);
      const GroundRay ray = ask.ray(from, dx, dz);
      const bool arrives = world.move(0, from, dx, dz).end == MoveEnd::kArrived;
      ASSERT_EQ(ray.arrived, arrives);
      const Vec3d moved = ray.place.position - from.position;
      const MoveResult move = world.move(0, from, moved.x, moved.z);
      ASSERT_EQ(move.end, MoveEnd::kArrived);
      EXPECT_EQ(move.place.level1, ray.place.level1);
      EXPECT_EQ(ray.blocked_by == Blocker::kNone, arrives);
      if (arrives) continue;
      ++stopped;
      const double whole = std::hypot(dx, dz);
      const double t = farthest(world, 0, from, dx, dz, static_cast<int32_t>(whole / cell * 64));
      EXPECT_NEAR(std::hypot(moved.x, moved.z), t * whole, cell / 16) << n;
      EXPECT_NEAR(std::hypot(ray.normal_x, ray.normal_z), 1, 1e-12);
      EXPECT_LT(ray.normal_x * dx + ray.normal_z * dz, 0);
    }
  }
  EXPECT_GT(stopped, 200u);
}

TEST(GroundQuery, NearestWallIsTheShortestOfAllRays) {
  uint64_t found = 0;
  for (const World& world : some_worlds()) {
    const double cell = world.summary().cell;
    GroundQuery ask = query(world);
    for (uint64_t n = 0; n < 25; ++n) {
      const Place from = world.random_place(0, 9, n);
      const NearestWall wall = ask.nearest_wall(from, 1.5);
      double shortest = 1.5;
      constexpr int32_t kRays = 360;
      for (int32_t r = 0; r < kRays; ++r) {
        const double angle = r * 2 * 3.14159265358979 / kRays;
        const GroundRay ray = ask.ray(from, 1.5 * std::cos(angle), 1.5 * std::sin(angle));
        const Vec3d moved = ray.place.position - from.position;
        if (!ray.arrived) shortest = std::min(shortest, std::hypot(moved.x, moved.z));
      }
      EXPECT_LE(wall.found ? wall.distance : 1.5, shortest + cell / 500);
      if (!wall.found) continue;
      ++found;
      // Rays are a degree apart, and end up to a unit before the wall.
      EXPECT_GE(wall.distance, shortest * 0.98 - cell / 16) << n;
      EXPECT_NEAR(std::hypot(wall.x - from.position.x, wall.z - from.position.z), wall.distance,
                  cell / 1000);
      EXPECT_NEAR(std::hypot(wall.normal_x, wall.normal_z), 1, 1e-9);
      // A body may stand up to the wall, not a cell further.
      const double inside = wall.distance - cell / 1000;
      if (inside > 0) {
        EXPECT_EQ(world.move(0, from, -wall.normal_x * inside, -wall.normal_z * inside).end,
                  MoveEnd::kArrived);
      }
      const double beyond = wall.distance + cell;
      EXPECT_EQ(world.move(0, from, -wall.normal_x * beyond, -wall.normal_z * beyond).end,
                MoveEnd::kBlocked);
    }
  }
  EXPECT_GT(found, 50u);
}

// Cells of a world that steps of one cell join to a place, inside a circle: over World::move.
std::set<std::tuple<uint32_t, int32_t, int32_t>> cells_near(const World& world, const Place& from,
                                                            double x, double z, double radius) {
  const WorldSummary summary = world.summary();
  const auto cell_of = [&](const Place& p) {
    return std::tuple(
        p.level1,
        static_cast<int32_t>(std::floor((p.position.x - summary.origin.x) / summary.cell)),
        static_cast<int32_t>(std::floor((p.position.z - summary.origin.z) / summary.cell)));
  };
  const auto middle = [&](int32_t cell, double origin) {
    return origin + (cell + 0.5) * summary.cell;
  };
  const auto inside = [&](int32_t cx, int32_t cz) {
    const double half = summary.cell / 2;
    const double dx = std::max(std::fabs(middle(cx, summary.origin.x) - x) - half, 0.0);
    const double dz = std::max(std::fabs(middle(cz, summary.origin.z) - z) - half, 0.0);
    return std::hypot(dx, dz) <= radius;
  };
  std::set<std::tuple<uint32_t, int32_t, int32_t>> seen;
  std::queue<Place> queue;
  Place start = from;
  const auto [level, sx, sz] = cell_of(from);
  start.position.x = middle(sx, summary.origin.x);
  start.position.z = middle(sz, summary.origin.z);
  queue.push(start);
  seen.insert(cell_of(start));
  while (!queue.empty()) {
    const Place at = queue.front();
    queue.pop();
    for (const auto& d : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
      const MoveResult move = world.move(0, at, d.first * summary.cell, d.second * summary.cell);
      if (move.end != MoveEnd::kArrived) continue;
      const auto cell = cell_of(move.place);
      if (!inside(std::get<1>(cell), std::get<2>(cell)) || !seen.insert(cell).second) continue;
      queue.push(move.place);
    }
  }
  return seen;
}

TEST(GroundQuery, SlidesToTheNearestPlaceToTheEnd) {
  uint64_t slid = 0;
  for (const World& world : some_worlds()) {
    const WorldSummary summary = world.summary();
    GroundQuery ask = query(world);
    for (uint64_t n = 0; n < 60; ++n) {
      const Place from = world.random_place(0, 11, n);
      const double dx = real(11, n, 3, -1, 1), dz = real(11, n, 4, -1, 1);
      const Place to = ask.slide(from, dx, dz);
      const double goal_x = from.position.x + dx, goal_z = from.position.z + dz;
      if (world.move(0, from, dx, dz).end == MoveEnd::kArrived) {
        EXPECT_NEAR(to.position.x, goal_x, 1e-9);
        continue;
      }
      ++slid;
      double best = std::hypot(dx, dz);
      for (const auto& [level, x, z] :
           cells_near(world, from, from.position.x + dx / 2, from.position.z + dz / 2,
                      std::hypot(dx, dz) / 2 + summary.cell)) {
        const double x0 = summary.origin.x + x * summary.cell;
        const double z0 = summary.origin.z + z * summary.cell;
        best = std::min(best, std::hypot(std::clamp(goal_x, x0, x0 + summary.cell) - goal_x,
                                         std::clamp(goal_z, z0, z0 + summary.cell) - goal_z));
      }
      EXPECT_NEAR(std::hypot(to.position.x - goal_x, to.position.z - goal_z), best,
                  summary.cell / 200)
          << n;
      EXPECT_EQ(world.find_place(0, to.position, 0.001).level1, to.level1);
    }
  }
  EXPECT_GT(slid, 60u);
}

TEST(GroundQuery, RandomPlacesAreNearAndEvenlyDistributed) {
  const World world = bake(worlds::doorway(0.2), 0.1);  // too narrow for an adult: two rooms
  GroundQuery ask = query(world);
  const Place centre = world.find_place(0, {3.4, 0, 3}, 0.5);
  ASSERT_TRUE(centre);
  std::vector<int> quarter(4, 0);
  constexpr int kDraws = 4000;
  for (uint64_t n = 0; n < kDraws; ++n) {
    const Place p = ask.random_place_near(centre, 2, 21, n);
    ASSERT_TRUE(p);
    EXPECT_LE(std::hypot(p.position.x - centre.position.x, p.position.z - centre.position.z),
              2 + 1e-4);
    EXPECT_LT(p.position.x, 4);  // never through the wall
    EXPECT_EQ(world.find_place(0, p.position, 0.001).level1, p.level1);
    quarter[(p.position.z < 3 ? 0u : 1u) + (p.position.x < centre.position.x - 0.8 ? 0u : 2u)]++;
  }
  // Half above, half below; on each side of the line as much as the circle's area there.
  EXPECT_NEAR(quarter[0] + quarter[2], kDraws / 2, 4 * std::sqrt(kDraws / 4.0));
  const double left = quarter[0] + quarter[1];
  // Circle of radius 2: area left of x = -0.8 is 4 acos(0.4) - 0.8 sqrt(4 - 0.64).
  const double area_left = 4 * std::acos(0.4) - 0.8 * std::sqrt(4 - 0.64);
  const double area = ask.area_near(centre, 2);
  EXPECT_NEAR(left / kDraws, area_left / area, 0.03);
  EXPECT_FALSE(ask.random_place_near({}, 2, 21, 0));
}

TEST(GroundQuery, SaysWhatBlocks) {
  const auto toward = [](const World& world, Vec3d at, double dx, double dz,
                         int32_t avatar_class = 0) {
    const Place from = world.find_place(avatar_class, at, 0.5);
    EXPECT_TRUE(from);
    return query(world, avatar_class).ray(from, dx, dz).blocked_by;
  };
  EXPECT_EQ(toward(bake(worlds::low_ceiling(1.5), 0.1), {2, 0, 2}, 4, 0), Blocker::kLow);
  EXPECT_EQ(toward(bake(worlds::doorway(0.2), 0.1), {2, 0, 3}, 4, 0), Blocker::kNarrow);
  // Of a slope that no class of a world climbs, the world knows no more than its first cell.
  EXPECT_EQ(toward(bake(worlds::ramp(50, 2), 0.1), {1, 0, 1.5}, 4, 0), Blocker::kSteep);
  const std::vector<AvatarClass> classes = {{.name = "adult"},
                                            {.name = "climber", .max_slope = 70},
                                            {.name = "wheelchair",
                                             .height = 1.35,
                                             .radius = 0.4,
                                             .step_height = 0.02,
                                             .max_slope = 3.44}};
  const World ramp = bake(worlds::ramp(30, 2), 0.1, classes);
  EXPECT_EQ(toward(ramp, {1, 0, 1.5}, 4, 0, 2), Blocker::kSteep);
  EXPECT_EQ(toward(ramp, {6, 1.155, 1.5}, -4, 0, 2), Blocker::kSteep);
  EXPECT_EQ(toward(ramp, {1, 0, 1.5}, 4, 0), Blocker::kNone);
  EXPECT_EQ(toward(bake(worlds::ramp(60, 2), 0.1, classes), {1, 0, 1.5}, 4, 0), Blocker::kSteep);
  EXPECT_EQ(toward(bake(worlds::flat(6), 0.1), {3, 0, 3}, 10, 0), Blocker::kGap);
  EXPECT_EQ(toward(bake(worlds::steps(0.5, 1.5, 3), 0.1), {1, 0, 1.5}, 4, 0), Blocker::kStep);
  EXPECT_EQ(toward(bake(worlds::two_floors(), 0.1), {9, 3, 4}, -4, 0), Blocker::kGap);
  EXPECT_EQ(toward(bake(worlds::doorway(0.9), 0.1), {2, 0, 1}, 4, 0), Blocker::kNarrow);
  EXPECT_EQ(toward(bake(worlds::doorway(0.9), 0.1), {2, 0, 3}, 4, 0), Blocker::kNone);
  // A block is a step or a wall from below, however high it is, and a step or a gap from above. (It
  // is hollow: one a bit lower than a body is a low room if no cell of its side is seen.)
  for (const double cell : {0.1, 0.2, 0.25}) {
    for (const double height : {0.5, 0.8, 2.0, 3.0, 5.0}) {
      Scene scene = worlds::flat(8);
      scene.add_box({3.05, 0, 0}, {5.95, height, 8});
      const World block = bake(scene, cell);
      const bool is_step = height < 0.9;
      EXPECT_EQ(toward(block, {1, 0, 4}, 4, 0), is_step ? Blocker::kStep : Blocker::kNarrow)
          << cell << ' ' << height;
      EXPECT_EQ(toward(block, {4.5, height, 4}, 4, 0), is_step ? Blocker::kStep : Blocker::kGap)
          << cell << ' ' << height;
    }
  }
}

// Whatever the length and direction of the push.
TEST(GroundQuery, APushFarBeyondTheWorldIsOneToItsRim) {
  const World world = bake(worlds::doorway(0.9), 0.1);
  GroundQuery ask = query(world);
  const Place from = world.find_place(0, {2, 0, 1}, 0.5);
  ASSERT_TRUE(from);
  for (const auto& [dx, dz] :
       {std::pair{1.0, 0.0}, {-1.0, 0.3}, {0.7, 1.0}, {0.01, -1.0}, {0.3, 0.8}}) {
    const GroundRay rim = ask.ray(from, 20 * dx, 20 * dz);
    ASSERT_FALSE(rim.arrived);
    for (const double length : {1e4, 1e7, 1e9, 1e12, 1e300}) {
      const GroundRay ray = ask.ray(from, length * dx, length * dz);
      EXPECT_FALSE(ray.arrived);
      EXPECT_EQ(ray.blocked_by, rim.blocked_by);
      EXPECT_LT(::throng::length(ray.place.position - rim.place.position), 1e-3) << length;
      EXPECT_NE(ask.slide(from, length * dx, length * dz).position, from.position);
    }
  }
}

// Its cell there would be another tile's.
TEST(GroundQuery, APlaceBesideTheTileOfItsLevelIsNone) {
  const World world = bake(worlds::flat(30), 0.1);
  const Place here = world.find_place(0, {3, 0, 3}, 0.5);
  const Place there = world.find_place(0, {20, 0, 20}, 0.5);
  ASSERT_TRUE(here && there);
  ASSERT_NE(here.level1, there.level1);
  const Place false_place{there.position, here.level1};
  GroundQuery ask = query(world);
  EXPECT_FALSE(ask.ray(false_place, 1, 0).arrived);
  EXPECT_FALSE(ask.nearest_wall(false_place, 50).found);
  EXPECT_EQ(ask.area_near(false_place, 3), 0);
  EXPECT_EQ(world.move(0, false_place, 0.5, 0).end, MoveEnd::kBlocked);
  EXPECT_TRUE(ask.ray(there, 1, 0).arrived);
  EXPECT_EQ(world.move(0, there, 0.5, 0).end, MoveEnd::kArrived);
}

// Zones of 12.8 m, one of them damaged or missing.
TEST(GroundQuery, NamesAZoneNearbyThatCannotBeUsed) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/flat.throng";
  Context context;
  ASSERT_TRUE(bake_world_to(path, worlds::flat(40), {.cell = 0.2, .zone = 12.8}, context));
  const auto whole = World::open(path);
  ASSERT_TRUE(whole) << whole.error().message;
  const Vec3d origin = whole->summary().origin;
  EXPECT_TRUE(query(*whole).check_near({20, 0, 20}, 1000));

  const std::string name = "zone_2_1.thz";  // x from 25.6 to 38.4 m, z from 12.8 to 25.6 m
  const Vec3d inside = origin + Vec3d{32, 0, 19}, west = origin + Vec3d{20, 0, 19},
              far = origin + Vec3d{5, 0, 5};
  ASSERT_TRUE(std::filesystem::exists(path + "/" + name));
  for (const bool is_missing : {false, true}) {
    if (is_missing) std::filesystem::remove(path + "/" + name);
    if (!is_missing) folder.write("flat.throng/" + name, "no zone");
    const auto world = World::open(path);
    ASSERT_TRUE(world) << world.error().message;
    const GroundQuery ask = query(*world);
    const auto refused = [&](Vec3d position, double radius) {
      const auto ok = ask.check_near(position, radius);
      if (ok) return false;
      EXPECT_EQ(ok.error().code, Errc::kBadFile);
      EXPECT_NE(ok.error().message.find(name), std::string::npos) << ok.error().message;
      return true;
    };
    EXPECT_TRUE(refused(inside, 0));
    EXPECT_TRUE(refused(inside + Vec3d{0, 500, 0}, 1)) << "seen from above";
    EXPECT_FALSE(refused(west, 5)) << "5.6 m from it";
    EXPECT_TRUE(refused(west, 5.7));
    EXPECT_FALSE(refused(far, 15)) << "22 m from it, by the corner";
    EXPECT_TRUE(refused(far, std::numeric_limits<double>::infinity()));
    EXPECT_FALSE(refused({1e9, 0, 1e9}, 5)) << "outside of the world are no zones";
    // Queries take it as empty.
    GroundQuery near = query(*world);
    EXPECT_FALSE(near.nearest_place(inside, 3));
    EXPECT_TRUE(near.nearest_place(west, 3));
  }
}

TEST(GroundQuery, RefusesNonsense) {
  const World world = bake(worlds::flat(6), 0.1);
  EXPECT_FALSE(GroundQuery::create(world, 99));
  EXPECT_FALSE(GroundQuery::create(world, -1));
  EXPECT_FALSE(GroundQuery::create(World(), 0));
  GroundQuery ask = query(world);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const Place from = world.find_place(0, {3, 0, 3}, 0.5);
  ASSERT_TRUE(from);
  EXPECT_FALSE(ask.nearest_place({nan, 0, 0}, 5));
  EXPECT_FALSE(ask.nearest_place({3, 0, 3}, nan));
  EXPECT_FALSE(ask.nearest_place({1e300, 0, -1e300}, 5));
  EXPECT_TRUE(ask.nearest_place({3, 0, 3}, inf));
  EXPECT_FALSE(ask.ray(from, nan, 0).arrived);
  EXPECT_FALSE(ask.ray(from, 1e300, 0).arrived);
  EXPECT_FALSE(ask.ray({}, 1, 0).arrived);
  EXPECT_FALSE(ask.nearest_wall(from, -1).found);
  EXPECT_FALSE(ask.nearest_wall({{3, 0, 3}, 77}, 5).found);
  EXPECT_FALSE(ask.slide({}, 1, 0));
  EXPECT_EQ(ask.slide(from, nan, 0).position, from.position);
  EXPECT_FALSE(ask.random_place_near(from, nan, 1, 1));
  EXPECT_EQ(ask.random_place_near(from, 0, 1, 1).position, from.position);
}

}  // namespace
}  // namespace throng
