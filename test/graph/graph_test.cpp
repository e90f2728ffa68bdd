// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <vector>

#include "baked.h"
#include "throng/world.h"
#include "worlds.h"

// The graph against a flood over World::move, cell by cell, that knows no regions.
namespace throng {
namespace {

using test::bake;
using test::builtin;

Graph make(const World& world, int32_t workers = 0) {
  Context context;
  const auto graph = Graph::create(world, {.workers = workers}, context);
  EXPECT_TRUE(graph);
  return graph ? *graph : Graph{};
}

// All legal cells of a class, and which of them moves of one cell connect.
struct Cells {
  std::vector<Place> places;
  std::vector<uint32_t> root;

  uint32_t find(uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  }
};

Cells naive_components(const World& world, int32_t avatar_class) {
  Cells cells;
  const WorldSummary summary = world.summary();
  std::map<std::tuple<uint32_t, int64_t, int64_t>, uint32_t> index;  // level1 and cell
  const auto key = [&](const Place& p) {
    return std::tuple{
        p.level1,
        static_cast<int64_t>(std::floor((p.position.x - summary.origin.x) / summary.cell)),
        static_cast<int64_t>(std::floor((p.position.z - summary.origin.z) / summary.cell))};
  };
  for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
    const LevelTileContent tile = world.level_tile(l);
    for (int32_t c = 0; c < kTileCells * kTileCells; ++c) {
      const auto i = static_cast<size_t>(c);
      if (tile.clearance[static_cast<size_t>(avatar_class)][i] == 0) continue;
      const double x = (tile.tile_x * kTileCells + c % kTileCells + 0.5) * summary.cell;
      const double z = (tile.tile_z * kTileCells + c / kTileCells + 0.5) * summary.cell;
      const Place place{{summary.origin.x + x, tile.floor[i] * 1e-3, summary.origin.z + z}, l + 1};
      index[key(place)] = static_cast<uint32_t>(cells.places.size());
      cells.places.push_back(place);
    }
  }
  cells.root.resize(cells.places.size());
  std::iota(cells.root.begin(), cells.root.end(), 0u);
  for (uint32_t i = 0; i < cells.places.size(); ++i) {
    for (const auto& [dx, dz] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
      const MoveResult there =
          world.move(avatar_class, cells.places[i], dx * summary.cell, dz * summary.cell);
      if (there.end != MoveEnd::kArrived) continue;
      const MoveResult back =
          world.move(avatar_class, there.place, -dx * summary.cell, -dz * summary.cell);
      if (back.end != MoveEnd::kArrived || back.place.level1 != cells.places[i].level1) continue;
      cells.root[cells.find(i)] = cells.find(index.at(key(there.place)));
    }
  }
  return cells;
}

// The graph's components are the naive ones, for every cell of every class.
void expect_as_naive(const World& world, const char* name) {
  const Graph graph = make(world);
  const WorldSummary summary = world.summary();
  for (int32_t c = 0; c < static_cast<int32_t>(summary.classes.size()); ++c) {
    SCOPED_TRACE(std::string(name) + ", " + summary.classes[static_cast<size_t>(c)].name);
    Cells cells = naive_components(world, c);
    std::map<uint32_t, int32_t> component_of_root;
    std::map<int32_t, uint64_t> cells_of;
    uint64_t wrong = 0;
    for (uint32_t i = 0; i < cells.places.size(); ++i) {
      const int32_t component = graph.component_at(c, cells.places[i]);
      const auto [at, is_new] = component_of_root.try_emplace(cells.find(i), component);
      wrong += component < 0 || at->second != component;
      ++cells_of[component];
    }
    EXPECT_EQ(wrong, 0u);
    const auto components = graph.components(c);
    EXPECT_EQ(component_of_root.size(), components.size());
    EXPECT_EQ(cells_of.size(), components.size());
    for (size_t i = 0; i < components.size(); ++i) {
      const auto count = static_cast<double>(cells_of[static_cast<int32_t>(i)]);
      EXPECT_NEAR(components[i].area, count * summary.cell * summary.cell, 1e-6);
      EXPECT_EQ(graph.component_at(c, components[i].place), static_cast<int32_t>(i));
      if (i > 0) {
        EXPECT_LE(components[i].area, components[i - 1].area);
      }
    }
  }
}

TEST(Graph, ConnectsWhatMovesConnect) {
  const auto classes = default_classes();
  expect_as_naive(bake(worlds::two_floors(), 0.1, classes), "two floors");
  expect_as_naive(bake(worlds::steps(0.17, 0.3, 10), 0.1, classes), "steps");
  expect_as_naive(bake(worlds::doorway(0.8), 0.1, classes), "doorway");
  expect_as_naive(bake(builtin({.name = "garage", .size = 45, .levels = 2}), 0.2, classes),
                  "garage");
  expect_as_naive(bake(builtin({.name = "stairs"}), 0.15, classes), "stairs");
  expect_as_naive(bake(builtin({.name = "church"}), 0.15, classes), "church");
  expect_as_naive(bake(builtin({.name = "maze", .size = 30, .levels = 2}), 0.1, classes), "maze");
}

TEST(Graph, IsTheSameForAnyNumberOfThreads) {
  const World world = bake(builtin({.name = "church"}), 0.15, default_classes());
  const Graph one = make(world, 1);
  for (const int32_t workers : {2, 3, 8}) {
    const Graph many = make(world, workers);
    EXPECT_EQ(one.summary().regions, many.summary().regions);
    EXPECT_EQ(one.summary().links, many.summary().links);
    for (int32_t c = 0; c < 4; ++c) {
      ASSERT_EQ(one.components(c).size(), many.components(c).size());
      for (size_t i = 0; i < one.components(c).size(); ++i) {
        EXPECT_EQ(one.components(c)[i].area, many.components(c)[i].area);
        EXPECT_EQ(one.components(c)[i].place.level1, many.components(c)[i].place.level1);
      }
    }
  }
}

// What a class reaches is what it reaches in a world baked for it alone, and many classes cost
// little more than one.
TEST(Graph, ManyClassesShareOneGraph) {
  auto classes = default_classes();
  AvatarClass climber = classes[0];
  climber.name = "climber";
  climber.step_height = 0.6;
  climber.max_slope = 60;
  AvatarClass crawler = classes[0];
  crawler.name = "crawler";
  crawler.height = 1.0;
  crawler.radius = 0.35;
  classes.push_back(climber);
  classes.push_back(crawler);
  const Scene scene = builtin({.name = "garage", .size = 60, .levels = 3});
  const World together = bake(scene, 0.1, classes);
  const Graph all = make(together);
  uint64_t most = 0;
  for (size_t c = 0; c < classes.size(); ++c) {
    const Graph alone = make(bake(scene, 0.1, {classes[c]}));
    most = std::max(most, alone.summary().bytes);
    const auto a = all.components(static_cast<int32_t>(c)), b = alone.components(0);
    ASSERT_EQ(a.size(), b.size()) << classes[c].name;
    for (size_t i = 0; i < a.size(); ++i) EXPECT_DOUBLE_EQ(a[i].area, b[i].area) << classes[c].name;
  }
  EXPECT_LE(static_cast<double>(all.summary().bytes), 1.5 * static_cast<double>(most));
}

TEST(Graph, RefusesWhatIsNoWorldAndAnswersForNoPlace) {
  Context context;
  EXPECT_FALSE(Graph::create(World{}, {}, context));
  const World world = bake(worlds::two_floors(), 0.1, default_classes());
  EXPECT_FALSE(Graph::create(world, {.workers = -1}, context));
  context.cancel = true;
  const auto cancelled = Graph::create(world, {}, context);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, Errc::kCancelled);
  const Graph graph = make(world);
  EXPECT_EQ(graph.component_at(0, Place{}), -1);
  EXPECT_EQ(graph.component_at(0, {{1e9, 0, 0}, 1}), -1);
  EXPECT_EQ(graph.component_at(0, {{1, 0, 1}, 4000000000u}), -1);
  EXPECT_EQ(graph.component_at(-1, world.random_place(0, 1, 1)), -1);
  EXPECT_EQ(graph.component_at(99, world.random_place(0, 1, 1)), -1);
  EXPECT_TRUE(graph.components(99).empty());
}

}  // namespace
}  // namespace throng
