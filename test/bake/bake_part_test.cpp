// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "baked.h"
#include "folder_bytes.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/world.h"

// BakeConfig::part: parts one after the other make the bytes of one bake.
namespace throng {
namespace {

using Folder = test::FolderBytes;

BakeConfig config_of(const std::optional<Box3d>& part, int32_t workers = 0) {
  AvatarClass flyer{.name = "flyer", .height = 0.8, .radius = 0.4, .speed = 3};
  flyer.flies = true;
  BakeConfig config{.cell = 0.25, .classes = {default_classes().front(), flyer}};
  config.part = part;
  config.zone = 48;
  config.workers = workers;
  return config;
}

Box3d square(double x0, double z0, double x1, double z1) {
  return {.min = {x0, 0, z0}, .max = {x1, 0, z1}};
}

class BakePart : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path() + name; }
  Result<BakeReport> bake(const std::string& name, const Scene& scene,
                          const std::optional<Box3d>& part, int32_t workers = 0) {
    Context context;
    return bake_world_to(path(name), scene, config_of(part, workers), context);
  }

  test::ScratchFolder folder_;
};

TEST_F(BakePart, PartsInAnyOrderMakeTheBytesOfOneBake) {
  const Scene scene = test::builtin({.name = "city", .size = 200});
  ASSERT_TRUE(bake("/whole", scene, {}));
  const Folder whole = test::folder_bytes(path("/whole"));
  // They overlap, in zones and at borders; the last lacks nothing.
  const std::array<Box3d, 4> parts{square(100, -20, 260, 90), square(0, 100, 90, 210),
                                   square(-50, -50, 110, 100), square(95, 95, 200, 200)};
  for (const auto& order :
       {std::array{0, 1, 2, 3}, std::array{3, 1, 0, 2}, std::array{2, 3, 1, 0}}) {
    const std::string name = "/parts" + std::to_string(order[0]);
    uint64_t baked = 0, zones = 0;
    for (const int n : order) {
      const auto report = bake(name, scene, parts[static_cast<size_t>(n)], 1 + n % 2);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_EQ(report->zones_reused, zones) << "all that were there are kept";
      EXPECT_GT(report->zones_baked, 0u);
      baked += report->zones_baked;
      EXPECT_GT(report->zones, zones);
      zones = report->zones;
      EXPECT_TRUE(World::open(path(name))->check_all());
    }
    EXPECT_EQ(baked, zones) << "a zone was baked twice";
    EXPECT_TRUE(test::folder_bytes(path(name)) == whole) << name;
  }
}

TEST_F(BakePart, WorldsOfPartsJoinToTheBytesOfOneBake) {
  const Scene scene = test::builtin({.name = "city", .size = 200});
  ASSERT_TRUE(bake("/whole", scene, {}));
  ASSERT_TRUE(bake("/a", scene, square(-10, -10, 60, 210)));
  ASSERT_TRUE(bake("/b", scene, square(50, -10, 210, 100)));  // one column of both
  ASSERT_TRUE(bake("/c", scene, square(100, 97, 210, 210)));
  const Folder a = test::folder_bytes(path("/a"));
  Context context;
  for (const int32_t workers : {1, 2}) {
    const auto report =
        join_worlds({path("/c"), path("/a"), path("/b")}, path("/joined"), workers, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->zones_baked, 0u);
    EXPECT_TRUE(test::folder_bytes(path("/joined")) == test::folder_bytes(path("/whole")));
  }
  EXPECT_TRUE(test::folder_bytes(path("/a")) == a) << "a world that was joined has changed";
  // Into one of them, and of two alone.
  ASSERT_TRUE(join_worlds({path("/a"), path("/b")}, path("/a"), 0, context));
  EXPECT_TRUE(World::open(path("/a"))->check_all());
  ASSERT_TRUE(bake("/ab", scene, square(-10, -10, 60, 210)));
  ASSERT_TRUE(bake("/ab", scene, square(50, -10, 210, 100)));
  EXPECT_TRUE(test::folder_bytes(path("/a")) == test::folder_bytes(path("/ab")));
}

