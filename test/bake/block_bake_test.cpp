// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "folder_bytes.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/surface.h"
#include "throng/world.h"

// Bakes of scenes that are read block by block give the bytes of bakes of the whole.
namespace throng {
namespace {

BakeConfig config_of(uint64_t block_bytes, int32_t workers) {
  AvatarClass flyer{.name = "flyer", .height = 0.8, .radius = 0.4, .speed = 3};
  flyer.flies = true;
  BakeConfig config{.cell = 0.25, .classes = {default_classes().front(), flyer}};
  config.block_bytes = block_bytes;
  config.zone = 48;
  config.workers = workers;
  return config;
}

class BlockBake : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path() + name; }

  Result<BakeReport> bake_whole(const std::vector<BuiltinWorldConfig>& worlds) {
    Scene scene;
    for (const BuiltinWorldConfig& world : worlds) {
      const auto made = create_builtin_world(world);
      if (!made) return made.error();
      scene.append(*made);
    }
    Context context;
    return bake_world_to(path("/whole"), scene, config_of(1, 2), context);
  }

  Result<BakeReport> bake(const std::string& name, const std::vector<BuiltinWorldConfig>& worlds,
                          const BakeConfig& config) {
    Context context;
    const auto scene = load_scene_regions({}, worlds, folder_.path(), context);
    if (!scene) return scene.error();
    return bake_world_to(path(name), **scene, config, context);
  }

  void expect_same_bytes(const std::vector<BuiltinWorldConfig>& worlds) {
    const auto whole = bake_whole(worlds);
    ASSERT_TRUE(whole) << whole.error().message;
    const auto bytes = test::folder_bytes(path("/whole"));
    for (const uint64_t block : {uint64_t{1}, uint64_t{4} << 20, uint64_t{1} << 30}) {
      for (const int32_t workers : {1, 2}) {
        const std::string name = "/by" + std::to_string(block) + std::to_string(workers);
        const auto report = bake(name, worlds, config_of(block, workers));
        ASSERT_TRUE(report) << report.error().message;
        EXPECT_EQ(report->zones, whole->zones);
        EXPECT_EQ(report->zones_baked, whole->zones_baked);
        EXPECT_EQ(report->walkable_area, whole->walkable_area);
        EXPECT_EQ(report->air_zones, whole->air_zones);
        EXPECT_TRUE(test::folder_bytes(path(name)) == bytes) << name;
        std::filesystem::remove_all(path(name));
      }
    }
  }

  test::ScratchFolder folder_;
};

TEST_F(BlockBake, OfALandscapeGivesTheBytesOfTheWhole) {
  expect_same_bytes({{.name = "landscape", .size = 200}});
}

TEST_F(BlockBake, OfACityOnALandscapeGivesTheBytesOfTheWhole) {
  expect_same_bytes({{.name = "city", .size = 120}, {.name = "landscape", .size = 150, .seed = 4}});
}

TEST_F(BlockBake, ReusesWhatIsThereFromTheSameInput) {
  const std::vector<BuiltinWorldConfig> worlds{{.name = "city", .size = 150}};
  ASSERT_TRUE(bake_whole(worlds));
  const auto bytes = test::folder_bytes(path("/whole"));
  const auto again = bake("/whole", worlds, config_of(1 << 20, 2));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->zones_baked, 0u);
  EXPECT_EQ(again->zones_reused, again->zones);
  EXPECT_EQ(again->air_zones_reused, again->air_zones);
  EXPECT_TRUE(test::folder_bytes(path("/whole")) == bytes);
}

TEST_F(BlockBake, PartsOfABlockBakeMakeTheWhole) {
  const std::vector<BuiltinWorldConfig> worlds{{.name = "landscape", .size = 200}};
  ASSERT_TRUE(bake_whole(worlds));
  BakeConfig config = config_of(1 << 20, 2);
  const auto part = [&](double x0, double z0, double x1, double z1) {
    config.part = Box3d{.min = {x0, 0, z0}, .max = {x1, 0, z1}};
    return bake("/parts", worlds, config);
  };
  const auto first = part(-10, -10, 90, 220);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->zones_reused, 0u);
  const auto second = part(80, -10, 220, 220);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->zones_baked + first->zones, second->zones);
  EXPECT_TRUE(test::folder_bytes(path("/parts")) == test::folder_bytes(path("/whole")));
  const auto beside = part(500, 500, 600, 600);
  ASSERT_FALSE(beside);
  EXPECT_EQ(beside.error().code, Errc::kBadConfig);
}

TEST_F(BlockBake, LeavesTheOldWorldWhenItFailsOrIsCancelled) {
  const std::vector<BuiltinWorldConfig> worlds{{.name = "landscape", .size = 200}};
  ASSERT_TRUE(bake_whole(worlds));
  const auto bytes = test::folder_bytes(path("/whole"));
  Context context;
  const auto scene = load_scene_regions({}, {{{.name = "landscape", .size = 200, .seed = 2}}},
                                        folder_.path(), context);
  ASSERT_TRUE(scene);
  int calls = 0;
  context.on_progress = [&](const Progress& progress) {
    EXPECT_LE(progress.done, progress.total);
    if (++calls == 5) context.cancel = true;
  };
  const auto report = bake_world_to(path("/whole"), **scene, config_of(1, 1), context);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::kCancelled);
  EXPECT_TRUE(test::folder_bytes(path("/whole")) == bytes);
  Context other;
  BakeConfig none = config_of(0, 1);
  EXPECT_EQ(bake_world_to(path("/w"), **scene, none, other).error().code, Errc::kBadConfig);
  // Links that lead nowhere are found before the world is written, as in a whole scene.
  NodeConfig nodes;
  nodes.off_mesh_links.push_back({{60, 500, 60}, {80, 500, 80}, 0, true});
  BakeConfig links = config_of(1, 1);
  links.nodes = &nodes;
  const auto by_block = bake_world_to(path("/w"), **scene, links, other);
  const auto whole = create_builtin_world({.name = "landscape", .size = 200, .seed = 2});
  const auto at_once = bake_world_to(path("/w"), *whole, links, other);
  ASSERT_FALSE(by_block || at_once);
  EXPECT_EQ(by_block.error().code, Errc::kBadInput);
  EXPECT_EQ(by_block.error().message, at_once.error().message);
  EXPECT_FALSE(std::filesystem::exists(path("/w")));
}

}  // namespace
}  // namespace throng
