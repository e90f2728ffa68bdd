// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "bake/columns/columns.h"
#include "bake/columns/triangles.h"
#include "core/parallel.h"
#include "papers/slices/slice_sweep.h"
#include "throng/papers.h"

// Columns of the whole grid are filled once, tile by tile; the sweep does the rest.
namespace throng {
namespace {

constexpr double kMaxHeight = 1e6;         // m: int32 millimetres with room for an avatar.
constexpr double kMaxCells = 134'217'728;  // 2^27: half a gigabyte a kept slice.

std::optional<Error> check_config(const SliceConfig& config) {
  const auto bad = [](const char* what, double value, const char* limit) {
    return Error{Errc::kBadConfig,
                 fmt::format("slices: {} is {}; it must be {}", what, value, limit)};
  };
  if (!(config.avatar_height >= 0.001 && config.avatar_height <= 1000)) {
    return bad("avatar_height", config.avatar_height, "0.001 to 1000 m");
  }
  if (!(config.resolution >= 0.001 && config.resolution <= 1000)) {
    return bad("resolution", config.resolution, "0.001 to 1000 m");
  }
  if (!(config.cell >= SliceConfig::kMinCell && config.cell <= SliceConfig::kMaxCell)) {
    return bad("cell", config.cell, "0.01 to 1000 m");
  }
  if (config.workers < 0) return bad("workers", config.workers, "at least 0");
  return {};
}

// The box of all corners in use, or why the scene cannot be cut.
Result<Box3d> check_scene(const Scene& scene) {
  if (scene.triangles.empty()) {
    return Error{Errc::kBadInput,
                 "slices: the scene has no triangles; give it a model with surfaces"};
  }
  Box3d box;
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    for (const uint32_t corner : scene.triangles[t]) {
      if (corner >= scene.positions.size()) {
        return Error{Errc::kBadInput,
                     fmt::format("slices: triangle {} has corner {}, the scene {} positions; "
                                 "load_scene drops such triangles",
                                 t, corner, scene.positions.size())};
      }
      const Vec3d p = scene.positions[corner];
      if (!(std::isfinite(p.x) && std::isfinite(p.z) && std::fabs(p.y) <= kMaxHeight)) {
        return Error{Errc::kBadInput,
                     fmt::format("slices: triangle {} reaches ({}, {}, {}); corners must be finite "
                                 "and within {} m of height 0",
                                 t, p.x, p.y, p.z, kMaxHeight)};
      }
      box.add(p);
    }
  }
  return box;
}

std::optional<Error> check_size(const Box3d& box, double cell) {
  const double width = box.max.x - box.min.x, depth = box.max.z - box.min.z;
  const auto cells = [&](double side) { return (width / side + 1) * (depth / side + 1); };
  if (cells(cell) <= kMaxCells) return {};
  double enough = cell;
  while (cells(enough) > kMaxCells) enough *= 1.1;
  return Error{
      Errc::kLimit,
      fmt::format("slices: {:.0f} x {:.0f} m in cells of {} m are more than {:.0f} cells; use "
                  "cells of {:.2f} m, or bake level tiles, which have no such limit",
                  width, depth, cell, kMaxCells, enough)};
}

int32_t to_mm(double metres) { return static_cast<int32_t>(std::lround(metres * 1000)); }

std::vector<bake::CellTriangle> to_cells(const Scene& scene, const bake::Grid& grid,
                                         int32_t workers) {
  std::vector<bake::CellTriangle> triangles(scene.triangles.size());
  parallel_ranges(triangles.size(), 4096, workers, [&](size_t begin, size_t end) {
    for (size_t t = begin; t < end; ++t) {
      triangles[t] = bake::to_cell_triangle(scene, static_cast<uint32_t>(t), grid, 0);
    }
  });
  return triangles;
}

// Reports a stage from many threads, never from two at once.
class Counter {
 public:
  Counter(Context& context, std::string_view stage, uint64_t total)
      : context_(context), stage_(stage), total_(total) {}
  void add_one() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (context_.on_progress) context_.on_progress({stage_, done_, total_});
  }

