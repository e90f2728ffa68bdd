// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "path/overlay/overlay_search.h"
#include "path/surface/node_parts.h"
#include "throng/path.h"

// The overlay of a mesh of nodes, against a search of all crossings.
namespace throng {
namespace {

using test::bake;
using test::builtin;

// Walkers, one that drops, and climbers with links over holes.
std::vector<AvatarClass> classes() {
  std::vector<AvatarClass> all = default_classes();
  all.push_back({.name = "climber"});
  all.back().climb_slope = 180;
  all.back().max_drop = 6;
  all.push_back({.name = "gecko", .height = 0.5, .radius = 0.15, .step_height = 0.2});
  all.back().climb_slope = 95;
  all[0].max_drop = 3;
  return all;
}

// Calls check(mesh) for classes of worlds of many overlay cells: of curved ground, of level tiles.
template <class Check>
void for_each_mesh(Check check) {
  Context context;
  for (const Scene& scene : {builtin({.name = "landscape", .size = 160, .seed = 2}),
                             builtin({.name = "garage"}), builtin({.name = "bridge"})}) {
    const auto nodes = Nodes::create(bake(scene, 0.25, classes()), scene, {.size = 1}, context);
    ASSERT_TRUE(nodes) << nodes.error().message;
    for (const int32_t c : {0, 3, 4, 5}) {
      const auto mesh = graph::NodeMesh::create(*nodes, c, 1, context);
      ASSERT_TRUE(mesh);
      check(*mesh);
    }
  }
}

path::BlockPoint random_point(const graph::NodeMesh& mesh, uint64_t n) {
  const NodePlace place = mesh.nodes().random_place(mesh.avatar_class(), 7, n);
  return {mesh.block_at(mesh.patch_of_node(place.node1 - 1), place.s, place.t), place.s, place.t};
}

// What a path costs from middle to middle; it must be connected.
double cost_along(const path::NodeView& mesh, const path::PieceCost& piece,
                  const path::BlockPoint& from, const std::vector<path::Crossing>& crossings,
                  const path::BlockPoint& to) {
  double cost = 0;
  path::BlockPoint at = from;
  const auto go = [&](const path::BlockPoint& next) {
    EXPECT_EQ(next.block, at.block);
    cost += piece(at.block, at.s, at.t, path::position(mesh, at), next.s, next.t,
                  path::position(mesh, next))
                .cost;
  };
  for (const path::Crossing& crossing : crossings) {
    const graph::NodePortal portal = mesh.portal(crossing.portal);
    EXPECT_FALSE(crossing.backward && portal.one_way);
    const auto [out, in] = path::ends_of(mesh, crossing);
    go(out);
    cost += graph::portal_length(portal, path::position(mesh, out), path::position(mesh, in));
    at = in;
  }
  go(to);
  return cost;
}

TEST(Overlay, InPartsItFindsTheSame) {
  uint64_t many = 0, reached = 0;
  for_each_mesh([&](const graph::NodeMesh& mesh) {
    const path::NodeView view(mesh);
    const path::PieceCost piece(view, 1);
    const path::Overlay overlay(mesh, piece, 2, 24);
    path::OverlaySearch search(view, piece, overlay);
    path::NodeSearch blocks(view, piece);
    for (uint64_t n = 0; n < 8; ++n) {
      const path::BlockPoint from = random_point(mesh, 2 * n), to = random_point(mesh, 2 * n + 1);
      const SearchBudget budget{n == 7 ? 100 : UINT64_MAX};
      std::vector<path::Crossing> whole, parts;
      const PathEnd end = search.find(from, to, budget, blocks, whole);
      const double cost = search.cost();
      const uint64_t expanded = search.expanded();
      reached += end == PathEnd::kReached;
      for (const uint64_t size : {1, 7, 100}) {
        search.begin(from, to);
        uint64_t taken = 0;
        std::optional<PathEnd> ended;
        for (int calls = 0; !ended; ++calls) {
          path::Slice slice{size};
          ended = search.advance(budget, slice, blocks, parts);
          taken += size - slice.left;
          many += calls == 5;
          if (!ended) {
            ASSERT_TRUE(slice.is_empty());
          }
        }
        EXPECT_EQ(*ended, end);
        EXPECT_EQ(search.cost(), cost);
        EXPECT_EQ(search.expanded(), expanded);
        EXPECT_EQ(taken, expanded) << "each node is taken from a slice";
        EXPECT_EQ(parts, whole);
      }
    }
  });
  EXPECT_GT(reached, 40u);
  EXPECT_GT(many, 100u);
}

TEST(Overlay, PathsOverEntrancesAreFoundIfAnyAndCostLittleMore) {
  uint64_t reached = 0, unreachable = 0, drops = 0, hole_links = 0, expanded = 0, plainly = 0;
  size_t overlay_levels = 0;
  for_each_mesh([&](const graph::NodeMesh& mesh) {
    double sum = 0, worst = 0, worst_of_costly = 0;
    int count = 0;
    for (const size_t per_cell : {24, 192}) {
      const path::NodeView view(mesh);
      const double steep = per_cell == 24 ? 2 : 0;
      const std::vector<double> added = path::added_costs(mesh, 2 * steep, steep);
      const path::PieceCost piece(view, steep, added);
      const path::Overlay overlay(mesh, piece, 2, per_cell);
      ASSERT_FALSE(overlay.empty());
      overlay_levels = std::max(overlay_levels, overlay.overlay_levels().size());
      path::OverlaySearch search(view, piece, overlay);
      path::NodeSearch plain(view, piece), blocks(view, piece);
      for (uint64_t n = 0; n < 40; ++n) {
        const path::BlockPoint from = random_point(mesh, 2 * n), to = random_point(mesh, 2 * n + 1);
        ASSERT_TRUE(from.block != graph::kNoNode && to.block != graph::kNoNode);
        std::vector<path::Crossing> best, crossings;
        const PathEnd end = plain.find(from, to, {}, best);
        ASSERT_EQ(search.find(from, to, {}, blocks, crossings), end);
        if (end != PathEnd::kReached) {
          ++unreachable;
          EXPECT_TRUE(crossings.empty());
          continue;
        }
        ++reached;
        expanded += search.expanded();
        plainly += plain.expanded();
        const double cost = cost_along(view, piece, from, crossings, to);
        EXPECT_NEAR(search.cost(), cost, 1e-9 * cost);
        EXPECT_GE(cost, plain.cost() * (1 - 1e-9));
        for (const path::Crossing& crossing : crossings) {
          drops += mesh.portals()[crossing.portal].kind == LinkKind::kDrop;
          hole_links += mesh.portals()[crossing.portal].over_hole;
        }
        if (plain.cost() < 5) continue;
        sum += cost / plain.cost();
        double& most = steep > 0 ? worst_of_costly : worst;
        most = std::max(most, cost / plain.cost());
        ++count;
        // A budget is kept: it is exhausted, or the search needs no more.
        const SearchBudget little{search.expanded() / 2};
        const PathEnd cut = search.find(from, to, little, blocks, crossings);
        if (cut == PathEnd::kReached) {
          EXPECT_LE(search.expanded(), 2 * little.max_nodes + 1);
        }
      }
    }
    EXPECT_GT(count, 30);
    EXPECT_LE(sum / count, 1.015);
    EXPECT_LE(worst, 1.1);
    EXPECT_LE(worst_of_costly, 1.2);  // A metre may cost 7 times as much as the next.
  });
  EXPECT_GT(overlay_levels, 2u);
  EXPECT_GT(reached, 600u);
  EXPECT_GT(unreachable, 40u);
  EXPECT_GT(drops, 0u);
  EXPECT_GT(hole_links, drops);
  EXPECT_LT(2 * expanded, plainly);
}

// On every overlay level: the costs in a cell are those that a search finds that does not leave it,
// or a little more.
TEST(Overlay, HoldsTheCostsOfCrossing) {
  uint64_t through = 0, none = 0;
  for_each_mesh([&](const graph::NodeMesh& mesh) {
    const path::NodeView view(mesh);
    const path::PieceCost piece(view, 1);
    const path::Overlay overlay(mesh, piece, 1, 48);
    path::NodeSearch search(view, piece);
    std::vector<uint32_t> of_block = overlay.of_block();
    std::vector<path::Crossing> crossings;
    double sum = 0;
    int count = 0;
    for (const path::Overlay::OverlayLevel& overlay_level : overlay.overlay_levels()) {
      uint64_t looked = 0;
      const uint64_t stride = overlay_level.costs.size() / 300 + 1;
      for (uint32_t d = 0; d + 1 < overlay_level.first.size(); ++d) {
        const auto entries = overlay_level.entries_of(d);
        for (const uint32_t entry : entries) {
          const path::Crossing crossing = overlay.crossing(entry);
          const auto costs = overlay_level.costs_from(entry);
          for (size_t j = 0; j < entries.size(); ++j) {
            if (entries[j] == entry || looked++ % stride != 0) continue;
            const path::Crossing out = overlay.crossing(entries[j] ^ 1);
            const graph::NodePortal portal = mesh.portals()[out.portal];
            const bool closed = (crossing.backward && mesh.portals()[crossing.portal].one_way) ||
                                (out.backward && portal.one_way);
            const auto ends = path::ends_of(view, out);
            const PathEnd end = search.find(path::ends_of(view, crossing).in, ends.out, {},
                                            crossings, {of_block.data(), d});
            if (closed || end != PathEnd::kReached) {
              EXPECT_TRUE(std::isinf(costs[j]));
              ++none;
              continue;
            }
            const double least =
                search.cost() + graph::portal_length(portal, path::position(view, ends.out),
                                                     path::position(view, ends.in));
            ASSERT_FALSE(std::isinf(costs[j]));
            EXPECT_GE(costs[j], least * (1 - 3e-6));  // sums of floats
            if (&overlay_level == &overlay.overlay_levels().front()) {
              EXPECT_NEAR(costs[j], least, 1e-5 * least);
            }
            sum += costs[j] / least;
            ++count;
            ++through;
          }
        }
      }
      if (overlay_level.above.empty()) continue;
      for (uint32_t& overlay_cell : of_block) overlay_cell = overlay_level.above[overlay_cell];
    }
    EXPECT_LE(sum / count, 1.05);
  });
  EXPECT_GT(through, 3000u);
  EXPECT_GT(none, 100u);
}

TEST(Overlay, AreTheSameForAnyNumberOfWorkers) {
  for_each_mesh([&](const graph::NodeMesh& mesh) {
    const path::NodeView view(mesh);
    const path::PieceCost piece(view, 0);
    const path::Overlay one(mesh, piece, 1), four(mesh, piece, 4);
    EXPECT_EQ(one.bytes(), four.bytes());
    ASSERT_EQ(one.overlay_levels().size(), four.overlay_levels().size());
    for (size_t k = 0; k < one.overlay_levels().size(); ++k) {
      EXPECT_EQ(one.overlay_levels()[k].entries, four.overlay_levels()[k].entries);
      EXPECT_EQ(one.overlay_levels()[k].costs, four.overlay_levels()[k].costs);
    }
  });
}

TEST(NodeParts, FindWhatIsReachableAndWhatComesNearest) {
  uint64_t reached = 0, unreachable = 0;
  for_each_mesh([&](const graph::NodeMesh& mesh) {
    const path::NodeView view(mesh);
    const path::PieceCost piece(view, 0);
    const path::NodeParts parts(mesh, 2);
    path::NodeParts::Reached marks;
    path::NodeSearch plain(view, piece);
    std::vector<path::Crossing> crossings;
    for (uint64_t n = 0; n < 60; ++n) {
      const path::BlockPoint from = random_point(mesh, 3 * n), to = random_point(mesh, 3 * n + 1);
      const PathEnd end = plain.find(from, to, {}, crossings);
      parts.reach(from.block, marks);
      EXPECT_EQ(marks.holds(parts.of_block(to.block)), end == PathEnd::kReached);
      if (end == PathEnd::kReached) {
        ++reached;
        continue;
      }
      ++unreachable;
      const Vec3d goal = path::position(view, to);
      const path::BlockPoint searched =
          crossings.empty() ? from : path::ends_of(view, crossings.back()).in;
      const path::BlockPoint reported =
          parts.nearest(view, from, goal, marks, [](uint32_t) { return false; });
      EXPECT_EQ(length(path::position(view, reported) - goal),
                length(path::position(view, searched) - goal));
      EXPECT_EQ(plain.find(from, reported, {}, crossings), PathEnd::kReached);
    }
  });
  EXPECT_GT(reached, 400u);
  EXPECT_GT(unreachable, 40u);
}

}  // namespace
}  // namespace throng
