// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include "throng/papers.h"
#include "throng/scene.h"

namespace {

// Items are cells of slices taken, kept or not.
void slice_scene(benchmark::State& state, const char* name) {
  const auto scene = throng::create_builtin_world({.name = name});
  if (!scene) return state.SkipWithError(scene.error().message.c_str());
  throng::Context context;
  int64_t cells = 0;
  for (auto _ : state) {
    const auto slices =
        throng::slice_scene(*scene, {.workers = static_cast<int32_t>(state.range(0))}, context);
    if (!slices) return state.SkipWithError(slices.error().message.c_str());
    cells += int64_t{slices->width} * slices->depth * slices->taken;
  }
  state.SetItemsProcessed(cells);
}

BENCHMARK_CAPTURE(slice_scene, cube, "cube")->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(slice_scene, garage, "garage")->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(slice_scene, church, "church")->Arg(1)->Arg(2)->UseRealTime();

}  // namespace
