// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/result.h"
#include "throng/scene.h"

/// Slices: horizontal cuts of a whole world, each with the highest surface below it in every cell.
/// Source: [ML06], algorithms 2 and 3, with the readings of docs/algorithms.md.
namespace throng {

/// Settings for slice_scene.
struct SliceConfig {
  double avatar_height = 1.75;  ///< Of the smallest avatar. [m, > 0]
  double resolution = 0.1;      ///< Largest loss of headroom. [m, >= 0.001]
  double cell = 0.1;            ///< Side of a cell. [m, >= 0.01]
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// A slice that was kept. Heights are whole millimetres.
struct Slice {
  int32_t height = 0;  ///< Height of the cut. [mm]
  /// Highest surface below, per cell; the far plane if there is none. [mm]
  std::vector<int32_t> surface;
};

/// All kept slices, highest first. Cell (x, z) is index z * width + x and covers
/// [origin_x + x * cell, origin_x + (x + 1) * cell] and likewise in z.
struct SliceSet {
  int32_t width = 0;
  int32_t depth = 0;
  double cell = 0;
  double origin_x = 0;                 ///< [m]
  double origin_z = 0;                 ///< [m]
  int32_t far_plane = 0;               ///< eq. 2: min_y - resolution. [mm]
  int32_t taken = 0;                   ///< Slices cut, kept or not.
  std::vector<int32_t> taken_heights;  ///< [mm], highest first
  std::vector<Slice> kept;
};

/// Cuts a scene into slices by one sweep over columns of spans. Time: spans + cells x slices cut.
/// Fails with kBadConfig, kBadInput (no triangles), kLimit (grid too large), kCancelled.
[[nodiscard]] THRONG_API Result<SliceSet> slice_scene(const Scene& scene, const SliceConfig& config,
                                                      Context& context);

}  // namespace throng
