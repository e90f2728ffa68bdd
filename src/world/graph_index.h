// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "world/region_data.h"

/// How the index of a graph holds the components of the world: they are all read when it is opened,
/// so they are packed as numbers of 7 bits a byte, in the order in which zones have them, by what
/// changes from one to the next. What several classes have in one place is stored once; their order
/// in the graph, the largest first, then as here, is found again.
namespace throng::world {

/// Puts the components of each class, in the order in which zones have them, into a graph: the
/// largest first, then as they are. Where each went, by class, from that class's first on.
std::vector<std::vector<uint32_t>> rank_components(
    std::span<const std::vector<GraphComponent>> found, GraphData& graph);

std::vector<uint8_t> pack_components(const GraphData& graph);

/// Fills the components of a graph whose slots and `class_first`, from 0 on and in order, are
/// there. What is wrong with them, or null.
const char* unpack_components(std::span<const uint8_t> packed, const WorldData& world,
                              GraphData& graph);

}  // namespace throng::world
