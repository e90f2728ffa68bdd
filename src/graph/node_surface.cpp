// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/node_surface.h"

#include <algorithm>

#include "core/access.h"
#include "throng/scene.h"
#include "world/place.h"

// Points and normals of a patch: of the Bezier surface, or of a level tile's floor.
namespace throng::graph {
namespace {

BezierPatch patch_of(const double* at) {
  BezierPatch out;
  for (Vec3d& p : out.points) {
    p = {at[0], at[1], at[2]};
    at += 3;
  }
  return out;
}

// The ground of a level tile at parameters (s, t).
Vec3d on_tile(const world::WorldData& world, uint32_t level, double s, double t) {
  const world::GroundLevel ground = world::ground_level(world, level, 0);
  if (ground.zone == nullptr) return {};
  const auto [tile_x, tile_z] = world::tile_of(world, *ground.zone, *ground.view.record);
  const auto unit = [](int32_t tile, double at) {
    const double cells = std::clamp(at, 0.0, 1.0) * kTileCells;
    const auto units = static_cast<int64_t>(
        std::min(cells * world::kUnitsPerCell, double{kTileCells} * world::kUnitsPerCell - 1));
    return (int64_t{tile} * kTileCells << world::kUnitBits) + units;
  };
  return world::place_at(world, ground, {unit(tile_x, s), unit(tile_z, t)}).position;
}

}  // namespace

bool NodeSurface::is_there() const {
  return points != nullptr || world->zone(world->slot_of_level(source)) != nullptr;
}

Vec3d NodeSurface::at(double s, double t) const {
  return points != nullptr ? patch_of(points).at(s, t) : on_tile(*world, source, s, t);
}

Vec3d NodeSurface::normal(double s, double t) const {
  return points != nullptr ? patch_of(points).normal(s, t) : Vec3d{0, 1, 0};
}

NodeSurface surface_of(const NodeData& nodes, const NodeZone& zone,
                       const format::NodePatch& patch) {
  const auto kind = static_cast<PatchKind>(patch.kind());
  return {.kind = kind,
          .depth = patch.depth(),
          .source = nodes.source_of(zone, patch),
          .points = kind == PatchKind::kBezier ? zone.points(patch) : nullptr,
          .world = data_of(nodes.world).get()};
}

}  // namespace throng::graph
