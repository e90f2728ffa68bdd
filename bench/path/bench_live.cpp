// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "crate_times.h"
#include "path/edits/ground_finder.h"
#include "throng/path.h"
#include "throng/world.h"

// Time until paths avoid a crate that is put onto one, on a world of any size; and the cost of a
// field of distances to shared goals.
namespace throng::bench {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "bench_live: {}\n", message);
  std::exit(2);
}

// Is a point of the path inside the crate grown by the body?
bool avoids(const Path& path, const Vec3d& low, const Vec3d& high, double radius) {
  for (size_t i = 1; i < path.points.size(); ++i) {
    const Vec3d a = path.points[i - 1].position, b = path.points[i].position;
    const int parts = static_cast<int>(length(b - a) / 0.05) + 1;
    for (int k = 0; k <= parts; ++k) {
      const Vec3d p = a + (b - a) * (static_cast<double>(k) / parts);
      const double dx = std::max({low.x - p.x, p.x - high.x, 0.0});
      const double dz = std::max({low.z - p.z, p.z - high.z, 0.0});
      if (std::fabs(p.y - low.y) < 1 && std::hypot(dx, dz) < radius - 1e-3) return false;
    }
  }
  return true;
}

Json crates(const World& world, int64_t trials, double away) {
  auto ground = path::GroundFinder::create(world, {});
  if (!ground) stop(ground.error().message);
  const double radius = world.summary().classes[0].radius;
  std::vector<double> first, added, found, both, removed;
  int64_t through = 0, blocked = 0;
  Path path;
  for (uint64_t n = 0; added.size() < static_cast<size_t>(trials) && n < 100000; ++n) {
    const Place from = world.random_place(0, 41, n);
    const double angle = static_cast<double>(n % 360) * 0.0174533;
    const Place to = world.find_place(0,
                                      {from.position.x + away * std::cos(angle), from.position.y,
                                       from.position.z + away * std::sin(angle)},
                                      1);
    if (!to) continue;
    auto start = Clock::now();
    ground->find(from, to, path, 20000);
    if (path.end != PathEnd::kReached || path.length > 2 * away) continue;
    first.push_back(milliseconds_since(start));
    // A crate of a metre over the middle of the path.
    Vec3d middle = path.points[0].position;
    double left = path.length / 2;
    for (size_t i = 1; i < path.points.size(); ++i) {
      const Vec3d segment = path.points[i].position - path.points[i - 1].position;
      const double size = std::hypot(segment.x, segment.z);
      if (left <= size) {
        middle = path.points[i - 1].position + segment * (left / size);
        break;
      }
      left -= size;
    }
    const Vec3d low{middle.x - 0.5, middle.y, middle.z - 0.5};
    const Vec3d high{middle.x + 0.5, middle.y + 1, middle.z + 0.5};
    start = Clock::now();
    const path::ChangeId crate = ground->add_obstacle({Prism::box(low, high)});
    added.push_back(milliseconds_since(start));
    ground->find(from, to, path, 20000);
    both.push_back(milliseconds_since(start));
    found.push_back(both.back() - added.back());
    if (path.end != PathEnd::kReached) ++blocked;
    if (path.end == PathEnd::kReached && !avoids(path, low, high, radius)) ++through;
    start = Clock::now();
    ground->remove(crate);
    removed.push_back(milliseconds_since(start));
  }
  if (added.empty()) stop("no path was found to put a crate onto");
  return {{"trials", added.size()},
          {"away_m", away},
          {"first_path_ms", quantiles(first)},
          {"add_ms", quantiles(added)},
          {"path_after_ms", quantiles(found)},
          {"until_avoided_ms", quantiles(both)},
          {"remove_ms", quantiles(removed)},
          {"paths_through_crates", through},
          {"paths_blocked_by_crates", blocked}};
}

Json fields(const World& world, double most) {
  Context context;
  const auto finder = PathFinder::create(world, {.speedup = PathSpeedup::kOnDemand}, context);
  if (!finder) stop(finder.error().message);
  const std::vector<Place> goals{world.random_place(0, 43, 0)};
  auto flow = FlowField::create(*finder, goals, {.max_distance = most}, context);
  if (!flow) stop(flow.error().message);
  const FlowSummary summary = flow->summary();
  constexpr uint64_t kPlaces = 20000;
  std::vector<Place> places;
  for (uint64_t n = 0; n < kPlaces; ++n) places.push_back(world.random_place(0, 44, n));
  uint64_t reached = 0;
  const auto start = Clock::now();
  for (const Place& place : places) reached += std::isfinite(flow->distance(place)) ? 1 : 0;
  const double distance = milliseconds_since(start);
  return {{"most_m", most},
          {"points", summary.points},
          {"bytes", summary.bytes},
          {"seconds", summary.seconds},
          {"places_reached", reached},
          {"distance_us", distance * 1e3 / kPlaces}};
}

}  // namespace
}  // namespace throng::bench

int main(int argc, char** argv) {
  using namespace throng::bench;
  CLI::App app{"Crates and shared goals on a baked world, as JSON"};
  std::string folder;
  int64_t trials = 1000;
  double away = 20, most = 500;
  app.add_option("world", folder, "World folder")->required();
  app.add_option("--trials", trials, "Crates");
  app.add_option("--away", away, "Length of the paths [m]");
  app.add_option("--most", most, "Farthest that the field looks [m]");
  CLI11_PARSE(app, argc, argv);
  const auto start = Clock::now();
  const auto world = throng::World::open(folder);
  if (!world) stop(world.error().message);
  const double open = milliseconds_since(start);
  const Json report = {{"world", folder},
                       {"open_ms", open},
                       {"crates", crates(*world, trials, away)},
                       {"field", fields(*world, most)}};
  fmt::print("{}\n", report.dump(2));
}
