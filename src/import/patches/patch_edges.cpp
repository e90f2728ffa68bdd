// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/patches/patch_edges.h"

#include <algorithm>
#include <utility>

#include "core/arrays/disjoint_sets.h"
#include "core/hash.h"

namespace throng::importer {
namespace {

// The same for an edge and its neighbour. Adding zero makes -0 and 0 the same bits.
uint64_t hash_of(const std::array<Vec3d, 4>& curve) {
  uint64_t sum = 0;
  for (const bool backward : {false, true}) {
    std::array<double, 12> numbers;
    for (size_t i = 0; i < 4; ++i) {
      const Vec3d& p = curve[backward ? 3 - i : i];
      numbers[3 * i] = p.x + 0.0;
      numbers[3 * i + 1] = p.y + 0.0;
      numbers[3 * i + 2] = p.z + 0.0;
    }
    sum += hash_bytes(numbers.data(), sizeof numbers);
  }
  return sum;
}

bool opposite(const std::array<Vec3d, 4>& a, const std::array<Vec3d, 4>& b) {
  return a[0] == b[3] && a[1] == b[2] && a[2] == b[1] && a[3] == b[0];
}

uint32_t start_of(PatchSide side) { return 4 * side.patch + side.edge; }
uint32_t end_of(PatchSide side) { return 4 * side.patch + (side.edge + 1) % 4; }

}  // namespace

bool is_collapsed(const std::array<Vec3d, 4>& curve) {
  return curve[0] == curve[1] && curve[0] == curve[2] && curve[0] == curve[3];
}

void bind_equal_edges(PatchSet& set, uint32_t first) {
  std::vector<std::pair<uint64_t, PatchSide>> sides;
  for (uint32_t p = first; p < set.size(); ++p) {
    for (uint32_t e = 0; e < 4; ++e) {
      if (set.edges[p][e].bind != EdgeBind::kOpen) continue;
      const auto curve = set.patches[p].edge(static_cast<int32_t>(e));
      if (!is_collapsed(curve)) sides.push_back({hash_of(curve), {p, e}});
    }
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].first == sides[i].first) ++end;
    const PatchSide a = sides[i].second;
    const PatchSide b = sides[end - 1].second;
    if (end - i == 2 && opposite(set.patches[a.patch].edge(static_cast<int32_t>(a.edge)),
                                 set.patches[b.patch].edge(static_cast<int32_t>(b.edge)))) {
      set.bind(a, b);
    }
    i = end;
  }
}

std::vector<uint32_t> weld_corners(const PatchSet& set) {
  DisjointSets groups(4 * set.size());
  for (uint32_t p = 0; p < set.size(); ++p) {
    for (uint32_t e = 0; e < 4; ++e) {
      const PatchEdge& edge = set.edges[p][e];
      const PatchSide side{p, e};
      if (is_collapsed(set.patches[p].edge(static_cast<int32_t>(e)))) {
        groups.join(start_of(side), end_of(side));
      }
      if (edge.bind == EdgeBind::kPart) continue;  // The larger edge does it.
      const size_t count = neighbour_count(edge.bind);
      for (size_t k = 0; k < count; ++k) {
        // Neighbours run in the opposite direction: the first one ends where this edge starts.
        groups.join(k == 0 ? start_of(side) : start_of(edge.next[k - 1]), end_of(edge.next[k]));
      }
      if (count > 0) groups.join(end_of(side), start_of(edge.next[count - 1]));
    }
  }
  std::vector<uint32_t> corner(4 * set.size());
  for (uint32_t i = 0; i < corner.size(); ++i) corner[i] = groups.find(i);
  return corner;
}

}  // namespace throng::importer
