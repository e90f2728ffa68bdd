// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/cylinder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace throng::verify {
namespace {

const Cylinder kBody{.x = 10, .z = -5, .low = 1, .high = 3, .radius = 0.5};

Vec3d at_body(double x, double y, double z) { return {kBody.x + x, kBody.low + y, kBody.z + z}; }

TEST(Cylinder, WallIsMetOnlyDeeperThanATouch) {
  const auto wall = [](double x) {
    return Corners{at_body(x, -9, -9), at_body(x, 9, -9), at_body(x, 0, 20)};
  };
  EXPECT_FALSE(meets(kBody, wall(0.51)));
  EXPECT_FALSE(meets(kBody, wall(0.5)));
  EXPECT_FALSE(meets(kBody, wall(0.5 - 0.5e-6)));
  EXPECT_TRUE(meets(kBody, wall(0.5 - 2e-6)));
  EXPECT_TRUE(meets(kBody, wall(0)));
}

TEST(Cylinder, FloorAndCeilingAreMetOnlyDeeperThanATouch) {
  const auto plane = [](double y) {
    return Corners{at_body(-50, y, -50), at_body(50, y, -50), at_body(0, y, 90)};
  };
  EXPECT_FALSE(meets(kBody, plane(-0.1)));
  EXPECT_FALSE(meets(kBody, plane(0)));
  EXPECT_TRUE(meets(kBody, plane(2e-6)));
  EXPECT_TRUE(meets(kBody, plane(1)));
  EXPECT_TRUE(meets(kBody, plane(2 - 2e-6)));
  EXPECT_FALSE(meets(kBody, plane(2)));
}

TEST(Cylinder, TriangleInsideIsMetThoughNoEdgeCrossesTheSurface) {
  EXPECT_TRUE(meets(kBody, {at_body(0.1, 1, 0), at_body(0, 1.1, 0.1), at_body(-0.1, 1, 0)}));
}

TEST(Cylinder, PlaneAroundTheAxisIsMetThoughItsEdgesAreFar) {
  EXPECT_TRUE(meets(kBody, {at_body(-9, 1, -9), at_body(9, 1.5, -9), at_body(0, 1, 9)}));
  // The same with a leaning plane that is inside the slab beside the disc only.
  EXPECT_FALSE(meets(kBody, {at_body(-9, -2, -9), at_body(9, 9, -9), at_body(-9, -2, 9)}));
}

TEST(Cylinder, CornerOutsideTheDiscButInsideItsBoxIsNotMet) {
  const double d = 0.5 * 0.7072;  // Just past the rim along the diagonal.
  EXPECT_FALSE(meets(kBody, {at_body(d, 0, d), at_body(d, 2, d), at_body(2, 1, 2)}));
  EXPECT_TRUE(meets(kBody, {at_body(0.353, 0, 0.353), at_body(0.353, 2, 0.353), at_body(2, 1, 2)}));
}

TEST(Cylinder, SegmentsAndPointsAreSolidToo) {
  const Vec3d inside = at_body(0.2, 1, 0.2);
  const Vec3d outside = at_body(0.4, 1, 0.4);
  EXPECT_TRUE(meets(kBody, {inside, inside, inside}));
  EXPECT_FALSE(meets(kBody, {outside, outside, outside}));
  const Vec3d left = at_body(-3, 0.1, 0), right = at_body(3, 1.9, 0);
  EXPECT_TRUE(meets(kBody, {left, right, left}));
  EXPECT_TRUE(meets(kBody, {left, left, right}));
  const Vec3d under = at_body(0, -1, 0), over = at_body(0, 3, 0);
  EXPECT_TRUE(meets(kBody, {under, over, over}));  // Seen from above it is a point.
  // On a line through the axis, but ending before the body: all turns are zero.
  EXPECT_FALSE(meets(kBody, {at_body(0.6, 1, 0), at_body(2, 1, 0), at_body(1, 1, 0)}));
  EXPECT_FALSE(meets(kBody, {at_body(0.6, 1, 0.3), at_body(2, 1, 1), at_body(4, 1, 2)}));
}

TEST(Cylinder, TenKilometreTriangleIsJudgedToTheMicrometre) {
  const auto wall = [](double x) {
    return Corners{at_body(x, -1e4, -1e4), at_body(x, 1e4, -1e4), at_body(x, 1, 1e4)};
  };
  EXPECT_FALSE(meets(kBody, wall(0.5)));
  EXPECT_TRUE(meets(kBody, wall(0.5 - 3e-6)));
}

// Dense points of the triangle against the cylinder. They can only miss what lies between them.
struct Sampled {
  bool inside = false;  ///< A point lies deeper than a touch.
  bool close = false;   ///< A point lies within the spacing of the points.
};

Sampled sample(const Cylinder& c, const Corners& t) {
  constexpr int kSteps = 150;
  double longest = 0;
  for (size_t i = 0; i < 3; ++i) longest = std::max(longest, length(t[i] - t[(i + 1) % 3]));
  const double spacing = longest / kSteps;
  Sampled result;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
      const Vec3d p = t[0] * (1 - u - v) + t[1] * u + t[2] * v;
      const double d = std::hypot(p.x - c.x, p.z - c.z);
      if (d < c.radius - 2e-6 && p.y > c.low + 2e-6 && p.y < c.high - 2e-6) result.inside = true;
      if (d < c.radius + spacing && p.y > c.low - spacing && p.y < c.high + spacing) {
        result.close = true;
      }
    }
  }
  return result;
}

