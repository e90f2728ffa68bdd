// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "scratch_folder.h"
#include "throng/papers.h"
#include "throng/picture.h"

namespace throng {
namespace {

// 20 x 10 cells: nothing on the left, floor at 0 in the middle, floor at 2 m on the right.
SliceSet steps() {
  SliceSet set;
  set.width = 20;
  set.depth = 10;
  set.cell = 0.5;
  set.far_plane = -100;
  Slice slice{.height = 3850, .surface = {}};
  for (int32_t cell = 0; cell < 200; ++cell) {
    slice.surface.push_back(cell % 20 < 5 ? -100 : (cell % 20 < 12 ? 0 : 2000));
  }
  set.kept = {slice};
  set.taken = 1;
  return set;
}

uint8_t grey_at(const Image& image, int32_t x, int32_t y) {
  const size_t i =
      (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x)) * 3;
  EXPECT_EQ(image.rgb[i], image.rgb[i + 1]);
  EXPECT_EQ(image.rgb[i], image.rgb[i + 2]);
  return image.rgb[i];
}

TEST(SlicePicture, DarkerIsHigherAndTheFarPlaneIsWhite) {
  const Image image = draw_slice(*store_depths(steps()), 0);
  ASSERT_EQ(image.rgb.size(),
            static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 3);
  const int32_t y = image.height / 2;
  std::vector<uint8_t> seen;  // The different greys along a row of the map, from left to right.
  for (int32_t x = 30; x < image.width - 180; ++x) {
    const uint8_t g = grey_at(image, x, y);
    if (seen.empty() || seen.back() != g) seen.push_back(g);
  }
  ASSERT_GE(seen.size(), 3u);
  EXPECT_EQ(seen[0], 255);
  EXPECT_GT(seen[0], seen[1]);
  EXPECT_GT(seen[1], seen[2] + 100) << "the contrast is stretched";
}

TEST(SlicePicture, AWallOneCellWideStaysVisibleInAWorldManyTimesWiderThanThePicture) {
  SliceSet set;
  set.width = 5000;
  set.depth = 40;
  set.cell = 0.1;
  set.far_plane = -100;
  Slice slice{.height = 5000, .surface = std::vector<int32_t>(200000, 0)};
  for (size_t z = 0; z < 40; ++z) slice.surface[z * 5000 + 2502] = 4900;
  set.kept = {slice};
  const Image image = draw_slice(*store_depths(set), 0);
  EXPECT_LE(image.width, 1500);
  std::set<uint8_t> greys;
  for (int32_t x = 100; x < image.width - 200; ++x) greys.insert(grey_at(image, x, 60));
  EXPECT_EQ(greys.size(), 2u) << "floor and wall";
}

TEST(SlicePicture, AnEmptySliceAndASingleCellCanBeDrawn) {
  SliceSet set = steps();
  set.kept[0].surface.assign(200, -100);
  EXPECT_GT(draw_slice(*store_depths(set), 0).width, 100);
  set.width = set.depth = 1;
  set.kept[0].surface = {700};
  EXPECT_GT(draw_slice(*store_depths(set), 0).width, 100);
}

TEST(Png, IsWrittenCompleteOrNotAtAll) {
  const test::ScratchFolder scratch;
  const std::string folder = scratch.path();
  const Image image{.width = 3, .height = 2, .rgb = std::vector<uint8_t>(18, 200)};
  const std::string path = folder + "/a.png";
  ASSERT_TRUE(write_png(image, path));
  std::ifstream file(path, std::ios::binary);
  std::string head(8, ' ');
  file.read(head.data(), 8);
  EXPECT_EQ(head, "\x89PNG\r\n\x1a\n");
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));

  const auto refused = write_png(image, folder + "/missing/a.png");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kIo);
  EXPECT_EQ(refused.error().message,
            folder +
                "/missing/a.png: cannot write: No such file or directory; check the folder, its "
                "rights and the free space");
  std::filesystem::create_directories(folder + "/taken.png");
  EXPECT_FALSE(write_png(image, folder + "/taken.png")) << "a folder has that name";
  EXPECT_FALSE(std::filesystem::exists(folder + "/taken.png.part"));
}

}  // namespace
}  // namespace throng
