// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "bake/layers/surface_planes.h"
#include "baked.h"
#include "core/random.h"
#include "exact_bodies.h"
#include "simd_targets.h"
#include "throng/verify.h"

// Slopes near the limit of a class whose bottom is no higher than its slope needs. The oracle is
// verify's: the exact cylinder against the source triangles, here at the corners of every legal
// cell, where the feet are furthest from the plane's middle.
namespace throng {
namespace {

using test::add_box, test::expect_no_body_enters, test::for_legal_cells, test::ground, test::Height;

constexpr int32_t kWheelchair = 2;  // of the default classes

TEST(NearLimit, APlaneIsLegalUpToNearlyTheLimitAndNotBeyond) {
  constexpr double kSide = 9.0, kRim = 0.55;  // the radius, and a cell and a half
  for (const double percent : {1.0, 3.0, 5.0, 6.5, 8.0, 9.5, 11.5, 15.0}) {
    for (const double turn : {0.0, 0.3, std::numbers::pi / 4, 1.3, 2.5, 4.0}) {
      const double gx = percent / 100 * std::cos(turn), gz = percent / 100 * std::sin(turn);
      const Scene scene =
          ground(kSide, 1.5, 3, [&](double x, double z) { return 50 + gx * x + gz * z; });
      const World world = test::bake(scene, 0.1);
      const std::string what = std::to_string(percent) + " %, turned by " + std::to_string(turn);
      const int64_t cells = expect_no_body_enters(world, scene, kWheelchair, what);
      int64_t inner = 0;
      for_legal_cells(world, kWheelchair, [&](Vec3d p, double) {
        inner += p.x > kRim && p.z > kRim && p.x < kSide - kRim && p.z < kSide - kRim;
      });
      if (percent > 11) {
        EXPECT_EQ(cells, 0) << what;
      } else {
        EXPECT_GE(inner, 79 * 79) << what;
      }
    }
  }
}

// Heights of a lattice that rise by at most `percent` of its spacing to the next point.
Height rough(double spacing, double percent, uint64_t seed) {
  return [=](double x, double z) {
    const auto column = static_cast<uint64_t>(std::lround(x / spacing));
    const auto row = static_cast<uint64_t>(std::lround(z / spacing));
    return 10 + spacing * percent / 100 * random_unit(seed, row, column);
  };
}

TEST(NearLimit, NoBodyEntersCreasesKerbsAndPosts) {
  std::vector<AvatarClass> classes = default_classes();
  // One that clears its slope by nothing, on more than one cell in height; one thinner than a cell.
  classes.push_back(
      {.name = "steep", .height = 1, .radius = 0.27, .step_height = 0, .max_slope = 21});
  classes.push_back(
      {.name = "thin", .height = 1, .radius = 0.07, .step_height = 0.001, .max_slope = 12});
  std::array<int64_t, 6> cells{};
  for (uint64_t seed = 1; seed <= 14; ++seed) {
    const double spacing = std::array{0.25, 0.5, 1.0, 3.0}[seed % 4];
    const double percent = std::array{3.0, 6.0, 9.0, 30.0}[seed / 4 % 4];
    Scene scene = ground(9, spacing, seed, rough(spacing, percent, seed));
    for (uint64_t n = 0; n < (seed % 3 == 0 ? 0 : 12); ++n) {
      const double x = 8 * random_unit(seed, 1, n), z = 8 * random_unit(seed, 2, n);
      const double high = n % 3 == 0 ? 2 : 0.05 * random_unit(seed, 3, n);
      add_box(scene, {x, 9.9, z},
              {0.05 + random_unit(seed, 4, n), high + 0.1, 0.05 + random_unit(seed, 5, n)});
    }
    const World world = test::bake(scene, seed % 5 == 0 ? 0.07 : 0.1, classes);
    for (int32_t c : {kWheelchair, 4, 5}) {
      cells[static_cast<size_t>(c)] +=
          expect_no_body_enters(world, scene, c, "seed " + std::to_string(seed));
    }
  }
  EXPECT_GT(cells[kWheelchair], 10000);
  EXPECT_GT(cells[4], 40000);
  EXPECT_GT(cells[5], 40000);
}

TEST(NearLimit, LittleIsLostOnGentlyRollingGround) {
  const Scene scene = ground(24, 0.5, 5, [](double x, double z) {
    return 1.2 * std::sin(x * 0.03) + 0.9 * std::cos(z * 0.04 + x * 0.01);
  });
  const World world = test::bake(scene, 0.1);
  Context context;
  const auto report =
      verify_world(world, scene, {.samples = 4000, .avatar_class = kWheelchair}, context);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->entered, 0u);
  EXPECT_EQ(report->unsupported, 0u);
  EXPECT_EQ(report->broken, 0u);
  EXPECT_GT(report->standable_area_grown, 200);
  EXPECT_LE(report->lost_grown, 0.01);
}

// Nine tiles of triangles as a bake sees them.
struct Soup {
  explicit Soup(uint64_t seed) {
    const auto classes = default_classes();
    codes.codes = {{0, kAreaWalkable}, {1, kAreaBlocked}};
    codes.allowed = {15, 0};
    limits = bake::body_limits(classes, codes, 0.1);
    body = bake::body_window(classes[kWheelchair], kWheelchair, 0.1);
    for (uint64_t n = 0; n < 260; ++n) triangles.push_back(make(seed, n));
    bins = bake::bin_triangles(triangles, -bake::kTileSide, -bake::kTileSide, 3, 3, bake::kTileSide,
                               0);
    for (size_t i = 0; i < 9; ++i) {
      const auto n = static_cast<int32_t>(i);
      const auto items =
          std::span(bins.items).subspan(bins.first[i], bins.first[i + 1] - bins.first[i]);
      bake::TileColumns columns;
      bake::TileFreeSpans free_spans, high;
      bake::rasterise_tile(triangles, items, (n % 3 - 1) * bake::kTileSide,
                           (n / 3 - 1) * bake::kTileSide, {}, limits.min_free_span - 1, columns);
      bake::find_free_spans(columns, limits.min_free_span, free_spans);
      bake::find_free_spans(columns, bake::BodyLimits::kHighFreeSpan, high);
      bake::lend_supports(free_spans);
      bake::assign_free_spans({.high = high, .all = &free_spans}, limits, pool, tiles[i]);
      for (const auto& layer : tiles[i]) {
        bake::find_useful(limits, *layer);
        lists[i].add(layer.get());
      }
      around[i] = &lists[i];
      of_tiles.items[i] = items;
    }
    of_tiles.all = triangles;
  }

