// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/zone_bake.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "bake/columns/free_spans.h"
#include "bake/folder/zone_builder.h"
#include "bake/layers/clearance.h"
#include "bake/layers/layer_kernels.h"
#include "bake/layers/surface_planes.h"
#include "bake/layers/wall_parts.h"
#include "core/parallel.h"
#include "core/stopwatch.h"

// A zone is baked in bands of tile rows, so that only a few rows of layers are alive at a time:
// while a band's columns are assigned to layers, legality is judged one row behind it, because it
// looks into the next tiles, and clearance is eroded one row behind that. A ring of tiles around
// the zone is rasterised as far as the zone looks, so that no zone depends on another's result.
namespace throng::bake {
namespace {

constexpr int32_t kBand = 8;  // tile rows

struct TileState {
  TileLayers layers;
  LayerList all, high;             // the layers, and those of them that are not low
  std::vector<size_t> high_of;     // which layer of the tile each of the high ones is
  std::unique_ptr<BitPlane> bare;  // columns without a solid; of fine bakes
  std::vector<FloorPlane> planes;
  TileLegality legality;

  [[nodiscard]] bool has_low() const { return high.size() != all.size(); }
};

// Tiles of a zone and its ring, row by row; the ring is row and column 0 and n + 1.
class ZoneJob {
 public:
  ZoneJob(const BakePlan& plan, int32_t zone_x, int32_t zone_z, ZoneScratch& scratch)
      : plan_(plan),
        scratch_(scratch),
        workers_(static_cast<int32_t>(scratch.workers.size())),
        first_x_(zone_x * plan.tiles_per_zone - 1),
        first_z_(zone_z * plan.tiles_per_zone - 1),
        side_(plan.tiles_per_zone + 2),
        tiles_(static_cast<size_t>(side_) * static_cast<size_t>(side_)),
        packs_(static_cast<size_t>(plan.tiles_per_zone) *
               static_cast<size_t>(plan.tiles_per_zone)) {}

  bool run(std::span<const uint32_t> triangles, int32_t zone_x, int32_t zone_z, Context& context,
           ZoneResult& result);

 private:
  [[nodiscard]] TileState& at(int32_t column, int32_t row) {
    return tiles_[static_cast<size_t>(row * side_ + column)];
  }
  [[nodiscard]] bool in_world(int32_t column, int32_t row) const {
    const int32_t x = first_x_ + column, z = first_z_ + row;
    return column >= 0 && row >= 0 && column < side_ && row < side_ && x >= 0 && z >= 0 &&
           x < plan_.grid.tiles_x() && z < plan_.grid.tiles_z();
  }
  template <class Body>
  void for_tiles(int32_t row0, int32_t row1, Body body);

  void make_layers(int32_t column, int32_t row, ZoneScratch::Worker& worker);
  void assign(TileState& tile, ZoneScratch::Worker& worker);
  void give_back(TileState& tile);
  void judge(int32_t column, int32_t row, ZoneScratch::Worker& worker);
  void judge_alike(int32_t column, int32_t row, const Neighbourhood& around,
                   std::span<const size_t> classes, ZoneScratch::Worker& worker);
  [[nodiscard]] Neighbourhood seen_around(int32_t column, int32_t row, bool low_too);
  void clear(int32_t column, int32_t row, ZoneScratch::Worker& worker);
  [[nodiscard]] TileTriangles triangles_around(int32_t column, int32_t row) const;
  void recheck_near_limit(const Layer& layer, const FloorPlane& floor, const BodyWindow& body,
                          const TileTriangles& triangles, ZoneScratch::Worker& worker,
                          LegalCells& cells);
  bool is_open(int32_t column, int32_t row, size_t avatar_class) const;

