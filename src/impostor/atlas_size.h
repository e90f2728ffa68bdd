// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "throng/impostor.h"

/// Sizes in bytes of the arrays of an atlas.
namespace throng::impostor {

inline bool in_blocks(AtlasFormat format) { return format >= AtlasFormat::kBc1; }

/// On all pages.
inline size_t texel_count(const Atlas& atlas) {
  return static_cast<size_t>(atlas.width) * static_cast<size_t>(atlas.height) *
         static_cast<size_t>(atlas.pages);
}

inline size_t colour_bytes(AtlasFormat format, size_t texels) {
  switch (format) {
    case AtlasFormat::kRgba8:
      return texels * 4;
    case AtlasFormat::kRgb5a1:
      return texels * 2;
    case AtlasFormat::kBc1:
    case AtlasFormat::kEtc2a1:
      return texels / 2;
    case AtlasFormat::kBc3:
    case AtlasFormat::kEtc2:
      return texels;
  }
  return 0;
}

inline size_t normal_bytes(AtlasFormat format, size_t texels) {
  return in_blocks(format) ? texels : texels * 2;
}

}  // namespace throng::impostor
