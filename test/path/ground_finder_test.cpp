// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/ground_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "path/edits/solid.h"
#include "path/overlay/mesh_finder.h"
#include "throng/path.h"
#include "worlds.h"

// Paths over ground that changes, against the exact search and the geometry of obstacles.
namespace throng {
namespace {

using test::bake;

path::GroundFinder live(const World& world, int32_t avatar_class = 0, double slope_cost = 0) {
  auto made =
      path::GroundFinder::create(world, {.avatar_class = avatar_class, .slope_cost = slope_cost});
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

path::MeshFinder exact(const World& world, int32_t avatar_class = 0) {
  Context context;
  auto made = path::MeshFinder::create(world, {.avatar_class = avatar_class}, context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

double real(uint64_t seed, uint64_t n, uint64_t counter, double low, double high) {
  return low +
         (high - low) * static_cast<double>(random_below(seed, n, counter, 1 << 20)) / (1 << 20);
}

std::vector<uint32_t> off_mesh_points(const Path& path) {
  std::vector<uint32_t> points;
  for (const PathLink& link : path.links) {
    EXPECT_EQ(link.kind, LinkKind::kOffMesh);
    EXPECT_EQ(path.segments[link.point - 1], SegmentKind::kOffMesh);
    points.push_back(link.point);
  }
  return points;
}

double plan_distance(const Vec3d& a, const Vec3d& b) { return std::hypot(a.x - b.x, a.z - b.z); }

void expect_walkable(const World& world, int32_t avatar_class, const Path& path) {
  ASSERT_GE(path.points.size(), 1u);
  double length = 0;
  for (size_t i = 1; i < path.points.size(); ++i) {
    const Vec3d step = path.points[i].position - path.points[i - 1].position;
    length += std::hypot(step.x, step.z);
    const MoveResult move = world.move(avatar_class, path.points[i - 1], step.x, step.z);
    ASSERT_EQ(move.end, MoveEnd::kArrived) << "leg " << i;
    ASSERT_EQ(move.place.level1, path.points[i].level1);
  }
  EXPECT_NEAR(length, path.length, 1e-3 * static_cast<double>(path.points.size()));
}

// Unchanged, it finds what the exact search finds.
TEST(GroundFinder, FindsWhatTheExactSearchFinds) {
  uint64_t found = 0, none = 0;
  double sum = 0;
  for (const World& world :
       {bake(test::builtin({.name = "garage"}), 0.2), bake(test::builtin({.name = "church"}), 0.15),
        bake(test::builtin({.name = "maze"}), 0.2), bake(worlds::random_soup(7, 400, 12), 0.15)}) {
    for (const int32_t c : {0, 1}) {
      path::GroundFinder ground = live(world, c);
      path::MeshFinder finder = exact(world, c);
      Path path, best;
      for (uint64_t n = 0; n < 150; ++n) {
        const Place from = world.random_place(c, 3, 2 * n);
        const Place to = world.random_place(c, 3, 2 * n + 1);
        finder.find(from, to, best);
        ground.find(from, to, path);
        ASSERT_EQ(path.end, best.end) << n;
        expect_walkable(world, c, path);
        EXPECT_LT(plan_distance(path.points.front().position, from.position), 1e-3);
        if (path.end != PathEnd::kReached) {
          ++none;
          continue;
        }
        EXPECT_LT(plan_distance(path.points.back().position, to.position), 1e-3);
        EXPECT_NEAR(path.cost, path.length, 1e-6 + 1e-9 * path.length);
        EXPECT_GE(path.length, best.length - 1e-3 * static_cast<double>(best.points.size()));
        EXPECT_LE(path.length, best.length + 1e-3 * static_cast<double>(best.points.size()));
        sum += path.length / std::max(best.length, world.summary().cell);
        ++found;
      }
    }
  }
  EXPECT_GT(found, 400u);
  EXPECT_GT(none, 100u);
  EXPECT_LT(sum / static_cast<double>(found), 1.0001);
}

// Distance of a point of the plan to a convex polygon, 0 inside. Its corners go around in one
// direction.
double distance_to(const Prism& prism, double x, double z) {
  double best = std::numeric_limits<double>::infinity();
  int left = 0;
  const auto count = prism.corners.size();
  for (size_t i = 0; i < count; ++i) {
    const auto &a = prism.corners[i], &b = prism.corners[(i + 1) % count];
    const double ux = b[0] - a[0], uz = b[1] - a[1];
    if (ux * (z - a[1]) - uz * (x - a[0]) > 0) ++left;
    const double t =
        std::clamp((ux * (x - a[0]) + uz * (z - a[1])) / (ux * ux + uz * uz), 0.0, 1.0);
    best = std::min(best, std::hypot(a[0] + t * ux - x, a[1] + t * uz - z));
  }
  return left == 0 || left == static_cast<int>(count) ? 0 : best;
}

Prism random_prism(uint64_t seed, uint64_t n, const Box3d& box) {
  Prism prism;
  const double x = real(seed, n, 0, box.min.x, box.max.x);
  const double z = real(seed, n, 1, box.min.z, box.max.z);
  const double turn = real(seed, n, 2, 0, 3), size = real(seed, n, 3, 0.05, 1.5);
  const uint64_t corners = 3 + random_below(seed, n, 4, 5);
  for (uint64_t i = 0; i < corners; ++i) {
    const double angle =
        turn + 6.283185307179586 * static_cast<double>(i) / static_cast<double>(corners);
    prism.corners.push_back({x + size * std::cos(angle), z + size * std::sin(angle)});
  }
  prism.low = real(seed, n, 5, box.min.y - 1, box.max.y + 1);
  prism.high = prism.low + real(seed, n, 6, 0.02, 2);
  return prism;
}

TEST(GroundFinder, NoPlaceIsInAnObstacleAndLittleElseIsLost) {
  uint64_t blocked = 0, free = 0, entered = 0;
  for (const World& world : {bake(worlds::two_floors(), 0.1), bake(worlds::ramp(20, 4), 0.1),
                             bake(test::builtin({.name = "garage"}), 0.2)}) {
    const WorldSummary summary = world.summary();
    for (int32_t c = 0; c < static_cast<int32_t>(summary.classes.size()); ++c) {
      const AvatarClass& body = summary.classes[static_cast<size_t>(c)];
      path::GroundFinder ground = live(world, c);
      std::vector<Prism> prisms;
      for (uint64_t n = 0; n < 40; ++n) {
        prisms.push_back(random_prism(17, n, summary.bounds));
        ASSERT_TRUE(ground.add_obstacle({prisms.back()}));
      }
      for (uint64_t n = 0; n < 3000; ++n) {
        const Place p = world.random_place(c, 23, n);
        if (!p) break;
        bool inside = false, near = false;
        for (const Prism& prism : prisms) {
          const double feet = p.position.y;
          const double away = distance_to(prism, p.position.x, p.position.z);
          const auto meets = [&](double more_radius, double more_height) {
            return away < body.radius + more_radius &&
                   prism.high > feet + body_bottom(body) - more_height &&
                   prism.low < feet + body.height + more_height;
          };
          inside |= meets(0, 0);
          // A cell's diagonal, and what a slope rises over it.
          near |= meets(summary.cell * 1.5 + 0.01, summary.cell * 1.5 + 0.01);
        }
        const bool stands = ground.is_free(p);
        if (stands && inside) ++entered;
        if (!near) {
          EXPECT_TRUE(stands);
        }
        ++(stands ? free : blocked);
      }
    }
  }
  EXPECT_EQ(entered, 0u);
  EXPECT_GT(blocked, 100u);
  EXPECT_GT(free, 10000u);
}

TEST(GroundFinder, MeshesBlockWhatTheirTrianglesTouch) {
  const World world = bake(worlds::flat(8), 0.1);
  path::GroundFinder by_mesh = live(world), by_prism = live(world);
  Scene crate;
  crate.add_box({3, 0, 3}, {3.4, 1, 3.6});
  ASSERT_TRUE(by_mesh.add_obstacle(*path::make_solid(crate.positions, crate.triangles)));
  ASSERT_TRUE(by_prism.add_obstacle({Prism::box({3, 0, 3}, {3.4, 1, 3.6})}));
  for (uint64_t n = 0; n < 4000; ++n) {
    const Place p = world.random_place(0, 5, n);
    // So thin a crate has no inside that a body would fit.
    EXPECT_EQ(by_mesh.is_free(p), by_prism.is_free(p));
  }
}

TEST(GroundFinder, PathsLeadAroundACrateAndStraightAfterItsRemoval) {
  const World world = bake(worlds::doorway(1.2), 0.1);
  path::GroundFinder ground = live(world);
  const Place from = world.find_place(0, {2, 0, 3}, 0.5), to = world.find_place(0, {6, 0, 3}, 0.5);
  Path path;
  ground.find(from, to, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  const double straight = path.length;
  EXPECT_NEAR(straight, 4, 1e-3);
  // A crate before the door: around it.
  const path::ChangeId crate = ground.add_obstacle({Prism::box({2.8, 0, 2.8}, {3.1, 1, 3.2})});
  ground.find(from, to, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_GT(path.length, straight + 0.05);
  for (size_t i = 1; i < path.points.size(); ++i) {
    for (double t = 0; t <= 1; t += 0.01) {
      const Vec3d at = path.points[i - 1].position * (1 - t) + path.points[i].position * t;
      EXPECT_GE(distance_to(Prism::box({2.8, 0, 2.8}, {3.1, 1, 3.2}), at.x, at.z),
                AvatarClass{}.radius - 1e-3);
    }
  }
  // A closed door leaf in the doorway: no path; the nearest place is on this side of it.
  const path::ChangeId door = ground.add_obstacle({Prism::box({3.95, 0, 2.3}, {4.05, 2, 3.7})});
  ground.find(from, to, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_EQ(path.blocked_by, Blocker::kObstacle);
  EXPECT_EQ(path.blocked_by_edit, door);
  expect_walkable(world, 0, path);
  EXPECT_NEAR(path.points.back().position.x, 3.7, 0.15);
  ASSERT_TRUE(ground.set_active(door, false));
  ASSERT_TRUE(ground.remove(crate));
  ground.find(from, to, path);
  EXPECT_NEAR(path.length, straight, 1e-9);
  ASSERT_TRUE(ground.set_active(door, true));
  ground.find(from, to, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_FALSE(ground.remove(crate));
  EXPECT_FALSE(ground.set_active(99, true));
}

// Any sequence of changes leaves the ground as if the last ones had been made on a fresh one.
TEST(GroundFinder, ChangesAreUndoneWithoutATrace) {
  const World world = bake(test::builtin({.name = "garage"}), 0.2);
  path::GroundFinder changed = live(world);
  std::vector<std::pair<path::ChangeId, Prism>> active;
  Path path, rebuilt_path;
  for (uint64_t n = 0; n < 60; ++n) {
    if (active.size() > 12 || (!active.empty() && random_below(3, n, 0, 3) == 0)) {
      const size_t which = random_below(3, n, 1, active.size());
      EXPECT_TRUE(changed.remove(active[which].first));
      active.erase(active.begin() + static_cast<int64_t>(which));
    } else {
      Prism prism = random_prism(29, n, world.summary().bounds);
      prism.high = prism.low + 3;
      active.push_back({changed.add_obstacle({prism}), prism});
    }
    path::GroundFinder rebuilt = live(world);
    for (const auto& [id, prism] : active) ASSERT_TRUE(rebuilt.add_obstacle({prism}));
    for (uint64_t k = 0; k < 5; ++k) {
      const Place from = world.random_place(0, n, 2 * k), to = world.random_place(0, n, 2 * k + 1);
      changed.find(from, to, path);
      rebuilt.find(from, to, rebuilt_path);
      ASSERT_EQ(path.end, rebuilt_path.end);
      EXPECT_EQ(path.length, rebuilt_path.length);
      ASSERT_EQ(path.points.size(), rebuilt_path.points.size());
    }
  }
}

// Crates so small and so near to the point that four tiles share that they change one, two or four
// of them: corners of the mesh there depend on the cells of all four.
TEST(GroundFinder, FollowsChangesWhereFourTilesMeet) {
  const World world = bake(worlds::flat(20), 0.1);
  const WorldSummary& summary = world.summary();
  const double tile = kTileCells * summary.cell;
  const Vec3d corner{summary.origin.x + tile, 0, summary.origin.z + tile};
  path::GroundFinder changed = live(world);
  std::vector<std::pair<path::ChangeId, Prism>> active;
  Path path, rebuilt_path;
  uint64_t bent = 0;
  for (uint64_t n = 0; n < 150; ++n) {
    if (active.size() > 3 || (!active.empty() && random_below(5, n, 0, 3) == 0)) {
      const size_t which = random_below(5, n, 1, active.size());
      EXPECT_TRUE(changed.remove(active[which].first));
      active.erase(active.begin() + static_cast<int64_t>(which));
    } else {
      const double x = corner.x + real(5, n, 2, -0.9, 0.9), z = corner.z + real(5, n, 3, -0.9, 0.9);
      const Prism crate =
          Prism::box({x, 0, z}, {x + real(5, n, 4, 0.05, 0.5), 1, z + real(5, n, 5, 0.05, 0.5)});
      active.push_back({changed.add_obstacle({crate}), crate});
    }
    path::GroundFinder rebuilt = live(world);
    for (const auto& [id, crate] : active) ASSERT_TRUE(rebuilt.add_obstacle({crate}));
    for (uint64_t k = 0; k < 6; ++k) {
      const double dx = real(7, n, 2 * k, -2.5, 2.5), dz = real(7, n, 2 * k + 1, -2.5, 2.5);
      const Place from = world.find_place(0, {corner.x + dx, 0, corner.z + dz}, 0.5);
      const Place to = world.find_place(0, {corner.x - dx, 0, corner.z - dz}, 0.5);
      changed.find(from, to, path);
      rebuilt.find(from, to, rebuilt_path);
      ASSERT_EQ(path.end, rebuilt_path.end) << n;
      EXPECT_EQ(path.length, rebuilt_path.length) << n;
      ASSERT_EQ(path.points.size(), rebuilt_path.points.size()) << n;
      bent += path.end == PathEnd::kReached && path.points.size() > 2 ? 1 : 0;
    }
  }
  EXPECT_GT(bent, 100u);
}

TEST(GroundFinder, DearGroundIsAvoidedAndClosedGroundNeverEntered) {
  const World world = bake(worlds::flat(12), 0.1);
  path::GroundFinder ground = live(world);
  const Prism lawn = Prism::box({4, -1, 0}, {8, 1, 9});
  const auto first = ground.add_area(lawn, 7);
  ASSERT_TRUE(first);
  const Place from = world.find_place(0, {2, 0, 4}, 0.5), to = world.find_place(0, {10, 0, 4}, 0.5);
  Path path;
  ground.find(from, to, path);
  EXPECT_NEAR(path.length, 8, 1e-3);  // it costs what the rest costs
  ASSERT_TRUE(ground.set_area_cost(7, 1.2));
  ground.find(from, to, path);
  EXPECT_NEAR(path.length, 8, 0.02);  // around it is farther
  EXPECT_NEAR(path.cost, 4 + 4 * 1.2, 0.05);
  ASSERT_TRUE(ground.set_area_cost(7, 50));
  ground.find(from, to, path);
  EXPECT_NEAR(path.cost, 2 * std::hypot(2, 5) + 4, 0.15);
  EXPECT_NEAR(path.length, path.cost, 0.05);
  ASSERT_TRUE(ground.set_area_cost(7, std::numeric_limits<double>::infinity()));
  ground.find(from, to, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_NEAR(path.length, path.cost, 1e-9);
  EXPECT_FALSE(ground.is_free(world.find_place(0, {6, 0, 4}, 0.5)));
  const auto more = ground.add_area(Prism::box({4, -1, 9}, {8, 1, 13}), 7);
  ASSERT_TRUE(more);
  ground.find(from, to, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_EQ(path.blocked_by, Blocker::kClosed);
  EXPECT_EQ(path.blocked_by_edit, *first);
  EXPECT_NEAR(path.points.back().position.x, 4, 0.2);
  ASSERT_TRUE(ground.remove(*more));
  ground.find(from, to, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
}

// What a search has read stays where a change touches no cell that is legal for the class.
TEST(GroundFinder, OnlyChangesOfItsGroundConcernASearch) {
  const World world = bake(worlds::flat(30), 0.1);
  path::GroundFinder ground = live(world);
  const Place from = world.find_place(0, {2, 0, 2}, 0.5),
              to = world.find_place(0, {27, 0, 26}, 0.5);
  ground.begin(from, to);
  Path path;
  uint64_t version = ground.version();
  const auto expect_change = [&](bool is_one, const char* what) {
    EXPECT_EQ(ground.version() != version, is_one) << what;
    version = ground.version();
  };
  const auto add = [&](double low) {
    return ground.add_obstacle({Prism::box({3, low, 3}, {4, low + 1, 4}), {}});
  };
  const path::ChangeId high = add(900), low = add(0);
  expect_change(true, "the crate on the floor");
  ground.find(from, to, path);
  for (const bool active : {false, true}) {
    EXPECT_TRUE(ground.set_active(high, active));
    expect_change(false, "the crate high up");
    EXPECT_TRUE(ground.set_active(low, active));
    expect_change(true, "the crate on the floor");
    ground.find(from, to, path);
  }
  EXPECT_TRUE(ground.remove(high));
  expect_change(false, "the crate high up");
  // Costs, after the first, which decides how paths are searched.
  ASSERT_TRUE(ground.set_area_cost(9, 3));
  expect_change(true, "the first cost");
  ground.find(from, to, path);
  ASSERT_TRUE(ground.set_area_cost(8, 5));
  expect_change(false, "a cost of no ground");
  ASSERT_TRUE(ground.set_area_cost(8, 0.5));
  expect_change(true, "the least cost");
  ground.find(from, to, path);
  ASSERT_TRUE(ground.add_area(Prism::box({3, 900, 3}, {6, 901, 6}), 9));
  expect_change(false, "an area high up");
  ASSERT_TRUE(ground.add_area(Prism::box({3, -1, 3}, {6, 1, 6}), 9));
  expect_change(true, "an area");
  ground.find(from, to, path);
  ASSERT_TRUE(ground.set_area_cost(9, 4));
  expect_change(true, "its cost");
}

// The path over a refracting border: by Snell's law, found by trying all places to cross.
TEST(GroundFinder, CrossesBordersOfAreasWhereItIsCheapest) {
  const World world = bake(worlds::flat(12), 0.1);
  path::GroundFinder ground = live(world);
  ASSERT_TRUE(ground.add_area(Prism::box({6, -1, -1}, {13, 1, 13}), 3));
  ASSERT_TRUE(ground.set_area_cost(3, 2.5));
  Path path;
  for (uint64_t n = 0; n < 40; ++n) {
    const Place from = world.find_place(0, {real(1, n, 0, 1, 5), 0, real(1, n, 1, 1, 11)}, 0.5);
    const Place to = world.find_place(0, {real(1, n, 2, 7, 11), 0, real(1, n, 3, 1, 11)}, 0.5);
    ground.find(from, to, path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    double best = 1e9;
    for (double z = 0.3; z < 11.7; z += 0.01) {
      best = std::min(best, std::hypot(from.position.x - 6, from.position.z - z) +
                                2.5 * std::hypot(to.position.x - 6, to.position.z - z));
    }
    // Cells whose middle lies in the area are of it: the border is off by up to half a cell.
    EXPECT_GE(path.cost, best - 0.1);
    EXPECT_LE(path.cost, best * 1.02 + 0.1);
  }
}

TEST(GroundFinder, SlopesCostMoreIfSet) {
  const World world = bake(worlds::ramp(20, 4), 0.1);
  const Place from = world.find_place(0, {1, 0, 1.5}, 0.5),
              to = world.find_place(0, {9, 2, 1.5}, 3);
  ASSERT_TRUE(to);
  path::GroundFinder plain = live(world), dear = live(world, 0, 3);
  Path path;
  plain.find(from, to, path);
  const double length = path.length;
  EXPECT_NEAR(path.cost, length, 1e-9);
  dear.find(from, to, path);
  EXPECT_NEAR(path.length, length, 0.1);
  // 20 degrees rise 36 %: the class up to 60 %. But for the ramp's ends, all 4 m of it.
  EXPECT_NEAR(path.cost, length + 4 * 3 * 0.6, 1.2);
}

TEST(GroundFinder, OffMeshLinksLeadWhereMovesDoNot) {
  const World world = bake(worlds::doorway(0.2), 0.1);  // too narrow for an adult: two rooms
  path::GroundFinder ground = live(world);
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  const Place from = at(1, 1), to = at(7, 5);
  Path path;
  ground.find(from, to, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  for (const double cost : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_FALSE(ground.add_off_mesh_link({at(3.5, 3), at(4.5, 3), cost}));
  }
  EXPECT_FALSE(ground.add_off_mesh_link({at(3.5, 3), {}, 2}));
  const auto off_mesh_link = ground.add_off_mesh_link({at(3.5, 3), at(4.5, 3), 1.5, false});
  ASSERT_TRUE(off_mesh_link);
  ground.find(from, to, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  ASSERT_EQ(off_mesh_points(path), std::vector<uint32_t>{2});
  EXPECT_NEAR(path.points[1].position.x, 3.5, 1e-3);
  EXPECT_NEAR(path.points[2].position.x, 4.5, 1e-3);
  EXPECT_NEAR(path.length, 2 * std::hypot(2.5, 2) + 1, 0.01);
  EXPECT_NEAR(path.cost, 2 * std::hypot(2.5, 2) + 1.5, 0.01);
  ground.find(to, from, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);  // one way
  const auto lift = ground.add_off_mesh_link({at(3.5, 5), at(4.5, 5), 1.1});
  ASSERT_TRUE(lift);
  ground.find(to, from, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(path.links.size(), 1u);
  path::GroundFinder copy = ground;
  ASSERT_TRUE(ground.set_active(*lift, false));
  ground.find(to, from, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  copy.find(to, from, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  ASSERT_TRUE(ground.set_active(*lift, true));
  ground.find(to, from, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  // A crate where it lands: no path uses the link.
  ASSERT_TRUE(ground.add_obstacle({Prism::box({4.4, 0, 2.9}, {4.6, 1, 3.1})}));
  ASSERT_TRUE(ground.remove(*lift));
  ground.find(from, to, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  ASSERT_TRUE(ground.remove(*off_mesh_link));
}

// Their ends lie in tiles of which only a part is legal, none of them the first.
TEST(GroundFinder, OffMeshLinksJoinTilesFarFromTheOrigin) {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({12, -0.5, 0}, {22, 0, 10});
  const World world = bake(scene, 0.1);
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  path::GroundFinder ground = live(world);
  Path path;
  for (const double z : {1.0, 5.0, 8.0}) {
    const auto link = ground.add_off_mesh_link({at(9, z), at(13, z), 4, false});
    ASSERT_TRUE(link) << z;
    ground.find(at(3, z), at(19, z), path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_NEAR(path.cost, 16, 0.01);
    ASSERT_TRUE(ground.remove(*link));
  }
}

// Two off-mesh links to one place: the path uses the cheaper, and stands where that one begins.
TEST(GroundFinder, OfTwoOffMeshLinksToOnePlaceTheCheaperIsUsed) {
  const World world = bake(worlds::doorway(0.2), 0.1);
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  const Place from = at(1, 3), to = at(7, 3);
  for (const bool cheap_first : {true, false}) {
    path::GroundFinder ground = live(world);
    const OffMeshLink cheap{at(3.3, 3), at(4.7, 3), 2, false},
        dear{at(3.3, 4.5), at(4.7, 3), 9, false};
    ASSERT_TRUE(ground.add_off_mesh_link(cheap_first ? cheap : dear));
    ASSERT_TRUE(ground.add_off_mesh_link(cheap_first ? dear : cheap));
    Path path;
    ground.find(from, to, path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    ASSERT_EQ(off_mesh_points(path), std::vector<uint32_t>{2});
    EXPECT_NEAR(path.points[1].position.z, 3, 1e-3);
    EXPECT_NEAR(path.cost, 2.3 + 2 + 2.3, 0.01);
  }
}

// An off-mesh link that costs less than its length, and begins away from the goal, beyond the
// border of a tile: a search that took the straight line for a bound would stop at the direct path.
TEST(GroundFinder, ACheapOffMeshLinkIsUsedThoughItLeadsAwayFirst) {
  const World world = bake(worlds::flat(40), 0.2);
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  path::GroundFinder ground = live(world);
  Path path;
  ground.find(at(14, 5), at(27, 5), path);
  EXPECT_NEAR(path.cost, 13, 0.1);
  const auto link = ground.add_off_mesh_link({at(11, 5), at(27, 6), 0.5});
  ASSERT_TRUE(link);
  ground.find(at(14, 5), at(27, 5), path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(path.links.size(), 1u);
  EXPECT_NEAR(path.cost, 3 + 0.5 + 1, 0.2);
  ground.find(at(27, 5), at(14, 5), path);
  EXPECT_NEAR(path.cost, 3 + 0.5 + 1, 0.2);
  path::GroundFinder copy = ground;
  copy.find(at(14, 5), at(27, 5), path);
  EXPECT_NEAR(path.cost, 3 + 0.5 + 1, 0.2);
  ASSERT_TRUE(ground.set_active(*link, false));
  ground.find(at(14, 5), at(27, 5), path);
  EXPECT_NEAR(path.cost, 13, 0.1);
}

// A path is used again and again, by one finder after the other.
TEST(GroundFinder, NothingOfAnOldPathIsLeft) {
  const World world = bake(worlds::doorway(0.2), 0.1);
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  path::GroundFinder ground = live(world);
  path::MeshFinder finder = exact(world);
  Path path;
  ground.find(at(1, 1), at(7, 5), path);
  ASSERT_NE(path.blocked_by, Blocker::kNone);
  finder.find(at(1, 1), at(2, 5), path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(path.blocked_by, Blocker::kNone);
  ASSERT_TRUE(ground.add_off_mesh_link({at(3.5, 3), at(4.5, 3), 1.5, false}));
  ground.find(at(1, 1), at(7, 5), path);
  ASSERT_EQ(path.links.size(), 1u);
  finder.find(at(1, 1), at(2, 5), path);
  EXPECT_TRUE(path.links.empty());
  EXPECT_EQ(path.cost, path.length);
}

TEST(GroundFinder, SearchesInSlicesAndStartsAgainWhenTheGroundChanges) {
  const World world = bake(test::builtin({.name = "garage"}), 0.2);
  path::GroundFinder ground = live(world);
  Path path, whole;
  uint64_t slices = 0;
  for (uint64_t n = 0; n < 20; ++n) {
    const Place from = world.random_place(0, 31, 2 * n), to = world.random_place(0, 31, 2 * n + 1);
    ground.find(from, to, whole);
    ground.begin(from, to);
    while (!ground.advance(10, path)) {
      EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
      ++slices;
      if (slices % 7 == 0) {
        const Prism everywhere = Prism::box({-90, 0, -90}, {90, 0.1, 90});
        ASSERT_TRUE(ground.remove(ground.add_obstacle({everywhere})));
        ground.advance(100000, path);
        break;
      }
    }
    EXPECT_EQ(path.end, whole.end);
    EXPECT_EQ(path.length, whole.length);
    ground.find(from, to, path, 3);
    EXPECT_TRUE(path.end == PathEnd::kBudgetExhausted || path.nodes <= 3);
  }
  EXPECT_GT(slices, 50u);
}

// All of the ground is not searched over intervals for a goal that is walled in.
TEST(GroundFinder, SeesEarlyThatAGoalIsWalledIn) {
  const World world = bake(worlds::flat(60), 0.2);
  path::GroundFinder ground = live(world);
  for (uint64_t n = 0; n < 400; ++n) {
    const double x = real(8, n, 0, 2, 58), z = real(8, n, 1, 2, 40);
    ASSERT_TRUE(ground.add_obstacle({Prism::box({x, 0, z}, {x + 0.5, 1, z + 0.3})}));
  }
  const Place from = world.find_place(0, {1, 0, 1}, 1), to = world.find_place(0, {50, 0, 50}, 1);
  Path path, over_points;
  ground.find(from, to, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  const Prism walls[] = {
      Prism::box({48, 0, 48}, {52, 2, 48.2}), Prism::box({48, 0, 51.8}, {52, 2, 52}),
      Prism::box({48, 0, 48}, {48.2, 2, 52}), Prism::box({51.8, 0, 48}, {52, 2, 52})};
  for (const Prism& wall : walls) ground.add_obstacle({wall});
  ground.find_over_points(from, to, over_points);
  ground.find(from, to, path);
  ASSERT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_EQ(path.length, over_points.length);
  EXPECT_EQ(path.blocked_by, Blocker::kObstacle);
  EXPECT_GT(path.nodes, over_points.nodes + 4000);  // else this proves nothing
  EXPECT_LT(path.nodes, over_points.nodes + 4200);
  // In parts it is the same.
  uint64_t parts = 0;
  Path in_parts;
  for (ground.begin(from, to); !ground.advance(500, in_parts);) ++parts;
  EXPECT_GT(parts, 8u);
  EXPECT_EQ(in_parts.end, path.end);
  EXPECT_EQ(in_parts.length, path.length);
  EXPECT_EQ(in_parts.nodes, path.nodes);
}

TEST(GroundFinder, RefusesNonsense) {
  const World world = bake(worlds::flat(6), 0.1);
  EXPECT_FALSE(path::GroundFinder::create(World(), {}));
  EXPECT_FALSE(path::GroundFinder::create(world, {.avatar_class = 9}));
  EXPECT_FALSE(path::GroundFinder::create(world, {.slope_cost = -1}));
  EXPECT_EQ(path::GroundFinder::create(world, {.workers = -1}).error().message,
            "path: workers must be 0 or more");
  path::GroundFinder ground = live(world);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(path::make_solid(Prism{}));
  EXPECT_FALSE(path::make_solid(Prism{{{0, 0}, {1, 0}, {1, nan}}, 0, 1}));
  EXPECT_FALSE(path::make_solid(Prism{{{0, 0}, {1, 0}, {1, 1}}, 1, 1}));
  EXPECT_FALSE(path::make_solid(Prism{{{0, 0}, {1, 0}, {2, 0}}, 0, 1}));            // a line
  EXPECT_FALSE(path::make_solid(Prism{{{0, 0}, {2, 0}, {1, 0.5}, {1, 2}}, 0, 1}));  // a dent
  Prism star;
  for (int i = 0; i < 5; ++i) {
    star.corners.push_back({std::cos(i * 2 * 1.2566), std::sin(i * 2 * 1.2566)});
  }
  star.high = 1;
  EXPECT_FALSE(path::make_solid(star));
  const std::vector<Vec3d> corners{{0, 0, 0}, {1, 0, 0}, {0, nan, 1}};
  EXPECT_FALSE(path::make_solid(corners, std::vector<std::array<uint32_t, 3>>{}));
  EXPECT_FALSE(path::make_solid(corners, std::vector<std::array<uint32_t, 3>>{{0, 1, 2}}));
  EXPECT_FALSE(path::make_solid(corners, std::vector<std::array<uint32_t, 3>>{{0, 1, 7}}));
  EXPECT_FALSE(ground.add_area(Prism::box({0, 0, 0}, {1, 1, 1}), 0));
  EXPECT_FALSE(ground.set_area_cost(3, 0));
  EXPECT_FALSE(ground.set_area_cost(3, nan));
  EXPECT_FALSE(ground.set_area_cost(64, 1));
  EXPECT_TRUE(ground.add_obstacle({Prism::box({-1e8, 0, -1e8}, {-0.9e8, 1, 1e8})}));  // far off
  Path path;
  ground.find({}, world.find_place(0, {3, 0, 3}, 0.5), path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace);
  ground.find({{3, 0, 3}, 999}, world.find_place(0, {3, 0, 3}, 0.5), path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace);
}

}  // namespace
}  // namespace throng
