// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scratch_folder.h"
#include "throng/scene.h"

/// The same upright square in every format that can carry a texture: x from -2 to 2 m, y from 0 to
/// 4 m, facing +z, with texture_of_quarters() on it once.
namespace throng::test {

/// 16 x 16 texels in quarters, row by row: red, green; blue, white.
[[nodiscard]] Texture texture_of_quarters();

/// An uncompressed TGA, rows from the top, which any program can write.
[[nodiscard]] std::string tga_bytes(const Texture& texture);

struct TexturedModel {
  std::string name;                                        ///< Of the format and its variant.
  std::function<std::string(const ScratchFolder&)> write;  ///< Returns the path to load.
};

[[nodiscard]] std::vector<TexturedModel> textured_models();

}  // namespace throng::test
