// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <vector>

#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"

// One obstacle that comes and goes, and a step, while others stand elsewhere: the time must not
// depend on how many these are.
namespace {

using throng::Prism;

Prism crate(double x, double z) { return Prism::box({x, 0, z}, {x + 0.5, 2, z + 0.5}); }

void obstacle_comes_and_goes(benchmark::State& state) {
  constexpr double kSize = 200;  // [m]
  throng::Context context;
  throng::Scene scene;
  scene.positions = {{0, 0, 0}, {0, 0, kSize}, {kSize, 0, kSize}, {kSize, 0, 0}};
  scene.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto world = throng::bake_world(scene, {}, context);
  if (!world) return state.SkipWithError(world.error().message.c_str());
  throng::Edits edits;
  auto crowd = throng::Crowd::create(*world, {.workers = 1, .edits = edits});
  if (!crowd) return state.SkipWithError(crowd.error().message.c_str());
  const std::vector<throng::AvatarSpawn> spawns = {{world->find_place(0, {1, 0, 1}, 1)}};
  if (!crowd->add(spawns, context)) return state.SkipWithError("no avatar");
  for (int i = 0; i < state.range(0); ++i) {
    if (!edits.add_obstacle(crate(1.5 * (i % 128) + 5, 1.5 * static_cast<double>(i / 128) + 5)))
      return state.SkipWithError("no obstacle");
  }
  (void)crowd->step();  // They come up.
  for (auto _ : state) {
    const auto id = edits.add_obstacle(crate(3, 3));
    benchmark::DoNotOptimize(crowd->step());
    edits.remove(*id);
    benchmark::DoNotOptimize(crowd->step());
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK(obstacle_comes_and_goes)->ArgName("stand")->Arg(1024)->Arg(4096)->Arg(8192);

}  // namespace
