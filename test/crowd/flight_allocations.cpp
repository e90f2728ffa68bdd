// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cstdio>
#include <vector>

#include "support/counted_allocations.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "throng/scene.h"
#include "throng/world.h"

// A program of its own, because it counts every allocation: once it is warm, a step in which flyers
// search for paths makes none. The paths lead around a wall, around an obstacle that the search
// knows, and over one that it does not know, since that can move.
namespace throng {
namespace {

constexpr int kWarm = 6000, kCounted = 2000;  // steps

int run() {
  Context context;
  Scene scene;
  scene.add_box({0, -0.5, 0}, {30, 0, 20});
  scene.add_box({14.6, 0, 0}, {15, 6, 13});
  const World world =
      need(bake_world(scene, {.cell = 0.2, .classes = {flyer_class()}, .workers = 1}, context));
  Edits edits;
  need(edits.add_obstacle(Prism::box({20, 0, 6}, {21, 5, 12})));
  need(edits.add_obstacle(Prism::box({14, 6, -1}, {15.6, 8, 21}), ObstacleKind::kKinematic));
  Crowd crowd = need(Crowd::create(world, {.workers = 1, .edits = edits}));
  std::vector<AvatarSpawn> spawns;
  std::vector<std::array<Place, 2>> ends;
  for (int i = 0; i < 8; ++i) {
    const double z = 2 + 2.2 * i;
    ends.push_back({air_place({5, 2, z}), air_place({25, 2, z})});
    spawns.push_back({.place = ends.back()[static_cast<size_t>(i % 2)]});
  }
  const std::vector<AvatarId> ids = need(crowd.add(spawns, context));
  std::vector<size_t> sides;
  for (size_t i = 0; i < ids.size(); ++i) {
    sides.push_back(1 - i % 2);
    crowd.set_goals({&ids[i], 1}, {&ends[i][sides[i]], 1});
  }
  uint64_t before = 0, planned = 0, arrived = 0;
  for (int step = 0; step < kWarm + kCounted; ++step) {
    if (step == kWarm) before = g_allocations;
    const CrowdReport report = crowd.step();
    planned += step >= kWarm ? report.planned : 0;
    for (const AvatarId id : crowd.arrived()) {
      const size_t i = id.slot1 - 1;
      sides[i] = 1 - sides[i];
      crowd.set_goals({&id, 1}, {&ends[i][sides[i]], 1});
      arrived += step >= kWarm ? 1 : 0;
    }
  }
  const uint64_t count = g_allocations - before;
  std::printf("%llu arrivals by %llu paths: %llu allocations\n",
              static_cast<unsigned long long>(arrived), static_cast<unsigned long long>(planned),
              static_cast<unsigned long long>(count));
  return count > 0 || arrived < 20 || planned < 20 ? 1 : 0;
}

}  // namespace
}  // namespace throng

int main() { return throng::run(); }
