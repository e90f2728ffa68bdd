// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "bake/free_spans.h"
#include "bake/grid.h"
#include "bake/triangles.h"
#include "throng/avatar_class.h"

/// Sheets: the gaps of a tile dealt to layers of one gap per column each, so that a layer follows
/// one floor. They are level tiles in the making.
namespace throng {

inline constexpr uint16_t kNone16 = 65535;         // no gap, no feet; for ceilings: open sky
inline constexpr uint16_t kHighCeiling16 = 65534;  // a ceiling that high or more

/// One gap per cell. Heights are [mm] from `base`, which lies kBelow under the lowest top so that
/// lower neighbours can still be told apart.
struct Layer {
  static constexpr int32_t kBelow = 4000;     // [mm]
  static constexpr int32_t kHighest = 60000;  // tops above base + this go to another sheet

  int32_t base = 0;
  int32_t cells = 0;                     // that have a gap
  int32_t present = 0;                   // that have feet
  uint16_t low_top = 0, high_top = 0;    // over cells with a gap
  uint16_t low_feet = 0, high_feet = 0;  // over cells with feet
  uint16_t low_ceiling = 0;              // over cells with a gap
  bool seams = false;                    // others of the tile go on where it was cut
  bool is_low = false;                   // for classes who get through less than kHighFreeSpan
  bool one_code = false;                 // all feet have the code of the first of them
  uint8_t some_code = 0;
  alignas(64) std::array<uint16_t, kTileArea> top;      // matter below the gap; kNone16: no gap
  alignas(64) std::array<uint16_t, kTileArea> ceiling;  // of the gap, rounded down
  // Of whatever lies below the gap, useful or not: floors lean as their matter does.
  alignas(64) std::array<uint16_t, kTileArea> feet;  // kNone16: nothing to stand on
  alignas(64) std::array<uint8_t, kTileArea> code;   // surface code where there are feet
  alignas(64) std::array<uint16_t, 32> slack;        // vector loads may run past the arrays above
  std::array<uint64_t, kTileSide> useful;            // bit x of row z: someone may stand here
  bool all_useful = false;                           // wherever there are feet
  // Useful feet along the tile's sides, kNone16 elsewhere: left, right, up (z = 0), down.
  std::array<std::array<uint16_t, kTileSide>, 4> border;
  std::array<bool, 4> has_border;  // any of those
};

/// What any of the classes could use, so that one bake serves them all. How gaps are found, and
/// dealt to sheets, does not depend on the classes unless one of them is uncommonly small: the
/// sheets of a floor must not change with who else walks in the world. Gaps that grown people get
/// through are dealt by themselves, so that who needs no lower ones does not pay for them. [mm]
struct BodyLimits {
  static constexpr int32_t kHighFreeSpan = 1300;  // less room is for those of lower classes
  static constexpr int32_t kLowFreeSpan = 300;  // less is matter, unless a class gets through less
  static constexpr double kMinRadius = 0.16;    // unless a class is narrower [m]

  int32_t min_free_span = 0;  // less room than this is matter: kHighFreeSpan if all need as much
  int32_t low_free_span = 0;  // the same, if some class needs less than kHighFreeSpan
  int32_t link_step = 500;    // tops this far apart at most are one floor
  int32_t min_height = 0;     // smallest height
  int32_t min_footprint = 0;  // a smaller floor holds nobody [cells]
  int32_t max_bottom = 0;     // largest bottom = how far matter may top the feet
  int32_t blocked_code = 0;   // of the surface that no class may stand on
  std::vector<uint32_t> allowed;  // per surface code: which classes may stand there
};

BodyLimits body_limits(std::span<const AvatarClass> classes, const SurfaceCodes& codes,
                       double cell);

/// The least room over matter that a class can use: its height less its bottom. [mm, > 0]
int32_t min_free_span_of(const AvatarClass& avatar);

/// Bottom of a class's body in whole mm, rounded down; height rounded up.
int32_t bottom_mm(const AvatarClass& avatar);
int32_t height_mm(const AvatarClass& avatar);

/// Finds where some class may stand: `useful` and the borders, from the feet.
void find_useful(const BodyLimits& limits, Layer& layer);

/// Fills the borders from the feet and `useful`.
void set_borders(Layer& layer);

/// Recycles sheets: a zone makes and drops thousands.
class LayerPool {
 public:
  std::unique_ptr<Layer> take();
  void give(std::unique_ptr<Layer> layer);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Layer>> free_;
};

/// The sheets of one tile, by their lowest tops.
using TileLayers = std::vector<std::unique_ptr<Layer>>;

/// The gaps of a tile of kHighFreeSpan and more; all of BodyLimits::min_free_span and more too, if
/// that is less.
struct FreeSpansToAssign {
  const TileFreeSpans& high;
  const TileFreeSpans* all = nullptr;
};

/// Deals the gaps of a tile to sheets, which are cleared first: all but what is useful of them.
/// Linear in the gaps.
void assign_free_spans(const FreeSpansToAssign& free_spans, const BodyLimits& limits,
                       LayerPool& pool, TileLayers& layers);

}  // namespace throng
