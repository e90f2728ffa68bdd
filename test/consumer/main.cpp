// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <throng/bake.h>
#include <throng/papers.h>
#include <throng/scene.h>

#include <cstdio>

// A square with a pillar, fifty wanderers, a hundred steps; fails when an avatar enters a wall or
// another.
int main() {
  throng::Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 20}, {20, 0, 20}, {20, 0, 0});
  scene.add_box({8, 0, 8}, {12, 3, 12}, throng::kAreaBlocked);

  throng::Context context;
  const auto world = throng::bake_world(scene, {.cell = 0.1}, context);
  if (!world) return std::fprintf(stderr, "%s\n", world.error().message.c_str()), 1;

  auto crowd = throng::Wanderers::create(*world, {.avatars = 50});
  if (!crowd) return std::fprintf(stderr, "%s\n", crowd.error().message.c_str()), 1;
  for (int step = 0; step < 100; ++step) crowd->step();
  const throng::CrowdCheck check = crowd->check();
  std::printf("%u avatars, %016llx\n", crowd->size(),
              static_cast<unsigned long long>(crowd->state_hash()));
  return check.wall_entries + check.overlaps == 0 ? 0 : 1;
}
