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

#include "grid_oracle.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/scene.h"

// Moving AI's grid maps and their scenarios: our paths' lengths beside the published ones, which
// keep to eight directions, and, for a sample, beside a brute-force search's; and the time of a
// query.
namespace throng::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string map, scenario;
  int runs = 3;
  int sample = 100;  // queries that the oracle judges
  bool labels = false;
};

struct Query {
  int32_t from_x, from_z, to_x, to_z;
  double octile = 0;  // length over eight directions [cells]
  double length = 0;  // ours
  bool reached = false;
};

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "bench_grid_maps: {}\n", message);
  std::exit(2);
}

std::vector<Query> read_scenario(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::vector<Query> queries;
  std::getline(file, line);  // "version 1"
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string bucket, map;
    int width = 0, depth = 0;
    Query q{};
    if (words >> bucket >> map >> width >> depth >> q.from_x >> q.from_z >> q.to_x >> q.to_z >>
        q.octile) {
      queries.push_back(q);
    }
  }
  if (queries.empty()) stop(path + ": no queries in it");
  return queries;
}

Place middle_of(const World& world, int32_t x, int32_t z) {
  return world.find_place(0, {x + 0.5, 0, z + 0.5}, 0.5);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// The oracle's result for every (count / sample)-th query: a shorter path, and illegal segments.
Json judge(const FlatCells& cells, const std::vector<Query>& queries, int sample) {
  const test::GridOracle oracle(cells);
  const size_t every =
      std::max<size_t>(1, queries.size() / static_cast<size_t>(std::max(1, sample)));
  double ratios = 0, worst = 0;
  int judged = 0, none = 0;
  for (size_t i = every / 2; i < queries.size(); i += every) {
    const Query& q = queries[i];
    if (!q.reached) continue;
    // The ellipse of all paths that are not longer than ours: the shortest of them is the optimum.
    const auto best = oracle.shortest(test::middle(q.from_x, q.from_z),
                                      test::middle(q.to_x, q.to_z), q.length * (1 + 1e-9) + 1e-9);
    if (!best) {
      ++none;  // Ours would be shorter than the optimum: it cuts through something.
      continue;
    }
    ++judged;
    const double ratio = *best > 0 ? q.length / *best : 1;
    ratios += ratio;
    worst = std::max(worst, ratio);
  }
  return {{"judged", judged},
          {"shorter_than_the_optimum", none},
          {"mean_ratio", judged > 0 ? ratios / judged : 0},
          {"worst_ratio", worst}};
}

Json measure(const Options& options) {
  const auto cells = load_grid_map(options.map);
  if (!cells) stop(cells.error().message);
  const auto world = bake_flat_cells(*cells, 1);
  if (!world) stop(world.error().message);
  Context context;
  auto finder = PathFinder::create(
      *world, {.speedup = options.labels ? PathSpeedup::kLabels : PathSpeedup::kNone}, context);
  if (!finder) stop(finder.error().message);
  std::vector<Query> queries = read_scenario(options.scenario);
  std::vector<std::pair<Place, Place>> ends;
  for (const Query& q : queries) {
    ends.push_back({middle_of(*world, q.from_x, q.from_z), middle_of(*world, q.to_x, q.to_z)});
  }
  Path path;
  double shorter = 0;
  int reached = 0, longer = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    finder->find(ends[i].first, ends[i].second, path);
    Query& q = queries[i];
    q.reached = path.end == PathEnd::kReached;
    q.length = path.length;
    if (!q.reached) continue;
    ++reached;
    shorter += q.octile > 0 ? q.length / q.octile : 1;
    if (q.length > q.octile + 1e-3) ++longer;
  }
  std::vector<double> means, times(queries.size());
  for (int run = 0; run < options.runs; ++run) {
    double total = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
      const auto start = std::chrono::steady_clock::now();
      finder->find(ends[i].first, ends[i].second, path);
      times[i] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      total += times[i];
    }
    means.push_back(total / static_cast<double>(queries.size()));
  }
  const PathSummary summary = finder->summary();
  return {{"map", options.map},
          {"queries", queries.size()},
          {"reached", reached},
          {"longer_than_octile", longer},
          {"length_by_octile", shorter / std::max(1, reached)},
          {"oracle", judge(*cells, queries, options.sample)},
          {"mean_ms", median(means) * 1e3},
          {"median_ms", median(times) * 1e3},
          {"worst_ms", *std::max_element(times.begin(), times.end()) * 1e3},
          {"rectangles", summary.rectangles},
          {"bytes", summary.bytes},
          {"make_seconds", summary.seconds}};
}

}  // namespace
}  // namespace throng::bench

int main(int argc, char** argv) {
  throng::bench::Options options;
  CLI::App parser("Runs the scenarios of a grid map of Moving AI's benchmarks");
  parser.add_option("map", options.map, "Grid map (.map)")->required();
  parser.add_option("scenario", options.scenario, "Its queries (.scen)")->required();
  parser.add_option("--runs", options.runs, "Times each query is timed")->check(CLI::Range(1, 100));
  parser.add_option("--sample", options.sample, "Queries that the oracle judges");
  parser.add_flag("--labels", options.labels, "Look paths up instead of searching");
  CLI11_PARSE(parser, argc, argv);
  fmt::print("{}\n", throng::bench::measure(options).dump(2));
  return 0;
}
