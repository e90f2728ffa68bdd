// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// What it takes to keep a model's floors in full grids of slices, in sparse slices and in level
// tiles: bytes, and the time of a look-up by a body that knows where it is. Prints a JSON object.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/access.h"
#include "core/random.h"
#include "crowd/ground/crowd_ground.h"
#include "papers/slices/slice_ground.h"
#include "papers/slices/sparse_slices.h"
#include "throng/bake.h"
#include "throng/papers.h"
#include "throng/scene.h"
#include "world/place.h"

namespace {

using namespace throng;
using Json = nlohmann::ordered_json;

struct Options {
  std::string model;
  std::string up;
  double scale = 0, cell = 0.1;
  uint64_t lookups = 4'000'000;
  int32_t threads = 0;
};

// A body of 1.75 m that stands somewhere: its cell, its feet, and a cell beside it.
struct Question {
  int32_t x, z, feet, next_x;
};

constexpr int32_t kHead = 1750, kStep = 400;  // [mm]

// Standing places, at random over all slices; in an order that walks over each storey row by row if
// they are `near` each other.
std::vector<Question> questions(const DepthSlices& slices, const papers::SliceGround& ground,
                                uint64_t count, bool near) {
  std::vector<Question> out;
  const uint64_t cells = uint64_t(slices.width) * uint64_t(slices.depth);
  uint64_t at = 0;
  const uint64_t tries = count * 2000;
  for (uint64_t k = 0; k < tries && out.size() < count; ++k) {
    const uint64_t all = cells * slices.slices.size();
    at = near && k % 64 != 0 ? (at + 1) % all : random_below(1, near ? 1 : 0, k, all);
    const size_t slice = at / cells, cell = at % cells;
    if (slices.slices[slice].depths[cell] == DepthSlice::kNone) continue;
    const int32_t feet = slices.slices[slice].surface(cell);
    if (ground.slice_above(feet + kHead) != slice) continue;
    const auto x = static_cast<int32_t>(cell % uint64_t(slices.width));
    if (x + 1 >= slices.width) continue;
    out.push_back({x, static_cast<int32_t>(cell / uint64_t(slices.width)), feet, x + 1});
  }
  return out;
}

// Nanoseconds a question of the fastest of five passes. `answer` returns a floor, summed up so that
// nothing is left out.
template <class Answer>
double time_of(const std::vector<Question>& questions, int64_t& sum, Answer answer) {
  double best = 1e300;
  for (int pass = 0; pass < 5; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    for (const Question& q : questions) sum += answer(q);
    const double ns =
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
    best = std::min(best, ns / static_cast<double>(questions.size()));
  }
  return best;
}

Json measure(const Options& o) {
  Context context;
  SceneSource source{.path = o.model, .up = {}, .scale = {}, .transform = {}};
  if (!o.up.empty()) source.up = o.up[0];
  if (o.scale > 0) source.scale = o.scale;
  BuiltinWorldConfig builtin;
  builtin.name = o.model.substr(o.model.find(':') + 1);
  const bool is_builtin = o.model.rfind("builtin:", 0) == 0;
  SceneConfig scene_config;
  scene_config.sources = {source};
  const Result<Scene> scene =
      is_builtin ? create_builtin_world(builtin) : load_scene(scene_config, context);
  if (!scene) return {{"error", scene.error().message}};
  SliceConfig config;
  config.cell = o.cell;
  config.workers = o.threads;
  const Result<SliceSet> cut = slice_scene(*scene, config, context);
  if (!cut) return {{"error", cut.error().message}};
  const DepthSlices slices = *store_depths(*cut);
  const papers::SliceGround dense(slices);
  const papers::SparseSlices sparse(slices);
  BakeConfig bake;
  bake.cell = o.cell;
  bake.workers = o.threads;
  bake.classes = {AvatarClass{}};
  const Result<World> world = bake_world(*scene, bake, context);
  if (!world) return {{"error", world.error().message}};
  const auto& data = *data_of(*world);
  const auto ground = crowd::CrowdGround::create(data, 0, kStep);
  if (!ground) return {{"error", ground.error().message}};

  Json json = {{"model", o.model},
               {"cell", o.cell},
               {"slices", slices.slices.size()},
               {"dense_bytes", slices.bytes()},
               {"sparse_bytes", sparse.bytes()},
               {"level_bytes", ground->bytes()}};
  int64_t sum = 0;
  const double dx = slices.origin_x - data.summary.origin.x,
               dz = slices.origin_z - data.summary.origin.z;
  const auto shift_x = static_cast<int32_t>(std::lround(dx / o.cell)),
             shift_z = static_cast<int32_t>(std::lround(dz / o.cell));
  for (const bool near : {false, true}) {
    const std::vector<Question> asked = questions(slices, dense, o.lookups, near);
    const std::string suffix = near ? "_near" : "_random";
    json["lookups" + suffix] = asked.size();
    json["dense_ns" + suffix] = time_of(asked, sum, [&](const Question& q) {
      const DepthSlice& slice = slices.slices[dense.slice_above(q.feet + kHead)];
      const uint16_t depth = slice.depths[dense.cell(q.next_x, q.z)];
      return depth == DepthSlice::kNone ? 0 : slice.height - depth;
    });
    json["sparse_ns" + suffix] = time_of(asked, sum, [&](const Question& q) {
      return sparse.surface(dense.slice_above(q.feet + kHead), q.next_x, q.z);
    });
    json["level_ns" + suffix] = time_of(asked, sum, [&](const Question& q) {
      const int32_t x = q.next_x + shift_x, z = q.z + shift_z;
      int32_t found = 0;
      ground->for_tile(world::tile_along(x), world::tile_along(z), q.feet - kStep, q.feet + kStep,
                       [&](uint32_t level) {
                         const int32_t in_x = world::in_tile(x), in_z = world::in_tile(z);
                         if (!ground->is_legal(level, in_x, in_z)) return;
                         const int32_t feet = ground->sample(level, in_x, in_z);
                         if (std::abs(feet - q.feet) <= kStep) found = feet;
                       });
      return found;
    });
  }
  json["sum"] = sum;
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Bytes and look-up times of slices, full and sparse, and of level tiles");
  Options options;
  app.add_option("model", options.model, "A model, or builtin:NAME")->required();
  app.add_option("--cell", options.cell, "Side of a cell [m]")->capture_default_str();
  app.add_option("--up", options.up, "Axis of the model: y or z");
  app.add_option("--scale", options.scale, "Metres a unit");
  app.add_option("--lookups", options.lookups, "How many")->capture_default_str();
  app.add_option("--threads", options.threads, "0: all")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const Json json = measure(options);
  std::printf("%s\n", json.dump().c_str());
  return json.contains("error") ? 2 : 0;
}
