// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "path/air/flight_finder.h"
#include "path/edits/ground_finder.h"
#include "path/overlay/mesh_finder.h"
#include "path/overlay/node_finder.h"
#include "throng/path.h"
#include "worlds.h"

// One finder for all classes, and edits in one place: against the searches that it chooses from,
// and against finders that see only what is left of the edits.
namespace throng {
namespace {

using test::bake;

constexpr int32_t kAdult = 0, kFlyer = 1, kClimber = 2;

template <class T>
T need(Result<T> made) {
  EXPECT_TRUE(made) << made.error().message;
  if constexpr (!std::is_void_v<T>) return *std::move(made);
}

// A garage for classes that walk, fly and climb.
struct Stage {
  Scene scene = test::builtin({.name = "garage", .size = 45, .levels = 2});
  World world = bake(scene, 0.25,
                     {{.name = "adult"},
                      flyer_class(),
                      {.name = "climber", .height = 1.0, .radius = 0.3, .climb_slope = 180}});
  Context context;
  Nodes nodes = need(Nodes::create(world, scene, {}, context));

  PathFinder finder(PathConfig config) {
    config.nodes = nodes;
    return need(PathFinder::create(world, config, context));
  }
  [[nodiscard]] Place place(int32_t avatar_class, uint64_t n) const {
    return world.random_place(avatar_class, 7, n);
  }
};

void expect_same(const Path& a, const Path& b) {
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.blocked_by, b.blocked_by);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.segments, b.segments);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].position.x, b.points[i].position.x);
    EXPECT_EQ(a.points[i].position.y, b.points[i].position.y);
    EXPECT_EQ(a.points[i].position.z, b.points[i].position.z);
  }
}

TEST(PathFinder, SearchesAsTheClassMoves) {
  Stage s;
  path::MeshFinder mesh = need(path::MeshFinder::create(s.world, {}, s.context));
  path::NodeFinder nodes =
      need(path::NodeFinder::create(s.nodes, {.avatar_class = kClimber}, s.context));
  path::FlightFinder flight =
      need(path::FlightFinder::create(s.world, {.avatar_class = kFlyer}, s.context));
  PathFinder walks = s.finder({}), flies = s.finder({.avatar_class = kFlyer}),
             climbs = s.finder({.avatar_class = kClimber}),
             on_foot = s.finder({.avatar_class = kFlyer, .space = PathSpace::kGround});
  EXPECT_GT(walks.summary().corners, 0u);
  EXPECT_GT(flies.summary().boxes, 0u);
  EXPECT_GT(climbs.summary().blocks, 0u);
  Path path, other;
  for (uint64_t n = 0; n < 10; ++n) {
    const Place from = s.place(kAdult, 2 * n), to = s.place(kAdult, 2 * n + 1);
    walks.find({.from = from, .to = to}, path);
    mesh.find(from, to, other);
    expect_same(path, other);
    // By positions it is the same path.
    walks.find({.from = from.position, .to = to.position, .tolerance = 0.05}, path);
    expect_same(path, other);
    const Vec3d up = s.place(kFlyer, n).position, there = *flies.random_point(3, n);
    flies.find({.from = up, .to = there, .nearest = true}, path);
    flight.find({.from = up, .to = there, .nearest = true}, other);
    expect_same(path, other);
    EXPECT_EQ(flies.take_off(s.place(kFlyer, n)).has_value(),
              flight.take_off(s.place(kFlyer, n)).has_value());
    EXPECT_EQ(flies.landing(there).level1, flight.landing(there).level1);
    EXPECT_FALSE(walks.take_off(from));
    EXPECT_FALSE(walks.landing(there));
    on_foot.find(s.place(kFlyer, n), s.place(kFlyer, n + 1), path);
    for (const SegmentKind kind : path.segments) EXPECT_EQ(kind, SegmentKind::kWalk);
    const NodePlace on = s.nodes.random_place(kClimber, 1, 2 * n),
                    off = s.nodes.random_place(kClimber, 1, 2 * n + 1);
    climbs.find({.from = on, .to = off}, path);
    nodes.find(on, off, other);
    expect_same(path, other);
    if (n == 0) {
      for (const double spacing : {0.0, -1.0, std::nan("")}) {
        climbs.find({.from = on, .to = off, .spacing = spacing}, other);
        EXPECT_EQ(other.end, path.end);
      }
      walks.find({.from = from.position, .to = to.position, .tolerance = -1}, other);
      EXPECT_EQ(other.end, PathEnd::kNoPlace);
    }
    EXPECT_TRUE(climbs.is_free(on) && walks.is_free(from) && flies.is_free(there));
  }
}

