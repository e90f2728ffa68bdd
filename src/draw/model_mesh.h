// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "draw/gl_objects.h"
#include "throng/base.h"
#include "throng/impostor.h"

namespace throng::draw {

/// A FigureModel in the card's memory: poses in a texture, one vertex buffer, drawn once for all.
class ModelMesh {
 public:
  /// Fails with kLimit: more poses than a texture holds.
  [[nodiscard]] static Result<ModelMesh> create(const FigureModel& model);
  /// Draws `instances` of a clip, with the program in use that they are set in. `layer`: 0 for the
  /// body, else a worn part's number plus one.
  void draw(const GlProgram& program, size_t clip, size_t layer, size_t instances) const;
  /// Of the body and the worn parts.
  [[nodiscard]] size_t layers() const { return first_index_.size() - 1; }
  /// Of any pose from a point this high over the feet. [m]
  [[nodiscard]] double extent(double centre) const;

 private:
  std::vector<AtlasClip> clips_;
  uint32_t vertices_ = 0;
  std::vector<size_t> first_index_;  // Of each layer, and the end.
  Vec3d low_, high_;
  GlTexture poses_;
  GlVertexArray array_;
  GlBuffer paint_, index_;
};

}  // namespace throng::draw
