// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "core/random.h"
#include "patch_nets.h"
#include "throng/scene.h"

namespace throng {
namespace {

PatchMesh cut(const PatchSet& set, double tolerance, int32_t workers = 0) {
  Context context;
  auto mesh = tessellate_patches(set, {.tolerance = tolerance, .workers = workers}, context);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *std::move(mesh) : PatchMesh{};
}

uint64_t hash_of(const PatchMesh& mesh) {
  std::vector<int64_t> numbers;
  for (const Vec3d& p : mesh.positions) {
    for (const double c : {p.x, p.y, p.z}) {
      numbers.push_back(static_cast<int64_t>(std::floor(c * 1000 + 0.5)));
    }
  }
  for (const auto& t : mesh.triangles) numbers.insert(numbers.end(), t.begin(), t.end());
  numbers.insert(numbers.end(), mesh.first.begin(), mesh.first.end());
  return hash_span(std::span<const int64_t>(numbers));
}

size_t count_kind(const PatchSet& set, EdgeBind bind) {
  size_t count = 0;
  for (const auto& four : set.edges) {
    for (const PatchEdge& edge : four) count += edge.bind == bind ? 1 : 0;
  }
  return count;
}

TEST(PatchMesh, RandomNetsWithOneTwoAndFourNeighboursHaveNoCrack) {
  size_t two = 0;
  size_t four = 0;
  for (uint64_t seed = 0; seed < 24; ++seed) {
    const PatchSet set = test::make_net({.side = 3, .seed = seed});
    two += count_kind(set, EdgeBind::kTwo);
    four += count_kind(set, EdgeBind::kFour);
    const double tolerance = seed % 3 == 0 ? 0.05 : seed % 3 == 1 ? 0.3 : 5;
    const PatchMesh mesh = cut(set, tolerance);
    EXPECT_GT(test::expect_watertight(set, mesh), 0u);
    if (HasFailure()) FAIL() << "seed " << seed << ", tolerance " << tolerance;
  }
  EXPECT_GT(two, 50u);
  EXPECT_GT(four, 10u);
}

// Some patches are cut in pieces and some as a whole, independently of their neighbours.
TEST(PatchMesh, PiecesMeetPatchesThatAreWholeAndPiecesOfOthersWithoutACrack) {
  size_t met[2][2][3] = {};  // pieces here, pieces there; one, two or four neighbours
  for (uint64_t seed = 0; seed < 16; ++seed) {
    PatchSet set =
        test::make_net({.side = 3, .cell = 8, .relief = 0.3, .sideways = 0.2, .seed = seed});
    for (uint32_t p = 0; p < set.size(); ++p) {
      // Bent inside, with the same borders.
      if (random_unit(seed, 1, p) < 0.5) continue;
      for (const size_t k : {5u, 6u, 9u, 10u}) {
        set.patches[p].points[k].y += 12 * random_unit(seed, 2 + k, p) - 6;
      }
    }
    const double tolerance = seed % 2 == 0 ? 0.01 : 0.03;
    const PatchMesh mesh = cut(set, tolerance);
    EXPECT_GT(test::expect_watertight(set, mesh), 0u);
    const auto in_pieces = [&](uint32_t p) { return mesh.first[p + 1] - mesh.first[p] > 512; };
    for (uint32_t p = 0; p < set.size(); ++p) {
      EXPECT_LE(test::worst_distance(set, mesh, p, 12), tolerance);
      for (const PatchEdge& edge : set.edges[p]) {
        const size_t count = edge.bind == EdgeBind::kOne    ? 1
                             : edge.bind == EdgeBind::kTwo  ? 2
                             : edge.bind == EdgeBind::kFour ? 4
                                                            : 0;
        for (size_t k = 0; k < count; ++k) {
          ++met[in_pieces(p) ? 1 : 0][in_pieces(edge.next[k].patch) ? 1 : 0][count / 2];
        }
      }
    }
    if (HasFailure()) FAIL() << "seed " << seed;
  }
  for (const auto& here : met) {
    for (const auto& there : here) {
      for (const size_t times : there) EXPECT_GT(times, 2u);
    }
  }
}

TEST(PatchMesh, AClosedNetHasNoOpenEdgeAtAll) {
  for (uint64_t seed = 0; seed < 12; ++seed) {
    const PatchSet set = test::make_net({.side = 4, .relief = 2, .closed = true, .seed = seed});
    const PatchMesh mesh = cut(set, seed % 2 == 0 ? 0.05 : 1);
    EXPECT_EQ(test::expect_watertight(set, mesh), 0u);
    // Euler: a torus has as many vertices and faces as edges.
    EXPECT_EQ(2 * mesh.positions.size(), mesh.triangles.size());
    if (HasFailure()) FAIL() << "seed " << seed;
  }
}

TEST(PatchMesh, NeighboursWhoseCurvesDifferALittleStillShareTheirVertices) {
  for (uint64_t seed = 0; seed < 8; ++seed) {
    const PatchSet set = test::make_net({.side = 3, .jitter = 0.09, .closed = true, .seed = seed});
    EXPECT_EQ(test::expect_watertight(set, cut(set, 0.2)), 0u);
    if (HasFailure()) FAIL() << "seed " << seed;
  }
}

TEST(PatchMesh, TrianglesStayWithinTheToleranceOfTheirPatch) {
  double worst = 0;
  for (const double tolerance : {0.005, 0.02, 0.3}) {
    const PatchSet set = test::make_net({.side = 2, .cell = 8, .relief = 3, .seed = 4});
    const PatchMesh mesh = cut(set, tolerance);
    for (uint32_t p = 0; p < set.size(); ++p) {
      const double distance = test::worst_distance(set, mesh, p, 40);
      EXPECT_LE(distance, tolerance);
      worst = std::fmax(worst, distance / tolerance);
    }
  }
  EXPECT_GT(worst, 0.2);  // Not simply the finest cut.
}

// The nearest point of a part, searched on ever finer grids around the nearest so far.
double distance_to_part(const BezierPatch& patch, const PatchPart& part, Vec3d at) {
  constexpr int kSteps = 8;
  const double s0 = part.s0 / 256.0, s1 = (part.s1 + 1) / 256.0;
  const double t0 = part.t0 / 256.0, t1 = (part.t1 + 1) / 256.0;
  double nearest = 1e9, best_s = (s0 + s1) / 2, best_t = (t0 + t1) / 2;
  for (double reach = 0.5; reach > 1e-9; reach /= 2) {
    const double around_s = best_s, around_t = best_t;
    for (int i = -kSteps; i <= kSteps; ++i) {
      for (int j = -kSteps; j <= kSteps; ++j) {
        const double s = std::clamp(around_s + reach * (s1 - s0) * i / kSteps, s0, s1);
        const double t = std::clamp(around_t + reach * (t1 - t0) * j / kSteps, t0, t1);
        const double far = length(patch.at(s, t) - at);
        if (far >= nearest) continue;
        nearest = far;
        best_s = s;
        best_t = t;
      }
    }
  }
  return nearest;
}

// Every corner of a triangle is a point of the surface within its part, off it by the reported
// distance.
TEST(PatchMesh, EveryTriangleNamesItsPartOfThePatch) {
  size_t rings = 0;
  double largest = 0;
  for (const double jitter : {0.0, 0.05}) {
    const PatchSet set = test::make_net({.side = 3, .jitter = jitter, .seed = 6});
    const PatchMesh mesh = cut(set, 0.02);
    ASSERT_EQ(mesh.parts.size(), mesh.triangles.size());
    ASSERT_EQ(mesh.off.size(), set.size());
    for (uint32_t p = 0; p < set.size(); ++p) {
      largest = std::fmax(largest, mesh.off[p]);
      for (uint32_t t = mesh.first[p]; t < mesh.first[p + 1]; t += 5) {
        const PatchPart& part = mesh.parts[t];
        ASSERT_LE(part.s0, part.s1);
        ASSERT_LE(part.t0, part.t1);
        for (const uint32_t corner : mesh.triangles[t]) {
          EXPECT_LE(distance_to_part(set.patches[p], part, mesh.positions[corner]),
                    mesh.off[p] + 1e-9);
        }
        if (HasFailure()) FAIL() << "patch " << p << ", triangle " << t;
        rings += part.s1 - part.s0 != mesh.parts[mesh.first[p]].s1 - mesh.parts[mesh.first[p]].s0;
      }
    }
  }
  EXPECT_GT(rings, 10u);
  EXPECT_GT(largest, 0.01);  // The neighbours' curves.
}

// Bent by its corners alone: all of its deviation comes from the mixed derivative.
TEST(PatchMesh, ATwistedPatchIsCutByItsTwist) {
  PatchSet set;
  BezierPatch patch;
  for (size_t i = 0; i < 16; ++i) {
    const double x = static_cast<double>(i % 4) * 3;
    const double z = static_cast<double>(i / 4) * 3;
    patch.points[i] = {x, x * z / 9, z};
  }
  set.add(patch);
  for (const double tolerance : {0.02, 0.3}) {
    const double distance = test::worst_distance(set, cut(set, tolerance), 0, 2000);
    EXPECT_LE(distance, tolerance);
    EXPECT_GT(distance, tolerance / 5);
  }
}

// Patches that roll up, fold and slide within themselves, at steps as coarse as a tolerance allows.
TEST(PatchMesh, WildPatchesStayWithinACoarseTolerance) {
  double worst = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    PatchSet set;
    BezierPatch patch;
    const double wild = 1 + 8 * random_unit(seed, 1, 0);
    for (uint64_t i = 0; i < 16; ++i) {
      patch.points[i] = {static_cast<double>(i % 4) * 3 + wild * random_unit(seed, 2, i),
                         wild * random_unit(seed, 3, i),
                         static_cast<double>(i / 4) * 3 + wild * random_unit(seed, 4, i)};
    }
    set.add(patch);
    const double tolerance = seed % 2 == 0 ? 0.3 : 1.5;
    worst = std::fmax(worst, test::worst_distance(set, cut(set, tolerance), 0, 60) / tolerance);
  }
  EXPECT_LE(worst, 1);
  EXPECT_GT(worst, 0.3);
}

TEST(PatchMesh, TrianglesShowTheirFaceWhereTheNormalPointsTo) {
  const PatchSet set = test::make_net({.side = 3, .relief = 3, .seed = 9});
  const PatchMesh mesh = cut(set, 0.05);
  for (uint32_t p = 0; p < set.size(); ++p) {
    Vec3d sum;
    for (uint32_t t = mesh.first[p]; t < mesh.first[p + 1]; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      sum =
          sum + cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    }
    EXPECT_GT(dot(sum, set.patches[p].normal(0.5, 0.5)), 0);
  }
}

TEST(PatchMesh, AFlatPatchIsTwoTriangles) {
  const PatchSet set = test::make_net({.side = 1, .relief = 0, .sideways = 0, .split_some = false});
  PatchSet flat = set;
  for (Vec3d& p : flat.patches[0].points) p.y = 0;
  const double third = 16.0 / 3;
  for (size_t i = 0; i < 16; ++i) {
    flat.patches[0].points[i] = {third * static_cast<double>(i % 4), 0,
                                 third * static_cast<double>(i / 4)};
  }
  EXPECT_EQ(cut(flat, 0.02).triangles.size(), 2u);
}

TEST(PatchMesh, VerticesLieOnWholeMillimetres) {
  for (const Vec3d& p : cut(test::make_net({}), 0.1).positions) {
    for (const double c : {p.x, p.y, p.z}) {
      EXPECT_EQ(c, std::floor(c * 1000 + 0.5) / 1000);
    }
  }
}

// A dome: four sides around a tip that is an edge of each, on an open ring.
TEST(PatchMesh, ACollapsedEdgeIsOneVertex) {
  PatchSet set;
  const double k = 0.5522847498;
  for (int32_t q = 0; q < 4; ++q) {
    BezierPatch patch;
    for (size_t j = 0; j < 4; ++j) {
      const std::array<std::array<double, 2>, 4> arc{{{1, 0}, {1, k}, {k, 1}, {0, 1}}};
      const double x = arc[j][0];
      const double z = arc[j][1];
      const std::array<std::array<double, 2>, 4> meridian{{{5, 0}, {5, 3}, {3, 5}, {0, 5}}};
      for (size_t i = 0; i < 4; ++i) {
        Vec3d p{meridian[i][0] * x, meridian[i][1], -meridian[i][0] * z};
        for (int32_t r = 0; r < q; ++r) p = {p.z, p.y, -p.x};  // A quarter turn.
        patch.points[4 * j + i] = {p.x + 0.0, p.y, p.z + 0.0};
      }
    }
    set.add(patch);
  }
  for (uint32_t q = 0; q < 4; ++q) set.bind({q, 1}, {(q + 1) % 4, 3});
  const PatchMesh mesh = cut(set, 0.02);
  const size_t open = test::expect_watertight(set, mesh);
  EXPECT_GT(open, 8u);
  // Euler for a disc: V - E + F = 1, with 3 F = 2 E - open.
  EXPECT_EQ(2 * mesh.positions.size(), mesh.triangles.size() + open + 2);
}

// One patch bent to a ring, its own neighbour.
TEST(PatchMesh, APatchMayBeItsOwnNeighbour) {
  PatchSet set;
  BezierPatch patch;
  const std::array<std::array<double, 2>, 4> loop{{{0, -3}, {9, 3}, {-9, 3}, {0, -3}}};
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 4; ++i) {
      patch.points[4 * j + i] = {loop[j][0], static_cast<double>(i), loop[j][1]};
    }
  }
  set.add(patch);
  set.bind({0, 1}, {0, 3});
  for (const double tolerance : {0.01, 100.0}) {
    const PatchMesh mesh = cut(set, tolerance);
    const size_t open = test::expect_watertight(set, mesh);
    EXPECT_GE(open, 8u);
    EXPECT_EQ(2 * mesh.positions.size(), mesh.triangles.size() + open);  // A ring: V - E + F = 0.
  }
}

