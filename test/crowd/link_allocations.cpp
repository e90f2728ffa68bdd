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

// A program of its own, because it counts every allocation: once it is warm, a step in which
// avatars wait for a link, enter it and land makes none.
namespace throng {
namespace {

constexpr int kWarm = 6000, kCounted = 2000;  // steps

int run() {
  Context context;
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({12, -0.5, 0}, {22, 0, 10});
  const World world = need(bake_world(scene, {.cell = 0.1}, context));
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  Edits edits;
  need(edits.add_off_mesh_link({at(9, 3), at(13, 3), 4, true}));
  need(edits.add_off_mesh_link({at(9, 7), at(13, 7), 4, true}));
  Crowd crowd = need(Crowd::create(world, {.workers = 1, .edits = edits}));
  std::vector<AvatarSpawn> spawns;
  for (int i = 0; i < 8; ++i) {
    spawns.push_back({.place = at(i % 2 == 0 ? 3 : 19, 1.5 + i)});
  }
  const std::vector<AvatarId> ids = need(crowd.add(spawns, context));
  std::vector<std::array<Place, 2>> ends;
  for (int i = 0; i < 8; ++i) ends.push_back({at(4, 1.2 + i), at(18, 1.2 + i)});
  std::vector<size_t> sides;
  for (size_t i = 0; i < ids.size(); ++i) {
    sides.push_back(1 - i % 2);
    crowd.set_goals({&ids[i], 1}, {&ends[i][sides[i]], 1});
  }
  uint64_t before = 0, riding = 0, arrived = 0;
  for (int step = 0; step < kWarm + kCounted; ++step) {
    if (step == kWarm) before = g_allocations;
    riding += crowd.step().on_links;
    for (const AvatarId id : crowd.arrived()) {
      const size_t i = id.slot1 - 1;
      sides[i] = 1 - sides[i];
      crowd.set_goals({&id, 1}, {&ends[i][sides[i]], 1});
      arrived += step >= kWarm ? 1 : 0;
    }
  }
  const uint64_t count = g_allocations - before;
  std::printf("%llu arrivals over links: %llu allocations\n",
              static_cast<unsigned long long>(arrived), static_cast<unsigned long long>(count));
  return count > 0 || arrived < 20 || riding < 1000 ? 1 : 0;
}

}  // namespace
}  // namespace throng

int main() { return throng::run(); }
