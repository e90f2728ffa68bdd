// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "impostor/srgb.h"
#include "throng/impostor.h"

// Draws the views of an atlas as in figure 2 of [TC00].
namespace throng {
namespace {

constexpr Vec3d kLight{-0.45, 0.68, 0.58};  // Over the viewer's left shoulder; unit length.
constexpr double kPaper = 0.72;             // Linear.

Vec3d lit(const uint8_t* colour, const uint8_t* normal) {
  const double x = (normal[0] - 128) / 127.0, y = (normal[1] - 128) / 127.0;
  const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
  const double light = 0.45 + 1.1 * std::max(0.0, dot({x, y, z}, kLight));
  return Vec3d{impostor::decode_colour(colour[0]), impostor::decode_colour(colour[1]),
               impostor::decode_colour(colour[2])} *
         light;
}

}  // namespace

Image draw_atlas(const Atlas& packed, int32_t frame) {
  const Atlas& atlas =
      packed.format == AtlasFormat::kRgba8 ? packed : convert_atlas(packed, AtlasFormat::kRgba8);
  const AtlasShape& s = atlas.shape;
  THRONG_ASSERT(frame >= 0 && frame < s.frames);
  Image image{.width = s.directions * s.pixels, .height = s.elevations * s.pixels, .rgb = {}};
  image.rgb.assign(static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 3,
                   impostor::encode_colour(kPaper));
  for (int32_t row = 0; row < s.elevations; ++row) {
    for (int32_t column = 0; column < s.directions; ++column) {
      const AtlasView& view = atlas.views[s.view(frame, row, column)];
      for (int32_t y = 0; y < view.height && view.top + y < s.pixels; ++y) {
        for (int32_t x = 0; x < view.width && view.left + x < s.pixels; ++x) {
          const size_t from =
              (static_cast<size_t>(view.page) * static_cast<size_t>(atlas.height) + view.y + y) *
                  static_cast<size_t>(atlas.width) +
              view.x + x;
          const double alpha = atlas.colour[from * 4 + 3] / 255.0;
          const Vec3d colour = lit(&atlas.colour[from * 4], &atlas.normal[from * 2]);
          const Vec3d mixed = Vec3d{kPaper, kPaper, kPaper} * (1 - alpha) + colour * alpha;
          const auto to = (static_cast<size_t>(row * s.pixels + view.top + y) *
                               static_cast<size_t>(image.width) +
                           static_cast<size_t>(column * s.pixels + view.left + x)) *
                          3;
          image.rgb[to] = impostor::encode_colour(mixed.x);
          image.rgb[to + 1] = impostor::encode_colour(mixed.y);
          image.rgb[to + 2] = impostor::encode_colour(mixed.z);
        }
      }
    }
  }
  return image;
}

}  // namespace throng
