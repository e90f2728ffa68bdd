// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "render/views.h"

// Draws a plan: floors coloured by height, shaded by slope as if lit from the upper left, a little
// darker close to walls; grey hatching where there is floor but the class cannot stand.
namespace throng::render {
namespace {

constexpr double kHatchSpacing = 5;  // px

float height_or(const StoreyRaster& storey, int32_t x, int32_t z, float otherwise) {
  if (x < 0 || z < 0 || x >= storey.width || z >= storey.height) return otherwise;
  const float height = storey.floor[static_cast<size_t>(z * storey.width + x)];
  return std::isnan(height) ? otherwise : height;
}

// Brightness of a slope against level ground, 1 for level.
double slope_light(const StoreyRaster& storey, size_t texel, double metres) {
  const auto x = static_cast<int32_t>(texel) % storey.width;
  const auto z = static_cast<int32_t>(texel) / storey.width;
  const float here = storey.floor[texel];
  const double dx =
      (height_or(storey, x + 1, z, here) - height_or(storey, x - 1, z, here)) / (2 * metres);
  const double dz =
      (height_or(storey, x, z + 1, here) - height_or(storey, x, z - 1, here)) / (2 * metres);
  constexpr double kUp = 1.7;  // The light comes from (-1, kUp, -1).
  const double light = (dx + kUp + dz) / (kUp * std::sqrt(dx * dx + dz * dz + 1));
  return std::clamp(0.45 + 0.55 * light, 0.72, 1.16);
}

bool cannot_stand(const StoreyRaster& storey, size_t i) { return storey.stand_share[i] < 128; }

// A texel's colour between and on the stripes of the hatching.
struct TexelColour {
  Rgb plain, striped;
};

TexelColour texel_colour(const StoreyRaster& storey, size_t i, bool context,
                         const HeightScale& scale, double metres) {
  Rgb flat = context ? kContext : kPaper;
  if (storey.kind[i] == TexelKind::kObstacle) flat = kSolid;
  if (storey.kind[i] == TexelKind::kOpenBelow) flat = kShaft;
  if (storey.kind[i] != TexelKind::kFloor) return {flat, flat};
  const double share = storey.floor_share[i] / 255.0;
  const Rgb plain = mix(kSolid, floor_colour(storey, i, metres, scale), share);
  return {plain, cannot_stand(storey, i) ? mix(kSolid, kHatch, share) : plain};
}

// A thin dark line where floor meets the outside: the last cells of a world are its walls.
bool on_rim(const StoreyRaster& storey, int32_t x, int32_t z) {
  for (const auto& [dx, dz] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const int32_t nx = x + dx, nz = z + dz;
    if (nx < 0 || nz < 0 || nx >= storey.width || nz >= storey.height) continue;
    if (storey.kind[static_cast<size_t>(nz * storey.width + nx)] != TexelKind::kOutside)
      return true;
  }
  return false;
}

void draw_avatars(Canvas& canvas, int32_t x, int32_t y, double pixels_per_metre, size_t index,
                  const RasterGrid& grid, std::span<const PlacedAvatar> avatars) {
  const auto draw = [&](double grow, double min_radius, Rgb colour) {
    for (const PlacedAvatar& placed : avatars) {
      if (placed.storey != index) continue;
      const Point at{x + (placed.avatar.position.x - grid.origin_x) * pixels_per_metre,
                     y + (placed.avatar.position.z - grid.origin_z) * pixels_per_metre};
      canvas.disc(at, std::max(placed.avatar.radius * pixels_per_metre, min_radius) + grow, colour);
    }
  };
  // All rims first: in a dense crowd every body stays visible. No rims where discs are dots.
  const bool dots = avatars.size() > 20000;
  if (!dots) draw(0.9, 1.6, kPaper);
  draw(0, dots ? 1.0 : 1.6, kAvatar);
}

// With a light rim, so that it is visible on every floor.
void draw_path(Canvas& canvas, int32_t x, int32_t y, double pixels_per_metre, size_t index,
               const RasterGrid& grid, std::span<const DrawnPoint> path) {
  constexpr double kWidth = 1.6, kRim = 1.2;  // [px]
  for (const auto& [radius, colour] : {std::pair{kWidth + kRim, kPaper}, {kWidth, kPath}}) {
    for (const DrawnPoint& point : path) {
      if (point.storey != index) continue;
      canvas.disc({x + (point.position.x - grid.origin_x) * pixels_per_metre,
                   y + (point.position.z - grid.origin_z) * pixels_per_metre},
                  radius, colour);
    }
  }
}

// The storey whose floor is nearest to a point over the grid, and how far.
struct NearStorey {
  size_t storey = 0;
  double distance = std::numeric_limits<double>::infinity();
};

NearStorey nearest_storey(Vec3d position, std::span<const StoreyRaster> storeys,
                          const RasterGrid& grid) {
  NearStorey nearest;
  const double x = (position.x - grid.origin_x) / grid.width_metres() * grid.width;
  const double z = (position.z - grid.origin_z) / grid.depth_metres() * grid.height;
  if (!(x >= 0 && z >= 0 && x < grid.width && z < grid.height)) return nearest;
  const auto texel =
      static_cast<size_t>(z) * static_cast<size_t>(grid.width) + static_cast<size_t>(x);
  for (size_t s = 0; s < storeys.size(); ++s) {
    const double distance = std::fabs(storeys[s].floor[texel] - position.y);
    if (!(distance < nearest.distance)) continue;  // Also where it has no floor: NaN.
    nearest = {s, distance};
  }
  return nearest;
}

// What a pixel sees along one axis: a part of texel `first` and `share` of texel `second`.
struct Sample {
  size_t first = 0, second = 0;
  double share = 0;
};

std::vector<Sample> sample_line(int32_t texels, double pixels_per_texel) {
  std::vector<Sample> line;
  const auto pixels = static_cast<int32_t>(std::floor(texels * pixels_per_texel + 1e-6));
  for (int32_t p = 0; p < pixels; ++p) {
    const double from = p / pixels_per_texel, to = (p + 1) / pixels_per_texel;
    const auto first = static_cast<size_t>(from + 1e-9);
    const auto second = std::min(first + 1, static_cast<size_t>(texels) - 1);
    const double share = (to - static_cast<double>(second)) * pixels_per_texel;
    line.push_back({first, second, std::clamp(share, 0.0, 1.0)});
  }
  return line;
}

}  // namespace

Rgb HeightScale::colour(double height) const {
  return height_colour((height - low) / (high - low));
}

HeightScale make_height_scale(std::span<const StoreyRaster> storeys) {
  HeightScale scale{.low = 0, .high = 0};
  bool first = true;
  for (const StoreyRaster& storey : storeys) {
    if (storey.floor_area <= 0) continue;
    scale.low = first ? storey.low : std::min(scale.low, storey.low);
    scale.high = first ? storey.high : std::max(scale.high, storey.high);
    first = false;
  }
  const double missing = 0.5 - (scale.high - scale.low);
  if (missing > 0) scale = {.low = scale.low - missing / 2, .high = scale.high + missing / 2};
  return scale;
}

Rgb floor_colour(const StoreyRaster& storey, size_t texel, double texel_metres,
                 const HeightScale& scale) {
  const double light = slope_light(storey, texel, texel_metres);
  const Rgb grey = shade(kNoStanding, light);
  if (storey.stand_share[texel] == 0) return grey;
  const double near_wall = std::clamp((storey.clearance[texel] / 16.0 - 1) / 5, 0.0, 1.0);
  const Rgb tint = shade(scale.colour(storey.floor[texel]), light * (0.84 + 0.16 * near_wall));
  return mix(grey, tint, storey.stand_share[texel] / 255.0);
}

std::vector<PlacedAvatar> place_avatars(std::span<const PictureAvatar> avatars,
                                        std::span<const StoreyRaster> storeys,
                                        const RasterGrid& grid) {
  std::vector<PlacedAvatar> placed;
  for (const PictureAvatar& avatar : avatars) {
    const NearStorey nearest = nearest_storey(avatar.position, storeys, grid);
    if (std::isfinite(nearest.distance)) placed.push_back({avatar, nearest.storey});
  }
  return placed;
}

std::vector<DrawnPoint> place_path(std::span<const Vec3d> path,
                                   std::span<const StoreyRaster> storeys, const RasterGrid& grid) {
  constexpr double kOff = 1;  // On its floor, and not that of another storey. [m]
  constexpr double kMax = 1e6;
  std::vector<DrawnPoint> placed;
  for (size_t i = 1; i < path.size(); ++i) {
    const Vec3d segment = path[i] - path[i - 1];
    const double steps = std::ceil(2 * std::hypot(segment.x, segment.z) / grid.texel_metres()) + 1;
    if (!(steps < kMax)) continue;
    for (double k = 0; k <= steps; ++k) {
      const Vec3d at = path[i - 1] + segment * (k / steps);
      const NearStorey nearest = nearest_storey(at, storeys, grid);
      if (nearest.distance < kOff) placed.push_back({at, nearest.storey});
    }
  }
  return placed;
}

void draw_plan(Canvas& canvas, int32_t x0, int32_t y0, double pixels_per_texel,
               std::span<const StoreyRaster> storeys, size_t index, const RasterGrid& grid,
               const HeightScale& scale, const PlacedMarks& marks) {
  const StoreyRaster& storey = storeys[index];
  const double metres = grid.texel_metres();
  std::vector<TexelColour> colours;
  for (int32_t z = 0; z < storey.height; ++z) {
    for (int32_t x = 0; x < storey.width; ++x) {
      const size_t i = colours.size();
      bool context = false;
      for (const StoreyRaster& other : storeys)
        context = context || other.kind[i] == TexelKind::kFloor;
      colours.push_back(storey.kind[i] == TexelKind::kOutside && on_rim(storey, x, z)
                            ? TexelColour{kFaintInk, kFaintInk}
                            : texel_colour(storey, i, context, scale, metres));
    }
  }
  // A pixel is never wider than a texel, so it covers at most two along each axis; both count by
  // their share.
  const std::vector<Sample> across = sample_line(storey.width, pixels_per_texel);
  const std::vector<Sample> down = sample_line(storey.height, pixels_per_texel);
  for (size_t py = 0; py < down.size(); ++py) {
    for (size_t px = 0; px < across.size(); ++px) {
      const int32_t x = x0 + static_cast<int32_t>(px), y = y0 + static_cast<int32_t>(py);
      const bool stripe = on_hatch(x, y, kHatchSpacing);
      const auto at = [&](size_t tx, size_t tz) {
        const TexelColour& c = colours[tz * static_cast<size_t>(storey.width) + tx];
        return stripe ? c.striped : c.plain;
      };
      const Sample& h = across[px];
      const Sample& v = down[py];
      canvas.set(x, y,
                 mix(mix(at(h.first, v.first), at(h.second, v.first), h.share),
                     mix(at(h.first, v.second), at(h.second, v.second), h.share), v.share));
    }
  }
  draw_path(canvas, x0, y0, pixels_per_texel / metres, index, grid, marks.path);
  draw_avatars(canvas, x0, y0, pixels_per_texel / metres, index, grid, marks.avatars);
}

}  // namespace throng::render