 private:
  Context& context_;
  std::string_view stage_;
  uint64_t total_;
  uint64_t done_ = 0;
  std::mutex mutex_;
};

// Columns of all tiles that hold a solid, in order. `low` and `high` bound the scene: the
// rasteriser may add a millimetre, which must not reach beyond the world.
std::vector<papers::SliceTile> fill_tiles(std::span<const bake::CellTriangle> triangles,
                                          const bake::Grid& grid, int32_t low, int32_t high,
                                          int32_t workers, Context& context) {
  const bake::TriangleBins bins =
      bake::bin_triangles(triangles, 0, 0, grid.tiles_x(), grid.tiles_z(), bake::kTileSide, 0);
  const size_t count = bins.first.size() - 1;
  std::vector<papers::SliceTile> tiles(count);
  std::vector<std::unique_ptr<bake::TileColumns>> scratch(
      static_cast<size_t>(worker_count(workers)));
  Counter counter(context, "columns", count);
  parallel_for_worker(count, workers, [&](size_t i, int32_t worker) {
    const uint32_t begin = bins.first[i], end = bins.first[i + 1];
    if (begin != end && !context.cancel) {
      auto& columns = scratch[static_cast<size_t>(worker)];
      if (!columns) columns = std::make_unique<bake::TileColumns>();
      papers::SliceTile& tile = tiles[i];
      tile.tile_x = static_cast<int32_t>(i) % grid.tiles_x();
      tile.tile_z = static_cast<int32_t>(i) / grid.tiles_x();
      const int32_t x = tile.tile_x * bake::kTileSide, z = tile.tile_z * bake::kTileSide;
      const bake::TileRect rect{.x1 = std::min(bake::kTileSide, grid.width - x),
                                .z1 = std::min(bake::kTileSide, grid.depth - z)};
      bake::rasterise_tile(triangles, std::span(bins.items).subspan(begin, end - begin), x, z, rect,
                           0, *columns);
      bake::TileSpans spans;
      bake::sort_spans(*columns, spans);
      for (int32_t& v : spans.low) v = std::clamp(v, low, high);
      for (int32_t& v : spans.high) v = std::clamp(v, low, high);
      tile.first = std::move(spans.first);
      tile.low = std::move(spans.low);
      tile.high = std::move(spans.high);
    }
    counter.add_one();
  });
  std::erase_if(tiles, [](const papers::SliceTile& tile) { return tile.low.empty(); });
  return tiles;
}

}  // namespace

Result<SliceSet> slice_scene(const Scene& scene, const SliceConfig& config, Context& context) {
  if (auto error = check_config(config)) return *std::move(error);
  const Result<Box3d> box = check_scene(scene);
  if (!box) return box.error();
  if (auto error = check_size(*box, config.cell)) return *std::move(error);

  const bake::Grid grid = bake::make_grid(*box, config.cell, 0);
  papers::SweepConfig sweep{.width = grid.width,
                            .depth = grid.depth,
                            .avatar_height = to_mm(config.avatar_height),
                            .resolution = to_mm(config.resolution),
                            .min_y = static_cast<int32_t>(std::floor(bake::snap_mm(box->min.y))),
                            .max_y = static_cast<int32_t>(std::ceil(bake::snap_mm(box->max.y))),
                            .workers = config.workers};
  sweep.far_plane = sweep.min_y - sweep.resolution;  // eq. 2
  std::vector<papers::SliceTile> tiles;
  {
    const std::vector<bake::CellTriangle> triangles = to_cells(scene, grid, config.workers);
    tiles = fill_tiles(triangles, grid, sweep.min_y, sweep.max_y, config.workers, context);
  }
  if (context.cancel) return Error{Errc::kCancelled, "slices: cancelled"};

  Result<SliceSet> set = papers::sweep_slices(tiles, sweep, context);
  if (!set) return set;
  set->cell = grid.cell;
  set->origin_x = grid.origin_x;
  set->origin_z = grid.origin_z;
  return set;
}

}  // namespace throng
