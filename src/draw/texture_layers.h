// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "draw/gl_objects.h"
#include "throng/base.h"
#include "throng/scene.h"

/// A scene's textures as layers of one: all brought to one size, so that a scene needs no change of
/// textures between its triangles.
namespace throng::draw {

inline constexpr size_t kMaxLayers = 256;  // What any card has.

/// The layers of a scene's textures, one entry each.
struct LayerOf {
  uint32_t layer1 = 0;  ///< Plus one; 0: it has none, and its mean stands in.
  std::array<uint8_t, 4> mean{255, 255, 255, 255};
};

struct TextureLayers {
  int32_t side = 0;  ///< Of a layer's first level, a power of two; 0: there are none. [px]
  int32_t layers = 0;
  /// RGBA, layer by layer, each level half as large as the one before, down to one texel. In
  /// smaller levels a colour counts by its opacity.
  std::vector<std::vector<uint8_t>> levels;
  std::vector<LayerOf> of_texture;
};

/// Layers for those textures that a part uses. Layers are as large as the largest texture, but all
/// together take no more than `budget` bytes without smaller levels.
[[nodiscard]] TextureLayers make_texture_layers(const Scene& scene, size_t budget);

/// The same in the card's memory.
class SurfaceTextures {
 public:
  /// Fails with kLimit. `smooth`: anisotropic filtering, if the card has it.
  [[nodiscard]] Result<void> set(const TextureLayers& layers, bool smooth);
  void bind(GLenum unit) const;  ///< Nothing where there are none.

 private:
  GlTexture texture_;
  bool any_ = false;
};

}  // namespace throng::draw
