// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "bake/columns/free_spans.h"
#include "core/hash.h"
#include "core/random.h"
#include "naive_columns.h"
#include "simd_targets.h"
#include "throng/scene.h"

namespace throng {
namespace {

struct Soup {
  Scene scene;
  bake::Grid grid;
};

void add(Scene& scene, Vec3d a, Vec3d b, Vec3d c) {
  const auto base = static_cast<uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {a, b, c});
  scene.triangles.push_back({base, base + 1, base + 2});
  scene.area.push_back(kAreaWalkable);
}

// Triangles of all shapes around one tile: big, small, needles, upright, degenerate, on cell
// borders.
Soup random_soup(uint64_t seed, double cell, int32_t count) {
  Soup soup;
  soup.grid = {.origin_x = -3 * cell, .origin_z = 5 * cell, .cell = cell, .width = 64, .depth = 64};
  const double side = 64 * cell;
  uint64_t n = 0;
  const auto unit = [&] { return random_unit(seed, 1, n++); };
  for (int32_t t = 0; t < count; ++t) {
    const int kind = static_cast<int>(random_below(seed, 2, static_cast<uint64_t>(t), 8));
    const double reach = kind == 0 ? 4 * side : (kind == 1 ? 3 * cell : side / 3);
    const Vec3d at{soup.grid.origin_x + (unit() * 1.4 - 0.2) * side, unit() * 20,
                   soup.grid.origin_z + (unit() * 1.4 - 0.2) * side};
    Vec3d p[3];
    for (Vec3d& v : p) {
      v = {at.x + (unit() - 0.5) * reach, at.y + (unit() - 0.5) * 6, at.z + (unit() - 0.5) * reach};
    }
    if (kind == 2) p[2] = {p[0].x, p[0].y + 3, p[0].z};                    // upright
    if (kind == 3) p[1].x = p[2].x = p[0].x;                               // upright along z
    if (kind == 4) p[2] = p[0] + (p[1] - p[0]) * 0.5 + Vec3d{1e-7, 0, 0};  // needle
    if (kind == 5) p[1].y = p[2].y = p[0].y;                               // flat
    if (kind == 6) p[2] = p[1];                                            // a segment
    if (kind == 7) {                                                       // corners on the grid
      for (Vec3d& v : p) {
        v.x = soup.grid.origin_x + std::round((v.x - soup.grid.origin_x) / cell) * cell;
        v.z = soup.grid.origin_z + std::round((v.z - soup.grid.origin_z) / cell) * cell;
      }
    }
    add(soup.scene, p[0], p[1], p[2]);
  }
  return soup;
}

std::vector<bake::CellTriangle> cell_triangles(const Soup& soup) {
  std::vector<bake::CellTriangle> out;
  for (uint32_t t = 0; t < soup.scene.triangles.size(); ++t) {
    out.push_back(bake::to_cell_triangle(soup.scene, t, soup.grid, 0));
  }
  return out;
}

std::vector<uint32_t> all_items(size_t count) {
  std::vector<uint32_t> items(count);
  for (size_t i = 0; i < count; ++i) items[i] = static_cast<uint32_t>(i);
  return items;
}

bake::TileSpans fast_spans(const Soup& soup, int32_t join) {
  const auto triangles = cell_triangles(soup);
  auto columns = std::make_unique<bake::TileColumns>();
  bake::rasterise_tile(triangles, all_items(triangles.size()), 0, 0, {}, join, *columns);
  bake::TileSpans spans;
  bake::sort_spans(*columns, spans);
  return spans;
}

naive::Columns as_naive(const bake::TileSpans& spans) {
  return {bake::kTileSide, bake::kTileSide, spans.first, spans.low, spans.high};
}

naive::Columns naive_columns(const Soup& soup, double widen) {
  return naive::make_columns(soup.scene, {.origin = {soup.grid.origin_x, 0, soup.grid.origin_z},
                                          .cell = soup.grid.cell,
                                          .width = 64,
                                          .depth = 64,
                                          .widen = widen});
}

// Spans grown by `mm` at both ends, merged again.
naive::Columns grown(const naive::Columns& columns, int32_t mm) {
  std::vector<std::vector<std::pair<int32_t, int32_t>>> cells(columns.first.size() - 1);
  for (size_t c = 0; c < cells.size(); ++c) {
    for (size_t i = columns.first[c]; i < columns.first[c + 1]; ++i) {
      cells[c].emplace_back(columns.low[i] - mm, columns.high[i] + mm);
    }
  }
  return naive::from_lists(columns.width, columns.depth, cells);
}

TEST(Columns, NoTriangleIsEverMissed) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    const double cell = seed % 3 == 0 ? 0.1 : (seed % 3 == 1 ? 0.3 : 0.05);
    const Soup soup = random_soup(seed, cell, 24);
    ASSERT_TRUE(naive::covers(as_naive(fast_spans(soup, 0)), naive_columns(soup, 0)))
        << "seed " << seed;
  }
}