TEST_F(BakePart, WorldsThatDoNotFitAreNotJoined) {
  const Scene city = test::builtin({.name = "city", .size = 200});
  Scene other = city;  // A triangle of a zone of both lies lower.
  const auto lies_in = [&](const auto& corners) {
    return std::all_of(corners.begin(), corners.end(), [&](uint32_t corner) {
      const Vec3d p = city.positions[corner];
      return p.x > 60 && p.x < 90 && p.z > 60 && p.z < 90;
    });
  };
  const auto moved = std::find_if(city.triangles.begin(), city.triangles.end(), lies_in);
  ASSERT_NE(moved, city.triangles.end());
  other.positions[(*moved)[0]].y -= 0.01;
  ASSERT_TRUE(bake("/a", city, square(-10, -10, 100, 210)));
  ASSERT_TRUE(bake("/b", test::builtin({.name = "city", .size = 150}), {}));
  ASSERT_TRUE(bake("/c", other, square(-10, -10, 210, 210)));
  Context context;
  for (const auto& worlds :
       {std::vector{path("/a"), path("/b")}, {path("/a"), path("/none")}, {}}) {
    const auto report = join_worlds(worlds, path("/joined"), 0, context);
    ASSERT_FALSE(report);
    EXPECT_FALSE(report.error().message.empty());
  }
  const auto report = join_worlds({path("/a"), path("/c")}, path("/joined"), 0, context);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::kBadInput);
  EXPECT_NE(report.error().message.find("zone 1, 1"), std::string::npos) << report.error().message;
  // A damaged file is named, and nothing is written.
  std::filesystem::resize_file(path("/a/zone_0_0.thz"), 100);
  const auto damaged = join_worlds({path("/a")}, path("/d"), 0, context);
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().code, Errc::kBadFile);
  EXPECT_NE(damaged.error().message.find("zone_0_0.thz"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("/d")));
}

TEST_F(BakePart, OneDistrictHasTheFilesOfItsZonesAlone) {
  const Scene scene = test::builtin({.name = "city", .size = 200});
  ASSERT_TRUE(bake("/whole", scene, {}));
  ASSERT_TRUE(bake("/part", scene, square(60, 70, 90, 120)));
  const Folder whole = test::folder_bytes(path("/whole")), part = test::folder_bytes(path("/part"));
  int zones = 0;
  for (const auto& [name, bytes] : part) {
    if (name.ends_with(".thz") || name.ends_with(".tha")) {
      ++zones;
      EXPECT_TRUE(name.starts_with("zone_1_1.") || name.starts_with("zone_1_2.")) << name;
      EXPECT_EQ(bytes, whole.at(name)) << name;
    }
  }
  EXPECT_EQ(zones, 4);
  // The same as the whole world opened in part.
  const auto a = World::open(path("/part"));
  const auto b = World::open(path("/whole"), {.part = square(60, 70, 90, 120)});
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->summary().level_tiles, b->summary().level_tiles);
  for (uint64_t n = 0; n < 200; ++n) {
    const Place place = a->random_place(0, 1, n), same = b->random_place(0, 1, n);
    EXPECT_EQ(length(place.position - same.position), 0);
  }
  // A bake of all completes it.
  const auto report = bake("/part", scene, {});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->zones_reused, 2u);
  EXPECT_TRUE(test::folder_bytes(path("/part")) == whole);
}

