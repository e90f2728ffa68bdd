// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "graph/tile_regions.h"
#include "throng/world.h"

/// The graph of a whole world, made tile by tile without zones: the oracle of the two passes over
/// zones and of their files.
namespace throng::test {

struct WholeGraph {
  struct Component {
    uint64_t cells = 0, regions = 0;
    uint32_t first_region = 0;
  };

  std::vector<graph::Region> regions;              // in order of levels
  std::vector<graph::RegionLink> links;            // a < b, by a, then b
  std::vector<std::vector<int64_t>> component;     // per class and region; -1: illegal there
  std::vector<std::vector<Component>> components;  // per class, the largest first
};

/// All zones must be usable.
WholeGraph whole_graph(const World& world);

}  // namespace throng::test
