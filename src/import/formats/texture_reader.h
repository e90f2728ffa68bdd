// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "import/raw/raw_scene.h"
#include "throng/base.h"
#include "throng/scene.h"

/// Pictures of surfaces, wherever a model keeps them.
namespace throng::importer {

/// PNG, JPEG, TGA, BMP. Halved until no side is longer than `max_side`; at most 2^26 texels before.
/// Fails with kBadFile and a clause that names the fault.
[[nodiscard]] Result<Texture> decode_texture(std::string_view bytes, int32_t max_side);

/// One texture of a model: bytes that it holds, or a file beside it. Fails like decode_texture.
[[nodiscard]] Result<Texture> read_texture(const TextureSource& source, const std::string& model,
                                           int32_t max_side);

/// How each texture is read: tests put decoders here that crash, hang or eat memory.
struct TextureDecoding {
  Result<Texture> (*read)(const TextureSource&, const std::string&, int32_t) = &read_texture;
  uint64_t bytes = uint64_t{2} << 30;  ///< Memory of the child that decodes. [> 0]
  uint64_t seconds = 10;               ///< Of a processor, for one texture. [> 0]
};

/// Turns `raw.textures` into those of its scene; materials whose texture cannot be used get a plain
/// colour. They are decoded in a child process, so a file that crashes the decoder is just one
/// that cannot be used. Fails with kCancelled.
[[nodiscard]] Result<void> read_textures(RawScene& raw, const std::string& model, Context& context,
                                         const TextureDecoding& decoding = {});

/// Decodes each of `sources`; one implementation with child processes and one without.
[[nodiscard]] Result<std::vector<Result<Texture>>> read_all_textures(
    const std::vector<TextureSource>& sources, const std::string& model, int32_t max_side,
    Context& context, const TextureDecoding& decoding);

}  // namespace throng::importer