  const BakePlan& plan_;
  ZoneScratch& scratch_;
  int32_t workers_;
  int32_t first_x_, first_z_;  // of the ring, in tiles of the world
  int32_t side_;
  std::vector<TileState> tiles_;
  std::vector<TilePack> packs_;  // of the zone's own tiles
  TriangleBins bins_;
};

}  // namespace

struct ZoneScratch::Worker {
  TileColumns columns;
  TileFreeSpans free_spans,
      high;  // all, and those of BodyLimits::kHighFreeSpan, if these are not all
  std::vector<size_t> low, tall;  // classes that use all layers of a tile, or high ones only
  uint32_t beside_walls = 0;      // bit c: walls of the tile were tested for class c
  LegalityScratch legality;
  CellPlanes planes;
  WallScratch walls;
  double seconds_columns = 0, seconds_levels = 0, seconds_clearance = 0;
  uint64_t spans = 0;
  std::vector<ClearancePlanes> clearance;  // of one layer, per class
  std::vector<uint8_t> step_safe;
  std::vector<uint64_t> legal_cells;  // of the zone, per class
};

ZoneScratch::ZoneScratch(int32_t count) {
  for (int32_t i = 0; i < count; ++i) workers.push_back(std::make_unique<Worker>());
}

ZoneScratch::~ZoneScratch() = default;

void BakePlan::put_on(const Grid& to) {
  grid = to;
  zones_x = (grid.tiles_x() + tiles_per_zone - 1) / tiles_per_zone;
  zones_z = (grid.tiles_z() + tiles_per_zone - 1) / tiles_per_zone;
}

int32_t BakePlan::apron() const { return reach + kApronBits + 1; }

namespace {

template <class Body>
void ZoneJob::for_tiles(int32_t row0, int32_t row1, Body body) {
  row0 = std::max(row0, 0);
  row1 = std::min(row1, side_);
  if (row0 >= row1) return;
  parallel_for_worker(static_cast<size_t>((row1 - row0) * side_), workers_,
                      [&](size_t i, int32_t worker) {
                        const int32_t column = static_cast<int32_t>(i) % side_;
                        const int32_t row = row0 + static_cast<int32_t>(i) / side_;
                        if (in_world(column, row)) {
                          body(column, row, *scratch_.workers[static_cast<size_t>(worker)]);
                        }
                      });
}

void ZoneJob::make_layers(int32_t column, int32_t row, ZoneScratch::Worker& worker) {
  const size_t bin = static_cast<size_t>(row * side_ + column);
  const uint32_t begin = bins_.first[bin], end = bins_.first[bin + 1];
  if (begin == end) return;
  const auto start = Clock::now();
  TileRect rect;  // of a ring tile only what the zone reads
  const int32_t apron = plan_.apron(), last = side_ - 1;
  if (column == 0) rect.x0 = std::max(0, kTileSide - apron);
  if (column == last) rect.x1 = std::min(kTileSide, apron);
  if (row == 0) rect.z0 = std::max(0, kTileSide - apron);
  if (row == last) rect.z1 = std::min(kTileSide, apron);
  rasterise_tile(scratch_.triangles, {&bins_.items[begin], end - begin},
                 (first_x_ + column) * kTileSide, (first_z_ + row) * kTileSide, rect,
                 plan_.limits.min_free_span - 1, worker.columns);
  find_free_spans(worker.columns, plan_.limits.min_free_span, worker.free_spans);
  worker.seconds_columns += seconds_since(start);
  if (column > 0 && row > 0 && column < last && row < last) worker.spans += worker.free_spans.spans;

  const auto assign_start = Clock::now();
  TileState& tile = at(column, row);
  if (plan_.config->fine) {
    tile.bare = std::make_unique<BitPlane>(bare_columns(worker.free_spans));
  }
  assign(tile, worker);
  worker.seconds_levels += seconds_since(assign_start);
}

// What another class may stand on below or above must not change what a class reaches. So how free
// spans are assigned does not depend on classes, and classes that need high free spans use no
// others: in a bake for them alone there are none.
void ZoneJob::assign(TileState& tile, ZoneScratch::Worker& worker) {
  const bool low_too =
      plan_.limits.min_free_span < BodyLimits::kHighFreeSpan && worker.free_spans.max_count > 1;
  if (low_too) {
    find_free_spans(worker.columns, BodyLimits::kHighFreeSpan, worker.high);
    lend_supports(worker.free_spans);
  }
  const FreeSpansToAssign free_spans{.high = low_too ? worker.high : worker.free_spans,
                                     .all = low_too ? &worker.free_spans : nullptr};
  assign_free_spans(free_spans, plan_.limits, scratch_.pool, tile.layers);
  if (tile.layers.empty()) return;
  for (auto& layer : tile.layers) {
    tile.planes.push_back(fit_plane(*layer));
    find_useful(plan_.limits, *layer);  // A plane may move feet by a millimetre.
  }
  for (size_t i = 0; i < tile.layers.size(); ++i) {
    const Layer* layer = tile.layers[i].get();
    tile.all.add(layer);
    if (layer->is_low) continue;
    tile.high.add(layer);
    tile.high_of.push_back(i);
  }
}

void ZoneJob::give_back(TileState& tile) {
  for (auto& layer : tile.layers) scratch_.pool.give(std::move(layer));
  tile = {};
}

Neighbourhood ZoneJob::seen_around(int32_t column, int32_t row, bool low_too) {
  Neighbourhood around{};
  for (int32_t i = 0; i < 9; ++i) {
    const int32_t x = column + i % 3 - 1, z = row + i / 3 - 1;
    if (!in_world(x, z)) continue;
    const TileState& tile = at(x, z);
    around[static_cast<size_t>(i)] = low_too ? &tile.all : &tile.high;
  }
  return around;
}

void ZoneJob::judge(int32_t column, int32_t row, ZoneScratch::Worker& worker) {
  TileState& tile = at(column, row);
  if (tile.layers.empty()) return;
  const auto start = Clock::now();
  tile.legality.resize(tile.layers.size());
  std::array<const TileLayers*, 4> sides{};
  constexpr std::array<std::array<int32_t, 2>, 4> kSides{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  for (size_t i = 0; i < 4; ++i) {
    const int32_t x = column + kSides[i][0], z = row + kSides[i][1];
    if (in_world(x, z)) sides[i] = &at(x, z).layers;
  }
  for (size_t s = 0; s < tile.layers.size(); ++s) {
    tile.legality[s].classes.resize(plan_.bodies.size());
    link_layer(*tile.layers[s], sides, plan_.max_step, tile.legality[s]);
  }
  worker.walls.known = 0;
  worker.beside_walls = 0;
  const size_t classes = plan_.bodies.size();
  const Neighbourhood around = seen_around(column, row, true);
  bool any_low = false;
  for (size_t i = 0; i < around.size(); ++i) {
    const int32_t x = column + static_cast<int32_t>(i) % 3 - 1;
    const int32_t z = row + static_cast<int32_t>(i) / 3 - 1;
    any_low |= around[i] != nullptr && at(x, z).has_low();
  }
  worker.low.clear();
  worker.tall.clear();
  for (size_t c = 0; c < classes; ++c) {
    (any_low && plan_.is_tall[c] ? worker.tall : worker.low).push_back(c);
  }
  judge_alike(column, row, around, worker.low, worker);
  if (!worker.tall.empty()) {
    judge_alike(column, row, seen_around(column, row, false), worker.tall, worker);
  }

  for (size_t s = 0; s < tile.layers.size(); ++s) {
    for (size_t c = 0; c < classes; ++c) {
      const BodyWindow& body = plan_.bodies[c];
      LayerLegality::PerClass& verdict = tile.legality[s].classes[c];
      if (verdict.all) continue;
      uint64_t any = 0, all = ~uint64_t{0};
      for (const uint64_t bits : verdict.legal) {
        any |= bits;
        all &= bits;
      }
      verdict.any = any != 0;
      verdict.all = all == ~uint64_t{0};
      // A window that fits within a step makes neighbours safe, but only where the layer is the
      // only one: at a seam the neighbour that fits is another layer's, and this one's may be a
      // storey off. Beside walls, a neighbour need not fit as a whole.
      const bool window_is_enough = tile.layers.size() == 1 && body.bottom <= body.step &&
                                    (worker.beside_walls & body.class_bit) == 0;
      verdict.step_safe =
          any == 0 || window_is_enough || step_safe(*tile.layers[s], verdict.legal, body.step);
    }
  }
  worker.seconds_clearance += seconds_since(start);
}

// Judges a tile for classes that use the same layers in it and around it.
void ZoneJob::judge_alike(int32_t column, int32_t row, const Neighbourhood& around,
                          std::span<const size_t> classes, ZoneScratch::Worker& worker) {
  TileState& tile = at(column, row);
  const TileTriangles triangles = triangles_around(column, row);
  const LayerList& seen = *around[4];
  for (size_t i = 0; i < seen.size(); ++i) {
    const Layer& layer = *seen[i];
    const size_t s = &seen == &tile.high ? tile.high_of[i] : i;
    bool assembled = false;
    for (const size_t c : classes) {
      const BodyWindow& body = plan_.bodies[c];
      LegalCells cells;
      BitPlane may;
      if (all_legal(around, i, body, plan_.limits)) {
        cells.legal.fill(~uint64_t{0});
      } else if (may_stand(layer, body, plan_.limits, may)) {
        if (!assembled) {
          worker.legality.window.assemble(around, i, plan_.reach, plan_.limits);
          make_tilt(layer, worker.legality.tilt);
          assembled = true;
        }
        legal_cells(layer, body, may, worker.legality, cells);
        recheck_slopes(layer, body, worker.legality, cells);
        if (body.barely) {
          recheck_near_limit(layer, tile.planes[s], body, triangles, worker, cells);
        }
        recheck_seams(around, i, body, plan_.limits, worker.legality, cells);
        if (body.fine &&
            recheck_walls(around, i, body, triangles, worker.legality, worker.walls, cells)) {
          worker.beside_walls |= body.class_bit;
        }
      }
      tile.legality[s].classes[c].legal = cells.legal;
    }
  }
}

TileTriangles ZoneJob::triangles_around(int32_t column, int32_t row) const {
  TileTriangles triangles{.all = scratch_.triangles,
                          .items = {},
                          .bare = {},
                          .cell_x = (first_x_ + column) * kTileSide,
                          .cell_z = (first_z_ + row) * kTileSide};
  for (int32_t i = 0; i < 9; ++i) {
    const int32_t x = column + i % 3 - 1, z = row + i / 3 - 1;
    if (!in_world(x, z)) continue;
    triangles.items[static_cast<size_t>(i)] = bins_.square(static_cast<size_t>(z * side_ + x));
    triangles.bare[static_cast<size_t>(i)] = tiles_[static_cast<size_t>(z * side_ + x)].bare.get();
  }
  return triangles;
}

// The last word on cells of a slope that is near what a class can climb, from the triangles.
void ZoneJob::recheck_near_limit(const Layer& layer, const FloorPlane& floor,
                                 const BodyWindow& body, const TileTriangles& triangles,
                                 ZoneScratch::Worker& worker, LegalCells& cells) {
  if (floor.found && (floor.slope_x | floor.slope_z) == 0) return;
  BitPlane asked;
  uint64_t any = 0;
  for (size_t z = 0; z < kTileSide; ++z) any |= asked[z] = cells.slanted[z] & ~cells.legal[z];
  if (any == 0) return;
  find_surface_planes(worker.legality.window, layer.base, asked, body, triangles, worker.planes);
  recheck_planes(layer, body, worker.planes, worker.legality, cells);
}

// True if this tile and all around it are single layers, legal everywhere, without a step between.
bool ZoneJob::is_open(int32_t column, int32_t row, size_t avatar_class) const {
  int32_t low = INT32_MAX, high = INT32_MIN;
  for (int32_t i = 0; i < 9; ++i) {
    const int32_t x = column + i % 3 - 1, z = row + i / 3 - 1;
    if (!in_world(x, z)) return false;
    const TileState& tile = tiles_[static_cast<size_t>(z * side_ + x)];
    if (tile.legality.size() != 1 || !tile.legality[0].classes[avatar_class].all) return false;
    const Layer& layer = *tile.layers[0];
    low = std::min(low, layer.base + layer.low_feet);
    high = std::max(high, layer.base + layer.high_feet);
  }
  return high - low <= plan_.bodies[avatar_class].step;
}

// Feet of a layer that are stored: where some class may stand, and beside the cells where a class
// is legal, whose tilt comes from there (world/surface.h).
void forget_feet(const world::CellRows& legal, Layer& layer) {
  if (layer.all_useful) return;
  // Nor is anything forgotten where a class may stand everywhere; those around such a tile read its
  // heights meanwhile (is_open).
  if (std::all_of(legal.begin(), legal.end(), [](uint64_t row) { return ~row == 0; })) return;
  world::CellRows kept = layer.useful;
  const auto keep = [&](size_t z, uint64_t row) {
    const uint64_t rims = (row & 1) << 2 | (row & uint64_t{1} << 63) >> 2;
    kept[z] |= row | row << 1 | row >> 1 | rims;
  };
  constexpr size_t kLast = kTileSide - 1;
  for (size_t z = 0; z < kTileSide; ++z) {
    keep(z, legal[z]);
    if (z > 0) kept[z] |= legal[z - 1];
    if (z < kLast) kept[z] |= legal[z + 1];
  }
  kept[2] |= legal[0];
  kept[kLast - 2] |= legal[kLast];
  keep_feet(kept, layer);
}

void ZoneJob::clear(int32_t column, int32_t row, ZoneScratch::Worker& worker) {
  if (column == 0 || row == 0 || column == side_ - 1 || row == side_ - 1) return;
  TileState& tile = at(column, row);
  if (tile.layers.empty()) return;
  const auto start = Clock::now();
  std::array<const TileLegality*, 9> around{};
  for (int32_t i = 0; i < 9; ++i) {
    const int32_t x = column + i % 3 - 1, z = row + i / 3 - 1;
    if (in_world(x, z)) around[static_cast<size_t>(i)] = &at(x, z).legality;
  }
  const auto index = static_cast<uint32_t>((row - 1) * plan_.tiles_per_zone + column - 1);
  const size_t classes = plan_.bodies.size();
  worker.clearance.resize(classes);
  worker.step_safe.resize(classes);
  for (size_t s = 0; s < tile.layers.size(); ++s) {
    const LayerLegality& legality = tile.legality[s];
    const bool used = std::any_of(legality.classes.begin(), legality.classes.end(),
                                  [](const auto& verdict) { return verdict.any; });
    if (!used) continue;
    world::CellRows needed{};
    for (size_t c = 0; c < classes; ++c) {
      ClearancePlanes& planes = worker.clearance[c];
      planes.all = false;
      planes.cells = 0;
      worker.step_safe[c] = legality.classes[c].step_safe;
      if (is_open(column, row, c)) {
        planes.all = true;
        planes.cells = kTileArea;
      } else if (legality.classes[c].any) {
        erode(around, s, c, plan_.bodies[c].step, planes);
      }
      worker.legal_cells[c] += static_cast<uint64_t>(planes.cells);
      if (!legality.classes[c].any) continue;
      for (size_t z = 0; z < kTileSide; ++z) needed[z] |= legality.classes[c].legal[z];
    }
    forget_feet(needed, *tile.layers[s]);
    pack_level(index, *tile.layers[s], tile.planes[s], worker.clearance, worker.step_safe,
               plan_.codes, packs_[index]);
  }
  worker.seconds_clearance += seconds_since(start);
}

bool ZoneJob::run(std::span<const uint32_t> triangles, int32_t zone_x, int32_t zone_z,
                  Context& context, ZoneResult& result) {
  for (auto& worker : scratch_.workers) {
    worker->seconds_columns = worker->seconds_levels = worker->seconds_clearance = 0;
    worker->spans = 0;
    worker->legal_cells.assign(plan_.bodies.size(), 0);
  }
  const auto start = Clock::now();
  scratch_.triangles.resize(triangles.size());
  parallel_ranges(triangles.size(), 4096, workers_, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      scratch_.triangles[i] =
          to_cell_triangle(*plan_.scene, triangles[i], plan_.grid, plan_.coder->code(triangles[i]));
    }
  });
  bins_ = bin_triangles(scratch_.triangles, first_x_ * kTileSide, first_z_ * kTileSide, side_,
                        side_, kTileSide, 0);
  result.seconds_columns = seconds_since(start);

