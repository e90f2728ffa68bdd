// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "throng/impostor.h"

/// The colours of a crowd's clothes.
namespace throng::draw {

inline constexpr int32_t kColoursAPart = 12;

/// Twelve linear colours for each body part, red, green, blue: clothes as they are seen in a
/// street, most of them quiet, some bright; skins and hair from everywhere.
[[nodiscard]] std::array<float, 3 * kColoursAPart * kBodyParts> wardrobe();

}  // namespace throng::draw