TEST(PatchMesh, SameBytesForAnyNumberOfWorkers) {
  const PatchSet set = test::make_net({.side = 12, .jitter = 0.02, .seed = 7});
  for (const int32_t workers : {1, 2, 3, 8, 0}) {
    EXPECT_EQ(hash_of(cut(set, 0.02, workers)), 0x256eae7009bf5edf) << "workers = " << workers;
  }
}

TEST(PatchMesh, WhatCannotBeCutIsRefusedWithASentence) {
  const PatchSet set = test::make_net({});
  Context context;
  for (const TessellationConfig& config :
       {TessellationConfig{.tolerance = 0}, TessellationConfig{.tolerance = NAN},
        TessellationConfig{.workers = -1}}) {
    const auto mesh = tessellate_patches(set, config, context);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, Errc::kBadConfig);
  }
  const auto many = tessellate_patches(set, {.tolerance = 0.001, .max_triangles = 1000}, context);
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().code, Errc::kLimit);
  EXPECT_NE(many.error().message.find("give more than 1000 triangles at a tolerance of 0.001 m"),
            std::string::npos);
  PatchSet wrong = set;
  wrong.patches[0].points[0].x = INFINITY;
  const auto bad = tessellate_patches(wrong, {}, context);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().code, Errc::kBadInput);
  context.cancel = true;
  const auto stopped = tessellate_patches(set, {}, context);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, Errc::kCancelled);
}

}  // namespace
}  // namespace throng
