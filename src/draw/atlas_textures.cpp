// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/atlas_textures.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "draw/wardrobe.h"

// Uploads an atlas: colours as blocks where the card reads them, else unpacked; details; views.
namespace throng::draw {
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

#ifndef GL_COMPRESSED_RGBA_S3TC_DXT1_EXT
#define GL_COMPRESSED_RGBA_S3TC_DXT1_EXT 0x83F1
#define GL_COMPRESSED_RGBA_S3TC_DXT5_EXT 0x83F3
#endif

// The internal format of blocks in OpenGL; 0 for formats without blocks.
GLenum kind_of(AtlasFormat format) {
  switch (format) {
    case AtlasFormat::kBc1:
      return GL_COMPRESSED_RGBA_S3TC_DXT1_EXT;
    case AtlasFormat::kBc3:
      return GL_COMPRESSED_RGBA_S3TC_DXT5_EXT;
    case AtlasFormat::kEtc2a1:
      return GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2;
    case AtlasFormat::kEtc2:
      return GL_COMPRESSED_RGBA8_ETC2_EAC;
    default:
      return 0;
  }
}

bool takes_s3tc() {
  // The desktop's name, and the browser's with both prefixes.
  return has_extension({"GL_EXT_texture_compression_s3tc", "GL_WEBGL_compressed_texture_s3tc",
                        "WEBGL_compressed_texture_s3tc"});
}

// OpenGL ES 3.0 includes it; a browser has it only where the card itself does, not where a driver
// would unpack it.
bool takes_etc2() {
#ifdef __EMSCRIPTEN__
  return has_extension({"GL_WEBGL_compressed_texture_etc", "WEBGL_compressed_texture_etc"});
#else
  const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  if (version != nullptr && std::string_view(version).starts_with("OpenGL ES")) return true;
  return has_extension({"GL_ARB_ES3_compatibility"});
#endif
}

// Half as many texels along each axis, like the next level that a card makes, except that a colour
// counts by its opacity. Rows and columns are filled up to whole blocks.
Atlas half_of(const Atlas& atlas) {
  Atlas out;
  out.pages = atlas.pages;
  const int32_t across = atlas.width / 2, down = atlas.height / 2;
  out.width = (across + 3) / 4 * 4;
  out.height = (down + 3) / 4 * 4;
  const size_t texels = static_cast<size_t>(out.width) * static_cast<size_t>(out.height) *
                        static_cast<size_t>(out.pages);
  out.colour.resize(4 * texels);
  out.normal.resize(2 * texels);
  for (int32_t page = 0; page < atlas.pages; ++page) {
    for (int32_t y = 0; y < down; ++y) {
      for (int32_t x = 0; x < across; ++x) {
        std::array<uint32_t, 4> sum{};
        for (int32_t k = 0; k < 4; ++k) {
          const auto row = static_cast<size_t>(page * atlas.height + 2 * y + k / 2);
          const uint8_t* from = atlas.colour.data() + 4 * (row * static_cast<size_t>(atlas.width) +
                                                           static_cast<size_t>(2 * x + k % 2));
          for (size_t c = 0; c < 3; ++c) sum[c] += uint32_t{from[c]} * from[3];
          sum[3] += from[3];
        }
        const auto row = static_cast<size_t>(page * out.height + y);
        uint8_t* to =
            out.colour.data() + 4 * (row * static_cast<size_t>(out.width) + static_cast<size_t>(x));
        for (size_t c = 0; c < 3; ++c) {
          to[c] = static_cast<uint8_t>(sum[3] > 0 ? sum[c] / sum[3] : 0);
        }
        to[3] = static_cast<uint8_t>(sum[3] / 4);
      }
    }
  }
  return out;
}

// In blocks, which the card reads as they are. No card makes smaller levels of blocks, so we do.
void upload_blocks(const Atlas& packed, const Atlas& unpacked) {
  const GLenum kind = kind_of(packed.format);
  const auto upload = [&](GLint level, const std::vector<uint8_t>& blocks) {
    glCompressedTexImage3D(GL_TEXTURE_2D_ARRAY, level, kind, packed.width >> level,
                           packed.height >> level, packed.pages, 0,
                           static_cast<GLsizei>(blocks.size()), blocks.data());
  };
  upload(0, packed.colour);
  Atlas smaller = half_of(unpacked);
  upload(1, convert_atlas(smaller, packed.format).colour);
  upload(2, convert_atlas(half_of(smaller), packed.format).colour);
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

bool takes_blocks(AtlasFormat format) {
  if (kind_of(format) == 0) return false;
  const bool etc2 = format == AtlasFormat::kEtc2a1 || format == AtlasFormat::kEtc2;
  return etc2 ? takes_etc2() : takes_s3tc();
}

Result<AtlasTextures> AtlasTextures::create(const Atlas& packed) {
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
  out.extents = extents_of(atlas);
  out.shape.clips = atlas.clips;
  out.shape.parts = atlas.parts;
  out.shape.views = atlas.views;
  for (uint32_t look = 0; look < kLooks && !atlas.parts.empty(); ++look) {
    out.worn.push_back(worn_by(atlas.parts, look));
  }
  out.shape.width = atlas.width;
  out.shape.height = atlas.height;
  for (size_t part = 0; part < out.part_bright.size(); ++part) {
    const std::array<float, 3> shares{0.30F, 0.59F, 0.11F};  // As in the shaders.
    for (size_t c = 0; c < 3; ++c) {
      const float stored = static_cast<float>(atlas.part_colour[part][c]) / 255;
      out.part_bright[part] += shares[c] * std::max(0.02F, stored * stored);
    }
  }
  out.colour = make_texture();
  glBindTexture(GL_TEXTURE_2D_ARRAY, out.colour.get());
  // Views keep to blocks of four texels, so two levels do not mix them.
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 2);
  out.colour_bytes = takes_blocks(packed.format) ? packed.colour.size() : 0;
  if (out.colour_bytes > 0) {
    upload_blocks(packed, atlas);
  } else {
    upload_pages(atlas, atlas.colour);
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
    out.colour_bytes = atlas.colour.size();
  }
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
  program.set_numbers("part_bright", part_bright.data(), kBodyParts);
  program.set_size("page", static_cast<float>(shape.width), static_cast<float>(shape.height));
}

}  // namespace throng::draw
