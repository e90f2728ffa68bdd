// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bake/columns/triangles.h"
#include "bake/surface/cell_store.h"
#include "bake/surface/node_plan.h"
#include "bake/surface/node_scene.h"
#include "graph/node_data.h"
#include "throng/base.h"
#include "throng/surface.h"

/// From patches and level tiles to nodes, links and widths, so many zones at a time as fit in
/// memory.
namespace throng::bake {

struct NodeBatchInput {
  const World& world;
  NodeRegion& region;  ///< That holds the box around the zones and those near them.
  const NodeConfig& config;
  const NodeBins& bins;
  const NodePlan& plan;
  CellStore* store = nullptr;  ///< Of cells that other batches have judged, or will need.
  bool is_last = false;        ///< The triangles are let go as soon as may be.
  Context& context;
};

/// Nodes of zones; null where there are none.
using NodeSlots = std::vector<std::unique_ptr<graph::NodeData::Slot>>;

/// Makes the nodes of some zones of the plan, given in ascending order, and returns them in it.
/// What lies near these is read, so the results do not depend on which are made together. Fails
/// with kBadInput (off-mesh links), kBadFile (a zone of the ground), kLimit or kCancelled.
[[nodiscard]] Result<NodeSlots> make_node_batch(const NodeBatchInput& input,
                                                std::span<const uint32_t> zones);

/// Only whether the off-mesh links of these zones begin and end at places; fails as make_node_batch
/// does.
[[nodiscard]] Result<void> check_batch_links(const NodeBatchInput& input,
                                             std::span<const uint32_t> zones);

/// What is said of a world with more nodes than numbers.
[[nodiscard]] Error too_many_nodes();

}  // namespace throng::bake
