// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>

#include "bake/layers/legality.h"

// The window of a layer: its own cells, and around them the cells of the neighbouring layers that
// continue it. Which layer a cell is taken from decides how much is found to be legal, never
// whether what is found is safe: any free span that holds the body proves its column free.
namespace throng::bake {
namespace {

// The top of another layer on this layer's scale. Out of range is no free span: were it drawn to
// the range's end, a class that may step far down would take a deep drop for a shallow one.
uint16_t rebased_top(uint16_t value, int32_t shift) {
  const int32_t moved = value + shift;
  return value == kNone16 || moved < 0 || moved > kNone16 ? kNone16 : static_cast<uint16_t>(moved);
}

uint16_t rebased_ceiling(uint16_t value, int32_t shift) {
  if (value == kNone16) return kNone16;
  return static_cast<uint16_t>(std::clamp<int32_t>(value + shift, 0, kHighCeiling16));
}

template <class Rebase>
void rebase_row(const uint16_t* from, int32_t count, int32_t shift, uint16_t* to, Rebase rebase) {
  if (shift == 0) {
    std::copy_n(from, count, to);
    return;
  }
  for (int32_t i = 0; i < count; ++i) to[i] = rebase(from[i], shift);
}

// The layer of a tile whose free span at `cell` is nearest to `near_top` (absolute), or null.
const Layer* nearest_layer(const LayerList& tile, size_t cell, int32_t near_top) {
  const Layer* best = nullptr;
  int32_t best_distance = INT32_MAX;
  for (const Layer* layer : tile) {
    if (layer->top[cell] == kNone16) continue;
    const int32_t distance = std::abs(layer->base + layer->top[cell] - near_top);
    if (distance < best_distance) {
      best_distance = distance;
      best = layer;
    }
  }
  return best;
}

// Adds the holes of a layer that another one's free spans continue by a step. Returns 0 if there
// are none.
uint64_t add_steps(const Layer& own, const world::CellRows& own_free_spans, const Layer& other,
                   const world::CellRows& other_free_spans, int32_t step, world::CellRows& holes) {
  // Most of the other layers are other storeys.
  if (own.base + own.low_top - step > other.base + other.high_top ||
      own.base + own.high_top + step < other.base + other.low_top) {
    return 0;
  }
  uint64_t any = 0;
  const auto add = [&](uint64_t cells, size_t z, ptrdiff_t offset) {
    for (; cells != 0; cells &= cells - 1) {
      const size_t cell = z * kTileSide + static_cast<size_t>(std::countr_zero(cells));
      const int32_t own_top = own.top[static_cast<size_t>(static_cast<ptrdiff_t>(cell) + offset)];
      if (std::abs(other.base + other.top[cell] - own.base - own_top) > step) continue;
      any |= holes[z] |= uint64_t{1} << cell % kTileSide;
    }
  };
  for (size_t z = 0; z < kTileSide; ++z) {
    const uint64_t open = other_free_spans[z] & ~own_free_spans[z];
    if (open == 0) continue;
    add(open & own_free_spans[z] << 1, z, -1);
    add(open & own_free_spans[z] >> 1, z, 1);
    if (z > 0) add(open & own_free_spans[z - 1], z, -kTileSide);
    if (z + 1 < kTileSide) add(open & own_free_spans[z + 1], z, kTileSide);
  }
  return any;
}

// The parts, of the cell that lies (dx, dz) from a square's, that are nearer to the square than the
// radius. [cells]
uint64_t near_parts_of(int32_t dx, int32_t dz, double radius) {
  const auto apart = [](double low) { return std::max({low - 1, -(low + 0.125), 0.0}); };
  uint64_t parts = 0;
  for (int32_t i = 0; i < 64; ++i) {
    const double x = apart(dx + i % 8 * 0.125), z = apart(dz + i / 8 * 0.125);
    if (x * x + z * z < radius * radius) parts |= uint64_t{1} << i;
  }
  return parts;
}

}  // namespace

BodyWindow body_window(const AvatarClass& avatar, int32_t class_index, double cell, bool fine) {
  BodyWindow body;
  body.bottom = bottom_mm(avatar);
  body.height = height_mm(avatar);
  body.step = static_cast<int32_t>(std::floor(avatar.step_height * 1000 + 1e-6));
  body.class_bit = 1u << class_index;
  // Cells at distance (dx, dz) are max(|d| - 1, 0) cells apart; a body that just touches is not in.
  const double radius = avatar.radius / cell - 1e-9;
  body.radius = avatar.radius / cell;
  // A plane of gradient g that carries the body rises g r <= bottom under it; the cells that the
  // body reaches lie up to r + sqrt(2) away, and their tops half their tilt above their centres.
  body.hope = static_cast<int32_t>(std::min(60000.0, body.bottom * (1 + 2.2 / body.radius))) + 3;
  body.barely = avatar.step_height < body_bottom(avatar);
  body.fine = fine && body.radius >= 1.5;  // more than a cell's diagonal
  body.gentle = body.bottom / 16;
  for (int32_t dz = 0;; ++dz) {
    const double apart = std::max(dz - 1, 0);
    if (apart >= radius) break;
    const double half = std::sqrt(radius * radius - apart * apart);
    body.width.push_back(static_cast<int32_t>(std::ceil(half)));
  }
  body.reach = static_cast<int32_t>(body.width.size()) - 1;
  // From the nearest point of the body's cell, a cell at distance d ends d cells away.
  for (int32_t dz = 0;; ++dz) {
    const double far = std::max<double>(dz, 0.5);
    if (far * far + 0.25 > radius * radius) break;
    body.core.push_back(static_cast<int32_t>(std::sqrt(radius * radius - far * far)));
  }
  body.near_stride = (2 * body.reach + 1 + 7) / 8 * 8;
  for (int32_t dz = -body.reach; dz <= body.reach; ++dz) {
    for (int32_t i = 0; i < body.near_stride; ++i) {
      const int32_t dx = i - body.reach;
      body.near_parts.push_back(dx > body.reach ? 0 : near_parts_of(dx, dz, radius));
    }
  }
  return body;
}

void LayerWindow::assemble(const Neighbourhood& tiles, size_t layer, int32_t reach,
                           const BodyLimits& limits) {
  reach_ = reach;
  pad_ = (reach + 31) / 32 * 32;
  stride_ = kTileSide + 2 * pad_;
  const size_t size = static_cast<size_t>(stride_) * static_cast<size_t>(stride_);
  top.resize(size);
  ceiling.resize(size);
  for (int32_t z = -reach; z < kTileSide + reach; ++z) {
    const size_t begin = index(-pad_, z);
    std::fill_n(&top[begin], stride_, kNone16);
    std::fill_n(&ceiling[begin], stride_, uint16_t{0});
  }
  const LayerList& tile = *tiles[4];
  copy_own(*tile[layer]);
  if (tile.seams && tile.size() > 1) fill_holes(tile, layer, limits);
  fill_apron(tiles, *tile[layer], reach);
}

void LayerWindow::copy_own(const Layer& own) {
  for (int32_t z = 0; z < kTileSide; ++z) {
    const size_t from = static_cast<size_t>(z * kTileSide);
    std::copy_n(&own.top[from], kTileSide, &top[index(0, z)]);
    std::copy_n(&own.ceiling[from], kTileSide, &ceiling[index(0, z)]);
  }
}

void LayerWindow::fill_apron(const Neighbourhood& tiles, const Layer& own, int32_t reach) {
  // Only where a body on the layer reaches: many layers are a storey in the middle of the tile.
  const uint64_t beside = (uint64_t{1} << reach) - 1;  // Bodies reach at most 49 cells.
  const auto is_reached = [&](int32_t dx, int32_t dz) {
    const uint64_t columns =
        dx == 0 ? ~uint64_t{0} : (dx < 0 ? beside : beside << (kTileSide - reach));
    const int32_t z0 = dz > 0 ? kTileSide - reach : 0, z1 = dz < 0 ? reach : kTileSide;
    uint64_t any = 0;
    for (int32_t z = z0; z < z1; ++z) any |= own.useful[static_cast<size_t>(z)] & columns;
    return any != 0;
  };
  // Corners last: they read the sides.
  for (const int32_t side : {1, 3, 5, 7, 0, 2, 6, 8}) {
    if (tiles[static_cast<size_t>(side)] == nullptr) continue;
    const LayerList& tile = *tiles[static_cast<size_t>(side)];
    if (tile.empty()) continue;
    const int32_t dx = side % 3 - 1, dz = side / 3 - 1;
    if (!is_reached(dx, dz)) continue;
    const auto range = [&](int32_t d) -> std::pair<int32_t, int32_t> {
      if (d < 0) return {-reach, 0};
      if (d > 0) return {kTileSide, kTileSide + reach};
      return {0, kTileSide};
    };
    const auto [x0, x1] = range(dx);
    const auto [z0, z1] = range(dz);
    if (tile.size() == 1) {
      const Layer& other = *tile[0];
      const int32_t shift = other.base - own.base;
      for (int32_t z = z0; z < z1; ++z) {
        const auto from =
            static_cast<size_t>((z - dz * kTileSide) * kTileSide + x0 - dx * kTileSide);
        rebase_row(&other.top[from], x1 - x0, shift, &top[index(x0, z)], rebased_top);
        rebase_row(&other.ceiling[from], x1 - x0, shift, &ceiling[index(x0, z)], rebased_ceiling);
      }
      continue;
    }
    if (dx != 0 && dz != 0) {
      fill_corner(tile, own, dx, dz, reach);
    } else {
      fill_side(tile, own, dx, dz, reach);
    }
  }
}

// Several layers beside the tile: lines of cells from the tile outward, each cell continuing the
// one before it.
void LayerWindow::fill_side(const LayerList& tile, const Layer& own, int32_t dx, int32_t dz,
                            int32_t reach) {
  const bool is_row = dx == 0;  // lines along x
  const bool outward_up = dx + dz > 0;
  lines_.resize(tile.size());
  columns_.resize(is_row ? 0 : tile.size() * 2 * kTileSide);
  alignas(64) std::array<int32_t, kTileSide> near;
  alignas(64) std::array<uint16_t, kTileSide> line_top, line_ceiling;
  for (size_t i = 0; i < kTileSide; ++i) {
    const size_t border = outward_up ? kTileSide - 1 : 0;
    const uint16_t at = own.top[is_row ? border * kTileSide + i : i * kTileSide + border];
    near[i] = at == kNone16 ? own.low_top : at;
  }
  for (int32_t step = 0; step < reach; ++step) {
    const auto line = static_cast<size_t>(outward_up ? step : kTileSide - 1 - step);
    for (size_t s = 0; s < tile.size(); ++s) {
      const Layer& other = *tile[s];
      lines_[s].shift = other.base - own.base;
      if (is_row) {
        lines_[s].top = &other.top[line * kTileSide];
        lines_[s].ceiling = &other.ceiling[line * kTileSide];
        continue;
      }
      uint16_t* tops = &columns_[s * 2 * kTileSide];
      uint16_t* ceilings = tops + kTileSide;
      for (size_t z = 0; z < kTileSide; ++z) {
        tops[z] = other.top[z * kTileSide + line];
        ceilings[z] = other.ceiling[z * kTileSide + line];
      }
      lines_[s].top = tops;
      lines_[s].ceiling = ceilings;
    }
    choose_free_spans(lines_, near.data(), line_top.data(), line_ceiling.data());
    const int32_t out = outward_up ? kTileSide + step : -1 - step;
    if (is_row) {
      std::copy(line_top.begin(), line_top.end(), &top[index(0, out)]);
      std::copy(line_ceiling.begin(), line_ceiling.end(), &ceiling[index(0, out)]);
      continue;
    }
    for (int32_t z = 0; z < kTileSide; ++z) {
      top[index(out, z)] = line_top[static_cast<size_t>(z)];
      ceiling[index(out, z)] = line_ceiling[static_cast<size_t>(z)];
    }
  }
}

void LayerWindow::fill_corner(const LayerList& tile, const Layer& own, int32_t dx, int32_t dz,
                              int32_t reach) {
  for (int32_t step_z = 0; step_z < reach; ++step_z) {
    const int32_t z = dz < 0 ? -1 - step_z : kTileSide + step_z;
    for (int32_t step_x = 0; step_x < reach; ++step_x) {
      const int32_t x = dx < 0 ? -1 - step_x : kTileSide + step_x;
      const uint16_t inward = top[index(x - dx, z - dz)], beside = top[index(x - dx, z)];
      const int32_t near_top =
          inward != kNone16 ? inward : (beside != kNone16 ? beside : own.low_top);
      const auto from = static_cast<size_t>((z - dz * kTileSide) * kTileSide + x - dx * kTileSide);
      const Layer* other = nearest_layer(tile, from, near_top + own.base);
      if (other == nullptr) continue;
      const int32_t shift = other->base - own.base;
      top[index(x, z)] = rebased_top(other->top[from], shift);
      ceiling[index(x, z)] = rebased_ceiling(other->ceiling[from], shift);
    }
  }
}

namespace {

// Fills the holes of a layer's window: cells where the layer has no free span but another layer of
// the tile continues it (a seam).
class HoleFiller {
 public:
  HoleFiller(LayerWindow& window, const LayerList& tile, size_t layer, const BodyLimits& limits)
      : window_(window),
        tile_(tile),
        own_(*tile[layer]),
        limits_(limits),
        surely_nearest_((limits.low_free_span - 1) / 2),
        last_(layer == 0 ? 1 : 0) {}

