// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "throng/base.h"
#include "throng/world.h"

/// Which storeys a world has, how large they are, and how high they lie around a tile.
namespace throng::render {

/// What a picture needs of a world, so that it can be drawn from anything that has level tiles.
struct PictureWorld {
  double cell = 0.1;  ///< [m]
  Vec3d origin{};     ///< Of cell (0, 0); floors count from origin.y.
  Box3d bounds{};     ///< What to show. [m]
  int32_t tiles_x = 0;
  int32_t tiles_z = 0;
  std::vector<int32_t> storeys{};  ///< Of each level tile.
  std::function<LevelTileContent(uint32_t)> level_tile{};
  int32_t avatar_class = 0;
  std::string class_name{};
};

/// A level tile and the mean height of its floor.
struct LevelEntry {
  uint32_t level = 0;
  double mean = 0;  ///< [mm]
};

/// Storeys around a tile, lowest first. The height is the median over the means of the tile and its
/// eight neighbours, so that a tile that mixes storeys does not count.
struct LocalStoreys {
  std::vector<size_t> storey;
  std::vector<double> height;  ///< [mm]
};

/// The storeys that a picture shows.
struct StoreyChoice {
  std::vector<int32_t> shown;  ///< Lowest first.
  int32_t left_out = 0;
};

/// Reads every level tile once.
class StoreyIndex {
 public:
  using Tile = std::pair<int32_t, int32_t>;  ///< z, x

  explicit StoreyIndex(const PictureWorld& world);

  [[nodiscard]] size_t storey_count() const { return area_.size(); }
  [[nodiscard]] const std::map<Tile, std::vector<LevelEntry>>& tiles() const { return tiles_; }
  [[nodiscard]] LocalStoreys around(Tile tile) const;
  /// The middle row of cells of [first, first + count), or one of its middle half that crosses many
  /// more floors.
  [[nodiscard]] int32_t section_row(int32_t first, int32_t count) const;
  /// The `max_count` largest storeys, without crumbs; `wanted` is among them in any case (-1:
  /// none).
  [[nodiscard]] StoreyChoice choose(int32_t wanted, size_t max_count) const;

 private:
  std::vector<int32_t> storeys_;  // of each level tile
  std::map<Tile, std::vector<LevelEntry>> tiles_;
  std::vector<double> area_;          // of each storey [m^2]
  std::vector<uint64_t> row_floors_;  // of each row of cells
};

}  // namespace throng::render
