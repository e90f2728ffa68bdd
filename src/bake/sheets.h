// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "bake/gaps.h"
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
struct Sheet {
  static constexpr int32_t kBelow = 4000;     // [mm]
  static constexpr int32_t kHighest = 60000;  // tops above base + this go to another sheet

  int32_t base = 0;
  int32_t cells = 0;                     // that have a gap
  int32_t present = 0;                   // that have feet
  uint16_t low_top = 0, high_top = 0;    // over cells with a gap
  uint16_t low_feet = 0, high_feet = 0;  // over cells with feet
  uint16_t low_ceiling = 0;              // over cells with a gap
  bool seams = false;                    // the tile has sheets that continue each other inside it
  bool one_code = false;                 // all feet have the code of the first of them
  uint8_t some_code = 0;
  alignas(64) std::array<uint16_t, kTileArea> top;      // matter below the gap; kNone16: no gap
  alignas(64) std::array<uint16_t, kTileArea> ceiling;  // of the gap, rounded down
  alignas(64) std::array<uint16_t, kTileArea> feet;     // kNone16: nobody can stand here
  alignas(64) std::array<uint8_t, kTileArea> code;      // surface code where there are feet
  alignas(64) std::array<uint16_t, 32> slack;  // vector loads may run past the arrays above
};

/// What any of the classes could use, so that one bake serves them all. [mm]
struct BodyLimits {
  int32_t min_gap = 0;            // smallest height - bottom: less room than this is matter
  int32_t min_height = 0;         // smallest height
  int32_t min_footprint = 0;      // fewest cells that a body needs [cells]
  int32_t max_bottom = 0;         // largest bottom = how far matter may top the feet
  int32_t blocked_code = 0;       // of the surface that no class may stand on
  std::vector<uint32_t> allowed;  // per surface code: which classes may stand there
};

BodyLimits body_limits(std::span<const AvatarClass> classes, const SurfaceCodes& codes,
                       double cell);

/// Bottom of a class's body in whole mm, rounded down; height rounded up.
int32_t bottom_mm(const AvatarClass& avatar);
int32_t height_mm(const AvatarClass& avatar);

/// Recycles sheets: a zone makes and drops thousands.
class SheetPool {
 public:
  std::unique_ptr<Sheet> take();
  void give(std::unique_ptr<Sheet> sheet);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Sheet>> free_;
};

/// The sheets of one tile, those with feet only, lowest first.
using TileSheets = std::vector<std::unique_ptr<Sheet>>;

/// Deals the gaps of a tile to sheets. Linear in the gaps.
void deal_gaps(const TileGaps& gaps, const BodyLimits& limits, SheetPool& pool, TileSheets& sheets);

}  // namespace throng
