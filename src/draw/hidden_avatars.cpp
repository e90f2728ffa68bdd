// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/hidden_avatars.h"

#include <algorithm>
#include <cmath>

#include "draw/wardrobe.h"

// Tests whether all that could be drawn of a figure lies behind the depths of the picture.
namespace throng::draw {

std::vector<FigureExtent> extents_of(const Atlas& atlas) {
  const AtlasShape& shape = atlas.shape;
  const double texel = shape.side / shape.pixels, middle = 0.5 * shape.pixels;
  std::vector<FigureExtent> out(atlas.views.size());
  for (size_t i = 0; i < atlas.views.size(); ++i) {
    const AtlasView& v = atlas.views[i];
    const double x = std::max(std::fabs(v.left - middle), std::fabs(v.left + v.width - middle));
    const double y = std::max(std::fabs(v.top - middle), std::fabs(v.top + v.height - middle));
    uint8_t front = 0;
    for (size_t row = 0; row < v.height; ++row) {
      const size_t first = (size_t{v.page} * static_cast<size_t>(atlas.height) + v.y + row) *
                               static_cast<size_t>(atlas.width) +
                           v.x;
      for (size_t column = 0; column < v.width; ++column) {
        front = std::max<uint8_t>(front, atlas.mask[first + column] & 31);
      }
    }
    const size_t layer = i / shape.view(shape.frames, 0, 0);
    const double ahead = layer == 0 ? 0 : worn_ahead(atlas.parts[layer - 1].kind);
    // As in the shader 5 cm nearer than the texel's depth, and 1 cm more for rounding.
    out[i] = {static_cast<float>(std::hypot(x, y) * texel + 0.01),
              static_cast<float>((front - 16.0) / 30 * shape.side + 0.06 + ahead)};
  }
  return out;
}

HiddenAvatars::HiddenAvatars(const EyeCamera& camera, const DepthPyramid& depths)
    : camera_(camera), axes_(camera_axes(camera)), depths_(depths) {
  up_ = std::tan(0.5 * camera.field_of_view);
  right_ = up_ * camera.aspect;
  const double n = camera.nearest, f = camera.furthest;
  scale_ = -2 * f * n / (f - n);
  shift_ = (f + n) / (f - n);
}

bool HiddenAvatars::hides(Vec3d to, double min_depth, double max_depth, double across,
                          double nearest) const {
  if (std::min(min_depth, nearest) <= camera_.nearest) return false;
  const double x = dot(to, axes_.right), y = dot(to, axes_.up);
  const auto low = [&](double v) {
    return std::min((v - across) / min_depth, (v - across) / max_depth);
  };
  const auto high = [&](double v) {
    return std::max((v + across) / min_depth, (v + across) / max_depth);
  };
  return depths_.hides(
      {low(x) / right_, high(x) / right_, low(y) / up_, high(y) / up_, shift_ + scale_ / nearest});
}

bool HiddenAvatars::hides(Vec3d middle, FigureExtent extent) const {
  const Vec3d to = middle - camera_.eye;
  const double depth = dot(to, axes_.forward);
  const double along = depth / std::max(length(to), 1e-9);
  // The card is inclined by the angle between the ray to it and the view's axis.
  const double lean = extent.across * std::sqrt(std::max(0.0, 1 - along * along));
  return hides(to, depth - lean, depth + lean, extent.across,
               depth - lean - std::max(0.0F, extent.front) * along);
}

bool HiddenAvatars::hides_point(Vec3d middle, double half_size) const {
  const Vec3d to = middle - camera_.eye;
  const double depth = dot(to, axes_.forward);
  return hides(to, depth, depth, half_size, depth);
}

}  // namespace throng::draw
