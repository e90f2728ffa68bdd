// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "throng/impostor.h"

/// The colours of a crowd's clothes.
namespace throng::draw {

inline constexpr int32_t kColoursAPart = 12;

/// Twelve linear colours for each body part, red, green, blue: clothes as they are seen in a
/// street, most of them quiet, some bright; skins and hair from everywhere.
[[nodiscard]] std::array<float, 3 * kColoursAPart * kBodyParts> wardrobe();

/// How many outfits a crowd has: a look has eleven bits in what is packed for an avatar.
inline constexpr int32_t kLooks = 2048;

/// The outfit of a look: which of its twelve colours each part has, four bits each. Each part is
/// drawn by a hash of its own, so nearly all looks have different outfits.
[[nodiscard]] uint32_t outfit_of(uint32_t look);

/// Which of its twelve colours each kind of worn part has, four bits each, by a hash of its own.
/// Hair has none: its colour is that of the outfit.
[[nodiscard]] uint32_t worn_colours_of(uint32_t look);

/// How much nearer than where it is a worn part is drawn, so that it covers what it is on: depths
/// of texels are steps of 7 cm. [m]
[[nodiscard]] double worn_ahead(WornKind kind);

}  // namespace throng::draw
