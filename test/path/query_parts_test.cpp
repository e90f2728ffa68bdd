// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "throng/path.h"

// Queries in parts: for slices of any size they find what a query in one go finds.
namespace throng {
namespace {

using test::bake;
using test::builtin;

constexpr int32_t kAdult = 0, kFlyer = 1, kClimber = 2;

template <class T>
T need(Result<T> made) {
  EXPECT_TRUE(made) << made.error().message;
  if constexpr (!std::is_void_v<T>) return *std::move(made);
}

std::vector<AvatarClass> classes() {
  return {{.name = "adult"},
          flyer_class(),
          {.name = "climber", .height = 1.0, .radius = 0.3, .climb_slope = 180, .max_drop = 4}};
}

// Two halls; through the wall between them one can walk but not fly.
Scene two_halls() {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 8}, {20, 0, 8}, {20, 0, 0});
  for (const double x : {0.0, 19.8}) scene.add_box({x, -0.1, 0}, {x + 0.2, 6, 8});
  scene.add_box({9.8, -0.1, 0}, {10, 6, 3.45});
  scene.add_box({9.8, -0.1, 4.55}, {10, 6, 8.0});
  scene.add_box({9.8, 2, 3}, {10, 6, 5});
  scene.add_box({0, -0.1, 0}, {20, 6, 0.2});
  scene.add_box({0, -0.1, 7.8}, {20, 6, 8});
  scene.add_box({0, 5.8, 0}, {20, 6, 8});
  return scene;
}

struct Stage {
  explicit Stage(Scene of) : scene(std::move(of)) {}

  Scene scene;
  World world = bake(scene, 0.25, classes());
  Context context;
  Nodes nodes = need(Nodes::create(world, scene, {}, context));
  Edits edits;

  [[nodiscard]] PathFinder finder(int32_t avatar_class) {
    PathConfig config{.avatar_class = avatar_class, .nodes = nodes, .edits = edits};
    if (avatar_class == kAdult) config.speedup = PathSpeedup::kOnDemand;
    return need(PathFinder::create(world, config, context));
  }
  // In the air, on surfaces or on the ground, as the class moves.
  [[nodiscard]] PathPoint end(PathFinder& finder, int32_t avatar_class, uint64_t n) const {
    if (avatar_class == kClimber) return nodes.random_place(kClimber, 5, n);
    const Place place = world.random_place(avatar_class, 5, n);
    if (avatar_class == kFlyer && n % 3 != 0) return *finder.random_point(5, n);
    return place.position;
  }
  [[nodiscard]] PathQuery query(PathFinder& finder, int32_t avatar_class, uint64_t n) const {
    return {.from = end(finder, avatar_class, 2 * n),
            .to = end(finder, avatar_class, 5 * n + 1),
            .nearest = n % 2 == 0};
  }
  // A crate, a wall or a slab beside some place.
  Prism prism(uint64_t n) const {
    const Vec3d at = world.random_place(kAdult, 8, n).position;
    const double side = n % 3 == 0 ? 4 : 0.6, high = n % 2 == 0 ? 1.5 : 8;
    return Prism::box(at - Vec3d{0.3, 0.2, side}, at + Vec3d{0.3, high, side});
  }
};

void expect_same(const Path& a, const Path& b) {
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.spent, b.spent);
  EXPECT_EQ(a.blocked_by, b.blocked_by);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.searched_cost, b.searched_cost);
  EXPECT_EQ(a.segments, b.segments);
  EXPECT_EQ(a.corridor, b.corridor);
  EXPECT_EQ(a.links.size(), b.links.size());
  EXPECT_EQ(a.node_places.size(), b.node_places.size());
  ASSERT_EQ(a.points.size(), b.points.size());
  for (size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(length(a.points[i].position - b.points[i].position), 0);
    EXPECT_EQ(a.points[i].level1, b.points[i].level1);
  }
}

// To the end of a query that has begun, and expanded so many nodes. Counts the calls, and what each
// expands.
uint64_t finish(PathFinder& finder, uint64_t slice, Path& path, uint64_t before = 0) {
  uint64_t calls = 1;
  for (; !finder.advance(slice, path); ++calls) {
    EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
    EXPECT_EQ(path.spent, SpentBudget::kNodes);
    EXPECT_TRUE(path.points.empty());
    EXPECT_EQ(path.nodes, before + slice);
    before = path.nodes;
  }
  return calls;
}

