// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "bake/columns/free_spans.h"
#include "bake/columns/grid.h"
#include "bake/columns/triangles.h"
#include "throng/avatar.h"

/// Layers: the free spans of a tile, assigned to layers of at most one free span per column, so
/// that a layer follows one floor. A finished layer is a level tile.
namespace throng::bake {

inline constexpr uint16_t kNone16 = 65535;         // no free span, no feet; for ceilings: open sky
inline constexpr uint16_t kHighCeiling16 = 65534;  // a ceiling that high or more

/// One free span per cell. Heights are [mm] from `base`, which lies kBaseDepth under the lowest top
/// so that lower neighbours keep distinct heights.
struct Layer {
  static constexpr int32_t kBaseDepth = 4000;  // [mm]
  static constexpr int32_t kMaxTop = 60000;    // tops above base + this go to another layer

  int32_t base = 0;
  int32_t cells = 0;                     // that have a free span
  int32_t present = 0;                   // that have feet
  uint16_t low_top = 0, high_top = 0;    // over cells with a free span
  uint16_t low_feet = 0, high_feet = 0;  // over cells with feet
  uint16_t low_ceiling = 0;              // over cells with a free span
  bool seams = false;                    // other layers of the tile continue it where it was cut
  bool is_low = false;                   // for classes that fit in less than kHighFreeSpan
  bool one_code = false;                 // all feet have the code of the first of them
  uint8_t some_code = 0;
  alignas(64) std::array<uint16_t, kTileArea> top;      // solid below the free span; kNone16: none
  alignas(64) std::array<uint16_t, kTileArea> ceiling;  // of the free span, rounded down
  // Of what lies below the free span, useful or not: floors slope as their solid does.
  alignas(64) std::array<uint16_t, kTileArea> feet;  // kNone16: nothing to stand on
  alignas(64) std::array<uint8_t, kTileArea> code;   // surface code where there are feet
  alignas(64) std::array<uint16_t, 32> slack;        // vector loads may run past the arrays above
  std::array<uint64_t, kTileSide> useful;            // bit x of row z: some class may stand here
  bool all_useful = false;                           // wherever there are feet
  // Useful feet along the tile's sides, kNone16 elsewhere: left, right, up (z = 0), down.
  std::array<std::array<uint16_t, kTileSide>, 4> border;
  std::array<bool, 4> has_border;  // any of those
};

/// What any of the classes could use, so that one bake serves them all. How free spans are found,
/// and assigned to layers, depends on the classes only if one of them is uncommonly small: the
/// layers of a floor must not change with the other classes of the world. Free spans in which
/// adults fit are assigned separately, so that classes that need no lower ones do not pay for them.
/// [mm]
struct BodyLimits {
  static constexpr int32_t kHighFreeSpan = 1300;  // lower ones are for lower classes
  static constexpr int32_t kLowFreeSpan = 300;    // lower ones are solid, unless a class fits
  static constexpr double kMinRadius = 0.16;      // unless a class is narrower [m]

  int32_t min_free_span = 0;      // lower ones are solid: kHighFreeSpan if all need it
  int32_t low_free_span = 0;      // the same, if some class needs less than kHighFreeSpan
  int32_t link_step = 500;        // tops this far apart at most are one floor
  int32_t min_height = 0;         // smallest height
  int32_t min_footprint = 0;      // on a smaller floor no class can stand [cells]
  int32_t max_bottom = 0;         // largest bottom = how far a solid may rise above the feet
  int32_t blocked_code = 0;       // of the surface that no class may stand on
  std::vector<uint32_t> allowed;  // per surface code: which classes may stand there
};

BodyLimits body_limits(std::span<const AvatarClass> classes, const SurfaceCodes& codes,
                       double cell);

/// The lowest free span that a class can use: its height less its bottom. [mm, > 0]
int32_t min_free_span_of(const AvatarClass& avatar);

/// Bottom of a class's body in whole mm, rounded down; height rounded up.
int32_t bottom_mm(const AvatarClass& avatar);
int32_t height_mm(const AvatarClass& avatar);

/// Finds where some class may stand: `useful` and the borders, from the feet.
void find_useful(const BodyLimits& limits, Layer& layer);

/// Fills the borders from the feet and `useful`.
void set_borders(Layer& layer);

/// Recycles layers: a zone makes and discards thousands.
class LayerPool {
 public:
  std::unique_ptr<Layer> take();
  void give(std::unique_ptr<Layer> layer);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Layer>> free_;
};

/// The layers of one tile, by their lowest tops.
using TileLayers = std::vector<std::unique_ptr<Layer>>;

/// The free spans of a tile of kHighFreeSpan and more; all of BodyLimits::min_free_span and more
/// too, if that is less.
struct FreeSpansToAssign {
  const TileFreeSpans& high;
  const TileFreeSpans* all = nullptr;
};

/// Assigns the free spans of a tile to layers, which are cleared first. Sets all but `useful` and
/// the borders. Linear in the free spans.
void assign_free_spans(const FreeSpansToAssign& free_spans, const BodyLimits& limits,
                       LayerPool& pool, TileLayers& layers);

}  // namespace throng::bake