TEST(PathFinder, LeadsToTheNearestPlaceIfAsked) {
  const World world = bake(worlds::doorway(0.2), 0.1);  // too narrow for an adult: two rooms
  Context context;
  PathFinder finder = need(PathFinder::create(world, {}, context));
  const Vec3d from{1, 0, 1}, to{7, 0, 5};
  Path path;
  finder.find({.from = from, .to = to}, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_TRUE(path.points.empty());
  EXPECT_EQ(path.nodes, 0u) << "components of the mesh differ: no search";
  finder.begin({.from = from, .to = to});
  while (!finder.advance(1000, path)) continue;
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_TRUE(path.points.empty());
  finder.find({.from = from, .to = to, .nearest = true}, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  ASSERT_FALSE(path.points.empty());
  EXPECT_LT(path.points.back().position.x, 4);
  EXPECT_EQ(path.blocked_by, Blocker::kNarrow);
  finder.find({.from = from, .to = Vec3d{100, 0, 0}}, path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace);
  finder.find({.from = from, .to = Place{}}, path);
  EXPECT_EQ(path.end, PathEnd::kNoPlace);
  EXPECT_FALSE(finder.is_free(Place{}));
  EXPECT_FALSE(finder.is_free(Vec3d{100, 0, 0}));
  EXPECT_FALSE(finder.find_node_place(from, 1)) << "there are no nodes";
}

// In a list with edits that are no longer there, and some that do not count on the ground.
TEST(PathFinder, NamesTheEditThatCutsAPath) {
  const World world = bake(worlds::doorway(1.2), 0.1);
  const Prism in_door = Prism::box({3.95, 0, 2.3}, {4.05, 2, 3.7});
  for (const PathSpeedup speedup :
       {PathSpeedup::kNone, PathSpeedup::kLabels, PathSpeedup::kZones, PathSpeedup::kOnDemand}) {
    Edits edits;
    Context context;
    PathFinder finder =
        need(PathFinder::create(world, {.speedup = speedup, .edits = edits}, context));
    const PathQuery query{.from = Vec3d{2, 0, 3}, .to = Vec3d{6, 0, 3}, .nearest = true};
    const auto expect_blocked = [&](Blocker blocker, EditId edit) {
      Path path;
      finder.find(query, path);
      EXPECT_EQ(path.end, PathEnd::kUnreachable);
      EXPECT_EQ(path.blocked_by, blocker);
      EXPECT_EQ(path.blocked_by_edit, edit);
      finder.begin(query);
      while (!finder.advance(10, path)) EXPECT_EQ(path.blocked_by_edit, 0u);
      EXPECT_EQ(path.blocked_by, blocker);
      EXPECT_EQ(path.blocked_by_edit, edit);
    };
    const EditId crate = need(edits.add_obstacle(Prism::box({1, 0, 1}, {1.5, 1, 1.5})));
    need(edits.add_obstacle(in_door, ObstacleKind::kKinematic));
    const EditId door = need(edits.add_obstacle(Prism::box({6, 0, 5}, {6.5, 2, 5.5})));
    Path path;
    finder.find(query, path);
    EXPECT_EQ(path.end, PathEnd::kReached);
    EXPECT_TRUE(edits.remove(crate));
    need(edits.move_obstacle(door, in_door));
    expect_blocked(Blocker::kObstacle, door);
    // Nearer than the door: it is met first.
    need(edits.set_area_cost(9, std::numeric_limits<double>::infinity()));
    const EditId closed = need(edits.add_area(Prism::box({3, -1, -1}, {3.5, 1, 7}), 9));
    expect_blocked(Blocker::kClosed, closed);
    EXPECT_TRUE(edits.set_active(closed, false));
    expect_blocked(Blocker::kObstacle, door);
    EXPECT_TRUE(edits.set_active(door, false));
    finder.find(query, path);
    EXPECT_EQ(path.end, PathEnd::kReached);
    EXPECT_EQ(path.blocked_by, Blocker::kNone);
    EXPECT_EQ(path.blocked_by_edit, 0u);
    // Of areas that overlap the last one counts, and only where it is.
    EXPECT_TRUE(edits.set_active(closed, true));
    need(edits.add_area(Prism::box({3, -1, -1}, {3.5, 1, 2}), 8));
    const EditId last = need(edits.add_area(Prism::box({3.2, -1, -1}, {3.8, 1, 7}), 9));
    finder.find(query, path);
    EXPECT_EQ(path.end, PathEnd::kUnreachable);
    EXPECT_TRUE(edits.remove(closed));
    expect_blocked(Blocker::kClosed, last);
    // Ends on ground that is closed or under an obstacle are no places.
    finder.find({.from = Vec3d{2, 0, 3}, .to = Vec3d{3.5, 0, 3}}, path);
    EXPECT_EQ(path.end, PathEnd::kNoPlace);
    EXPECT_EQ(path.blocked_by_edit, 0u);
  }
}

// The wall of the bake comes before the obstacle.
TEST(PathFinder, NamesNoEditWhereABakedWallIsMetFirst) {
  const World world = bake(worlds::doorway(0.2), 0.1);  // too narrow for an adult: two rooms
  Edits edits;
  Context context;
  PathFinder finder = need(PathFinder::create(world, {.edits = edits}, context));
  need(edits.add_obstacle(Prism::box({5.5, 0, 2}, {6, 2, 4})));  // beyond the wall
  Path path;
  finder.find({.from = Vec3d{1, 0, 1}, .to = Vec3d{7, 0, 3}, .nearest = true}, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  EXPECT_EQ(path.blocked_by, Blocker::kNarrow);
  EXPECT_EQ(path.blocked_by_edit, 0u);
}

// Level ground alone, so that the nearest place of nodes is that of the ground: a floor, a crate,
// and a deck over a part of both.
struct LevelStage {
  Scene scene = [] {
    Scene made = worlds::flat(12);
    made.add_box({4, 0, 4}, {7, 1.5, 7});
    made.add_box({6, 3.5, 0}, {12, 3.8, 12});
    return made;
  }();
  World world = bake(
      scene, 0.25,
      {{.name = "adult"}, {.name = "climber", .height = 1.0, .radius = 0.3, .climb_slope = 180}});
  Context context;
  Nodes nodes = need(Nodes::create(world, scene, {}, context));
};

TEST(PathFinder, TheNodePlaceNearestInThreeDimensionsIsFound) {
  LevelStage s;
  PathFinder finder =
      need(PathFinder::create(s.world, {.avatar_class = 1, .nodes = s.nodes}, s.context));
  GroundQuery ground = need(GroundQuery::create(s.world, 1));
  uint64_t found = 0, none = 0;
  for (uint64_t n = 0; n < 3000; ++n) {
    const Vec3d at{random_unit(4, n, 0) * 18 - 3, random_unit(4, n, 1) * 6 - 1,
                   random_unit(4, n, 2) * 18 - 3};
    const double radius = random_unit(4, n, 3) * 3;
    const Place nearest = ground.nearest_place(at, 1000);
    ASSERT_TRUE(nearest);
    const double distance = length(nearest.position - at);
    if (std::fabs(distance - radius) < 0.002) continue;
    const NodePlace place = finder.find_node_place(at, radius);
    ASSERT_EQ(static_cast<bool>(place), distance < radius)
        << at.x << ' ' << at.y << ' ' << at.z << ", " << distance << " of " << radius;
    if (place) {
      EXPECT_NEAR(length(place.feet - at), distance, 0.002) << at.x << ' ' << at.y << ' ' << at.z;
      EXPECT_TRUE(finder.is_free(place));
    }
    ++(place ? found : none);
  }
  EXPECT_GT(found, 500u);
  EXPECT_GT(none, 500u);
}

TEST(PathFinder, ANodePlaceIsFoundBesideAnObstacle) {
  LevelStage s;
  Edits edits;
  const Prism crate = Prism::box({1, 0, 1}, {3, 1, 3});
  ASSERT_TRUE(edits.add_obstacle(crate));
  PathFinder finder = need(PathFinder::create(
      s.world, {.avatar_class = 1, .nodes = s.nodes, .edits = edits}, s.context));
  const NodePlace place = finder.find_node_place({2, 0, 2.5}, 3);
  ASSERT_TRUE(place);
  EXPECT_FALSE(crate.covers(place.feet.x, place.feet.z));
  EXPECT_GT(place.feet.z, 3.2) << "on the side that is nearer";
  EXPECT_LT(place.feet.z, 4.1);
  EXPECT_TRUE(finder.is_free(place));
  EXPECT_FALSE(finder.find_node_place({2, 0, 2}, 0.5)) << "all of it is blocked";
}

TEST(PathFinder, ANodePlaceOfNoPositionIsNowhere) {
  LevelStage s;
  PathFinder finder =
      need(PathFinder::create(s.world, {.avatar_class = 1, .nodes = s.nodes}, s.context));
  const double nan = std::nan(""), infinity = HUGE_VAL;
  const NodePlace place = s.nodes.random_place(1, 3, 4);
  ASSERT_TRUE(finder.find_node_place(place.feet, 0.01));
  EXPECT_FALSE(finder.find_node_place(place.feet, -1));
  EXPECT_FALSE(finder.find_node_place(place.feet, nan));
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_FALSE(finder.find_node_place({bad, 0, 0}, 5)) << bad;
    EXPECT_FALSE(finder.find_node_place({0, bad, 0}, infinity)) << bad;
    EXPECT_FALSE(finder.find_node_place({0, 0, bad}, 5)) << bad;
  }
  EXPECT_FALSE(finder.find_node_place({1e300, 0, -1e300}, 5));
  EXPECT_FALSE(finder.find_node_place({1000, 0, 0}, 900));
  EXPECT_TRUE(finder.find_node_place({1000, 0, 0}, 1000));
  EXPECT_TRUE(finder.find_node_place({5, 0, 5}, infinity));
}

TEST(PathFinder, RefusesWhatItsSpaceDoesNotHave) {
  const World world = bake(worlds::flat(6), 0.2);
  Context context;
  const auto refused = [&](const PathConfig& config, Errc code) {
    const auto made = PathFinder::create(world, config, context);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, code) << made.error().message;
  };
  refused({.avatar_class = 9}, Errc::kBadConfig);
  refused({.avatar_class = -1}, Errc::kBadConfig);
  refused({.slope_cost = -1}, Errc::kBadConfig);
  refused({.slope_cost = std::nan("")}, Errc::kBadConfig);
  refused({.slope_cost = 1, .speedup = PathSpeedup::kLabels}, Errc::kBadConfig);
  refused({.narrow_cost = 1}, Errc::kBadConfig);  // Only nodes promise a width or a height.
  refused({.low_cost = std::nan("")}, Errc::kBadConfig);
  for (const PathSpeedup speedup :
       {PathSpeedup::kNone, PathSpeedup::kLabels, PathSpeedup::kZones, PathSpeedup::kOnDemand}) {
    refused({.workers = -1, .speedup = speedup}, Errc::kBadConfig);
  }
  refused({.slope_cost = 1, .workers = -1}, Errc::kBadConfig);
  refused({.space = PathSpace::kAir}, Errc::kNotFound);
  EXPECT_FALSE(PathFinder::create(world, {.space = PathSpace::kNodes}, context)) << "no nodes";
  EXPECT_FALSE(PathFinder::create(World(), {}, context));
  context.cancel = true;
  refused({}, Errc::kCancelled);
}

TEST(PathFinder, InPartsItIsTheSamePath) {
  Stage s;
  for (const PathConfig& config :
       {PathConfig{.speedup = PathSpeedup::kOnDemand}, PathConfig{.slope_cost = 2},
        PathConfig{.avatar_class = kFlyer}, PathConfig{.avatar_class = kClimber}}) {
    PathFinder finder = s.finder(config);
    Path whole, parts;
    for (uint64_t n = 0; n < 6; ++n) {
      const PathQuery query{.from = s.place(config.avatar_class, n).position,
                            .to = s.place(config.avatar_class, n + 1).position,
                            .nearest = n % 2 == 0};
      finder.find(query, whole);
      finder.begin(query);
      while (!finder.advance(3, parts)) EXPECT_EQ(parts.end, PathEnd::kBudgetExhausted);
      expect_same(whole, parts);
    }
  }
}

// Random edits, among them thousands of a door: finders that have followed all along find what one
// does that sees the edits that are left for the first time.
TEST(Edits, AFinderThatFollowsFindsWhatANewOneFinds) {
  Stage s;
  constexpr uint64_t kSeed = 11;
  Edits edits;
  PathFinder walks = s.finder({.edits = edits}),
             labels = s.finder({.speedup = PathSpeedup::kLabels, .edits = edits}),
             flies = s.finder({.avatar_class = kFlyer, .edits = edits}),
             climbs = s.finder({.avatar_class = kClimber, .edits = edits});
  struct Put {
    EditId id;
    int kind;
    Prism prism;
    bool active = true;
  };
  std::vector<Put> put;
  Path path, other;
  uint64_t different = 0;
  for (uint64_t round = 0; round < 24; ++round) {
    for (uint64_t i = 0; i < 4; ++i) {
      const uint64_t n = 4 * round + i;
      const uint64_t what = random_below(kSeed, n, 0, put.size() < 4 ? 2 : 5);
      if (what < 2) {
        const Vec3d at = s.place(kAdult, 100 + n).position;
        const Prism prism = Prism::box(at - Vec3d{0.7, 0.1, 0.7}, at + Vec3d{0.7, 1.5, 0.7});
        const auto id = what == 0 ? edits.add_obstacle(prism) : edits.add_area(prism, 3);
        put.push_back({need(id), static_cast<int>(what), prism});
      } else {
        const size_t which = random_below(kSeed, n, 1, put.size());
        if (what == 2) {
          EXPECT_TRUE(edits.remove(put[which].id));
          EXPECT_FALSE(edits.set_active(put[which].id, true));
          put.erase(put.begin() + static_cast<ptrdiff_t>(which));
        } else {
          put[which].active = !put[which].active;
          EXPECT_TRUE(edits.set_active(put[which].id, put[which].active));
        }
      }
    }
    if (round == 8) need(edits.set_area_cost(3, 5));
    if (round == 12) {  // More than is kept of what has changed.
      for (int i = 0; i < 10000; ++i) EXPECT_TRUE(edits.set_active(put[0].id, i % 2 == 0));
      put[0].active = false;
    }
    Edits left;
    for (const Put& one : put) {
      const auto id = one.kind == 0 ? left.add_obstacle(one.prism) : left.add_area(one.prism, 3);
      need(id);
      if (!one.active) left.set_active(*id, false);
    }
    if (round >= 8) need(left.set_area_cost(3, 5));
    PathFinder new_walks = s.finder({.edits = left}),
               new_labels = s.finder({.speedup = PathSpeedup::kLabels, .edits = left}),
               new_flies = s.finder({.avatar_class = kFlyer, .edits = left}),
               new_climbs = s.finder({.avatar_class = kClimber, .edits = left});
    const auto compare = [&](PathFinder& follows, PathFinder& begins, const PathQuery& query) {
      follows.find(query, path);
      begins.find(query, other);
      expect_same(path, other);
    };
    PathFinder plain = s.finder({});
    for (uint64_t n = 4 * round; n < 4 * round + 4; ++n) {
      const PathQuery query{
          .from = s.place(kAdult, n), .to = s.place(kAdult, n + 1), .nearest = n % 2 == 0};
      compare(labels, new_labels, query);
      compare(walks, new_walks, query);
      plain.find(query, other);
      different += path.length != other.length ? 1 : 0;
      compare(flies, new_flies, {.from = *new_flies.random_point(3, n), .to = s.place(kFlyer, n)});
      compare(climbs, new_climbs,
              {.from = s.nodes.random_place(kClimber, 1, n),
               .to = s.nodes.random_place(kClimber, 1, n + 1)});
    }
    // A copy follows by itself.
    if (round % 8 == 5) walks = PathFinder(walks);
  }
  EXPECT_GT(different, 10u) << "the edits change no path";
}

// With crates in the world, labels and searches of the whole mesh find the same as what is made on
// demand: paths that no crate cuts are kept.
TEST(Edits, WithCratesEverySpeedupFindsTheShortest) {
  const World world = bake(test::builtin({.name = "garage"}), 0.2);
  Context context;
  Edits edits;
  PathFinder on_demand =
      need(PathFinder::create(world, {.speedup = PathSpeedup::kOnDemand, .edits = edits}, context));
  PathFinder by_mesh = need(PathFinder::create(world, {.edits = edits}, context));
  PathFinder by_labels =
      need(PathFinder::create(world, {.speedup = PathSpeedup::kLabels, .edits = edits}, context));
  PathFinder bare = need(PathFinder::create(world, {}, context));
  Path path, other, best;
  uint64_t reached = 0, led_around = 0, blocked = 0;
  for (uint64_t n = 0; n < 120; ++n) {
    const Vec3d at = world.random_place(0, 5, n).position;
    const double half = 0.3 + 0.1 * static_cast<double>(n % 20);
    const auto crate = edits.add_obstacle(
        Prism::box({at.x - half, at.y, at.z - 0.4}, {at.x + half, at.y + 1, at.z + 0.4}));
    ASSERT_TRUE(crate);
    if (n % 4 == 3) {
      ASSERT_TRUE(edits.remove(static_cast<EditId>(1 + n / 2)));
    }
    for (uint64_t q = 0; q < 6; ++q) {
      const PathQuery query{.from = world.random_place(0, 6, 12 * n + 2 * q),
                            .to = world.random_place(0, 6, 12 * n + 2 * q + 1),
                            .nearest = n % 2 == 0};
      on_demand.find(query, best);
      for (PathFinder* finder : {&by_mesh, &by_labels}) {
        finder->find(query, path);
        ASSERT_EQ(path.end, best.end) << n << ", " << q;
        const double slack = 2e-4 * static_cast<double>(best.points.size() + path.points.size());
        ASSERT_NEAR(path.length, best.length, best.end == PathEnd::kReached ? slack : 1e9);
      }
      bare.find(query, other);
      reached += best.end == PathEnd::kReached ? 1 : 0;
      blocked += best.end == PathEnd::kUnreachable ? 1 : 0;
      led_around += best.end == PathEnd::kReached && best.length > other.length + 1e-3 ? 1 : 0;
    }
  }
  EXPECT_GT(reached, 300u);
  EXPECT_GT(led_around, 50u);
  EXPECT_GT(blocked, 10u);
}

TEST(Edits, LeadAroundAndBackAgain) {
  const World world = bake(worlds::flat(20), 0.2);
  Context context;
  Edits edits;
  PathFinder finder = need(PathFinder::create(world, {.edits = edits}, context));
  const PathQuery query{.from = Vec3d{2, 0, 10}, .to = Vec3d{18, 0, 10}};
  Path path;
  finder.find(query, path);
  EXPECT_NEAR(path.length, 16, 1e-6);
  const auto wall = edits.add_obstacle(Prism::box({9, 0, 0}, {10, 2, 18}));
  ASSERT_TRUE(wall);
  finder.find(query, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_GT(path.length, 22);
  ASSERT_TRUE(edits.set_active(*wall, false));
  finder.find(query, path);
  EXPECT_NEAR(path.length, 16, 1e-6);
  // Triangles, an area that is closed, and a link through it.
  const std::vector<Vec3d> corners{{9.5, 0, -1}, {9.5, 0, 21}, {9.5, 2, 21}, {9.5, 2, -1}};
  const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  const auto sheet = edits.add_obstacle(corners, triangles);
  ASSERT_TRUE(sheet);
  finder.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  ASSERT_TRUE(edits.remove(*sheet));
  const auto area = edits.add_area(Prism::box({8, -1, -1}, {12, 1, 21}), 7);
  ASSERT_TRUE(area);
  finder.find(query, path);
  EXPECT_NEAR(path.length, 16, 1e-6);
  ASSERT_TRUE(edits.set_area_cost(7, std::numeric_limits<double>::infinity()));
  finder.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  const auto link = edits.add_off_mesh_link(
      {world.find_place(0, {7, 0, 10}, 1), world.find_place(0, {13, 0, 10}, 1), 0.5});
  ASSERT_TRUE(link);
  finder.find(query, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(path.links.size(), 1u);
  EXPECT_NEAR(path.cost, 5 + 0.5 + 5, 0.1);
  const uint64_t version = edits.version();
  ASSERT_TRUE(edits.set_area_cost(7, 1));
  EXPECT_GT(edits.version(), version);
  ASSERT_TRUE(edits.remove(*link));
  finder.find(query, path);
  EXPECT_NEAR(path.length, 16, 1e-6);
}

// As if they were not there: on the ground by each search, over nodes, in the air, in flow fields.
TEST(Edits, FindersIgnoreKinematicObstacles) {
  Stage s;
  Edits edits;
  const Place target = s.place(kAdult, 100);
  for (uint64_t n = 0; n < 30; ++n) {
    const Vec3d at = s.place(kAdult, 1000 + n).position;
    const Prism cart = Prism::box({at.x - 1, at.y - 1, at.z - 1}, {at.x + 1, at.y + 3, at.z + 1});
    const auto id = edits.add_obstacle(cart, ObstacleKind::kKinematic);
    ASSERT_TRUE(id);
    if (n % 3 == 0) {
      ASSERT_TRUE(edits.move_obstacle(*id, cart));
    }
    if (n % 3 == 1) {
      ASSERT_TRUE(edits.set_active(*id, false) && edits.set_active(*id, true));
    }
  }
  const Vec3d there = target.position;
  ASSERT_TRUE(edits.add_obstacle(Prism::box(there - Vec3d{1, 1, 1}, there + Vec3d{1, 3, 1}),
                                 ObstacleKind::kKinematic));
  for (const auto& [avatar_class, speedup] :
       {std::pair{kAdult, PathSpeedup::kNone}, std::pair{kAdult, PathSpeedup::kOnDemand},
        std::pair{kFlyer, PathSpeedup::kNone}, std::pair{kClimber, PathSpeedup::kNone}}) {
    PathFinder with = s.finder({.avatar_class = avatar_class, .speedup = speedup, .edits = edits});
    PathFinder without = s.finder({.avatar_class = avatar_class, .speedup = speedup});
    uint64_t reached = 0;
    for (uint64_t n = 0; n < 20; ++n) {
      const PathQuery query{.from = s.place(kAdult, n).position,
                            .to = s.place(kAdult, n + 1).position,
                            .nearest = true};
      Path path, other;
      with.find(query, path);
      without.find(query, other);
      expect_same(path, other);
      reached += path.end == PathEnd::kReached ? 1 : 0;
      EXPECT_EQ(with.is_free(query.to), without.is_free(query.to));
    }
    EXPECT_GT(reached, 0u) << avatar_class;
    if (avatar_class != kAdult) continue;
    FlowField flow = need(FlowField::create(with, {&target, 1}, {}, s.context)),
              other = need(FlowField::create(without, {&target, 1}, {}, s.context));
    for (uint64_t n = 0; n < 20; ++n) {
      EXPECT_EQ(flow.distance(s.place(kAdult, n)), other.distance(s.place(kAdult, n)));
    }
  }
}

TEST(Edits, FindersKnowAnObstacleWhereItWasMoved) {
  const World world = bake(worlds::flat(20), 0.2);
  Context context;
  Edits edits;
  PathFinder finder = need(PathFinder::create(world, {.edits = edits}, context));
  const PathQuery query{.from = Vec3d{2, 0, 10}, .to = Vec3d{18, 0, 10}};
  Path path;
  const auto length = [&] {
    finder.find(query, path);
    EXPECT_EQ(path.end, PathEnd::kReached);
    return path.length;
  };
  const Prism wall = Prism::box({9, 0, 0}, {10, 2, 18}), beside = Prism::box({9, 0, 1}, {10, 2, 4}),
              other = Prism::box({9, 0, 2}, {10, 2, 20});
  const auto id = edits.add_obstacle(wall);
  ASSERT_TRUE(id);
  EXPECT_GT(length(), 22);
  const uint64_t version = edits.version();
  ASSERT_TRUE(edits.move_obstacle(*id, beside));
  EXPECT_EQ(edits.version(), version + 1);
  EXPECT_NEAR(length(), 16, 1e-6);
  ASSERT_TRUE(edits.move_obstacle(*id, other));
  EXPECT_GT(length(), 22);
  EXPECT_LT(path.points[1].position.z, 3) << "around the other end";
  // While it is off, and more often between two queries.
  ASSERT_TRUE(edits.set_active(*id, false) && edits.move_obstacle(*id, wall));
  EXPECT_NEAR(length(), 16, 1e-6);
  ASSERT_TRUE(edits.move_obstacle(*id, beside) && edits.set_active(*id, true));
  EXPECT_NEAR(length(), 16, 1e-6);
  ASSERT_TRUE(edits.move_obstacle(*id, other) && edits.move_obstacle(*id, wall));
  EXPECT_GT(length(), 22);
  EXPECT_GT(path.points[1].position.z, 17);
  ASSERT_TRUE(edits.move_obstacle(*id, other) && edits.remove(*id));
  EXPECT_NEAR(length(), 16, 1e-6);
}

TEST(Edits, OnlyObstaclesOfPrismsCanBeMoved) {
  const World world = bake(worlds::flat(6), 0.2);
  const Place place = world.find_place(0, {3, 0, 3}, 0.5);
  Edits edits;
  const std::vector<Vec3d> corners{{1, 0, 1}, {2, 0, 1}, {2, 1, 1}};
  const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 2}};
  const Prism box = Prism::box({1, 0, 1}, {2, 1, 2});
  const auto crate = edits.add_obstacle(box), sheet = edits.add_obstacle(corners, triangles),
             area = edits.add_area(box, 3), link = edits.add_off_mesh_link({place, place, 1}),
             gone = edits.add_obstacle(box);
  ASSERT_TRUE(crate && sheet && area && link && gone && edits.remove(*gone));
  const uint64_t version = edits.version();
  EXPECT_EQ(edits.move_obstacle(*crate, Prism{}).error().code, Errc::kBadInput);
  const auto of_triangles = edits.move_obstacle(*sheet, box);
  ASSERT_FALSE(of_triangles);
  EXPECT_EQ(of_triangles.error().code, Errc::kBadInput);
  EXPECT_EQ(of_triangles.error().message,
            "obstacle: 2 is of triangles, which cannot be moved; remove it and add it where it is "
            "to be");
  for (const EditId id : {*area, *link, *gone, EditId{0}, EditId{99}}) {
    const auto none = edits.move_obstacle(id, box);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, Errc::kNotFound);
  }
  EXPECT_EQ(edits.version(), version);
}

