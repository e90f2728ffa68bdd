// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/layers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "bake/layers/layer_kernels.h"

// Free spans of neighbouring columns belong together when a step leads from one to the other. Runs
// of linked free spans in a row are the units; they are joined with union-find in one raster pass
// [RP66]. Most free spans continue that of the same rank beside them, which vectors find; only
// where ranks shift, at walls and edges, are columns compared one by one. A component that lies
// over itself, like a spiral ramp, is split along its breadth-first order; then components are
// packed first-fit into layers.
namespace throng::bake {
namespace {

constexpr int32_t kSide = kTileSide;
constexpr int32_t kMaxRange = Layer::kMaxTop - Layer::kBaseDepth;  // of tops in a layer [mm]

using Rows = world::CellRows;

uint64_t run_mask(int32_t first, int32_t last) {
  return (~uint64_t{0} >> (63 - (last - first))) << first;
}

// A run of linked free spans of one free-span layer in one row.
struct Run {
  int32_t free_layer, z;
  uint64_t cells;
  int32_t parent;  // union-find
  int32_t component;
};

struct Component {
  Rows cells{};
  int32_t count = 0;
  TopRange tops;
  bool overlaps_itself = false;
  bool is_piece = false;  // of one that was split
};

// What goes into a layer: free spans of a free-span layer in a row.
struct Piece {
  int32_t free_layer, z;
  uint64_t cells;
  int32_t component;
};

class LayerBuilder {
 public:
  // `only`, if it is not empty: of each free-span layer, those to assign. They may continue others.
  LayerBuilder(const TileFreeSpans& free_spans, const BodyLimits& limits,
               std::span<const Rows> only = {})
      : free_spans_(free_spans), limits_(limits), only_(only) {
    rule_ = {limits.link_step, only.empty() ? BodyLimits::kHighFreeSpan : limits.low_free_span};
  }

  void build(LayerPool& pool, TileLayers& layers);

  // What is in no layer, because it is too small for any class.
  [[nodiscard]] const std::vector<Piece>& crumbs() const { return crumbs_; }

 private:
  [[nodiscard]] const FreeSpanLayer& free_layer(int32_t k) const {
    return *free_spans_.layers[static_cast<size_t>(k)];
  }
  [[nodiscard]] bool linked(size_t cell_a, int32_t a, size_t cell_b, int32_t b) const {
    const FreeSpanLayer &p = free_layer(a), &q = free_layer(b);
    return linked(p.top[cell_a], p.ceiling[cell_a], q.top[cell_b], q.ceiling[cell_b]);
  }
  [[nodiscard]] bool linked(int32_t top_a, int32_t ceiling_a, int32_t top_b,
                            int32_t ceiling_b) const {
    const int32_t high = std::max(top_a, top_b), low = std::min(top_a, top_b);
    return high - low <= rule_.step && std::min(ceiling_a, ceiling_b) - high >= rule_.free_span;
  }
  // Is the free span one of those to assign?
  [[nodiscard]] bool is_ours(size_t cell, int32_t k) const {
    return only_.empty() ||
           (only_[static_cast<size_t>(k)][cell / kTileSide] >> cell % kTileSide & 1) != 0;
  }
  int32_t root(int32_t run);
  void unite(int32_t a, int32_t b);
  void find_runs();
  void join_ranks(size_t cell, size_t other, const int32_t* runs, const int32_t* other_runs);
  void make_components();
  void split(int32_t component);
  [[nodiscard]] bool is_crumb(size_t component) const;
  [[nodiscard]] bool goes_on(size_t component) const;
  int32_t pack(std::vector<int32_t>& layer_of) const;

