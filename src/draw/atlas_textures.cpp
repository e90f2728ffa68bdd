// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/atlas_textures.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace throng {
namespace {

constexpr GLsizei kViewsWide = 1024;  // Two texels a view.

void filter(GLenum target, GLint small, GLint large) {
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, small);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, large);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void upload_pages(const Atlas& atlas, const std::vector<uint8_t>& four_bytes) {
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, atlas.width, atlas.height, atlas.pages, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, four_bytes.data());
}

void upload_views(const Atlas& atlas) {
  const size_t rows = (atlas.views.size() * 2 + kViewsWide - 1) / kViewsWide;
  std::vector<uint16_t> words(rows * kViewsWide * 4);
  for (size_t i = 0; i < atlas.views.size(); ++i) {
    const AtlasView& v = atlas.views[i];
    const uint16_t eight[] = {v.x, v.y, v.width, v.height, v.left, v.top, v.page, 0};
    std::copy_n(eight, 8, words.begin() + static_cast<ptrdiff_t>(i * 8));
  }
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16UI, kViewsWide, static_cast<GLsizei>(rows), 0,
               GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, words.data());
}

}  // namespace

Result<AtlasTextures> AtlasTextures::make(const Atlas& packed) {
  GLint largest = 0, layers = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
  if (packed.width > largest || packed.height > largest || packed.pages > layers) {
    return Error{Errc::kLimit, "drawing: the atlas has pages larger than this card's textures (" +
                                   std::to_string(largest) + "); make it with fewer pixels"};
  }
  const Atlas atlas = convert_atlas(packed, AtlasFormat::kRgba8);
  AtlasTextures out;
  out.shape.shape = atlas.shape;
  out.reaches = reaches_of(atlas);
  out.shape.clips = atlas.clips;
  out.shape.width = atlas.width;
  out.shape.height = atlas.height;
  for (size_t i = 0; i < out.part_colour.size(); ++i) {
    const float stored = static_cast<float>(atlas.part_colour[i / 3][i % 3]) / 255;
    out.part_colour[i] = std::max(0.02F, stored * stored);
  }
  out.colour = make_texture();
  glBindTexture(GL_TEXTURE_2D_ARRAY, out.colour.get());
  upload_pages(atlas, atlas.colour);
  // Views keep to blocks of four texels, so two levels do not mix them.
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 2);
  glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
  filter(GL_TEXTURE_2D_ARRAY, GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
  std::vector<uint8_t> detail(atlas.colour.size());
  for (size_t i = 0; i < atlas.mask.size(); ++i) {
    detail[i * 4] = atlas.normal[i * 2];
    detail[i * 4 + 1] = atlas.normal[i * 2 + 1];
    detail[i * 4 + 2] = atlas.mask[i];
  }
  out.detail = make_texture();
  glBindTexture(GL_TEXTURE_2D_ARRAY, out.detail.get());
  upload_pages(atlas, detail);
  filter(GL_TEXTURE_2D_ARRAY, GL_NEAREST, GL_NEAREST);
  out.views = make_texture();
  glBindTexture(GL_TEXTURE_2D, out.views.get());
  upload_views(atlas);
  filter(GL_TEXTURE_2D, GL_NEAREST, GL_NEAREST);
  return out;
}

void AtlasTextures::bind(const GlProgram& program) const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D_ARRAY, colour.get());
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D_ARRAY, detail.get());
  glActiveTexture(GL_TEXTURE2);
  glBindTexture(GL_TEXTURE_2D, views.get());
  program.set("albedo", 0);
  program.set("detail", 1);
  program.set("views", 2);
  program.set("side", static_cast<float>(shape.shape.side));
  program.set("centre", static_cast<float>(shape.shape.centre));
  program.set("pixels", static_cast<float>(shape.shape.pixels));
  program.set_colours("part_colour", part_colour.data(), kBodyParts);
  program.set_size("page", static_cast<float>(shape.width), static_cast<float>(shape.height));
}

}  // namespace throng
