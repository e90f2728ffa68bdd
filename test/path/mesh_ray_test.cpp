// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/mesh_ray.h"

#include <gtest/gtest.h>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "throng/bake.h"
#include "throng/scene.h"
#include "world/ground.h"
#include "world/place.h"

// Rays over rectangles against walks over cells.
namespace throng {
namespace {

path::PathMesh mesh_of(const World& world, int32_t avatar_class) {
  Context context;
  auto mesh = path::build_mesh(*data_of(world), avatar_class, 0, context);
  EXPECT_TRUE(mesh);
  return *std::move(mesh);
}

// The rectangle in which a walk over cells ends.
uint32_t walked(const World& world, const path::PathMesh& mesh, const path::Stop& from,
                world::GroundPoint to) {
  const world::WorldGround ground{*data_of(world), mesh.avatar_class};
  world::GroundLevel level =
      world::ground_level(*data_of(world), mesh.rects[from.rect].level, mesh.avatar_class);
  if (!world::walk(ground, level, from.at, to, mesh.step)) return path::kNoRect;
  return mesh.rect_at(level.world_level, to.cell_x(), to.cell_z());
}

// In the cell of a point: its low corner, the middle of a side or of it all, or an eighth; a line
// between two of them runs through points that cells share, often.
world::GroundPoint round_off(world::GroundPoint p, uint64_t seed, uint64_t n) {
  const int64_t part = world::kUnitsPerCell >> random_below(seed, n, 7, 4);
  const auto low = [&](int64_t at, uint64_t use) {
    const auto parts = static_cast<uint64_t>(world::kUnitsPerCell / part);
    return (at >> world::kUnitBits << world::kUnitBits) +
           static_cast<int64_t>(random_below(seed, n, use, parts)) * part;
  };
  return {low(p.x, 8), low(p.z, 9)};
}

// Every point of a map of one level has one rectangle at most, so rays and walks must agree.
TEST(MeshRay, GoesAsFarAsTheWalkOverCells) {
  int through = 0, blocked = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    // Every fourth over several tiles.
    const int32_t width = seed % 4 == 3 ? 150 : 20, depth = seed % 4 == 3 ? 70 : 24;
    FlatCells cells{.width = width, .depth = depth, .passable = {}};
    for (uint64_t i = 0; i < static_cast<uint64_t>(width * depth); ++i)
      cells.passable.push_back(random_below(seed, 0, i, 200) < 1 + seed ? 0 : 1);
    const auto world = bake_flat_cells(cells, 1);
    ASSERT_TRUE(world);
    const path::PathMesh mesh = mesh_of(*world, 0);
    const auto stop_at = [&](world::GroundPoint at) {
      const Place place = world->find_place(0, {at.cell_x() + 0.5, 0, at.cell_z() + 0.5}, 0.1);
      return path::Stop{
          at, place ? mesh.rect_at(place.level1 - 1, at.cell_x(), at.cell_z()) : path::kNoRect};
    };
    for (uint64_t n = 0; n < 4000; ++n) {
      const auto random_point = [&](uint64_t use) {
        const auto cell = [&](uint64_t more, int32_t size) {
          const auto count = static_cast<uint64_t>(size);
          return static_cast<int64_t>(random_below(seed, n + 1, 2 * use + more, count))
                 << world::kUnitBits;
        };
        return round_off({cell(0, width), cell(1, depth)}, seed + 100 * (use + 1), n);
      };
      const path::Stop from = stop_at(random_point(0));
      const world::GroundPoint to = random_point(1);
      if (from.rect == path::kNoRect) continue;
      const uint32_t rect = path::mesh_ray(mesh, from.rect, from.at, to);
      ASSERT_EQ(rect, walked(*world, mesh, from, to))
          << "seed " << seed << ": " << from.at.x << ", " << from.at.z << " to " << to.x << ", "
          << to.z;
      ++(rect == path::kNoRect ? blocked : through);
    }
  }
  EXPECT_GT(through, 20000);
  EXPECT_GT(blocked, 20000);
}

TEST(MeshRay, LeadsToTheLevelThatTheWalkLeadsTo) {
  int through = 0, lost = 0;
  for (const auto& [name, cell] :
       {std::pair{"church", 0.15}, {"garage", 0.2}, {"stairs", 0.1}, {"bridge", 0.2}}) {
    SCOPED_TRACE(name);
    const World world = test::bake(test::builtin({.name = name}), cell);
    const path::PathMesh mesh = mesh_of(world, 0);
    for (uint64_t n = 0; n < 20000; ++n) {
      const Place place = world.random_place(0, 1, n);
      const world::GroundPoint at =
          world::to_ground(*data_of(world), place.position.x, place.position.z);
      const path::Stop from{round_off(at, 2, n),
                            mesh.rect_at(place.level1 - 1, at.cell_x(), at.cell_z())};
      ASSERT_NE(from.rect, path::kNoRect);
      const auto along = [&](uint64_t use) {
        return (static_cast<int64_t>(random_below(3, n, use, 81)) - 40) *
               (world::kUnitsPerCell / 2);
      };
      const world::GroundPoint to{from.at.x + along(0), from.at.z + along(1)};
      if (to.x < 0 || to.z < 0) continue;
      const uint32_t rect = path::mesh_ray(mesh, from.rect, from.at, to);
      const uint32_t by_cells = walked(world, mesh, from, to);
      if (rect == path::kNoRect) {
        // Steps that do not lead back are none to a mesh.
        lost +=
            by_cells != path::kNoRect && walked(world, mesh, {to, by_cells}, from.at) == from.rect;
        continue;
      }
      ASSERT_EQ(rect, by_cells) << n;
      ++through;
    }
  }
  EXPECT_GT(through, 10000);
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace throng
