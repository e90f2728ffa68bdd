// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "world/region_data.h"

/// How the index of a graph holds the components of the world: they are all read when it is opened,
/// so they are packed as numbers of 7 bits a byte, by what changes from one to the next. A place
/// where several classes have a component each is told once.
namespace throng {

struct PackedComponents {
  std::vector<uint8_t> sizes;     // of the components, class by class
  std::vector<uint8_t> of_zones;  // what those of the zones belong to, and where it begins
};

PackedComponents pack_components(const GraphData& graph);

/// Fills the components of a graph whose slots and `class_first`, from 0 on and in order, are
/// there. What is wrong with them, or null.
const char* unpack_components(std::span<const uint8_t> sizes, std::span<const uint8_t> of_zones,
                              const WorldData& world, GraphData& graph);

}  // namespace throng