TEST_F(BakePart, RefusesAWorldOfOtherInputBesideIt) {
  Scene scene = test::builtin({.name = "city", .size = 200});
  ASSERT_TRUE(bake("/w", scene, {}));
  const Folder before = test::folder_bytes(path("/w"));
  // A slab far from the part.
  const auto first = static_cast<uint32_t>(scene.positions.size());
  for (const Vec3d& p : {Vec3d{180, 3, 180}, Vec3d{180, 3, 185}, Vec3d{185, 3, 180}}) {
    scene.positions.push_back(p);
  }
  scene.triangles.push_back({first, first + 1, first + 2});
  scene.area.push_back(kAreaWalkable);
  const auto refused = bake("/w", scene, square(10, 10, 20, 20));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kBadConfig);
  EXPECT_NE(refused.error().message.find("zone 3, 3"), std::string::npos)
      << refused.error().message;
  EXPECT_TRUE(test::folder_bytes(path("/w")) == before);
  const auto baked = bake("/w", scene, square(150, 150, 200, 200));
  ASSERT_TRUE(baked) << baked.error().message;
  ASSERT_TRUE(bake("/again", scene, {}));
  EXPECT_TRUE(test::folder_bytes(path("/w")) == test::folder_bytes(path("/again")));
}

TEST_F(BakePart, AJoinDoesWithoutNoAirFile) {
  const Scene scene = test::builtin({.name = "city", .size = 200});
  ASSERT_TRUE(bake("/a", scene, square(-10, -10, 100, 210)));
  ASSERT_TRUE(bake("/b", scene, square(100, -10, 210, 210)));
  Context context;
  const std::string file = path("/a/zone_0_0.tha");
  ASSERT_TRUE(std::filesystem::exists(file));
  for (const bool is_there : {true, false}) {
    if (is_there) std::filesystem::resize_file(file, std::filesystem::file_size(file) - 8);
    if (!is_there) std::filesystem::remove(file);
    const auto joined = join_worlds({path("/a"), path("/b")}, path("/c"), 0, context);
    ASSERT_FALSE(joined);
    EXPECT_EQ(joined.error().code, Errc::kBadFile);
    EXPECT_NE(joined.error().message.find("zone_0_0.tha"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("/c")));
  }
}

// Zones beside a part are never lost.
TEST_F(BakePart, RefusesToTakeTheOtherZonesAway) {
  const Scene scene = test::builtin({.name = "city", .size = 200});
  ASSERT_TRUE(bake("/w", scene, {}));
  const Folder before = test::folder_bytes(path("/w"));
  BakeConfig config = config_of(square(10, 10, 20, 20));
  config.old_zones = OldZones::kBakeAgain;
  Context context;
  const auto again = bake_world_to(path("/w"), scene, config, context);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Errc::kBadConfig);
  EXPECT_TRUE(test::folder_bytes(path("/w")) == before);
  std::filesystem::resize_file(path("/w/manifest.thm"), 100);
  const auto unread = bake("/w", scene, square(10, 10, 20, 20));
  ASSERT_FALSE(unread);
  EXPECT_EQ(unread.error().code, Errc::kBadFile);
  EXPECT_EQ(test::folder_bytes(path("/w")).size(), before.size());
}

TEST_F(BakePart, RefusesBoxesWithoutGroundAndNodes) {
  const Scene scene = test::builtin({.name = "cube"});
  for (const Box3d& box : {square(1000, 0, 1010, 10), square(5, 5, 2, 2), Box3d{}}) {
    const auto report = bake("/w", scene, box);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, Errc::kBadConfig) << report.error().message;
  }
  NodeConfig nodes;
  BakeConfig config = config_of(square(0, 0, 5, 5));
  config.nodes = &nodes;
  Context context;
  EXPECT_FALSE(bake_world_to(path("/w"), scene, config, context));
  EXPECT_FALSE(std::filesystem::exists(path("/w")));
  // In memory it is the part alone.
  const auto world = bake_world(test::builtin({.name = "city", .size = 200}),
                                config_of(square(60, 70, 90, 120)), context);
  ASSERT_TRUE(world);
  EXPECT_EQ(world->summary().zones, 2u);
}

}  // namespace
}  // namespace throng
