// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "graph/regions.h"

/// Components: regions that links hold together, per class.
namespace throng {

/// Components of one class, numbered by falling count of cells, then by their first region.
struct ClassComponents {
  std::vector<uint32_t> first_region;  // per component
  std::vector<uint64_t> cells;         // per component
  std::vector<uint64_t> regions;       // per component
};

/// Numbers the components of every class. `of_part` gets, for each part of the graph
/// (RegionGraph::part), its component in its class.
std::vector<ClassComponents> find_components(const RegionGraph& graph, size_t classes,
                                             std::vector<uint32_t>& of_part);

}  // namespace throng
