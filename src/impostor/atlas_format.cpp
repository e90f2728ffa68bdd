// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel.h"
#include "impostor/atlas_size.h"
#include "impostor/block_codec.h"
#include "impostor/etc2_codec.h"
#include "throng/impostor.h"

// Converts formats in two steps: any format is unpacked to 8 bits a channel, which are then packed
// in the requested format.
namespace throng {
namespace {

// Rows of blocks, all pages under each other.
struct Blocks {
  size_t across = 0, down = 0;
};

Blocks blocks_of(const Atlas& atlas) {
  return {static_cast<size_t>(atlas.width) / 4,
          static_cast<size_t>(atlas.height) / 4 * static_cast<size_t>(atlas.pages)};
}

// Calls body(block number, number of its first texel, texels a row) for each block.
template <class Body>
void for_each_block(const Atlas& atlas, int32_t workers, Body body) {
  const Blocks blocks = blocks_of(atlas);
  const auto width = static_cast<size_t>(atlas.width);
  parallel_for(blocks.down, workers, [&](size_t row) {
    for (size_t x = 0; x < blocks.across; ++x) {
      body(row * blocks.across + x, row * 4 * width + x * 4, width);
    }
  });
}

size_t texel_of(size_t first, size_t width, size_t i) { return first + i / 4 * width + i % 4; }

impostor::Bytes8 bytes_at(const std::vector<uint8_t>& from, size_t offset) {
  impostor::Bytes8 out;
  std::copy_n(from.begin() + static_cast<ptrdiff_t>(offset), 8, out.begin());
  return out;
}

void put(const impostor::Bytes8& bytes, std::vector<uint8_t>& to, size_t offset) {
  std::copy_n(bytes.begin(), 8, to.begin() + static_cast<ptrdiff_t>(offset));
}

uint8_t widen5(int32_t five) { return static_cast<uint8_t>(five << 3 | five >> 2); }

bool is_etc2(AtlasFormat format) {
  return format == AtlasFormat::kEtc2a1 || format == AtlasFormat::kEtc2;
}

// Formats of 8 bytes a block, whose texels are opaque or holes; others have 8 bytes of alpha first.
bool has_holes(AtlasFormat format) {
  return format == AtlasFormat::kBc1 || format == AtlasFormat::kEtc2a1;
}

void decode_colour(AtlasFormat format, const std::vector<uint8_t>& from, size_t block,
                   impostor::ColourBlock& texel) {
  const bool holes = has_holes(format);
  const impostor::Bytes8 colour = bytes_at(from, holes ? block * 8 : block * 16 + 8);
  is_etc2(format) ? impostor::decode_etc2(colour, holes, texel)
                  : impostor::decode_bc1(colour, holes, texel);
  if (holes) return;
  impostor::ChannelBlock alpha;
  const impostor::Bytes8 bytes = bytes_at(from, block * 16);
  is_etc2(format) ? impostor::decode_eac(bytes, alpha) : impostor::decode_bc4(bytes, alpha);
  for (size_t i = 0; i < 16; ++i) texel[i][3] = alpha[i];
}

void encode_colour(AtlasFormat format, const impostor::ColourBlock& texel, std::vector<uint8_t>& to,
                   size_t block) {
  impostor::ChannelBlock alpha;
  impostor::TexelWeights weights, all;
  all.fill(1);
  for (size_t i = 0; i < 16; ++i) weights[i] = alpha[i] = texel[i][3];  // By its opacity.
  const bool holes = has_holes(format);
  put(is_etc2(format) ? impostor::encode_etc2(texel, weights, holes)
                      : impostor::encode_bc1(texel, weights, holes),
      to, holes ? block * 8 : block * 16 + 8);
  if (!holes)
    put(is_etc2(format) ? impostor::encode_eac(alpha, all) : impostor::encode_bc4(alpha, all), to,
        block * 16);
}

// One of a normal's two channels.
void decode_channel(AtlasFormat format, const impostor::Bytes8& bytes,
                    impostor::ChannelBlock& values) {
  if (!is_etc2(format)) return impostor::decode_bc4(bytes, values);
  impostor::WideChannelBlock wide;
  impostor::decode_eac11(bytes, wide);
  for (size_t i = 0; i < 16; ++i) {
    values[i] = static_cast<uint8_t>((wide[i] * 255 + 1023) / 2047);
  }
}

std::vector<uint8_t> unpack_colour(const Atlas& atlas, int32_t workers) {
  if (atlas.format == AtlasFormat::kRgba8) return atlas.colour;
  const size_t texels = impostor::texel_count(atlas);
  std::vector<uint8_t> out(texels * 4);
  if (atlas.format == AtlasFormat::kRgb5a1) {
    for (size_t i = 0; i < texels; ++i) {
      const int32_t word = atlas.colour[2 * i] | atlas.colour[2 * i + 1] << 8;
      out[4 * i] = widen5(word >> 11);
      out[4 * i + 1] = widen5(word >> 6 & 31);
      out[4 * i + 2] = widen5(word >> 1 & 31);
      out[4 * i + 3] = (word & 1) != 0 ? 255 : 0;
    }
    return out;
  }
  for_each_block(atlas, workers, [&](size_t block, size_t first, size_t width) {
    impostor::ColourBlock texel;
    decode_colour(atlas.format, atlas.colour, block, texel);
    for (size_t i = 0; i < 16; ++i) {
      std::copy_n(texel[i].begin(), 4,
                  out.begin() + static_cast<ptrdiff_t>(4 * texel_of(first, width, i)));
    }
  });
  return out;
}

std::vector<uint8_t> unpack_normal(const Atlas& atlas, int32_t workers) {
  if (!impostor::in_blocks(atlas.format)) return atlas.normal;
  std::vector<uint8_t> out(impostor::texel_count(atlas) * 2);
  for_each_block(atlas, workers, [&](size_t block, size_t first, size_t width) {
    for (size_t channel = 0; channel < 2; ++channel) {
      impostor::ChannelBlock values;
      decode_channel(atlas.format, bytes_at(atlas.normal, block * 16 + channel * 8), values);
      for (size_t i = 0; i < 16; ++i) out[2 * texel_of(first, width, i) + channel] = values[i];
    }
  });
  return out;
}

std::vector<uint8_t> pack_colour(const Atlas& atlas, const std::vector<uint8_t>& colour,
                                 AtlasFormat format, int32_t workers) {
  if (format == AtlasFormat::kRgba8) return colour;
  const size_t texels = impostor::texel_count(atlas);
  std::vector<uint8_t> out(impostor::colour_bytes(format, texels));
  if (format == AtlasFormat::kRgb5a1) {
    const auto five = [&](size_t i) { return (colour[i] * 31 + 127) / 255; };
    for (size_t i = 0; i < texels; ++i) {
      const int32_t word = five(4 * i) << 11 | five(4 * i + 1) << 6 | five(4 * i + 2) << 1 |
                           (colour[4 * i + 3] >= 128 ? 1 : 0);
      out[2 * i] = static_cast<uint8_t>(word);
      out[2 * i + 1] = static_cast<uint8_t>(word >> 8);
    }
    return out;
  }
  for_each_block(atlas, workers, [&](size_t block, size_t first, size_t width) {
    impostor::ColourBlock texel;
    for (size_t i = 0; i < 16; ++i) {
      std::copy_n(colour.begin() + static_cast<ptrdiff_t>(4 * texel_of(first, width, i)), 4,
                  texel[i].begin());
    }
    encode_colour(format, texel, out, block);
  });
  return out;
}

std::vector<uint8_t> pack_normal(const Atlas& atlas, const std::vector<uint8_t>& normal,
                                 const std::vector<uint8_t>& colour, AtlasFormat format,
                                 int32_t workers) {
  if (!impostor::in_blocks(format)) return normal;
  std::vector<uint8_t> out(impostor::texel_count(atlas));
  for_each_block(atlas, workers, [&](size_t block, size_t first, size_t width) {
    impostor::TexelWeights weights;
    for (size_t i = 0; i < 16; ++i) {
      weights[i] = colour[4 * texel_of(first, width, i) + 3] > 0 ? 1 : 0;
    }
    for (size_t channel = 0; channel < 2; ++channel) {
      impostor::ChannelBlock values;
      for (size_t i = 0; i < 16; ++i) values[i] = normal[2 * texel_of(first, width, i) + channel];
      put(is_etc2(format) ? impostor::encode_eac11(values, weights)
                          : impostor::encode_bc4(values, weights),
          out, block * 16 + channel * 8);
    }
  });
  return out;
}

}  // namespace

const char* word_for(AtlasFormat format) {
  static constexpr const char* kWords[] = {"rgba8", "rgb5a1", "bc1", "bc3", "etc2a1", "etc2"};
  return kWords[static_cast<size_t>(format)];
}

Atlas convert_atlas(const Atlas& atlas, AtlasFormat format, int32_t workers) {
  if (format == atlas.format) return atlas;
  Atlas out;
  out.shape = atlas.shape;
  out.clips = atlas.clips;
  out.views = atlas.views;
  out.parts = atlas.parts;
  out.format = format;
  out.width = atlas.width;
  out.height = atlas.height;
  out.pages = atlas.pages;
  out.mask = atlas.mask;
  out.part_colour = atlas.part_colour;
  const std::vector<uint8_t> colour = unpack_colour(atlas, workers);
  const std::vector<uint8_t> normal = unpack_normal(atlas, workers);
  out.colour = pack_colour(atlas, colour, format, workers);
  out.normal = pack_normal(atlas, normal, colour, format, workers);
  return out;
}

uint64_t packed_colour_bytes(const Atlas& atlas, AtlasFormat format) {
  return impostor::colour_bytes(format, impostor::texel_count(atlas));
}

uint64_t sheet_colour_bytes(const AtlasShape& shape, AtlasFormat format) {
  const size_t side = (static_cast<size_t>(shape.pixels) + 3) / 4 * 4;
  return impostor::colour_bytes(format, shape.view(shape.frames, 0, 0) * side * side);
}

double atlas_psnr(const Atlas& exact, const Atlas& other) {
  THRONG_ASSERT(exact.views == other.views && exact.width == other.width);
  const std::vector<uint8_t> a = unpack_colour(exact, 0), b = unpack_colour(other, 0);
  uint64_t squares = 0, count = 0;
  for (size_t i = 0; i < a.size(); i += 4) {
    if (a[i + 3] < 128) continue;
    for (size_t c = 0; c < 3; ++c) {
      const int32_t off = a[i + c] - b[i + c];
      squares += static_cast<uint64_t>(off * off);
    }
    count += 3;
  }
  if (squares == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(255.0 * 255.0 * static_cast<double>(count) / static_cast<double>(squares));
}

}  // namespace throng
