// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <vector>

#include "bake/columns/free_spans.h"
#include "throng/scene.h"

namespace {

using namespace throng;

// A built-in world cut into tiles, one of which after the other is rasterised.
struct Tiles {
  bake::Grid grid;
  std::vector<bake::CellTriangle> triangles;
  bake::TriangleBins bins;

  explicit Tiles(const Scene& scene)
      : grid(bake::make_grid(scene.bounds(), 0.1, bake::kGridPhase)) {
    const std::vector<AvatarClass> classes = default_classes();
    const bake::SurfaceCoder coder(scene, classes, false, 1);
    for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
      triangles.push_back(bake::to_cell_triangle(scene, t, grid, coder.code(t)));
    }
    bins = bake::bin_triangles(triangles, 0, 0, grid.tiles_x(), grid.tiles_z(), bake::kTileSide, 0);
  }

  void rasterise(size_t tile, bake::TileColumns& columns) const {
    const auto index = static_cast<int32_t>(tile);
    bake::rasterise_tile(
        triangles, {bins.items.data() + bins.first[tile], bins.first[tile + 1] - bins.first[tile]},
        index % bins.squares_x * bake::kTileSide, index / bins.squares_x * bake::kTileSide, {}, 500,
        columns);
  }
};

// Items are cells.
void rasterise(benchmark::State& state, const char* name) {
  const auto scene = create_builtin_world({.name = name});
  if (!scene) return state.SkipWithError(scene.error().message.c_str());
  const Tiles tiles(*scene);
  bake::TileColumns columns;
  for (auto _ : state) {
    for (size_t tile = 0; tile + 1 < tiles.bins.first.size(); ++tile) {
      tiles.rasterise(tile, columns);
      benchmark::DoNotOptimize(columns.depth.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * (static_cast<int64_t>(tiles.bins.first.size()) - 1) *
                          bake::kTileArea);
}

void rasterise_and_find_free_spans(benchmark::State& state, const char* name) {
  const auto scene = create_builtin_world({.name = name});
  if (!scene) return state.SkipWithError(scene.error().message.c_str());
  const Tiles tiles(*scene);
  bake::TileColumns columns;
  bake::TileFreeSpans free_spans;
  for (auto _ : state) {
    for (size_t tile = 0; tile + 1 < tiles.bins.first.size(); ++tile) {
      tiles.rasterise(tile, columns);
      bake::find_free_spans(columns, 500, free_spans);
      benchmark::DoNotOptimize(free_spans.count.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * (static_cast<int64_t>(tiles.bins.first.size()) - 1) *
                          bake::kTileArea);
}

BENCHMARK_CAPTURE(rasterise, garage, "garage");
BENCHMARK_CAPTURE(rasterise, stairs, "stairs");
BENCHMARK_CAPTURE(rasterise_and_find_free_spans, garage, "garage");
BENCHMARK_CAPTURE(rasterise_and_find_free_spans, stairs, "stairs");

}  // namespace
