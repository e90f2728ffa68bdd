// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <type_traits>
#include <utility>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "throng/path.h"

// Costs of area kinds that the bake gave: every finder knows them, whether edits add areas or not.
namespace throng {
namespace {

constexpr double kWide = 40, kDeep = 20;  // [m]
constexpr uint8_t kLawn = 7;

// A floor of two zones with a lawn, around whose far side one can walk.
bool is_lawn(double x, double z) { return x > 16 && x < 24 && z < 14; }

World floor_with_lawn() {
  Scene scene;
  const auto add = [&](double x0, double z0, double x1, double z1, AreaKind kind) {
    scene.add_quad({x0, 0, z0}, {x0, 0, z1}, {x1, 0, z1}, {x1, 0, z0}, kind);
  };
  add(0, 0, 16, kDeep, kAreaWalkable);
  add(16, 0, 24, 14, kLawn);
  add(16, 14, 24, kDeep, kAreaWalkable);
  add(24, 0, kWide, kDeep, kAreaWalkable);
  return test::bake(scene, 0.25);
}

template <class T>
T need(Result<T> made) {
  EXPECT_TRUE(made) << made.error().message;
  if constexpr (!std::is_void_v<T>) return *std::move(made);
}

// Of a straight line, sampled.
double cost_of_line(Vec3d from, Vec3d to, double lawn) {
  const double far = std::hypot(to.x - from.x, to.z - from.z);
  if (far == 0) return 0;
  constexpr int kSamples = 256;
  double sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double t = (i + 0.5) / kSamples;
    const bool on_lawn = is_lawn(from.x + t * (to.x - from.x), from.z + t * (to.z - from.z));
    sum += on_lawn ? lawn : 1;
  }
  return far * sum / kSamples;
}

// Dijkstra's search over points half a metre apart, each joined to 16 around it: at most 3 % above
// the cheapest path. Ends are such points.
double cheapest(Vec3d from, Vec3d to, double lawn) {
  constexpr double kStep = 0.5;
  constexpr int kColumns = 77, kRows = 37;  // from 1 m to 1 m before the far sides
  const auto number = [](Vec3d p) {
    return static_cast<int>(std::lround((p.z - 1) / kStep)) * kColumns +
           static_cast<int>(std::lround((p.x - 1) / kStep));
  };
  const auto at = [](int n) {
    return Vec3d{1 + n % kColumns * kStep, 0, 1 + n / kColumns * kStep};
  };
  const std::vector<std::pair<int, int>> around{{1, 0}, {1, 1}, {0, 1}, {1, 2}, {2, 1}};
  std::vector<double> cost(kColumns * kRows, std::numeric_limits<double>::infinity());
  std::priority_queue<std::pair<double, int>> open;  // negative costs
  cost[static_cast<size_t>(number(from))] = 0;
  open.push({0, number(from)});
  while (!open.empty()) {
    const auto [negative, n] = open.top();
    open.pop();
    if (n == number(to)) return -negative;
    if (-negative > cost[static_cast<size_t>(n)]) continue;
    for (const auto& [dx, dz] : around) {
      for (int turn = 0; turn < 4; ++turn) {
        const int ux = turn % 2 == 0 ? dx : -dz, uz = turn % 2 == 0 ? dz : dx;
        const int x = n % kColumns + (turn < 2 ? ux : -ux);
        const int z = n / kColumns + (turn < 2 ? uz : -uz);
        if (x < 0 || x >= kColumns || z < 0 || z >= kRows) continue;
        const int next = z * kColumns + x;
        const double there = -negative + cost_of_line(at(n), at(next), lawn);
        if (there >= cost[static_cast<size_t>(next)]) continue;
        cost[static_cast<size_t>(next)] = there;
        open.push({-there, next});
      }
    }
  }
  return std::numeric_limits<double>::infinity();
}

struct Finders {
  explicit Finders(const World& world) {
    Context context;
    for (const PathSpeedup speedup :
         {PathSpeedup::kOnDemand, PathSpeedup::kNone, PathSpeedup::kLabels, PathSpeedup::kZones}) {
      all.push_back(need(PathFinder::create(world, {.speedup = speedup, .edits = edits}, context)));
    }
  }
  Edits edits;
  std::vector<PathFinder> all;  // the first has nothing that was made before the costs
};

PathQuery across() { return {.from = Vec3d{10, 0, 4}, .to = Vec3d{30, 0, 4}}; }

double farthest_z(const Path& path) {
  double most = 0;
  for (const Place& point : path.points) most = std::max(most, point.position.z);
  return most;
}

TEST(BakedCosts, AllFindersLeadAroundGroundThatCostsMoreWithoutAnyArea) {
  const World world = floor_with_lawn();
  Finders finders(world);
  Path path, on_demand;
  for (PathFinder& finder : finders.all) {
    finder.find(across(), path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_NEAR(path.length, 20, 1e-6) << "a metre costs one";
  }
  need(finders.edits.set_area_cost(kLawn, 5));
  const double around = 2 * std::hypot(6, 10) + 8;
  finders.all[0].find(across(), on_demand);
  EXPECT_NEAR(on_demand.cost, around, 1);
  for (PathFinder& finder : finders.all) {
    finder.find(across(), path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_NEAR(path.cost, on_demand.cost, 0.05);
    EXPECT_GT(farthest_z(path), 13);
    finder.begin(across());
    while (!finder.advance(50, path)) continue;
    EXPECT_NEAR(path.cost, on_demand.cost, 0.05);
    Context context;
    const Place goal = world.find_place(0, {30, 0, 4}, 0.5);
    FlowField field = need(FlowField::create(finder, {&goal, 1}, {}, context));
    EXPECT_NEAR(field.distance(world.find_place(0, {10, 0, 4}, 0.5)), around, 0.1 * around);
  }
  need(finders.edits.set_area_cost(kLawn, 1));
  for (PathFinder& finder : finders.all) {
    finder.find(across(), path);
    EXPECT_NEAR(path.length, 20, 1e-6) << "and one again";
  }
}

TEST(BakedCosts, PathsCostWhatASearchOfPointsFinds) {
  const World world = floor_with_lawn();
  Finders finders(world);
  const auto on_grid = [](uint64_t n, uint64_t draw, double low, double high) {
    return low + std::floor(random_unit(3, n, draw) * (high - low) * 2) / 2;
  };
  uint64_t over_lawn = 0;
  for (uint64_t n = 0; n < 12; ++n) {
    const double lawn = n % 3 == 0 ? 0.4 : n % 3 == 1 ? 1.3 : 6;
    need(finders.edits.set_area_cost(kLawn, lawn));
    const Vec3d from{on_grid(n, 0, 2, 14), 0, on_grid(n, 1, 2, 18)};
    const Vec3d to{on_grid(n, 2, 18, 38), 0, on_grid(n, 3, 2, 18)};
    const double found = cheapest(from, to, lawn);
    for (PathFinder& finder : finders.all) {
      Path path;
      finder.find({.from = from, .to = to}, path);
      ASSERT_EQ(path.end, PathEnd::kReached);
      double cost = 0;
      for (size_t i = 1; i < path.points.size(); ++i) {
        cost += cost_of_line(path.points[i - 1].position, path.points[i].position, lawn);
      }
      // Cells beside a border are of one kind as a whole.
      EXPECT_NEAR(path.cost, cost, 0.05 * cost + 1) << n;
      EXPECT_LE(path.cost, found * 1.06 + 1) << n;
      EXPECT_GE(path.cost, found / 1.03 - 1) << n;
      over_lawn += path.cost > path.length * 1.02 || path.cost < path.length * 0.98;
    }
  }
  EXPECT_GT(over_lawn, 8u);
}

TEST(BakedCosts, ClosedKindsAreNoPlacesAndOtherKindsChangeNothing) {
  const World world = floor_with_lawn();
  Finders finders(world);
  Path before, path;
  for (PathFinder& finder : finders.all) {
    need(finders.edits.set_area_cost(kLawn, 1));
    finder.find(across(), before);
    need(finders.edits.set_area_cost(kLawn + 1, 9));  // none of the ground
    finder.find(across(), path);
    EXPECT_NEAR(path.length, before.length, 1e-6);
    need(finders.edits.set_area_cost(kLawn, std::numeric_limits<double>::infinity()));
    EXPECT_FALSE(finder.is_free(Vec3d{20, 0, 4}));
    finder.find({.from = Vec3d{10, 0, 4}, .to = Vec3d{20, 0, 4}}, path);
    EXPECT_EQ(path.end, PathEnd::kNoPlace);
    finder.find(across(), path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_GT(farthest_z(path), 13);
    EXPECT_NEAR(path.cost, path.length, 1e-6);
    // Where the lawn is all that could be crossed.
    const EditId wall = need(finders.edits.add_obstacle(Prism::box({16, 0, 13.5}, {24, 2, 21})));
    PathQuery query = across();
    query.nearest = true;
    finder.find(query, path);
    EXPECT_EQ(path.end, PathEnd::kUnreachable);
    EXPECT_EQ(path.blocked_by, Blocker::kClosed);
    EXPECT_EQ(path.blocked_by_edit, 0u) << "no edit gave it the kind";
    EXPECT_TRUE(finders.edits.remove(wall));
  }
}

}  // namespace
}  // namespace throng
