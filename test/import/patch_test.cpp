// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "patch_nets.h"
#include "throng/scene.h"

namespace throng {
namespace {

BezierPatch random_patch(uint64_t seed) {
  BezierPatch patch;
  for (size_t i = 0; i < 16; ++i) {
    const auto roll = [&](uint64_t what) { return random_unit(seed, what, i); };
    patch.points[i] = {static_cast<double>(i % 4) + roll(0), 2 * roll(1),
                       static_cast<double>(i / 4) + roll(2)};
  }
  return patch;
}

void expect_near(Vec3d a, Vec3d b, double within) { EXPECT_LE(length(a - b), within); }

// Repeated linear blending instead of Bernstein's polynomials.
Vec3d de_casteljau(const BezierPatch& patch, double s, double t) {
  std::vector<Vec3d> rows;
  const auto reduce = [](std::vector<Vec3d> c, double u) {
    while (c.size() > 1) {
      for (size_t i = 0; i + 1 < c.size(); ++i) c[i] = c[i] * (1 - u) + c[i + 1] * u;
      c.pop_back();
    }
    return c[0];
  };
  for (size_t j = 0; j < 4; ++j) {
    rows.push_back(reduce({patch.points.begin() + static_cast<ptrdiff_t>(4 * j),
                           patch.points.begin() + static_cast<ptrdiff_t>(4 * j + 4)},
                          s));
  }
  return reduce(rows, t);
}

TEST(BezierPatch, PointsAndDerivativesAgreeWithBlendingAndDifferences) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const BezierPatch patch = random_patch(seed);
    for (uint64_t k = 0; k < 20; ++k) {
      const double s = random_unit(seed, 8, k);
      const double t = random_unit(seed, 9, k);
      expect_near(patch.at(s, t), de_casteljau(patch, s, t), 1e-13);
      const double h = 1e-5;
      expect_near(patch.along_s(s, t), (patch.at(s + h, t) - patch.at(s - h, t)) * (0.5 / h), 1e-7);
      expect_near(patch.along_t(s, t), (patch.at(s, t + h) - patch.at(s, t - h)) * (0.5 / h), 1e-7);
      const Vec3d n = patch.normal(s, t);
      EXPECT_NEAR(length(n), 1, 1e-12);
      EXPECT_NEAR(dot(n, patch.along_s(s, t)), 0, 1e-9);
      EXPECT_NEAR(dot(n, patch.along_t(s, t)), 0, 1e-9);
    }
  }
}

TEST(BezierPatch, VerticesAndEdgesRunCounterClockwiseSeenFromTheNormal) {
  BezierPatch flat;
  for (size_t i = 0; i < 16; ++i) {
    flat.points[i] = {static_cast<double>(i % 4), 0, static_cast<double>(i / 4)};
  }
  EXPECT_EQ(flat.normal(0.3, 0.6), (Vec3d{0, 1, 0}));
  double doubled = 0;  // Area in plan, counter-clockwise seen from above: z grows towards us.
  for (int32_t e = 0; e < 4; ++e) {
    const auto curve = flat.edge(e);
    EXPECT_EQ(curve[0], flat.vertex(e));
    EXPECT_EQ(curve[3], flat.vertex((e + 1) % 4));
    doubled += curve[0].z * curve[3].x - curve[3].z * curve[0].x;
  }
  EXPECT_EQ(doubled, 18);
}

TEST(BezierPatch, EdgesAreTheBorderOfTheSurface) {
  const BezierPatch patch = random_patch(3);
  for (const double u : {0.0, 0.2, 0.7, 1.0}) {
    expect_near(cubic_point(patch.edge(0), u), patch.at(0, u), 1e-13);
    expect_near(cubic_point(patch.edge(1), u), patch.at(u, 1), 1e-13);
    expect_near(cubic_point(patch.edge(2), u), patch.at(1, 1 - u), 1e-13);
    expect_near(cubic_point(patch.edge(3), u), patch.at(1 - u, 0), 1e-13);
  }
}

TEST(BezierPatch, SplitPartsAreTheSameSurface) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const BezierPatch patch = random_patch(seed);
    const double at = 0.1 + 0.8 * random_unit(seed, 7, 0);
    const auto by_s = split_s(patch, at);
    const auto by_t = split_t(patch, at);
    for (uint64_t k = 0; k < 20; ++k) {
      const double s = random_unit(seed, 8, k);
      const double t = random_unit(seed, 9, k);
      expect_near(by_s[0].at(s, t), patch.at(s * at, t), 1e-13);
      expect_near(by_s[1].at(s, t), patch.at(at + s * (1 - at), t), 1e-13);
      expect_near(by_t[0].at(s, t), patch.at(s, t * at), 1e-13);
      expect_near(by_t[1].at(s, t), patch.at(s, at + t * (1 - at)), 1e-13);
    }
    EXPECT_EQ(by_s[0].edge(2)[0], by_s[1].edge(0)[3]);  // One border, the same bits.
    EXPECT_EQ(by_t[0].edge(1)[2], by_t[1].edge(3)[1]);
  }
}

