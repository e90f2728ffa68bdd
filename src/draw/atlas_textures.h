// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "draw/gl_objects.h"
#include "draw/hidden_avatars.h"
#include "throng/impostor.h"

namespace throng::draw {

/// Can the card read colours of this format as they are, in blocks of 4 x 4 texels (S3TC, ETC2)?
[[nodiscard]] bool takes_blocks(AtlasFormat format);

/// An atlas in the card's memory, and the part of it that the processor needs.
struct AtlasTextures {
  /// Fails with kLimit: pages larger than textures may be.
  [[nodiscard]] static Result<AtlasTextures> create(const Atlas& atlas);
  /// Binds colours, details and views to units 0, 1 and 2 and sets the program's numbers.
  void bind(const GlProgram& program) const;

  Atlas shape;                                  ///< Without texels.
  std::vector<FigureExtent> extents;            ///< Of each view.
  std::array<float, kBodyParts> part_bright{};  ///< On the mean, of linear light.
  size_t colour_bytes = 0;  ///< Of the largest level: blocks stay blocks where the card reads them.
  GlTexture colour, detail, views;
  std::vector<uint32_t> worn;  ///< By look: worn_by(). Empty if the atlas has no parts.
};

}  // namespace throng::draw
