// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <vector>

#include "core/random.h"
#include "throng/impostor.h"

// A million avatars of a square city, seen from above (all are in the picture) and from the street
// (few are).
namespace throng {
namespace {

void pack_impostors(benchmark::State& state) {
  const auto count = static_cast<size_t>(state.range(0));
  const bool overview = state.range(1) != 0;
  std::vector<float> x(count), y(count), z(count);
  std::vector<uint16_t> heading(count), phase(count), look(count);
  for (size_t i = 0; i < count; ++i) {
    x[i] = static_cast<float>(random_unit(1, i, 0) * 2000 - 1000);
    z[i] = static_cast<float>(random_unit(1, i, 1) * 2000 - 1000);
    heading[i] = static_cast<uint16_t>(random_u64(1, i, 2));
    phase[i] = static_cast<uint16_t>(random_u64(1, i, 3));
    look[i] = static_cast<uint16_t>(random_below(1, i, 4, 2048));
  }
  Atlas atlas;
  atlas.shape = {.pixels = 64,
                 .directions = 16,
                 .elevations = 8,
                 .frames = 10,
                 .side = 2.07,
                 .centre = 0.875,
                 .height = 1.75};
  atlas.clips = {{.name = "Walk", .first_frame = 0, .frames = 10, .seconds = 1, .stride = 1.5}};
  PackConfig config;
  config.camera.eye = overview ? Vec3d{0, 1800, 1800} : Vec3d{0, 1.7, 0};
  config.camera.target = overview ? Vec3d{0, 0, 0} : Vec3d{0, 1.5, -10};
  config.workers = static_cast<int32_t>(state.range(2));
  std::vector<ImpostorInstance> out(count);
  size_t seen = 0;
  for (auto _ : state) {
    seen = pack_impostors(atlas, {x, y, z, heading, phase, look}, config, out);
    benchmark::DoNotOptimize(out.data());
  }
  state.counters["seen"] = static_cast<double>(seen);
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(count));
}

BENCHMARK(pack_impostors)
    ->ArgNames({"avatars", "overview", "workers"})
    ->ArgsProduct({{100000, 1000000}, {0, 1}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace throng
