// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "throng/path.h"
#include "throng/world.h"

// Long paths over a large baked world, by zones: their time by distance, and how much longer than
// the shortest they are.
namespace throng::bench {
namespace {

using Json = nlohmann::ordered_json;
using Pair = std::pair<Place, Place>;

struct Options {
  std::string world;
  std::vector<double> distances{500, 2000, 10000};
  int pairs = 300;
  int runs = 3;
  int judged = 20;  // pairs of each distance that are searched for, too
};

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "bench_long_paths: {}\n", message);
  std::exit(2);
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Random places so far from each other that a path joins.
std::vector<Pair> find_pairs(const World& world, PathFinder& finder, double apart,
                             const Options& options) {
  std::vector<Pair> pairs;
  Path path;
  for (uint64_t n = 0; pairs.size() < static_cast<size_t>(options.pairs) && n < 1'000'000; ++n) {
    constexpr double kGolden = 2.399963229728653;  // radians: directions of all kinds
    const double angle = kGolden * static_cast<double>(n);
    const Place from = world.random_place(0, 1, n);
    const Vec3d& p = from.position;
    const Place to =
        world.find_place(0, {p.x + apart * std::cos(angle), p.y, p.z + apart * std::sin(angle)}, 3);
    if (!to) continue;
    finder.find(from, to, path);
    if (path.end == PathEnd::kReached) pairs.push_back({from, to});
  }
  return pairs;
}

Json measure(const World& world, PathFinder& finder, PathFinder& search, double apart,
             const Options& options) {
  const std::vector<Pair> pairs = find_pairs(world, finder, apart, options);
  if (pairs.empty()) return {{"distance", apart}, {"pairs", 0}};
  std::vector<double> times;
  Path path, shortest;
  double length = 0;
  for (int run = 0; run < options.runs; ++run) {
    for (const auto& [from, to] : pairs) {
      const double start = now();
      finder.find(from, to, path);
      times.push_back((now() - start) * 1e3);
      if (run == 0) length += path.length;
    }
  }
  std::sort(times.begin(), times.end());
  double ours = 0, best = 0, worst = 0;
  std::vector<double> search_times;
  for (size_t i = 0; i < std::min(pairs.size(), static_cast<size_t>(options.judged)); ++i) {
    const auto& [from, to] = pairs[i];
    finder.find(from, to, path);
    const double start = now();
    search.find(from, to, shortest);
    search_times.push_back((now() - start) * 1e3);
    if (shortest.end != PathEnd::kReached) stop("the search finds no path where the zones do");
    ours += path.length;
    best += shortest.length;
    worst = std::max(worst, path.length / shortest.length);
  }
  std::sort(search_times.begin(), search_times.end());
  return {{"distance", apart},
          {"pairs", pairs.size()},
          {"mean_length", length / static_cast<double>(pairs.size())},
          {"median_ms", times[times.size() / 2]},
          {"p99_ms", times[times.size() * 99 / 100]},
          {"judged", search_times.size()},
          {"mean_ratio", best > 0 ? ours / best : 0},
          {"worst_ratio", worst},
          {"search_median_ms", search_times.empty() ? 0 : search_times[search_times.size() / 2]}};
}

Json run(const Options& options) {
  Context context;
  const double start = now();
  const Result<World> world = World::open(options.world);
  if (!world) stop(world.error().message);
  const double opened = now() - start;
  auto finder = PathFinder::create(*world, {.speedup = PathSpeedup::kZones}, context);
  if (!finder) stop(finder.error().message);
  auto search = PathFinder::create(*world, {}, context);
  if (!search) stop(search.error().message);
  const PathSummary made = finder->summary(), mesh = search->summary();
  Json paths = Json::array();
  for (const double apart : options.distances)
    paths.push_back(measure(*world, *finder, *search, apart, options));
  const WorldSummary summary = world->summary();
  return {{"world", options.world},
          {"area_km2", (summary.bounds.max.x - summary.bounds.min.x) *
                           (summary.bounds.max.z - summary.bounds.min.z) * 1e-6},
          {"open_ms", opened * 1e3},
          {"rectangles", made.rectangles},
          {"corners", made.corners},
          {"gates", made.entrances},
          {"labels", made.labels},
          {"bytes", made.bytes},
          {"mesh_bytes", mesh.bytes},
          {"make_seconds", made.seconds},
          {"paths", paths}};
}

}  // namespace
}  // namespace throng::bench

int main(int argc, char** argv) {
  using namespace throng::bench;
  CLI::App parser{"Long paths over a large baked world", "bench_long_paths"};
  Options options;
  parser.add_option("world", options.world, "World folder")->required();
  parser.add_option("--distances", options.distances, "How far the ends are apart [m]")
      ->delimiter(',');
  parser.add_option("--pairs", options.pairs, "Pairs of each distance")->capture_default_str();
  parser.add_option("--runs", options.runs, "Runs")->capture_default_str();
  parser.add_option("--judged", options.judged, "Pairs that are searched for, too")
      ->capture_default_str();
  CLI11_PARSE(parser, argc, argv);
  fmt::print("{}\n", run(options).dump());
  return 0;
}
