// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "grid_oracle.h"
#include "path/ground/baked_cells.h"
#include "path/ground/label_search.h"
#include "path/ground/mesh.h"
#include "path/ground/search.h"
#include "path/ground/segments.h"
#include "path/ground/string_puller.h"
#include "throng/bake.h"
#include "throng/scene.h"
#include "world/place.h"

// Paths that are pulled taut, and paths looked up by the middles of blocks, against the search.
namespace throng {
namespace {

class MeshedWorld {
 public:
  MeshedWorld(const World& world, int32_t avatar_class) : world_(world), class_(avatar_class) {
    Context context;
    auto made = path::build_mesh(*data_of(world), avatar_class, 0, context);
    EXPECT_TRUE(made);
    mesh = *std::move(made);
  }

  [[nodiscard]] path::Stop random_stop(uint64_t seed, uint64_t n) const {
    const Place place = world_.random_place(class_, seed, n);
    path::Stop stop;
    stop.at = world::to_ground(*data_of(world_), place.position.x, place.position.z);
    stop.rect = mesh.rect_at(place.level1 - 1, stop.at.cell_x(), stop.at.cell_z());
    EXPECT_NE(stop.rect, path::kNoRect);
    return stop;
  }
  [[nodiscard]] bool together(const path::Stop& a, const path::Stop& b) const {
    return mesh.rects[a.rect].component == mesh.rects[b.rect].component;
  }
  // Of the shortest path.
  double search(const path::Stop& from, const path::Stop& to, std::vector<uint32_t>& corners) {
    double length = 0;
    EXPECT_EQ(search_.find(mesh, from, to, UINT64_MAX, corners, length),
              path::SearchResult::kFound);
    return length;
  }
  [[nodiscard]] bool is_legal(const path::Stop& from, const std::vector<uint32_t>& corners,
                              const path::Stop& to) const {
    std::vector<path::Stop> stops;
    const path::BakedCells cells(*data_of(world_), mesh);
    return path::SegmentWalker(cells, mesh).walk(from, corners, to.at, stops) &&
           stops.back().rect == to.rect;
  }

  path::PathMesh mesh;

