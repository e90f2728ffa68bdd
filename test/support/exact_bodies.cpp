// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "exact_bodies.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/random.h"
#include "verify/body_check.h"

// Body tests by verify's triangle tree, at nine points of each legal cell.
namespace throng::test {

Scene ground(double side, double spacing, uint64_t seed, const Height& height) {
  Scene scene;
  const auto lines = static_cast<uint32_t>(std::lround(side / spacing)) + 1;
  for (uint32_t i = 0; i < lines * lines; ++i) {
    const double x = i % lines * spacing, z = i / lines * spacing;
    scene.positions.push_back({x, height(x, z), z});
  }
  for (uint32_t z = 0; z + 1 < lines; ++z) {
    for (uint32_t x = 0; x + 1 < lines; ++x) {
      const uint32_t a = z * lines + x, b = a + 1, c = a + lines, d = c + 1;
      if (random_below(seed, 7, a, 2) == 0) {
        scene.triangles.push_back({a, c, b});
        scene.triangles.push_back({b, c, d});
      } else {
        scene.triangles.push_back({a, c, d});
        scene.triangles.push_back({a, d, b});
      }
    }
  }
  scene.area.assign(scene.triangles.size(), kAreaWalkable);
  return scene;
}

void add_box(Scene& scene, Vec3d at, Vec3d size, double turn) {
  const auto first = static_cast<uint32_t>(scene.positions.size());
  const double c = std::cos(turn), s = std::sin(turn);
  for (uint32_t i = 0; i < 8; ++i) {
    const double x = (i & 1) * size.x, z = (i >> 2 & 1) * size.z;
    scene.positions.push_back(
        {at.x + c * x - s * z, at.y + (i >> 1 & 1) * size.y, at.z + s * x + c * z});
  }
  constexpr std::array<std::array<uint32_t, 4>, 6> kFaces{
      {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
  for (const auto& f : kFaces) {
    scene.triangles.push_back({first + f[0], first + f[1], first + f[2]});
    scene.triangles.push_back({first + f[0], first + f[2], first + f[3]});
  }
  scene.area.resize(scene.triangles.size(), kAreaWalkable);
}

void for_legal_cells(const World& world, int32_t avatar_class,
                     const std::function<void(Vec3d middle, double cell)>& visit) {
  const WorldSummary summary = world.summary();
  for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
    const LevelTileContent level = world.level_tile(l);
    for (int32_t c = 0; c < kTileCells * kTileCells; ++c) {
      const auto i = static_cast<size_t>(c);
      if (level.clearance[static_cast<size_t>(avatar_class)][i] == 0) continue;
      const double x = level.tile_x * kTileCells + c % kTileCells + 0.5;
      const double z = level.tile_z * kTileCells + c / kTileCells + 0.5;
      visit({summary.origin.x + x * summary.cell, level.floor[i] * 1e-3,
             summary.origin.z + z * summary.cell},
            summary.cell);
    }
  }
}

int64_t expect_no_body_enters(const World& world, const Scene& scene, int32_t avatar_class,
                              const std::string& what) {
  const verify::TriangleTree tree(scene, 0);
  const AvatarClass avatar = world.summary().classes[static_cast<size_t>(avatar_class)];
  const verify::BodyCheck body(tree, avatar, world.summary().cell);
  int64_t cells = 0, entered = 0, missing = 0;
  for_legal_cells(world, avatar_class, [&](Vec3d middle, double cell) {
    ++cells;
    for (int32_t i = 0; i < 9; ++i) {
      const double u = (i % 3 - 1) * 0.4999 * cell, v = (i / 3 - 1) * 0.4999 * cell;
      const Vec3d at{middle.x + u, middle.y, middle.z + v};
      const Place place = world.find_place(avatar_class, at, 0.25);
      missing += place ? 0 : 1;
      if (!place) continue;
      const Vec3d feet{place.position.x, world.feet(place), place.position.z};
      if (!body.intruder(feet)) continue;
      if (entered++ == 0) {
        ADD_FAILURE() << what << ": " << avatar.name << " enters a triangle at " << feet.x << " "
                      << feet.y << " " << feet.z;
      }
    }
  });
  EXPECT_EQ(entered, 0) << what;
  EXPECT_EQ(missing, 0) << what;
  return cells;
}

}  // namespace throng::test
