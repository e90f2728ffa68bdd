// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/crowd_ground.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/access.h"
#include "core/random.h"
#include "throng/bake.h"
#include "throng/scene.h"
#include "worlds.h"

namespace throng {
namespace {

constexpr int32_t kStep = 400;  // mm

World baked(const Scene& scene) {
  Context context;
  auto world = bake_world(scene, {}, context);
  EXPECT_TRUE(world) << world.error().message;
  return std::move(*world);
}

// The same ground, straight from the zones.
world::WorldGround zones(const World& world) { return {*data_of(world), 0}; }

world::GroundLevel zone_level(const World& world, uint32_t level) {
  return world::ground_level(*data_of(world), level, 0);
}

TEST(CrowdGround, LegalCellsAreThoseOfTheZones) {
  for (const Scene& scene : {worlds::two_floors(), worlds::flat(20), worlds::ramp(20, 8)}) {
    const World world = baked(scene);
    const auto ground = crowd::CrowdGround::create(*data_of(world), 0, kStep);
    ASSERT_TRUE(ground);
    for (uint32_t level = 0; level < world.level_tile_count(); ++level) {
      const world::GroundLevel expected = zone_level(world, level);
      for (int32_t cell = 0; cell < 4096; ++cell) {
        ASSERT_EQ(ground->is_legal(level, cell % 64, cell / 64),
                  expected.is_legal(cell % 64, cell / 64));
      }
    }
  }
}

// Level ground, then a slope over the edge of the tiles at 6.4 m, then level ground.
Scene slope_over_the_edge(bool along_x) {
  Scene scene;
  const double at[] = {0, 5, 8, 13}, y[] = {0, 0, 0.8, 0.8};
  for (int i = 0; i < 3; ++i) {
    if (along_x) {
      scene.add_quad({at[i], y[i], 0}, {at[i], y[i], 9}, {at[i + 1], y[i + 1], 9},
                     {at[i + 1], y[i + 1], 0});
    } else {
      scene.add_quad({0, y[i], at[i]}, {0, y[i + 1], at[i + 1]}, {9, y[i + 1], at[i + 1]},
                     {9, y[i], at[i]});
    }
  }
  return scene;
}

// Walks of up to two cells that stay on flat cells need no further test; that is, the world permits
// them, and the feet stay as high as they are.
TEST(CrowdGround, AWalkOverFlatCellsEndsOnTheSameLevelAtTheSameHeight) {
  for (const Scene& scene :
       {worlds::two_floors(), worlds::steps(0.17, 0.3, 12), worlds::ramp(20, 8), worlds::doorway(1),
        slope_over_the_edge(true), slope_over_the_edge(false)}) {
    const World world = baked(scene);
    const auto ground = crowd::CrowdGround::create(*data_of(world), 0, kStep);
    ASSERT_TRUE(ground);
    uint64_t n = 0, plain_walks = 0;
    const auto draw = [&](uint64_t below) {
      return static_cast<int32_t>(random_below(5, 6, n++, below));
    };
    for (int32_t i = 0; i < 200000; ++i) {
      const auto level = static_cast<uint32_t>(draw(world.level_tile_count()));
      const int32_t x0 = draw(64), z0 = draw(64);
      const int32_t x1 = std::min(63, x0 + draw(3)), z1 = std::min(63, z0 + draw(3));
      bool all_flat = true;
      for (int32_t z = z0; z <= z1; ++z) {
        for (int32_t x = x0; x <= x1; ++x) all_flat &= ((ground->flat(level)[z] >> x) & 1) != 0;
      }
      if (!all_flat) continue;
      ++plain_walks;
      const auto& record = ground->records()[level];
      const auto point = [&](int32_t x, int32_t z) {
        return world::GroundPoint{
            (int64_t{record.tile_x * 64 + x} << world::kUnitBits) + draw(world::kUnitsPerCell),
            (int64_t{record.tile_z * 64 + z} << world::kUnitBits) + draw(world::kUnitsPerCell)};
      };
      world::GroundPoint from = point(x0, z1), to = point(x1, z0);
      if (i % 2 == 0) std::swap(from, to);
      world::GroundLevel reached = zone_level(world, level);
      ASSERT_TRUE(world::walk(zones(world), reached, from, to, kStep));
      ASSERT_EQ(reached.world_level, level);
      ASSERT_EQ(ground->feet(level, from), ground->feet(level, to));
    }
    EXPECT_GT(plain_walks, 1000u);
  }
}

Scene garage() {
  auto scene = create_builtin_world({.name = "garage", .size = 60, .levels = 2});
  EXPECT_TRUE(scene);
  return std::move(*scene);
}

// The same for steps of up to a block over the edge of a tile, which may change the level.
TEST(CrowdGround, AStepOverAJoinEndsWhereAWalkDoesAtTheSameHeight) {
  for (const Scene& scene : {worlds::two_floors(), worlds::flat(20), slope_over_the_edge(true),
                             slope_over_the_edge(false), garage()}) {
    const World world = baked(scene);
    const auto ground = crowd::CrowdGround::create(*data_of(world), 0, kStep);
    ASSERT_TRUE(ground);
    uint64_t n = 0, crossed = 0;
    const auto draw = [&](uint64_t below) {
      return static_cast<int32_t>(random_below(7, 8, n++, below));
    };
    for (int32_t i = 0; i < 400000; ++i) {
      const auto level = static_cast<uint32_t>(draw(world.level_tile_count()));
      const auto& record = ground->records()[level];
      const int32_t along = draw(64), rim = draw(2) * 63, dx = draw(9) - 4, dz = draw(9) - 4;
      const int32_t x = record.tile_x * 64 + (i % 2 == 0 ? rim : along);
      const int32_t z = record.tile_z * 64 + (i % 2 == 0 ? along : rim);
      const uint32_t beyond = ground->line(level).cross(x, z, x + dx, z + dz);
      if (beyond == crowd::LevelLine::kNone) continue;
      ++crossed;
      const auto point = [&](int32_t cell_x, int32_t cell_z) {
        return world::GroundPoint{
            (int64_t{cell_x} << world::kUnitBits) + draw(world::kUnitsPerCell),
            (int64_t{cell_z} << world::kUnitBits) + draw(world::kUnitsPerCell)};
      };
      const world::GroundPoint from = point(x, z), to = point(x + dx, z + dz);
      world::GroundLevel reached = zone_level(world, level);
      ASSERT_TRUE(world::walk(zones(world), reached, from, to, kStep));
      ASSERT_EQ(reached.world_level, beyond);
      ASSERT_EQ(ground->feet(level, from), ground->feet(beyond, to));
    }
    EXPECT_GT(crossed, 1000u);
  }
}

TEST(CrowdGround, ALoneLevelIsTheOnlyOneWithinAStepInItsTile) {
  const World world = baked(worlds::two_floors());
  const auto ground = crowd::CrowdGround::create(*data_of(world), 0, kStep);
  ASSERT_TRUE(ground);
  int32_t lone = 0;
  for (uint32_t level = 0; level < world.level_tile_count(); ++level) {
    if (!ground->walk(level).is_isolated) continue;
    ++lone;
    const auto& record = ground->records()[level];
    const world::GroundLevel here = zone_level(world, level);
    ground->for_tile(record.tile_x, record.tile_z, INT32_MIN, INT32_MAX, [&](uint32_t other) {
      if (other == level) return;
      const world::GroundLevel there = zone_level(world, other);
      for (int32_t a = 0; a < 4096; a += 7) {
        for (int32_t b = 0; b < 4096; b += 13) {
          if (!here.view.has(a % 64, a / 64) || !there.view.has(b % 64, b / 64)) continue;
          const int32_t rise = here.view.sample(a % 64, a / 64) - there.view.sample(b % 64, b / 64);
          ASSERT_GT(std::abs(rise), kStep);
        }
      }
    });
  }
  EXPECT_GT(lone, 0);
}

TEST(CrowdGround, FloorsOutsideTheGivenHeightsMayBeLeftOutButNoOther) {
  const World world = baked(worlds::two_floors());
  const auto ground = crowd::CrowdGround::create(*data_of(world), 0, kStep);
  ASSERT_TRUE(ground);
  for (uint32_t level = 0; level < world.level_tile_count(); ++level) {
    const auto& record = ground->records()[level];
    const world::LevelView view = zone_level(world, level).view;
    for (int32_t cell = 0; cell < 4096; cell += 5) {
      if (!view.has(cell % 64, cell / 64)) continue;
      const int32_t y = view.sample(cell % 64, cell / 64);
      bool found = false;
      ground->for_tile(record.tile_x, record.tile_z, y, y,
                       [&](uint32_t other) { found |= other == level; });
      ASSERT_TRUE(found);
    }
  }
}

}  // namespace
}  // namespace throng
