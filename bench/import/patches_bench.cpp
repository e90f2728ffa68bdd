// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include "throng/scene.h"

namespace {

// Items are triangles. The tolerance is in millimetres.
void tessellate_patches(benchmark::State& state) {
  const auto scene = throng::create_builtin_world({.name = "landscape", .size = 640});
  if (!scene) return state.SkipWithError(scene.error().message.c_str());
  const throng::TessellationConfig config{.tolerance = static_cast<double>(state.range(0)) / 1000,
                                          .workers = static_cast<int32_t>(state.range(1))};
  throng::Context context;
  int64_t triangles = 0;
  for (auto _ : state) {
    const auto mesh = throng::tessellate_patches(scene->patches, config, context);
    if (!mesh) return state.SkipWithError(mesh.error().message.c_str());
    triangles += static_cast<int64_t>(mesh->triangles.size());
  }
  state.SetItemsProcessed(triangles);
}

BENCHMARK(tessellate_patches)
    ->ArgNames({"tolerance", "workers"})
    ->ArgsProduct({{20, 200}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
