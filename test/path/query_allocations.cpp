// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <functional>
#include <string>

#include "path/air/flight_finder.h"
#include "path/edits/ground_finder.h"
#include "path/overlay/mesh_finder.h"
#include "path/overlay/node_finder.h"
#include "support/counted_allocations.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/scene.h"
#include "throng/world.h"

// A program of its own, because it counts every allocation: a query that is repeated makes none.
namespace throng {
namespace {

constexpr uint64_t kPairs = 60;

// Asks all pairs three times: two to grow, as memories may change places between queries. Returns
// how much the third time allocated.
uint64_t late(const char* name, const std::function<void(uint64_t)>& ask) {
  for (uint64_t n = 0; n < 2 * kPairs; ++n) ask(n % kPairs);
  const uint64_t warm = g_allocations;
  for (uint64_t n = 0; n < kPairs; ++n) ask(n);
  const uint64_t more = g_allocations - warm;
  std::printf("%s: %llu allocations once warm\n", name, static_cast<unsigned long long>(more));
  return more;
}

int run() {
  Context context;
  const Scene scene = need(create_builtin_world({.name = "garage", .size = 45, .levels = 2}));
  std::vector<AvatarClass> classes = default_classes();
  classes.push_back(flyer_class());
  const World world = need(bake_world(scene, {.cell = 0.2, .classes = classes}, context));
  const auto from = [&](uint64_t n) { return world.random_place(0, 7, 2 * n); };
  const auto to = [&](uint64_t n) { return world.random_place(0, 7, 2 * n + 1); };
  uint64_t sum = 0, reached = 0;
  Path path;
  for (const PathConfig& config : {PathConfig{}, PathConfig{.speedup = PathSpeedup::kLabels},
                                   PathConfig{.speedup = PathSpeedup::kZones}}) {
    path::MeshFinder finder = need(path::MeshFinder::create(world, config, context));
    sum += late(config.speedup == PathSpeedup::kLabels  ? "labels"
                : config.speedup == PathSpeedup::kZones ? "zones"
                                                        : "search",
                [&](uint64_t n) {
                  finder.find(from(n), to(n), path);
                  reached += path.end == PathEnd::kReached;
                });
  }
  path::GroundFinder live = need(path::GroundFinder::create(world, {}));
  sum += late("live ground", [&](uint64_t n) {
    live.find(from(n), to(n), path);
    reached += path.end == PathEnd::kReached;
  });
  const Nodes nodes = need(Nodes::create(world, scene, {}, context));
  path::NodeFinder over_nodes = need(path::NodeFinder::create(nodes, {}, context));
  Path node_path;
  sum += late("nodes", [&](uint64_t n) {
    over_nodes.find(over_nodes.find_place(from(n).position, 1),
                    over_nodes.find_place(to(n).position, 1), node_path);
    reached += node_path.end == PathEnd::kReached;
  });
  path::FlightFinder flight = need(path::FlightFinder::create(
      world, {.avatar_class = static_cast<int32_t>(classes.size()) - 1}, context));
  Path flown;
  sum += late("flight", [&](uint64_t n) {
    flight.find({.from = from(n).position, .to = to(n).position}, flown);
    reached += flown.end == PathEnd::kReached;
  });
  GroundQuery query = need(GroundQuery::create(world, 0));
  sum += late("the ground around", [&](uint64_t n) {
    const Place place = from(n);
    reached += query.ray(place, 5, 3).arrived;
    reached += query.nearest_wall(query.slide(place, 2, -3), 4).found;
    reached += static_cast<bool>(query.nearest_place(to(n).position, 2));
    reached += static_cast<bool>(query.random_place_near(place, 3, 1, n));
  });
  path::Slice slice;
  sum += late("nodes in parts", [&](uint64_t n) {
    over_nodes.begin(over_nodes.find_place(from(n).position, 1),
                     over_nodes.find_place(to(n).position, 1));
    do slice = {50};
    while (!over_nodes.advance(slice, node_path));
    reached += node_path.end == PathEnd::kReached;
  });
  sum += late("flight in parts", [&](uint64_t n) {
    flight.begin({.from = from(n).position, .to = to(n).position});
    do slice = {50};
    while (!flight.advance(slice, flown));
    reached += flown.end == PathEnd::kReached;
  });
  // A wall through the garage, and crates.
  for (uint64_t n = 0; n < 12; ++n) {
    const Vec3d at = from(n).position, high{at.x + 1, at.y + 2, n == 0 ? 1000 : at.z + 1};
    const Prism box = Prism::box({at.x, at.y + 0.1, at.z}, high);
    live.add_obstacle({box});
    over_nodes.add_obstacle({box});
    flight.add_obstacle({box});
  }
  sum += late("live ground around obstacles", [&](uint64_t n) {
    live.find(from(n), to(n), path);
    reached += path.end == PathEnd::kReached;
  });
  sum += late("nodes around obstacles", [&](uint64_t n) {
    over_nodes.find(over_nodes.find_place(from(n).position, 1),
                    over_nodes.find_place(to(n).position, 1), node_path);
    reached += node_path.end == PathEnd::kReached;
  });
  sum += late("flight around obstacles", [&](uint64_t n) {
    flight.find({.from = from(n).position, .to = to(n).position}, flown);
    reached += flown.end == PathEnd::kReached;
  });
  std::printf("%llu paths found\n", static_cast<unsigned long long>(reached));
  return sum == 0 && reached > 5 * kPairs ? 0 : 1;
}

}  // namespace
}  // namespace throng

int main() { return throng::run(); }
