// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "throng/bake.h"
#include "throng/papers.h"
#include "throng/scene.h"

// Steps of wanderers, and the moves that they make.
namespace {

// Whole steps in a garage of four storeys with about four square metres per avatar; items are
// avatars.
void wander_step(benchmark::State& state) {
  const auto avatars = static_cast<uint32_t>(state.range(0));
  const double size = std::max(60.0, std::ceil(std::sqrt(avatars * 4 / 2.75)));
  const auto scene = throng::create_builtin_world({.name = "garage", .size = size, .levels = 4});
  if (!scene) return state.SkipWithError(scene.error().message.c_str());
  throng::Context context;
  const auto world =
      throng::bake_world(*scene, {.cell = 0.1, .classes = {throng::AvatarClass{}}}, context);
  if (!world) return state.SkipWithError(world.error().message.c_str());
  auto crowd = throng::Wanderers::create(
      *world, {.avatars = avatars, .workers = static_cast<int32_t>(state.range(1))});
  if (!crowd) return state.SkipWithError(crowd.error().message.c_str());
  for (auto _ : state) benchmark::DoNotOptimize(crowd->step());
  state.SetItemsProcessed(state.iterations() * avatars);
}

BENCHMARK(wander_step)
    ->ArgNames({"avatars", "workers"})
    ->ArgsProduct({{1000, 10000, 100000}, {1, 2}})
    ->UseRealTime();

// Straight moves of one body, tested cell by cell; items are moves.
void world_move(benchmark::State& state) {
  const auto scene = throng::create_builtin_world({.name = "garage"});
  if (!scene) return state.SkipWithError(scene.error().message.c_str());
  throng::Context context;
  const auto world = throng::bake_world(*scene, {.cell = 0.1}, context);
  if (!world) return state.SkipWithError(world.error().message.c_str());
  const double distance = static_cast<double>(state.range(0)) * 0.1;
  uint64_t n = 0;
  throng::Place place = world->random_place(0, 1, n);
  for (auto _ : state) {
    const throng::MoveResult move = world->move(0, place, distance, distance / 2);
    place = move.end == throng::MoveEnd::kArrived ? move.place : world->random_place(0, 1, ++n);
    benchmark::DoNotOptimize(place);
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK(world_move)->ArgName("decimetres")->Arg(1)->Arg(10);

}  // namespace
