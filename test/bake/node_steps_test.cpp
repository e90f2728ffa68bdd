// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "baked.h"
#include "core/arrays/disjoint_sets.h"
#include "path/overlay/node_finder.h"
#include "throng/path.h"
#include "throng/surface.h"

// Links over steps: LinkKind::kStep, in nodes and in paths over them.
namespace throng {
namespace {

Nodes make(const Scene& scene, double cell) {
  Context context;
  const auto nodes = Nodes::create(test::bake(scene, cell), scene, {}, context);
  EXPECT_TRUE(nodes) << nodes.error().message;
  return nodes ? *nodes : Nodes{};
}

size_t steps_of(const Nodes& nodes) {
  size_t steps = 0;
  for (uint32_t n = 0; n < nodes.node_count(); ++n) {
    for (const NodeArc& arc : nodes.arcs(n)) steps += arc.kind == LinkKind::kStep ? 1 : 0;
  }
  return steps;
}

// What a class reaches without steps: areas of connected parts, largest first.
std::vector<double> parts_without_steps(const Nodes& nodes, int32_t avatar_class) {
  DisjointSets sets(nodes.node_count());
  const auto stands = [&](const NodeInfo& info) { return (info.classes >> avatar_class & 1) != 0; };
  for (uint32_t n = 0; n < nodes.node_count(); ++n) {
    const NodeInfo info = nodes.node(n);
    if (info.parent1 != 0 && stands(info) && stands(nodes.node(info.parent1 - 1))) {
      sets.join(n, info.parent1 - 1);
    }
    for (const NodeArc& arc : nodes.arcs(n)) {
      if ((arc.classes >> avatar_class & 1) != 0 && arc.kind != LinkKind::kStep) {
        sets.join(n, arc.to);
      }
    }
  }
  std::vector<double> areas(nodes.node_count(), 0.0), found;
  for (uint32_t n = 0; n < nodes.node_count(); ++n) {
    const NodeInfo info = nodes.node(n);
    const bool inside = info.parent1 != 0 && stands(nodes.node(info.parent1 - 1));
    if (stands(info) && !inside) areas[sets.find(n)] += static_cast<double>(info.area);
  }
  std::copy_if(areas.begin(), areas.end(), std::back_inserter(found),
               [](double a) { return a > 0; });
  std::sort(found.rbegin(), found.rend());
  return found;
}

// 20 x 12 m, the farther half higher, and beside the kerb a ramp as long as is asked for.
Scene kerb(double high, double at, double run = 0) {
  Scene scene;
  const auto sheet = [&](double x0, double z0, double x1, double z1, double y0, double y1) {
    scene.add_quad({x0, y0, z0}, {x0, y0, z1}, {x1, y1, z1}, {x1, y1, z0});
  };
  const double z1 = run > 0 ? 8 : 12;
  sheet(0, 0, at, z1, 0, 0);
  sheet(at, 0, 20, z1, high, high);
  if (run > 0) {
    sheet(0, 8, at - run, 12, 0, 0);
    sheet(at - run, 8, at, 12, 0, high);
    sheet(at, 8, 20, 12, high, high);
  }
  return scene;
}

TEST(NodeSteps, NoBodyGetsOverAKerbWithoutOne) {
  for (const double cell : {0.1, 0.2, 0.25}) {
    for (const double high : {0.08, 0.17, 0.28}) {
      // Wherever it lies in blocks of 8 x 8 cells and in tiles, but at a tile's very rim.
      for (const double at : {9.0, 9.37, 10.11}) {
        const Nodes nodes = make(kerb(high, at), cell);
        const auto adult = parts_without_steps(nodes, 0);
        ASSERT_EQ(adult.size(), 2u) << cell << ", " << high << ", " << at;
        EXPECT_GT(adult[1], 80);
        EXPECT_EQ(nodes.components(0).size(), 1u);
        for (uint32_t n = 0; n < nodes.node_count(); ++n) {
          for (const NodeArc& arc : nodes.arcs(n)) {
            if (arc.kind != LinkKind::kStep) continue;
            EXPECT_EQ(arc.classes >> 2 & 1, 0) << "a wheelchair";
            EXPECT_NEAR(std::abs(nodes.middle(n).y - nodes.middle(arc.to).y), high, 2e-3);
          }
        }
      }
    }
  }
}

// A ramp over the whole width, turned by an angle around the vertical.
Scene ramp(double high, double from, double to, double turn) {
  Scene scene;
  const double c = std::cos(turn), s = std::sin(turn);
  const auto at = [&](double x, double y, double z) {
    return Vec3d{x * c - z * s, y, x * s + z * c};
  };
  const auto sheet = [&](double x0, double x1, double y0, double y1) {
    scene.add_quad(at(x0, y0, 0), at(x0, y0, 12), at(x1, y1, 12), at(x1, y1, 0));
  };
  sheet(0, from, 0, 0);
  sheet(from, to, 0, high);
  sheet(to, 20, high, high);
  return scene;
}

// 20 x 20 m of facets of half a metre.
Scene hills() {
  Scene scene;
  const auto at = [](int i, int k) {
    return Vec3d{i * 0.5, 1.5 * std::sin(i * 0.2) * std::cos(k * 0.17), k * 0.5};
  };
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 40; ++k) {
      scene.add_quad(at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k));
    }
  }
  return scene;
}

TEST(NodeSteps, RampsAndHillsHaveNone) {
  for (const double cell : {0.1, 0.2, 0.4}) {
    for (const double run : {2.3, 3.1, 6.0}) {  // 41 degrees at most
      for (const double turn : {0.0, 0.4}) {
        const Nodes nodes = make(ramp(2, 9.3, 9.3 + run, turn), cell);
        EXPECT_EQ(steps_of(nodes), 0u) << cell << ", " << run << ", " << turn;
        EXPECT_GT(nodes.node_count(), 10u);
      }
    }
    EXPECT_EQ(steps_of(make(hills(), cell)), 0u) << cell;
  }
}

TEST(NodeSteps, AClassThatCanGoAroundNeedsNone) {
  // A kerb that runs out along the ramp: 8 m of it, and the ramp beside.
  const Nodes nodes = make(kerb(0.3, 10, 5), 0.2);
  EXPECT_GT(steps_of(nodes), 0u);
  EXPECT_EQ(parts_without_steps(nodes, 0).size(), 1u);
}

TEST(NodeSteps, APathUpstairsNamesEveryRiser) {
  Context context;
  const Nodes nodes = make(test::builtin({.name = "stairs"}), 0.1);
  auto finder = path::NodeFinder::create(nodes, {}, context);
  ASSERT_TRUE(finder) << finder.error().message;
  Path path;
  finder->find(finder->find_place({2, 0, 2}, 10), finder->find_place({12, 3.06, 2}, 1), path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  double risen = 0;
  size_t steps = 0;
  for (const PathLink& link : path.links) {
    if (link.kind != LinkKind::kStep) continue;
    ++steps;
    // (The point of a link may lie just before or just beyond the riser.)
    const size_t before = link.point - 1,
                 after = std::min<size_t>(link.point + 1, path.points.size() - 1);
    risen += std::min(0.17, path.node_places[after].feet.y - path.node_places[before].feet.y);
  }
  const double rise = path.node_places.back().feet.y - path.node_places.front().feet.y;
  EXPECT_GT(rise, 1.5);
  EXPECT_EQ(static_cast<double>(steps), std::round(rise / 0.17));
  EXPECT_NEAR(risen, rise, 0.02);
}

}  // namespace
}  // namespace throng
