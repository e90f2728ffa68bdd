// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/polygon.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace throng {
namespace {

using Points = std::vector<importer::Vec2d>;
using Rings = std::vector<Points>;

double area_of(const Points& ring) {
  double sum = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const importer::Vec2d a = ring[i];
    const importer::Vec2d b = ring[(i + 1) % ring.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return std::fabs(sum) / 2;
}

bool contains(const Rings& rings, importer::Vec2d p) {  // Even-odd.
  bool inside = false;
  for (const Points& ring : rings) {
    for (size_t i = 0; i < ring.size(); ++i) {
      const importer::Vec2d a = ring[i];
      const importer::Vec2d b = ring[(i + 1) % ring.size()];
      if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) {
        inside = !inside;
      }
    }
  }
  return inside;
}

struct Cut {
  bool exact = false;
  std::vector<Vec3d> points;
  std::vector<std::array<uint32_t, 3>> triangles;
  double area = 0;
};

template <class Lift>
Cut cut(const Rings& rings, Lift lift) {
  Cut out;
  std::vector<uint32_t> first{0};
  for (const Points& ring : rings) {
    for (const importer::Vec2d p : ring) out.points.push_back(lift(p));
    first.push_back(static_cast<uint32_t>(out.points.size()));
  }
  importer::PolygonCutter cutter;
  out.exact = cutter.cut(out.points, first, out.triangles);
  for (const auto& [a, b, c] : out.triangles) {
    out.area += length(cross(out.points[b] - out.points[a], out.points[c] - out.points[a])) / 2;
  }
  return out;
}

Cut cut(const Rings& rings) {
  return cut(rings, [](importer::Vec2d p) { return Vec3d{p.x, p.y, 0}; });
}

// Checks area, side and place of every triangle, which together exclude a wrong cut.
void expect_exact(const Rings& rings, const char* what) {
  double area = area_of(rings[0]);
  for (size_t i = 1; i < rings.size(); ++i) area -= area_of(rings[i]);
  const Cut out = cut(rings);
  EXPECT_TRUE(out.exact) << what;
  EXPECT_NEAR(out.area, area, 1e-9 * area_of(rings[0])) << what;
  for (const auto& [a, b, c] : out.triangles) {
    const Vec3d centre = (out.points[a] + out.points[b] + out.points[c]) * (1.0 / 3);
    EXPECT_TRUE(contains(rings, {centre.x, centre.y})) << what;
  }
}

class Dice {
 public:
  explicit Dice(uint64_t seed) : seed_(seed) {}
  double unit() { return random_unit(seed_, 0, counter_++); }
  int below(int n) {
    return static_cast<int>(random_below(seed_, 1, counter_++, static_cast<uint64_t>(n)));
  }

 private:
  uint64_t seed_;
  uint64_t counter_ = 0;
};

Points star(Dice& dice, importer::Vec2d centre, double radius, int corners, double roughness) {
  Points ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.8 * dice.unit()) / corners;
    const double r = radius * (1 - roughness * dice.unit());
    ring.push_back({centre.x + r * std::cos(angle), centre.y + r * std::sin(angle)});
  }
  return ring;
}

TEST(Orient, AgreesWithWholeNumbersWhereDoublesDoNot) {
  // Points on and one unit in the last place off a line through far coordinates.
  const importer::Vec2d a{500000, 5000000};
  const importer::Vec2d b{500001, 5000001};
  for (int k = 2; k < 100; ++k) {
    const importer::Vec2d on{500000.0 + k, 5000000.0 + k};
    EXPECT_EQ(importer::orient(a, b, on), 0);
    EXPECT_EQ(importer::orient(a, b, {on.x, std::nextafter(on.y, 1e9)}), 1);
    EXPECT_EQ(importer::orient(a, b, {std::nextafter(on.x, 1e9), on.y}), -1);
  }
  // A triangle of 1e-20 beside the origin: the filter cannot see it, the exact sum can.
  EXPECT_EQ(importer::orient({1e-9, 1e-9}, {2e-9, 2e-9}, {3e-9, std::nextafter(3e-9, 1)}), 1);
}

