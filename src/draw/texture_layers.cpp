// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/texture_layers.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/math/texel_mean.h"
#include "draw/gl.h"

// Scales textures to one size and makes their smaller levels.
namespace throng::draw {
namespace {

constexpr int32_t kLargestSide = 2048;  // Of any card.
constexpr int32_t kSmallestSide = 16;

#ifndef GL_TEXTURE_MAX_ANISOTROPY_EXT
#define GL_TEXTURE_MAX_ANISOTROPY_EXT 0x84FE
#endif

// The texels of `from` that one of `to` covers, and the share of each.
struct Span {
  int32_t first = 0, last = 0;
  double begin = 0, end = 0;
  Span(int32_t at, int32_t from, int32_t to)
      : begin(static_cast<double>(at) * from / to), end((at + 1.0) * from / to) {
    first = static_cast<int32_t>(begin);
    last = std::min(static_cast<int32_t>(std::ceil(end)), from);
  }
  [[nodiscard]] double share(int32_t i) const {
    return std::min(end, i + 1.0) - std::max(begin, static_cast<double>(i));
  }
};

// Scales to side x side texels. When enlarging, the nearest texel suffices, since the card filters.
void fit(const Texture& from, int32_t side, uint8_t* to) {
  for (int32_t y = 0; y < side; ++y) {
    const Span down(y, from.height, side);
    for (int32_t x = 0; x < side; ++x) {
      const Span across(x, from.width, side);
      TexelMean mean;
      for (int32_t sy = down.first; sy < down.last; ++sy) {
        const uint8_t* row =
            &from.rgba[static_cast<size_t>(sy) * static_cast<size_t>(from.width) * 4];
        for (int32_t sx = across.first; sx < across.last; ++sx) {
          mean.add(row + static_cast<size_t>(sx) * 4, down.share(sy) * across.share(sx));
        }
      }
      mean.write(to +
                 (static_cast<size_t>(y) * static_cast<size_t>(side) + static_cast<size_t>(x)) * 4);
    }
  }
}

// Half as large.
std::vector<uint8_t> next_level(const std::vector<uint8_t>& from, int32_t side, int32_t layers) {
  const auto half = static_cast<size_t>(side / 2), whole = static_cast<size_t>(side);
  std::vector<uint8_t> to(half * half * static_cast<size_t>(layers) * 4);
  for (size_t layer = 0; layer < static_cast<size_t>(layers); ++layer) {
    for (size_t y = 0; y < half; ++y) {
      for (size_t x = 0; x < half; ++x) {
        TexelMean mean;
        for (size_t k = 0; k < 4; ++k) {
          const size_t at = layer * whole * whole + (2 * y + k / 2) * whole + 2 * x + k % 2;
          mean.add(&from[at * 4], 1);
        }
        mean.write(&to[(layer * half * half + y * half + x) * 4]);
      }
    }
  }
  return to;
}

std::vector<bool> used_textures(const Scene& scene) {
  std::vector<bool> used(scene.textures.size());
  for (const ScenePart& part : scene.parts) {
    if (part.material1 == 0 || part.material1 > scene.materials.size()) continue;
    const uint32_t texture1 = scene.materials[part.material1 - 1].texture1;
    if (texture1 != 0 && texture1 <= used.size()) used[texture1 - 1] = true;
  }
  return used;
}

bool is_whole(const Texture& t) {
  return t.width > 0 && t.height > 0 &&
         t.rgba.size() == static_cast<size_t>(t.width) * static_cast<size_t>(t.height) * 4;
}

}  // namespace

TextureLayers make_texture_layers(const Scene& scene, size_t budget) {
  TextureLayers out;
  out.of_texture.resize(scene.textures.size());
  const std::vector<bool> used = used_textures(scene);
  int32_t largest = 1;
  for (size_t i = 0; i < used.size(); ++i) {
    const Texture& texture = scene.textures[i];
    if (!used[i] || !is_whole(texture)) continue;
    if (static_cast<size_t>(out.layers) < kMaxLayers) {
      out.of_texture[i].layer1 = static_cast<uint32_t>(++out.layers);
      largest = std::max({largest, texture.width, texture.height});
    } else {
      fit(texture, 1, out.of_texture[i].mean.data());
    }
  }
  if (out.layers == 0) return out;
  const auto bytes = [&](int32_t side) {
    return static_cast<size_t>(side) * static_cast<size_t>(side) * 4;
  };
  out.side = kSmallestSide;
  while (out.side < largest && out.side < kLargestSide &&
         bytes(2 * out.side) * static_cast<size_t>(out.layers) <= budget) {
    out.side *= 2;
  }
  std::vector<uint8_t>& first = out.levels.emplace_back();
  first.resize(bytes(out.side) * static_cast<size_t>(out.layers));
  for (size_t i = 0; i < used.size(); ++i) {
    const uint32_t layer1 = out.of_texture[i].layer1;
    if (layer1 == 0) continue;
    fit(scene.textures[i], out.side, &first[bytes(out.side) * (layer1 - 1)]);
  }
  for (int32_t side = out.side; side > 1; side /= 2) {
    out.levels.push_back(next_level(out.levels.back(), side, out.layers));
  }
  return out;
}

Result<void> SurfaceTextures::set(const TextureLayers& layers, bool smooth) {
  any_ = false;
  texture_ = {};
  if (layers.layers == 0) return {};
  texture_ = make_texture();
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.get());
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, static_cast<GLsizei>(layers.levels.size()), GL_RGBA8,
                 layers.side, layers.side, layers.layers);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (size_t level = 0; level < layers.levels.size(); ++level) {
    const GLsizei side = layers.side >> level;
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, static_cast<GLint>(level), 0, 0, 0, side, side,
                    layers.layers, GL_RGBA, GL_UNSIGNED_BYTE, layers.levels[level].data());
  }
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
  if (smooth &&
      has_extension({"GL_EXT_texture_filter_anisotropic", "EXT_texture_filter_anisotropic"})) {
    glTexParameterf(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_ANISOTROPY_EXT, 8.0F);
  }
  any_ = glGetError() == GL_NO_ERROR;
  if (any_) return {};
  texture_ = {};
  return Error{Errc::kLimit,
               "drawing: the model's textures do not fit into the card's memory; draw a part of "
               "it"};
}

void SurfaceTextures::bind(GLenum unit) const {
  if (!any_) return;
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.get());
}

}  // namespace throng::draw
