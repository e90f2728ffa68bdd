// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/layers/layer_kernels.h"
#include "bake/layers/layers.h"

/// Where a class may stand: one bit per cell of a layer.
namespace throng::bake {

/// 64 rows of 64 bits; bit x of row z is cell (x, z).
using BitPlane = std::array<uint64_t, kTileSide>;

/// A class's body as the windows see it. [mm, cells]
struct BodyWindow {
  int32_t bottom = 0;  // [mm]
  int32_t height = 0;
  int32_t step = 0;
  int32_t hope = 0;            // no recheck passes a solid further from the feet
  bool barely = false;         // its slope's rise under the rim takes all of the bottom
  bool fine = false;           // tested by parts of cells: it reaches all of the next cells
  int32_t gentle = 0;          // on ground of a larger tilt it is not tested by parts [mm]
  double radius = 0;           // [cells]
  int32_t reach = 0;           // rows that a body on a cell can touch beyond it
  std::vector<int32_t> width;  // per row distance 0..reach: columns on either side
  std::vector<int32_t> core;   // likewise, of cells in which it reaches any solid
  /// Per cell that it can touch, row by row: the parts that it can touch, from anywhere on its
  /// cell; bit 8 j + i is part (i, j) of 8 x 8. Rows are padded with empty cells.
  std::vector<uint64_t> near_parts;
  int32_t near_stride = 0;
  uint32_t class_bit = 0;
};

/// `fine`: BakeConfig::fine.
BodyWindow body_window(const AvatarClass& avatar, int32_t class_index, double cell,
                       bool fine = false);

/// Layers of a tile that some classes use, all or the high ones, by their lowest tops.
struct LayerList {
  std::vector<const Layer*> layers;
  bool seams = false;  // some of them continue each other inside the tile

  void add(const Layer* layer) {
    layers.push_back(layer);
    seams |= layer->seams;
  }
  [[nodiscard]] size_t size() const { return layers.size(); }
  [[nodiscard]] bool empty() const { return layers.empty(); }
  [[nodiscard]] const Layer* operator[](size_t i) const { return layers[i]; }
  [[nodiscard]] auto begin() const { return layers.begin(); }
  [[nodiscard]] auto end() const { return layers.end(); }
};

/// Layers of a tile and its eight neighbours, row by row from (-1, -1); null: no tile there.
using Neighbourhood = std::array<const LayerList*, 9>;

/// Solids and free spans around one layer, with the neighbours' cells filled in. [mm from the
/// layer's base]
class LayerWindow {
 public:
  /// `reach` is the largest of all classes. [cells, <= 64]
  void assemble(const Neighbourhood& tiles, size_t layer, int32_t reach, const BodyLimits& limits);

  [[nodiscard]] int32_t reach() const { return reach_; }
  [[nodiscard]] int32_t pad() const { return pad_; }
  [[nodiscard]] int32_t stride() const { return stride_; }
  /// Cell (x, z) may lie up to `reach` outside the tile.
  [[nodiscard]] size_t index(int32_t x, int32_t z) const {
    return static_cast<size_t>((z + pad_) * stride_ + x + pad_);
  }
  std::vector<uint16_t> top;
  std::vector<uint16_t> ceiling;

 private:
  void copy_own(const Layer& own);
  void fill_apron(const Neighbourhood& tiles, const Layer& own, int32_t reach);
  void fill_side(const LayerList& tile, const Layer& own, int32_t dx, int32_t dz, int32_t reach);
  void fill_corner(const LayerList& tile, const Layer& own, int32_t dx, int32_t dz, int32_t reach);
  void fill_holes(const LayerList& tile, size_t layer, const BodyLimits& limits);

  int32_t reach_ = 0;
  int32_t pad_ = 0;
  int32_t stride_ = 0;
  std::vector<FreeSpanLine> lines_;  // of one line of cells, per layer
  std::vector<uint16_t> columns_;    // of the layers, where a line is one
};

/// Scratch of one worker for legal_cells.
struct LegalityScratch {
  LayerWindow window;
  std::vector<uint16_t> rows;                        // horizontal extremes
  alignas(64) std::array<uint16_t, kTileArea> tilt;  // half of the feet's rise over a cell
};

/// What legal_cells found for one class.
struct LegalCells {
  BitPlane legal{};
  BitPlane stands{};   // may_stand
  BitPlane slanted{};  // of those, failed only for how high or low the solids around are
  BitPlane hemmed{};  // of those, on gentle ground, failed only for cells that a fine body may just
                      // miss matter in
};

/// True if nothing in reach can stop this class anywhere on the layer, judged by the layers'
/// extremes alone: the common case of open flat ground.
bool all_legal(const Neighbourhood& tiles, size_t layer, const BodyWindow& body,
               const BodyLimits& limits);

/// Cells where the class has a surface that it may stand on and fits over it, whatever is around:
/// the only ones that can be legal. False if there are none.
bool may_stand(const Layer& layer, const BodyWindow& body, const BodyLimits& limits,
               BitPlane& cells);

/// The test of docs/design/000-house.md, "legality is tested by value", for one class. `cells` are
/// those of may_stand; `scratch` holds the window (assembled) and the tilt (from make_tilt).
void legal_cells(const Layer& layer, const BodyWindow& body, const BitPlane& cells,
                 LegalityScratch& scratch, LegalCells& out);

/// The same test, relative to the plane of the feet, for cells that failed it only for a solid's
/// height: on a slope a whole cell is higher than the part of it that the body reaches.
void recheck_slopes(const Layer& layer, const BodyWindow& body, const LegalityScratch& scratch,
                    LegalCells& cells);

/// Absolute heights of a free span that a body on one cell needs. [mm]
struct ColumnNeed {
  int32_t low_top, high_top;  // of the solid below
  int32_t ceiling;
};

/// True if one of the free spans of a tile's column holds the body.
bool column_is_free(const LayerList& tile, size_t cell, const ColumnNeed& need);

/// The same test for cells that failed it near a seam, where the window may have followed the wrong
/// layer: each column around may show any of its free spans. Slow, exact, for few cells. Those
/// that fail outside of the core become hemmed.
void recheck_seams(const Neighbourhood& tiles, size_t layer, const BodyWindow& body,
                   const BodyLimits& limits, const LegalityScratch& scratch, LegalCells& cells);

/// True if any two legal neighbours on the layer differ by at most the step.
bool step_safe(const Layer& layer, const BitPlane& legal, int32_t step);

}  // namespace throng::bake
