// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "draw/gl_objects.h"
#include "throng/base.h"
#include "throng/impostor.h"

namespace throng::draw {

/// A FigureModel in the card's memory: poses in a texture, one vertex buffer, drawn once for all.
class ModelMesh {
 public:
  /// Fails with kLimit: more poses than a texture holds.
  [[nodiscard]] static Result<ModelMesh> create(const FigureModel& model);
  /// Draws `instances` of a clip, with the program in use that they are set in.
  void draw(const GlProgram& program, size_t clip, size_t instances) const;
  /// Of any pose from a point this high over the feet. [m]
  [[nodiscard]] double extent(double centre) const;

 private:
  std::vector<AtlasClip> clips_;
  uint32_t vertices_ = 0;
  GLsizei indices_ = 0;
  Vec3d low_, high_;
  GlTexture poses_;
  GlVertexArray array_;
  GlBuffer paint_, index_;
};

}  // namespace throng::draw