  // Holes are filled from their rims inward, a row at a time: down the tile, then up.
  void fill() {
    add_free_span_bits(own_, filled_);
    uint64_t any = 0;
    for (const Layer* other : tile_) {
      if (other == &own_) continue;
      world::CellRows free_spans{};
      add_free_span_bits(*other, free_spans);
      for (size_t z = 0; z < kTileSide; ++z) others_[z] |= free_spans[z];
      any |= add_steps(own_, filled_, *other, free_spans, limits_.link_step, hopeful_);
    }
    if (any == 0) return;
    even_.resize(tile_.size());
    known_.assign(tile_.size(), 0);
    for (int32_t z = 0; z < kTileSide; ++z) fill_row(z);
    for (int32_t z = kTileSide - 1; z >= 0; --z) fill_row(z);
  }

 private:
  // Which layer has the free span nearest to a top, if it lies within a step; else their number.
  // Free spans of a column have tops at least low_free_span apart, so one that is nearer than half
  // of that is the nearest: mostly the layer's that the last hole was filled from.
  [[nodiscard]] size_t next_floor(size_t cell, int32_t near_top) const {
    const auto distance = [&](const Layer& other) {
      return std::abs(other.base + other.top[cell] - near_top);
    };
    if (tile_[last_]->top[cell] != kNone16 && distance(*tile_[last_]) <= surely_nearest_) {
      return last_;
    }
    size_t best = tile_.size();
    int32_t best_distance = limits_.link_step + 1;
    for (size_t i = 0; i < tile_.size(); ++i) {
      const Layer& other = *tile_[i];
      if (near_top < other.base + other.low_top - limits_.link_step ||
          near_top > other.base + other.high_top + limits_.link_step ||
          other.top[cell] == kNone16 || distance(other) >= best_distance) {
        continue;
      }
      best_distance = distance(other);
      best = i;
    }
    return best;
  }