  using Worker = ZoneScratch::Worker;
  for (int32_t row = 0; row < side_ + 2; row += kBand) {
    if (context.cancel) return false;
    const int32_t end = row + kBand;
    // Once cancelled, no pass reads what the one before it has left out.
    const auto pass = [&](int32_t behind, auto&& work) {
      for_tiles(row - behind, end - behind, [&](int32_t x, int32_t z, Worker& w) {
        if (!context.cancel) work(x, z, w);
      });
    };
    pass(0, [&](int32_t x, int32_t z, Worker& w) { make_layers(x, z, w); });
    pass(1, [&](int32_t x, int32_t z, Worker& w) { judge(x, z, w); });
    pass(2, [&](int32_t x, int32_t z, Worker& w) { clear(x, z, w); });
    // Rows that are not read again.
    for (int32_t z = std::max(row - 4, 0); z < std::min(end - 4, side_); ++z) {
      for (int32_t x = 0; x < side_; ++x) give_back(at(x, z));
    }
  }
  for (auto& tile : tiles_) give_back(tile);
  if (context.cancel) return false;
  for (const auto& worker : scratch_.workers) {
    result.seconds_columns += worker->seconds_columns;
    result.seconds_levels += worker->seconds_levels;
    result.seconds_clearance += worker->seconds_clearance;
    result.spans += worker->spans;
    for (size_t c = 0; c < result.legal_cells.size(); ++c) {
      result.legal_cells[c] += worker->legal_cells[c];
    }
  }
  for (const TilePack& pack : packs_) {
    result.levels += static_cast<uint32_t>(pack.levels.size());
    result.flat_levels += pack.flat;
    result.tiles += pack.levels.empty() ? 0 : 1;
  }
  if (result.levels > 0) {
    result.bytes = zone_bytes({.x = zone_x,
                               .z = zone_z,
                               .tiles_per_side = static_cast<uint32_t>(plan_.tiles_per_zone),
                               .class_count = static_cast<uint32_t>(plan_.bodies.size())},
                              packs_, workers_);
  }
  return true;
}

}  // namespace

bool bake_zone(const BakePlan& plan, int32_t zone_x, int32_t zone_z,
               std::span<const uint32_t> triangles, ZoneScratch& scratch, Context& context,
               ZoneResult& result) {
  result = {};
  result.legal_cells.assign(plan.bodies.size(), 0);
  if (triangles.empty()) return true;
  return ZoneJob(plan, zone_x, zone_z, scratch).run(triangles, zone_x, zone_z, context, result);
}

}  // namespace throng::bake
