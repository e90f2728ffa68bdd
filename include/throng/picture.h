// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/math.h"
#include "throng/nodes.h"
#include "throng/result.h"
#include "throng/slices.h"
#include "throng/world.h"

/// Pictures without a window: plans of each level, a section, an exploded view of the levels.
namespace throng {

/// An avatar to draw as a disc.
struct PictureAvatar {
  Vec3d position;        ///< Feet. [m]
  double radius = 0.25;  ///< [m]
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
  bool air = false;     ///< Links of the air, and between air and ground; the world must have air.
  int32_t storey = -1;  ///< Only level tiles of this storey, or all nodes (-1).
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

/// Draws one slice as [ML06] figures 9 and 10 do: darker is higher.
[[nodiscard]] THRONG_API Image draw_slice(const SliceSet& slices, size_t index);

/// Encodes a PNG file. Empty if there is no memory for it.
[[nodiscard]] THRONG_API std::vector<uint8_t> png_bytes(const Image& image);
/// Writes a PNG file beside `path` and renames it. Fails with kIo.
[[nodiscard]] THRONG_API Result<void> write_png(const Image& image, const std::string& path);

}  // namespace throng
