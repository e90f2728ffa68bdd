// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/zone_paths.h"

#include <gtest/gtest.h>

#include "core/access.h"
#include "throng/bake.h"
#include "throng/scene.h"

// The limit of corners in a zone's tables.
namespace throng {
namespace {

// Pillars of one cell, one cell apart: each has four corners.
path::PathMesh among_pillars(int32_t a_side) {
  const int32_t side = 2 * a_side + 1;
  FlatCells cells{.width = side, .depth = side, .passable = {}};
  for (int32_t z = 0; z < side; ++z) {
    for (int32_t x = 0; x < side; ++x) cells.passable.push_back(x % 2 == 1 && z % 2 == 1 ? 0 : 1);
  }
  Context context;
  const auto world = bake_flat_cells(cells, 0.5, 0);
  EXPECT_TRUE(world);
  auto mesh = path::build_mesh(*data_of(*world), 0, 0, context);
  EXPECT_TRUE(mesh);
  return *std::move(mesh);
}

// Paths name corners by 16 bits, of which one number says that there is none.
TEST(ZonePaths, AZoneOfMoreCornersThanTheyCanNameIsRefused) {
  const std::vector<path::Entrance> entrances{{.at = {0, 0.5}, .zone = {0, 1}, .rect = {0, 0}}};
  path::Sight sight;
  const auto fits = [&](int32_t pillars, size_t corners) {
    const path::PathMesh mesh = among_pillars(pillars);
    path::ZonePaths paths;
    paths.last_rect = static_cast<uint32_t>(mesh.rects.size() - 1);
    paths.entrances = {0};
    const bool found = path::find_zone_paths(mesh, entrances, 0, sight, paths);
    EXPECT_EQ(paths.corners.size(), corners);
    return found;
  };
  EXPECT_TRUE(fits(8, 4 * 8 * 8));
  EXPECT_FALSE(fits(128, 4 * 128 * 128));
}

}  // namespace
}  // namespace throng
