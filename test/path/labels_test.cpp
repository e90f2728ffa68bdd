// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <vector>

#include "baked.h"
#include "core/random.h"
#include "path/label_search.h"
#include "path/mesh.h"
#include "path/search.h"
#include "path/segments.h"
#include "path/string_puller.h"
#include "world/place.h"

// Ways that are pulled taut, and ways looked up by the middles of blocks, against the search.
namespace throng {
namespace {

class Ways {
 public:
  Ways(const World& world, int32_t avatar_class) : world_(world), class_(avatar_class) {
    Context context;
    auto made = build_mesh(*world.data(), avatar_class, 0, context);
    EXPECT_TRUE(made);
    mesh = *std::move(made);
  }

  [[nodiscard]] Stop random_stop(uint64_t seed, uint64_t n) const {
    const Place place = world_.random_place(class_, seed, n);
    Stop stop;
    stop.at = to_ground(*world_.data(), place.position.x, place.position.z);
    stop.rect = mesh.rect_at(place.level1 - 1, stop.at.cell_x(), stop.at.cell_z());
    EXPECT_NE(stop.rect, kNoRect);
    return stop;
  }
  [[nodiscard]] bool together(const Stop& a, const Stop& b) const {
    return mesh.rects[a.rect].component == mesh.rects[b.rect].component;
  }
  // Of the shortest way.
  double search(const Stop& from, const Stop& to, std::vector<uint32_t>& corners) {
    double length = 0;
    EXPECT_EQ(search_.find(mesh, from, to, UINT64_MAX, corners, length), SearchResult::kFound);
    return length;
  }
  [[nodiscard]] bool can_be_gone(const Stop& from, const std::vector<uint32_t>& corners,
                                 const Stop& to) const {
    std::vector<Stop> stops;
    return SegmentWalker(*world_.data(), mesh).walk(from, corners, to.at, stops) &&
           stops.back().rect == to.rect;
  }

  PathMesh mesh;

 private:
  const World& world_;
  int32_t class_;
  PathSearch search_;
};

std::vector<World> some_worlds() {
  std::vector<World> worlds;
  worlds.push_back(test::bake(test::builtin({.name = "church"}), 0.15));
  worlds.push_back(test::bake(test::builtin({.name = "garage", .size = 45, .levels = 3}), 0.2));
  worlds.push_back(test::bake(test::builtin({.name = "maze", .size = 30, .levels = 2}), 0.15));
  worlds.push_back(test::bake(test::builtin({.name = "city", .size = 250}), 0.4));
  return worlds;
}

TEST(Labels, AStringOverAThirdPlacePullsTaut) {
  int pulled = 0, shortest = 0;
  for (const World& world : some_worlds()) {
    Ways ways(world, 0);
    StringPuller puller;
    std::vector<uint32_t> first, second, corners, exact;
    for (uint64_t n = 0; n < 150; ++n) {
      const Stop from = ways.random_stop(1, 3 * n), over = ways.random_stop(1, 3 * n + 1);
      const Stop to = ways.random_stop(1, 3 * n + 2);
      if (!ways.together(from, to) || !ways.together(from, over)) continue;
      SCOPED_TRACE(testing::Message() << n);
      const double both = ways.search(from, over, first) + ways.search(over, to, second);
      std::vector<Waypoint> way{{in_cells(from.at), from.rect}};
      for (const uint32_t c : first) way.push_back(waypoint(ways.mesh, c));
      way.push_back({in_cells(over.at), over.rect});
      for (const uint32_t c : second) way.push_back(waypoint(ways.mesh, c));
      way.push_back({in_cells(to.at), to.rect});
      double length = 0;
      ASSERT_TRUE(puller.pull(ways.mesh, way, corners, length));
      EXPECT_TRUE(ways.can_be_gone(from, corners, to));
      const double least = ways.search(from, to, exact);
      EXPECT_LE(length, both + 1e-6);
      EXPECT_GE(length, least - 1e-6);
      ++pulled;
      shortest += length < least + 1e-6;
      // What is taut stays as it is.
      double again = 0;
      std::vector<Waypoint> taut{way.front()};
      for (const uint32_t c : corners) taut.push_back(waypoint(ways.mesh, c));
      taut.push_back(way.back());
      ASSERT_TRUE(puller.pull(ways.mesh, taut, exact, again));
      EXPECT_EQ(exact, corners);
    }
  }
  EXPECT_GT(pulled, 300);
  EXPECT_GT(shortest, 50);
}

TEST(Labels, WaysByMiddlesAreHardlyLonger) {
  int asked = 0, exact = 0;
  for (const World& world : some_worlds()) {
    Ways ways(world, 0);
    cut_into_blocks(ways.mesh, kLargeBlock);
    Context context;
    const auto labels = build_labels(ways.mesh, 0, context);
    ASSERT_TRUE(labels);
    ASSERT_FALSE(labels->by_middle.first.empty());
    LabelSearch look_up;
    std::vector<uint32_t> corners, shortest;
    for (uint64_t n = 0; n < 250; ++n) {
      const Stop from = ways.random_stop(2, 2 * n), to = ways.random_stop(2, 2 * n + 1);
      if (!ways.together(from, to)) continue;
      SCOPED_TRACE(testing::Message() << n);
      double length = 0;
      ASSERT_TRUE(look_up.find(ways.mesh, *labels, from, to, corners, length));
      EXPECT_TRUE(ways.can_be_gone(from, corners, to));
      const double least = ways.search(from, to, shortest);
      EXPECT_GE(length, least - 1e-6);
      EXPECT_LE(length, least * 1.02 + 1e-6);
      ++asked;
      exact += length < least + 1e-6;
    }
  }
  EXPECT_GT(asked, 600);
  EXPECT_GT(exact, asked * 9 / 10);
}

// The 47025th pair is one whose way bends at a corner, runs on by less than rays can tell through
// the cell that is missing there, and so lost that corner.
TEST(Labels, NoCornerIsLostToRounding) {
  const World world = test::bake(test::builtin({.name = "maze", .size = 30, .levels = 2}), 0.15);
  Ways ways(world, 0);
  cut_into_blocks(ways.mesh, kLargeBlock);
  Context context;
  const auto labels = build_labels(ways.mesh, 0, context);
  ASSERT_TRUE(labels);
  LabelSearch look_up;
  std::vector<uint32_t> corners;
  for (uint64_t n = 47000; n < 60000; ++n) {
    const Stop from = ways.random_stop(2, 2 * n), to = ways.random_stop(2, 2 * n + 1);
    ASSERT_TRUE(ways.together(from, to));
    double length = 0;
    ASSERT_TRUE(look_up.find(ways.mesh, *labels, from, to, corners, length)) << n;
    EXPECT_TRUE(ways.can_be_gone(from, corners, to)) << n;
  }
}

}  // namespace
}  // namespace throng
