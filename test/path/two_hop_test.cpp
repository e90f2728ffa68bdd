// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/two_hop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"

// Looked-up paths of random graphs, against all shortest paths found by three nested loops.
namespace throng {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

struct RandomGraph {
  path::PathGraph paths;
  std::vector<double> edge;      // count x count; infinite: none
  std::vector<double> shortest;  // count x count

  // Lengths are small whole numbers where `ties`, so that many paths are equally short.
  RandomGraph(uint64_t seed, uint32_t count, uint32_t edges, bool ties)
      : edge(size_t{count} * count, kNever) {
    for (uint32_t e = 0; e < edges; ++e) {
      const auto a = static_cast<uint32_t>(random_below(seed, e, 0, count));
      const auto b = static_cast<uint32_t>(random_below(seed, e, 1, count));
      if (a == b) continue;
      const double length = ties ? 1.0 + static_cast<double>(random_below(seed, e, 2, 3))
                                 : 1.0 + static_cast<double>(random_below(seed, e, 2, 1000)) / 97;
      double& there = edge[size_t{a} * count + b];
      there = std::min(there, length);
      edge[size_t{b} * count + a] = there;
    }
    paths.first.assign(1, 0);
    shortest = edge;
    for (uint32_t a = 0; a < count; ++a) {
      for (uint32_t b = 0; b < count; ++b) {
        if (edge[size_t{a} * count + b] < kNever)
          paths.edges.push_back({b, edge[size_t{a} * count + b]});
      }
      paths.first.push_back(static_cast<uint32_t>(paths.edges.size()));
      shortest[size_t{a} * count + a] = 0;
    }
    for (size_t k = 0; k < count; ++k) {
      for (size_t a = 0; a < count; ++a) {
        for (size_t b = 0; b < count; ++b) {
          double& known = shortest[a * count + b];
          known = std::min(known, shortest[a * count + k] + shortest[k * count + b]);
        }
      }
    }
  }

  // Of a path by its edges; infinite if one is missing.
  [[nodiscard]] double length(const std::vector<uint32_t>& nodes) const {
    double sum = 0;
    for (size_t i = 1; i < nodes.size(); ++i) sum += edge[nodes[i - 1] * paths.count() + nodes[i]];
    return sum;
  }
};

TEST(TwoHop, LooksUpTheShortestPathsAndTheirNodes) {
  constexpr int kGraphs = 60;
  uint64_t joined = 0, apart = 0, steps = 0;
  for (uint64_t seed = 0; seed < kGraphs; ++seed) {
    const auto count = static_cast<uint32_t>(1 + random_below(seed, 0, 3, 60));
    const auto edges = static_cast<uint32_t>(random_below(seed, 0, 4, 3 * count));
    const RandomGraph graph(seed, count, edges, seed % 2 == 0);
    Context context;
    const auto labels =
        path::label_graph(graph.paths, 16, 1 + static_cast<int32_t>(seed % 3), context);
    ASSERT_TRUE(labels);
    for (uint32_t a = 0; a < count; ++a) {
      for (uint32_t b = 0; b < count; ++b) {
        SCOPED_TRACE(testing::Message() << seed << ": " << a << " to " << b);
        float best = std::numeric_limits<float>::infinity();
        for (const auto& p : labels->of(a)) {
          for (const auto& q : labels->of(b)) {
            if (p.hub == q.hub) best = std::min(best, p.length + q.length);
          }
        }
        const double wanted = graph.shortest[size_t{a} * count + b];
        if (wanted == kNever) {
          EXPECT_EQ(double{best}, kNever);
          ++apart;
          continue;
        }
        EXPECT_NEAR(best, wanted, 1e-4);
        const path::Meeting met = path::meet(labels->of(a), labels->of(b));
        EXPECT_EQ(met.length, best);
        EXPECT_EQ(labels->of(a)[met.first].hub, met.hub);
        EXPECT_EQ(labels->of(b)[met.last].hub, met.hub);
        std::vector<uint32_t> nodes{a};  // its old content stays
        labels->walk(labels->place_of(a, met.hub), labels->place_of(b, met.hub), nodes);
        nodes.erase(nodes.begin());
        ASSERT_EQ(nodes.front(), a);
        ASSERT_EQ(nodes.back(), b);
        ASSERT_EQ(std::count(nodes.begin(), nodes.end(), labels->hubs[met.hub]), 1);
        EXPECT_NEAR(graph.length(nodes), wanted, 1e-4);
        steps += nodes.size();
        ++joined;
      }
    }
    // Every node of a hub's tree lies in the trees once.
    const auto nodes = std::count_if(labels->trees.begin(), labels->trees.end(), [](uint32_t word) {
      return word < path::TwoHopLabels::kGoesOn;
    });
    EXPECT_EQ(static_cast<size_t>(nodes), labels->labels.size());
  }
  EXPECT_GT(joined, 10000U);
  EXPECT_GT(apart, 1000U);
  EXPECT_GT(steps, 3 * joined);
}

TEST(TwoHop, AGraphWithoutNodesHasNoLabels) {
  path::PathGraph none;
  none.first = {0};
  Context context;
  const auto labels = path::label_graph(none, 16, 2, context);
  ASSERT_TRUE(labels);
  EXPECT_TRUE(labels->labels.empty());
  EXPECT_TRUE(labels->trees.empty());
}

}  // namespace
}  // namespace throng
