// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/clearance.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

// A cell's margin is k if every cell that a point within k cells of it can lie on is legal. Two
// cells at (dx, dz) are max(|dx| - 1, 0), max(|dz| - 1, 0) apart, and the offsets nearer than k
// are, for k = 1 to 7, exactly the sums of these squares S and crosses P: S, S, S, P, P, S, P. So
// each margin is one more erosion of the last, a row of bits at a time.
namespace throng::bake {
namespace {

using Row = unsigned __int128;  // bit x + kApronBits is column x

constexpr std::array<bool, kMaxMargin> kSquare{true, true, true, false, false, true, false};

// A row of a layer with up to 8 columns of the layers to its left and right.
Row wide_row(const TileLegality* left, const TileLegality* right, const LayerLegality& layer,
             size_t avatar_class, int32_t step, size_t z) {
  Row row = static_cast<Row>(layer.classes[avatar_class].legal[z]) << kApronBits;
  const int16_t l = layer.link[0][z];
  if (l >= 0 && left != nullptr && layer.rise[0][z] <= step) {
    row |=
        (*left)[static_cast<size_t>(l)].classes[avatar_class].legal[z] >> (kTileSide - kApronBits);
  }
  const int16_t r = layer.link[1][z];
  if (r >= 0 && right != nullptr && layer.rise[1][z] <= step) {
    const uint64_t bits = (*right)[static_cast<size_t>(r)].classes[avatar_class].legal[z] & 0xff;
    row |= static_cast<Row>(bits) << (kApronBits + kTileSide);
  }
  return row;
}

// Adds the rows of the tile above or below: columns go to the layer that continues them.
void add_rows(const std::array<const TileLegality*, 3>& tiles, const LayerLegality& layer,
              size_t side, size_t avatar_class, int32_t step, size_t first_z, Row* rows) {
  const TileLegality* tile = tiles[1];
  if (tile == nullptr) return;
  for (size_t s = 0; s < tile->size(); ++s) {
    Row columns = 0;
    for (size_t x = 0; x < kTileSide; ++x) {
      if (layer.link[side][x] == static_cast<int16_t>(s) && layer.rise[side][x] <= step) {
        columns |= static_cast<Row>(1) << (x + kApronBits);
      }
    }
    if (columns == 0) continue;
    const Row corner = 0xff;
    if ((columns & (static_cast<Row>(1) << kApronBits)) != 0) columns |= corner;
    if ((columns & (static_cast<Row>(1) << (kApronBits + kTileSide - 1))) != 0) {
      columns |= corner << (kApronBits + kTileSide);
    }
    for (size_t i = 0; i < kApronBits; ++i) {
      rows[i] |=
          columns & wide_row(tiles[0], tiles[2], (*tile)[s], avatar_class, step, first_z + i);
    }
  }
}

}  // namespace

void link_layer(const Layer& layer, const std::array<const TileLayers*, 4>& sides, int32_t max_step,
                LayerLegality& out) {
  constexpr std::array<size_t, 4> kAcross{1, 0, 3, 2};
  constexpr int32_t kMissingRise = 1 << 28;
  for (size_t side = 0; side < 4; ++side) {
    out.link[side].fill(-1);
    out.rise[side].fill(0);
    const TileLayers* tile = sides[side];
    if (tile == nullptr || !layer.has_border[side]) continue;
    std::array<int32_t, kTileSide> best, link;
    best.fill(max_step + 1);
    link.fill(-1);
    const auto& own = layer.border[side];
    for (size_t s = 0; s < tile->size(); ++s) {
      const Layer& other = *(*tile)[s];
      const int32_t shift = other.base - layer.base;
      // Most are other storeys. (Feet may have moved by a millimetre since they were ranged.)
      if (!other.has_border[kAcross[side]] ||
          other.low_feet + shift > layer.high_feet + max_step + 2 ||
          other.high_feet + shift < layer.low_feet - max_step - 2) {
        continue;
      }
      const auto& across = other.border[kAcross[side]];
      for (size_t i = 0; i < kTileSide; ++i) {
        const int32_t apart = std::abs(across[i] + shift - own[i]);
        const int32_t rise = own[i] == kNone16 || across[i] == kNone16 ? kMissingRise : apart;
        link[i] = rise < best[i] ? static_cast<int32_t>(s) : link[i];
        best[i] = std::min(rise, best[i]);
      }
    }
    for (size_t i = 0; i < kTileSide; ++i) {
      out.link[side][i] = static_cast<int16_t>(link[i]);
      out.rise[side][i] = static_cast<uint16_t>(link[i] >= 0 ? best[i] : 0);
    }
  }
}

void erode(const std::array<const TileLegality*, 9>& tiles, size_t layer, size_t avatar_class,
           int32_t step, ClearancePlanes& out) {
  const LayerLegality& own = (*tiles[4])[layer];
  constexpr size_t kRows = kTileSide + 2 * kApronBits;
  std::array<Row, kRows> rows{};
  for (size_t z = 0; z < kTileSide; ++z) {
    rows[z + kApronBits] = wide_row(tiles[3], tiles[5], own, avatar_class, step, z);
  }
  add_rows({tiles[0], tiles[1], tiles[2]}, own, 2, avatar_class, step, kTileSide - kApronBits,
           &rows[0]);
  add_rows({tiles[6], tiles[7], tiles[8]}, own, 3, avatar_class, step, 0,
           &rows[kTileSide + kApronBits]);

  out = {};
  out.legal = own.classes[avatar_class].legal;
  for (const uint64_t row : out.legal) out.cells += std::popcount(row);
  bool full = out.cells == kTileArea;
  // Rows from first to last have cells: many layers are a storey of a few rows.
  size_t first = 0, last = kRows - 1;
  for (int32_t k = 0; k < kMaxMargin; ++k) {
    while (first < last && rows[first] == 0) ++first;
    while (last > first && rows[last] == 0) --last;
    Row above = first > 0 ? 0 : rows[0];  // as it was
    for (size_t z = first; z <= last; ++z) {
      const Row row = rows[z], below = rows[z + 1 < kRows ? z + 1 : z];
      if (kSquare[static_cast<size_t>(k)]) {
        const Row column = row & above & below;
        rows[z] = column & (column << 1) & (column >> 1);
      } else {
        rows[z] = row & (row << 1) & (row >> 1) & above & below;
      }
      above = row;
    }
    uint64_t left = 0, missing = 0;
    for (size_t z = 0; z < kTileSide; ++z) {
      const uint64_t survivors = static_cast<uint64_t>(rows[z + kApronBits] >> kApronBits);
      // A counter of three bits per cell: add one to the survivors.
      const uint64_t carry0 = out.margin[0][z] & survivors;
      out.margin[0][z] ^= survivors;
      const uint64_t carry1 = out.margin[1][z] & carry0;
      out.margin[1][z] ^= carry0;
      out.margin[2][z] ^= carry1;
      left |= survivors;
      missing |= ~survivors;
    }
    full = full && missing == 0;
    if (left == 0) break;
  }
  out.all = full;
}

}  // namespace throng::bake
