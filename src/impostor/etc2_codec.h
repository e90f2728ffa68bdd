// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "impostor/block_codec.h"

/// Blocks of 4 x 4 texels that the graphics cards of phones read: ETC2 for colours, EAC for one
/// channel. RGBA8 is EAC of alpha before ETC2 of colour; RG11 is two EAC of 11 bits. Texels are
/// given by row, though the blocks hold them by column. Source: [KDF].
namespace throng::impostor {

using WideChannelBlock = std::array<uint16_t, 16>;  ///< 11 bits each, by row.

/// Encodes colours with minimal weighted square error. With `holes` (punch-through alpha), texels
/// of alpha under 128 become transparent.
[[nodiscard]] Bytes8 encode_etc2(const ColourBlock& block, const TexelWeights& weights, bool holes);
/// Alpha becomes 0 or 255 with `holes`, and stays what it is without. Transparent texels are black.
void decode_etc2(const Bytes8& bytes, bool holes, ColourBlock& block);

/// 8 bits, for alpha.
[[nodiscard]] Bytes8 encode_eac(const ChannelBlock& block, const TexelWeights& weights);
void decode_eac(const Bytes8& bytes, ChannelBlock& block);

/// The same 8 bits in a block of 11 bits a texel: each is nearest to value * 2047 / 255.
[[nodiscard]] Bytes8 encode_eac11(const ChannelBlock& block, const TexelWeights& weights);
void decode_eac11(const Bytes8& bytes, WideChannelBlock& block);

}  // namespace throng::impostor
