// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/storey_index.h"

/// A world's storeys as small images of heights: what the plans and the fan are drawn from.
namespace throng::render {

/// How the cells of a world fall on texels: one each, or several averaged in one.
struct RasterGrid {
  int32_t cell_x = 0, cell_z = 0;     ///< First cell shown.
  int32_t cells_x = 0, cells_z = 0;   ///< Cells shown.
  int32_t width = 0, height = 0;      ///< Texels. [<= cells]
  double cell = 0;                    ///< [m]
  double origin_x = 0, origin_z = 0;  ///< Of the first cell shown. [m]

  [[nodiscard]] double width_metres() const { return cells_x * cell; }
  [[nodiscard]] double depth_metres() const { return cells_z * cell; }
  [[nodiscard]] double texel_metres() const { return width_metres() / width; }
};

/// The grid of the world's bounds with at most this many texels along each axis.
[[nodiscard]] RasterGrid make_raster_grid(const PictureWorld& world, int32_t max_width,
                                          int32_t max_height);

enum class TexelKind : uint8_t {
  kOutside,    ///< No floor, and the rim of the picture can be reached without crossing any.
  kFloor,      ///< At least one cell has a floor.
  kObstacle,   ///< No floor, enclosed: a wall, a pillar, a closed room.
  kOpenBelow,  ///< No floor, enclosed, and free down to a lower storey: a shaft, an atrium.
};

/// One storey, row by row. Averages are over the texel's cells that have a floor.
struct StoreyRaster {
  int32_t storey = 0;
  int32_t width = 0, height = 0;
  std::vector<float> floor;          ///< [m], unset (NaN) without a floor.
  std::vector<float> ceiling;        ///< Highest one, infinite under the sky. [m]
  std::vector<uint8_t> floor_share;  ///< Cells with a floor, of 255.
  std::vector<uint8_t> stand_share;  ///< Of these, cells where the class can stand, of 255.
  std::vector<uint8_t> clearance;    ///< Mean clearance where the class can stand, times 16.
  std::vector<TexelKind> kind;
  double low = 0, high = 0;  ///< Of the floors, one percent at either end left out. [m]
  double stand_area = 0;     ///< [m^2]
  double floor_area = 0;     ///< [m^2]
};

struct StoreyRasters {
  std::vector<StoreyRaster> storeys;
  double left_out_area = 0;  ///< Floor of no storey that is shown. [m^2]
};

/// Rasters of the storeys `shown`; small pieces of others join them where they lie near and free.
/// Time: all level tiles once. Memory: 24 bytes a texel and storey.
[[nodiscard]] StoreyRasters rasterise_storeys(const PictureWorld& world, const StoreyIndex& index,
                                              std::span<const int32_t> shown,
                                              const RasterGrid& grid);

}  // namespace throng::render
