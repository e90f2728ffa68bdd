// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "throng/impostor.h"

/// Where views lie on the pages of an atlas.
namespace throng::impostor {

inline constexpr int32_t kPageWidth = 1024;
inline constexpr int32_t kPageHeight = 2048;  ///< Every WebGL 2 implementation allows it.
inline constexpr int32_t kMaxPages = 64;
inline constexpr size_t kMaxViews = size_t{1} << 20;  ///< What an instance can name.

struct PageSize {
  int32_t width = 0, height = 0, pages = 0;
};

/// Places rectangles whose sizes are set, multiples of 4 up to 512, without overlap: in rows of
/// about equal height, tallest first. Writes page, x and y. Pages have one size, as low as fits.
[[nodiscard]] PageSize pack_views(std::span<AtlasView> views);

}  // namespace throng::impostor