TEST(Orient, IsAntisymmetricAndCyclic) {
  Dice dice(3);
  for (int i = 0; i < 20000; ++i) {
    const auto coordinate = [&] { return 0.1 * dice.below(40) + 1e5; };
    const importer::Vec2d a{coordinate(), coordinate()};
    const importer::Vec2d b{coordinate(), coordinate()};
    const importer::Vec2d c{coordinate(), coordinate()};
    EXPECT_EQ(importer::orient(a, b, c), importer::orient(b, c, a));
    EXPECT_EQ(importer::orient(a, b, c), -importer::orient(b, a, c));
  }
}

TEST(Polygon, SquareWithSquareHole) {
  expect_exact({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}, {3, 1}, {3, 3}, {1, 3}}}, "ring");
}

TEST(Polygon, RandomStarsWithHolesKeepTheirArea) {
  for (uint64_t seed = 0; seed < 400; ++seed) {
    Dice dice(seed);
    Rings rings;
    rings.push_back(star(dice, {0, 0}, 30, 8 + dice.below(60), 0.3));
    const int cells = dice.below(5);
    for (int y = 0; y < cells; ++y) {
      for (int x = 0; x < cells; ++x) {
        const importer::Vec2d centre{(x - 0.5 * (cells - 1)) * 24.0 / cells,
                                     (y - 0.5 * (cells - 1)) * 24.0 / cells};
        rings.push_back(star(dice, centre, 11.0 / cells, 3 + dice.below(20), 0.8));
        // Either winding must do.
        if (dice.below(2) == 0) std::reverse(rings.back().begin(), rings.back().end());
      }
    }
    if (dice.below(2) == 0) std::reverse(rings[0].begin(), rings[0].end());
    expect_exact(rings, std::to_string(seed).c_str());
  }
}

TEST(Polygon, HolesThatTouchEachOtherAndTheRimAtCornersAreExact) {
  // A chessboard: every hole touches its diagonal neighbours, some touch the rim.
  for (int n : {2, 4, 7}) {
    for (int margin : {0, 1}) {
      const double side = n + 2 * margin;
      Rings rings{{{0, 0}, {side, 0}, {side, side}, {0, side}}};
      for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
          const bool at_rim = x == 0 || y == 0 || x == n - 1 || y == n - 1;
          if ((x + y) % 2 != 0 || (margin == 0 && at_rim)) continue;
          const double a = x + margin;
          const double b = y + margin;
          rings.push_back({{a, b}, {a + 1, b}, {a + 1, b + 1}, {a, b + 1}});
        }
      }
      expect_exact(rings, "chessboard");
    }
  }
  // A diamond whose four corners lie on the rim's edges, and one that shares two corners with it.
  expect_exact({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{2, 0}, {4, 2}, {2, 4}, {0, 2}}}, "diamond");
  expect_exact({{{0, 0}, {4, 0}, {6, 2}, {4, 4}, {0, 4}}, {{0, 0}, {2, 1}, {4, 4}, {1, 2}}},
               "shared corners");
}

TEST(Polygon, WholeNumberPolygonsWithManyStraightRunsAreExact) {
  // A rectangle's rim walked cell by cell, pushed in here and there: mostly collinear corners.
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Dice dice(seed);
    Points ring;
    const int n = 6 + dice.below(20);
    for (int x = 0; x < n; ++x) ring.push_back({1.0 * x, 1.0 * (x > 0 ? dice.below(3) : 0)});
    for (int y = 0; y < n; ++y) ring.push_back({1.0 * n, 1.0 * y + 3});
    for (int x = n; x > 0; --x) ring.push_back({1.0 * x, n + 3.0 + (x < n ? dice.below(3) : 0)});
    for (int y = n; y > 0; --y) ring.push_back({0, 1.0 * y + 2});
    expect_exact({ring}, std::to_string(seed).c_str());
  }
}

