// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graph/node_links.h"
#include "throng/scene.h"

/// Which finest sub-patches of Bezier patches lie beside each other over patches' edges.
namespace throng::graph {

/// Where a pair touches: the edge of the first patch, and the parameter of the middle along it.
struct EdgePair {
  CellPair cells;
  PatchSide side_a, side_b;
  double at_a = 0, at_b = 0;
  double half_a = 0, half_b = 0;  ///< Half the length along which they touch, likewise.
};

/// All pairs over the edges of one patch that it shares as the first, or the bigger, of the two;
/// over all patches, every pair once. `depth` is each patch's; classes are left 0.
[[nodiscard]] std::vector<EdgePair> edge_pairs(const PatchSet& set, std::span<const int32_t> depth,
                                               uint32_t patch);

/// Parameters (s, t) of a point along an edge, from the edge's first vertex on.
[[nodiscard]] std::array<double, 2> edge_parameters(uint32_t edge, double at);

}  // namespace throng::graph
