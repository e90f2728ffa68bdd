// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/layers/legality.h"

/// How far around a legal cell everything stays legal, by word-wide erosion across tiles.
namespace throng::bake {

inline constexpr int32_t kMaxMargin = 7;  // cells
inline constexpr int32_t kApronBits = 8;  // columns and rows that erosion looks past a tile

/// What one layer is to each class, once legality is known.
struct LayerLegality {
  struct PerClass {
    BitPlane legal{};
    bool all = false;  // every cell of the layer
    bool any = false;
    bool step_safe = true;
  };
  std::vector<PerClass> classes;

  /// Which layer of the neighbouring tile continues this one across each border cell (-1: none),
  /// and by how much the feet differ. Sides: 0 left, 1 right, 2 up (z - 1), 3 down. [mm]
  std::array<std::array<int16_t, kTileSide>, 4> link;
  std::array<std::array<uint16_t, kTileSide>, 4> rise;
};

using TileLegality = std::vector<LayerLegality>;

/// Links of one layer to the four tiles beside it: for each border cell the layer whose feet are
/// nearest, if within `max_step`.
void link_layer(const Layer& layer, const std::array<const TileLayers*, 4>& sides, int32_t max_step,
                LayerLegality& out);

/// Legal cells and the margin of each, as planes: `legal` and the three bits of the margin.
struct ClearancePlanes {
  BitPlane legal{};
  std::array<BitPlane, 3> margin{};
  bool all = false;  // legal with the full margin everywhere
  int32_t cells = 0;
};

/// Margins of a layer for one class. `tiles` are the legalities of the 3 x 3 tiles around it.
void erode(const std::array<const TileLegality*, 9>& tiles, size_t layer, size_t avatar_class,
           int32_t step, ClearancePlanes& out);

}  // namespace throng::bake
