// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "throng/avatar.h"
#include "throng/scene.h"

/// The part of Recast that does what our bake does: triangles to a compact heightfield on which the
/// walkable area is eroded by the body's radius. For comparison only.
namespace throng::bench {

/// A scene as Recast wants it.
struct RecastInput {
  std::vector<float> vertices;  ///< x y z
  std::vector<int> triangles;
  float min[3] = {0, 0, 0};
  float max[3] = {0, 0, 0};
};

RecastInput make_recast_input(const Scene& scene);

struct RecastConfig {
  float cell = 0.1f;         ///< [m]
  float cell_height = 0.1f;  ///< [m]
  AvatarClass avatar;
  int32_t tile = 0;  ///< Side of a tile without its border, 0: one heightfield. [cells]
};

/// A floor cell that is left after the erosion, to compare heights.
struct RecastFloor {
  int32_t x = 0;
  int32_t z = 0;
  float height = 0;  ///< [m]
};

struct RecastResult {
  uint64_t spans = 0;     ///< Compact spans, borders of tiles not counted.
  uint64_t walkable = 0;  ///< Spans left after the erosion.
  uint64_t bytes = 0;     ///< Of all compact heightfields: cells, spans, areas.
};

/// Triangles under each tile, so that a tiled bake does not look at all of them. Made outside the
/// measured time, as Recast's own demo does it.
using TileTriangles = std::vector<std::vector<int>>;
TileTriangles sort_into_tiles(const RecastInput& input, const RecastConfig& config);

/// Rasterise, filter low hanging obstacles, ledges and low spans, compact, erode.
RecastResult recast_bake(const RecastInput& input, const RecastConfig& config,
                         const TileTriangles& tiles, std::vector<RecastFloor>* floors = nullptr);

}  // namespace throng::bench
