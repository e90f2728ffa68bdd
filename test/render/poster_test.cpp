// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/poster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "render/storey_raster.h"
#include "render/views.h"

namespace throng {
namespace {

// A world of hand-made level tiles. `floor(level, x, z)` gives a height in mm or kNoFloor.
struct HandMade {
  std::vector<LevelTileContent> tiles;
  render::PictureWorld world;

  HandMade(int32_t tiles_x, int32_t tiles_z, int32_t levels,
           const std::function<int32_t(int32_t, int32_t, int32_t)>& floor,
           const std::function<int32_t(int32_t, int32_t, int32_t)>& ceiling = nullptr) {
    world.cell = 0.5;
    world.tiles_x = tiles_x;
    world.tiles_z = tiles_z;
    world.bounds.add({0, 0, 0});
    world.bounds.add({tiles_x * 32.0, 10, tiles_z * 32.0});
    world.class_name = "adult";
    for (int32_t level = 0; level < levels; ++level) {
      for (int32_t t = 0; t < tiles_x * tiles_z; ++t) {
        LevelTileContent tile;
        tile.tile_x = t % tiles_x;
        tile.tile_z = t / tiles_x;
        tile.area.assign(4096, 1);
        tile.clearance.resize(1);
        for (int32_t c = 0; c < 4096; ++c) {
          const int32_t x = tile.tile_x * 64 + c % 64, z = tile.tile_z * 64 + c / 64;
          tile.floor.push_back(floor(level, x, z));
          tile.ceiling.push_back(ceiling ? ceiling(level, x, z) : kOpenSky);
          tile.clearance[0].push_back(tile.floor.back() == kNoFloor ? 0 : 8);
        }
        tiles.push_back(tile);
        world.storeys.push_back(level);
      }
    }
    world.level_tile = [this](uint32_t i) { return tiles[i]; };
  }
  HandMade(const HandMade&) = delete;

