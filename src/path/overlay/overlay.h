// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "path/surface/node_search.h"

/// Overlay cells, squares of ground on overlay levels: the cost of crossing each is known, so that
/// a long path need not be searched block by block. Source: [BMS04], [DGPW11];
/// docs/design/006-nodes.md.
namespace throng::path {

class OverlayGraph;

/// An overlay cell is four by four of those of the overlay level below; a block belongs to the one
/// that holds its middle, at whatever height. Of the portals that lead over borders some are
/// *entrances*: at least one for any two strongly connected components of overlay cells that a
/// portal joins, so that where a path exists, one exists over entrances; the higher the border's
/// overlay level, the farther apart. An entrance has two *entries*, one into each of its overlay
/// cells: 2 entrance, and 2 entrance + 1 if it is crossed backward.
class Overlay {
 public:
  static constexpr uint32_t kTimes = 4;
  /// For each overlay cell its entries, and the cost from each to the far side of each other
  /// entrance.
  struct OverlayLevel {
    double side = 0;  ///< [m]
    std::vector<uint32_t>
        above;  ///< By overlay cell: the one of the next overlay level that holds it.
    std::vector<uint32_t> of_entry;    ///< The overlay cell that an entry leads into.
    std::vector<uint32_t> first;       ///< By overlay cell, and the end: its entries,
    std::vector<uint32_t> entries;     ///< rising.
    std::vector<uint32_t> place;       ///< By entry: its place among those of its overlay cell.
    std::vector<uint64_t> first_cost;  ///< By overlay cell:
    std::vector<float> costs;          ///< row by row, one an entrance. Infinite: no path.

    [[nodiscard]] std::span<const uint32_t> entries_of(uint32_t overlay_cell) const {
      return std::span(entries).subspan(first[overlay_cell],
                                        first[overlay_cell + 1] - first[overlay_cell]);
    }
    [[nodiscard]] std::span<const float> costs_from(uint32_t entry) const {
      const uint32_t overlay_cell = of_entry[entry];
      const size_t count = first[overlay_cell + 1] - first[overlay_cell];
      return std::span(costs).subspan(first_cost[overlay_cell] + place[entry] * count, count);
    }
  };
  struct Entrance {
    uint32_t portal = 0;
    uint8_t overlay_level = 0;  ///< The highest one whose border it leads over.
  };

  /// None.
  Overlay() = default;
  /// The lowest overlay cells are the smallest squares that hold so many crossings on average. The
  /// same for any number of workers. Empty if the mesh would have only one overlay cell.
  Overlay(const graph::NodeMesh& mesh, const PieceCost& cost, int32_t workers,
          size_t crossings = 192);

  [[nodiscard]] bool empty() const { return overlay_levels_.empty(); }
  [[nodiscard]] const std::vector<OverlayLevel>& overlay_levels() const { return overlay_levels_; }
  [[nodiscard]] const std::vector<Entrance>& entrances() const { return entrances_; }
  /// Of the lowest overlay level.
  [[nodiscard]] const std::vector<uint32_t>& of_block() const { return of_block_; }
  [[nodiscard]] std::span<const uint32_t> blocks_of(uint32_t overlay_cell) const {
    return std::span(blocks_).subspan(first_block_[overlay_cell],
                                      first_block_[overlay_cell + 1] - first_block_[overlay_cell]);
  }
  [[nodiscard]] Crossing crossing(uint32_t entry) const {
    return {entrances_[entry / 2].portal, entry % 2 != 0};
  }
  /// Where an entry leads to. [m]
  [[nodiscard]] Vec3d at(uint32_t entry) const { return at_[entry]; }
  /// The entry of a crossing, or kNoNode: its portal is no entrance.
  [[nodiscard]] uint32_t entry_of(const Crossing& crossing) const;
  [[nodiscard]] uint64_t bytes() const;

 private:
  void choose_sides(const graph::NodeMesh& mesh, int32_t workers, size_t crossings);
  void choose_entrances(const graph::NodeMesh& mesh, int32_t workers);
  void list_entries(const graph::NodeMesh& mesh, OverlayLevel& overlay_level, uint8_t k);
  void measure_costs(const graph::NodeMesh& mesh, const PieceCost& cost, int32_t workers);
  void join_up(size_t overlay_level, int32_t workers);

  std::vector<uint32_t> of_block_;
  std::vector<uint32_t> first_block_, blocks_;  // by overlay cell of the lowest level
  std::vector<OverlayLevel> overlay_levels_;
  std::vector<Entrance> entrances_;  // by portal, rising
  std::vector<Vec3d> at_;            // by entry
};

}  // namespace throng::path