TEST(BezierPatch, ARaisedPatchIsTheSameSurface) {
  for (const int32_t ds : {1, 2, 3}) {
    for (const int32_t dt : {1, 2, 3}) {
      std::vector<Vec3d> points;
      const auto count = static_cast<uint64_t>((ds + 1) * (dt + 1));
      for (uint64_t i = 0; i < count; ++i) {
        points.push_back({random_unit(1, 0, i), random_unit(1, 1, i), random_unit(1, 2, i)});
      }
      const BezierPatch raised = raise_degree(ds, dt, points);
      const auto weight = [](int32_t degree, int32_t i, double u) {
        const double choose = degree == 3 ? (i % 3 == 0 ? 1 : 3) : degree == 2 ? 1 + i % 2 : 1;
        return choose * std::pow(u, i) * std::pow(1 - u, degree - i);
      };
      for (uint64_t k = 0; k < 20; ++k) {
        const double s = random_unit(2, 0, k);
        const double t = random_unit(2, 1, k);
        Vec3d p;
        for (int32_t j = 0; j <= dt; ++j) {
          for (int32_t i = 0; i <= ds; ++i) {
            p = p +
                points[static_cast<size_t>(j * (ds + 1) + i)] * weight(ds, i, s) * weight(dt, j, t);
          }
        }
        expect_near(raised.at(s, t), p, 1e-14);
      }
    }
  }
}

TEST(BezierPatch, ARaisedPatchOfBadPointsIsNoBetterThanThese) {
  const std::vector<Vec3d> one_place(9, Vec3d{1, 2, 3});
  const BezierPatch point = raise_degree(2, 2, one_place);
  for (const Vec3d& p : point.points) expect_near(p, {1, 2, 3}, 1e-15);
  EXPECT_EQ(point.normal(0.5, 0.5), Vec3d{}) << "it has no area";

  for (const double bad : {double{NAN}, double{INFINITY}}) {
    for (size_t i = 0; i < 9; ++i) {
      std::vector<Vec3d> points;
      for (int32_t k = 0; k < 9; ++k) points.push_back({double(k % 3), 0, double(k) / 3});
      PatchSet sound, false_one;
      sound.add(raise_degree(2, 2, points));
      points[i].y = bad;
      false_one.add(raise_degree(2, 2, points));
      const auto passed = check_patches(sound);
      ASSERT_TRUE(passed) << passed.error().message;
      const auto refused = check_patches(false_one);
      ASSERT_FALSE(refused) << i;
      EXPECT_EQ(refused.error().code, Errc::kBadInput);
    }
  }
}

TEST(BezierPatch, ItsBoxHoldsTheSurface) {
  const BezierPatch patch = random_patch(11);
  const Box3d box = patch.bounds();
  for (uint64_t k = 0; k < 500; ++k) {
    const Vec3d p = patch.at(random_unit(1, 1, k), random_unit(1, 2, k));
    EXPECT_TRUE(box.min.x <= p.x && p.x <= box.max.x);
    EXPECT_TRUE(box.min.y <= p.y && p.y <= box.max.y);
    EXPECT_TRUE(box.min.z <= p.z && p.z <= box.max.z);
  }
}

// A cone's tip: edge 0 is a point, the sides slope down by 45 degrees.
TEST(BezierPatch, ACollapsedEdgeHasTheNormalOfItsSurroundings) {
  BezierPatch cone;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 4; ++i) {
      const double out = static_cast<double>(i);
      cone.points[4 * j + i] = {out, -out, out * (static_cast<double>(j) - 1.5) / 1.5};
    }
  }
  const Vec3d wanted{std::sqrt(0.5), std::sqrt(0.5), 0};
  for (const double t : {0.0, 0.3, 0.5, 1.0}) expect_near(cone.normal(0, t), wanted, 1e-5);
  expect_near(cone.normal(0.5, 0.5), wanted, 1e-12);
  // A corner at which both derivatives vanish.
  BezierPatch blunt = cone;
  for (const size_t i : {1, 4}) blunt.points[i] = blunt.points[0];
  const Vec3d n = blunt.normal(0, 0);
  EXPECT_NEAR(length(n), 1, 1e-12);
  EXPECT_GT(n.y, 0.1);
}

