// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "support/counted_allocations.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"
#include "throng/world.h"

// A program of its own, because it counts every allocation: a change of one obstacle makes no more
// of them, nor does a step, when thousands stand elsewhere.
namespace throng {
namespace {

constexpr int kSide = 64;         // crates in a row
constexpr uint64_t kSpare = 200;  // allocations: tables grow now and then

Prism crate(double x, double z) { return Prism::box({x, 0, z}, {x + 0.5, 2, z + 0.5}); }

// Of one that is added, moved, switched off and on and removed, with steps between.
uint64_t allocations_of_one(Crowd& crowd, Edits& edits) {
  const uint64_t before = g_allocations;
  const EditId id = need(edits.add_obstacle(crate(3, 3)));
  crowd.step();
  if (!edits.move_obstacle(id, crate(3.2, 3))) std::exit(1);
  crowd.step();
  edits.set_active(id, false);
  edits.set_active(id, true);
  crowd.step();
  edits.remove(id);
  crowd.step();
  return g_allocations - before;
}

// Of a step after one in which nothing has changed either.
uint64_t allocations_of_none(Crowd& crowd) {
  crowd.step();
  const uint64_t before = g_allocations;
  crowd.step();
  return g_allocations - before;
}

int run() {
  Context context;
  Scene scene;
  scene.positions = {{0, 0, 0}, {0, 0, 110}, {110, 0, 110}, {110, 0, 0}};
  scene.triangles = {{0, 1, 2}, {0, 2, 3}};
  const World world = need(bake_world(scene, {.cell = 0.2}, context));
  Edits edits;
  Crowd crowd = need(Crowd::create(world, {.workers = 1, .edits = edits}));
  const std::vector<AvatarSpawn> spawns = {{world.find_place(0, {1, 0, 1}, 1)}};
  if (need(crowd.add(spawns, context)).size() != 1) return 1;
  std::vector<uint64_t> counts;
  for (int row = 0; row < kSide; ++row) {
    for (int i = 0; i < kSide; ++i) {
      need(edits.add_obstacle(crate(1.5 * i + 8, 1.5 * row + 8)));
    }
    if (row != 1 && row + 1 != kSide) continue;
    (void)allocations_of_one(crowd, edits);
    counts.push_back(allocations_of_one(crowd, edits));
    std::printf("%d obstacles stand: %llu allocations\n", (row + 1) * kSide,
                static_cast<unsigned long long>(counts.back()));
    if (const uint64_t idle = allocations_of_none(crowd); idle > 0) {
      std::printf("a step without a change: %llu allocations\n",
                  static_cast<unsigned long long>(idle));
      return 1;
    }
  }
  return counts[1] > counts[0] + kSpare ? 1 : 0;
}

}  // namespace
}  // namespace throng

int main() { return throng::run(); }
