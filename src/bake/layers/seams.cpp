// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <bit>
#include <cstdlib>

#include "bake/layers/layer_kernels.h"
#include "bake/layers/legality.h"

// Where a floor lies over itself inside a tile (a ramp over the ground that leads to it), its layer
// is cut, and near the cut a window may have followed the lower floor where the body walks on the
// upper. Any free span that holds the body proves a column free, so there all free spans are
// tested.
namespace throng::bake {
namespace {

constexpr int32_t kLast = kTileSide - 1;

enum class Fit { kYes, kPerhaps, kNo };

// kPerhaps: it does not where the body may just miss the blocker.
Fit body_fits(const Neighbourhood& tiles, const BodyWindow& body, int32_t x, int32_t z,
              const ColumnNeed& need) {
  // From the middle outward: 0, -1, 1, -2 and so on. What fails mostly does so near by.
  const auto nth = [](int32_t i) { return (i & 1) != 0 ? -(i + 1) / 2 : i / 2; };
  for (int32_t i = 0; i <= 2 * body.reach; ++i) {
    const int32_t dz = nth(i), w = body.width[static_cast<size_t>(std::abs(dz))];
    for (int32_t k = 0; k <= 2 * w; ++k) {
      const int32_t cx = x + nth(k), cz = z + dz;
      const int32_t side =
          (cz < 0 ? 0 : (cz > kLast ? 6 : 3)) + (cx < 0 ? 0 : (cx > kLast ? 2 : 1));
      const LayerList* tile = tiles[static_cast<size_t>(side)];
      const size_t cell = static_cast<size_t>((cz & kLast) * kTileSide + (cx & kLast));
      if (tile != nullptr && column_is_free(*tile, cell, need)) continue;
      const auto d = static_cast<size_t>(std::abs(dz));
      return d < body.core.size() && std::abs(nth(k)) <= body.core[d] ? Fit::kNo : Fit::kPerhaps;
    }
  }
  return Fit::kYes;
}

// Cells of a layer whose neighbour is continued by another layer of the tile.
BitPlane seam_cells(const LayerList& tile, const Layer& own, int32_t max_step) {
  // Most of the other layers are other storeys, which continue nothing.
  const auto is_near = [&](const Layer& other) {
    return &other != &own && other.base + other.low_top <= own.base + own.high_top + max_step &&
           other.base + other.high_top >= own.base + own.low_top - max_step;
  };
  BitPlane others{}, seams{};
  bool any = false;
  for (const Layer* other : tile) {
    if (!is_near(*other)) continue;
    add_free_span_bits(*other, others);
    any = true;
  }
  if (!any) return seams;
  TopLinks links;
  link_tops(own, max_step, links);
  const auto look = [&](uint64_t cells, int32_t z, int32_t dx, int32_t dz) {
    for (; cells != 0; cells &= cells - 1) {
      const int32_t x = std::countr_zero(cells);
      const int32_t top = own.base + own.top[static_cast<size_t>(z * kTileSide + x)];
      const auto next = static_cast<size_t>((z + dz) * kTileSide + x + dx);
      for (const Layer* other : tile) {
        if (!is_near(*other) || other->top[next] == kNone16) continue;
        if (std::abs(other->base + other->top[next] - top) > max_step) continue;
        seams[static_cast<size_t>(z)] |= 1ULL << x;
        break;
      }
    }
  };
  for (int32_t z = 0; z < kTileSide; ++z) {
    const auto r = static_cast<size_t>(z);
    const uint64_t has = links.has[r];
    look(has & ~links.right[r] & (others[r] >> 1), z, 1, 0);
    look(has & ~(links.right[r] << 1) & (others[r] << 1), z, -1, 0);
    if (z < kLast) look(has & ~links.down[r] & others[r + 1], z, 0, 1);
    if (z > 0) look(has & ~links.down[r - 1] & others[r - 1], z, 0, -1);
  }
  return seams;
}

// Every cell within `reach` of a set bit, along rows and columns.
BitPlane widened(const BitPlane& plane, int32_t reach) {
  BitPlane across = plane, out{};
  for (auto& row : across) {
    for (int32_t i = 0; i < reach; ++i) row |= (row << 1) | (row >> 1);
  }
  for (int32_t z = 0; z < kTileSide; ++z) {
    for (int32_t dz = -reach; dz <= reach; ++dz) {
      if (z + dz < 0 || z + dz > kLast) continue;
      out[static_cast<size_t>(z)] |= across[static_cast<size_t>(z + dz)];
    }
  }
  return out;
}

}  // namespace

bool column_is_free(const LayerList& tile, size_t cell, const ColumnNeed& need) {
  for (const Layer* layer : tile) {
    // Most layers are other storeys: their extremes suffice.
    if (layer->base + layer->low_top > need.high_top ||
        layer->base + layer->high_top < need.low_top || layer->top[cell] == kNone16) {
      continue;
    }
    const int32_t top = layer->base + layer->top[cell];
    const bool headroom =
        layer->ceiling[cell] == kNone16 || layer->base + layer->ceiling[cell] >= need.ceiling;
    if (top <= need.high_top && top >= need.low_top && headroom) return true;
  }
  return false;
}

void recheck_seams(const Neighbourhood& tiles, size_t layer, const BodyWindow& body,
                   const BodyLimits& limits, const LegalityScratch& scratch, LegalCells& cells) {
  const LayerList& tile = *tiles[4];
  const Layer& own = *tile[layer];
  BitPlane doubtful{};
  if (tile.size() > 1 && (tile.seams || body.bottom > limits.link_step)) {
    doubtful = widened(seam_cells(tile, own, body.bottom), body.reach);
  }
  // Along the border of a tile of several layers the window may have followed the wrong one too.
  const auto several = [&](size_t side) {
    return tiles[side] != nullptr && tiles[side]->size() > 1;
  };
  const int32_t reach = std::min(body.reach, kTileSide);
  for (int32_t z = 0; z < kTileSide; ++z) {
    uint64_t& row = doubtful[static_cast<size_t>(z)];
    const uint64_t left = reach >= 64 ? ~uint64_t{0} : (1ULL << reach) - 1;
    if (several(3)) row |= left;
    if (several(5)) row |= left << (kTileSide - reach);
    if (z < reach && (several(0) || several(1) || several(2))) row = ~uint64_t{0};
    if (z >= kTileSide - reach && (several(6) || several(7) || several(8))) row = ~uint64_t{0};
  }
  for (int32_t z = 0; z < kTileSide; ++z) {
    const size_t r = static_cast<size_t>(z);
    uint64_t row = doubtful[r] & cells.stands[r] & ~cells.legal[r];
    for (; row != 0; row &= row - 1) {
      const int32_t x = std::countr_zero(row);
      const size_t cell = static_cast<size_t>(z * kTileSide + x);
      const int32_t feet = own.base + own.feet[cell], tilt = scratch.tilt[cell];
      const ColumnNeed need{feet + tilt - body.bottom, feet - tilt + body.bottom,
                            feet + tilt + body.height};
      const Fit fit = body_fits(tiles, body, x, z, need);
      if (fit == Fit::kYes) cells.legal[r] |= 1ULL << x;
      if (fit == Fit::kPerhaps) cells.hemmed[r] |= 1ULL << x;
    }
  }
}

}  // namespace throng::bake