TEST(BezierPatch, APatchWithoutAreaHasNoNormal) {
  BezierPatch point;
  point.points.fill({1, 2, 3});
  EXPECT_EQ(point.normal(0.5, 0.5), Vec3d{});
}

PatchSet two_quads() {
  PatchSet set;
  set.begin_run("hill.json", "ground", "grass");
  for (int32_t k = 0; k < 2; ++k) {
    BezierPatch patch;
    for (size_t i = 0; i < 16; ++i) {
      patch.points[i] = {static_cast<double>(3 * k) + static_cast<double>(i % 4), 0,
                         static_cast<double>(i / 4)};
    }
    set.add(patch);
  }
  set.bind({0, 2}, {1, 0});
  return set;
}

std::string fault_of(const PatchSet& set) {
  const auto checked = check_patches(set);
  if (checked) return "";
  EXPECT_EQ(checked.error().code, Errc::kBadInput);
  return checked.error().message;
}

TEST(PatchSet, NeighboursMustNameEachOtherAndRunOppositely) {
  const PatchSet good = two_quads();
  EXPECT_EQ(fault_of(good), "");
  const std::string at = "hill.json: patch 0 of ground, edge 2: ";
  PatchSet set = good;
  set.edges[1][0] = {};
  EXPECT_EQ(fault_of(set), at + "hill.json: patch 1 of ground, edge 0, does not name it in return; "
                                "bind both");
  set = good;
  set.edges[0][2].next[0].patch = 2;
  EXPECT_EQ(fault_of(set), at +
                               "its neighbour is patch 2 edge 0, which does not exist; name one of "
                               "2 patches and edge 0 to 3");
  set = good;
  set.edges[0][2].next[0].edge = 4;
  EXPECT_NE(fault_of(set), "");
  set = good;
  set.edges[0][2].next[1] = {1, 1};
  EXPECT_EQ(fault_of(set), at + "names more neighbours than it has; remove them");
  set = good;
  set.edges[0][2] = {EdgeBind::kOne, {PatchSide{0, 2}}};
  EXPECT_EQ(fault_of(set), at + "is its own neighbour; leave it open");
  set = good;
  set.edges[0][2] = {static_cast<EdgeBind>(3), {}};
  EXPECT_EQ(fault_of(set), at + "has a kind that does not exist; use 0, 1, 2, 4 or part");
  set = good;
  set.patches[1] = test::turn(set.patches[1], 2);
  set.edges[0][2].next[0] = {1, 2};
  set.edges[1][2] = {EdgeBind::kOne, {PatchSide{0, 2}}};
  set.edges[1][0] = {};
  EXPECT_EQ(fault_of(set), "");                          // Turned, and named as it now lies.
  for (Vec3d& p : set.patches[1].points) p.z = 3 - p.z;  // Mirrored: now it shows its back.
  EXPECT_EQ(fault_of(set), at +
                               "lies 3 m from hill.json: patch 1 of ground, edge 2, its neighbour; "
                               "they must meet within 0.1 m and run in opposite directions");
}

TEST(PatchSet, WrongNumbersAreNamed) {
  PatchSet set = two_quads();
  set.patches[1].points[7].y = NAN;
  EXPECT_EQ(fault_of(set),
            "hill.json: patch 1 of ground has a control point that is not finite; repair the file");
  set = two_quads();
  set.edges.pop_back();
  EXPECT_EQ(fault_of(set), "patches: 2 patches but edges of 1; give four edges to each");
  set = two_quads();
  set.runs[0].patch_count = 1;
  EXPECT_EQ(fault_of(set), "patches: the runs leave out patches or overlap; add patches by add()");
}

TEST(PatchSet, AppendingKeepsNeighboursAndRuns) {
  PatchSet set = two_quads();
  PatchSet other = test::make_net({.side = 3, .seed = 2});
  const size_t added = other.size();
  set.append(other);
  EXPECT_EQ(fault_of(set), "");
  EXPECT_EQ(set.size(), 2 + added);
  EXPECT_EQ(set.name_of(2), "patches: patch 0");
  const auto component = patch_components(set);
  EXPECT_EQ(component[0], 0u);
  EXPECT_EQ(component[1], 0u);
  for (size_t p = 2; p < set.size(); ++p) EXPECT_EQ(component[p], 1u);
}

}  // namespace
}  // namespace throng
