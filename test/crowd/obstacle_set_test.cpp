// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/obstacles/obstacle_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "baked.h"
#include "core/access.h"
#include "core/hash.h"
#include "core/random.h"
#include "crowd/ground/leaving_ground.h"
#include "crowd/ground/stride_ground.h"
#include "world/place.h"
#include "worlds.h"

namespace throng {
namespace {

constexpr int32_t kStep = 400;  // mm

// All that a step reads of the ground.
uint64_t hash_of(const crowd::CrowdGround& ground) {
  uint64_t hash = 1;
  for (uint32_t level = 0; level < ground.records().size(); ++level) {
    const crowd::LevelLine& line = ground.line(level);
    const auto add = [&](const void* data, size_t bytes) { hash = hash_bytes(data, bytes, hash); };
    add(ground.legal(level), 512);
    add(ground.flat(level), 512);
    add(line.flat.data(), sizeof line.flat);
    add(line.beyond.data(), sizeof line.beyond);
    add(line.joined.data(), sizeof line.joined);
    add(&ground.records()[level].legal_cells, 4);
    const crowd::CrowdGround::Walk walk = ground.walk(level);
    const bool flags[] = {walk.is_step_safe, walk.is_isolated};
    add(flags, sizeof flags);
  }
  return hash;
}

struct Fixture {
  World world;
  crowd::CrowdGround ground;
  crowd::ObstacleSet obstacle_set;
  uint64_t n = 0;

