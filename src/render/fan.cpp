// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/text.h"
#include "render/views.h"

// Draws the storeys apart from each other and seen at a slant. Every texel is a small block: a top
// and the two sides that face the eye. Blocks are drawn from back to front and storeys from the
// lowest to the highest (painter's algorithm), three times too large and then averaged.
namespace throng::render {
namespace {

constexpr double kAcross = 0.80, kDown = 0.40;  // Of a metre along x or z, to the side and down.
constexpr double kUpright = 0.75;               // Of a metre of height.
constexpr double kSlab = 0.25;                  // Thickness of a floor at its rim. [m]
constexpr int32_t kFanSamples = 3;
constexpr int32_t kMaxTexels = 420;  // Along the longer side.

// A storey reduced to few enough texels.
struct ReducedStorey {
  int32_t width = 0, height = 0;
  std::vector<float> top;  // [m] over the storey's lowest floor, NaN where there is nothing
  std::vector<Rgb> colour;

  [[nodiscard]] float at(int32_t x, int32_t z) const {
    if (x >= width || z >= height) return std::numeric_limits<float>::quiet_NaN();
    return top[static_cast<size_t>(z * width + x)];
  }
};

ReducedStorey reduce_storey(const StoreyRaster& storey, const RasterGrid& grid,
                            const HeightScale& scale) {
  const int32_t share = (std::max(storey.width, storey.height) + kMaxTexels - 1) / kMaxTexels;
  ReducedStorey reduced;
  reduced.width = (storey.width + share - 1) / share;
  reduced.height = (storey.height + share - 1) / share;
  const double base = storey.low;
  for (int32_t z = 0; z < reduced.height; ++z) {
    for (int32_t x = 0; x < reduced.width; ++x) {
      double height = 0, r = 0, g = 0, b = 0;
      int32_t floors = 0, obstacles = 0;
      for (int32_t k = 0; k < share * share; ++k) {
        const int32_t tx = x * share + k % share, tz = z * share + k / share;
        if (tx >= storey.width || tz >= storey.height) continue;
        const auto i = static_cast<size_t>(tz * storey.width + tx);
        obstacles += storey.kind[i] == TexelKind::kObstacle;
        if (storey.kind[i] != TexelKind::kFloor) continue;
        const Rgb c = floor_colour(storey, i, grid.texel_metres(), scale);
        height += storey.floor[i] - base;
        r += c.r;
        g += c.g;
        b += c.b;
        ++floors;
      }
      if (floors > 0) {
        const double n = floors;
        reduced.top.push_back(static_cast<float>(height / n));
        reduced.colour.push_back({static_cast<uint8_t>(r / n), static_cast<uint8_t>(g / n),
                                  static_cast<uint8_t>(b / n)});
      } else {
        reduced.top.push_back(obstacles > 0 ? 0 : std::numeric_limits<float>::quiet_NaN());
        reduced.colour.push_back(kSolid);
      }
    }
  }
  return reduced;
}

double relief(const StoreyRaster& storey) { return storey.high - storey.low; }

// Draws one storey whose back corner (x = z = 0 at its lowest floor) is at `corner`.
void draw_storey(Canvas& canvas, const ReducedStorey& reduced, Point corner, double texel_x,
                 double texel_z, double lift) {
  const auto project = [&](double x, double z, double height) {
    return Point{corner.x + (x * texel_x - z * texel_z) * kAcross,
                 corner.y + (x * texel_x + z * texel_z) * kDown - height * lift};
  };
  const auto side = [&](double x0, double z0, double x1, double z1, double high, double low,
                        Rgb colour) {
    const std::array<Point, 4> face = {project(x0, z0, high), project(x1, z1, high),
                                       project(x1, z1, low), project(x0, z0, low)};
    canvas.fill_convex(face, colour);
  };
  for (int32_t sum = 0; sum < reduced.width + reduced.height - 1; ++sum) {
    for (int32_t x = std::max(0, sum - reduced.height + 1); x <= std::min(sum, reduced.width - 1);
         ++x) {
      const int32_t z = sum - x;
      const float top = reduced.at(x, z);
      if (std::isnan(top)) continue;
      const Rgb colour = reduced.colour[static_cast<size_t>(z * reduced.width + x)];
      const auto low = [&](float neighbour) {
        return std::isnan(neighbour) ? top - kSlab : std::min<double>(neighbour, top);
      };
      const double low_x = low(reduced.at(x + 1, z)), low_z = low(reduced.at(x, z + 1));
      if (low_x < top) side(x + 1, z, x + 1, z + 1, top, low_x, shade(colour, 0.62));
      if (low_z < top) side(x, z + 1, x + 1, z + 1, top, low_z, shade(colour, 0.8));
      const std::array<Point, 4> roof = {project(x, z, top), project(x + 1, z, top),
                                         project(x + 1, z + 1, top), project(x, z + 1, top)};
      canvas.fill_convex(roof, colour);
    }
  }
}

}  // namespace

FanLayout lay_out_fan(std::span<const StoreyRaster> storeys, const RasterGrid& grid, double width,
                      double max_height) {
  FanLayout layout;
  const double span = grid.width_metres() + grid.depth_metres();
  layout.width = width;
  layout.scale = width / (span * kAcross);
  double highest = 0;  // Relief of the storey that rises most above its place in the fan.
  for (const StoreyRaster& storey : storeys) highest = std::max(highest, relief(storey));
  const auto spacings = static_cast<double>(storeys.size()) - 1;
  // Try the largest first: ground, relief and the offsets must fit the height.
  for (int i = 0; i < 40; ++i, layout.scale *= 0.93) {
    layout.lift = layout.scale * kUpright;
    const double ground = span * kDown * layout.scale;
    layout.offset = spacings > 0 ? ground * std::clamp(2.2 / spacings, 0.3, 0.55) : 0;
    layout.offset = std::max(layout.offset, 18.0);
    layout.top = highest * layout.lift + 4;
    layout.height = layout.top + ground + spacings * layout.offset + kSlab * layout.lift + 6;
    if (layout.height <= max_height) break;
  }
  layout.left =
      grid.depth_metres() * kAcross * layout.scale + (width - span * kAcross * layout.scale) / 2;
  return layout;
}

void draw_fan(Canvas& canvas, int32_t x, int32_t y, const FanLayout& layout,
              std::span<const StoreyRaster> storeys, const RasterGrid& grid, double text,
              const HeightScale& scale, const PlacedMarks& marks) {
  Canvas large(static_cast<int32_t>(std::ceil(layout.width)) * kFanSamples,
               static_cast<int32_t>(std::ceil(layout.height)) * kFanSamples, kPaper);
  const double factor = kFanSamples;
  for (size_t s = 0; s < storeys.size(); ++s) {
    const auto above = static_cast<double>(storeys.size() - 1 - s);
    const Point corner{layout.left, layout.top + above * layout.offset};
    const ReducedStorey reduced = reduce_storey(storeys[s], grid, scale);
    draw_storey(large, reduced, {corner.x * factor, corner.y * factor},
                grid.width_metres() / reduced.width * layout.scale * factor,
                grid.depth_metres() / reduced.height * layout.scale * factor, layout.lift * factor);
    const auto disc = [&](const Vec3d& p, double radius, Rgb colour) {
      const double ax = (p.x - grid.origin_x) * layout.scale,
                   az = (p.z - grid.origin_z) * layout.scale;
      const Point at{corner.x + (ax - az) * kAcross,
                     corner.y + (ax + az) * kDown - (p.y - storeys[s].low) * layout.lift};
      large.disc({at.x * factor, at.y * factor}, radius * factor, colour);
    };
    for (const auto& [radius, colour] : {std::pair{2.2, kPaper}, {1.3, kPath}}) {
      for (const DrawnPoint& point : marks.path) {
        if (point.storey == s) disc(point.position, radius, colour);
      }
    }
    for (const PlacedAvatar& placed : marks.avatars) {
      if (placed.storey != s) continue;
      disc(placed.avatar.position, std::max(placed.avatar.radius * layout.scale, 1.0), kAvatar);
    }
  }
  canvas.draw_reduced(large, kFanSamples, x, y);
  if (storeys.size() < 2) return;
  for (size_t s = 0; s < storeys.size(); ++s) {
    // The left corner of the storey: x = 0 at its far end in z.
    const double depth = grid.depth_metres() * layout.scale;
    const double left = x + layout.left - depth * kAcross;
    const double line = y + layout.top +
                        static_cast<double>(storeys.size() - 1 - s) * layout.offset + depth * kDown;
    draw_text(canvas, {left - text * 0.8, line + text / 2}, fmt::format("{}", storeys[s].storey),
              {.size = text, .colour = kInk, .align = Align::kRight, .bold = true});
  }
}

}  // namespace throng::render
