// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "draw/gl_objects.h"
#include "throng/base.h"
#include "throng_draw/draw.h"

namespace throng::draw {

/// A panel and its texture in the card's memory.
class PanelMesh {
 public:
  /// Fails with kLimit.
  [[nodiscard]] Result<void> set_texture(int32_t width, int32_t height,
                                         std::span<const uint8_t> alpha);
  /// Draws over a picture of width x height pixels that has `samples` along each side of a pixel.
  void draw(const GlProgram& program, const PanelView& panel, int32_t width, int32_t height,
            int32_t samples);

 private:
  GlTexture texture_;
  GlVertexArray array_;
  GlBuffer vertices_, indices_;
};

}  // namespace throng::draw
