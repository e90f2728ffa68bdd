// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/cell_blocks.h"

/// Connected parts of one level tile, whole rows of cells at a time.
namespace throng::graph {

/// Where no step leads from a cell to the next: bit x of `across` row z between (x, z) and
/// (x + 1, z), of `along` row z between (x, z) and (x, z + 1).
struct StepCuts {
  world::CellRows across{}, along{};
};

/// The cells of `open` that are connected to cell (x, z), which must be open. Neighbours share a
/// side. `cuts` may be null.
world::CellRows flood(const world::CellRows& open, const StepCuts* cuts, int32_t x, int32_t z);

enum TileSide : size_t { kWest, kEast, kNorth, kSouth };

/// Connected parts of level tiles. Of each, only the rows from its first cell to its last are kept.
struct PartList {
  struct Part {
    uint32_t rows = 0;            // where its rows begin in `rows`
    uint16_t begin = 0, end = 0;  // rows of the tile: [begin, end)
    uint32_t cells = 0;
    std::array<uint64_t, 4> side{};  // its cells along the four borders of the tile
  };

  std::vector<Part> parts;
  std::vector<uint64_t> rows;

  void clear() {
    parts.clear();
    rows.clear();
  }
  /// Row z of a part. [begin <= z < end]
  [[nodiscard]] uint64_t row(const Part& part, size_t z) const {
    return rows[part.rows + z - part.begin];
  }
};

/// Finds parts. What it needs beside them it keeps from one time to the next.
class PartFinder {
 public:
  /// Adds all connected parts of `open` to a list, in the order of their first cells, row by row.
  /// `cuts` may be null.
  void find(const world::CellRows& open, const StepCuts* cuts, PartList& list);
  /// The same without cuts, but only if it takes little time: false if not, and then adds nothing.
  bool find_few(const world::CellRows& open, PartList& list);

 private:
  // Rows one after the other that are alike. Where walls run along the grid that are nearly all: 9
  // of 10 in city400, 4 of 10 where they run askew.
  struct Band {
    uint16_t begin = 0, end = 0;  // rows of the tile: [begin, end)
    uint16_t first_run = 0;
  };

  bool find_bands(const world::CellRows& open, const StepCuts* cuts);
  void add_parts(const world::CellRows& open, const StepCuts* cuts, bool is_chain, PartList& list);
  void find_runs(const world::CellRows& open, const StepCuts* cuts);
  static void add_run(uint64_t run, const Band& band, PartList::Part& part);
  uint16_t root(uint16_t run);

  std::array<Band, 65> bands_{};  // one more at the end
  size_t band_count_ = 0;
  // Runs of cells of all bands, band by band; connected ones are trees whose roots are the first of
  // them.
  std::vector<uint64_t> cells_;
  std::vector<uint16_t> parent_;
  std::vector<uint32_t> part_;  // of the roots
};

}  // namespace throng::graph
