// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/graph_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "core/random.h"

namespace throng {
namespace {

void make_small(world::WorldData& world) {
  world.level_count = 1000;
  world.width = world.depth = 5000;
}

// Components of three classes, each made of one to four of zones, often where another class has
// one.
world::GraphData random_graph(uint64_t seed, uint32_t count) {
  world::GraphData graph;
  std::vector<std::pair<uint32_t, uint32_t>> of_zones;  // class, component
  for (uint32_t c = 0; c < 3; ++c) {
    graph.class_first.push_back(static_cast<uint32_t>(graph.components.size()));
    uint64_t cells = uint64_t{1} << 40;
    for (uint32_t i = 0; i < count; ++i) {
      const auto draw = [&](uint64_t n, uint64_t end) {
        return static_cast<uint32_t>(random_below(seed, c * 1000 + i, n, end));
      };
      cells -= draw(0, 5) == 0 ? 0 : draw(1, 1 << 20);
      world::GraphComponent of{cells,
                               1 + draw(2, 300),
                               draw(3, 1000),
                               static_cast<int32_t>(draw(4, 5000)),
                               static_cast<int32_t>(draw(5, 5000)),
                               static_cast<int32_t>(draw(6, UINT32_MAX))};
      if (c > 0 && draw(7, 2) == 0) {
        const world::GraphComponent& other = graph.components[i];
        of = {cells, of.regions, other.level, other.cell_x, other.cell_z, other.feet};
      }
      graph.components.push_back(of);
      for (uint32_t k = 0; k <= draw(8, 4); ++k) of_zones.emplace_back(c, i);
    }
  }
  graph.class_first.push_back(static_cast<uint32_t>(graph.components.size()));
  for (size_t i = of_zones.size(); i > 1; --i) {
    std::swap(of_zones[i - 1], of_zones[random_below(seed, i, 9, i)]);
  }
  for (const auto& [c, i] : of_zones) {
    graph.class_of.push_back(static_cast<uint8_t>(c));
    graph.component_of.push_back(i);
  }
  // Those as large as each other in the order in which they are seen, as the graph has them.
  for (uint32_t c = 0; c < 3; ++c) {
    std::vector<uint32_t> order, number(count);
    for (const auto& [of_class, i] : of_zones) {
      if (of_class == c && std::count(order.begin(), order.end(), i) == 0) order.push_back(i);
    }
    const auto first = graph.components.begin() + c * count;
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return first[a].cells > first[b].cells; });
    const std::vector<world::GraphComponent> before(first, first + count);
    for (uint32_t i = 0; i < count; ++i) {
      first[i] = before[order[i]];
      number[order[i]] = i;
    }
    for (size_t i = 0; i < of_zones.size(); ++i) {
      if (of_zones[i].first == c) graph.component_of[i] = number[of_zones[i].second];
    }
  }
  return graph;
}

TEST(GraphIndex, ComponentsComeBackAsTheyWere) {
  world::WorldData world;
  make_small(world);
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const world::GraphData graph = random_graph(seed, seed == 0 ? 0 : 100);
    const std::vector<uint8_t> packed = world::pack_components(graph);
    world::GraphData again;
    again.class_first = graph.class_first;
    ASSERT_EQ(world::unpack_components(packed, world, again), nullptr);
    EXPECT_EQ(again.component_of, graph.component_of);
    EXPECT_EQ(again.class_of, graph.class_of);
    ASSERT_EQ(again.components.size(), graph.components.size());
    for (size_t i = 0; i < graph.components.size(); ++i) {
      const world::GraphComponent &a = again.components[i], &b = graph.components[i];
      EXPECT_TRUE(a.cells == b.cells && a.regions == b.regions && a.level == b.level &&
                  a.cell_x == b.cell_x && a.cell_z == b.cell_z && a.feet == b.feet);
    }
  }
}

TEST(GraphIndex, FalseComponentsAreRefusedOrLieInTheWorld) {
  world::WorldData world;
  make_small(world);
  const world::GraphData graph = random_graph(7, 60);
  const std::vector<uint8_t> whole = world::pack_components(graph);
  size_t refused = 0, used = 0;
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    std::vector<uint8_t> bytes = whole;
    world::GraphData found;
    found.class_first = graph.class_first;
    const size_t at = random_below(seed, 0, 0, bytes.size());
    switch (random_below(seed, 1, 0, 8)) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        found.class_first[1 + seed % 3] += static_cast<uint32_t>(random_u64(seed, 2, 0) >> 40);
        std::sort(found.class_first.begin(), found.class_first.end());
        break;
      default:
        bytes[at] = static_cast<uint8_t>(random_u64(seed, 3, 0));
    }
    if (world::unpack_components(bytes, world, found) != nullptr) {
      ++refused;
      continue;
    }
    ++used;
    ASSERT_EQ(found.class_of.size(), found.component_of.size());
    for (size_t i = 0; i < found.component_of.size(); ++i) {
      ASSERT_LT(found.class_of[i], 3);
      ASSERT_LT(found.class_first[found.class_of[i]] + found.component_of[i],
                found.class_first[found.class_of[i] + 1u]);
    }
    for (const world::GraphComponent& of : found.components) {
      ASSERT_TRUE(of.cells > 0 && of.regions > 0 && of.level < world.level_count);
      ASSERT_TRUE(of.cell_x >= 0 && of.cell_x < world.width);
      ASSERT_TRUE(of.cell_z >= 0 && of.cell_z < world.depth);
    }
  }
  EXPECT_GT(refused, 1000u);
  EXPECT_GT(used, 200u);
}

}  // namespace
}  // namespace throng