TEST(QueryParts, FindTheSameForSlicesOfAnySize) {
  uint64_t reached = 0, unreachable = 0, many = 0;
  for (const Scene& scene : {builtin({.name = "garage", .size = 45, .levels = 2}), two_halls()}) {
    Stage s(scene);
    for (const int32_t c : {kAdult, kFlyer, kClimber}) {
      PathFinder finder = s.finder(c);
      Path whole, parts;
      for (uint64_t n = 0; n < 14; ++n) {
        // From the middle on with obstacles.
        if (n == 7) {
          for (uint64_t i = 0; i < 12; ++i) need(s.edits.add_obstacle(s.prism(i)));
        }
        const PathQuery query = s.query(finder, c, n);
        finder.find(query, whole);
        reached += whole.end == PathEnd::kReached;
        unreachable += whole.end == PathEnd::kUnreachable;
        for (const uint64_t slice : {uint64_t{1}, uint64_t{7}, uint64_t{100}, UINT64_MAX}) {
          finder.begin(query);
          const uint64_t calls = finish(finder, slice, parts);
          many += calls > 3;
          if (slice == UINT64_MAX) {
            EXPECT_EQ(calls, 1u);
          }
          SCOPED_TRACE(testing::Message() << "class " << c << ", query " << n << ", " << slice);
          expect_same(whole, parts);
          if (slice != UINT64_MAX) {
            EXPECT_LE(whole.nodes, calls * slice);
          }
        }
      }
    }
  }
  EXPECT_GT(reached, 20u);
  EXPECT_GT(unreachable, 0u);
  EXPECT_GT(many, 50u);
}

TEST(QueryParts, AnEditOfWhatTheyMayHaveSeenMakesThemBeginAgain) {
  Stage s(builtin({.name = "garage", .size = 45, .levels = 2}));
  for (const int32_t c : {kAdult, kFlyer, kClimber}) {
    PathFinder finder = s.finder(c), other = s.finder(c);
    Path whole, parts;
    uint64_t again = 0;
    for (uint64_t n = 0; n < 8; ++n) {
      const PathQuery query = s.query(finder, c, n);
      finder.begin(query);
      const bool ended = finder.advance(2 + n, parts);
      const EditId edit = need(s.edits.add_obstacle(s.prism(40 + n)));
      if (ended) finder.begin(query);
      if (!finder.advance(3, parts)) {
        // What was expanded before does not count, if it could have met the obstacle.
        EXPECT_TRUE(parts.nodes == 3 || parts.nodes == 5 + n) << parts.nodes;
        again += parts.nodes == 3 && !ended;
        finish(finder, 11, parts, parts.nodes);
      }
      other.find(query, whole);
      expect_same(whole, parts);
      // And when it goes.
      finder.begin(query);
      if (!finder.advance(4, parts)) {
        EXPECT_TRUE(s.edits.remove(edit));
        if (!finder.advance(50, parts)) finish(finder, 50, parts, parts.nodes);
        other.find(query, whole);
        expect_same(whole, parts);
      }
    }
    EXPECT_GT(again, 0u) << c;
  }
}

// Carts, and crates where nothing can stand or fly, that move before each call. A look-up makes the
// finder follow them. Flyers have walked before, so they know ground with edits.
TEST(QueryParts, EditsThatDoNotBearOnThemDoNotDisturbThem) {
  Stage s(builtin({.name = "garage", .size = 45, .levels = 2}));
  const auto cart_at = [](double x) { return Prism::box({x, -1, 1}, {x + 1, 9, 40}); };
  const auto far_at = [](double x) { return Prism::box({x, 900, 1}, {x + 1, 901, 40}); };
  const EditId cart = need(s.edits.add_obstacle(cart_at(5), ObstacleKind::kKinematic));
  const EditId far = need(s.edits.add_obstacle(far_at(5)));
  need(s.edits.add_obstacle(s.prism(1)));
  for (const int32_t c : {kAdult, kFlyer, kClimber}) {
    PathFinder finder = s.finder(c);
    Path whole, parts;
    uint64_t many = 0, walks = 0;
    for (uint64_t n = 0; n < 20 && c == kFlyer; ++n) {
      finder.find({.from = s.world.random_place(c, 6, 2 * n).position,
                   .to = s.world.random_place(c, 6, 2 * n + 1).position},
                  whole);
      walks += std::count(whole.segments.begin(), whole.segments.end(), SegmentKind::kWalk) > 0;
    }
    EXPECT_TRUE(c != kFlyer || walks > 0);
    for (uint64_t n = 0; n < 10; ++n) {
      const PathQuery query = s.query(finder, c, n);
      finder.find(query, whole);
      finder.begin(query);
      const uint64_t calls = finish(finder, 3, parts);
      finder.begin(query);
      uint64_t moved = 0;
      for (bool ended = false; !ended && moved <= calls; ++moved) {
        const double x = 5 + static_cast<double>(moved % 30);
        need(s.edits.move_obstacle(cart, cart_at(x)));
        need(s.edits.move_obstacle(far, far_at(x)));
        static_cast<void>(finder.is_free(query.to));
        ended = finder.advance(3, parts);
      }
      EXPECT_EQ(moved, calls) << "class " << c << ", query " << n;
      expect_same(whole, parts);
      many += calls > 5;
    }
    EXPECT_GT(many, 2u) << c;
  }
}