  bool try_fill(int32_t x, int32_t z) {
    const size_t at = window_.index(x, z);
    const size_t cell = static_cast<size_t>(z * kTileSide + x);
    const std::array<size_t, 4> around{window_.index(x - 1, z), window_.index(x + 1, z),
                                       window_.index(x, z - 1), window_.index(x, z + 1)};
    for (const size_t next : around) {
      if (window_.top[next] == kNone16) continue;
      const size_t floor = next_floor(cell, own_.base + window_.top[next]);
      if (floor == tile_.size()) continue;
      const Layer& other = *tile_[floor];
      const int32_t shift = other.base - own_.base;
      const uint16_t other_top = rebased_top(other.top[cell], shift);
      const uint16_t other_ceiling = rebased_ceiling(other.ceiling[cell], shift);
      const int32_t headroom =
          std::min(other_ceiling, window_.ceiling[next]) - std::max(other_top, window_.top[next]);
      if (std::abs(other_top - window_.top[next]) > limits_.link_step ||
          headroom < limits_.low_free_span) {
        continue;
      }
      window_.top[at] = other_top;
      window_.ceiling[at] = other_ceiling;
      last_ = floor;
      return true;
    }
    return false;
  }

  // After a hole was filled, fills those to the right of it as far as the same floor is so even
  // that each would be filled from the one before it. Returns which.
  uint64_t fill_on(int32_t x, int32_t z, uint64_t open) {
    const Layer& other = *tile_[last_];
    const int32_t shift = other.base - own_.base;
    // All heights are on this layer's scale, too.
    if (other.low_top + shift < 0 ||
        other.high_top + shift + limits_.low_free_span > kHighCeiling16) {
      return 0;
    }
    if (known_[last_] == 0) {
      even_runs(other, {surely_nearest_, limits_.low_free_span}, even_[last_]);
    }
    known_[last_] = 1;
    const uint64_t onward = open & even_[last_][static_cast<size_t>(z)] << 1;
    const int32_t count = x < kTileSide - 1 ? std::countr_one(onward >> (x + 1)) : 0;
    if (count == 0) return 0;
    const size_t from = static_cast<size_t>(z * kTileSide + x + 1), to = window_.index(x + 1, z);
    rebase_row(&other.top[from], count, shift, &window_.top[to], rebased_top);
    rebase_row(&other.ceiling[from], count, shift, &window_.ceiling[to], rebased_ceiling);
    return ~uint64_t{0} >> (64 - count) << (x + 1);
  }

