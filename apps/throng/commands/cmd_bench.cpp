// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "command.h"
#include "number_checks.h"
#include "throng/bake.h"
#include "throng/papers.h"
#include "throng/scene.h"

// throng bench: times bakes of built-in worlds and crowds of several sizes on this machine, on one
// thread and on several.
namespace throng::app {
namespace {

struct BenchOptions {
  double cell = 0.1;
  int32_t threads = 2;
  uint64_t runs = 3;
  uint64_t steps = 50;
  uint32_t avatars = 100'000;  // The largest crowd.
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Times are medians. [s]
struct BakeRow {
  BuiltinWorldConfig world;
  uint64_t triangles = 0;
  BakeReport report;
  double one = 0;
  double several = 0;
};

Result<BakeRow> bench_bake(const BuiltinWorldConfig& world, const BenchOptions& options,
                           Context& context) {
  const Result<Scene> scene = create_builtin_world(world);
  if (!scene) return scene.error();
  BakeRow row{.world = world, .triangles = scene->triangles.size(), .report = {}};
  std::vector<double> one;
  std::vector<double> several;
  for (uint64_t run = 0; run < options.runs; ++run) {
    for (const int32_t workers : {1, options.threads}) {
      const Result<World> baked =
          bake_world(*scene, {.cell = options.cell, .workers = workers}, context, &row.report);
      if (!baked) return baked.error();
      (workers == 1 ? one : several).push_back(row.report.seconds_total);
    }
  }
  row.one = median(one);
  row.several = options.threads == 1 ? row.one : median(several);
  return row;
}

struct CrowdRow {
  uint32_t avatars = 0;
  double one = 0;      // [ns] an avatar a step
  double several = 0;  // [ns]
  bool same = false;   // State hashes agree.
};

// A garage with four square metres for each avatar, so that rows differ in size, not in density.
BuiltinWorldConfig garage_for(uint32_t avatars) {
  BuiltinWorldConfig world{.name = "garage", .levels = 4};
  world.size = std::max(60.0, std::ceil(std::sqrt(avatars)));
  return world;
}

Result<CrowdRow> bench_crowd(const World& world, uint32_t avatars, const BenchOptions& options,
                             Context& context) {
  CrowdRow row{.avatars = avatars};
  std::vector<uint64_t> hashes;
  for (const int32_t workers : {1, options.threads}) {
    Result<Wanderers> crowd = Wanderers::create(world, {.avatars = avatars, .workers = workers});
    if (!crowd) return crowd.error();
    std::vector<double> seconds;
    for (uint64_t step = 0; step < options.steps; ++step) {
      seconds.push_back(crowd->step().seconds_total);
      if (context.cancel) return Error{Errc::kCancelled, "bench: interrupted"};
    }
    (workers == 1 ? row.one : row.several) = median(seconds) * 1e9 / avatars;
    hashes.push_back(crowd->state_hash());
  }
  if (options.threads == 1) row.several = row.one;
  row.same = hashes.front() == hashes.back();
  return row;
}

Json bakes_json(const std::vector<BakeRow>& rows) {
  Json json = Json::array();
  for (const BakeRow& row : rows) {
    const double area = row.report.walkable_area.front();
    json.push_back({{"world", row.world.name},
                    {"triangles", row.triangles},
                    {"seconds_1", row.one},
                    {"seconds_n", row.several},
                    {"ratio", row.one / row.several},
                    {"triangles_per_second", static_cast<double>(row.triangles) / row.several},
                    {"walkable_m2", area},
                    {"bytes", row.report.bytes},
                    {"bytes_per_m2", area > 0 ? static_cast<double>(row.report.bytes) / area : 0}});
  }
  return json;
}

Json crowds_json(const std::vector<CrowdRow>& rows) {
  Json json = Json::array();
  for (const CrowdRow& row : rows) {
    json.push_back({{"avatars", row.avatars},
                    {"ns_per_avatar_step_1", row.one},
                    {"ns_per_avatar_step_n", row.several},
                    {"ratio", row.one / row.several},
                    {"same_state", row.same}});
  }
  return json;
}

std::string bench_text(const std::vector<BakeRow>& bakes, const std::vector<CrowdRow>& crowds,
                       int32_t threads) {
  std::string text =
      fmt::format("{:<12} {:>10} {:>12} {:>12} {:>7} {:>10}\n", "bake", "triangles", "1 thread",
                  fmt::format("{} threads", threads), "ratio", "bytes/m2");
  for (const BakeRow& row : bakes) {
    const double area = std::max(1e-9, row.report.walkable_area.front());
    text += fmt::format("{:<12} {:>10} {:>9.1f} ms {:>9.1f} ms {:>7.2f} {:>10.1f}\n",
                        row.world.name, row.triangles, row.one * 1e3, row.several * 1e3,
                        row.one / row.several, static_cast<double>(row.report.bytes) / area);
  }
  text += fmt::format("\n{:<12} {:>12} {:>12} {:>7} {:>12}\n", "avatars", "1 thread",
                      fmt::format("{} threads", threads), "ratio", "same state");
  for (const CrowdRow& row : crowds) {
    text += fmt::format("{:<12} {:>9.1f} ns {:>9.1f} ns {:>7.2f} {:>12}\n", row.avatars, row.one,
                        row.several, row.one / row.several, row.same ? "yes" : "NO");
  }
  return text;
}

int bench(Session& session, const BenchOptions& options) {
  const std::vector<BuiltinWorldConfig> worlds = {
      {.name = "cube"}, {.name = "garage"}, {.name = "church"}, {.name = "city", .size = 200}};
  std::vector<BakeRow> bakes;
  for (const BuiltinWorldConfig& world : worlds) {
    Result<BakeRow> row = bench_bake(world, options, session.context);
    if (!row) return fail(row.error());
    bakes.push_back(*std::move(row));
  }
  std::vector<CrowdRow> crowds;
  bool same = true;
  for (uint32_t avatars = 1000; avatars <= options.avatars; avatars *= 10) {
    const Result<Scene> scene = create_builtin_world(garage_for(avatars));
    if (!scene) return fail(scene.error());
    const Result<World> world =
        bake_world(*scene, {.cell = options.cell, .classes = {AvatarClass{}}}, session.context);
    if (!world) return fail(world.error());
    const Result<CrowdRow> row = bench_crowd(*world, avatars, options, session.context);
    if (!row) return fail(row.error());
    crowds.push_back(*row);
    same = same && row->same;
  }
  print_result(session,
               {{"cell", options.cell},
                {"threads", options.threads},
                {"bake", bakes_json(bakes)},
                {"crowd", crowds_json(crowds)}},
               bench_text(bakes, crowds, options.threads));
  return same ? kDone : kAnswerIsNo;
}

}  // namespace

void add_bench(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "bench", "Time bakes and crowds on this machine",
                                  "throng bench --cell 0.2 --avatars 1000 --steps 10 --runs 1");
  const auto options = std::make_shared<BenchOptions>();
  command->add_option("--cell", options->cell, "Side of a cell [m]")->capture_default_str();
  add_threads(*command, options->threads, "Compare one thread with this many")
      ->check(above(0))
      ->capture_default_str();
  command->add_option("--runs", options->runs, "Bakes of each world")
      ->check(above(0))
      ->capture_default_str();
  command->add_option("--steps", options->steps, "Steps of each crowd")
      ->check(above(0))
      ->capture_default_str();
  command->add_option("--avatars", options->avatars, "Largest crowd (1000, 10000 ... up to this)")
      ->check(between(1000, 100'000'000))
      ->capture_default_str();
  command->callback([&session, options] { session.exit_code = bench(session, *options); });
}

}  // namespace throng::app