  // Ground in large triangles, patches of it, slivers, upright ones and far ones.
  static bake::CellTriangle make(uint64_t seed, uint64_t n) {
    const uint64_t kind = n < 8 ? 0 : random_below(seed, 1, n, 5);
    const double size = std::array{300.0, 40.0, 3.0, 12.0, 0.6}[kind];
    const double rise = kind == 3 ? 100 : (kind == 4 ? 30 : 0.02 * size * 10);
    std::array<Vec3d, 3> p;
    const Vec3d middle{-70 + 204 * random_unit(seed, 2, n), 20 * random_unit(seed, 3, n),
                       -70 + 204 * random_unit(seed, 4, n)};
    for (uint64_t i = 0; i < 3; ++i) {
      const auto draw = [&](uint64_t axis) {
        return random_unit(seed, 10 + axis, 3 * n + i) - 0.5;
      };
      p[i] = {middle.x + size * draw(0), middle.y + rise * draw(1), middle.z + size * draw(2)};
      if (kind == 3 && i == 2) p[i].x = p[0].x + 1e-4 * draw(3), p[i].z = p[0].z;
      if (n % 7 == 0) p[i].x = std::floor(p[i].x);
    }
    std::sort(p.begin(), p.end(), [](const Vec3d& a, const Vec3d& b) { return a.z < b.z; });
    bake::CellTriangle t;
    for (size_t i = 0; i < 3; ++i) t.x[i] = p[i].x, t.y[i] = p[i].y, t.z[i] = p[i].z;
    t.low = static_cast<int32_t>(std::floor(std::min({p[0].y, p[1].y, p[2].y})));
    t.high = static_cast<int32_t>(std::ceil(std::max({p[0].y, p[1].y, p[2].y})));
    t.code = 0;
    return t;
  }

