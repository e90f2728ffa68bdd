// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/path.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "path/edits/ground_finder.h"
#include "path/overlay/mesh_finder.h"
#include "throng/bake.h"
#include "throng/world.h"
#include "worlds.h"

// Paths over the ground, against a brute-force visibility graph.
namespace throng {
namespace {

using test::bake;

World builtin(const BuiltinWorldConfig& config, double cell) {
  return bake(test::builtin(config), cell);
}

path::MeshFinder finder(const World& world, int32_t avatar_class, bool labels = false) {
  Context context;
  auto made = path::MeshFinder::create(
      world,
      {.avatar_class = avatar_class, .speedup = labels ? PathSpeedup::kLabels : PathSpeedup::kNone},
      context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

double plan_distance(const Vec3d& a, const Vec3d& b) { return std::hypot(a.x - b.x, a.z - b.z); }

// The path is legal from its first place to its last, and its length is right.
void expect_walkable(const World& world, int32_t avatar_class, const Place& from, const Place& to,
                     const Path& path) {
  ASSERT_GE(path.points.size(), 2u);
  EXPECT_LT(plan_distance(path.points.front().position, from.position), 1e-3);
  EXPECT_LT(plan_distance(path.points.back().position, to.position), 1e-3);
  EXPECT_EQ(path.points.front().level1, from.level1);
  EXPECT_EQ(path.points.back().level1, to.level1);
  double length = 0;
  Place at = path.points.front();
  for (size_t i = 1; i < path.points.size(); ++i) {
    const Vec3d step = path.points[i].position - at.position;
    length += std::hypot(step.x, step.z);
    const MoveResult move = world.move(avatar_class, at, step.x, step.z);
    ASSERT_EQ(move.end, MoveEnd::kArrived) << "leg " << i;
    ASSERT_EQ(move.place.level1, path.points[i].level1);
    EXPECT_NEAR(move.place.position.y, path.points[i].position.y, 1e-9);
    at = path.points[i];
  }
  EXPECT_NEAR(length, path.length, 1e-3 * static_cast<double>(path.points.size()));
}

// A floor with boxes at random, of any size and some turned.
Scene boxes(uint64_t seed) {
  constexpr double kSide = 9;
  Scene scene = worlds::flat(kSide);
  const auto real = [&](uint64_t n, double low, double high) {
    return low + (high - low) * static_cast<double>(random_below(seed, n, 0, 1 << 20)) / (1 << 20);
  };
  for (uint64_t b = 0; b < 9; ++b) {
    const double x = real(b * 5, 0, kSide), z = real(b * 5 + 1, 0, kSide);
    const double w = real(b * 5 + 2, 0.1, 2.5), d = real(b * 5 + 3, 0.1, 2.5);
    const double angle = b % 3 == 0 ? real(b * 5 + 4, 0, 3) : 0;
    const auto corner = [&](double u, double v, double y) {
      return Vec3d{x + u * w * std::cos(angle) - v * d * std::sin(angle), y,
                   z + u * w * std::sin(angle) + v * d * std::cos(angle)};
    };
    constexpr double kUV[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    for (size_t i = 0; i < 4; ++i) {
      const auto& p = kUV[i];
      const auto& q = kUV[(i + 1) % 4];
      scene.add_quad(corner(p[0], p[1], 0), corner(q[0], q[1], 0), corner(q[0], q[1], 2.5),
                     corner(p[0], p[1], 2.5));
    }
    // No body fits into the room inside.
    scene.add_quad(corner(-0.5, -0.5, 0.6), corner(0.5, -0.5, 0.6), corner(0.5, 0.5, 0.6),
                   corner(-0.5, 0.5, 0.6), kAreaBlocked);
  }
  return scene;
}

// The shortest path over all points beside convex corners of the legal cells that moves can join: a
// visibility graph, by trying every pair. Of one level tile after the other, so for flat worlds.
class Visibility {
 public:
  Visibility(const World& world, int32_t avatar_class) : world_(world), class_(avatar_class) {
    const WorldSummary summary = world.summary();
    const int32_t width = summary.tiles_x * kTileCells, depth = summary.tiles_z * kTileCells;
    std::vector<uint8_t> legal(static_cast<size_t>(width) * static_cast<size_t>(depth), 0);
    const auto at = [&](int32_t x, int32_t z) {
      return x >= 0 && z >= 0 && x < width && z < depth &&
             legal[static_cast<size_t>(z) * static_cast<size_t>(width) + static_cast<size_t>(x)] !=
                 0;
    };
    for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
      const LevelTileContent tile = world.level_tile(l);
      for (int32_t c = 0; c < kTileCells * kTileCells; ++c) {
        if (tile.clearance[static_cast<size_t>(avatar_class)][static_cast<size_t>(c)] == 0)
          continue;
        const int32_t x = tile.tile_x * kTileCells + c % kTileCells;
        const int32_t z = tile.tile_z * kTileCells + c / kTileCells;
        legal[static_cast<size_t>(z) * static_cast<size_t>(width) + static_cast<size_t>(x)] = 1;
      }
    }
    const double nudge = summary.cell / 1024;
    for (int32_t z = 1; z < depth; ++z) {
      for (int32_t x = 1; x < width; ++x) {
        const int count = at(x, z) + at(x - 1, z) + at(x, z - 1) + at(x - 1, z - 1);
        if (count != 3) continue;
        const double away_x = at(x, z) && at(x, z - 1) ? 1 : -1;
        const double away_z = at(x, z) && at(x - 1, z) ? 1 : -1;
        const Vec3d point{summary.origin.x + x * summary.cell + away_x * nudge, 0,
                          summary.origin.z + z * summary.cell + away_z * nudge};
        corners_.push_back(world.find_place(avatar_class, point, 0.5));
      }
    }
  }

  // Infinite if there is no path.
  [[nodiscard]] double length(const Place& from, const Place& to) const {
    std::vector<Place> points = corners_;
    points.push_back(from);
    points.push_back(to);
    const size_t start = points.size() - 2, goal = points.size() - 1;
    std::vector<double> best(points.size(), std::numeric_limits<double>::infinity());
    std::vector<bool> done(points.size(), false);
    best[start] = 0;
    for (;;) {
      size_t next = points.size();
      for (size_t i = 0; i < points.size(); ++i) {
        if (!done[i] && std::isfinite(best[i]) && (next == points.size() || best[i] < best[next]))
          next = i;
      }
      if (next == points.size() || next == goal) return best[goal];
      done[next] = true;
      for (size_t i = 0; i < points.size(); ++i) {
        const double through =
            best[next] + plan_distance(points[next].position, points[i].position);
        if (done[i] || through >= best[i] || !points[i]) continue;
        const Vec3d d = points[i].position - points[next].position;
        if (world_.move(class_, points[next], d.x, d.z).end == MoveEnd::kArrived) best[i] = through;
      }
    }
  }

 private:
  const World& world_;
  int32_t class_;
  std::vector<Place> corners_;
};

TEST(Path, NoLegalPathIsShorterOnRandomFloors) {
  int reached = 0, bent = 0;
  for (uint64_t seed = 0; seed < 24; ++seed) {
    const World world = bake(boxes(seed), seed % 2 == 0 ? 0.15 : 0.1, {AvatarClass{}});
    path::MeshFinder paths = finder(world, 0), looked_up = finder(world, 0, true);
    const Visibility oracle(world, 0);
    Path path, label_path;
    for (uint64_t n = 0; n < 12; ++n) {
      const Place from = world.random_place(0, seed, 2 * n);
      const Place to = world.random_place(0, seed, 2 * n + 1);
      ASSERT_TRUE(from && to);
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", pair " << n);
      const double shortest = oracle.length(from, to);
      paths.find(from, to, path);
      ASSERT_EQ(path.end == PathEnd::kReached, std::isfinite(shortest));
      if (path.end != PathEnd::kReached) continue;
      ++reached;
      bent += path.points.size() > 2;
      expect_walkable(world, 0, from, to, path);
      EXPECT_LE(path.length, shortest + 1e-4);
      // The oracle keeps two units farther from each corner.
      EXPECT_GE(path.length, shortest * (1 - 1e-3) - 1e-3);
      looked_up.find(from, to, label_path);
      ASSERT_EQ(label_path.end, PathEnd::kReached);
      expect_walkable(world, 0, from, to, label_path);
      EXPECT_NEAR(label_path.length, path.length, 1e-6);
    }
  }
  EXPECT_GT(reached, 150);
  EXPECT_GT(bent, 60);
}

// The same place moved to the low corner of its cell: on the border of rectangles, often.
Place on_border(const World& world, int32_t avatar_class, const Place& place) {
  const WorldSummary summary = world.summary();
  const auto low = [&](double at, double origin) {
    return origin + (std::floor((at - origin) / summary.cell) + 1.0 / 8192) * summary.cell;
  };
  const MoveResult move =
      world.move(avatar_class, place, low(place.position.x, summary.origin.x) - place.position.x,
                 low(place.position.z, summary.origin.z) - place.position.z);
  EXPECT_EQ(move.end, MoveEnd::kArrived);
  return move.place;
}

// Paths exist within components and nowhere else, and are legal.
void expect_as_graph(const World& world, uint64_t pairs) {
  Context context;
  const auto graph = Graph::create(world, {}, context);
  ASSERT_TRUE(graph);
  const auto classes = static_cast<int32_t>(world.summary().classes.size());
  for (int32_t c = 0; c < classes; ++c) {
    SCOPED_TRACE(world.summary().classes[static_cast<size_t>(c)].name);
    path::MeshFinder paths = finder(world, c), looked_up = finder(world, c, true);
    auto over_zones = path::MeshFinder::create(
        world, {.avatar_class = c, .speedup = PathSpeedup::kZones}, context);
    ASSERT_TRUE(over_zones);
    EXPECT_EQ(looked_up.summary().corners == 0, looked_up.summary().labels == 0);
    Path path, label_path, zone_path;
    for (uint64_t n = 0; n < pairs; ++n) {
      Place from = world.random_place(c, 3, 2 * n), to = world.random_place(c, 3, 2 * n + 1);
      if (!from || !to) break;
      if (n % 3 == 1) from = on_border(world, c, from);
      if (n % 3 == 2) to = on_border(world, c, to);
      SCOPED_TRACE(testing::Message() << "pair " << n);
      paths.find(from, to, path);
      const bool together = graph->component_at(c, from) == graph->component_at(c, to);
      ASSERT_EQ(path.end, together ? PathEnd::kReached : PathEnd::kUnreachable);
      looked_up.find(from, to, label_path);
      ASSERT_EQ(label_path.end, path.end);
      over_zones->find(from, to, zone_path);
      ASSERT_EQ(zone_path.end, path.end);
      if (!together) continue;
      EXPECT_GE(zone_path.length, path.length - 1e-6);
      EXPECT_LE(zone_path.length, path.length * 1.05 + 1e-6);
      expect_walkable(world, c, from, to, path);
      expect_walkable(world, c, from, to, label_path);
      EXPECT_NEAR(label_path.length, path.length, 1e-6);
    }
  }
}

TEST(Path, LeadsUpStairsRampsAndSpirals) {
  expect_as_graph(bake(worlds::two_floors(), 0.1, default_classes()), 60);
  expect_as_graph(builtin({.name = "stairs"}, 0.15), 60);
  expect_as_graph(builtin({.name = "church"}, 0.15), 60);
  expect_as_graph(builtin({.name = "garage", .size = 45, .levels = 3}, 0.2), 60);
  expect_as_graph(builtin({.name = "maze", .size = 30, .levels = 2}, 0.1), 40);
}

// Hills whose slopes come to about a step a cell: between neighbouring cells, both legal, the
// ground often rises by more than that.
Scene hills(uint64_t seed, double side, double steepest) {
  constexpr int32_t kSquares = 48;
  const auto real = [&](uint64_t n) {
    return static_cast<double>(random_below(seed, n, 0, 1 << 20)) / (1 << 20);
  };
  const auto height = [&](double x, double z) {
    double sum = 0;
    for (uint64_t wave = 0; wave < 5; ++wave) {
      const double turn = 6.28 * real(wave * 3), along = x * std::cos(turn) + z * std::sin(turn);
      const double often = 0.4 + 1.2 * real(wave * 3 + 1);
      sum += steepest / 2.5 / often * std::sin(often * along + 6.28 * real(wave * 3 + 2));
    }
    return sum;
  };
  Scene scene;
  const auto corner = [&](int32_t x, int32_t z) {
    const double px = side * x / kSquares, pz = side * z / kSquares;
    return Vec3d{px, height(px, pz), pz};
  };
  for (int32_t z = 0; z < kSquares; ++z) {
    for (int32_t x = 0; x < kSquares; ++x) {
      scene.add_quad(corner(x, z), corner(x, z + 1), corner(x + 1, z + 1), corner(x + 1, z));
    }
  }
  return scene;
}

TEST(Path, LeadsAroundTheEndsOfRisesThatAreTooHigh) {
  const std::vector<AvatarClass> classes{
      {.name = "low", .height = 1.5, .radius = 0.25, .step_height = 0.05, .max_slope = 40},
      {.name = "high", .height = 1.5, .radius = 0.25, .step_height = 0.08, .max_slope = 40}};
  Context context;
  uint64_t together = 0, apart = 0;
  double sum = 0, by_live = 0;
  for (uint64_t seed = 0; seed < 12; ++seed) {
    const World world = bake(hills(seed, 16, 0.4), seed % 2 == 0 ? 0.2 : 0.25, classes);
    const auto graph = Graph::create(world, {}, context);
    ASSERT_TRUE(graph);
    for (const int32_t c : {0, 1}) {
      path::MeshFinder paths = finder(world, c), looked_up = finder(world, c, true);
      auto over_zones = path::MeshFinder::create(
          world, {.avatar_class = c, .speedup = PathSpeedup::kZones}, context);
      auto live = path::GroundFinder::create(world, {.avatar_class = c});
      ASSERT_TRUE(over_zones && live);
      Path path, live_path;
      for (uint64_t n = 0; n < 60; ++n) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", class " << c << ", pair " << n);
        const Place from = world.random_place(c, 3, 2 * n),
                    to = world.random_place(c, 3, 2 * n + 1);
        if (!from || !to) break;
        const bool can = graph->component_at(c, from) == graph->component_at(c, to);
        ++(can ? together : apart);
        for (path::MeshFinder* finder : {&paths, &looked_up, &*over_zones}) {
          finder->find(from, to, path);
          ASSERT_EQ(path.end, can ? PathEnd::kReached : PathEnd::kUnreachable);
          if (can) expect_walkable(world, c, from, to, path);
        }
        live->find(from, to, live_path);
        if (!can) continue;
        paths.find(from, to, path);
        sum += path.length;
        by_live += live_path.length;
      }
    }
  }
  EXPECT_GT(together, 300u);
  EXPECT_GT(apart, 50u);
  EXPECT_LT(sum, by_live * 1.01);
}

// A city of many small zones, in overlay cells of 8 x 8: paths over them against the shortest.
TEST(Path, PathsOverManyZonesAreHardlyLonger) {
  BakeConfig config{.cell = 0.4, .resolution = 0.1, .zone = 26};
  Context context;
  const auto world = bake_world(test::builtin({.name = "city", .size = 420}), config, context);
  ASSERT_TRUE(world);
  const auto classes = static_cast<int32_t>(world->summary().classes.size());
  uint64_t asked = 0, far = 0;
  double sum = 0, shortest = 0;
  for (int32_t c = 0; c < classes; ++c) {
    SCOPED_TRACE(world->summary().classes[static_cast<size_t>(c)].name);
    auto made = path::MeshFinder::create(
        *world, {.avatar_class = c, .speedup = PathSpeedup::kZones}, context);
    ASSERT_TRUE(made);
    path::MeshFinder over_zones = *std::move(made), exact = finder(*world, c);
    EXPECT_GT(over_zones.summary().entrances, 100u);
    Path path, best;
    for (uint64_t n = 0; n < 150; ++n) {
      Place from = world->random_place(c, 4, 2 * n), to = world->random_place(c, 4, 2 * n + 1);
      if (n % 3 == 1) from = on_border(*world, c, from);
      if (n % 3 == 2) to = on_border(*world, c, to);
      SCOPED_TRACE(testing::Message() << "pair " << n);
      exact.find(from, to, best);
      over_zones.find(from, to, path);
      ASSERT_EQ(path.end, best.end);
      if (path.end != PathEnd::kReached) continue;
      expect_walkable(*world, c, from, to, path);
      EXPECT_GE(path.length, best.length - 1e-6);
      EXPECT_LE(path.length, best.length * 1.05 + 1e-6);
      ++asked;
      far += path.nodes == 0;
      sum += path.length;
      shortest += best.length;
    }
  }
  EXPECT_GT(asked, 200u);
  EXPECT_GT(far, asked / 2);
  EXPECT_LT(sum, shortest * 1.005);
}

// Between middles of cells, by slopes that lead through points that four cells share: near, in the
// same zone, and far.
TEST(Path, StraightLinesOverManyZonesAreFound) {
  const World world = bake(test::builtin({.name = "city", .size = 250}), 0.4);
  const WorldSummary summary = world.summary();
  const double cell = summary.cell;
  Context context;
  auto made = path::MeshFinder::create(world, {.speedup = PathSpeedup::kZones}, context);
  ASSERT_TRUE(made);
  path::MeshFinder over_zones = *std::move(made), search = finder(world, 0),
                   labels = finder(world, 0, true);
  Path path;
  uint64_t straight = 0;
  for (uint64_t n = 0; n < 4000; ++n) {
    const Place place = world.random_place(0, 6, n);
    const auto move = [&](const Place& at, double cells_x, double cells_z) {
      // So little past the middle of a cell that it is rounded to that.
      const auto by = [&](double from, double origin, double cells) {
        return origin + (std::floor((from - origin) / cell) + cells + 0.5 + 1.0 / 8192) * cell -
               from;
      };
      return world.move(0, at, by(at.position.x, summary.origin.x, cells_x),
                        by(at.position.z, summary.origin.z, cells_z));
    };
    const MoveResult from = move(place, 0, 0);
    const auto random = [&](uint64_t use, uint64_t count) {
      return static_cast<double>(random_below(7, n, use, count));
    };
    const double times = 1 + random(0, 120);
    const MoveResult to =
        move(from.place, (2 * random(1, 3) - 1) * times, (2 * random(2, 3) - 1) * times);
    if (from.end != MoveEnd::kArrived || to.end != MoveEnd::kArrived) continue;
    SCOPED_TRACE(testing::Message() << "pair " << n);
    const double length = plan_distance(from.place.position, to.place.position);
    for (path::MeshFinder* by : {&search, &labels, &over_zones}) {
      SCOPED_TRACE(by == &search ? "search" : by == &labels ? "labels" : "zones");
      by->find(from.place, to.place, path);
      ASSERT_EQ(path.end, PathEnd::kReached);
      EXPECT_NEAR(path.length, length, 2 * cell / 2048);  // to a unit
    }
    ++straight;
  }
  EXPECT_GT(straight, 400u);
}

TEST(Path, ZonesAreTheSameForAnyNumberOfWorkers) {
  const BakeConfig config{.cell = 0.5, .resolution = 0.1, .zone = 32};
  Context context;
  const auto world = bake_world(test::builtin({.name = "city", .size = 250}), config, context);
  ASSERT_TRUE(world);
  std::vector<double> lengths;
  for (const int32_t workers : {1, 2, 7}) {
    auto made = path::MeshFinder::create(
        *world, {.workers = workers, .speedup = PathSpeedup::kZones}, context);
    ASSERT_TRUE(made);
    Path path;
    for (uint64_t n = 0; n < 40; ++n) {
      made->find(world->random_place(0, 6, 2 * n), world->random_place(0, 6, 2 * n + 1), path);
      if (workers == 1) lengths.push_back(path.length);
      EXPECT_EQ(path.length, lengths[n]) << workers << " workers, pair " << n;
    }
  }
}

TEST(Path, StopsWhenCancelled) {
  const World world = builtin({.name = "garage", .size = 45, .levels = 3}, 0.2);
  Context context;
  auto over_zones = path::MeshFinder::create(world, {.speedup = PathSpeedup::kZones}, context);
  auto live = path::GroundFinder::create(world, {});
  ASSERT_TRUE(over_zones && live);
  path::MeshFinder search = finder(world, 0);
  std::atomic<bool> stop{true}, go{false};
  uint64_t stopped = 0;
  Path whole, path;
  for (uint64_t n = 0; n < 40; ++n) {
    SCOPED_TRACE(testing::Message() << "pair " << n);
    const Place from = world.random_place(0, 5, 2 * n), to = world.random_place(0, 5, 2 * n + 1);
    search.find(from, to, whole);
    search.find(from, to, path, {UINT64_MAX, &go});
    EXPECT_EQ(path.end, whole.end);
    EXPECT_EQ(path.length, whole.length);
    search.find(from, to, path, {UINT64_MAX, &stop});
    // A goal in the start's own rectangle is not searched for.
    EXPECT_TRUE(path.end == PathEnd::kBudgetExhausted || whole.nodes == 0);
    stopped += path.end == PathEnd::kBudgetExhausted;
    over_zones->find(from, to, path, {UINT64_MAX, &stop});
    EXPECT_TRUE(path.end == PathEnd::kBudgetExhausted || path.nodes <= 1);
    live->find(from, to, whole);
    live->find(from, to, path, {UINT64_MAX, &go});
    EXPECT_EQ(path.end, whole.end);
    EXPECT_EQ(path.length, whole.length);
    live->find(from, to, path, {UINT64_MAX, &stop});
    EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
    live->find(from, to, path, {5, &go});
    EXPECT_TRUE(path.end == PathEnd::kBudgetExhausted || path.nodes <= 5);
  }
  EXPECT_GT(stopped, 20u);
}

TEST(Path, SaysWhyThereIsNone) {
  const World world = bake(worlds::doorway(0.45), 0.1, {AvatarClass{}});
  path::MeshFinder paths = finder(world, 0);
  Path path;
  const Place left = world.find_place(0, {1, 0, 3}, 0.5);
  ASSERT_TRUE(left);
  paths.find(left, left, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(path.length, 0);
  paths.find(Place{}, left, path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace);
  paths.find(left, {{1e9, 0, 1}, 1}, path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace);
  paths.find(left, {{std::nan(""), 0, 1}, 1}, path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace);
  paths.find({left.position, 4000000000u}, left, path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace);
  const World maze = builtin({.name = "maze", .size = 30, .levels = 1}, 0.1);
  path::MeshFinder through = finder(maze, 0);
  const Place from = maze.random_place(0, 1, 1), to = maze.random_place(0, 1, 2);
  ASSERT_TRUE(from && to);
  through.find(from, to, path, 3);
  EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
  through.find(from, to, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  path::MeshFinder copy = through;
  Path again;
  copy.find(from, to, again);
  EXPECT_EQ(again.length, path.length);
  path::MeshFinder moved = std::move(copy);
  copy = through;
  copy.find(from, to, again);
  EXPECT_EQ(again.length, path.length);
  Context context;
  EXPECT_FALSE(path::MeshFinder::create(world, {.avatar_class = 1}, context));
  EXPECT_FALSE(path::MeshFinder::create(World{}, {}, context));
  context.cancel = true;
  EXPECT_FALSE(path::MeshFinder::create(world, {}, context));
}

}  // namespace
}  // namespace throng
