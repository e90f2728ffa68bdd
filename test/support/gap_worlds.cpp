// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "gap_worlds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/random.h"

// Solids as columns of spans, and the rule of free spans written with plain loops.
namespace throng::naive {
namespace {

using Height = std::function<double(double, double)>;  // height over cells [mm]

class Dice {
 public:
  explicit Dice(uint64_t seed) : seed_(seed) {}
  double unit() { return random_unit(seed_, 77, n_++); }
  double from(double low, double high) { return low + unit() * (high - low); }
  int32_t below(int32_t n) { return static_cast<int32_t>(unit() * n); }

 private:
  uint64_t seed_, n_ = 0;
};

Height make_ground(int32_t kind, Dice& dice) {
  const double wave_x = dice.from(5, 60), wave_z = dice.from(5, 60), tall = dice.from(20, 900);
  const double gx = dice.from(-150, 150), gz = dice.from(-150, 150);
  const Height rolling = [=](double x, double z) {
    return tall * (std::sin(x / wave_x) + std::cos(z / wave_z));
  };
  if (kind == 0) return rolling;
  if (kind == 1) {
    const double rise = dice.from(15, 700);
    return [=](double x, double z) {
      // Constant over each cell, so that a terrace ends where a cell does.
      return std::floor(rolling(std::floor(x), std::floor(z)) / rise) * rise;
    };
  }
  if (kind == 2) {
    const double fold_x = dice.from(-60, 120), fold_z = dice.from(-60, 120);
    const double gentle = dice.unit() < 0.5 ? 0.3 : 1;
    return [=](double x, double z) {
      return gentle * (gx * std::fabs(x - fold_x) + gz * std::fabs(z - fold_z));
    };
  }
  if (kind == 3) {
    const uint64_t seed = static_cast<uint64_t>(dice.below(1 << 30));
    const double rough = dice.from(1, 300);
    return [=](double x, double z) {
      const auto cx = static_cast<uint64_t>(std::floor(x) + 1000);
      const auto cz = static_cast<uint64_t>(std::floor(z) + 1000);
      return rough * random_unit(seed, cx, cz);
    };
  }
  return [](double, double) { return 0.0; };
}

// Adds a slab whose upper side is `height`; in a cell it is as high as its highest corner there.
void add_slab(SolidBlock& block, std::array<int32_t, 4> rect, const Height& height, double thick,
              int32_t code) {
  const double in = 1e-9;  // corners seen from inside the cell
  for (int32_t z = std::max(rect[1], block.kFirst); z < std::min(rect[3], block.kEnd); ++z) {
    for (int32_t x = std::max(rect[0], block.kFirst); x < std::min(rect[2], block.kEnd); ++x) {
      const std::array<double, 4> corners{height(x + in, z + in), height(x + 1 - in, z + in),
                                          height(x + in, z + 1 - in),
                                          height(x + 1 - in, z + 1 - in)};
      const double low = *std::min_element(corners.begin(), corners.end());
      const double high = *std::max_element(corners.begin(), corners.end());
      const double middle = std::clamp(height(x + 0.5, z + 0.5), low, high);
      block.at(x, z).push_back({static_cast<int32_t>(std::floor(low - thick + 1e-3)),
                                static_cast<int32_t>(std::ceil(high - 1e-3)),
                                static_cast<int32_t>(std::lround(middle)), code});
    }
  }
}

std::array<int32_t, 4> random_rect(Dice& dice, int32_t least, int32_t most) {
  const int32_t x = dice.below(150) - 50, z = dice.below(150) - 50;
  return {x, z, x + least + dice.below(most - least), z + least + dice.below(most - least)};
}

}  // namespace

FreeSpanBlock free_spans_of(const SolidBlock& solids, int32_t min_free_span) {
  FreeSpanBlock free_spans;
  for (size_t c = 0; c < solids.cells.size(); ++c) {
    std::vector<Solid> column = solids.cells[c];
    std::sort(column.begin(), column.end(),
              [](const Solid& a, const Solid& b) { return a.low < b.low; });
    std::vector<FreeSpan>& out = free_spans.cells[c];
    for (size_t i = 0; i < column.size();) {
      FreeSpan free_span{column[i].high, bake::kOpenSkyMm, column[i].support, column[i].code};
      for (++i; i < column.size(); ++i) {
        if (column[i].low - free_span.top >= min_free_span) {
          free_span.ceiling = column[i].low;
          break;
        }
        free_span.top = std::max(free_span.top, column[i].high);
        const bool higher = column[i].support > free_span.support;
        const bool same = column[i].support == free_span.support && column[i].code > free_span.code;
        if (higher || same) {
          free_span.support = column[i].support;
          free_span.code = column[i].code;
        }
      }
      out.push_back(free_span);
    }
  }
  return free_spans;
}

namespace {

bool is_above(const FreeSpan& a, const FreeSpan& b) {
  return a.support != b.support ? a.support > b.support : a.code > b.code;
}

void lend(const FreeSpan& from, FreeSpan& to) {
  if (!is_above(from, to)) return;
  to.support = from.support;
  to.code = from.code;
}

}  // namespace

FreeSpanBlock with_lent_supports(const FreeSpanBlock& free_spans) {
  FreeSpanBlock out = free_spans;
  for (auto& column : out.cells) {
    for (size_t i = 1; i < column.size(); ++i) lend(column[i - 1], column[i]);
  }
  return out;
}

FreeSpanBlock high_free_spans(const FreeSpanBlock& free_spans) {
  FreeSpanBlock out;
  for (size_t c = 0; c < free_spans.cells.size(); ++c) {
    const FreeSpan* below = nullptr;
    std::vector<FreeSpan> joined = free_spans.cells[c];
    for (FreeSpan& free_span : joined) {
      if (below != nullptr) lend(*below, free_span);
      const bool is_low =
          free_span.ceiling != bake::kOpenSkyMm &&
          int64_t{free_span.ceiling} - free_span.top < bake::BodyLimits::kHighFreeSpan;
      below = is_low ? &free_span : nullptr;
      if (!is_low) out.cells[c].push_back(free_span);
    }
  }
  return out;
}

void assign_tile(const FreeSpanBlock& free_spans, int32_t tile_x, int32_t tile_z,
                 const bake::BodyLimits& limits, bake::LayerPool& pool, bake::TileLayers& layers) {
  const auto all = std::make_unique<bake::TileFreeSpans>(),
             high = std::make_unique<bake::TileFreeSpans>();
  fill_tile(high_free_spans(free_spans), tile_x, tile_z, *high);
  fill_tile(with_lent_supports(free_spans), tile_x, tile_z, *all);
  const bool low_too = limits.min_free_span < bake::BodyLimits::kHighFreeSpan;
  bake::assign_free_spans({.high = *high, .all = low_too ? all.get() : nullptr}, limits, pool,
                          layers);
  for (const auto& layer : layers) bake::find_useful(limits, *layer);
}

void fill_tile(const FreeSpanBlock& block, int32_t tile_x, int32_t tile_z,
               bake::TileFreeSpans& out) {
  const auto column = [&](int32_t cell) -> const std::vector<FreeSpan>& {
    return block.at(tile_x * bake::kTileSide + cell % bake::kTileSide,
                    tile_z * bake::kTileSide + cell / bake::kTileSide);
  };
  out.base = INT32_MAX;
  out.max_count = 0;
  for (int32_t c = 0; c < bake::kTileArea; ++c) {
    for (const FreeSpan& free_span : column(c)) out.base = std::min(out.base, free_span.top - 1000);
    out.count[static_cast<size_t>(c)] = static_cast<int32_t>(column(c).size());
    out.max_count = std::max(out.max_count, out.count[static_cast<size_t>(c)]);
  }
  if (out.max_count == 0) out.base = 0;
  while (out.layers.size() < static_cast<size_t>(out.max_count)) {
    out.layers.push_back(std::make_unique<bake::FreeSpanLayer>());
  }
  for (int32_t c = 0; c < bake::kTileArea; ++c) {
    const auto cell = static_cast<size_t>(c);
    for (size_t k = 0; k < column(c).size(); ++k) {
      const FreeSpan& free_span = column(c)[k];
      bake::FreeSpanLayer& layer = *out.layers[k];
      layer.top[cell] = free_span.top - out.base;
      layer.ceiling[cell] =
          free_span.ceiling == bake::kOpenSkyMm ? bake::kOpenSkyMm : free_span.ceiling - out.base;
      layer.support[cell] = free_span.support == bake::kNoSupport
                                ? bake::kNoSupport
                                : (free_span.support - out.base) * 256 + free_span.code;
    }
  }
}

SolidBlock random_solids(const RandomBlock& config) {
  Dice dice(config.seed);
  SolidBlock block;
  const Height ground = make_ground(config.ground, dice);
  constexpr std::array<int32_t, 4> kAll{-64, -64, 128, 128};
  add_slab(block, kAll, ground, 3000, 0);
  if (config.codes > 1) {
    for (int32_t i = 0; i < 6; ++i) {
      add_slab(block, random_rect(dice, 2, 60), ground, 10, dice.below(config.codes));
    }
  }
  if (config.decks) {
    for (int32_t i = 0; i < 4; ++i) {
      // A deck, and a ramp down to the ground beside or under it.
      const std::array<int32_t, 4> deck = random_rect(dice, 12, 90);
      const double foot = ground(deck[0], deck[1]), level = foot + dice.from(1500, 3600);
      const double thick = dice.from(50, 300);
      add_slab(
          block, deck, [=](double, double) { return level; }, thick, 0);
      const bool under = dice.unit() < 0.3;  // as in a spiral: the deck lies over its own ramp
      const int32_t length = 8 + dice.below(60), wide = 6 + dice.below(20);
      const int32_t start = under ? deck[0] + length : deck[0];
      const auto slope = [=](double x, double) {
        return foot + (level - foot) * std::clamp(1 - (start - x) / length, 0.0, 1.0);
      };
      add_slab(block, {start - length, deck[1], start, deck[1] + wide}, slope, thick, 0);
      if (dice.unit() < 0.5) {  // a low ceiling over a part of it
        const double room = dice.from(1000, 2600);
        const int32_t from = start - dice.below(length);
        const auto roof = [=](double x, double z) { return slope(x, z) + room + 100; };
        add_slab(block, {from, deck[1], from + 10, deck[1] + wide}, roof, 100, 0);
      }
    }
  }
  if (config.ceilings) {
    for (int32_t i = 0; i < 5; ++i) {
      const std::array<int32_t, 4> rect = random_rect(dice, 1, 50);
      const double room = dice.from(900, 3600);
      const Height over = [=](double x, double z) { return ground(x, z) + room + 200; };
      add_slab(block, rect, over, 200, 0);
    }
  }
  for (int32_t i = 0; i < 25; ++i) {  // crates, kerbs, walls, rails
    const double tall = dice.from(10, dice.unit() < 0.5 ? 500 : 2500);
    const double base = ground(dice.below(64), dice.below(64));
    add_slab(
        block, random_rect(dice, 1, dice.unit() < 0.7 ? 4 : 20),
        [=](double, double) { return base + tall; }, tall + 500, dice.below(config.codes));
  }
  if (config.holes) {
    for (int32_t i = 0; i < 12; ++i) {
      const std::array<int32_t, 4> rect = random_rect(dice, 1, 8);
      for (int32_t z = rect[1]; z < std::min(rect[3], block.kEnd); ++z) {
        for (int32_t x = rect[0]; x < std::min(rect[2], block.kEnd); ++x) block.at(x, z).clear();
      }
    }
    for (auto& column : block.cells) {  // cracks: solids without a surface under the centre
      if (!column.empty() && dice.unit() < 0.001) column.front().support = bake::kNoSupport;
    }
  }
  return block;
}

}  // namespace throng::naive
