// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "path/edits/blocked_cells.h"
#include "throng/path.h"
#include "world/cell_blocks.h"

/// What a density map makes of the cells of a level tile: some are no ground, others cost more.
namespace throng::path {

/// Fails with kBadInput and the reason.
[[nodiscard]] Result<void> check_density(const DensityGrid& map);

class DensityCells {
 public:
  /// Costs are steps, so that ground of about the same weight is one piece of ground.
  static constexpr uint8_t kSteps = 5;

  explicit DensityCells(DensityGrid map);  ///< [check_density]

  /// Cells on which a body's middle can be over a pixel of weight 0.
  [[nodiscard]] world::CellRows zero_cells(const TileFloor& floor) const;
  /// By cell, the step of the weight under its middle; 0 where the map does not apply.
  [[nodiscard]] std::array<uint8_t, 4096> steps(const TileFloor& floor) const;
  /// Cost of a metre. [step < kSteps; 1 to 3]
  [[nodiscard]] static double cost(uint8_t step) { return 1 + 0.5 * step; }
  /// Do all weights that are not 0 cost the same?
  [[nodiscard]] bool is_even() const { return is_even_; }
  /// Tiles that the picture touches.
  [[nodiscard]] SquareRange tiles(const world::WorldData& world) const;
  /// Tiles that the pixels touch which make other ground than those of another map, or all tiles of
  /// both if that is of another place or size.
  [[nodiscard]] SquareRange changed_tiles(const world::WorldData& world,
                                          const DensityCells& other) const;
  [[nodiscard]] const DensityGrid& map() const { return map_; }

 private:
  // Pixels between two places along an axis, last included; none: first above last.
  [[nodiscard]] std::pair<int32_t, int32_t> columns(double low, double high) const;
  [[nodiscard]] std::pair<int32_t, int32_t> rows(double low, double high) const;
  [[nodiscard]] SquareRange tiles_of(const world::WorldData& world, double x0, double z0, double x1,
                                     double z1) const;
  [[nodiscard]] bool applies(const TileFloor& floor, int32_t x, int32_t z) const;

  DensityGrid map_;
  std::array<uint8_t, 256> step_of_{};  // by weight
  bool is_even_ = true;
};

}  // namespace throng::path
