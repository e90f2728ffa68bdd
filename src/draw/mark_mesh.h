// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "draw/gl_objects.h"
#include "throng/base.h"
#include "throng_draw/draw.h"

namespace throng::draw {

/// Marks in the card's memory. A line is two triangles that the vertex shader spreads apart: lines
/// of OpenGL ES are a pixel wide.
class MarkMesh {
 public:
  /// Fails with kLimit.
  [[nodiscard]] Result<void> set(const Marks& marks);
  /// With the marks' program in use and its matrices set; `samples` of a pixel's side.
  void draw(const GlProgram& program, float samples) const;

 private:
  GlVertexArray array_;
  GlBuffer buffer_;
  GLsizei vertices_ = 0;
  float line_width_ = 2;
  bool through_walls_ = false;
};

}  // namespace throng::draw
