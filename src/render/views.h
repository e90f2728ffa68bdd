// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/canvas.h"
#include "render/storey_raster.h"
#include "throng/picture.h"

/// The three views of a world: plan, section, fan. Each draws into a part of a canvas.
namespace throng::render {

/// The colour of a height, the same in all views of a picture.
struct HeightScale {
  double low = 0, high = 1;  ///< [m]
  [[nodiscard]] Rgb colour(double height) const;
};

/// The range of all floors shown, at least half a metre.
[[nodiscard]] HeightScale make_height_scale(std::span<const StoreyRaster> storeys);

/// Colour of a texel with a floor: height, slope shading, darker close to walls, grey where the
/// class cannot stand.
[[nodiscard]] Rgb floor_colour(const StoreyRaster& storey, size_t texel, double texel_metres,
                               const HeightScale& scale);

/// An avatar and the index of the storey (among those shown) that it stands on.
struct PlacedAvatar {
  PictureAvatar avatar;
  size_t storey = 0;
};

/// Gives each avatar over the grid the storey whose floor is nearest to its feet.
[[nodiscard]] std::vector<PlacedAvatar> place_avatars(std::span<const PictureAvatar> avatars,
                                                      std::span<const StoreyRaster> storeys,
                                                      const RasterGrid& grid);

/// A point of a path and the storey whose floor it is on.
struct DrawnPoint {
  Vec3d position;
  size_t storey = 0;
};

/// Points along a path, two a texel, where it is within a metre of the floor of a storey.
[[nodiscard]] std::vector<DrawnPoint> place_path(std::span<const Vec3d> path,
                                                 std::span<const StoreyRaster> storeys,
                                                 const RasterGrid& grid);

/// What is drawn over the floors.
struct PlacedMarks {
  std::vector<PlacedAvatar> avatars;
  std::vector<DrawnPoint> path;
};

/// Storey `index` seen from above, x to the right, z down; a texel is a square of `block` pixels.
/// The corner is at (x, y); other storeys lie under it as a faint ground.
void draw_plan(Canvas& canvas, int32_t x, int32_t y, double pixels_per_texel,
               std::span<const StoreyRaster> storeys, size_t index, const RasterGrid& grid,
               const HeightScale& scale, const PlacedMarks& marks);

/// Free space over one cell of the section. [m]
struct SectionSpan {
  double floor = 0;
  double ceiling = 0;
  bool stands = false;
};

/// The free spans that a cut along x meets in one row of cells, sampled at `columns` places; those
/// of a column lowest first.
struct Section {
  double z = 0;  ///< Position of the cut. [m]
  std::vector<std::vector<SectionSpan>> free_spans;
};

[[nodiscard]] Section cut_section(const PictureWorld& world, const RasterGrid& grid, int32_t row,
                                  int32_t columns);

/// Draws a section with a height axis on its left, inside `rect`; vertical scale
/// `pixels_per_metre`, lowest height `low`.
void draw_section(Canvas& canvas, const Rect& rect, const Section& section, double low,
                  double pixels_per_metre, double text, const HeightScale& scale);

/// The layout of the fan.
struct FanLayout {
  double scale = 1;   ///< Pixels a metre of ground.
  double lift = 1;    ///< Pixels a metre of height.
  double offset = 0;  ///< Pixels from one storey up to the next.
  double width = 0, height = 0;
  double left = 0;  ///< Of the back corner, from the left edge.
  double top = 0;   ///< Of the highest storey's back corner, from the top edge.
};

/// Fits the fan of `storeys` into `width` x `max_height` pixels.
[[nodiscard]] FanLayout lay_out_fan(std::span<const StoreyRaster> storeys, const RasterGrid& grid,
                                    double width, double max_height);

/// All storeys from above at a slant, apart from each other, the highest on top.
void draw_fan(Canvas& canvas, int32_t x, int32_t y, const FanLayout& layout,
              std::span<const StoreyRaster> storeys, const RasterGrid& grid, double text,
              const HeightScale& scale, const PlacedMarks& marks);

}  // namespace throng::render