TEST(Cylinder, AgreesWithDensePointsOfRandomTriangles) {
  int met = 0, missed = 0;
  for (uint64_t n = 0; n < 1500; ++n) {
    uint64_t counter = 0;
    const auto random = [&](double low, double high) {
      return low + (high - low) * random_unit(7, n, counter++);
    };
    Corners t;
    for (Vec3d& p : t) p = at_body(random(-1.2, 1.2), random(-1.5, 3.5), random(-1.2, 1.2));
    if (n % 5 == 1) t[2] = t[1];                      // A segment,
    if (n % 5 == 2) t[2] = (t[0] + t[1]) * 0.5;       // one with three corners,
    if (n % 5 == 3) t[1] = {t[0].x, t[1].y, t[0].z};  // a vertical edge.
    const Sampled points = sample(kBody, t);
    const bool result = meets(kBody, t);
    EXPECT_TRUE(result || !points.inside) << "triangle " << n << " was missed";
    EXPECT_TRUE(!result || points.close) << "triangle " << n << " is too far away";
    ++(result ? met : missed);
  }
  EXPECT_GT(met, 300);
  EXPECT_GT(missed, 300);
}

TEST(Cylinder, TurningTheCornersChangesNothing) {
  for (uint64_t n = 0; n < 2000; ++n) {
    uint64_t counter = 0;
    const auto random = [&](double size) { return size * (random_unit(8, n, counter++) - 0.5); };
    Corners t;
    for (Vec3d& p : t) p = at_body(random(3), 1 + random(5), random(3));
    const bool result = meets(kBody, t);
    EXPECT_EQ(result, meets(kBody, {t[1], t[2], t[0]}));
    EXPECT_EQ(result, meets(kBody, {t[2], t[1], t[0]}));
  }
}

TEST(Cylinder, HeightOfAPlaneIsExactAndCoversItsEdges) {
  const Corners t{Vec3d{0, 1, 0}, Vec3d{4, 3, 0}, Vec3d{0, 1, 4}};
  EXPECT_NEAR(height_at(t, 1, 1).value(), 1.5, 1e-12);
  EXPECT_NEAR(height_at(t, 2, 0).value(), 2, 1e-12);
  EXPECT_NEAR(height_at(t, 0, 0).value(), 1, 1e-12);
  EXPECT_FALSE(height_at(t, 2.1, 2));
  EXPECT_FALSE(height_at(t, -1e-6, 1));
  EXPECT_FALSE(height_at({Vec3d{0, 0, 0}, Vec3d{0, 5, 0}, Vec3d{0, 0, 5}}, 0, 1));  // A wall.
}

TEST(Cylinder, LevelnessIsTheCosineOfTheSlopeWhereverItFaces) {
  EXPECT_NEAR(levelness({Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 0, 1}}), 1, 1e-12);
  EXPECT_NEAR(levelness({Vec3d{0, 0, 0}, Vec3d{0, 0, 1}, Vec3d{1, 0, 0}}), 1, 1e-12);
  EXPECT_NEAR(levelness({Vec3d{0, 0, 0}, Vec3d{1, 1, 0}, Vec3d{0, 0, 1}}), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(levelness({Vec3d{0, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}), 0);
  EXPECT_EQ(levelness({Vec3d{1, 2, 3}, Vec3d{1, 2, 3}, Vec3d{1, 2, 3}}), 0);
}

}  // namespace
}  // namespace throng::verify
