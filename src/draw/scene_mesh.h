// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "draw/gl_objects.h"
#include "draw/scene_corners.h"
#include "throng/math.h"
#include "throng/result.h"

namespace throng {

/// A scene's triangles in the card's memory.
class SceneMesh {
 public:
  /// Fails with kLimit.
  [[nodiscard]] Result<void> set(const SceneCorners& scene);
  void draw() const;
  [[nodiscard]] const Box3d& bounds() const {
    return bounds_;
  }  ///< Of the scene, relative to the origin.

 private:
  GlVertexArray array_;
  GlBuffer buffer_;
  GLsizei corners_ = 0;
  Box3d bounds_;
};

}  // namespace throng
