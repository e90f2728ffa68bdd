// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "draw/gl_objects.h"
#include "draw/hidden_avatars.h"
#include "throng/impostor.h"

namespace throng {

/// An atlas in the card's memory, and what the processor needs of it.
struct AtlasTextures {
  /// Fails with kLimit: pages larger than textures may be.
  [[nodiscard]] static Result<AtlasTextures> make(const Atlas& atlas);
  /// Binds colours, details and views to units 0, 1 and 2 and sets the program's numbers.
  void bind(const GlProgram& program) const;

  Atlas shape;                                      ///< Without texels.
  std::vector<FigureReach> reaches;                 ///< Of each view.
  std::array<float, 3 * kBodyParts> part_colour{};  ///< Linear.
  GlTexture colour, detail, views;
};

}  // namespace throng
