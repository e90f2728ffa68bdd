// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/picture.h"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "throng/bake.h"

namespace throng {
namespace {

// Two storeys of 40 x 20 m, 3 m apart, and a ramp between them along the middle.
Scene two_storeys_scene() {
  Scene scene;
  const auto sheet = [&](double x0, double z0, double x1, double z1, double y0, double y1) {
    scene.add_quad({x0, y0, z0}, {x0, y0, z1}, {x1, y1, z1}, {x1, y1, z0});
  };
  sheet(0, 0, 40, 20, 0, 0);
  sheet(0, 0, 40, 8, 3, 3);
  sheet(0, 12, 40, 20, 3, 3);
  sheet(28, 8, 40, 12, 3, 3);
  sheet(10, 8, 28, 12, 0, 3);
  return scene;
}
World two_storeys() {
  Context context;
  auto world = bake_world(two_storeys_scene(), {}, context);
  EXPECT_TRUE(world) << world.error().message;
  return *world;
}

TEST(Storeys, AFloorStaysOneStoreyAlthoughARampLeadsToTheNext) {
  const World world = two_storeys();
  const std::vector<int32_t> storeys = world.storeys();
  ASSERT_EQ(storeys.size(), world.level_tile_count());
  // Away from the ramp (z outside 6.4 to 12.8) each level tile lies on one floor alone.
  std::map<std::pair<int32_t, int32_t>, int32_t> cells;  // (storey, floor in mm) -> tiles
  for (uint32_t i = 0; i < world.level_tile_count(); ++i) {
    const LevelTileContent tile = world.level_tile(i);
    if (tile.tile_z == 1) continue;
    for (const int32_t floor : tile.floor) {
      if (floor != kNoFloor) ++cells[{storeys[i], floor}];
    }
  }
  ASSERT_EQ(cells.size(), 2u) << "one height in each of two storeys";
  EXPECT_EQ(cells.begin()->first, (std::pair{0, 0}));
  EXPECT_EQ(cells.rbegin()->first, (std::pair{1, 3000}));
}

TEST(NodePicture, DrawsNodesAndAWayFromFarBeyondThem) {
  Context context;
  const auto nodes = Nodes::make(two_storeys(), two_storeys_scene(), {}, context);
  ASSERT_TRUE(nodes) << nodes.error().message;
  NodePictureConfig config{.width = 600, .links = true, .area = {}, .path = {}, .title = ""};
  const auto all = draw_nodes(*nodes, config);
  ASSERT_TRUE(all) << all.error().message;
  config.path = {{-1e13, 1, 10}, {1e13, 1, 10}};
  const auto with_way = draw_nodes(*nodes, config);
  ASSERT_TRUE(with_way);
  ASSERT_EQ(with_way->rgb.size(), all->rgb.size());
  size_t changed = 0;
  for (size_t i = 0; i < all->rgb.size(); i += 3) changed += with_way->rgb[i] != all->rgb[i];
  EXPECT_GT(changed, 1000u);  // from side to side
  config.path.clear();
  config.storey = 1;
  const auto upper = draw_nodes(*nodes, config);
  ASSERT_TRUE(upper) << upper.error().message;
  EXPECT_NE(upper->rgb, all->rgb);
  config.storey = 7;
  EXPECT_EQ(draw_nodes(*nodes, config).error().code, Errc::kNotFound);
  config.storey = -1;
  config.avatar_class = 3;  // Giants keep farther from the rims.
  const auto giants = draw_nodes(*nodes, config);
  ASSERT_TRUE(giants) << giants.error().message;
  EXPECT_NE(giants->rgb, all->rgb);
  config.avatar_class = 4;
  EXPECT_EQ(draw_nodes(*nodes, config).error().code, Errc::kBadConfig);
}

TEST(Picture, DrawsABakedWorldForEachClass) {
  const World world = two_storeys();
  PictureConfig config;
  config.width = 600;
  const auto adult = draw_world(world, {}, config);
  ASSERT_TRUE(adult) << adult.error().message;
  EXPECT_EQ(adult->width, 600);
  config.avatar_class = *world.find_class("giant");
  const auto giant = draw_world(world, {}, config);
  ASSERT_TRUE(giant) << giant.error().message;
  EXPECT_NE(giant->rgb, adult->rgb);
  config.avatar_class = 4;
  const auto refused = draw_world(world, {}, config);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "picture: no avatar class 4; this world has 0 to 3");
}

}  // namespace
}  // namespace throng