 private:
  const World& world_;
  int32_t class_;
  path::PathSearch search_;
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
    MeshedWorld meshed(world, 0);
    path::StringPuller puller;
    std::vector<uint32_t> first, second, corners, exact;
    for (uint64_t n = 0; n < 150; ++n) {
      const path::Stop from = meshed.random_stop(1, 3 * n), over = meshed.random_stop(1, 3 * n + 1);
      const path::Stop to = meshed.random_stop(1, 3 * n + 2);
      if (!meshed.together(from, to) || !meshed.together(from, over)) continue;
      SCOPED_TRACE(testing::Message() << n);
      const double both = meshed.search(from, over, first) + meshed.search(over, to, second);
      std::vector<path::Waypoint> path{{path::in_cells(from.at), from.rect}};
      for (const uint32_t c : first) path.push_back(path::waypoint(meshed.mesh, c));
      path.push_back({path::in_cells(over.at), over.rect});
      for (const uint32_t c : second) path.push_back(path::waypoint(meshed.mesh, c));
      path.push_back({path::in_cells(to.at), to.rect});
      double length = 0;
      ASSERT_TRUE(puller.pull(meshed.mesh, path, corners, length));
      EXPECT_TRUE(meshed.is_legal(from, corners, to));
      const double least = meshed.search(from, to, exact);
      EXPECT_LE(length, both + 1e-6);
      EXPECT_GE(length, least - 1e-6);
      ++pulled;
      shortest += length < least + 1e-6;
      // A taut path stays as it is.
      double again = 0;
      std::vector<path::Waypoint> taut{path.front()};
      for (const uint32_t c : corners) taut.push_back(path::waypoint(meshed.mesh, c));
      taut.push_back(path.back());
      ASSERT_TRUE(puller.pull(meshed.mesh, taut, exact, again));
      EXPECT_EQ(exact, corners);
    }
  }
  EXPECT_GT(pulled, 300);
  EXPECT_GT(shortest, 50);
}

TEST(Labels, PathsOverMiddlesAreHardlyLonger) {
  int pairs = 0, exact = 0;
  for (const World& world : some_worlds()) {
    MeshedWorld meshed(world, 0);
    path::cut_into_blocks(meshed.mesh, path::kLargeBlock);
    Context context;
    const auto labels = path::build_labels(meshed.mesh, 0, context);
    ASSERT_TRUE(labels);
    ASSERT_FALSE(labels->by_middle.first.empty());
    path::LabelSearch label_search;
    std::vector<uint32_t> corners, shortest;
    for (uint64_t n = 0; n < 250; ++n) {
      const path::Stop from = meshed.random_stop(2, 2 * n), to = meshed.random_stop(2, 2 * n + 1);
      if (!meshed.together(from, to)) continue;
      SCOPED_TRACE(testing::Message() << n);
      double length = 0;
      ASSERT_TRUE(label_search.find(meshed.mesh, *labels, from, to, corners, length));
      EXPECT_TRUE(meshed.is_legal(from, corners, to));
      const double least = meshed.search(from, to, shortest);
      EXPECT_GE(length, least - 1e-6);
      EXPECT_LE(length, least * 1.02 + 1e-6);
      ++pairs;
      exact += length < least + 1e-6;
    }
  }
  EXPECT_GT(pairs, 600);
  EXPECT_GT(exact, pairs * 9 / 10);
}

// The 47025th pair is one whose path turns at a corner, continues through the cell that is missing
// there by less than rays can distinguish, and so lost that corner.
TEST(Labels, NoCornerIsLostToRounding) {
  const World world = test::bake(test::builtin({.name = "maze", .size = 30, .levels = 2}), 0.15);
  MeshedWorld meshed(world, 0);
  path::cut_into_blocks(meshed.mesh, path::kLargeBlock);
  Context context;
  const auto labels = path::build_labels(meshed.mesh, 0, context);
  ASSERT_TRUE(labels);
  path::LabelSearch label_search;
  std::vector<uint32_t> corners;
  for (uint64_t n = 47000; n < 60000; ++n) {
    const path::Stop from = meshed.random_stop(2, 2 * n), to = meshed.random_stop(2, 2 * n + 1);
    ASSERT_TRUE(meshed.together(from, to));
    double length = 0;
    ASSERT_TRUE(label_search.find(meshed.mesh, *labels, from, to, corners, length)) << n;
    EXPECT_TRUE(meshed.is_legal(from, corners, to)) << n;
  }
}

// The middle of a cell, or another point of it.
path::Stop stop_in(const World& world, const path::PathMesh& mesh, int32_t x, int32_t z,
                   world::GroundPoint within = {world::kUnitsPerCell / 2,
                                                world::kUnitsPerCell / 2}) {
  path::Stop stop{
      {(int64_t{x} << world::kUnitBits) + within.x, (int64_t{z} << world::kUnitBits) + within.z},
      path::kNoRect};
  const Place place = world.find_place(0, {x + 0.5, 0, z + 0.5}, 0.1);
  if (place) stop.rect = mesh.rect_at(place.level1 - 1, x, z);
  return stop;
}

path::HubLabels labels_of(const path::PathMesh& mesh) {
  Context context;
  auto labels = path::build_labels(mesh, 0, context);
  EXPECT_TRUE(labels);
  return *std::move(labels);
}

// Lines between middles of cells run exactly through points that four cells share, and those
// between low corners of cells along the lines between cells: where rectangles meet, as they do at
// the borders of tiles, 64 cells apart.
TEST(Labels, StraightLinesThroughPointsOfFourCellsAreFound) {
  const std::vector<std::string> rows{"............", "..#.........", "............",
                                      ".......#....", "............", "...#........",
                                      "............", "............", "............",
                                      "#...........", "............", "............"};
  constexpr int32_t kSide = 80, kFirst = 58, kWindow = 12;
  FlatCells cells{.width = kSide, .depth = kSide, .passable = {}};
  cells.passable.assign(size_t{kSide} * kSide, 1);
  for (size_t z = 0; z < kWindow; ++z) {
    for (size_t x = 0; x < kWindow; ++x)
      cells.passable[(kFirst + z) * kSide + kFirst + x] = rows[z][x] == '.' ? 1 : 0;
  }
  const auto world = bake_flat_cells(cells, 1);
  ASSERT_TRUE(world);
  const test::GridOracle oracle(cells);
  MeshedWorld meshed(*world, 0);
  for (const int32_t side : {path::kSmallBlock, path::kLargeBlock}) {
    path::cut_into_blocks(meshed.mesh, side);
    const path::HubLabels labels = labels_of(meshed.mesh);
    path::LabelSearch label_search;
    std::vector<uint32_t> corners;
    for (const int32_t half : {1, 0}) {
      for (int32_t n = 0; n < kWindow * kWindow * kWindow * kWindow; ++n) {
        const int32_t from = n / (kWindow * kWindow), to = n % (kWindow * kWindow);
        const auto stop_at = [&](int32_t cell) {
          const world::GroundPoint within{half * world::kUnitsPerCell / 2,
                                          half * world::kUnitsPerCell / 2};
          return stop_in(*world, meshed.mesh, kFirst + cell % kWindow, kFirst + cell / kWindow,
                         within);
        };
        const auto point = [&](int32_t cell) {
          return test::HalfPoint{2 * (kFirst + cell % kWindow) + half,
                                 2 * (kFirst + cell / kWindow) + half};
        };
        const path::Stop a = stop_at(from), b = stop_at(to);
        if (a.rect == path::kNoRect || b.rect == path::kNoRect) continue;
        double length = 0;
        ASSERT_TRUE(label_search.find(meshed.mesh, labels, a, b, corners, length));
        const auto best = oracle.shortest(point(from), point(to), length * (1 + 1e-9) + 1e-9);
        ASSERT_TRUE(best) << from << " to " << to;
        EXPECT_LE(length, *best * (side == path::kSmallBlock ? 1 : 1.02) + 1e-6)
            << from << " to " << to << ", half " << half << ", side " << side;
      }
    }
  }
}

// Ends anywhere and on halves and quarters of cells, over one tile and over several.
TEST(Labels, AreAsShortAsTheSearchOverRandomCells) {
  int pairs = 0, straight = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const int32_t width = seed < 3 ? 140 : 30, depth = seed < 3 ? 80 : 24;
    FlatCells cells{.width = width, .depth = depth, .passable = {}};
    for (uint64_t i = 0; i < static_cast<uint64_t>(width * depth); ++i)
      cells.passable.push_back(random_below(seed, 0, i, 200) < 2 + seed ? 0 : 1);
    const auto world = bake_flat_cells(cells, 1);
    ASSERT_TRUE(world);
    MeshedWorld meshed(*world, 0);
    for (const int32_t side : {path::kSmallBlock, path::kLargeBlock}) {
      path::cut_into_blocks(meshed.mesh, side);
      const path::HubLabels labels = labels_of(meshed.mesh);
      ASSERT_EQ(labels.by_middle.first.empty(), side == path::kSmallBlock);
      path::LabelSearch label_search;
      std::vector<uint32_t> corners, exact;
      for (uint64_t n = 0; n < 400; ++n) {
        const auto random_stop = [&](uint64_t use) {
          const auto below = [&](uint64_t more, int32_t most) {
            const auto count = static_cast<uint64_t>(most);
            return static_cast<int32_t>(random_below(seed, n + 1, 8 * use + more, count));
          };
          const int32_t parts = 1 << std::min(below(0, 14), world::kUnitBits);
          const int32_t part = world::kUnitsPerCell / parts;
          const world::GroundPoint within{below(1, parts) * part, below(2, parts) * part};
          return stop_in(*world, meshed.mesh, below(3, width), below(4, depth), within);
        };
        const path::Stop from = random_stop(0), to = random_stop(1);
        if (from.rect == path::kNoRect || to.rect == path::kNoRect || !meshed.together(from, to))
          continue;
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", pair " << n << ", side " << side);
        double length = 0;
        ASSERT_TRUE(label_search.find(meshed.mesh, labels, from, to, corners, length));
        EXPECT_TRUE(meshed.is_legal(from, corners, to));
        const double least = meshed.search(from, to, exact);
        EXPECT_GE(length, least - 1e-5);
        EXPECT_LE(length, least * (side == path::kSmallBlock ? 1 : 1.02) + 1e-5);
        ++pairs;
        straight += exact.empty();
      }
    }
  }
  EXPECT_GT(pairs, 10000);
  EXPECT_GT(straight, 2000);
}

