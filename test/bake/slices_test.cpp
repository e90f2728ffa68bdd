// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "bake/columns/columns.h"
#include "core/random.h"
#include "naive_columns.h"
#include "naive_slices.h"
#include "throng/papers.h"

namespace throng {
namespace {

using Ints = std::vector<int32_t>;

void add_triangle(Scene& scene, Vec3d a, Vec3d b, Vec3d c) {
  const auto base = static_cast<uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {a, b, c});
  scene.triangles.push_back({base, base + 1, base + 2});
  scene.area.push_back(kAreaWalkable);
}

void add_quad(Scene& scene, Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  add_triangle(scene, a, b, c);
  add_triangle(scene, a, c, d);
}

// A level rectangle.
void add_sheet(Scene& scene, double x0, double z0, double x1, double z1, double y) {
  add_quad(scene, {x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1});
}

void add_tower(Scene& scene, Vec3d low, Vec3d high) {
  add_sheet(scene, low.x, low.z, high.x, high.z, low.y);
  add_sheet(scene, low.x, low.z, high.x, high.z, high.y);
  for (const double x : {low.x, high.x}) {
    add_quad(scene, {x, low.y, low.z}, {x, high.y, low.z}, {x, high.y, high.z}, {x, low.y, high.z});
  }
  for (const double z : {low.z, high.z}) {
    add_quad(scene, {low.x, low.y, z}, {low.x, high.y, z}, {high.x, high.y, z}, {high.x, low.y, z});
  }
}

SliceSet slice(const Scene& scene, const SliceConfig& config) {
  Context context;
  auto set = slice_scene(scene, config, context);
  EXPECT_TRUE(set) << set.error().message;
  return *std::move(set);
}

Ints kept_heights(const SliceSet& set) {
  Ints heights;
  for (const Slice& kept : set.kept) heights.push_back(kept.height);
  return heights;
}

// The columns that slice_scene sees, by the same rasteriser but as one grid.
naive::Columns rasterised(const Scene& scene, double cell) {
  Box3d box;
  for (const Vec3d& p : scene.positions) box.add(p);
  const bake::Grid grid = bake::make_grid(box, cell, 0);
  std::vector<bake::CellTriangle> triangles;
  for (uint32_t t = 0; t < scene.triangles.size(); ++t) {
    triangles.push_back(bake::to_cell_triangle(scene, t, grid, 0));
  }
  const auto bins =
      bake::bin_triangles(triangles, 0, 0, grid.tiles_x(), grid.tiles_z(), bake::kTileSide, 0);
  const int32_t low = naive::floor_mm(box.min.y), high = naive::ceil_mm(box.max.y);
  std::vector<std::vector<std::pair<int32_t, int32_t>>> cells(
      static_cast<size_t>(grid.width * grid.depth));
  auto columns = std::make_unique<bake::TileColumns>();
  for (int32_t tz = 0; tz < grid.tiles_z(); ++tz) {
    for (int32_t tx = 0; tx < grid.tiles_x(); ++tx) {
      const auto square = static_cast<size_t>(tz * grid.tiles_x() + tx);
      const auto items =
          std::span(bins.items)
              .subspan(bins.first[square], bins.first[square + 1] - bins.first[square]);
      bake::rasterise_tile(triangles, items, tx * bake::kTileSide, tz * bake::kTileSide, {}, 0,
                           *columns);
      bake::TileSpans spans;
      bake::sort_spans(*columns, spans);
      for (int32_t c = 0; c < bake::kTileArea; ++c) {
        const int32_t x = tx * bake::kTileSide + c % bake::kTileSide,
                      z = tz * bake::kTileSide + c / bake::kTileSide;
        if (x >= grid.width || z >= grid.depth) continue;
        for (uint32_t i = spans.first[static_cast<size_t>(c)];
             i < spans.first[static_cast<size_t>(c) + 1]; ++i) {
          cells[static_cast<size_t>(z * grid.width + x)].emplace_back(
              std::max(spans.low[i], low), std::min(spans.high[i], high));
        }
      }
    }
  }
  return naive::from_lists(grid.width, grid.depth, cells);
}

void expect_equal(const SliceSet& set, const naive::SliceRun& expected) {
  ASSERT_EQ(static_cast<size_t>(set.taken), expected.taken.size());
  ASSERT_EQ(set.kept.size(), expected.kept.size());
  for (size_t i = 0; i < expected.kept.size(); ++i) {
    ASSERT_EQ(set.kept[i].height, expected.kept[i].height);
    ASSERT_EQ(set.kept[i].surface, expected.kept[i].surface);
  }
}

TEST(Slices, AHollowCubeOf5800mmTakes42AndKeepsTwoAsInTable2) {
  Scene scene;
  add_tower(scene, {-2.9, 0, -2.9}, {2.9, 5.8, 2.9});
  const SliceSet set = slice(scene, {.avatar_height = 1.75, .resolution = 0.1, .cell = 0.1});
  EXPECT_EQ(set.width, 58);
  EXPECT_EQ(set.depth, 58);
  EXPECT_EQ(set.taken, 42);
  EXPECT_EQ(kept_heights(set), (Ints{7650, 5700}));
  EXPECT_EQ(set.far_plane, -100);
  EXPECT_EQ(set.kept[1].surface[20 * 58 + 30], 0) << "the floor inside";
  EXPECT_EQ(set.kept[1].surface[30], 5700) << "the wall, cut";
}

TEST(Slices, TheSeedsWorkedExampleTakes32AndKeepsTwo) {
  Scene scene;
  add_sheet(scene, 0, 0, 6, 1, 1);                        // region 1 and 3
  add_tower(scene, {2, 1, 0}, {4, 4, 1});                 // region 2
  add_tower(scene, {1.05, 5.95, 0.05}, {4.95, 9, 0.95});  // the block above
  const SliceSet set = slice(scene, {.avatar_height = 4.5, .resolution = 0.1, .cell = 0.1});
  EXPECT_EQ(set.taken, 32);
  EXPECT_EQ(kept_heights(set), (Ints{13600, 5900}));
}

TEST(Slices, ThinRoofsAt8And7And6Take4AndKeepTwo) {
  Scene scene;
  add_sheet(scene, 0, 0, 6, 2, 0);
  for (int i = 0; i < 3; ++i) add_sheet(scene, 2 * i + 0.05, 0.05, 2 * i + 1.95, 1.95, 8 - i);
  const SliceSet set = slice(scene, {.avatar_height = 4.5, .resolution = 0.1, .cell = 0.1});
  EXPECT_EQ(set.taken, 4);
  EXPECT_EQ(kept_heights(set), (Ints{12600, 5900}));
}

TEST(Slices, UprightTrianglesCountUnlikeInTheDepthMapsOfFigure9) {
  Scene scene;
  add_sheet(scene, 0, 0, 2, 2, 0);
  add_triangle(scene, {1.05, 0, 0.5}, {1.05, 4, 0.5}, {1.05, 4, 1.5});
  const SliceSet set = slice(scene, {.cell = 0.1});
  EXPECT_EQ(set.kept[0].surface[10 * 20 + 10], 4000);
  EXPECT_EQ(set.kept[0].surface[10 * 20 + 9], 0);
}

TEST(Slices, EqualTheNaiveOnesOnRandomBoxesThatNeverTouchACellBorder) {
  for (uint64_t seed = 0; seed < 12; ++seed) {
    uint64_t n = 0;
    const auto mm = [&](uint64_t limit) {
      return static_cast<double>(random_below(seed, 1, n++, limit));
    };
    const auto inside = [&](uint64_t cells) { return (mm(cells) + 0.3 + mm(5) / 10) * 0.25; };
    Scene scene;
    add_sheet(scene, 0, 0, 20, 5, 0);
    for (int i = 0; i < 25; ++i) {
      const Vec3d low{inside(60), mm(8000) / 1000, inside(12)};
      add_tower(scene, low, low + Vec3d{mm(18) * 0.25, mm(2000) / 1000, mm(7) * 0.25});
    }
    const auto columns =
        naive::make_columns(scene, {.origin = {}, .cell = 0.25, .width = 80, .depth = 20});
    const auto expected = naive::slice(columns, naive::sweep_config(columns, 1200, 150));
    expect_equal(slice(scene, {.avatar_height = 1.2, .resolution = 0.15, .cell = 0.25}), expected);
  }
}

TEST(Slices, EqualTheNaiveOnesOnTheRasterisersColumnsOfRandomTriangles) {
  for (uint64_t seed = 0; seed < 6; ++seed) {
    uint64_t n = 0;
    const auto at = [&](double side) { return (random_unit(seed, 1, n++) - 0.5) * side; };
    Scene scene;
    for (int i = 0; i < 60; ++i) {
      const Vec3d p{at(30), at(12), at(14)};
      add_triangle(scene, p, p + Vec3d{at(6), at(3), at(6)}, p + Vec3d{at(6), at(3), at(6)});
    }
    const auto columns = rasterised(scene, 0.2);
    const auto config = naive::sweep_config(columns, 900, 200);
    expect_equal(slice(scene, {.avatar_height = 0.9, .resolution = 0.2, .cell = 0.2}),
                 naive::slice(columns, config));
  }
}

TEST(Slices, KnowWhereTheyLie) {
  Scene scene;
  add_sheet(scene, 5000.25, -3.14, 5001.05, -2.55, 2);
  const SliceSet set = slice(scene, {.cell = 0.1});
  EXPECT_DOUBLE_EQ(set.origin_x, 5000.2);
  EXPECT_NEAR(set.origin_z, -3.2, 1e-9);
  EXPECT_EQ(set.width, 9);
  EXPECT_EQ(set.depth, 7);
  EXPECT_EQ(set.cell, 0.1);
}

TEST(Slices, BadSettingsAreRefusedByName) {
  Scene scene;
  add_sheet(scene, 0, 0, 1, 1, 0);
  const auto message = [&](const SliceConfig& config) {
    Context context;
    const auto set = slice_scene(scene, config, context);
    return set ? std::string("accepted") : set.error().message;
  };
  EXPECT_EQ(message({.avatar_height = 0}),
            "slices: avatar_height is 0; it must be 0.001 to 1000 m");
  EXPECT_EQ(message({.avatar_height = std::nan("")}),
            "slices: avatar_height is nan; it must be 0.001 to 1000 m");
  EXPECT_EQ(message({.resolution = 0.0001}),
            "slices: resolution is 0.0001; it must be 0.001 to 1000 m");
  EXPECT_EQ(message({.cell = 0}), "slices: cell is 0; it must be 0.01 to 1000 m");
  EXPECT_EQ(message({.workers = -1}), "slices: workers is -1; it must be at least 0");
}

TEST(Slices, ScenesThatCannotBeCutAreRefusedWithThePlace) {
  const auto error = [](const Scene& scene) {
    Context context;
    const auto set = slice_scene(scene, {}, context);
    return set ? Error{} : set.error();
  };
  Scene scene;
  EXPECT_EQ(error(scene).message,
            "slices: the scene has no triangles; give it a model with surfaces");
  add_sheet(scene, 0, 0, 1, 1, 0);
  Scene bad = scene;
  bad.triangles[1][2] = 77;
  EXPECT_EQ(error(bad).message,
            "slices: triangle 1 has corner 77, the scene 6 positions; load_scene drops such "
            "triangles");
  bad = scene;
  bad.positions[4].x = std::numeric_limits<double>::infinity();
  EXPECT_EQ(error(bad).code, Errc::kBadInput);
  bad = scene;
  bad.positions[4].y = std::nan("");
  EXPECT_EQ(error(bad).code, Errc::kBadInput);
}

TEST(Slices, AGridThatIsTooLargeIsRefusedWithACellThatFits) {
  Scene scene;
  add_sheet(scene, 0, 0, 4000, 2000, 0);
  Context context;
  const auto set = slice_scene(scene, {.cell = 0.1}, context);
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code, Errc::kLimit);
  EXPECT_EQ(set.error().message,
            "slices: 4000 x 2000 m in cells of 0.1 m are more than 134217728 cells; use cells of "
            "0.26 m, or bake level tiles, which have no such limit");
}

TEST(Slices, CancelStopsBeforeAnythingIsReturned) {
  Scene scene;
  add_tower(scene, {0, 0, 0}, {20, 30, 20});
  Context context;
  context.on_progress = [&](const Progress& progress) {
    if (progress.stage == "columns") context.cancel = true;
  };
  const auto set = slice_scene(scene, {}, context);
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code, Errc::kCancelled);
}

}  // namespace
}  // namespace throng