// Areas while all kinds cost 1, and costs of a kind that no place has: changed before each call.
TEST(QueryParts, CostsThatNoGroundHasDoNotDisturbThem) {
  Stage s(builtin({.name = "garage", .size = 45, .levels = 2}));
  const EditId area = need(s.edits.add_area(Prism::box({-1, -9, -1}, {60, 20, 60}), 3));
  need(s.edits.add_area(Prism::box({-1, 900, -1}, {60, 901, 60}), 9));
  for (const int32_t c : {kAdult, kClimber}) {
    // The baked mesh of adults knows which kinds there are.
    PathFinder finder = need(PathFinder::create(
        s.world, {.avatar_class = c, .nodes = s.nodes, .edits = s.edits}, s.context));
    Path quiet, parts;
    for (const bool is_cost : {false, true}) {
      uint64_t many = 0;
      for (uint64_t n = 0; n < 10; ++n) {
        const PathQuery query = s.query(finder, c, n);
        finder.begin(query);
        uint64_t calls = 1, edited = 0;
        while (!finder.advance(3, quiet)) ++calls;
        finder.begin(query);
        for (bool ended = false; !ended && edited <= calls; ++edited) {
          if (is_cost) {
            need(s.edits.set_area_cost(9, edited % 2 == 0 ? 2 : 3));
          } else {
            EXPECT_TRUE(s.edits.set_active(area, edited % 2 != 0));
          }
          ended = finder.advance(3, parts);
        }
        EXPECT_EQ(edited, calls) << "class " << c << ", query " << n << ", costs " << is_cost;
        expect_same(quiet, parts);
        many += calls > 5;
      }
      EXPECT_GT(many, 2u) << c;
    }
    // Costs of ground do.
    EXPECT_TRUE(s.edits.set_active(area, true));
    uint64_t again = 0;
    for (uint64_t n = 0; n < 10; ++n) {
      finder.begin(s.query(finder, c, n));
      if (finder.advance(2, parts)) continue;
      need(s.edits.set_area_cost(3, 5));
      if (!finder.advance(1, parts)) {
        EXPECT_EQ(parts.nodes, 1u) << "class " << c << ", query " << n;
        ++again;
      }
      need(s.edits.set_area_cost(3, 1));
    }
    EXPECT_GT(again, 0u) << c;
    need(s.edits.set_area_cost(9, 1));
  }
}

