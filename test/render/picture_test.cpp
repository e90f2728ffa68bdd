// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <climits>
#include <map>

#include "baked.h"
#include "throng/bake.h"

namespace throng {
namespace {

// Two storeys of 40 x 20 m, 3 m apart, and a ramp between them along the middle.
Scene two_storeys_scene() {
  Scene scene;
  const auto floor_quad = [&](double x0, double z0, double x1, double z1, double y0, double y1) {
    scene.add_quad({x0, y0, z0}, {x0, y0, z1}, {x1, y1, z1}, {x1, y1, z0});
  };
  floor_quad(0, 0, 40, 20, 0, 0);
  floor_quad(0, 0, 40, 8, 3, 3);
  floor_quad(0, 12, 40, 20, 3, 3);
  floor_quad(28, 8, 40, 12, 3, 3);
  floor_quad(10, 8, 28, 12, 0, 3);
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

TEST(NodePicture, DrawsNodesAndAPathThatStartsFarBeyondThem) {
  Context context;
  const auto nodes = Nodes::create(two_storeys(), two_storeys_scene(), {}, context);
  ASSERT_TRUE(nodes) << nodes.error().message;
  NodePictureConfig config{.width = 600, .links = true, .area = {}, .path = {}, .title = ""};
  const auto all = draw_nodes(*nodes, config);
  ASSERT_TRUE(all) << all.error().message;
  config.path = {{-1e13, 1, 10}, {1e13, 1, 10}};
  const auto with_path = draw_nodes(*nodes, config);
  ASSERT_TRUE(with_path);
  ASSERT_EQ(with_path->rgb.size(), all->rgb.size());
  size_t changed = 0;
  for (size_t i = 0; i < all->rgb.size(); i += 3) changed += with_path->rgb[i] != all->rgb[i];
  EXPECT_GT(changed, 1000u);  // from side to side
  config.path.clear();
  config.storey = 1;
  const auto upper = draw_nodes(*nodes, config);
  ASSERT_TRUE(upper) << upper.error().message;
  EXPECT_NE(upper->rgb, all->rgb);
  config.storey = 7;
  EXPECT_EQ(draw_nodes(*nodes, config).error().code, Errc::kNotFound);
  config.storey = -1;
  config.avatar_class = 3;  // Giants stay farther from the rims.
  const auto giants = draw_nodes(*nodes, config);
  ASSERT_TRUE(giants) << giants.error().message;
  EXPECT_NE(giants->rgb, all->rgb);
  config.avatar_class = 4;
  EXPECT_EQ(draw_nodes(*nodes, config).error().code, Errc::kBadConfig);
}

struct Pixels {
  size_t count = 0;
  int32_t first_row = INT32_MAX, last_row = -1;
};

// Below the text at the top.
template <class Accept>
Pixels pixels(const Image& image, Accept accept) {
  Pixels found;
  for (int32_t y = 64; y < image.height; ++y) {
    for (int32_t x = 0; x < image.width; ++x) {
      const auto at =
          3 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x));
      if (!accept(image.rgb[at], image.rgb[at + 1], image.rgb[at + 2])) continue;
      ++found.count;
      found.first_row = std::min(found.first_row, y);
      found.last_row = std::max(found.last_row, y);
    }
  }
  return found;
}

bool is_blue(int r, int g, int b) { return r < 130 && g < 160 && b > 180; }
// Of ground, by how much red is in it: the ramp's 9 degrees are greener than 25, level floor more.
bool is_level(int r, int g, int b) { return g > 100 && r < g / 2 && b < 120; }
bool is_inclined(int r, int g, int b) {
  return g > 100 && r > g * 3 / 5 && r < g * 4 / 5 && b < 120;
}
bool is_steep(int r, int g, int b) { return r > 130 && r > g * 9 / 10 && b < 120; }

TEST(NodePicture, LevelFloorBesideWallsIsGreen) {
  Context context;
  Scene scene = two_storeys_scene();
  scene.add_quad({20, 0, 3}, {20, 0, 5}, {20, 2, 5}, {20, 2, 3});  // a wall
  const auto world = bake_world(scene, {}, context);
  ASSERT_TRUE(world) << world.error().message;
  const auto nodes = Nodes::create(*world, scene, {}, context);
  ASSERT_TRUE(nodes) << nodes.error().message;
  for (const int32_t avatar_class : {-1, 0}) {
    NodePictureConfig config{.width = 600, .area = {}, .path = {}, .title = ""};
    config.avatar_class = avatar_class;
    const auto image = draw_nodes(*nodes, config);
    ASSERT_TRUE(image) << image.error().message;
    const int32_t legend = image->height - 58;
    const auto on_map = [&](auto accept) {
      Image map = *image;
      map.height = legend;
      return pixels(map, accept);
    };
    EXPECT_EQ(on_map(is_steep).count, 0u);
    EXPECT_GT(on_map(is_inclined).count, 1000u);  // the ramp
    EXPECT_GT(on_map(is_level).count, 20000u);
  }
}

// At the rim of the ground, corners of the blocks of partial nodes have no floor.
TEST(NodePicture, GroundFillsThePicture) {
  Context context;
  const Scene scene = test::builtin({.name = "stairs"});
  const auto nodes = Nodes::create(test::bake(scene, 0.2), scene, {}, context);
  ASSERT_TRUE(nodes) << nodes.error().message;
  const auto image = draw_nodes(*nodes, {.width = 600, .area = {}, .path = {}, .title = ""});
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_LT(pixels(*image, is_level).first_row, 64 + 24);
}

// If a pixel spans metres, the rim of a path that leads away from the eye lies nearer than the
// path.
TEST(NodePicture, APathOverAWideMapIsBlueEverywhereAlsoUnderLinks) {
  Context context;
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 300}, {300, 0, 300}, {300, 0, 0});
  const auto world = bake_world(scene, {.cell = 0.5}, context);
  ASSERT_TRUE(world) << world.error().message;
  const auto nodes = Nodes::create(*world, scene, {}, context);
  ASSERT_TRUE(nodes) << nodes.error().message;
  NodePictureConfig config{.width = 200, .area = {}, .path = {}, .title = ""};
  config.path = {{150, 0, 20}, {150, 0, 100}, {150, 0, 190}, {150, 0, 280}};
  for (const bool links : {false, true}) {
    config.links = links;
    const auto image = draw_nodes(*nodes, config);
    ASSERT_TRUE(image) << image.error().message;
    const Pixels blue = pixels(*image, is_blue);
    EXPECT_GT(blue.count, static_cast<size_t>(blue.last_row - blue.first_row));
    EXPECT_GT(blue.last_row - blue.first_row, 60);
  }
}

TEST(NodePicture, APathIsDrawnOnTheMapOnly) {
  Context context;
  const auto nodes = Nodes::create(two_storeys(), two_storeys_scene(), {}, context);
  ASSERT_TRUE(nodes) << nodes.error().message;
  NodePictureConfig config{.width = 600, .area = {}, .path = {}, .title = ""};
  config.area = {{10, -10, 0}, {20, 10, 8}};
  config.path = {{15, 3, -30}, {15, 3, 50}};
  config.storey = 1;
  const auto part = draw_nodes(*nodes, config);
  ASSERT_TRUE(part) << part.error().message;
  const Pixels blue = pixels(*part, is_blue), all = pixels(*part, is_level);
  EXPECT_GT(blue.count, 20u);
  EXPECT_GE(blue.first_row, all.first_row - 2);
  EXPECT_LE(blue.last_row, all.last_row + 2);
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
