// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "draw/texture_layers.h"
#include "throng/base.h"
#include "throng/scene.h"

/// A scene's triangles in the form that the card reads: three corners each, no index, because flat
/// normals are not shared.
namespace throng::draw {

struct SceneCorner {
  std::array<float, 3> position{};
  std::array<int8_t, 3> normal{};
  /// Bit k: the side opposite to the triangle's corner k is an edge. Higher bits: 0 for the ground
  /// around the scene, else 1 to 31, the tint of the part.
  uint8_t edges_tint = 0;
};
static_assert(sizeof(SceneCorner) == 16);

/// Further attributes of a corner in a scene with materials.
struct SurfaceCorner {
  std::array<float, 2> place{};    ///< In the texture.
  std::array<uint8_t, 4> paint{};  ///< Roots of red, green, blue in linear light; how opaque.
  uint16_t look = 0;  ///< 0: nothing is known of the surface, 1: paint alone, else layer plus two.
  uint8_t threshold = 0;  ///< 0: opaque, 255: blended, else of holes.
  uint8_t spare = 0;
};
static_assert(sizeof(SurfaceCorner) == 16);

/// A run of corners, and a box around what they span.
struct SceneChunk {
  Box3d box;
  uint32_t first = 0, count = 0;
};

struct SceneCorners {
  std::vector<SceneCorner> corners;
  std::vector<SurfaceCorner> surfaces;  ///< One a corner; empty where there are no materials.
  bool has_holes = false;               ///< Some surface lets light through.
  std::vector<SceneChunk> chunks;       ///< See sort_into_chunks. Without the ground plane.
  Box3d bounds;                         ///< Without the ground plane, relative to the origin.
  Vec3d origin;
};

/// Fails with kLimit. `textures`: the layers of the scene's textures.
[[nodiscard]] Result<SceneCorners> scene_corners(const Scene& scene, Vec3d origin,
                                                 std::span<const LayerOf> textures = {});
/// Adds a plane just under the lowest point, out to the haze, on which the scene stands.
void add_ground_plane(SceneCorners& scene);

}  // namespace throng::draw
