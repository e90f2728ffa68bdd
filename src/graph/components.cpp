// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/components.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace throng {
namespace {

// Union-find over parts; the root of a set is its smallest member, so numbers do not depend on the
// order of unions.
class Sets {
 public:
  explicit Sets(size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), uint32_t{0});
  }
  uint32_t find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace

std::vector<ClassComponents> find_components(const RegionGraph& graph, size_t classes,
                                             std::vector<uint32_t>& of_part) {
  // A part belongs to one region and class, so one forest serves all classes.
  Sets sets(graph.cells.size());
  for (const RegionLink& link : graph.links) {
    for (uint32_t left = link.classes; left != 0; left &= left - 1) {
      const int32_t c = std::countr_zero(left);
      sets.join(graph.part(link.a, c), graph.part(link.b, c));
    }
  }
  std::vector<ClassComponents> found(classes);
  of_part.assign(graph.cells.size(), 0);
  for (uint32_t r = 0; r < graph.regions.size(); ++r) {
    for (uint32_t left = graph.regions[r].classes; left != 0; left &= left - 1) {
      const int32_t c = std::countr_zero(left);
      ClassComponents& of_class = found[static_cast<size_t>(c)];
      const uint32_t part = graph.part(r, c), root = sets.find(part);
      if (root == part) {
        of_part[part] = static_cast<uint32_t>(of_class.cells.size());
        of_class.first_region.push_back(r);
        of_class.cells.push_back(0);
        of_class.regions.push_back(0);
      }
      of_part[part] = of_part[root];  // Roots come first.
      of_class.cells[of_part[part]] += graph.cells[part];
      ++of_class.regions[of_part[part]];
    }
  }

  // Largest first.
  std::vector<std::vector<uint32_t>> rank(classes);
  for (size_t c = 0; c < classes; ++c) {
    ClassComponents& of_class = found[c];
    std::vector<uint32_t> order(of_class.cells.size());
    std::iota(order.begin(), order.end(), uint32_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return of_class.cells[a] > of_class.cells[b]; });
    ClassComponents sorted;
    rank[c].resize(order.size());
    for (uint32_t i = 0; i < order.size(); ++i) {
      rank[c][order[i]] = i;
      sorted.first_region.push_back(of_class.first_region[order[i]]);
      sorted.cells.push_back(of_class.cells[order[i]]);
      sorted.regions.push_back(of_class.regions[order[i]]);
    }
    of_class = std::move(sorted);
  }
  for (uint32_t r = 0; r < graph.regions.size(); ++r) {
    for (uint32_t left = graph.regions[r].classes; left != 0; left &= left - 1) {
      const int32_t c = std::countr_zero(left);
      uint32_t& component = of_part[graph.part(r, c)];
      component = rank[static_cast<size_t>(c)][component];
    }
  }
  return found;
}

}  // namespace throng
