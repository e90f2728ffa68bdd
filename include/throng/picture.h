// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/surface.h"
#include "throng/world.h"

/// Pictures without a window: plans, sections and heat maps of worlds, charts.
namespace throng {

// ----
// Pictures without a window: plans of each level, a section, an exploded view of the levels.

/// An avatar to draw as a disc.
struct PictureAvatar {
  Vec3d position;        ///< Feet. [m]
  double radius = 0.19;  ///< [m]
};

/// Settings for draw_world.
struct PictureConfig {
  int32_t avatar_class = 0;  ///< The class whose clearance is shown.
  int32_t storey = -1;       ///< Only this storey, or all (-1).
  int32_t width = 1600;      ///< Of the whole picture. [px, 200 to 16000]
  std::string title;
  std::vector<Vec3d> path = {};  ///< A path to draw over the floors. [m]
};

/// Settings for draw_nodes.
struct NodePictureConfig {
  int32_t width = 1600;  ///< Of the whole picture. [px, 200 to 16000]
  bool links = false;
  bool air = false;  ///< Links of the air, and between air and ground; the world must have air.
  bool cylinders = false;     ///< Those of terminal nodes, see Nodes::cylinder.
  bool boxes = false;         ///< Free boxes of the air's octree; the world must have air.
  int32_t storey = -1;        ///< Only level tiles of this storey, or all nodes (-1).
  int32_t avatar_class = -1;  ///< Only nodes and links of this class, or all (-1).
  Box3d area;                 ///< Only nodes whose middle lies in its x and z; empty: all. [m]
  std::vector<Vec3d> path;    ///< A path to draw over the nodes. [m]
  std::string title;
};

/// 8-bit RGB, rows from the top.
struct Image {
  int32_t width = 0;
  int32_t height = 0;
  std::vector<uint8_t> rgb;
};

/// Draws plans of the storeys (floor height, obstacles, clearance, avatars), a side section and an
/// oblique exploded view of the levels; scale bar, legend, units.
[[nodiscard]] THRONG_API Result<Image> draw_world(const World& world,
                                                  std::span<const PictureAvatar> avatars,
                                                  const PictureConfig& config);

/// Draws nodes in an oblique view: green flat, yellow steep, red overhanging; links in the same
/// colours, those of the air violet, ground-air links blue.
[[nodiscard]] THRONG_API Result<Image> draw_nodes(const Nodes& nodes,
                                                  const NodePictureConfig& config);

/// Encodes a PNG file. Empty if there is no memory for it.
[[nodiscard]] THRONG_API std::vector<uint8_t> png_bytes(const Image& image);
/// Writes a PNG file beside `path` and renames it. Fails with kIo.
[[nodiscard]] THRONG_API Result<void> write_png(const Image& image, const std::string& path);

// ----
// Line charts as pictures, for reports.

/// How a line is drawn.
enum class LineKind : uint8_t {
  kFaint,   ///< Thin and grey: one of many.
  kPlain,   ///< In its own colour.
  kStrong,  ///< Twice as thick.
  kDashed,  ///< A bound, or a result from elsewhere.
};

/// A line of a chart.
struct ChartLine {
  std::string name = {};            ///< Name in the legend; a line without one is not in it.
  std::vector<double> values = {};  ///< One per x of the chart. [finite, >= 0]
  std::vector<double> spread =
      {};  ///< Drawn as a band of values +- spread; or empty. [finite, >= 0]
  LineKind kind = LineKind::kPlain;
};

/// A line chart: lines over a shared x; both axes are linear, y begins at 0.
struct Chart {
  std::string title = {};
  std::vector<std::string> notes = {};  ///< Under the title, one line each.
  std::string x_title = {}, y_title = {};
  std::vector<double> x = {};  ///< [finite, ascending, at least 2]
  std::vector<ChartLine> lines = {};
  double max = 0;        ///< Top of the y axis; values above are cut off. 0: from the values.
  int32_t width = 1200;  ///< [px, 400 to 8000]
};

/// Draws a chart. Fails with kBadConfig and the line that does not fit.
[[nodiscard]] THRONG_API Result<Image> draw_chart(const Chart& chart);

// ----
// Heat maps: a quantity over the plan as a picture, such as density or waiting time.

/// A heat map. Cells are row by row, x to the right, z down: cell (i, k) begins at x0 + i * cell,
/// z0 + k * cell.
struct HeatMap {
  std::string title = {};
  std::vector<std::string> notes = {};  ///< Under the title, one line each.
  std::string unit = {};                ///< Of the values.
  double x0 = 0, z0 = 0;                ///< [m]
  double cell = 0.5;                    ///< [m, > 0]
  int32_t width = 0, depth = 0;         ///< [cells, 1 to 1000000]
  std::vector<double> values = {};      ///< width * depth. [finite, >= 0; 0 stays paper]
  double max = 0;  ///< Value of the darkest colour; larger values have the same. 0: the largest.
  int32_t picture_width = 1200;  ///< [px, 400 to 8000]
};

/// Draws a map; cells larger than a pixel are squares, smaller ones are averaged. Fails with
/// kBadConfig.
[[nodiscard]] THRONG_API Result<Image> draw_heat_map(const HeatMap& map);

}  // namespace throng
