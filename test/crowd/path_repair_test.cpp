// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/obstacles/path_repair.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "crowd/obstacles/obstacle_set.h"
#include "path/edits/ground_finder.h"
#include "path/overlay/mesh_finder.h"
#include "world/place.h"
#include "worlds.h"

namespace throng {
namespace {

constexpr int32_t kStep = 400;  // mm

// The same crates on the ground of a crowd and on the ground of a GroundFinder.
struct Crated {
  World world;
  crowd::CrowdGround ground;
  crowd::ObstacleSet book;
  path::GroundFinder live;
  path::MeshFinder finder;

  Crated(World of, path::MeshFinder a_finder)
      : world(std::move(of)),
        ground(*crowd::CrowdGround::create(*data_of(world), 0, kStep)),
        book(world, world.summary().classes.size()),
        live(*path::GroundFinder::create(world, {})),
        finder(std::move(a_finder)) {
    book.open_class(0, ground, 0);
  }
  void put_up(const Prism& prism) {
    book.settle(book.add(prism, ObstacleKind::kStatic, true));
    book.block_cells();
    ASSERT_TRUE(live.add_obstacle({prism}));
  }
};

Crated crated(World world) {
  Context context;
  auto finder = path::MeshFinder::create(world, {}, context);
  EXPECT_TRUE(finder);
  return {std::move(world), *finder};
}

// Is each segment a legal move over the cells that are left?
bool is_open(const Crated& c, const Path& path) {
  for (size_t i = 1; i < path.points.size(); ++i) {
    const Place &a = path.points[i - 1], &b = path.points[i];
    uint32_t level = a.level1 - 1;
    const world::GroundPoint from = *world::ground_point(*data_of(c.world), a),
                             to = *world::ground_point(*data_of(c.world), b);
    if (!world::walk(c.ground, level, from, to, kStep) || level != b.level1 - 1) return false;
  }
  return true;
}

TEST(Detours, LeadAroundCratesAndAreHardlyLongerThanTheBest) {
  uint64_t covered = 0, reached = 0, searched_in_vain = 0;
  double ratios = 0, worst = 0;
  for (const char* name : {"garage", "church", "maze", "bridge"}) {
    Crated c = crated(test::bake(test::builtin({.name = name, .seed = 3}), 0.1));
    for (uint64_t i = 0; i < 50; ++i) {
      const Vec3d at = c.world.random_place(0, 8, i).position;
      c.put_up(Prism::circle(at, 0.2 + random_unit(8, 1, i), 1));
    }
    const crowd::StrideGround ground(c.ground, kStep);
    crowd::RepairScratch scratch;
    Path path, best;
    for (uint64_t i = 0; i < 150; ++i) {
      const Place from = c.world.random_place(0, 5, 2 * i),
                  to = c.world.random_place(0, 5, 2 * i + 1);
      if (!c.live.is_free(from)) continue;
      c.finder.find(from, to, path);
      if (path.end != PathEnd::kReached) continue;
      const double least = path.length;
      const bool was_open = is_open(c, path);
      crowd::lead_around(*data_of(c.world), c.live, ground, {}, path, scratch);
      c.live.find(from, to, best);
      ASSERT_EQ(path.end, best.end) << name << ' ' << i;
      if (was_open) {
        ASSERT_EQ(path.length, least);
        continue;
      }
      ++covered;
      if (path.end != PathEnd::kReached) {
        ++searched_in_vain;
        continue;
      }
      ASSERT_TRUE(is_open(c, path)) << name << ' ' << i;
      ASSERT_EQ(path.points.front().position.x, from.position.x);
      ASSERT_EQ(path.points.back().position.z, to.position.z);
      ASSERT_GE(path.length, least - 1e-6);
      ++reached;
      ratios += path.length / best.length;
      worst = std::max(worst, path.length - best.length);
    }
  }
  EXPECT_GT(covered, 100u);
  EXPECT_GT(searched_in_vain, 5u);
  EXPECT_LT(ratios / static_cast<double>(reached), 1.03);
  EXPECT_LT(worst, 2 * crowd::kMaxRepairDetour);
}

}  // namespace
}  // namespace throng
