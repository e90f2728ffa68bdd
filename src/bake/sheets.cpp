// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/sheets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

// Gaps of neighbouring columns belong together when a step leads from one to the other. Connected
// components are found with union-find in one raster pass (Rosenfeld, Pfaltz. Sequential operations
// in digital picture processing. 1966); a component that lies over itself, like a spiral ramp, is
// split along its breadth-first order; then components are packed first-fit into sheets.
namespace throng {
namespace {

constexpr int32_t kSide = kTileSide;

struct GapRef {
  int32_t cell;
  int32_t layer;
};

struct Component {
  int32_t cells = 0;
  int32_t first_cell = 0;
  int32_t low = INT32_MAX, high = INT32_MIN;  // tops
  int32_t last_cell = -1;
  bool overlaps_itself = false;
};

struct Linker {
  const TileGaps& gaps;
  int32_t max_step;
  int32_t min_gap;

  [[nodiscard]] bool linked(size_t cell_a, const GapLayer& a, size_t cell_b, const GapLayer& b) const {
    const int32_t top_a = a.top[cell_a], top_b = b.top[cell_b];
    const int32_t step = top_a > top_b ? top_a - top_b : top_b - top_a;
    if (step > max_step) return false;
    return std::min(a.ceiling[cell_a], b.ceiling[cell_b]) - std::max(top_a, top_b) >= min_gap;
  }
};

int32_t find_root(std::vector<int32_t>& parent, int32_t label) {
  while (parent[static_cast<size_t>(label)] != label) {
    auto& up = parent[static_cast<size_t>(label)];
    up = parent[static_cast<size_t>(up)];
    label = up;
  }
  return label;
}

int32_t unite(std::vector<int32_t>& parent, int32_t a, int32_t b) {
  a = find_root(parent, a);
  b = find_root(parent, b);
  if (a == b) return a;
  parent[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
  return std::min(a, b);
}

// Provisional labels for every gap, then roots.
void label_gaps(const TileGaps& gaps, const Linker& linker, SheetScratch& scratch) {
  const size_t layers = static_cast<size_t>(gaps.max_count);
  scratch.label.resize(layers * kTileArea);
  scratch.parent.clear();
  const auto label_of = [&](int32_t layer, size_t cell) -> int32_t& {
    return scratch.label[static_cast<size_t>(layer) * kTileArea + cell];
  };
  // The label of the gap of `other` that continues gap `k` of `cell`, or -1. Gaps ascend, so the
  // search begins where the last one ended.
  const auto continued = [&](size_t cell, int32_t k, size_t other, int32_t& from) -> int32_t {
    const GapLayer& layer = *gaps.layers[static_cast<size_t>(k)];
    const int32_t lowest = layer.top[cell] - linker.max_step;
    const int32_t count = gaps.count[other];
    while (from < count && gaps.layers[static_cast<size_t>(from)]->top[other] < lowest) ++from;
    for (int32_t m = from; m < count; ++m) {
      const GapLayer& candidate = *gaps.layers[static_cast<size_t>(m)];
      if (candidate.top[other] > layer.top[cell] + linker.max_step) break;
      if (linker.linked(cell, layer, other, candidate)) return label_of(m, other);
    }
    return -1;
  };
  for (int32_t z = 0; z < kSide; ++z) {
    for (int32_t x = 0; x < kSide; ++x) {
      const size_t cell = static_cast<size_t>(z * kSide + x);
      int32_t from_left = 0, from_up = 0;
      for (int32_t k = 0; k < gaps.count[cell]; ++k) {
        const int32_t left = x > 0 ? continued(cell, k, cell - 1, from_left) : -1;
        const int32_t up = z > 0 ? continued(cell, k, cell - kSide, from_up) : -1;
        int32_t label = left >= 0 ? left : up;
        if (label < 0) {
          label = static_cast<int32_t>(scratch.parent.size());
          scratch.parent.push_back(label);
        } else if (left >= 0 && up >= 0 && left != up) {
          label = unite(scratch.parent, left, up);
        }
        label_of(k, cell) = label;
      }
    }
  }
}

// Replaces labels by component numbers in order of first appearance.
std::vector<Component> number_components(const TileGaps& gaps, SheetScratch& scratch) {
  std::vector<int32_t> number(scratch.parent.size(), -1);
  std::vector<Component> components;
  for (int32_t cell = 0; cell < kTileArea; ++cell) {
    for (int32_t k = 0; k < gaps.count[static_cast<size_t>(cell)]; ++k) {
      int32_t& label =
          scratch.label[static_cast<size_t>(k) * kTileArea + static_cast<size_t>(cell)];
      int32_t& index = number[static_cast<size_t>(find_root(scratch.parent, label))];
      if (index < 0) {
        index = static_cast<int32_t>(components.size());
        components.push_back({.first_cell = cell});
      }
      label = index;
      Component& component = components[static_cast<size_t>(index)];
      const int32_t top = gaps.layers[static_cast<size_t>(k)]->top[static_cast<size_t>(cell)];
      ++component.cells;
      component.low = std::min(component.low, top);
      component.high = std::max(component.high, top);
      component.overlaps_itself |= component.last_cell == cell;
      component.last_cell = cell;
    }
  }
  return components;
}

// Cuts a component that lies over itself, or is too tall for 16 bits, into pieces that do not.
void split_component(const TileGaps& gaps, const Linker& linker, int32_t index,
                     SheetScratch& scratch, std::vector<Component>& components) {
  const auto label_of = [&](const GapRef& gap) -> int32_t& {
    return scratch.label[static_cast<size_t>(gap.layer) * kTileArea +
                         static_cast<size_t>(gap.cell)];
  };
  std::vector<GapRef> pending;
  for (int32_t cell = 0; cell < kTileArea; ++cell) {
    for (int32_t k = 0; k < gaps.count[static_cast<size_t>(cell)]; ++k) {
      if (label_of({cell, k}) == index) pending.push_back({cell, k});
    }
  }
  constexpr int32_t kPending = -2;
  for (const GapRef& gap : pending) label_of(gap) = kPending;
  std::vector<int32_t> taken(kTileArea, -1);  // which piece has a gap in this column
  std::vector<GapRef> queue;
  bool reuse = true;  // the first piece keeps the component's number
  for (const GapRef& seed : pending) {
    if (label_of(seed) != kPending) continue;
    const int32_t piece = reuse ? index : static_cast<int32_t>(components.size());
    if (!reuse) components.emplace_back();
    reuse = false;
    Component& component = components[static_cast<size_t>(piece)];
    component = {.first_cell = seed.cell};
    const auto take = [&](const GapRef& gap) {
      const int32_t top = gaps.layers[static_cast<size_t>(gap.layer)]->top[static_cast<size_t>(gap.cell)];
      const int32_t low = std::min(component.low, top), high = std::max(component.high, top);
      if (high - low > Sheet::kHighest - Sheet::kBelow) return;
      label_of(gap) = piece;
      taken[static_cast<size_t>(gap.cell)] = piece;
      component.low = low;
      component.high = high;
      ++component.cells;
      queue.push_back(gap);
    };
    queue.clear();
    take(seed);
    for (size_t head = 0; head < queue.size(); ++head) {
      const GapRef gap = queue[head];
      const int32_t x = gap.cell % kSide, z = gap.cell / kSide;
      const GapLayer& layer = *gaps.layers[static_cast<size_t>(gap.layer)];
      const std::array<std::array<int32_t, 2>, 4> around{{{x - 1, z}, {x + 1, z}, {x, z - 1}, {x, z + 1}}};
      for (const auto& [nx, nz] : around) {
        if (nx < 0 || nz < 0 || nx >= kSide || nz >= kSide) continue;
        const int32_t other = nz * kSide + nx;
        if (taken[static_cast<size_t>(other)] == piece) continue;
        for (int32_t m = 0; m < gaps.count[static_cast<size_t>(other)]; ++m) {
          if (label_of({other, m}) != kPending) continue;
          if (linker.linked(static_cast<size_t>(gap.cell), layer, static_cast<size_t>(other),
                            *gaps.layers[static_cast<size_t>(m)])) {
            take({other, m});
            break;
          }
        }
      }
    }
  }
}

using Rows = std::array<uint64_t, kTileSide>;

// Deals components to sheets, larger first, each to the first sheet whose columns are free.
int32_t pack_components(const TileGaps& gaps, const SheetScratch& scratch,
                        const std::vector<Component>& components, std::vector<int32_t>& sheet_of) {
  std::vector<Rows> cells(components.size(), Rows{});
  for (int32_t cell = 0; cell < kTileArea; ++cell) {
    for (int32_t k = 0; k < gaps.count[static_cast<size_t>(cell)]; ++k) {
      const int32_t index =
          scratch.label[static_cast<size_t>(k) * kTileArea + static_cast<size_t>(cell)];
      cells[static_cast<size_t>(index)][static_cast<size_t>(cell / kSide)] |= 1ULL << (cell % kSide);
    }
  }
  std::vector<int32_t> order(components.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int32_t a, int32_t b) {
    const Component& p = components[static_cast<size_t>(a)];
    const Component& q = components[static_cast<size_t>(b)];
    return p.cells != q.cells ? p.cells > q.cells : a < b;
  });
  struct Bin {
    Rows used{};
    int32_t low = INT32_MAX, high = INT32_MIN;
  };
  std::vector<Bin> bins;
  sheet_of.assign(components.size(), 0);
  for (const int32_t index : order) {
    const Component& component = components[static_cast<size_t>(index)];
    const Rows& rows = cells[static_cast<size_t>(index)];
    size_t b = 0;
    for (; b < bins.size(); ++b) {
      const int32_t low = std::min(bins[b].low, component.low);
      const int32_t high = std::max(bins[b].high, component.high);
      if (high - low > Sheet::kHighest - Sheet::kBelow) continue;
      bool clash = false;
      for (size_t z = 0; z < rows.size() && !clash; ++z) clash = (bins[b].used[z] & rows[z]) != 0;
      if (!clash) break;
    }
    if (b == bins.size()) bins.emplace_back();
    Bin& bin = bins[b];
    bin.low = std::min(bin.low, component.low);
    bin.high = std::max(bin.high, component.high);
    for (size_t z = 0; z < rows.size(); ++z) bin.used[z] |= rows[z];
    sheet_of[static_cast<size_t>(index)] = static_cast<int32_t>(b);
  }
  return static_cast<int32_t>(bins.size());
}

// Writes one gap into a sheet whose base is set.
void write_gap(const GapLayer& layer, size_t cell, const BodyLimits& limits, Sheet& sheet) {
  const int32_t top = layer.top[cell] - sheet.base;
  const int32_t ceiling = layer.ceiling[cell];
  const int64_t ceiling_from_base = static_cast<int64_t>(ceiling) - sheet.base;
  sheet.top[cell] = static_cast<uint16_t>(top);
  sheet.ceiling[cell] = static_cast<uint16_t>(
      ceiling == kOpenSkyMm ? kNone16 : std::min<int64_t>(ceiling_from_base, kNone16));
  sheet.feet[cell] = kNone16;
  sheet.code[cell] = 0;
  if (layer.support[cell] == kNoSupport) return;
  const int32_t feet = (layer.support[cell] >> 8) - sheet.base;
  const uint8_t code = static_cast<uint8_t>(layer.support[cell] & 255);
  if (limits.allowed[code] == 0 || top - feet > limits.max_bottom || feet < 0 ||
      sheet.ceiling[cell] < feet + limits.min_height) {
    return;
  }
  sheet.feet[cell] = static_cast<uint16_t>(feet);
  sheet.code[cell] = code;
}

void summarise(Sheet& sheet) {
  sheet.low_top = sheet.low_feet = sheet.low_ceiling = kNone16;
  sheet.high_top = sheet.high_feet = 0;
  sheet.cells = sheet.present = 0;
  uint8_t low_code = 255, high_code = 0;
  for (size_t c = 0; c < kTileArea; ++c) {
    const uint16_t top = sheet.top[c];
    const bool gap = top != kNone16;
    sheet.cells += gap;
    sheet.low_top = std::min(sheet.low_top, top);
    sheet.high_top = std::max<uint16_t>(sheet.high_top, gap ? top : 0);
    sheet.low_ceiling = std::min<uint16_t>(sheet.low_ceiling, gap ? sheet.ceiling[c] : kNone16);
    const uint16_t feet = sheet.feet[c];
    const bool has_feet = feet != kNone16;
    sheet.present += has_feet;
    sheet.low_feet = std::min(sheet.low_feet, feet);
    sheet.high_feet = std::max<uint16_t>(sheet.high_feet, has_feet ? feet : 0);
    low_code = std::min<uint8_t>(low_code, has_feet ? sheet.code[c] : 255);
    high_code = std::max<uint8_t>(high_code, has_feet ? sheet.code[c] : 0);
  }
  sheet.one_code = low_code == high_code;
  sheet.some_code = high_code;
}

void clear(Sheet& sheet) {
  sheet.seams = false;
  sheet.top.fill(kNone16);
  sheet.ceiling.fill(0);
  sheet.feet.fill(kNone16);
  sheet.code.fill(0);
}

// Heights so far become heights from the tile's own zero; bases are made absolute at the end.
void keep_if_used(std::unique_ptr<Sheet> sheet, int32_t base, SheetPool& pool, TileSheets& sheets) {
  summarise(*sheet);
  sheet->base += base;
  if (sheet->present == 0) {
    pool.give(std::move(sheet));
  } else {
    sheets.push_back(std::move(sheet));
  }
}

// A tile of single gaps that fit 16 bits needs no labels: any deal is as safe as any other.
bool deal_single_layer(const TileGaps& gaps, const BodyLimits& limits, SheetPool& pool,
                       TileSheets& sheets) {
  const GapLayer& layer = *gaps.layers[0];
  int32_t low = INT32_MAX, high = INT32_MIN;
  for (size_t c = 0; c < kTileArea; ++c) {
    if (gaps.count[c] == 0) continue;
    low = std::min(low, layer.top[c]);
    high = std::max(high, layer.top[c]);
  }
  if (high - low > Sheet::kHighest - Sheet::kBelow) return false;
  auto sheet = pool.take();
  sheet->base = low - Sheet::kBelow;
  clear(*sheet);
  for (size_t c = 0; c < kTileArea; ++c) {
    if (gaps.count[c] > 0) write_gap(layer, c, limits, *sheet);
  }
  keep_if_used(std::move(sheet), gaps.base, pool, sheets);
  return true;
}

}  // namespace

int32_t bottom_mm(const AvatarClass& avatar) {
  return static_cast<int32_t>(std::floor(body_bottom(avatar) * 1000 + 1e-6));
}

int32_t height_mm(const AvatarClass& avatar) {
  return static_cast<int32_t>(std::ceil(avatar.height * 1000 - 1e-6));
}

BodyLimits body_limits(std::span<const AvatarClass> classes, const SurfaceCodes& codes) {
  BodyLimits limits;
  limits.min_gap = limits.min_height = INT32_MAX;
  for (const AvatarClass& avatar : classes) {
    const int32_t bottom = bottom_mm(avatar), height = height_mm(avatar);
    limits.min_gap = std::min(limits.min_gap, height - bottom);
    limits.min_height = std::min(limits.min_height, height);
    limits.max_bottom = std::max(limits.max_bottom, bottom);
  }
  limits.allowed.assign(256, 0);
  std::copy(codes.allowed.begin(), codes.allowed.end(), limits.allowed.begin());
  return limits;
}

std::unique_ptr<Sheet> SheetPool::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      auto sheet = std::move(free_.back());
      free_.pop_back();
      return sheet;
    }
  }
  return std::make_unique_for_overwrite<Sheet>();
}

