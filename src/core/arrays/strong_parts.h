// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

/// The strongly connected parts of a graph with one-way arcs.
namespace throng {

struct StrongParts {
  std::vector<uint32_t> of;  ///< By vertex: its part.
  uint32_t count = 0;
};

/// `degree(v)` is how many arcs a vertex may have, `target(v, k)` where the k-th leads, or
/// UINT32_MAX: nowhere. Linear, without recursion. Source: Tarjan, Depth-first search and linear
/// graph algorithms, 1972.
template <class Degree, class Target>
StrongParts strong_parts(uint32_t vertices, Degree degree, Target target) {
  StrongParts parts{.of = std::vector<uint32_t>(vertices, UINT32_MAX)};
  struct Frame {
    uint32_t vertex, next;
  };
  std::vector<uint32_t> number(vertices, 0), low(vertices, 0), held;
  std::vector<Frame> frames;
  uint32_t visited = 0;
  const auto enter = [&](uint32_t v) {
    number[v] = low[v] = ++visited;
    held.push_back(v);
    frames.push_back({v, 0});
  };
  for (uint32_t root = 0; root < vertices; ++root) {
    if (number[root] != 0) continue;
    enter(root);
    while (!frames.empty()) {
      const uint32_t v = frames.back().vertex;
      if (frames.back().next < degree(v)) {
        const uint32_t to = target(v, frames.back().next++);
        if (to == UINT32_MAX) continue;
        if (number[to] == 0) {
          enter(to);
        } else if (parts.of[to] == UINT32_MAX) {
          low[v] = std::min(low[v], number[to]);
        }
        continue;
      }
      frames.pop_back();
      if (!frames.empty()) {
        uint32_t& above = low[frames.back().vertex];
        above = std::min(above, low[v]);
      }
      if (low[v] != number[v]) continue;
      uint32_t member;
      do {
        member = held.back();
        held.pop_back();
        parts.of[member] = parts.count;
      } while (member != v);
      ++parts.count;
    }
  }
  return parts;
}

}  // namespace throng
