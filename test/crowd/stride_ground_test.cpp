// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/stride_ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/access.h"
#include "core/random.h"
#include "simd_targets.h"
#include "throng/bake.h"
#include "throng/scene.h"
#include "world/place.h"

namespace throng {
namespace {

constexpr int32_t kStep = 400;  // mm

struct Fixture {
  explicit Fixture(const BuiltinWorldConfig& config) {
    Context context;
    const auto scene = create_builtin_world(config);
    EXPECT_TRUE(scene) << scene.error().message;
    auto baked = bake_world(*scene, {.cell = 0.1, .classes = {AvatarClass{}}}, context);
    EXPECT_TRUE(baked) << baked.error().message;
    world = *baked;
    ground = *crowd::CrowdGround::create(*data_of(world), 0, kStep);
    stride = crowd::StrideGround(ground, kStep);
  }
  // A random body, and a point to look at.
  struct Stand {
    uint32_t level;
    world::GroundPoint at;
    int32_t y;
  };
  [[nodiscard]] Stand stand(uint64_t n) const {
    const Place place = world.random_place(0, 1, n);
    const world::GroundPoint at = *world::ground_point(*data_of(world), place);
    return {place.level1 - 1, at, ground.feet(place.level1 - 1, at)};
  }
  World world;
  crowd::CrowdGround ground;
  crowd::StrideGround stride;
};

const BuiltinWorldConfig kWorlds[] = {{.name = "garage", .size = 60, .levels = 3},
                                      {.name = "city", .size = 100},
                                      {.name = "stairs"},
                                      {.name = "maze", .size = 40}};

double number(uint64_t n, uint64_t stream) { return random_unit(7, stream, n); }

TEST(StrideGround, SeesAsFarAsItCanWalkCellByCell) {
  for (const BuiltinWorldConfig& config : kWorlds) {
    const Fixture f(config);
    uint64_t free = 0, blocked = 0, distinguished = 0;
    for (uint64_t n = 0; n < 20000; ++n) {
      const auto s = f.stand(n);
      const double angle = 2 * M_PI * number(n, 1),
                   far = 8 * world::kUnitsPerCell * 10 * number(n, 2);
      world::GroundPoint from = s.at, to{s.at.x + std::lround(far * std::cos(angle)),
                                         s.at.z + std::lround(far * std::sin(angle))};
      // Paths bend at corners of cells, so lines from, to and through them are common.
      const auto to_corner = [](int64_t v) { return v & ~int64_t{world::kUnitsPerCell - 1}; };
      if (n % 4 >= 1) to = {to_corner(to.x), to_corner(to.z)};
      if (n % 4 >= 2) from = {to_corner(from.x), to_corner(from.z)};
      if (n % 4 == 3) to.x = from.x + (to.z - from.z);
      uint32_t end = s.level;
      const bool expected = world::walk(f.ground, end, from, to, kStep);
      distinguished += f.stride.sees(s.level, from, to, end, 1e9f) != expected;
      ++(expected ? free : blocked);
      if (!expected) continue;
      EXPECT_FALSE(f.stride.sees(s.level, from, to, end + 1, 1e9f));
    }
    EXPECT_GT(free, 1000u) << config.name;
    EXPECT_GT(blocked, 1000u) << config.name;
    EXPECT_EQ(distinguished, 0u) << config.name;
  }
}

TEST(StrideGround, FreeDistancesEndWhereTheCellByCellWalkDoes) {
  for (const BuiltinWorldConfig& config : kWorlds) {
    const Fixture f(config);
    uint64_t ends = 0, distinguished = 0;
    for (uint64_t n = 0; n < 5000; ++n) {
      const auto s = f.stand(n);
      const double angle = 2 * M_PI * number(n, 1);
      const steer::Plane direction{static_cast<float>(std::cos(angle)),
                                   static_cast<float>(std::sin(angle))};
      const float most = 20.0f * world::kUnitsPerCell;
      const float distance = f.stride.free_distance(s.level, s.at, direction, most);
      const auto at = [&](double size) {
        return world::GroundPoint{s.at.x + std::lround(size * direction.x),
                                  s.at.z + std::lround(size * direction.z)};
      };
      uint32_t end = s.level;
      distinguished += !world::walk(f.ground, end, s.at, at(std::max(distance - 8.0, 0.0)), kStep);
      end = s.level;
      if (distance == most) continue;
      ++ends;
      distinguished += world::walk(f.ground, end, s.at, at(distance + 8.0), kStep);
    }
    EXPECT_GT(ends, 500u) << config.name;
    // Where a line grazes a corner of cells, one that ends elsewhere rounds to the other side.
    EXPECT_LE(distinguished, 15u) << config.name;
  }
}

// Walks cell by cell between random points of squares that are reported as open; also where
// obstacles blocked cells, and freed them.
TEST(StrideGround, OpenSquaresHaveNoWalls) {
  for (const BuiltinWorldConfig& config : kWorlds) {
    Fixture f(config);
    uint64_t open = 0, shut = 0, blocked = 0, landed_elsewhere = 0;
    const auto look = [&](uint64_t first) {
      for (uint64_t n = first; n < first + 6000; ++n) {
        const auto s = f.stand(n);
        if (!f.ground.is_legal(s.level, s.at.cell_x() & 63, s.at.cell_z() & 63)) continue;
        const auto reach = static_cast<int32_t>(1 + 31 * number(n, 1));
        const bool is_open = f.stride.is_open_around(s.level, s.at, reach);
        ++(is_open ? open : shut);
        for (uint64_t k = 0; k < 8; ++k) {
          const auto off = [&](uint64_t axis) {
            return std::lround(reach * world::kUnitsPerCell *
                               (2 * number(8 * n + k, 2 + axis) - 1));
          };
          const world::GroundPoint to{s.at.x + off(0), s.at.z + off(1)};
          uint32_t end = s.level;
          const bool walks = world::walk(f.ground, end, s.at, to, kStep);
          blocked += is_open && !walks;
          crowd::StrideGround::Landing landing;
          const bool moves = f.stride.move(s.level, s.y, s.at, to, landing);
          landed_elsewhere += moves != walks;
          if (!moves || !walks) continue;
          landed_elsewhere += landing.level != end || landing.y != f.ground.feet(end, to);
        }
      }
    };
    look(0);
    const uint64_t open_as_baked = open;
    const size_t levels = f.ground.records().size();
    const auto take = [&](uint32_t level, const world::CellRows& cells) {
      f.ground.set_blocked(level, cells);
      f.ground.join_tile(f.ground.records()[level].tile_x, f.ground.records()[level].tile_z);
    };
    world::CellRows some{};
    for (size_t z = 20; z < 44; ++z) some[z] = uint64_t{0xffff00000000ffff};
    for (uint32_t level = 0; level < levels; level += 3) take(level, some);
    look(10000);
    for (uint32_t level = 0; level < levels; level += 3) take(level, {});
    open = 0;
    look(0);
    EXPECT_EQ(open, open_as_baked) << config.name;
    EXPECT_GT(open, 300u) << config.name;
    EXPECT_GT(shut, 1000u) << config.name;
    EXPECT_EQ(blocked, 0u) << config.name;
    EXPECT_EQ(landed_elsewhere, 0u) << config.name;
  }
}

// For each square the window states what may be walked on there, and the distances are those of a
// simple loop over its squares.
TEST(WallWindow, DistancesAreThoseOfAPlainLoop) {
  const auto plain = [](const crowd::WallWindow& w, steer::Plane d, float look) {
    const auto by = [&](float part) {
      return static_cast<int32_t>(std::lrint(part * static_cast<float>(w.spacing())));
    };
    int32_t x = w.x, z = w.z, free = 0;
    while (static_cast<float>(free * w.spacing()) < look) {
      x += by(d.x);
      z += by(d.z);
      if ((w.rows[static_cast<size_t>(z >> w.shift)] >> (x >> w.shift) & 1) == 0) break;
      ++free;
    }
    return std::min(static_cast<float>(free * w.spacing()), look);
  };
  test::for_every_simd_target([&](const char* name) {
    uint64_t short_distances = 0;
    for (uint64_t n = 0; n < 2000; ++n) {
      crowd::WallWindow window;
      window.shift = n % 2 == 0 ? world::kUnitBits : world::kUnitBits + 1;
      const auto middle = static_cast<double>(crowd::WallWindow::kMiddle << window.shift);
      window.x = static_cast<int32_t>(middle + (1 << window.shift) * number(n, 3));
      window.z = static_cast<int32_t>(middle + (1 << window.shift) * number(n, 4));
      for (size_t row = 0; row < window.rows.size(); ++row) {
        const uint64_t bits = random_u64(3, n, row);
        window.rows[row] = static_cast<uint32_t>(bits | bits >> 32 | random_u64(4, n, row));
      }
      const double angle = 2 * M_PI * number(n, 5);
      const steer::Fan fan = steer::fan_around(
          {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
      const auto look = static_cast<float>(window.range() * number(n, 6));
      crowd::FreeDistances distances;
      crowd::find_free_distances(window, fan, look, distances);
      for (size_t k = 0; k < distances.size(); ++k) {
        ASSERT_EQ(distances[k], plain(window, fan[k], look)) << name << " " << n << " " << k;
        short_distances += distances[k] < look;
      }
    }
    EXPECT_GT(short_distances, 10000u);
  });
}

TEST(StrideGround, WindowsShowWhichDistancesAreFree) {
  for (const BuiltinWorldConfig& config : kWorlds) {
    const Fixture f(config);
    uint64_t open = 0, walls = 0, steps = 0, distances = 0, near = 0;
    for (uint64_t n = 0; n < 5000; ++n) {
      const auto s = f.stand(n);
      const float look = n % 2 == 0 ? 9.1f * world::kUnitsPerCell : 24.5f * world::kUnitsPerCell;
      const auto cells = static_cast<int32_t>(look) / world::kUnitsPerCell + 1;
      crowd::WallWindow window;
      const auto around =
          f.stride.query_walls(s.level, s.y, s.at, cells,
                               static_cast<int32_t>(look / world::kUnitsPerCell * 100), window);
      open += around == crowd::StrideGround::Around::kOpen;
      walls += around == crowd::StrideGround::Around::kWalls;
      steps += around == crowd::StrideGround::Around::kSteps;
      if (around == crowd::StrideGround::Around::kSteps) continue;
      const steer::Fan fan = steer::fan_around({1, 0.3f});
      crowd::FreeDistances found;
      found.fill(look);
      if (around == crowd::StrideGround::Around::kWalls) {
        ASSERT_LE(look, window.range());
        crowd::find_free_distances(window, fan, look, found);
      }
      for (size_t k = 0; k < fan.size(); ++k) {
        const float exact = f.stride.free_distance(s.level, s.at, fan[k], look);
        ++distances;
        near += std::abs(found[k] - exact) <= 2 * world::kUnitsPerCell;
      }
    }
    EXPECT_GT(walls, 1000u) << config.name;
    EXPECT_GT(open, 10u) << config.name;
    EXPECT_LT(steps, 500u) << config.name;
    // The others: stairs, and corners that a line passes narrowly.
    EXPECT_GT(static_cast<double>(near), 0.97 * static_cast<double>(distances)) << config.name;
  }
}

}  // namespace
}  // namespace throng
