// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <DetourNavMesh.h>

#include <cstdint>
#include <memory>

#include "recast_bake.h"

/// A Detour navigation mesh as Recast's own tiled sample makes it. For comparison only.
namespace throng::bench {

struct FreeNavMesh {
  void operator()(dtNavMesh* mesh) const { dtFreeNavMesh(mesh); }
};
using NavMesh = std::unique_ptr<dtNavMesh, FreeNavMesh>;

struct DetourSummary {
  uint64_t tiles = 0;
  uint64_t polygons = 0;
  uint64_t bytes = 0;
};

/// Tiles of `config.tile` cells, watershed regions, contours within 1.3 cells, polygons of up to
/// six corners, detail heights. Null if a tile cannot be made.
NavMesh make_detour_mesh(const RecastInput& input, const RecastConfig& config,
                         const TileTriangles& tiles, DetourSummary& summary);

}  // namespace throng::bench