  std::vector<render::StoreyRaster> rasters(int32_t size) const {
    const render::StoreyIndex index(world);
    return render::rasterise_storeys(world, index, index.choose(-1, 12).shown,
                                     render::make_raster_grid(world, size, size))
        .storeys;
  }
};

bool in(int32_t v, int32_t low, int32_t high) { return v >= low && v < high; }

// Two storeys 3 m apart; a pillar through both; the upper one has a shaft and ends at x = 50.
int32_t house_floor(int32_t level, int32_t x, int32_t z) {
  if (in(x, 10, 14) && in(z, 10, 14)) return kNoFloor;
  if (level == 1 && (x >= 50 || (in(x, 30, 40) && in(z, 30, 40)))) return kNoFloor;
  return level * 3000;
}
int32_t house_ceiling(int32_t level, int32_t x, int32_t z) {
  const bool covered = house_floor(1, x, z) != kNoFloor;
  return level == 0 && covered ? 2800 : kOpenSky;
}

TEST(StoreyRaster, WallsShaftsAndTheOutsideAreDistinguished) {
  const HandMade house(1, 1, 2, house_floor, house_ceiling);
  const auto storeys = house.rasters(64);
  ASSERT_EQ(storeys.size(), 2u);
  const auto kind = [&](size_t s, size_t x, size_t z) { return storeys[s].kind[z * 64 + x]; };
  EXPECT_EQ(kind(0, 20, 20), render::TexelKind::kFloor);
  EXPECT_EQ(kind(0, 12, 12), render::TexelKind::kObstacle);
  EXPECT_EQ(kind(1, 12, 12), render::TexelKind::kObstacle);
  EXPECT_EQ(kind(1, 35, 35), render::TexelKind::kOpenBelow);
  EXPECT_EQ(kind(1, 55, 20), render::TexelKind::kOutside);
  EXPECT_EQ(storeys[0].low, 0);
  EXPECT_EQ(storeys[1].high, 3);
  EXPECT_DOUBLE_EQ(storeys[0].floor_area, (4096 - 16) * 0.25);
}

TEST(StoreyRaster, ReducingAveragesHeightsAndShares) {
  const HandMade ramp(2, 1, 1,
                      [](int32_t, int32_t x, int32_t z) { return z == 1 ? kNoFloor : x * 100; });
  const auto storeys = ramp.rasters(32);  // 128 x 64 cells, 4 x 4 cells a texel
  ASSERT_EQ(storeys.size(), 1u);
  EXPECT_EQ(storeys[0].width, 32);
  EXPECT_EQ(storeys[0].height, 16);
  EXPECT_NEAR(storeys[0].floor[5], 2.15, 1e-5);  // cells 20 to 23
  EXPECT_EQ(storeys[0].floor_share[5], 191);     // three rows of four
  EXPECT_EQ(storeys[0].floor_share[32 + 5], 255);
  EXPECT_EQ(storeys[0].stand_share[5], 255);
  EXPECT_EQ(storeys[0].clearance[5], 128);
}

TEST(StoreyRaster, APieceOfAnotherStoreyInALevelTileIsAssignedToIt) {
  // In the middle tile of five the two levels have swapped a piece.
  const HandMade mixed(5, 1, 2, [](int32_t level, int32_t x, int32_t z) {
    const bool swapped = in(x, 130, 170) && in(z, 20, 40);
    return (swapped ? 1 - level : level) * 3000;
  });
  for (const render::StoreyRaster& storey : mixed.rasters(320)) {
    EXPECT_EQ(storey.low, storey.storey * 3.0);
    EXPECT_EQ(storey.high, storey.storey * 3.0);
    for (const float floor : storey.floor) ASSERT_EQ(floor, static_cast<float>(storey.storey * 3));
  }
}

TEST(StoreyRaster, CrumbsAreLeftOutUnlessTheyAreRequested) {
  const HandMade crumbs(2, 2, 3, [](int32_t level, int32_t x, int32_t z) {
    return level == 1 && (x > 3 || z > 3) ? kNoFloor : level * 3000;
  });
  const render::StoreyIndex index(crumbs.world);
  EXPECT_EQ(index.choose(-1, 12).shown, (std::vector<int32_t>{0, 2}));
  EXPECT_EQ(index.choose(-1, 12).left_out, 1);
  EXPECT_EQ(index.choose(1, 12).shown, (std::vector<int32_t>{0, 1, 2}));
  EXPECT_EQ(index.choose(1, 1).shown, (std::vector<int32_t>{1}));
}

TEST(StoreyRaster, CrumbsJoinAStoreyThatIsNearAndFreeThere) {
  // Storey 1 is a landing at 1.2 in a hole of storey 0, storey 2 a perch far above everything.
  const HandMade crumbs(2, 2, 3, [](int32_t level, int32_t x, int32_t z) {
    const bool landing = in(x, 20, 24) && in(z, 20, 24), perch = in(x, 40, 44) && in(z, 40, 44);
    if (level == 0) return landing ? kNoFloor : 0;
    return level == 1 ? (landing ? 1200 : kNoFloor) : (perch ? 9000 : kNoFloor);
  });
  const render::StoreyIndex index(crumbs.world);
  const auto rasters = render::rasterise_storeys(crumbs.world, index, index.choose(-1, 12).shown,
                                                 render::make_raster_grid(crumbs.world, 128, 128));
  ASSERT_EQ(rasters.storeys.size(), 1u);
  EXPECT_EQ(rasters.storeys[0].floor[22 * 128 + 22], 1.2f);
  EXPECT_EQ(rasters.storeys[0].floor[42 * 128 + 42], 0);
  EXPECT_EQ(rasters.left_out_area, 4);
}

TEST(Views, AvatarsAreDrawnOnTheNearestFloor) {
  const HandMade house(1, 1, 2, house_floor, house_ceiling);
  const auto storeys = house.rasters(64);
  const render::RasterGrid grid = render::make_raster_grid(house.world, 64, 64);
  const std::vector<PictureAvatar> avatars = {{{10, 0.02, 10}, 0.25},
                                              {{10, 2.9, 10}, 0.25},
                                              {{30, 2.9, 10}, 0.25},  // the upper floor ends before
                                              {{-1, 0, 10}, 0.25},    // outside
                                              {{6, 0, 6}, 0.25}};     // in the pillar
  const auto placed = render::place_avatars(avatars, storeys, grid);
  ASSERT_EQ(placed.size(), 3u);
  EXPECT_EQ(placed[0].storey, 0u);
  EXPECT_EQ(placed[1].storey, 1u);
  EXPECT_EQ(placed[2].storey, 0u);
}

TEST(Views, TheSectionShowsFreeSpansAndFloors) {
  const HandMade house(1, 1, 2, house_floor, house_ceiling);
  const render::RasterGrid grid = render::make_raster_grid(house.world, 64, 64);
  const render::Section section = render::cut_section(house.world, grid, 35, 64);
  EXPECT_DOUBLE_EQ(section.z, 17.75);
  ASSERT_EQ(section.free_spans[20].size(), 2u);
  EXPECT_EQ(section.free_spans[20][0].ceiling, 2.8);
  EXPECT_EQ(section.free_spans[20][1].floor, 3);
  EXPECT_TRUE(std::isinf(section.free_spans[20][1].ceiling));
  EXPECT_EQ(section.free_spans[35].size(), 1u) << "the shaft";
  EXPECT_TRUE(section.free_spans[20][0].stands);
}

TEST(Views, TheSectionLeavesTheMiddleOnlyForMuchMoreFloor) {
  const auto row_of = [](const std::function<int32_t(int32_t, int32_t, int32_t)>& floor) {
    const HandMade world(1, 1, 2, floor);
    return render::StoreyIndex(world.world).section_row(0, 64);
  };
  EXPECT_EQ(row_of([](int32_t level, int32_t, int32_t) { return level * 3000; }), 32);
  EXPECT_EQ(row_of([](int32_t level, int32_t, int32_t z) {
              return level == 1 && z != 20 ? kNoFloor : level * 3000;
            }),
            20);
}

// Pixels of one colour in an image.
size_t count_colour(const Image& image, render::Rgb colour) {
  size_t count = 0;
  for (size_t i = 0; i < image.rgb.size(); i += 3) {
    count += render::Rgb{image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]} == colour;
  }
  return count;
}

TEST(Poster, ShowsFloorsWallsAndAvatars) {
  const HandMade house(1, 1, 2, house_floor, house_ceiling);
  const std::vector<PictureAvatar> avatars = {{{20, 0, 20}, 0.5}};
  PictureConfig config;
  config.width = 900;
  const auto image = render::draw_poster(house.world, {"House", {"a line"}}, avatars, config);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 900);
  EXPECT_EQ(image->rgb.size(), static_cast<size_t>(image->height) * 2700);
  EXPECT_GT(count_colour(*image, render::height_colour(0)), 10000u);
  EXPECT_GT(count_colour(*image, render::height_colour(1)), 10000u);
  EXPECT_GT(count_colour(*image, render::kSolid), 500u);
  EXPECT_GT(count_colour(*image, render::kAvatar), 60u);
  const auto again = render::draw_poster(house.world, {"House", {"a line"}}, avatars, config);
  EXPECT_EQ(again->rgb, image->rgb) << "the same bytes each time";
}

