// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "crate_times.h"
#include "path/air/flight_finder.h"
#include "throng/path.h"

// Time until paths through the air avoid a crate that is put onto one, on a world of any size; with
// `--standing`, among other crates.
namespace throng::bench {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "bench_air_changes: {}\n", message);
  std::exit(2);
}

Prism crate_around(Vec3d p, double side) {
  const Vec3d half{side / 2, side / 2, side / 2};
  return Prism::box(p - half, p + half);
}

Json crates(path::FlightFinder& finder, int64_t trials, int64_t standing, double away,
            double side) {
  for (int64_t n = 0; n < standing; ++n) {
    const auto at = finder.random_point(7, static_cast<uint64_t>(n));
    if (at) finder.add_obstacle({crate_around(*at, side)});
  }
  std::vector<double> before, added, after, both, removed;
  int64_t longer = 0, shut = 0;
  Path path;
  for (uint64_t n = 0; added.size() < static_cast<size_t>(trials) && n < 100000; ++n) {
    const auto from = finder.random_point(41, n);
    if (!from) stop("there is no air");
    const double angle = static_cast<double>(n % 360) * 0.0174533;
    const Vec3d to{from->x + away * std::cos(angle), from->y, from->z + away * std::sin(angle)};
    if (!finder.is_legal(to)) continue;
    const path::FlightQuery query{.from = *from, .to = to, .budget = 20000, .nearest = false};
    auto start = Clock::now();
    finder.find(query, path);
    const double first = milliseconds_since(start);
    if (path.end != PathEnd::kReached || path.length > 2 * away) continue;
    before.push_back(first);
    Vec3d middle = path.points[0].position;
    double left = path.length / 2;
    for (size_t i = 1; i < path.points.size(); ++i) {
      const Vec3d segment = path.points[i].position - path.points[i - 1].position;
      if (left <= length(segment)) {
        middle = path.points[i - 1].position + segment * (left / length(segment));
        break;
      }
      left -= length(segment);
    }
    const double straight = path.length;
    start = Clock::now();
    const path::ChangeId crate = finder.add_obstacle({crate_around(middle, side)});
    added.push_back(milliseconds_since(start));
    start = Clock::now();
    finder.find(query, path);
    after.push_back(milliseconds_since(start));
    both.push_back(added.back() + after.back());
    if (path.end != PathEnd::kReached) ++shut;
    if (path.end == PathEnd::kReached && path.length > straight) ++longer;
    start = Clock::now();
    finder.remove(crate);
    removed.push_back(milliseconds_since(start));
  }
  if (added.empty()) stop("no path was found to put a crate onto");
  return {{"trials", added.size()},
          {"standing", standing},
          {"away_m", away},
          {"path_before_ms", quantiles(before)},
          {"add_ms", quantiles(added)},
          {"path_after_ms", quantiles(after)},
          {"until_avoided_ms", quantiles(both)},
          {"remove_ms", quantiles(removed)},
          {"paths_made_longer", longer},
          {"paths_blocked_by_crates", shut}};
}

}  // namespace
}  // namespace throng::bench

int main(int argc, char** argv) {
  using namespace throng::bench;
  CLI::App app{"Crates in the air of a baked world, as JSON"};
  std::string folder, name = "flyer";
  int64_t trials = 1000, standing = 0;
  double away = 20, side = 1;
  app.add_option("world", folder, "World folder")->required();
  app.add_option("--class", name, "Avatar class that flies");
  app.add_option("--trials", trials, "Crates");
  app.add_option("--standing", standing, "Other crates, all over the air");
  app.add_option("--away", away, "Length of the paths [m]");
  app.add_option("--side", side, "Of a crate [m]");
  CLI11_PARSE(app, argc, argv);
  const auto world = throng::World::open(folder);
  if (!world) stop(world.error().message);
  const auto& classes = world->summary().classes;
  const auto found = std::find_if(classes.begin(), classes.end(),
                                  [&](const auto& avatar) { return avatar.name == name; });
  if (found == classes.end()) stop("there is no class " + name);
  throng::Context context;
  auto finder = throng::path::FlightFinder::create(
      *world, {.avatar_class = static_cast<int32_t>(found - classes.begin())}, context);
  if (!finder) stop(finder.error().message);
  const Json report = {{"world", folder},
                       {"boxes", finder->summary().boxes},
                       {"crates", crates(*finder, trials, standing, away, side)}};
  fmt::print("{}\n", report.dump(2));
}
