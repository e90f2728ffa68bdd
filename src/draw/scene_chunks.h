// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "draw/depth_pyramid.h"
#include "draw/matrix.h"
#include "draw/scene_corners.h"
#include "throng/base.h"

/// Pieces of a scene that are drawn or left out as a whole.
namespace throng::draw {

/// Sorts triangles into cubic cells of about five hundred each and lists them in `scene.chunks`.
void sort_into_chunks(SceneCorners& scene);

/// Indices of the chunks of which something may lie in the clip space of `clip_from_world`,
/// nearest to `eye` first.
[[nodiscard]] std::vector<uint32_t> chunks_in_view(std::span<const SceneChunk> chunks,
                                                   const Matrix& clip_from_world, Vec3d eye);

/// Removes the chunks that the pyramid hides. The pyramid must be of the same view.
void drop_hidden_chunks(std::span<const SceneChunk> chunks, const Matrix& clip_from_world,
                        const DepthPyramid& depths, std::vector<uint32_t>& indices);

}  // namespace throng::draw
