// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "throng/bake.h"
#include "throng/path.h"
#include "throng/scene.h"
#include "voxel_oracle.h"

// Moving AI's voxel maps and their queries: our paths' lengths beside the published ones, which
// keep to 26 directions, and, for a sample, beside a brute-force any-angle search's; and the time
// of a query.
namespace throng::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string map;
  int runs = 1;
  int sample = 50;     // queries that the oracle checks
  size_t most = 3000;  // corners that it expands for one
};

struct Query {
  int32_t from[3], to[3];
  double published = 0;  // length over 26 directions [voxels]
  double length = 0;     // ours
  bool reached = false;
};

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "bench_voxel_maps: {}\n", message);
  std::exit(2);
}

std::vector<Query> read_queries(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::vector<Query> queries;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    Query q{};
    if (words >> q.from[0] >> q.from[1] >> q.from[2] >> q.to[0] >> q.to[1] >> q.to[2] >>
        q.published) {
      queries.push_back(q);
    }
  }
  if (queries.empty()) stop(path + ": no queries in it");
  return queries;
}

Vec3d middle_of(const int32_t (&v)[3]) { return {v[0] + 0.5, v[1] + 0.5, v[2] + 0.5}; }

double at_share(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<size_t>(share * static_cast<double>(values.size())))];
}

bool is_legal(const test::VoxelOracle& oracle, const Path& path) {
  for (size_t i = 1; i < path.points.size(); ++i) {
    if (!oracle.is_clear(path.points[i - 1].position, path.points[i].position)) return false;
  }
  return true;
}

Json judge(const test::VoxelOracle& oracle, const std::vector<Query>& queries,
           const Options& options) {
  const size_t every =
      std::max<size_t>(1, queries.size() / static_cast<size_t>(std::max(1, options.sample)));
  int judged = 0, budget_exhausted = 0, shorter = 0;
  double sum = 0, worst = 0;
  for (size_t i = every / 2; i < queries.size() && options.sample > 0; i += every) {
    const Query& q = queries[i];
    if (!q.reached) continue;
    const auto best = oracle.shortest(test::middle(q.from[0], q.from[1], q.from[2]),
                                      test::middle(q.to[0], q.to[1], q.to[2]),
                                      q.length * 1.001 + 0.01, options.most);
    if (best.budget_exhausted) {
      ++budget_exhausted;
      continue;
    }
    ++judged;
    // No path over corners is within a thousandth of ours: ours is shorter than that.
    const double ratio = best.length ? q.length / *best.length : 1 / 1.001;
    shorter += best.length ? 0 : 1;
    sum += ratio;
    worst = std::max(worst, ratio);
  }
  return {{"judged", judged},
          {"given_up", budget_exhausted},
          {"shorter_than_over_corners", shorter},
          {"mean_ratio", judged > 0 ? sum / judged : 0},
          {"worst_ratio", worst}};
}

Json measure(const Options& options) {
  const auto cells = load_voxel_map(options.map);
  if (!cells) stop(cells.error().message);
  const auto world = bake_voxel_cells(*cells, 1);
  if (!world) stop(world.error().message);
  Context context;
  auto finder = PathFinder::create(*world, {.space = PathSpace::kAir}, context);
  if (!finder) stop(finder.error().message);
  const test::VoxelOracle oracle(*cells);
  std::vector<Query> queries = read_queries(options.map + ".3dscen");
  Path path;
  int reached = 0, longer = 0, illegal = 0;
  double by_published = 0, nodes = 0;
  for (Query& q : queries) {
    finder->find({.from = middle_of(q.from), .to = middle_of(q.to)}, path);
    q.reached = path.end == PathEnd::kReached;
    q.length = path.length;
    if (!q.reached) continue;
    ++reached;
    nodes += static_cast<double>(path.nodes);
    by_published += q.published > 0 ? q.length / q.published : 1;
    longer += q.length > q.published + 1e-3 ? 1 : 0;
    illegal += is_legal(oracle, path) ? 0 : 1;
  }
  std::vector<double> times(queries.size(), 1e300);
  for (int run = 0; run < options.runs; ++run) {
    for (size_t i = 0; i < queries.size(); ++i) {
      const Query& q = queries[i];
      const auto start = std::chrono::steady_clock::now();
      finder->find({.from = middle_of(q.from), .to = middle_of(q.to)}, path);
      // The shortest of the runs: what the others took more was not the query's.
      times[i] =
          std::min(times[i],
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
  }
  double total = 0;
  for (const double t : times) total += t;
  const PathSummary summary = finder->summary();
  const auto air = air_summary(*world);
  if (!air) stop(air.error().message);
  return {{"map", options.map},
          {"voxels", cells->filled.size()},
          {"queries", queries.size()},
          {"reached", reached},
          {"illegal", illegal},
          {"longer_than_published", longer},
          {"length_by_published", by_published / std::max(1, reached)},
          {"oracle", judge(oracle, queries, options)},
          {"median_ms", at_share(times, 0.5) * 1e3},
          {"mean_ms", total / static_cast<double>(times.size()) * 1e3},
          {"p99_ms", at_share(times, 0.99) * 1e3},
          {"worst_ms", at_share(times, 1) * 1e3},
          {"mean_nodes", nodes / std::max(1, reached)},
          {"file_bytes", air->bytes},
          {"boxes", summary.boxes},
          {"bytes", summary.bytes},
          {"make_seconds", summary.seconds}};
}

}  // namespace
}  // namespace throng::bench

int main(int argc, char** argv) {
  throng::bench::Options options;
  CLI::App parser("Runs the queries of a voxel map of Moving AI's benchmarks");
  parser
      .add_option("map", options.map, "Voxel map (.3dmap), its queries beside it (.3dmap.3dscen)")
      ->required();
  parser.add_option("--runs", options.runs, "Times each query is timed: the shortest counts")
      ->check(CLI::Range(1, 100));
  parser.add_option("--sample", options.sample, "Queries that the oracle is asked");
  parser.add_option("--most", options.most, "Corners that the oracle looks at for one");
  CLI11_PARSE(parser, argc, argv);
  fmt::print("{}\n", throng::bench::measure(options).dump(2));
  return 0;
}
