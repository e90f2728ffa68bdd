// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/scene.h"

/// Patches for tests, and checks of their triangles.
namespace throng::test {

/// The shape of a net.
struct NetConfig {
  int32_t side = 4;        ///< Cells along x and z.
  double cell = 16;        ///< [m]
  double relief = 6;       ///< Largest vertical offset of vertices. [m]
  double sideways = 3;     ///< Largest horizontal offset of inner vertices. [m]
  double jitter = 0;       ///< Control points of inner borders differ by this between patches. [m]
  bool closed = false;     ///< Closed to a torus, without a border.
  bool split_some = true;  ///< Cells are split into 2 x 2 or 4 x 4 at random.
  uint64_t seed = 1;
};

/// A net of cells with neighbours of all kinds (1, 2, 4), each patch turned at random. Open nets
/// have their border in the planes x, z = 0 and side * cell.
PatchSet make_net(const NetConfig& config);
/// The same as a scene of its triangles, all of them walkable.
Scene net_scene(const NetConfig& config);
/// Any patches as a scene of their triangles.
Scene patch_scene(const PatchSet& set);

/// The same surface with vertex k as vertex k + 1, applied `turns` times.
BezierPatch turn(BezierPatch patch, uint32_t turns);

/// Expects that each triangle's edge has exactly one opposite edge, by index and by position,
/// except on open edges of the triangle's patch; and that no vertex lies inside an edge. Returns
/// how many edges have no opposite edge.
size_t expect_watertight(const PatchSet& set, const PatchMesh& mesh);

/// The largest distance from points of patch p to its triangles, over `samples` points.
double worst_distance(const PatchSet& set, const PatchMesh& mesh, uint32_t p, int32_t samples);

double distance_to_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c);

}  // namespace throng::test