// A crate beside the start moves before each call. After four restarts the query does not follow it
// any more, and finds the path of that time; look-ups in between do not make it begin again either.
TEST(QueryParts, EndWhateverMovesInEachFrame) {
  Stage s(two_halls());
  const auto corner_of = [](uint64_t n) {
    return Vec3d{3 + 0.3 * static_cast<double>(n % 8), -0.1, 5};
  };
  const auto crate_at = [&](uint64_t n) {
    return Prism::box(corner_of(n), corner_of(n) + Vec3d{0.8, 2.6, 1});
  };
  for (const int32_t c : {kAdult, kFlyer, kClimber}) {
    for (const bool looks_up : {false, true}) {
      SCOPED_TRACE(testing::Message() << "class " << c << (looks_up ? ", looks up" : ""));
      const EditId crate = need(s.edits.add_obstacle(crate_at(0)));
      PathFinder finder = s.finder(c), other = s.finder(c);
      // The door between the halls is too narrow for climbers.
      const PathQuery query{
          .from = Vec3d{2, 0, 6}, .to = Vec3d{c == kClimber ? 8.0 : 18.0, 0, 6}, .nearest = true};
      Path whole, parts;
      finder.begin(query);
      uint64_t calls = 1, restarts = 0;
      for (bool ended = finder.advance(1, parts); !ended; ++calls) {
        ASSERT_LT(calls, 100'000u);
        need(s.edits.move_obstacle(crate, crate_at(calls)));
        if (restarts < 4) other.find(query, whole);
        if (looks_up) {
          ASSERT_TRUE(finder.is_free(query.to));
        }
        const uint64_t before = parts.nodes;
        ended = finder.advance(1, parts);
        restarts += !ended && parts.nodes <= before;
      }
      EXPECT_EQ(restarts, 4u);
      EXPECT_EQ(parts.end, PathEnd::kReached);
      expect_same(whole, parts);
      // From now on it knows where the crate is.
      const Vec3d corner = corner_of(calls - 1);
      const Vec3d inside{corner.x + 0.4, 0, corner.z + 0.5};
      EXPECT_EQ(finder.is_free(inside), other.is_free(inside));
      EXPECT_TRUE(c == kClimber || !finder.is_free(inside));
      finder.find(query, parts);
      other.find(query, whole);
      expect_same(whole, parts);
      EXPECT_TRUE(s.edits.remove(crate));
    }
  }
}

TEST(QueryParts, OtherQueriesDoNotDisturbTheResult) {
  Stage s(builtin({.name = "garage", .size = 45, .levels = 2}));
  for (const int32_t c : {kAdult, kFlyer, kClimber}) {
    PathFinder finder = s.finder(c), other = s.finder(c);
    Path whole, parts, path;
    for (uint64_t n = 0; n < 6; ++n) {
      const PathQuery query = s.query(finder, c, n), between = s.query(finder, c, n + 20);
      other.find(query, whole);
      // Another query in one go.
      finder.begin(query);
      if (!finder.advance(5, parts)) {
        finder.find(between, path);
        finish(finder, 9, parts);
      }
      expect_same(whole, parts);
      other.find(between, path);
      finder.find(between, parts);
      expect_same(path, parts);
      // Another one in parts takes its place.
      finder.begin(between);
      static_cast<void>(finder.advance(2, path));
      finder.begin(query);
      finish(finder, 9, parts);
      expect_same(whole, parts);
      // What does not search, and a copy.
      finder.begin(query);
      if (!finder.advance(5, parts)) {
        EXPECT_TRUE(finder.is_free(s.end(finder, c, n)));
        PathFinder copy = finder;
        finish(copy, 13, parts);
        expect_same(whole, parts);
        finish(finder, 9, parts, 5);
        expect_same(whole, parts);
      }
    }
  }
}

TEST(QueryParts, KeepTheBudgetOfTheWholeQueryAndCanBeCancelled) {
  Stage s(builtin({.name = "garage", .size = 45, .levels = 2}));
  for (const int32_t c : {kAdult, kFlyer, kClimber}) {
    PathFinder finder = s.finder(c);
    Path whole, parts;
    uint64_t exhausted = 0, cancelled = 0;
    for (uint64_t n = 0; n < 8; ++n) {
      PathQuery query = s.query(finder, c, n);
      query.budget = {12};
      finder.find(query, whole);
      finder.begin(query);
      finish(finder, 5, parts);
      exhausted += whole.end == PathEnd::kBudgetExhausted;
      EXPECT_EQ(parts.end, whole.end);
      EXPECT_EQ(parts.spent, whole.spent);
      std::atomic<bool> cancel = false;
      query.budget = {UINT64_MAX, &cancel};
      finder.begin(query);
      if (finder.advance(3, parts)) continue;
      cancel = true;
      ASSERT_TRUE(finder.advance(3, parts));
      EXPECT_EQ(parts.end, PathEnd::kBudgetExhausted);
      EXPECT_EQ(parts.spent, SpentBudget::kCancelled);
      EXPECT_EQ(parts.nodes, 3u);
      EXPECT_TRUE(parts.points.empty());
      ++cancelled;
    }
    EXPECT_GT(exhausted, 0u) << c;
    EXPECT_GT(cancelled, 0u) << c;
  }
}

// Flights and walks take from one budget. What a query expands is counted by calls of a node each;
// floods to a take-off take further calls, and nothing of the budget.
TEST(QueryParts, InTheAirTheBudgetIsThatOfAllItsSearches) {
  uint64_t by_many = 0, exhausted = 0, queries = 0, flooded = 0;
  for (const Scene& scene : {builtin({.name = "garage", .size = 45, .levels = 2}), two_halls()}) {
    Stage s(scene);
    PathFinder finder = s.finder(kFlyer);
    Path whole, part;
    for (uint64_t n = 0; n < 14; ++n, ++queries) {
      if (n == 7) {
        for (uint64_t i = 0; i < 12; ++i) need(s.edits.add_obstacle(s.prism(i)));
      }
      SCOPED_TRACE(n);
      PathQuery query = s.query(finder, kFlyer, n);
      finder.find(query, whole);
      finder.begin(query);
      const uint64_t calls = finish(finder, 1, part);
      EXPECT_LE(whole.nodes, calls);
      const uint64_t floods = calls - whole.nodes;
      flooded += floods > 1;
      query.budget.max_nodes = whole.nodes + 1;
      finder.find(query, part);
      expect_same(whole, part);
      for (const uint64_t less : {whole.nodes - whole.nodes / 4, whole.nodes / 2, uint64_t{0}}) {
        query.budget.max_nodes = less;
        finder.find(query, part);
        EXPECT_LE(part.nodes, less);
        EXPECT_TRUE(part.end != PathEnd::kBudgetExhausted || part.spent == SpentBudget::kNodes);
        exhausted += part.end == PathEnd::kBudgetExhausted;
        finder.begin(query);
        EXPECT_LE(finish(finder, 1, part), less + 1 + floods);
      }
      const bool walks =
          std::count(whole.segments.begin(), whole.segments.end(), SegmentKind::kWalk) > 0;
      const bool flies =
          std::count(whole.segments.begin(), whole.segments.end(), SegmentKind::kFly) > 0;
      by_many += walks && flies;
    }
  }
  EXPECT_GT(by_many, 0u);
  EXPECT_GT(exhausted, 10u);
  EXPECT_GT(flooded, 0u);
  EXPECT_LT(flooded, queries);
}

// The nearest point is looked for when the goal is known to be unreachable.
TEST(QueryParts, InTheAirACancelEndsTheSearchForTheNearestPoint) {
  Stage s(two_halls());
  // One wall closes the door, and one stands between the start and the nearest point.
  need(s.edits.add_obstacle(Prism::box({9.2, -0.1, 0}, {9.6, 6, 8})));
  need(s.edits.add_obstacle(Prism::box({5, -0.1, 0}, {5.3, 6, 4.5})));
  PathFinder finder = s.finder(kFlyer);
  std::atomic<bool> cancel = false;
  const PathQuery query{.from = Vec3d{2, 0, 2},
                        .to = Vec3d{17, 3, 3},
                        .nearest = true,
                        .budget = {UINT64_MAX, &cancel}};
  Path whole, path;
  finder.find(query, whole);
  ASSERT_EQ(whole.end, PathEnd::kUnreachable);
  ASSERT_FALSE(whole.points.empty());
  ASSERT_GT(whole.nodes, 3u);
  for (uint64_t after = 1; after < whole.nodes; after += 1 + whole.nodes / 50) {
    cancel = false;
    finder.begin(query);
    ASSERT_FALSE(finder.advance(after, path)) << after;
    cancel = true;
    ASSERT_TRUE(finder.advance(1000, path));
    EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
    EXPECT_EQ(path.spent, SpentBudget::kCancelled);
    EXPECT_EQ(path.nodes, after);
    EXPECT_TRUE(path.points.empty());
  }
  // In one go it looks as well.
  finder.find(query, path);
  EXPECT_EQ(path.spent, SpentBudget::kCancelled);
}

TEST(QueryParts, WithoutAQueryNothingIsFound) {
  Stage s(two_halls());
  for (const int32_t c : {kAdult, kFlyer, kClimber}) {
    PathFinder finder = s.finder(c);
    Path path;
    EXPECT_TRUE(finder.advance(10, path));
    EXPECT_EQ(path.end, PathEnd::kNoPlace);
    finder.begin({.from = Place{}, .to = Place{}});
    EXPECT_TRUE(finder.advance(10, path));
    EXPECT_EQ(path.end, PathEnd::kNoPlace);
    finder.begin({.from = Vec3d{1e6, 0, 0}, .to = Vec3d{1, 0, 1}});
    EXPECT_TRUE(finder.advance(0, path));
    EXPECT_EQ(path.end, PathEnd::kNoPlace);
    finder.begin(s.query(finder, c, 3));
    finish(finder, 1000, path);
    EXPECT_NE(path.end, PathEnd::kNoPlace);
    EXPECT_TRUE(finder.advance(10, path));
    EXPECT_EQ(path.end, PathEnd::kNoPlace) << "it has ended";
    EXPECT_TRUE(path.points.empty());
  }
}

}  // namespace
}  // namespace throng
