// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "path/node_search.h"

/// Squares of ground, in tiers: what it costs to go through each of them is known, so that a long
/// way need not be searched block by block. Source: [BMS04], [DGPW11]; docs/design/006-nodes.md.
namespace throng {

class OverlayGraph;

/// A square of a tier is four by four of the tier below it; a block is of that which holds its
/// middle, on whatever level. Of the portals that lead over borders some are *gates*: at least one
/// for any two strongly connected parts of districts that a portal joins, so that where there is a
/// way there is one over gates; the higher the border's tier, the farther apart. A gate has two
/// *entries*, one into each of its districts: 2 gate, and 2 gate + 1 if it is gone backward.
class Overlay {
 public:
  static constexpr uint32_t kTimes = 4;
  /// For each district its entries, and what it costs from each to be through each other gate.
  struct OverlayLevel {
    double side = 0;                   ///< [m]
    std::vector<uint32_t> above;       ///< By district: the one of the next tier that holds it.
    std::vector<uint32_t> of_entry;    ///< The district that an entry leads into.
    std::vector<uint32_t> first;       ///< By district, and the end: its entries,
    std::vector<uint32_t> entries;     ///< rising.
    std::vector<uint32_t> place;       ///< By entry: its place among those of its district.
    std::vector<uint64_t> first_cost;  ///< By district:
    std::vector<float> costs;          ///< row by row, one a gate. Infinite: there is no way.

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
  /// The lowest districts are the smallest squares that hold so many crossings on average. The same
  /// for any number of workers. None if the mesh is of one district.
  Overlay(const NodeMesh& mesh, const PieceCost& cost, int32_t workers, size_t crossings = 192);

  [[nodiscard]] bool empty() const { return overlay_levels_.empty(); }
  [[nodiscard]] const std::vector<OverlayLevel>& overlay_levels() const { return overlay_levels_; }
  [[nodiscard]] const std::vector<Entrance>& entrances() const { return entrances_; }
  /// Of the lowest tier.
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
  /// The entry of a crossing, or kNoNode: its portal is no gate.
  [[nodiscard]] uint32_t entry_of(const Crossing& crossing) const;
  [[nodiscard]] uint64_t bytes() const;

 private:
  void choose_sides(const NodeMesh& mesh, int32_t workers, size_t crossings);
  void choose_entrances(const NodeMesh& mesh, int32_t workers);
  void list_entries(const NodeMesh& mesh, OverlayLevel& overlay_level, uint8_t k);
  void measure_costs(const NodeMesh& mesh, const PieceCost& cost, int32_t workers);
  void join_up(size_t overlay_level, int32_t workers);

  std::vector<uint32_t> of_block_;
  std::vector<uint32_t> first_block_, blocks_;  // by district of the lowest tier
  std::vector<OverlayLevel> overlay_levels_;
  std::vector<Entrance> entrances_;  // by portal, rising
  std::vector<Vec3d> at_;            // by entry
};

}  // namespace throng
