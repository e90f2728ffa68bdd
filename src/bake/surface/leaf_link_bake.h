// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "bake/surface/node_folder.h"
#include "throng/surface.h"
#include "throng/world.h"

/// The second pass over nodes and air: links between leaves of the air and the nodes under them.
namespace throng::bake {

/// Adds to a folder that holds all nodes of a world, before it is finished, their links to the
/// world's air; none, if the world has no air. Zones of earlier bakes whose input is the same are
/// reused, unless the config says otherwise. The same for any number of workers. Linear in the
/// cells of the nodes and in the voxels times the widths of bodies. Fails with kBadFile, kIo or
/// kCancelled. [the world was opened from the folder's]
[[nodiscard]] Result<void> link_to_air(const World& world, const graph::NodeData& nodes,
                                       const NodeConfig& config, NodeFolder& folder,
                                       Context& context);

}  // namespace throng::bake
