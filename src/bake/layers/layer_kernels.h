// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bake/layers/layers.h"
#include "world/cell_blocks.h"

/// The vector loops of layers. Rows of 64 cells are words of bits: bit x is cell x.
namespace throng::bake {

/// Which free spans of one free-span layer continue each other, row by row.
struct FreeSpanLinks {
  std::array<uint64_t, kTileSide> has;   // the cell has a free span of this rank
  std::array<uint64_t, kTileSide> left;  // it continues that of the same rank at x - 1
  std::array<uint64_t, kTileSide> up;    // and at z - 1
};

/// Free spans of neighbouring columns continue each other if their tops are at most `step` apart
/// and what is free over both is at least `free_span`.
struct LinkRule {
  int32_t step, free_span;  // [mm]
};

/// `only`, unless null: the free spans of the free-span layer that count.
void link_free_spans(const TileFreeSpans& free_spans, int32_t free_layer, const LinkRule& rule,
                     const world::CellRows* only, FreeSpanLinks& links);

/// Cells of a free-span layer whose free span is lower than `height`. [mm]
void low_free_spans(const TileFreeSpans& free_spans, int32_t free_layer, int32_t height,
                    world::CellRows& rows);

/// Lowest and highest top over the cells of a free-span layer that have one.
struct TopRange {
  int32_t low = INT32_MAX, high = INT32_MIN;
};
TopRange free_span_range(const TileFreeSpans& free_spans, int32_t free_layer);
/// The same over the cells of row z whose bits are set.
TopRange run_range(const FreeSpanLayer& free_layer, int32_t z, uint64_t cells);

/// Sets every cell to "no free span".
void clear_layer(Layer& layer);

/// Copies the free spans of `free_layer` in row z whose bits are set into the layer, whose base is
/// set.
void write_free_spans(const FreeSpanLayer& free_layer, int32_t z, uint64_t cells, Layer& layer);

/// Fills the layer's counts and extremes.
void summarise(Layer& layer);

/// Could the feet be a plane? Quick and sure when it says no: differences of neighbours must agree
/// to within 2 mm.
bool may_be_plane(const Layer& layer);

/// Half of what the feet may rise or fall over each cell, see world/surface.h; rows in which no
/// class may stand are left as they are. [mm]
void make_tilt(const Layer& layer, std::array<uint16_t, kTileArea>& tilt);

/// What the column of a body's feet must have: a solid at most `bottom` above them, `height` free
/// over them, and a surface of another code.
struct BodyNeed {
  int32_t bottom, height;  // [mm]
  int32_t blocked_code;
};

/// Cells with feet whose own columns have that, whatever is around. False if there are none.
bool useful_cells(const Layer& layer, const BodyNeed& need, world::CellRows& rows);

/// Removes the feet of all other cells, and counts feet again.
void keep_feet(const world::CellRows& rows, Layer& layer);

/// Which cells have feet: 64 rows of 64 bits.
void present_bits(const Layer& layer, std::array<uint64_t, kTileSide>& rows);

/// Lowest and highest ceiling over the cells that have feet.
struct HeightRange {
  uint16_t low = kNone16, high = 0;
};
HeightRange ceiling_range(const Layer& layer);

/// One layer's free spans along a line of 64 cells.
struct FreeSpanLine {
  const uint16_t* top;
  const uint16_t* ceiling;
  int32_t shift;  // from the layer's base to the target layer's [mm]
};

/// For each of 64 cells the free span whose top is nearest to `near`, which becomes that top; where
/// no layer has a free span, kNone16 under a ceiling of 0, and `near` stays. [mm]
void choose_free_spans(std::span<const FreeSpanLine> lines, int32_t* near, uint16_t* top,
                       uint16_t* ceiling);

/// True if the plane meets all feet to within 1 mm. Heights as LevelView::sample.
struct LevelPlane {
  int32_t base = 0;                  // at the centre of cell (0, 0), from the layer's base [mm]
  int32_t part = 0;                  // [1/1024 mm]
  int32_t slope_x = 0, slope_z = 0;  // [1/1024 mm per cell]
};
bool plane_fits(const Layer& layer, const LevelPlane& plane);

/// Puts all feet on the plane.
void put_on_plane(const LevelPlane& plane, Layer& layer);

/// Which cells have a free span, and which of them continue their neighbour's on the same layer:
/// tops within `step` of the cell to the right, and of the one below.
struct TopLinks {
  std::array<uint64_t, kTileSide> has, right, down;
};
void link_tops(const Layer& layer, int32_t step, TopLinks& links);

/// Bit x of row z: both it and the next cell have a free span, tops are at most `rule.step` apart,
/// and `rule.free_span` is free over both.
void even_runs(const Layer& layer, const LinkRule& rule, world::CellRows& rows);

/// Adds the cells that have a free span to `rows`.
void add_free_span_bits(const Layer& layer, std::array<uint64_t, kTileSide>& rows);

}  // namespace throng::bake