TEST(Polygon, RepeatedCornersSpikesAndSelfTouchingAreExact) {
  expect_exact({{{0, 0}, {0, 0}, {4, 0}, {4, 4}, {4, 4}, {4, 4}, {0, 4}, {0, 0}}}, "repeats");
  expect_exact({{{0, 0}, {4, 0}, {6, 0}, {4, 0}, {4, 4}, {0, 4}}}, "spike out");
  expect_exact({{{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 2}, {2, 4}, {0, 4}}}, "spike in");
  // Two squares that touch in one corner, as one ring.
  expect_exact({{{0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 4}, {2, 4}, {2, 2}, {0, 2}}}, "figure eight");
  // A ring that closes round a hole by a doubled edge.
  expect_exact({{{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}}},
               "key hole");
}

TEST(Polygon, TiltedPlanesInNationalCoordinatesKeepTheirArea) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Dice dice(seed);
    const Rings rings{star(dice, {0, 0}, 20, 12, 0.5), star(dice, {0, 0}, 6, 7, 0.5)};
    const Vec3d u{dice.unit() - 0.5, dice.unit() - 0.5, dice.unit() - 0.5};
    Vec3d v = cross(u, {dice.unit(), dice.unit(), dice.unit()});
    const Vec3d e = u * (1 / length(u));
    v = v * (1 / length(v));
    const Cut out = cut(rings, [&](importer::Vec2d p) {
      return Vec3d{85000, 447000, 12} + e * p.x + v * p.y;
    });
    EXPECT_TRUE(out.exact);
    EXPECT_NEAR(out.area, area_of(rings[0]) - area_of(rings[1]), 1e-5);
    // Triangles face like the outer ring.
    const Vec3d normal = cross(e, v);
    for (const auto& [a, b, c] : out.triangles) {
      const Vec3d facing = cross(out.points[b] - out.points[a], out.points[c] - out.points[a]);
      EXPECT_GT(dot(facing, normal), -1e-6);
    }
  }
}

TEST(Polygon, AStraightKerbKeepsTheHeightsOfItsCorners) {
  // A strip that is a rectangle from above and goes up and down along both long sides, gently: a
  // face that doubles back under itself could not be cut in any plane.
  for (const int n : {2, 3, 10, 60}) {
    const auto height = [](double x) { return 0.3 * std::cos(x); };
    Points ring;
    for (int i = 0; i <= n; ++i) ring.push_back({1.0 * i, 0});
    for (int i = n; i >= 0; --i) ring.push_back({1.0 * i, 3});
    const Cut out = cut({ring}, [&](importer::Vec2d p) { return Vec3d{p.x, p.y, height(p.x)}; });
    EXPECT_TRUE(out.exact);
    std::vector<bool> used(ring.size(), false);
    double flat = 0;
    for (const auto& triangle : out.triangles) {
      double low = 1e9;
      double high = -1e9;
      for (const uint32_t corner : triangle) {
        used[corner] = true;
        low = std::fmin(low, ring[corner].x);
        high = std::fmax(high, ring[corner].x);
      }
      EXPECT_LE(high - low, n + 0.5);
      const importer::Vec2d a = ring[triangle[0]];
      const importer::Vec2d b = ring[triangle[1]];
      const importer::Vec2d c = ring[triangle[2]];
      flat += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
      EXPECT_NE(importer::orient(a, b, c), 0);  // No upright slivers: the surface itself bends.
    }
    EXPECT_NEAR(flat, 3 * n, 1e-9);
    EXPECT_EQ(out.triangles.size(), ring.size() - 2);
    for (const bool corner : used) EXPECT_TRUE(corner);
  }
}

