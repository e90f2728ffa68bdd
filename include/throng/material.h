// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Materials and textures of surfaces. Drawing uses them, a bake does not.
namespace throng {

/// How a surface lets light through.
enum class Opacity : uint8_t {
  kOpaque,
  kHoles,    ///< Nothing where colour and texture are less opaque than the threshold.
  kBlended,  ///< As opaque as colour and texture are.
};

/// A material of surfaces.
struct Material {
  std::string name;
  /// Red, green, blue in linear light, and opacity; multiplies the texels of a texture. [0 to 1]
  std::array<float, 4> colour{1, 1, 1, 1};
  uint32_t texture1 = 0;  ///< Index into Scene::textures plus one; 0: none.
  Opacity opacity = Opacity::kOpaque;
  float threshold = 0.5F;  ///< Of holes. [0 to 1]
};

/// A picture on a surface: red, green, blue as sRGB and opacity, 8 bits each, rows from the top. It
/// repeats in both directions.
struct Texture {
  std::string name;
  int32_t width = 0, height = 0;  ///< [px, > 0]
  std::vector<uint8_t> rgba;
};

/// Texture coordinates of a triangle's corners: to the right and down, in whole textures.
using TextureCorners = std::array<std::array<float, 2>, 3>;

}  // namespace throng