  // Each hole is asked once a pass, the first of a row's rim first; but those that are neither
  // hopeful nor beside one that was filled would be asked in vain.
  void fill_row(int32_t z) {
    const auto r = static_cast<size_t>(z);
    const auto beside = [&](const world::CellRows& rows) {
      const uint64_t above = z > 0 ? rows[r - 1] : 0;
      const uint64_t below = z + 1 < kTileSide ? rows[r + 1] : 0;
      return above | below | rows[r] << 1 | rows[r] >> 1;
    };
    uint64_t open = others_[r] & ~filled_[r];
    while (true) {
      const uint64_t asked = open & (hopeful_[r] | beside(fresh_));
      if (asked == 0) return;
      const uint64_t bit = asked & (~asked + 1);
      open &= ~(bit | (beside(filled_) & (bit - 1)));
      const int32_t x = std::countr_zero(bit);
      if (!try_fill(x, z)) continue;
      const uint64_t cells = bit | fill_on(x, z, open);
      open &= ~cells;
      filled_[r] |= cells;
      fresh_[r] |= cells;
    }
  }

  LayerWindow& window_;
  const LayerList& tile_;
  const Layer& own_;
  const BodyLimits& limits_;
  int32_t surely_nearest_;
  size_t last_;                        // layer that the last hole was filled from
  std::vector<world::CellRows> even_;  // by layer, once known
  std::vector<uint8_t> known_;
  world::CellRows filled_{}, others_{}, hopeful_{};
  world::CellRows fresh_{};  // filled here
};

}  // namespace

void LayerWindow::fill_holes(const LayerList& tile, size_t layer, const BodyLimits& limits) {
  if (tile[layer]->cells == kTileArea) return;
  HoleFiller(*this, tile, layer, limits).fill();
}

bool all_legal(const Neighbourhood& tiles, size_t layer, const BodyWindow& body,
               const BodyLimits& limits) {
  const Layer& own = *(*tiles[4])[layer];
  if (own.present != kTileArea || !own.one_code ||
      (limits.allowed[own.some_code] & body.class_bit) == 0) {
    return false;
  }
  // The feet's tilt is at most half the range of feet over neighbouring cells, so at most the
  // range.
  const int32_t low_feet = own.base + 2 * own.low_feet - own.high_feet;
  const int32_t high_feet = own.base + 2 * own.high_feet - own.low_feet;
  if (own.high_feet - own.low_feet > body.step) return false;
  for (const LayerList* tile : tiles) {
    if (tile == nullptr || tile->size() != 1) return false;
    const Layer& other = *(*tile)[0];
    if (other.cells != kTileArea) return false;
    const int32_t ceiling =
        other.low_ceiling == kNone16 ? INT32_MAX : other.base + other.low_ceiling;
    if (other.base + other.high_top > low_feet + body.bottom ||
        other.base + other.low_top < high_feet - body.bottom || ceiling < high_feet + body.height) {
      return false;
    }
  }
  return true;
}

}  // namespace throng::bake
