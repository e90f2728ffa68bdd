// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <vector>

#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"

// Steps of a crowd on level ground and on a slope, which slows avatars or does not: what it takes
// to read the slope, beside the step. On level ground it must take no time.
namespace {

void step_on_slope(benchmark::State& state) {
  constexpr double kSize = 200;                             // [m]
  constexpr uint32_t kAvatars = 10'000;                     // 4 m2 each
  const double top = state.range(0) != 0 ? kSize / 12 : 0;  // [m]
  throng::Context context;
  throng::Scene scene;
  scene.positions = {{0, 0, 0}, {0, 0, kSize}, {kSize, top, kSize}, {kSize, top, 0}};
  scene.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto world = throng::bake_world(scene, {}, context);
  if (!world) return state.SkipWithError(world.error().message.c_str());
  auto crowd = throng::Crowd::create(*world, {.workers = 1, .slow_on_slopes = state.range(1) != 0});
  if (!crowd) return state.SkipWithError(crowd.error().message.c_str());
  const auto ids = crowd->scatter(kAvatars, {}, context);
  if (!ids) return state.SkipWithError(ids.error().message.c_str());
  std::vector<throng::Place> goals;
  for (uint64_t n = 0; n < kAvatars; ++n) goals.push_back(world->random_place(0, 1, n));
  crowd->set_goals(*ids, goals);
  for (int step = 0; step < 20; ++step) crowd->step();
  uint64_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(crowd->step());
    state.PauseTiming();
    const std::vector<throng::AvatarId> arrived(crowd->arrived().begin(), crowd->arrived().end());
    goals.clear();
    while (goals.size() < arrived.size()) goals.push_back(world->random_place(0, 2, next++));
    crowd->set_goals(arrived, goals);
    state.ResumeTiming();
  }
  state.SetItemsProcessed(state.iterations() * kAvatars);
}

BENCHMARK(step_on_slope)->ArgNames({"slope", "slow"})->ArgsProduct({{0, 1}, {0, 1}});

}  // namespace
