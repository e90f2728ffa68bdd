// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include "throng/bake.h"
#include "throng/scene.h"

namespace {

// Whole bakes in memory; items are square metres of ground plan.
void bake_world(benchmark::State& state, const char* name, double size) {
  const auto scene = throng::create_builtin_world({.name = name, .size = size});
  if (!scene) return state.SkipWithError(scene.error().message.c_str());
  const throng::BakeConfig config{.cell = 0.1, .workers = static_cast<int32_t>(state.range(0))};
  throng::Context context;
  for (auto _ : state) benchmark::DoNotOptimize(throng::bake_world(*scene, config, context));
  const throng::Vec3d extent = scene->bounds().max - scene->bounds().min;
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(extent.x * extent.z));
}

BENCHMARK_CAPTURE(bake_world, stairs, "stairs", 0)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(bake_world, garage, "garage", 0)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(bake_world, church, "church", 0)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK_CAPTURE(bake_world, city, "city", 200)->Arg(1)->Arg(2)->UseRealTime();

}  // namespace
