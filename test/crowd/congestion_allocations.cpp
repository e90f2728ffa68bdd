// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <array>
#include <cstdio>
#include <span>
#include <vector>

#include "support/counted_allocations.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"
#include "throng/world.h"

// A program of its own, because it counts every allocation: once it is warm, a step in which
// avatars search for routes around a jam and take them makes none.
namespace throng {
namespace {

// Memory grows with the largest search so far, so most kinds of jam must come while it is warmed.
constexpr int kWarm = 60000, kCounted = 10000;  // steps

int run() {
  Context context;
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({4.9, 0, 0}, {5.1, 3, 1.5});
  scene.add_box({4.9, 0, 2.5}, {5.1, 3, 7.5});
  scene.add_box({4.9, 0, 8.5}, {5.1, 3, 10});
  const World world = need(bake_world(scene, {.cell = 0.1}, context));
  const auto at = [&](double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); };
  Crowd crowd = need(Crowd::create(world, {.workers = 1}));
  // One stands in the first door for good; the others go to and fro.
  std::vector<AvatarSpawn> spawns{{.place = at(5, 2)}};
  for (int i = 0; i < 8; ++i)
    spawns.push_back({.place = at(1 + 0.8 * (i % 4), 1.4 + 0.8 * (i / 4))});
  const std::vector<AvatarId> ids = need(crowd.add(spawns, context));
  const Vec3d still{};
  crowd.set_velocities({ids.data(), 1}, {&still, 1});
  std::vector<std::array<Place, 2>> ends{{}};
  for (int i = 0; i < 8; ++i) {
    ends.push_back(
        {at(1 + 0.7 * (i % 4), 1.2 + 0.7 * (i / 4)), at(7 + 0.7 * (i % 4), 1.2 + 0.7 * (i / 4))});
  }
  std::vector<size_t> sides(ids.size(), 1);
  for (size_t i = 1; i < ids.size(); ++i) crowd.set_goals({&ids[i], 1}, {&ends[i][1], 1});
  uint64_t before = 0, changed = 0, searches = 0;
  for (int step = 0; step < kWarm + kCounted; ++step) {
    if (step == kWarm) before = g_allocations;
    const CrowdReport report = crowd.step();
    if (step >= kWarm) {
      changed += report.changed_route;
      searches += report.jam_searches;
    }
    for (const AvatarId id : crowd.arrived()) {
      const size_t i = id.slot1 - 1;
      sides[i] = 1 - sides[i];
      crowd.set_goals({&id, 1}, {&ends[i][sides[i]], 1});
    }
  }
  const uint64_t count = g_allocations - before;
  std::printf("%llu searches, %llu routes changed: %llu allocations\n",
              static_cast<unsigned long long>(searches), static_cast<unsigned long long>(changed),
              static_cast<unsigned long long>(count));
  return count > 0 || searches < 8 || changed < 4 ? 1 : 0;
}

}  // namespace
}  // namespace throng

int main() { return throng::run(); }