// A link that was added while a crate stood at its end works once the crate is removed.
TEST(Edits, AnOffMeshLinkOutlivesACrateAtItsEnd) {
  const World world = bake(worlds::doorway(0.2), 0.1);
  Context context;
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  Edits edits;
  PathFinder finder = need(PathFinder::create(world, {.edits = edits}, context));
  const auto crate = edits.add_obstacle(Prism::box({4.4, 0, 2.9}, {4.6, 1, 3.1}));
  ASSERT_TRUE(crate);
  ASSERT_TRUE(edits.add_off_mesh_link({at(3.5, 3), at(4.5, 3), 1.5, false}));
  Path path;
  finder.find(at(1, 1), at(7, 5), path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
  ASSERT_TRUE(edits.remove(*crate));
  finder.find(at(1, 1), at(7, 5), path);
  EXPECT_EQ(path.end, PathEnd::kReached);
}

TEST(Edits, RefuseNonsense) {
  const World world = bake(worlds::flat(6), 0.2);
  const Place place = world.find_place(0, {3, 0, 3}, 0.5);
  Edits edits;
  const uint64_t version = edits.version();
  const double nan = std::nan("");
  EXPECT_FALSE(edits.add_obstacle(Prism{}));
  EXPECT_FALSE(edits.add_obstacle(Prism::box({nan, 0, 0}, {1, 1, 1})));
  EXPECT_FALSE(edits.add_obstacle(std::vector<Vec3d>{}, {}));
  const std::vector<std::array<uint32_t, 3>> beyond{{0, 1, 5}};
  EXPECT_FALSE(edits.add_obstacle(std::vector<Vec3d>(3), beyond));
  EXPECT_FALSE(edits.add_area(Prism::box({0, 0, 0}, {1, 1, 1}), 0));
  EXPECT_FALSE(edits.add_area(Prism::box({0, 0, 0}, {1, 1, 1}), 64));
  EXPECT_FALSE(edits.add_area(Prism{}, 1));
  EXPECT_FALSE(edits.add_off_mesh_link({place, {}, 1}));
  EXPECT_FALSE(edits.add_off_mesh_link({{}, place, 1}));
  for (const double cost : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(edits.add_off_mesh_link({place, place, cost}));
  }
  EXPECT_FALSE(edits.set_area_cost(0, 2));
  EXPECT_FALSE(edits.set_area_cost(1, nan));
  EXPECT_FALSE(edits.set_area_cost(1, 0));
  EXPECT_FALSE(edits.remove(0) || edits.remove(1) || edits.set_active(7, true));
  EXPECT_EQ(edits.version(), version) << "what was refused is no change";
}

}  // namespace
}  // namespace throng
