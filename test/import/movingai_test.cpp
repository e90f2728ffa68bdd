// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/movingai.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scratch_folder.h"
#include "throng/scene.h"

namespace throng {
namespace {

TEST(GridMap, DotsGrassAndSwampArePassable) {
  const auto cells =
      importer::read_grid_map("type octile\nheight 2\nwidth 4\nmap\n.G@T\nSWO.\n", "a.map");
  ASSERT_TRUE(cells) << cells.error().message;
  EXPECT_EQ(cells->width, 4);
  EXPECT_EQ(cells->depth, 2);
  EXPECT_EQ(cells->passable, (std::vector<uint8_t>{1, 1, 0, 0, 1, 0, 0, 1}));
}

TEST(GridMap, WindowsLinesAreRead) {
  const auto cells =
      importer::read_grid_map("type octile\r\nheight 1\r\nwidth 2\r\nmap\r\n.@\r\n", "a.map");
  ASSERT_TRUE(cells) << cells.error().message;
  EXPECT_EQ(cells->passable, (std::vector<uint8_t>{1, 0}));
}

TEST(GridMap, BadMapsAreRefusedAndTheLineIsNamed) {
  const auto message = [](std::string_view text) {
    const auto cells = importer::read_grid_map(text, "a.map");
    EXPECT_FALSE(cells);
    EXPECT_EQ(cells.error().code, Errc::kBadFile);
    return cells.error().message;
  };
  EXPECT_EQ(message(""), "a.map: not a grid map; its first line must be `type octile`");
  EXPECT_NE(message("type octile\nheight 0\nwidth 2\nmap\n").find("lines 2 and 3"),
            std::string::npos);
  EXPECT_NE(message("type octile\nheight 2\nwidth 99999\nmap\n").find("16000"), std::string::npos);
  EXPECT_NE(message("type octile\nheight 1\nwidth 2\nmop\n..\n").find("line 4"), std::string::npos);
  EXPECT_EQ(message("type octile\nheight 2\nwidth 2\nmap\n..\n.\n"),
            "a.map: line 6 has 1 cells, `width` says 2");
  EXPECT_EQ(message("type octile\nheight 2\nwidth 2\nmap\n..\n"),
            "a.map: line 6 has 0 cells, `width` says 2");
}

TEST(GridMap, FilesAreReadAndNamedWhereTheyCannotBe) {
  const test::ScratchFolder folder;
  const auto cells =
      load_grid_map(folder.write("a.map", "type octile\nheight 2\nwidth 3\nmap\n.GS\n@.T\n"));
  ASSERT_TRUE(cells) << cells.error().message;
  EXPECT_EQ(cells->width, 3);
  EXPECT_EQ(cells->depth, 2);
  EXPECT_EQ(cells->passable, (std::vector<uint8_t>{1, 1, 1, 0, 1, 0}));

  const std::string bad = folder.write("b.map", "type octile\nheight 2\nwidth 3\nmap\n...\n..\n");
  const auto refused = load_grid_map(bad);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kBadFile);
  EXPECT_EQ(refused.error().message.rfind(bad + ": line 6", 0), 0u) << refused.error().message;

  for (const std::string& path : {folder.path() + "/c.map", std::string()}) {
    const auto missing = load_grid_map(path);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, Errc::kBadFile);
    EXPECT_NE(missing.error().message.find(path), std::string::npos) << missing.error().message;
  }
  const auto no_file = load_grid_map(folder.path());
  ASSERT_FALSE(no_file);
  EXPECT_TRUE(no_file.error().code == Errc::kBadFile || no_file.error().code == Errc::kIo);
}

TEST(VoxelMap, ListsItsVoxels) {
  const auto cells = importer::read_voxel_map("voxel 4 5 6\n0 1 2\n3 4 5\n", "a.3dmap");
  ASSERT_TRUE(cells) << cells.error().message;
  EXPECT_EQ(cells->height, 5);
  ASSERT_EQ(cells->filled.size(), 2u);
  EXPECT_EQ(cells->filled[1].z, 5);
}

TEST(VoxelMap, BadMapsAreRefusedAndTheLineIsNamed) {
  const auto message = [](std::string_view text) {
    const auto cells = importer::read_voxel_map(text, "a.3dmap");
    EXPECT_FALSE(cells);
    return cells.error().message;
  };
  EXPECT_NE(message("").find("first line"), std::string::npos);
  EXPECT_NE(message("voxel 4 0 6\n").find("line 1"), std::string::npos);
  EXPECT_NE(message("voxel 4 9999 6\n").find("4096"), std::string::npos);
  EXPECT_NE(message("voxel 4 5 6\n0 1 2\n4 1 2\n").find("line 3"), std::string::npos);
  EXPECT_NE(message("voxel 4 5 6\n0 1\n").find("line 2"), std::string::npos);
}

TEST(VoxelMap, FilesAreReadAndNamedWhereTheyCannotBe) {
  const test::ScratchFolder folder;
  const auto cells = load_voxel_map(folder.write("a.3dmap", "voxel 4 5 6\r\n0 1 2\r\n3 4 5"));
  ASSERT_TRUE(cells) << cells.error().message;
  EXPECT_EQ(cells->depth, 6);
  ASSERT_EQ(cells->filled.size(), 2u);
  EXPECT_EQ(cells->filled[0].y, 1);

  const std::string bad = folder.write("b.3dmap", "voxel 4 5 6\n0 1 6\n");
  const auto refused = load_voxel_map(bad);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kBadFile);
  EXPECT_EQ(refused.error().message.rfind(bad + ": line 2", 0), 0u) << refused.error().message;

  const std::string nowhere = folder.path() + "/c.3dmap";
  const auto missing = load_voxel_map(nowhere);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kBadFile);
  EXPECT_NE(missing.error().message.find(nowhere), std::string::npos) << missing.error().message;
}

}  // namespace
}  // namespace throng