TEST(Poster, DrawsAPathOnTheStoreyWhoseFloorItIsOn) {
  const HandMade house(1, 1, 2, house_floor, house_ceiling);
  const auto count_on = [&](int32_t storey, double height) {
    PictureConfig config;
    config.storey = storey;
    config.width = 900;
    config.path = {{4, height, 4}, {20, height, 4}, {20, height, 12}};
    const auto image = render::draw_poster(house.world, {}, {}, config);
    EXPECT_TRUE(image);
    return image ? count_colour(*image, render::kPath) : 0;
  };
  const size_t in_legend = count_on(0, 3);
  EXPECT_GT(in_legend, 0u);
  EXPECT_GT(count_on(0, 0), in_legend + 200);
  EXPECT_GT(count_on(1, 3), in_legend + 200);
  EXPECT_EQ(count_on(1, 0), in_legend);
  EXPECT_EQ(count_on(1, 4.5), 0u) << "it is on no floor";
}

TEST(Poster, OneStoreyIsDrawnLargerAndAlone) {
  const HandMade house(1, 1, 2, house_floor, house_ceiling);
  const auto one = render::draw_poster(house.world, {}, {},
                                       {.avatar_class = 0, .storey = 1, .width = 900, .title = {}});
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_GT(count_colour(*one, render::height_colour(1)), 100000u);
  EXPECT_LT(count_colour(*one, render::height_colour(0)), 5000u) << "in legend and section only";
}

TEST(Poster, HoldsAnyShapeOfWorldAtAnyWidth) {
  const auto hill = [](int32_t, int32_t x, int32_t z) { return (x * x + z * z) % 977; };
  for (const int32_t width : {200, 333, 1600}) {
    for (const auto& [x, z] : {std::pair{1, 1}, {24, 1}, {1, 24}}) {
      const HandMade world(x, z, 1, hill);
      PictureConfig config;
      config.width = width;
      const auto image = render::draw_poster(world.world, {"Hill", {}}, {}, config);
      ASSERT_TRUE(image) << image.error().message;
      EXPECT_EQ(image->width, width);
      EXPECT_LT(image->height, width * 3);
    }
  }
}

TEST(Poster, WhatCannotBeDrawnIsRefused) {
  const HandMade house(1, 1, 2, house_floor);
  const auto message = [](const render::PictureWorld& world, int32_t storey, int32_t width) {
    PictureConfig config;
    config.storey = storey;
    config.width = width;
    const auto image = render::draw_poster(world, {}, {}, config);
    return image ? std::string("accepted") : image.error().message;
  };
  EXPECT_EQ(message(house.world, -1, 199), "picture: width is 199; it must be 200 to 16000 pixels");
  EXPECT_EQ(message(house.world, 2, 800), "picture: no storey 2; this world has 0 to 1");
  EXPECT_EQ(message(render::PictureWorld{}, -1, 800),
            "picture: this world has no floor; bake a model with surfaces");
}

}  // namespace
}  // namespace throng
