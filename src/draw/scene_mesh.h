// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "draw/gl_objects.h"
#include "draw/scene_corners.h"
#include "throng/base.h"

namespace throng::draw {

/// A scene's triangles in the card's memory.
class SceneMesh {
 public:
  /// Fails with kLimit.
  [[nodiscard]] Result<void> set(const SceneCorners& scene);
  void draw() const;  ///< All of it.
  /// `chunks` as indices in any order; the pieces are drawn in the order of the mesh.
  void draw(std::vector<uint32_t> chunks) const;
  void draw_ground_plane() const;  ///< The triangles that are in no chunk.
  /// Attributes 3 to 5 are there.
  [[nodiscard]] bool has_surfaces() const { return has_surfaces_; }
  [[nodiscard]] bool has_holes() const { return has_holes_; }
  [[nodiscard]] std::span<const SceneChunk> chunks() const { return chunks_; }
  [[nodiscard]] const Box3d& bounds() const {
    return bounds_;
  }  ///< Of the scene, relative to the origin.

 private:
  GlVertexArray array_;
  GlBuffer buffer_, surfaces_;
  bool has_surfaces_ = false, has_holes_ = false;
  void draw_corners(uint32_t first, uint32_t count) const;

  GLsizei corners_ = 0;
  std::vector<SceneChunk> chunks_;
  Box3d bounds_;
};

}  // namespace throng::draw
