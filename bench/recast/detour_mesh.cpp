// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "detour_mesh.h"

#include <DetourNavMeshBuilder.h>
#include <Recast.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace throng::bench {
namespace {

template <class T, void (*Free)(T*)>
struct Freed {
  void operator()(T* p) const { Free(p); }
};
template <class T, void (*Free)(T*)>
using Owned = std::unique_ptr<T, Freed<T, Free>>;

// One tile's navigation data, in memory that Detour will own; null where no agent can walk.
unsigned char* make_tile(const RecastInput& input, const std::vector<int>& triangles,
                         const RecastConfig& config, int x, int z, int& size) {
  rcContext context(false);
  rcConfig c{};
  const auto up = [](double value) { return static_cast<int>(std::ceil(value - 1e-6)); };
  c.cs = config.cell;
  c.ch = config.cell_height;
  c.walkableSlopeAngle = static_cast<float>(config.avatar.max_slope);
  c.walkableHeight = std::max(3, up(config.avatar.height / c.ch));
  c.walkableClimb = static_cast<int>(std::floor(config.avatar.step_height / c.ch + 1e-6));
  c.walkableRadius = up(config.avatar.radius / c.cs);
  c.maxEdgeLen = static_cast<int>(12 / c.cs);
  c.maxSimplificationError = 1.3f;
  c.minRegionArea = 8 * 8;
  c.mergeRegionArea = 20 * 20;
  c.maxVertsPerPoly = 6;
  c.tileSize = config.tile;
  c.borderSize = c.walkableRadius + 3;
  c.width = c.height = c.tileSize + 2 * c.borderSize;
  c.detailSampleDist = 6 * c.cs;
  c.detailSampleMaxError = c.ch;
  const float side = static_cast<float>(c.tileSize) * c.cs;
  const float rim = static_cast<float>(c.borderSize) * c.cs;
  std::copy(input.min, input.min + 3, c.bmin);
  std::copy(input.max, input.max + 3, c.bmax);
  c.bmin[0] = input.min[0] + static_cast<float>(x) * side - rim;
  c.bmin[2] = input.min[2] + static_cast<float>(z) * side - rim;
  c.bmax[0] = input.min[0] + static_cast<float>(x + 1) * side + rim;
  c.bmax[2] = input.min[2] + static_cast<float>(z + 1) * side + rim;

  const int count = static_cast<int>(triangles.size() / 3);
  const int vertices = static_cast<int>(input.vertices.size() / 3);
  const Owned<rcHeightfield, rcFreeHeightField> solid(rcAllocHeightfield());
  const Owned<rcCompactHeightfield, rcFreeCompactHeightfield> compact(rcAllocCompactHeightfield());
  const Owned<rcContourSet, rcFreeContourSet> contours(rcAllocContourSet());
  const Owned<rcPolyMesh, rcFreePolyMesh> polygons(rcAllocPolyMesh());
  const Owned<rcPolyMeshDetail, rcFreePolyMeshDetail> detail(rcAllocPolyMeshDetail());
  std::vector<unsigned char> areas(static_cast<size_t>(count), 0);
  if (!rcCreateHeightfield(&context, *solid, c.width, c.height, c.bmin, c.bmax, c.cs, c.ch))
    return nullptr;
  rcMarkWalkableTriangles(&context, c.walkableSlopeAngle, input.vertices.data(), vertices,
                          triangles.data(), count, areas.data());
  rcRasterizeTriangles(&context, input.vertices.data(), vertices, triangles.data(), areas.data(),
                       count, *solid, c.walkableClimb);
  rcFilterLowHangingWalkableObstacles(&context, c.walkableClimb, *solid);
  rcFilterLedgeSpans(&context, c.walkableHeight, c.walkableClimb, *solid);
  rcFilterWalkableLowHeightSpans(&context, c.walkableHeight, *solid);
  if (!rcBuildCompactHeightfield(&context, c.walkableHeight, c.walkableClimb, *solid, *compact) ||
      !rcErodeWalkableArea(&context, c.walkableRadius, *compact) ||
      !rcBuildDistanceField(&context, *compact) ||
      !rcBuildRegions(&context, *compact, c.borderSize, c.minRegionArea, c.mergeRegionArea) ||
      !rcBuildContours(&context, *compact, c.maxSimplificationError, c.maxEdgeLen, *contours) ||
      contours->nconts == 0 ||
      !rcBuildPolyMesh(&context, *contours, c.maxVertsPerPoly, *polygons) ||
      !rcBuildPolyMeshDetail(&context, *polygons, *compact, c.detailSampleDist,
                             c.detailSampleMaxError, *detail)) {
    return nullptr;
  }
  for (int i = 0; i < polygons->npolys; ++i) polygons->flags[i] = 1;
  dtNavMeshCreateParams p{};
  p.verts = polygons->verts;
  p.vertCount = polygons->nverts;
  p.polys = polygons->polys;
  p.polyAreas = polygons->areas;
  p.polyFlags = polygons->flags;
  p.polyCount = polygons->npolys;
  p.nvp = polygons->nvp;
  p.detailMeshes = detail->meshes;
  p.detailVerts = detail->verts;
  p.detailVertsCount = detail->nverts;
  p.detailTris = detail->tris;
  p.detailTriCount = detail->ntris;
  p.walkableHeight = static_cast<float>(config.avatar.height);
  p.walkableRadius = static_cast<float>(config.avatar.radius);
  p.walkableClimb = static_cast<float>(config.avatar.step_height);
  p.tileX = x;
  p.tileY = z;
  std::copy(polygons->bmin, polygons->bmin + 3, p.bmin);
  std::copy(polygons->bmax, polygons->bmax + 3, p.bmax);
  p.cs = c.cs;
  p.ch = c.ch;
  p.buildBvTree = true;
  unsigned char* data = nullptr;
  return dtCreateNavMeshData(&p, &data, &size) ? data : nullptr;
}

}  // namespace

NavMesh make_detour_mesh(const RecastInput& input, const RecastConfig& config,
                         const TileTriangles& tiles, DetourSummary& summary) {
  NavMesh mesh(dtAllocNavMesh());
  const float side = static_cast<float>(config.tile) * config.cell;
  const int tiles_x =
      std::max(1, static_cast<int>(std::ceil((input.max[0] - input.min[0]) / side)));
  dtNavMeshParams params{};
  std::copy(input.min, input.min + 3, params.orig);
  params.tileWidth = params.tileHeight = side;
  params.maxTiles = static_cast<int>(tiles.size());
  params.maxPolys = 1 << 12;
  if (mesh == nullptr || dtStatusFailed(mesh->init(&params))) return nullptr;
  for (size_t t = 0; t < tiles.size(); ++t) {
    if (tiles[t].empty()) continue;
    int size = 0;
    unsigned char* data = make_tile(input, tiles[t], config, static_cast<int>(t) % tiles_x,
                                    static_cast<int>(t) / tiles_x, size);
    if (data == nullptr) continue;
    dtTileRef ref = 0;
    if (dtStatusFailed(mesh->addTile(data, size, DT_TILE_FREE_DATA, 0, &ref))) {
      dtFree(data);
      return nullptr;
    }
    ++summary.tiles;
    summary.polygons += static_cast<uint64_t>(mesh->getTileByRef(ref)->header->polyCount);
    summary.bytes += static_cast<uint64_t>(size);
  }
  return mesh;
}

}  // namespace throng::bench
