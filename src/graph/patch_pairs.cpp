// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/patch_pairs.h"

#include <algorithm>

// Pairs of finest sub-patches that touch over the edges of Bezier patches: one to one, or one to
// two or four. Linear in the sub-patches along the edges.
namespace throng::graph {
namespace {

// Cell k of 2^depth along an edge, from its first vertex on.
uint32_t edge_cell(uint32_t edge, int32_t depth, uint32_t k) {
  const uint32_t last = (1u << depth) - 1;
  const auto cell = [&](uint32_t s, uint32_t t) { return (t << depth) + s; };
  switch (edge) {
    case 0:
      return cell(0, k);
    case 1:
      return cell(k, last);
    case 2:
      return cell(last, last - k);
    default:
      return cell(last - k, 0);
  }
}

}  // namespace

std::array<double, 2> edge_parameters(uint32_t edge, double at) {
  switch (edge) {
    case 0:
      return {0, at};
    case 1:
      return {at, 1};
    case 2:
      return {1, 1 - at};
    default:
      return {1 - at, 0};
  }
}

std::vector<EdgePair> edge_pairs(const PatchSet& set, std::span<const int32_t> depth,
                                 uint32_t patch) {
  std::vector<EdgePair> pairs;
  for (uint32_t e = 0; e < 4; ++e) {
    const PatchEdge& edge = set.edges[patch][e];
    uint32_t parts = 0;
    if (edge.bind == EdgeBind::kOne) parts = 1;
    if (edge.bind == EdgeBind::kTwo) parts = 2;
    if (edge.bind == EdgeBind::kFour) parts = 4;
    for (uint32_t k = 0; k < parts; ++k) {
      const PatchSide other = edge.next[k];
      const PatchSide self{patch, e};
      // One to one: only from the first of the two sides.
      if (parts == 1 && std::pair(other.patch, other.edge) < std::pair(self.patch, self.edge)) {
        continue;
      }
      const uint32_t ours = 1u << depth[patch], theirs = 1u << depth[other.patch];
      const uint32_t steps = std::max({theirs, ours / parts, 1u});
      for (uint32_t i = 0; i < steps; ++i) {
        const double at_b =
            (i + 0.5) / steps;  // The neighbour's edge runs in the opposite direction.
        const double at_a = (k + 1 - at_b) / parts;
        const auto cell_a = static_cast<uint32_t>(at_a * ours);
        const auto cell_b = static_cast<uint32_t>(at_b * theirs);
        pairs.push_back({.cells = {.patch_a = patch,
                                   .cell_a = edge_cell(e, depth[patch], cell_a),
                                   .patch_b = other.patch,
                                   .cell_b = edge_cell(other.edge, depth[other.patch], cell_b),
                                   .side_a = static_cast<uint8_t>(e),
                                   .side_b = static_cast<uint8_t>(other.edge)},
                         .side_a = self,
                         .side_b = other,
                         .at_a = at_a,
                         .at_b = at_b,
                         .half_a = 0.5 / steps / parts,
                         .half_b = 0.5 / steps});
      }
    }
  }
  return pairs;
}

}  // namespace throng::graph