void SheetPool::give(std::unique_ptr<Sheet> sheet) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(sheet));
}

void deal_gaps(const TileGaps& gaps, const BodyLimits& limits, SheetPool& pool,
               SheetScratch& scratch, TileSheets& sheets) {
  sheets.clear();
  if (gaps.max_count == 0) return;
  if (gaps.max_count == 1 && deal_single_layer(gaps, limits, pool, sheets)) return;

  const Linker linker{gaps, limits.max_bottom, limits.min_gap};
  label_gaps(gaps, linker, scratch);
  std::vector<Component> components = number_components(gaps, scratch);
  const size_t found = components.size();
  bool seams = false;
  for (size_t i = 0; i < found; ++i) {
    const bool too_tall = components[i].high - components[i].low > Sheet::kHighest - Sheet::kBelow;
    if (components[i].overlaps_itself || too_tall) {
      split_component(gaps, linker, static_cast<int32_t>(i), scratch, components);
      seams = true;
    }
  }
  std::vector<int32_t> sheet_of;
  const int32_t count = pack_components(gaps, scratch, components, sheet_of);
  std::vector<std::unique_ptr<Sheet>> dealt(static_cast<size_t>(count));
  std::vector<int32_t> low(static_cast<size_t>(count), INT32_MAX);
  for (size_t i = 0; i < components.size(); ++i) {
    int32_t& lowest = low[static_cast<size_t>(sheet_of[i])];
    lowest = std::min(lowest, components[i].low);
  }
  for (size_t s = 0; s < dealt.size(); ++s) {
    dealt[s] = pool.take();
    dealt[s]->base = low[s] - Sheet::kBelow;
    clear(*dealt[s]);
  }
  for (size_t cell = 0; cell < kTileArea; ++cell) {
    for (int32_t k = 0; k < gaps.count[cell]; ++k) {
      const int32_t index = scratch.label[static_cast<size_t>(k) * kTileArea + cell];
      write_gap(*gaps.layers[static_cast<size_t>(k)], cell, limits,
                *dealt[static_cast<size_t>(sheet_of[static_cast<size_t>(index)])]);
    }
  }
  for (auto& sheet : dealt) {
    sheet->seams = seams;
    keep_if_used(std::move(sheet), gaps.base, pool, sheets);
  }
  std::stable_sort(sheets.begin(), sheets.end(), [](const auto& a, const auto& b) {
    return a->base + a->low_feet < b->base + b->low_feet;
  });
}

}  // namespace throng