TEST(Columns, NothingIsCoveredBeyondTheStatedMargins) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    const Soup soup = random_soup(seed, 0.1, 12);
    // Upright edges shorter than 1e-3 cells count whole, so the bound is a little wider than
    // kWiden.
    ASSERT_TRUE(naive::covers(grown(naive_columns(soup, 2e-3), 2), as_naive(fast_spans(soup, 0))))
        << "seed " << seed;
  }
}

TEST(Columns, AFarTriangleKeepsItsPrecision) {
  Soup soup = random_soup(7, 0.1, 0);
  add(soup.scene, {-40000, -3, 10}, {50000, 900, 3000}, {1000, 40, -60000});
  EXPECT_TRUE(naive::covers(as_naive(fast_spans(soup, 0)), naive_columns(soup, 0)));
  EXPECT_TRUE(naive::covers(grown(naive_columns(soup, 1e-3), 2), as_naive(fast_spans(soup, 0))));
}

TEST(Columns, FlatSurfacesAreExact) {
  Soup soup = random_soup(7, 0.1, 0);
  add(soup.scene, {-10, 1.1, -10}, {30, 1.1, -10}, {-10, 1.1, 40});
  const bake::TileSpans spans = fast_spans(soup, 0);
  ASSERT_EQ(spans.low.size(), 4096u);
  for (size_t i = 0; i < spans.low.size(); ++i) {
    ASSERT_EQ(spans.low[i], 1100);
    ASSERT_EQ(spans.high[i], 1100);
  }
}

TEST(Columns, DeepColumnsSpillAndStaySorted) {
  Soup soup = random_soup(7, 0.1, 0);
  for (int i = 0; i < 300; ++i) {  // far more sheets than there are layers
    const double y = ((i * 137) % 300) * 2.0;
    add(soup.scene, {-10, y, -10}, {30, y, -10}, {-10, y, 40});
  }
  const bake::TileSpans spans = fast_spans(soup, 0);
  ASSERT_EQ(spans.low.size(), 4096u * 300);
  for (size_t i = 0; i < 300; ++i) EXPECT_EQ(spans.low[i], static_cast<int32_t>(i) * 2000);

  const auto triangles = cell_triangles(soup);
  auto columns = std::make_unique<bake::TileColumns>();
  bake::rasterise_tile(triangles, all_items(triangles.size()), 0, 0, {}, 0, *columns);
  auto gaps = std::make_unique<bake::TileFreeSpans>();
  bake::find_free_spans(*columns, 1500, *gaps);
  EXPECT_EQ(gaps->count[17], 300);
  EXPECT_EQ(gaps->layers[299]->ceiling[17], bake::kOpenSkyMm);
}

TEST(Columns, FreeSpansAreWhatJoinedSpansLeave) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    const Soup soup = random_soup(seed, 0.2, static_cast<int32_t>(seed % 60) + 2);
    const int32_t min_free_span = 700 + static_cast<int32_t>(seed) * 10;
    const auto triangles = cell_triangles(soup);
    auto columns = std::make_unique<bake::TileColumns>();
    bake::rasterise_tile(triangles, all_items(triangles.size()), 0, 0, {}, min_free_span - 1,
                         *columns);
    auto gaps = std::make_unique<bake::TileFreeSpans>();
    bake::find_free_spans(*columns, min_free_span, *gaps);
    const bake::TileSpans spans = fast_spans(soup, 0);
    for (size_t c = 0; c < 4096; ++c) {
      std::vector<std::pair<int32_t, int32_t>> expected;  // top, ceiling
      for (size_t i = spans.first[c]; i < spans.first[c + 1]; ++i) {
        const bool last = i + 1 == spans.first[c + 1];
        if (!last && spans.low[i + 1] - spans.high[i] < min_free_span) continue;
        expected.emplace_back(spans.high[i], last ? bake::kOpenSkyMm : spans.low[i + 1]);
      }
      ASSERT_EQ(gaps->count[c], static_cast<int32_t>(expected.size())) << "seed " << seed;
      for (size_t k = 0; k < expected.size(); ++k) {
        const bake::FreeSpanLayer& layer = *gaps->layers[k];
        ASSERT_EQ(layer.top[c] + gaps->base, expected[k].first);
        const int32_t ceiling = layer.ceiling[c];
        ASSERT_EQ(ceiling == bake::kOpenSkyMm ? ceiling : ceiling + gaps->base, expected[k].second);
        // The support is no higher than the solid, and not below the run's lowest span.
        if (layer.support[c] != bake::kNoSupport) {
          ASSERT_LE(layer.support[c] >> 8, layer.top[c]);
        }
      }
    }
  }
}