  const TileFreeSpans& free_spans_;
  const BodyLimits& limits_;
  std::span<const Rows> only_;
  LinkRule rule_;
  std::vector<Run> runs_;
  std::vector<Component> components_;
  std::vector<Piece> pieces_, crumbs_;
};

int32_t LayerBuilder::root(int32_t run) {
  while (runs_[static_cast<size_t>(run)].parent != run) {
    int32_t& up = runs_[static_cast<size_t>(run)].parent;
    up = runs_[static_cast<size_t>(up)].parent;
    run = up;
  }
  return run;
}

void LayerBuilder::unite(int32_t a, int32_t b) {
  a = root(a);
  b = root(b);
  runs_[static_cast<size_t>(std::max(a, b))].parent = std::min(a, b);
}

// Joins free spans of different ranks in two neighbouring columns. `runs` holds the run of each
// free-span layer.
void LayerBuilder::join_ranks(size_t cell, size_t other, const int32_t* runs,
                              const int32_t* other_runs) {
  int32_t from = 0;
  for (int32_t k = 0; k < free_spans_.count[cell]; ++k) {
    const int32_t top = free_layer(k).top[cell];
    const int32_t count = free_spans_.count[other];
    while (from < count && free_layer(from).top[other] < top - rule_.step) ++from;
    if (!is_ours(cell, k)) continue;
    for (int32_t m = from; m < count && free_layer(m).top[other] <= top + rule_.step; ++m) {
      if (!is_ours(other, m) || !linked(cell, k, other, m)) continue;
      unite(runs[k * kSide], other_runs[m * kSide]);
    }
  }
}

void LayerBuilder::find_runs() {
  const int32_t free_layers = free_spans_.max_count;
  std::vector<FreeSpanLinks> links(static_cast<size_t>(free_layers));
  for (int32_t k = 0; k < free_layers; ++k) {
    const auto l = static_cast<size_t>(k);
    link_free_spans(free_spans_, k, rule_, only_.empty() ? nullptr : &only_[l], links[l]);
  }
  // Run of each free-span layer and column, in this row and the one above.
  std::vector<int32_t> now(static_cast<size_t>(free_layers * kSide)), above(now.size());
  for (int32_t z = 0; z < kSide; ++z) {
    const size_t row = static_cast<size_t>(z);
    std::swap(now, above);
    uint64_t odd_left = 0, odd_up = 0;  // columns whose ranks may have shifted
    for (int32_t k = 0; k < free_layers; ++k) {
      const FreeSpanLinks& l = links[static_cast<size_t>(k)];
      const uint64_t has = l.has[row];
      if (z > 0) odd_up |= (has | l.has[row - 1]) & ~l.up[row];
      if (has == 0) continue;
      odd_left |= (has | has << 1) & ~l.left[row];
      // A run begins where a free span does not continue its left neighbour.
      uint64_t starts = has & ~l.left[row];
      for (; starts != 0; starts &= starts - 1) {
        const int32_t first = std::countr_zero(starts);
        const uint64_t after =
            ~(l.left[row] & has) & (first < 63 ? ~uint64_t{0} << (first + 1) : 0);
        const int32_t last = after == 0 ? 63 : std::countr_zero(after) - 1;
        const auto index = static_cast<int32_t>(runs_.size());
        const uint64_t cells = run_mask(first, last);
        runs_.push_back({k, z, cells, index, -1});
        std::fill_n(&now[static_cast<size_t>(k * kSide + first)], last - first + 1, index);
        // One union per run above that it touches.
        uint64_t up = l.up[row] & runs_.back().cells;
        while (up != 0) {
          const int32_t x = std::countr_zero(up);
          const int32_t run_above = above[static_cast<size_t>(k * kSide + x)];
          unite(index, run_above);
          up &= ~runs_[static_cast<size_t>(run_above)].cells;
        }
      }
    }
    for (uint64_t odd = odd_left & ~uint64_t{1}; odd != 0; odd &= odd - 1) {
      const int32_t x = std::countr_zero(odd);
      const size_t cell = static_cast<size_t>(z * kSide + x);
      join_ranks(cell, cell - 1, &now[static_cast<size_t>(x)], &now[static_cast<size_t>(x - 1)]);
    }
    for (; odd_up != 0; odd_up &= odd_up - 1) {
      const int32_t x = std::countr_zero(odd_up);
      const size_t cell = static_cast<size_t>(z * kSide + x);
      join_ranks(cell, cell - kSide, &now[static_cast<size_t>(x)], &above[static_cast<size_t>(x)]);
    }
  }
}

void LayerBuilder::make_components() {
  for (size_t i = 0; i < runs_.size(); ++i) {
    Run& run = runs_[i];
    const int32_t top = root(static_cast<int32_t>(i));
    if (top == static_cast<int32_t>(i)) {
      run.component = static_cast<int32_t>(components_.size());
      components_.emplace_back();
    } else {
      run.component = runs_[static_cast<size_t>(top)].component;
    }
    Component& component = components_[static_cast<size_t>(run.component)];
    uint64_t& row = component.cells[static_cast<size_t>(run.z)];
    component.overlaps_itself |= (row & run.cells) != 0;
    row |= run.cells;
    component.count += std::popcount(run.cells);
    const TopRange tops = run_range(free_layer(run.free_layer), run.z, run.cells);
    component.tops.low = std::min(component.tops.low, tops.low);
    component.tops.high = std::max(component.tops.high, tops.high);
  }
  // A component whose heights lie too far apart for 16 bits is cut like one that overlaps itself.
  for (Component& c : components_) {
    c.overlaps_itself |= static_cast<int64_t>(c.tops.high) - c.tops.low > kMaxRange;
  }
}

// Cuts a component into pieces that lie over themselves nowhere, breadth first from its first free
// span.
void LayerBuilder::split(int32_t index) {
  const auto free_layers = static_cast<size_t>(free_spans_.max_count);
  struct FreeSpan {
    uint16_t cell, free_layer;
  };
  std::vector<Rows> pending(free_layers, Rows{});  // free spans that are in no piece yet
  for (const Run& run : runs_) {
    if (run.component != index) continue;
    pending[static_cast<size_t>(run.free_layer)][static_cast<size_t>(run.z)] |= run.cells;
  }
  std::array<FreeSpan, kTileArea> queue;
  std::vector<Rows> rows(free_layers);
  // Row z + 1: columns with free spans that are pending, but not those where the piece has one.
  // Most neighbours of a free span are in its own piece, which a few operations show.
  std::array<uint64_t, kTileSide + 2> open{};
  const auto grow_piece = [&](int32_t seed_cell, int32_t seed_free_layer) {
    const auto piece = static_cast<int32_t>(components_.size());
    Component& component = components_.emplace_back();
    component.is_piece = true;
    for (size_t z = 0; z < kTileSide; ++z) {
      open[z + 1] = 0;
      for (const Rows& of_free_layer : pending) open[z + 1] |= of_free_layer[z];
    }
    for (Rows& r : rows) r.fill(0);
    TopRange tops;
    size_t count = 0;
    const auto take = [&](size_t cell, int32_t k, int32_t top) {
      const auto l = static_cast<size_t>(k), z = cell / kTileSide;
      const int32_t low = std::min(tops.low, top), high = std::max(tops.high, top);
      if (static_cast<int64_t>(high) - low > kMaxRange) return;
      tops = {low, high};
      const uint64_t bit = uint64_t{1} << cell % kTileSide;
      pending[l][z] &= ~bit;
      open[z + 1] &= ~bit;
      component.cells[z] |= bit;
      rows[l][z] |= bit;
      queue[count++] = {static_cast<uint16_t>(cell), static_cast<uint16_t>(k)};
    };
    const auto seed = static_cast<size_t>(seed_cell);
    take(seed, seed_free_layer, free_layer(seed_free_layer).top[seed]);
    for (size_t head = 0; head < count; ++head) {
      const FreeSpan free_span = queue[head];
      const size_t z = free_span.cell / kTileSide;
      const uint64_t bit = uint64_t{1} << free_span.cell % kTileSide;
      const uint64_t left = bit >> 1 & open[z + 1], right = bit << 1 & open[z + 1];
      const uint64_t up = bit & open[z], down = bit & open[z + 2];
      if ((left | right | up | down) == 0) continue;
      const FreeSpanLayer& own = free_layer(free_span.free_layer);
      const int32_t top = own.top[free_span.cell], ceiling = own.ceiling[free_span.cell];
      const auto grow_to = [&](size_t other, uint64_t other_bit) {
        const int32_t free_spans_there = free_spans_.count[other];
        for (int32_t m = 0; m < free_spans_there; ++m) {
          if ((pending[static_cast<size_t>(m)][other / kTileSide] & other_bit) == 0) continue;
          const FreeSpanLayer& theirs = free_layer(m);
          if (!linked(top, ceiling, theirs.top[other], theirs.ceiling[other])) continue;
          take(other, m, theirs.top[other]);
          break;
        }
      };
      if (left != 0) grow_to(free_span.cell - size_t{1}, left);
      if (right != 0) grow_to(free_span.cell + size_t{1}, right);
      if (up != 0) grow_to(free_span.cell - size_t{kTileSide}, up);
      if (down != 0) grow_to(free_span.cell + size_t{kTileSide}, down);
    }
    component.tops = tops;
    component.count = static_cast<int32_t>(count);
    for (size_t k = 0; k < free_layers; ++k) {
      for (int32_t z = 0; z < kSide; ++z) {
        const uint64_t cells = rows[k][static_cast<size_t>(z)];
        if (cells != 0) pieces_.push_back({static_cast<int32_t>(k), z, cells, piece});
      }
    }
  };
  components_[static_cast<size_t>(index)].count = 0;  // its number is not used again
  for (size_t i = 0; i < runs_.size(); ++i) {
    const Run run = runs_[i];
    if (run.component != index) continue;
    const uint64_t& left = pending[static_cast<size_t>(run.free_layer)][static_cast<size_t>(run.z)];
    while ((left & run.cells) != 0) {
      grow_piece(run.z * kSide + std::countr_zero(left & run.cells), run.free_layer);
    }
  }
}

// True if no body of any class fits on the component: it is smaller than the smallest footprint and
// ends inside the tile. This removes the tops of pillars and rails. A piece continues in another
// one.
bool LayerBuilder::is_crumb(size_t component) const {
  const Component& c = components_[component];
  if (c.is_piece) return false;
  if (c.count >= limits_.min_footprint || c.cells[0] != 0 || c.cells[kSide - 1] != 0) return false;
  uint64_t columns = 0;
  for (const uint64_t row : c.cells) columns |= row;
  return (columns & 0x8000000000000001u) == 0 && (only_.empty() || !goes_on(component));
}

// True if free spans that are in layers already continue a component.
bool LayerBuilder::goes_on(size_t component) const {
  for (const Run& run : runs_) {
    if (run.component != static_cast<int32_t>(component)) continue;
    for (uint64_t cells = run.cells; cells != 0; cells &= cells - 1) {
      // Crumbs end inside the tile: each cell has four neighbours.
      const int32_t cell = run.z * kSide + std::countr_zero(cells);
      for (const int32_t next : {cell - 1, cell + 1, cell - kSide, cell + kSide}) {
        const auto at = static_cast<size_t>(cell), other = static_cast<size_t>(next);
        for (int32_t m = 0; m < free_spans_.count[other]; ++m) {
          if (!is_ours(other, m) && linked(at, run.free_layer, other, m)) return true;
        }
      }
    }
  }
  return false;
}

// Assigns components to layers, larger first, each to the first layer of about its height whose
// columns are free: floors stay constant when a crate's top is in another layer. Many layers are
// worse than mixed ones, so after kMaxSortedLayers the height does not count.
int32_t LayerBuilder::pack(std::vector<int32_t>& layer_of) const {
  constexpr size_t kMaxSortedLayers = 24;
  constexpr int32_t kSameHeight = 500;  // [mm]
  std::vector<int32_t> order;
  for (size_t i = 0; i < components_.size(); ++i) {
    if (components_[i].count > 0 && !is_crumb(i)) order.push_back(static_cast<int32_t>(i));
  }
  std::stable_sort(order.begin(), order.end(), [&](int32_t a, int32_t b) {
    return components_[static_cast<size_t>(a)].count > components_[static_cast<size_t>(b)].count;
  });
  struct Bin {
    Rows used{};
    TopRange tops;
  };
  std::vector<Bin> bins;
  layer_of.assign(components_.size(), -1);
  for (const int32_t index : order) {
    const Component& component = components_[static_cast<size_t>(index)];
    size_t b = 0;
    for (; b < bins.size(); ++b) {
      const int64_t low = std::min(bins[b].tops.low, component.tops.low);
      if (std::max(bins[b].tops.high, component.tops.high) - low > kMaxRange) continue;
      const bool apart = component.tops.low - bins[b].tops.high > kSameHeight ||
                         bins[b].tops.low - component.tops.high > kSameHeight;
      if (apart && bins.size() < kMaxSortedLayers) continue;
      bool overlaps = false;
      for (size_t z = 0; z < kTileSide && !overlaps; ++z)
        overlaps = (bins[b].used[z] & component.cells[z]) != 0;
      if (!overlaps) break;
    }
    if (b == bins.size()) bins.emplace_back();
    Bin& bin = bins[b];
    bin.tops.low = std::min(bin.tops.low, component.tops.low);
    bin.tops.high = std::max(bin.tops.high, component.tops.high);
    for (size_t z = 0; z < kTileSide; ++z) bin.used[z] |= component.cells[z];
    layer_of[static_cast<size_t>(index)] = static_cast<int32_t>(b);
  }
  return static_cast<int32_t>(bins.size());
}

void LayerBuilder::build(LayerPool& pool, TileLayers& layers) {
  find_runs();
  make_components();
  bool seams = false;
  const size_t found = components_.size();
  for (size_t i = 0; i < found; ++i) {
    if (!components_[i].overlaps_itself) continue;
    split(static_cast<int32_t>(i));
    seams = true;
  }
  for (const Run& run : runs_) {
    if (components_[static_cast<size_t>(run.component)].overlaps_itself) continue;
    pieces_.push_back({run.free_layer, run.z, run.cells, run.component});
  }
  std::vector<int32_t> layer_of;
  const int32_t count = pack(layer_of);
  std::vector<std::unique_ptr<Layer>> built;
  std::vector<int32_t> low(static_cast<size_t>(count), INT32_MAX);
  for (size_t i = 0; i < components_.size(); ++i) {
    if (layer_of[i] < 0) continue;
    int32_t& lowest = low[static_cast<size_t>(layer_of[i])];
    lowest = std::min(lowest, components_[i].tops.low);
  }
  for (const int32_t lowest : low) {
    built.push_back(pool.take());
    built.back()->base = lowest - Layer::kBaseDepth;
    built.back()->seams = seams || !only_.empty();
    built.back()->is_low = !only_.empty();
    clear_layer(*built.back());
  }
  for (const Piece& piece : pieces_) {
    const int32_t layer = layer_of[static_cast<size_t>(piece.component)];
    if (layer < 0) {
      crumbs_.push_back(piece);
      continue;
    }
    write_free_spans(free_layer(piece.free_layer), piece.z, piece.cells,
                     *built[static_cast<size_t>(layer)]);
  }
  for (auto& layer : built) {
    summarise(*layer);
    layer->base += free_spans_.base;
    if (layer->present == 0) {
      pool.give(std::move(layer));
    } else {
      layers.push_back(std::move(layer));
    }
  }
}

// Per free-span layer, the free spans that are too low for high layers, and the crumbs of these;
// empty if there are none. High free spans are found among all by their tops.
std::vector<Rows> free_spans_to_add(const TileFreeSpans& all, const TileFreeSpans& high,
                                    const std::vector<Piece>& crumbs) {
  std::vector<Rows> rows(static_cast<size_t>(all.max_count));
  uint64_t any = 0;
  for (int32_t k = 0; k < all.max_count; ++k) {
    Rows& of_free_layer = rows[static_cast<size_t>(k)];
    low_free_spans(all, k, BodyLimits::kHighFreeSpan, of_free_layer);
    for (const uint64_t row : of_free_layer) any |= row;
  }
  if (any == 0 && crumbs.empty()) return {};
  for (const Piece& crumb : crumbs) {
    const FreeSpanLayer& from = *high.layers[static_cast<size_t>(crumb.free_layer)];
    for (uint64_t cells = crumb.cells; cells != 0; cells &= cells - 1) {
      const int32_t x = std::countr_zero(cells);
      const auto cell = static_cast<size_t>(crumb.z * kSide + x);
      for (int32_t k = 0; k < all.count[cell]; ++k) {
        const int32_t top = all.layers[static_cast<size_t>(k)]->top[cell] + all.base;
        if (top != from.top[cell] + high.base) continue;
        rows[static_cast<size_t>(k)][static_cast<size_t>(crumb.z)] |= uint64_t{1} << x;
      }
    }
  }
  return rows;
}

// A tile of single free spans that fit 16 bits needs no runs: they are one layer.
bool build_single_layer(const TileFreeSpans& free_spans, LayerPool& pool, TileLayers& layers) {
  const TopRange range = free_span_range(free_spans, 0);
  if (static_cast<int64_t>(range.high) - range.low > kMaxRange) return false;
  auto layer = pool.take();
  layer->base = range.low - Layer::kBaseDepth;
  layer->seams = layer->is_low = false;
  uint64_t missing = 0;
  Rows has{};
  for (size_t c = 0; c < kTileArea; ++c) {
    has[c / kTileSide] |= static_cast<uint64_t>(free_spans.count[c] > 0) << (c % kTileSide);
  }
  for (const uint64_t row : has) missing |= ~row;
  if (missing != 0) clear_layer(*layer);
  for (int32_t z = 0; z < kSide; ++z) {
    write_free_spans(*free_spans.layers[0], z, has[static_cast<size_t>(z)], *layer);
  }
  summarise(*layer);
  layer->base += free_spans.base;
  if (layer->present == 0) {
    pool.give(std::move(layer));
  } else {
    layers.push_back(std::move(layer));
  }
  return true;
}

}  // namespace

int32_t bottom_mm(const AvatarClass& avatar) {
  return static_cast<int32_t>(std::floor(body_bottom(avatar) * 1000 + 1e-6));
}

int32_t height_mm(const AvatarClass& avatar) {
  return static_cast<int32_t>(std::ceil(avatar.height * 1000 - 1e-6));
}

int32_t min_free_span_of(const AvatarClass& avatar) {
  return std::max(1, height_mm(avatar) - bottom_mm(avatar));
}

namespace {

// Cells that a body on one cell can touch, at least.
int32_t footprint_cells(double radius, double cell) {
  const auto reach = static_cast<int32_t>(std::floor(radius / cell / 1.5));
  return (2 * reach + 1) * (2 * reach + 1);
}

}  // namespace

BodyLimits body_limits(std::span<const AvatarClass> classes, const SurfaceCodes& codes,
                       double cell) {
  BodyLimits limits;
  int32_t min_room = INT32_MAX;
  limits.min_height = INT32_MAX;
  limits.min_footprint = footprint_cells(BodyLimits::kMinRadius, cell);
  for (const AvatarClass& avatar : classes) {
    const int32_t bottom = bottom_mm(avatar), height = height_mm(avatar);
    min_room = std::min(min_room, min_free_span_of(avatar));
    limits.min_height = std::min(limits.min_height, height);
    limits.max_bottom = std::max(limits.max_bottom, bottom);
    limits.min_footprint = std::min(limits.min_footprint, footprint_cells(avatar.radius, cell));
  }
  limits.low_free_span = std::min(BodyLimits::kLowFreeSpan, min_room);
  limits.min_free_span =
      min_room < BodyLimits::kHighFreeSpan ? limits.low_free_span : BodyLimits::kHighFreeSpan;
  limits.blocked_code = static_cast<int32_t>(codes.codes.size()) - 1;
  limits.allowed.assign(256, 0);
  std::copy(codes.allowed.begin(), codes.allowed.end(), limits.allowed.begin());
  return limits;
}

void set_borders(Layer& layer) {
  constexpr size_t kEnd = kTileSide - 1;
  constexpr std::array<size_t, 4> kFirst{0, kEnd, 0, kEnd * kTileSide};
  for (size_t side = 0; side < 4; ++side) {
    const size_t stride = side < 2 ? kTileSide : 1;
    uint16_t lowest = kNone16;
    for (size_t i = 0; i < kTileSide; ++i) {
      const size_t cell = kFirst[side] + i * stride;
      const auto useful = static_cast<uint16_t>(layer.useful[cell / kTileSide] >> cell % kTileSide);
      const uint16_t feet = layer.feet[cell] | static_cast<uint16_t>((useful & 1) - 1);
      layer.border[side][i] = feet;
      lowest = std::min(lowest, feet);
    }
    layer.has_border[side] = lowest != kNone16;
  }
}

void find_useful(const BodyLimits& limits, Layer& layer) {
  // Most layers are so even that their extremes suffice.
  layer.all_useful =
      layer.one_code && layer.some_code != limits.blocked_code &&
      layer.high_top <= layer.low_feet + limits.max_bottom &&
      (layer.low_ceiling == kNone16 || layer.low_ceiling >= layer.high_feet + limits.min_height);
  if (!layer.all_useful) {
    useful_cells(layer, {limits.max_bottom, limits.min_height, limits.blocked_code}, layer.useful);
  } else if (layer.present == kTileArea) {
    layer.useful.fill(~uint64_t{0});
  } else {
    present_bits(layer, layer.useful);
  }
  set_borders(layer);
}

std::unique_ptr<Layer> LayerPool::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      auto layer = std::move(free_.back());
      free_.pop_back();
      return layer;
    }
  }
  return std::make_unique_for_overwrite<Layer>();
}

void LayerPool::give(std::unique_ptr<Layer> layer) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(layer));
}

void assign_free_spans(const FreeSpansToAssign& free_spans, const BodyLimits& limits,
                       LayerPool& pool, TileLayers& layers) {
  layers.clear();
  const TileFreeSpans& high = free_spans.high;
  std::vector<Piece> crumbs;
  if (high.max_count > 0) {
    if (high.max_count > 1 || !build_single_layer(high, pool, layers)) {
      LayerBuilder builder(high, limits);
      builder.build(pool, layers);
      crumbs = builder.crumbs();
    }
  }
  if (free_spans.all != nullptr && free_spans.all->max_count > 1) {
    const std::vector<Rows> low = free_spans_to_add(*free_spans.all, high, crumbs);
    if (!low.empty()) LayerBuilder(*free_spans.all, limits, low).build(pool, layers);
  }
  std::stable_sort(layers.begin(), layers.end(),
                   [](const auto& a, const auto& b) { return a->base < b->base; });
}

}  // namespace throng::bake
