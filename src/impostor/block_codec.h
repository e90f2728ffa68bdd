// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

/// Blocks of 4 x 4 texels that graphics cards read: BC1 (S3TC DXT1) for colours, BC4 (RGTC) for
/// one channel. BC3 is BC4 of alpha before BC1 of colour; BC5 is two BC4.
namespace throng::impostor {

using ColourBlock = std::array<std::array<uint8_t, 4>, 16>;  ///< Red, green, blue, alpha; by row.
using ChannelBlock = std::array<uint8_t, 16>;
using Bytes8 = std::array<uint8_t, 8>;
using TexelWeights = std::array<uint8_t, 16>;  ///< The weight of each texel in the error.

/// Encodes colours with minimal weighted square error. With `holes`, texels of alpha under
/// 128 become transparent.
[[nodiscard]] Bytes8 encode_bc1(const ColourBlock& block, const TexelWeights& weights, bool holes);
/// Alpha becomes 0 or 255. `holes`: as BC1 alone; without, as the second half of BC3.
void decode_bc1(const Bytes8& bytes, bool holes, ColourBlock& block);

[[nodiscard]] Bytes8 encode_bc4(const ChannelBlock& block, const TexelWeights& weights);
void decode_bc4(const Bytes8& bytes, ChannelBlock& block);

}  // namespace throng::impostor