  bake::SurfaceCodes codes;
  bake::BodyLimits limits;
  bake::BodyWindow body;
  std::vector<bake::CellTriangle> triangles;
  bake::TriangleBins bins;
  bake::LayerPool pool;
  std::array<bake::TileLayers, 9> tiles;
  std::array<bake::LayerList, 9> lists;
  bake::Neighbourhood around{};
  bake::TileTriangles of_tiles;
};

TEST(SurfacePlanes, NoSolidBelowTheFreeSpanIsAboveThePlaneByMoreThanTheExcess) {
  int64_t points = 0, planes = 0, raised = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const Soup soup(seed);
    bake::BitPlane asked;
    for (size_t z = 0; z < bake::kTileSide; ++z) {
      asked[z] = seed % 3 != 0 ? ~uint64_t{0} : (z % 9 < 5 ? random_u64(seed, 5, z) : 0);
    }
    bake::CellPlanes planes_of;
    bake::LayerWindow window;
    for (size_t s = 0; s < soup.tiles[4].size(); ++s) {
      const int32_t base = soup.tiles[4][s]->base;
      window.assemble(soup.around, s, soup.body.reach, soup.limits);
      bake::find_surface_planes(window, base, asked, soup.body, soup.of_tiles, planes_of);
      for (uint64_t n = 0; n < soup.triangles.size(); ++n) {
        const bake::CellTriangle& t = soup.triangles[n];
        for (uint64_t k = 0; k < 300; ++k) {
          // Inside, on sides and at corners.
          double a = random_unit(seed + s, 6 + n, 2 * k),
                 b = random_unit(seed + s, 6 + n, 2 * k + 1);
          if (a + b > 1) a = 1 - a, b = 1 - b;
          if (k % 4 == 1) b = 0;
          if (k % 4 == 2) b = 1 - a;
          if (k < 3) a = k == 1, b = k == 2;
          const double x = t.x[0] + a * (t.x[1] - t.x[0]) + b * (t.x[2] - t.x[0]);
          const double y = t.y[0] + a * (t.y[1] - t.y[0]) + b * (t.y[2] - t.y[0]) - base;
          const double z = t.z[0] + a * (t.z[1] - t.z[0]) + b * (t.z[2] - t.z[0]);
          const auto cx = static_cast<int32_t>(std::floor(x));
          const auto cz = static_cast<int32_t>(std::floor(z));
          if (cx < 0 || cz < 0 || cx >= bake::kTileSide || cz >= bake::kTileSide) continue;
          if ((asked[static_cast<size_t>(cz)] >> cx & 1) == 0) continue;
          const size_t i = window.index(cx, cz);
          if (window.top[i] == bake::kNone16 || y > window.top[i]) continue;
          ++points;
          planes += planes_of.excess[i] >= 0;
          raised += planes_of.excess[i] > 1;
          if (planes_of.excess[i] > static_cast<float>(soup.body.hope)) continue;
          const double plane = planes_of.height[i] + planes_of.slope_x[i] * (x - cx - 0.5) +
                               planes_of.slope_z[i] * (z - cz - 0.5);
          ASSERT_LE(y - plane, std::max(planes_of.excess[i], 0.0f) + 1e-3)
              << "seed " << seed << " triangle " << n << " cell " << cx << " " << cz;
        }
      }
    }
  }
  EXPECT_GT(points, 300000);
  EXPECT_GT(planes, points / 2);
  EXPECT_GT(raised, 10000);
}

TEST(NearLimit, EveryVectorWidthFindsTheSame) {
  const Scene scene = ground(9, 0.5, 2, rough(0.5, 5, 2));
  const auto cells = [&] {
    std::vector<Vec3d> found;
    for_legal_cells(test::bake(scene, 0.1), kWheelchair,
                    [&](Vec3d at, double) { found.push_back(at); });
    return found;
  };
  const std::vector<Vec3d> all = cells();
  EXPECT_GT(all.size(), 1000u);
  test::for_every_simd_target([&](const char* target) {
    const std::vector<Vec3d> again = cells();
    ASSERT_EQ(again.size(), all.size()) << target;
    for (size_t i = 0; i < all.size(); ++i) {
      ASSERT_TRUE(again[i].x == all[i].x && again[i].y == all[i].y && again[i].z == all[i].z)
          << target;
    }
  });
}

}  // namespace
}  // namespace throng
