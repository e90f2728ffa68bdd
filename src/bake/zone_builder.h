// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/clearance.h"
#include "bake/sheets.h"
#include "world/zone_generated.h"

/// Packs the sheets of a zone into a zone file's arrays: constants and planes where they serve.
namespace throng {

/// Replaces a sheet's feet by a plane if that changes no height by more than 1 mm. Run before
/// legality is judged, so that everything after sees the feet that the moves will see.
struct FloorPlane {
  bool found = false;
  int32_t base = 0;                  // [mm], absolute, at the centre of cell (0, 0)
  int32_t part = 0;                  // of the base below 1 mm [1/1024 mm]
  int32_t slope_x = 0, slope_z = 0;  // [1/1024 mm per cell]
};
FloorPlane fit_plane(Sheet& sheet);

class ZoneBuilder {
 public:
  ZoneBuilder(uint32_t tiles_per_side, size_t class_count, const SurfaceCodes& codes);

  /// Adds one level of tile `tile`; tiles come in ascending order.
  void add_level(uint32_t tile, const Sheet& sheet, const FloorPlane& plane,
                 std::span<const ClearancePlanes> clearance, std::span<const uint8_t> step_safe);

  [[nodiscard]] uint32_t level_count() const { return static_cast<uint32_t>(levels_.size()); }
  [[nodiscard]] uint32_t plain_count() const { return plain_; }
  [[nodiscard]] uint32_t tile_count() const { return tiles_with_levels_; }
  [[nodiscard]] std::span<const uint64_t> legal_cells() const { return legal_cells_; }

  /// The zone file's bytes.
  [[nodiscard]] std::vector<uint8_t> finish(int32_t zone_x, int32_t zone_z) const;

 private:
  uint32_t add_planes(const BitPlane& plane);
  uint32_t add_heights(std::span<const uint16_t> values);

  uint32_t tiles_per_side_;
  size_t class_count_;
  const SurfaceCodes& codes_;
  std::vector<uint32_t> levels_of_tile_;
  std::vector<format::Level> levels_;
  std::vector<format::Clearance> clearance_;
  std::vector<uint16_t> heights_;
  std::vector<uint64_t> planes_;
  std::vector<uint8_t> areas_;
  std::vector<uint64_t> legal_cells_;
  uint32_t plain_ = 0;
  uint32_t tiles_with_levels_ = 0;
  uint32_t last_tile_ = UINT32_MAX;
};

}  // namespace throng