// Labels hold paths over corners only, so none between two middles that see each other: their
// length must prove nothing there. Ends behind a wall from each other, middles that are not.
TEST(Labels, PathsAreHardlyLongerWhereMiddlesSeeEachOther) {
  constexpr int32_t kWidth = 190, kDepth = 120;
  for (uint64_t seed = 200; seed < 210; ++seed) {
    FlatCells cells{.width = kWidth, .depth = kDepth, .passable = {}};
    cells.passable.assign(size_t{kWidth} * kDepth, 1);
    const uint64_t walls = 1 + random_below(seed, 1, 0, 8);
    for (uint64_t wall = 2; wall < 2 + walls; ++wall) {
      const auto below = [&](uint64_t use, uint64_t most) {
        return static_cast<int32_t>(random_below(seed, wall, use, most));
      };
      const int32_t x0 = below(0, kWidth), z0 = below(1, kDepth);
      int32_t width = 1, depth = 1;
      if (below(2, 2) != 0) {
        width += below(3, 100);
      } else {
        depth += below(3, 80);
      }
      if (below(4, 4) == 0) {
        width = 1 + below(5, 12);
        depth = 1 + below(6, 12);
      }
      for (int32_t z = z0; z < std::min(kDepth, z0 + depth); ++z) {
        for (int32_t x = x0; x < std::min(kWidth, x0 + width); ++x)
          cells.passable[static_cast<size_t>(z * kWidth + x)] = 0;
      }
    }
    const auto world = bake_flat_cells(cells, 1);
    ASSERT_TRUE(world);
    MeshedWorld meshed(*world, 0);
    path::cut_into_blocks(meshed.mesh, path::kLargeBlock);
    const path::HubLabels labels = labels_of(meshed.mesh);
    path::LabelSearch label_search;
    std::vector<uint32_t> corners, exact;
    for (uint64_t n = 0; n < 2000; ++n) {
      const auto random_stop = [&](uint64_t use) {
        return stop_in(*world, meshed.mesh,
                       static_cast<int32_t>(random_below(seed, 100 + n, use, kWidth)),
                       static_cast<int32_t>(random_below(seed, 100 + n, use + 1, kDepth)));
      };
      const path::Stop from = random_stop(0), to = random_stop(2);
      if (from.rect == path::kNoRect || to.rect == path::kNoRect || !meshed.together(from, to))
        continue;
      double length = 0;
      ASSERT_TRUE(label_search.find(meshed.mesh, labels, from, to, corners, length));
      EXPECT_LE(length, meshed.search(from, to, exact) * 1.02 + 1e-5) << seed << ", " << n;
    }
  }
}

}  // namespace
}  // namespace throng
