// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "impostor/view_packer.h"
#include "throng/impostor.h"

/// Atlases whose colours a test chooses.
namespace throng::test {

inline constexpr int32_t kBlankPixels = 16;  // of a view's side

/// Views of 16 x 16 texels, packed, white all over: 16 directions, 8 elevations, one clip.
inline Atlas blank_atlas(int32_t frames) {
  Atlas atlas;
  atlas.shape = {.pixels = kBlankPixels,
                 .directions = 16,
                 .elevations = 8,
                 .frames = frames,
                 .side = 2,
                 .centre = 1,
                 .height = 2};
  atlas.clips = {{.name = "Walk", .first_frame = 0, .frames = frames, .seconds = 1, .stride = 1.5}};
  atlas.views.assign(static_cast<size_t>(16 * 8 * frames),
                     {.width = kBlankPixels, .height = kBlankPixels});
  const impostor::PageSize size = impostor::pack_views(atlas.views);
  atlas.width = size.width, atlas.height = size.height, atlas.pages = size.pages;
  const auto texels = static_cast<size_t>(size.width * size.height * size.pages);
  atlas.colour.assign(texels * 4, 255);
  atlas.normal.assign(texels * 2, 128);
  atlas.mask.assign(texels, 16);
  return atlas;
}

/// The colour, red first, of a view's texel, counted row by row.
inline uint8_t* texel_of(Atlas& atlas, const AtlasView& view, int32_t texel) {
  const int32_t x = view.x + texel % kBlankPixels, y = view.y + texel / kBlankPixels;
  return &atlas.colour[4 * static_cast<size_t>((view.page * atlas.height + y) * atlas.width + x)];
}

}  // namespace throng::test