TEST(Polygon, AnyCornerThatBendsInSpaceIsUsed) {
  // A rim with straight runs and square holes with a corner in the middle of each side, every
  // corner at a height of its own: nothing is straight in space.
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Dice dice(seed);
    const int n = 2 + dice.below(4);
    Rings rings(1);
    const int side = 4 * n;
    for (int i = 0; i < side; ++i) rings[0].push_back({1.0 * i, 0});
    for (int i = 0; i < side; ++i) rings[0].push_back({1.0 * side, 1.0 * i});
    for (int i = side; i > 0; --i) rings[0].push_back({1.0 * i, 1.0 * side});
    for (int i = side; i > 0; --i) rings[0].push_back({0, 1.0 * i});
    for (int x = 0; x < n; ++x) {
      for (int y = 0; y < n; ++y) {
        if (dice.below(2) == 0) continue;
        const double a = 4 * x + 1;
        const double b = 4 * y + 1;
        rings.push_back({{a, b},
                         {a + 1, b},
                         {a + 2, b},
                         {a + 2, b + 1},
                         {a + 2, b + 2},
                         {a + 1, b + 2},
                         {a, b + 2},
                         {a, b + 1}});
      }
    }
    const Cut out = cut(rings, [&](importer::Vec2d p) {
      return Vec3d{p.x, p.y, 0.1 * dice.unit()};
    });
    EXPECT_TRUE(out.exact) << seed;
    std::vector<bool> used(out.points.size(), false);
    double flat = 0;
    for (const auto& [a, b, c] : out.triangles) {
      const Vec3d normal = cross(out.points[b] - out.points[a], out.points[c] - out.points[a]);
      EXPECT_GT(normal.z, 0) << seed;
      flat += normal.z / 2;
      for (const uint32_t corner : {a, b, c}) used[corner] = true;
    }
    const double holes = static_cast<double>(rings.size()) - 1;
    EXPECT_NEAR(flat, 1.0 * side * side - 4 * holes, 1e-9) << seed;
    EXPECT_EQ(out.triangles.size(), out.points.size() - 2 + 2 * (rings.size() - 1)) << seed;
    for (const bool corner : used) EXPECT_TRUE(corner) << seed;
  }
}

TEST(Polygon, CrossingRingsAreReportedAndEnd) {
  EXPECT_FALSE(cut({{{0, 0}, {4, 4}, {4, 0}, {0, 5}}}).exact);  // a bow tie
  EXPECT_FALSE(cut({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{9, 9}, {8, 9}, {8, 8}}}).exact);  // outside
  EXPECT_FALSE(cut({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{3, 1}, {6, 1}, {6, 2}, {3, 2}}}).exact);
  for (uint64_t seed = 0; seed < 50; ++seed) {
    Dice dice(seed);
    Rings rings(1 + static_cast<size_t>(dice.below(6)));
    for (Points& ring : rings) {
      const int corners = 3 + dice.below(60);
      for (int i = 0; i < corners; ++i) ring.push_back({1.0 * dice.below(8), 1.0 * dice.below(8)});
    }
    const Cut out = cut(rings);
    for (const auto& triangle : out.triangles) {
      for (const uint32_t corner : triangle) EXPECT_LT(corner, out.points.size());
    }
  }
}

TEST(Polygon, WithoutAreaItStaysSolidButThin) {
  const Cut line = cut({{{0, 0}, {1, 0}, {2, 0}, {3, 0}}});
  EXPECT_EQ(line.triangles.size(), 2u);
  EXPECT_EQ(line.area, 0);
  EXPECT_TRUE(cut({{{0, 0}, {1, 0}}}).triangles.empty());
  const double nan = std::nan("");
  EXPECT_EQ(cut({{{0, 0}, {1, 0}, {nan, 1}, {0, 1}}}).triangles.size(), 2u);
}

TEST(Polygon, ManyCornersEndInGoodTime) {
  const auto begin = std::chrono::steady_clock::now();
  Points comb;  // 100 000 corners, half of them reflex
  const int teeth = 25000;
  for (int i = 0; i < teeth; ++i) {
    comb.insert(comb.end(),
                {{4.0 * i, 0}, {4.0 * i + 1, 1000}, {4.0 * i + 2, 1000}, {4.0 * i + 3, 0}});
  }
  comb.push_back({4.0 * teeth, -10});
  comb.push_back({0, -10});
  const Cut out = cut({comb});
  EXPECT_TRUE(out.exact);
  EXPECT_NEAR(out.area, area_of(comb), 1e-6 * area_of(comb));
  Dice dice(1);
  Points crossing;  // 20 000 random corners: everything crosses everything
  for (int i = 0; i < 20000; ++i) crossing.push_back({dice.unit(), dice.unit()});
  EXPECT_FALSE(cut({crossing}).exact);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(took.count(), 60);  // A second or two; a quadratic pass would take minutes.
}

}  // namespace
}  // namespace throng
