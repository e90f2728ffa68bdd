// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "baked.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "throng/world.h"

// WorldConfig::part: inside it is the world as it was baked, outside is nothing.
namespace throng {
namespace {

constexpr double kZone = 48;                                     // [m] 3 tiles of 64 cells
constexpr Box3d kPart{.min = {60, 0, 70}, .max = {90, 0, 120}};  // zones 1 x (1, 2)

class WorldPart : public testing::Test {
 protected:
  void SetUp() override {
    if (folder_ != nullptr) return;  // One bake for all tests.
    folder_ = new test::ScratchFolder;
    AvatarClass flyer{.name = "flyer", .height = 0.8, .radius = 0.4, .speed = 3};
    flyer.flies = true;
    Context context;
    const Scene scene = test::builtin({.name = "city", .size = 200});
    const auto report = bake_world_to(
        path(), scene, {.cell = 0.25, .zone = kZone, .classes = {default_classes().front(), flyer}},
        context);
    ASSERT_TRUE(report) << report.error().message;
    // With links between the air and nodes, which a part does without.
    const auto nodes = Nodes::create_in_folder(open(), scene, {}, context);
    ASSERT_TRUE(nodes) << nodes.error().message;
    ASSERT_TRUE(AirLinks::exist(open()));
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static std::string path() { return folder_->path() + "/city.throng"; }
  static World open(const WorldConfig& config = {}) {
    auto world = World::open(path(), config);
    EXPECT_TRUE(world) << world.error().message;
    return *world;
  }
  // Do all zones that the part has to keep hold it? By the zones' sides alone.
  static bool is_inside(const World& world, const Vec3d& p) {
    const Vec3d& origin = world.summary().origin;
    const auto zone = [](double at) { return static_cast<int>(std::floor(at / kZone)); };
    return zone(p.x - origin.x) == 1 && zone(p.z - origin.z) >= 1 && zone(p.z - origin.z) <= 2;
  }

  static test::ScratchFolder* folder_;
};
test::ScratchFolder* WorldPart::folder_ = nullptr;

TEST_F(WorldPart, IsTheWorldInsideAndNothingOutside) {
  const World whole = open(), part = open({.part = kPart});
  EXPECT_EQ(part.summary().zones, 2u);
  EXPECT_LT(part.summary().level_tiles, whole.summary().level_tiles);
  EXPECT_LT(part.summary().bytes, whole.summary().bytes);
  int inside = 0, outside = 0;
  for (uint64_t n = 0; n < 4000; ++n) {
    const Place place = whole.random_place(0, 7, n);
    const Place found = part.find_place(0, place.position, 0.01);
    if (!is_inside(whole, place.position)) {
      EXPECT_FALSE(found);
      ++outside;
      continue;
    }
    ++inside;
    ASSERT_TRUE(found);
    EXPECT_EQ(found.position.x, place.position.x);
    EXPECT_EQ(found.position.y, place.position.y);
    EXPECT_EQ(found.position.z, place.position.z);
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 1000);
}

TEST_F(WorldPart, NoWalkLeadsOut) {
  const World whole = open(), part = open({.part = kPart});
  int stopped = 0;
  for (uint64_t n = 0; n < 2000; ++n) {
    const Place from = part.random_place(0, 3, n);
    ASSERT_TRUE(is_inside(whole, from.position));
    const double dx = double(n % 41) - 20, dz = double(n % 37) - 18;
    const MoveResult move = part.move(0, from, dx, dz);
    EXPECT_TRUE(is_inside(whole, move.place.position));
    const Place same = whole.find_place(0, from.position, 0.01);
    const MoveResult all = whole.move(0, same, dx, dz);
    if (is_inside(whole, all.place.position)) continue;
    ++stopped;
    EXPECT_GT(length(move.place.position - all.place.position), 0);
  }
  EXPECT_GT(stopped, 50) << "too few walks came to the border";
}

TEST_F(WorldPart, AirBeyondItIsNotFree) {
  const auto make = [](const World& world) {
    Context context;
    auto finder = PathFinder::create(world, {.avatar_class = 1}, context);
    EXPECT_TRUE(finder) << finder.error().message;
    return *std::move(finder);
  };
  const World whole = open();
  PathFinder all = make(whole), some = make(open({.part = kPart}));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(0, 199), y(0, 30);
  int inside = 0, outside = 0;
  for (int n = 0; n < 4000; ++n) {
    const Vec3d at{x(random), y(random), x(random)};
    if (!all.is_free(at, 0)) {
      EXPECT_FALSE(some.is_free(at, 0)) << at.x << " " << at.y << " " << at.z;
      continue;
    }
    const bool is_near_border =
        !is_inside(whole, at + Vec3d{1, 0, 1}) || !is_inside(whole, at - Vec3d{1, 0, 1});
    if (!is_inside(whole, at)) {
      EXPECT_FALSE(some.is_free(at, 0)) << at.x << " " << at.y << " " << at.z;
      ++outside;
    } else if (!is_near_border) {
      EXPECT_TRUE(some.is_free(at, 0)) << at.x << " " << at.y << " " << at.z;
      ++inside;
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 1000);
}

TEST_F(WorldPart, HasComponentsOfItsOwnAndNoNodes) {
  const World whole = open(), part = open({.part = kPart});
  Context context;
  const auto of_whole = Graph::create(whole, {}, context);
  const auto of_part = Graph::create(part, {}, context);
  ASSERT_TRUE(of_whole && of_part);
  int pairs = 0;
  for (uint64_t n = 0; n < 500; ++n) {
    const Place a = part.random_place(0, 11, 2 * n), b = part.random_place(0, 11, 2 * n + 1);
    if (of_part->component_at(0, a) != of_part->component_at(0, b)) continue;
    ++pairs;
    EXPECT_EQ(of_whole->component_at(0, whole.find_place(0, a.position, 0.01)),
              of_whole->component_at(0, whole.find_place(0, b.position, 0.01)));
  }
  EXPECT_GT(pairs, 50);
  const auto nodes = Nodes::open(part);
  ASSERT_FALSE(nodes);
  EXPECT_EQ(nodes.error().code, Errc::kBadConfig);
  EXPECT_FALSE(AirLinks::exist(part));
}

TEST_F(WorldPart, RefusesABoxWithoutGround) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Box3d> boxes{{.min = {500, 0, 0}, .max = {600, 0, 10}},
                                 {.min = {50, 0, 0}, .max = {20, 0, 10}},
                                 {.min = {kNan, 0, 0}, .max = {20, 0, 10}},
                                 Box3d{}};
  for (const Box3d& box : boxes) {
    const auto world = World::open(path(), {.part = box});
    ASSERT_FALSE(world);
    EXPECT_EQ(world.error().code, Errc::kBadConfig) << world.error().message;
  }
}

TEST_F(WorldPart, CheckTouchedNamesADamagedZoneOnceItWasUsed) {
  test::ScratchFolder copy;
  const std::string name = copy.path() + "/w.throng";
  std::filesystem::copy(path(), name, std::filesystem::copy_options::recursive);
  const std::string zone = name + "/zone_0_0.thz";
  {
    std::fstream file(zone, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200);
    file.put('!');
    file.put('?');
  }
  const auto world = World::open(name);
  ASSERT_TRUE(world);
  EXPECT_FALSE(world->find_place(0, {110, 0.1, 110}, 40).position.x < 0);
  EXPECT_TRUE(world->check_touched());
  EXPECT_FALSE(world->find_place(0, {10, 0.1, 10}, 40));
  const auto touched = world->check_touched();
  ASSERT_FALSE(touched);
  EXPECT_NE(touched.error().message.find("zone_0_0.thz"), std::string::npos);
  // A part without that zone knows nothing of it.
  const auto part = World::open(name, {.part = kPart});
  ASSERT_TRUE(part);
  EXPECT_TRUE(part->check_ground());
}

}  // namespace
}  // namespace throng
