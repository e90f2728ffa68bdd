// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "graph/node_data.h"
#include "throng/base.h"
#include "throng/surface.h"

/// The ground of a node's patch.
namespace throng::graph {

/// A Bezier patch or a level tile, by parameters from 0 to 1. Points into the nodes' data.
struct NodeSurface {
  PatchKind kind = PatchKind::kLevelTile;
  uint8_t depth = 0;               ///< 2^depth x 2^depth cells.
  uint32_t source = 0;             ///< Bezier patch of the scene, or level of the world.
  const double* points = nullptr;  ///< A Bezier patch's 48 numbers.
  const world::WorldData* world = nullptr;

  /// False of a level tile whose zone cannot be used.
  [[nodiscard]] bool is_there() const;
  /// (0, 0, 0) if it is not there.
  [[nodiscard]] Vec3d at(double s, double t) const;
  /// Straight up on level tiles.
  [[nodiscard]] Vec3d normal(double s, double t) const;
};

[[nodiscard]] NodeSurface surface_of(const NodeData& nodes, const NodeZone& zone,
                                     const format::NodePatch& patch);

}  // namespace throng::graph