TEST(Columns, SupportIsTheSurfaceUnderTheCentre) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    const Soup soup = random_soup(seed, 0.1, 1);
    const auto triangles = cell_triangles(soup);
    auto columns = std::make_unique<bake::TileColumns>();
    bake::rasterise_tile(triangles, all_items(1), 0, 0, {}, 0, *columns);
    const bake::CellTriangle& t = triangles[0];
    const double area =
        (t.x[1] - t.x[0]) * (t.z[2] - t.z[0]) - (t.x[2] - t.x[0]) * (t.z[1] - t.z[0]);
    if (std::fabs(area) < 1e-3) continue;
    for (int32_t z = 0; z < 64; ++z) {
      for (int32_t x = 0; x < 64; ++x) {
        const double px = x + 0.5, pz = z + 0.5;
        const auto side = [&](size_t a, size_t b) {
          return ((t.x[b] - t.x[a]) * (pz - t.z[a]) - (px - t.x[a]) * (t.z[b] - t.z[a])) / area;
        };
        const double w2 = side(0, 1), w0 = side(1, 2), w1 = side(2, 0);
        const size_t c = static_cast<size_t>(z * 64 + x);
        const size_t at = columns->place(c);
        const bool supported =
            columns->holds(0, c) && columns->layers[0]->support[at] != bake::kNoSupport;
        if (std::min({w0, w1, w2}) > 1e-4) {
          ASSERT_TRUE(supported) << "seed " << seed << " cell " << x << " " << z;
          const double y = w0 * t.y[0] + w1 * t.y[1] + w2 * t.y[2];
          ASSERT_NEAR((columns->layers[0]->support[at] >> 8) + columns->base, y, 1.1);
        } else if (std::min({w0, w1, w2}) < -1e-4) {
          ASSERT_FALSE(supported) << "seed " << seed << " cell " << x << " " << z;
        }
      }
    }
  }
}

uint64_t hash_columns() {
  uint64_t hash = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const Soup soup = random_soup(seed, 0.1, 40);
    const bake::TileSpans spans = fast_spans(soup, 0);
    hash = hash_span(std::span<const int32_t>(spans.low), hash);
    hash = hash_span(std::span<const int32_t>(spans.high), hash);
    const auto triangles = cell_triangles(soup);
    auto columns = std::make_unique<bake::TileColumns>();
    bake::rasterise_tile(triangles, all_items(triangles.size()), 0, 0, {}, 999, *columns);
    auto gaps = std::make_unique<bake::TileFreeSpans>();
    bake::find_free_spans(*columns, 1000, *gaps);
    for (size_t c = 0; c < 4096; ++c) {
      for (int32_t k = 0; k < gaps->count[c]; ++k) {
        const bake::FreeSpanLayer& layer = *gaps->layers[static_cast<size_t>(k)];
        const int32_t values[3] = {layer.top[c], layer.ceiling[c], layer.support[c]};
        hash = hash_bytes(values, sizeof values, hash);
      }
    }
  }
  return hash;
}

TEST(Columns, SameBytesForEverySimdWidth) {
  const uint64_t expected = hash_columns();
  test::for_every_simd_target(
      [&](const char* target) { EXPECT_EQ(hash_columns(), expected) << target; });
  EXPECT_EQ(expected, 15705882385212781359u) << std::hex << expected;
}

}  // namespace
}  // namespace throng
