// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "draw/depth_pyramid.h"
#include "draw/gl_objects.h"
#include "throng/base.h"

namespace throng::draw {

/// Brings the depths of a picture that is being drawn to the processor, as a pyramid. The card
/// takes the furthest of each block: OpenGL ES cannot read depths back, and it is less to send.
class DepthReader {
 public:
  /// Fails with kNotFound: the driver refuses a shader.
  [[nodiscard]] Result<void> make_program();
  /// Waits until all that was drawn is done. Leaves another framebuffer, viewport and program in
  /// use, and no depth test.
  void read(const GlTexture& depth, GLsizei width, GLsizei height, DepthPyramid& out);

 private:
  GlProgram program_;
  GlVertexArray nothing_;
  GlTexture blocks_;
  GlFramebuffer frame_;
  GLsizei width_ = 0, height_ = 0;  // In blocks.
  std::vector<uint32_t> words_;
  std::vector<float> furthest_;
};

}  // namespace throng::draw