  explicit Fixture(World of)
      : world(std::move(of)),
        ground(*crowd::CrowdGround::create(*data_of(world), 0, kStep)),
        obstacle_set(world, world.summary().classes.size()) {
    obstacle_set.open_class(0, ground, 0);
  }
  double draw() { return random_unit(9, 1, n++); }
  Prism random_prism() {
    const Vec3d at = world.random_place(0, 9, n++).position;
    const double low = at.y - 0.2 + 2 * draw() * draw();
    return Prism::circle({at.x, low, at.z}, 0.05 + 1.5 * draw() * draw(), 0.1 + 2 * draw(),
                         3 + static_cast<int>(20 * draw()));
  }
  uint32_t put_up(const Prism& prism) {
    const uint32_t slot = obstacle_set.add(prism, ObstacleKind::kStatic, true);
    obstacle_set.settle(slot);
    obstacle_set.block_cells();
    return slot;
  }
};

// Square of the distance of a point from a convex polygon, by a walk along its sides in fine steps:
// independent of the code that blocks cells.
double square_from(const Prism& prism, double x, double z) {
  bool left = true, right = true;
  double nearest = 1e300;
  for (size_t i = 0; i < prism.corners.size(); ++i) {
    const auto [ax, az] = prism.corners[i];
    const auto [bx, bz] = prism.corners[(i + 1) % prism.corners.size()];
    const double side = (bx - ax) * (z - az) - (bz - az) * (x - ax);
    left &= side >= 0;
    right &= side <= 0;
    for (int k = 0; k <= 64; ++k) {
      const double t = k / 64.0;
      nearest = std::min(nearest, std::hypot(ax + (bx - ax) * t - x, az + (bz - az) * t - z));
    }
  }
  return left || right ? 0 : nearest;
}

TEST(ObstacleSet, BlocksTheCellsOnWhichABodyCouldTouchAndFewMore) {
  uint64_t blocked = 0, left = 0;
  for (const Scene& scene : {worlds::two_floors(), worlds::ramp(20, 8), worlds::flat(14)}) {
    Fixture f(test::bake(scene, 0.1));
    const crowd::CrowdGround baked = *crowd::CrowdGround::create(*data_of(f.world), 0, kStep);
    const AvatarClass avatar = f.world.summary().classes[0];
    const double bottom = body_bottom(avatar), cell = f.world.summary().cell;
    const Vec3d origin = f.world.summary().origin;
    for (int round = 0; round < 10; ++round) {
      const Prism prism = f.random_prism();
      const uint32_t slot = f.put_up(prism);
      for (uint32_t level = 0; level < f.ground.records().size(); ++level) {
        const auto& record = f.ground.records()[level];
        for (int32_t c = 0; c < 4096; ++c) {
          const int32_t x = c % 64, z = c / 64;
          if (!baked.is_legal(level, x, z)) {
            ASSERT_FALSE(f.ground.is_legal(level, x, z));
            continue;
          }
          // Bodies at random points of the cell.
          const bool is_blocked = !f.ground.is_legal(level, x, z);
          bool touches = false, could = false;
          for (int k = 0; k < 3; ++k) {
            const world::GroundPoint p{(int64_t{record.tile_x * 64 + x} << world::kUnitBits) +
                                           static_cast<int64_t>(f.draw() * world::kUnitsPerCell),
                                       (int64_t{record.tile_z * 64 + z} << world::kUnitBits) +
                                           static_cast<int64_t>(f.draw() * world::kUnitsPerCell)};
            const double unit = cell / world::kUnitsPerCell;
            const double far =
                square_from(prism, origin.x + (static_cast<double>(p.x) + 0.5) * unit,
                            origin.z + (static_cast<double>(p.z) + 0.5) * unit);
            const double feet = baked.feet(level, p) * 1e-3;
            const double vertical_distance =
                std::max(feet + bottom - prism.high, prism.low - feet - avatar.height);
            touches |= far < avatar.radius && vertical_distance < 0;
            could |= far < avatar.radius + 1.5 * cell + 0.05 && vertical_distance < 0.12;
          }
          if (touches) {
            ASSERT_TRUE(is_blocked) << level << ' ' << x << ' ' << z;
          }
          if (is_blocked) {
            ASSERT_TRUE(could) << level << ' ' << x << ' ' << z;
          }
          ++(is_blocked ? blocked : left);
        }
      }
      f.obstacle_set.remove(slot);
      f.obstacle_set.block_cells();
    }
  }
  EXPECT_GT(blocked, 2000u);
  EXPECT_GT(left, 50000u);
}

TEST(ObstacleSet, FreesToTheBitWhatItBlocked) {
  for (const char* name : {"garage", "church", "maze"}) {
    Fixture f(test::bake(test::builtin({.name = name, .seed = 3}), 0.1));
    const uint64_t baked = hash_of(f.ground);
    std::vector<uint32_t> slots;
    for (int round = 0; round < 400; ++round) {
      if (slots.size() < 5 || f.draw() < 0.55) {
        slots.push_back(f.put_up(f.random_prism()));
        continue;
      }
      const size_t i = static_cast<size_t>(f.draw() * static_cast<double>(slots.size()));
      if (f.draw() < 0.5) {
        f.obstacle_set.request_move(slots[i], f.random_prism());
        f.obstacle_set.settle(slots[i]);
      } else {
        f.obstacle_set.remove(slots[i]);
        slots.erase(slots.begin() + static_cast<ptrdiff_t>(i));
      }
      f.obstacle_set.block_cells();
    }
    EXPECT_NE(hash_of(f.ground), baked);
    // What is left must equal what the same obstacles leave of a new ground.
    crowd::CrowdGround rebuilt = *crowd::CrowdGround::create(*data_of(f.world), 0, kStep);
    crowd::ObstacleSet again(f.world, f.world.summary().classes.size());
    again.open_class(0, rebuilt, 0);
    for (const uint32_t slot : slots) {
      again.settle(again.add(f.obstacle_set.at(slot).place, ObstacleKind::kStatic, true));
    }
    again.block_cells();
    EXPECT_EQ(hash_of(f.ground), hash_of(rebuilt)) << name;
    for (const uint32_t slot : slots) f.obstacle_set.remove(slot);
    f.obstacle_set.block_cells();
    EXPECT_EQ(hash_of(f.ground), baked) << name;
  }
}

// Random orders, as a crowd gives them: what is kept by slot must be what a look at all shows, and
// exits that are counted again around a change must be those of a search everywhere.
void change_at_random(Fixture f, const std::function<Prism(Fixture&)>& draw_prism) {
  std::vector<uint32_t> slots, all_levels;
  uint64_t waited = 0, left = 0;
  for (uint32_t level = 0; level < f.ground.records().size(); ++level) all_levels.push_back(level);
  const auto exits = [&] {
    std::vector<uint16_t> steps;
    for (const uint32_t level : all_levels) {
      for (int32_t cell = 0; cell < 4096; ++cell) {
        steps.push_back(f.ground.left().steps_out({level, cell % 64, cell / 64}));
      }
    }
    return steps;
  };
  for (int round = 0; round < 200; ++round) {
    const double what = f.draw();
    const uint32_t slot =
        slots.size() < 20 || what < 0.2
            ? slots.emplace_back(f.obstacle_set.add(draw_prism(f), ObstacleKind::kStatic, true))
            : slots[static_cast<size_t>(f.draw() * static_cast<double>(slots.size()))];
    if (what < 0.3) {
      f.obstacle_set.request_move(slot, draw_prism(f));
    } else if (what < 0.4) {
      f.obstacle_set.request_active(slot, f.draw() < 0.5);
    } else if (what < 0.6) {
      if (f.obstacle_set.at(slot).waits()) f.obstacle_set.settle(slot);
    } else if (what < 0.85) {
      if (f.obstacle_set.at(slot).wanted_up) {
        f.obstacle_set.set_exit_only(slot, true);
        f.obstacle_set.close(slot);
      }
    } else {
      f.obstacle_set.remove(slot);
      std::erase(slots, slot);
    }
    f.obstacle_set.block_cells();
    std::vector<uint32_t> waiting;
    bool cuts_paths = false;
    for (const uint32_t one : slots) {
      const crowd::CrowdObstacle& obstacle = f.obstacle_set.at(one);
      if (obstacle.waits() || obstacle.is_exit_only) waiting.push_back(one);
      cuts_paths |= obstacle.has_cells;
    }
    std::sort(waiting.begin(), waiting.end());
    const auto kept = f.obstacle_set.waiting();
    ASSERT_EQ(std::vector(kept.begin(), kept.end()), waiting) << round;
    ASSERT_EQ(f.obstacle_set.cuts_paths(), cuts_paths);
    waited += waiting.size();
    const std::vector<uint16_t> counted = exits();
    left += crowd::find_exits(f.ground, kStep, all_levels);
    ASSERT_EQ(counted, exits()) << round;
  }
  EXPECT_GT(waited, 500u);
  EXPECT_GT(left, 1000u);
}

TEST(ObstacleSet, KeepsWhatWaitsAndCountsExitsAsALookAtAllDoes) {
  change_at_random(Fixture(test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1)),
                   [](Fixture& f) { return f.random_prism(); });
}

TEST(ObstacleSet, CountsExitsOverTheBordersOfTiles) {
  // On both sides of the border of two tiles, at 6.347 m: the cells that are taken end at it.
  change_at_random(Fixture(test::bake(worlds::flat(14), 0.1)), [](Fixture& f) {
    const double x = f.draw() < 0.5 ? 6.02 : 6.64, z = 1 + 11 * f.draw();
    return Prism::box({x, 0, z}, {x + 0.05, 2, z + 0.1 + 0.5 * f.draw()});
  });
}

TEST(ObstacleSet, AChangeTouchesNothingElsewhereHoweverManyStandThere) {
  Fixture f(test::bake(worlds::flat(100), 0.1));
  std::vector<size_t> changed, counted;
  for (const int side : {4, 8, 16, 32}) {
    for (int i = 0; i < side * side; ++i) {
      const double x = 3.0 * (i % side) + 3, z = 3.0 * static_cast<double>(i / side) + 3;
      const Prism crate = Prism::box({x, 0, z}, {x + 0.5, 2, z + 0.5});
      const uint32_t slot = f.obstacle_set.add(crate, ObstacleKind::kStatic, true);
      f.obstacle_set.set_exit_only(slot, true);
      f.obstacle_set.close(slot);
    }
    f.obstacle_set.block_cells();
    (void)f.obstacle_set.take_changed();
    const uint32_t slot = f.put_up(Prism::box({1, 0, 1}, {1.5, 2, 1.5}));
    changed.push_back(f.obstacle_set.take_changed().size());
    f.obstacle_set.remove(slot);
    f.obstacle_set.block_cells();
    const std::array<uint32_t, 1> first{0};  // the level of a tile
    counted.push_back(crowd::find_exits(f.ground, kStep, first));
  }
  EXPECT_EQ(changed, (std::vector<size_t>{1, 1, 1, 1}));
  EXPECT_GT(counted[0], 0u);
  EXPECT_LE(counted[3], 2 * counted[0]);
}

TEST(ObstacleSet, MemoryDoesNotGrowAsObstaclesComeAndGo) {
  Fixture f(test::bake(worlds::flat(14), 0.1));
  const auto come_and_go = [&] {
    f.obstacle_set.remove(f.put_up(Prism::box({5, 0, 5}, {8, 1, 8})));
    f.obstacle_set.block_cells();
  };
  come_and_go();
  const uint64_t ground = f.ground.bytes(), obstacle_set = f.obstacle_set.bytes();
  for (int i = 0; i < 100; ++i) come_and_go();
  EXPECT_EQ(f.ground.bytes(), ground);
  EXPECT_EQ(f.obstacle_set.bytes(), obstacle_set);
}

// The ground as it was baked, without the cells blocked in `now`: uses none of its lines, sets or
// joins.
struct PlainGround {
  using Level = world::GroundLevel;
  world::WorldGround baked;
  const crowd::CrowdGround& now;
  [[nodiscard]] bool is_legal(const Level& level, int32_t x, int32_t z) const {
    return baked.is_legal(level, x, z) && now.is_legal(level.world_level, x, z);
  }
  [[nodiscard]] int32_t sample(const Level& level, int32_t x, int32_t z) const {
    return baked.sample(level, x, z);
  }
  [[nodiscard]] bool step_safe(const Level& level) const { return baked.step_safe(level); }
  template <class Visit>
  void for_tile(int32_t x, int32_t z, int32_t low, int32_t high, Visit visit) const {
    baked.for_tile(x, z, low, high, visit);
  }
};

TEST(ObstacleSet, FastMovesAreThoseOfThePlainGround) {
  uint64_t legal_moves = 0, moves = 0, over_edges = 0;
  for (const char* name : {"garage", "church", "stairs", "landscape"}) {
    Fixture f(test::bake(test::builtin({.name = name, .seed = 3}), 0.1));
    for (int i = 0; i < 60; ++i) f.put_up(f.random_prism());
    const crowd::StrideGround stride(f.ground, kStep);
    const PlainGround plain{{*data_of(f.world), 0}, f.ground};
    for (int i = 0; i < 30000; ++i) {
      const Place place = f.world.random_place(0, 31, static_cast<uint64_t>(i));
      const auto from = *world::ground_point(*data_of(f.world), place);
      uint32_t level = place.level1 - 1;
      if (!f.ground.is_legal(level, from.cell_x() & 63, from.cell_z() & 63)) continue;
      const auto offset = [&] {
        return static_cast<int64_t>((f.draw() * 8 - 4) * world::kUnitsPerCell);
      };
      const world::GroundPoint to{from.x + offset(), from.z + offset()};
      crowd::StrideGround::Landing landing;
      const bool moved = stride.move(level, f.ground.feet(level, from), from, to, landing);
      world::GroundLevel on = world::ground_level(*data_of(f.world), level, 0);
      const bool expected = world::walk(plain, on, from, to, kStep);
      ASSERT_EQ(moved, expected) << name << ' ' << i;
      ++moves;
      legal_moves += expected;
      if (!expected) continue;
      ASSERT_EQ(landing.level, on.world_level);
      over_edges += landing.level != level;
    }
  }
  EXPECT_GT(legal_moves, moves / 3);
  EXPECT_LT(legal_moves, moves);
  EXPECT_GT(over_edges, 1000u);
}

TEST(ObstacleSet, TheHullOfTwoPrismsHoldsAllBetween) {
  uint64_t n = 0;
  const auto draw = [&] { return random_unit(4, 4, n++); };
  for (int round = 0; round < 300; ++round) {
    const Prism a = Prism::circle({draw(), draw(), draw()}, 0.1 + draw(), draw() + 0.1,
                                  3 + static_cast<int>(10 * draw()));
    Prism b = a;
    const double dx = 4 * draw() - 2, dz = draw() < 0.2 ? 0 : 4 * draw() - 2;
    for (auto& [x, z] : b.corners) {
      x += dx;
      z += dz;
    }
    b.low -= draw();
    const Prism hull = crowd::hull_of(a, b);
    ASSERT_TRUE(check_prism(hull)) << check_prism(hull).error().message;
    EXPECT_LE(hull.low, std::min(a.low, b.low));
    EXPECT_GE(hull.high, std::max(a.high, b.high));
    for (const auto& [x, z] : a.corners) {
      const double t = draw();
      EXPECT_LT(square_from(hull, x + t * dx, z + t * dz), 0.05);
    }
  }
}

}  // namespace
}  // namespace throng
