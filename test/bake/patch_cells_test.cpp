// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/patch_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "baked.h"
#include "core/random.h"
#include "graph/node_bins.h"
#include "patch_nets.h"
#include "verify/turned_body.h"

namespace throng {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// A cell's surface, cut out of its patch as PatchJudge cuts it.
BezierPatch cell_of(const BezierPatch& patch, int32_t depth, int32_t s, int32_t t) {
  BezierPatch part = patch;
  for (int32_t bit = depth - 1; bit >= 0; --bit) {
    part = split_s(part, 0.5)[static_cast<size_t>(s >> bit & 1)];
    part = split_t(part, 0.5)[static_cast<size_t>(t >> bit & 1)];
  }
  return part;
}

// Every cell by itself against every triangle of the scene.
class Naive {
 public:
  Naive(const Scene& scene, std::span<const AvatarClass> classes, const NodeBins& bins)
      : scene_(scene), classes_(classes), bins_(bins) {}

  // Heights as promised, and the classes that no triangle stops, whatever the inclination.
  graph::Promise judge(const bake::SurfaceBound& along, const bake::SurfaceBound& upright) const {
    graph::Promise promise;
    for (const bake::PatchBody& body : bake::patch_bodies(classes_)) {
      const bake::SurfaceBound& surface = body.climbs ? along : upright;
      if (entry(surface.frame, bake::sweep_of(surface, body)) == kNever)
        promise.classes |= body.bit;
    }
    promise.height = height(along);
    promise.headroom = height(upright);
    return promise;
  }

  // Patches but `beside` that come into the surface.
  void add_makers(const bake::SurfaceBound& along, const std::set<uint32_t>& beside,
                  std::set<uint32_t>& makers) const {
    const bake::BodySweep sweep{along.radius, along.low, along.high};
    for (size_t t = 0; t < scene_.triangles.size(); ++t) {
      const uint32_t patch = scene_.patch_of_triangle[t];
      if (patch == kNoPatch || beside.contains(patch)) continue;
      if (bake::lowest_entry(local(along.frame, t), sweep) < kNever) makers.insert(patch);
    }
  }

 private:
  bake::LocalTriangle local(const bake::BodyFrame& frame, size_t triangle) const {
    bake::LocalTriangle corners;
    for (size_t i = 0; i < 3; ++i) {
      corners[i] = frame.local(scene_.positions[scene_.triangles[triangle][i]]);
    }
    return corners;
  }

  double entry(const bake::BodyFrame& frame, const bake::BodySweep& sweep) const {
    double lowest = kNever;
    for (size_t t = 0; t < scene_.triangles.size(); ++t) {
      lowest = std::min(lowest, bake::lowest_entry(local(frame, t), sweep));
    }
    return lowest;
  }

  uint8_t height(const bake::SurfaceBound& surface) const {
    const double tallest = bins_.height.back();
    double bottom = 0;
    for (const bake::PatchBody& body : bake::patch_bodies(classes_))
      bottom = std::max(bottom, body.bottom);
    const double free =
        entry(surface.frame, {surface.radius + tallest * surface.sine,
                              surface.low + bottom * surface.cosine, surface.high + tallest});
    return bins_.height_code(std::max(0.0, free - surface.high));
  }

  const Scene& scene_;
  std::span<const AvatarClass> classes_;
  const NodeBins& bins_;
};

// The patch, its neighbours and theirs.
std::set<uint32_t> beside(const PatchSet& set, uint32_t patch) {
  std::set<uint32_t> all{patch};
  for (int ring = 0; ring < 2; ++ring) {
    for (const uint32_t p : std::set<uint32_t>(all)) {
      for (const PatchEdge& edge : set.edges[p]) {
        for (const PatchSide& side : edge.next) {
          if (side.patch != kNoPatch) all.insert(side.patch);
        }
      }
    }
  }
  return all;
}

std::vector<AvatarClass> four_classes() {
  std::vector<AvatarClass> classes{
      {.name = "adult"},
      {.name = "giant", .height = 3, .radius = 0.5, .step_height = 0.8},
      {.name = "climber"},
      {.name = "gecko", .height = 0.5, .radius = 0.2, .step_height = 0.25}};
  classes[2].climb_slope = 120;
  classes[3].climb_slope = 180;
  return classes;
}

// Where it is unknown which part of its patch a triangle covers, the patch's own are like all
// others.
TEST(PatchCells, PromiseWhatATestOfEveryTriangleOfTheSceneFinds) {
  const std::vector<AvatarClass> classes = four_classes();
  const NodeBins bins = graph::make_bins(classes);
  size_t stopped = 0, stands = 0, low = 0, made = 0;
  for (const bool rocks : {false, true}) {
    Scene scene = rocks ? test::builtin({.name = "landscape", .size = 64})
                        : test::net_scene({.side = 3, .cell = 8, .relief = 5});
    scene.patch_part.clear();
    scene.patch_off.clear();
    ASSERT_GT(scene.patches.size(), 0u);
    const bake::TriangleSquares triangles(scene, 1);
    const Naive naive(scene, classes, bins);
    bake::PatchJudge judge(triangles, classes, bins, 1.5);
    // The landscape's rocks come last: few cells each, and all pierce the ground.
    for (uint32_t p = rocks ? 22 : 0; p < scene.patches.size(); p += 2) {
      const bake::BezierCells cells = judge.judge(p);
      const auto around = beside(scene.patches, p);
      std::set<uint32_t> makers;
      for (int32_t t = 0; t < cells.promise.side(); ++t) {
        for (int32_t s = 0; s < cells.promise.side(); ++s) {
          const BezierPatch part = cell_of(scene.patches.patches[p], cells.promise.depth, s, t);
          const graph::Promise& found = cells.promise.cells[cells.promise.index(s, t)];
          const auto along = bake::bound_surface(part);
          if (!along) {
            EXPECT_EQ(found.classes, 0);
            continue;
          }
          naive.add_makers(*along, around, makers);
          if ((s + t + static_cast<int32_t>(p)) % 3 != 0) continue;  // The rest takes long.
          const bake::SurfaceBound upright = bake::upright_bound(part, *along);
          const graph::Promise expected = naive.judge(*along, upright);
          EXPECT_EQ(found.height, expected.height);
          const double steepest =
              std::max(along->steepest_cosine(), bake::steepest_cosine(part, *along));
          double walked = 1;
          for (const bake::PatchBody& body : bake::patch_bodies(classes)) {
            if (!body.climbs) walked = std::min(walked, body.steepest);
          }
          const bool leans = along->frame.up.y <= along->sine || steepest < walked;
          EXPECT_EQ(found.headroom, leans ? 0 : expected.headroom);
          uint16_t allowed = 0;  // by inclination
          for (const bake::PatchBody& body : bake::patch_bodies(classes)) {
            if (steepest >= body.steepest && (body.climbs || !leans)) allowed |= body.bit;
          }
          EXPECT_EQ(found.classes, expected.classes & allowed);
          stands += found.classes != 0;
          stopped += (allowed & ~found.classes) != 0;
          low += found.height < bins.height.size();
        }
      }
      EXPECT_EQ(std::vector<uint32_t>(makers.begin(), makers.end()), cells.makers) << p;
      made += makers.size();
    }
  }
  EXPECT_GT(stands, 100u);
  EXPECT_GT(stopped, 20u);
  EXPECT_GT(low, 20u);
  EXPECT_GT(made, 4u);
}

// Where the patch's own triangles are spared, cells only promise more, and still no body anywhere
// on them meets any triangle of the scene.
TEST(PatchCells, NoBodyMeetsTheGroundThatItWasNotTestedAgainst) {
  const std::vector<AvatarClass> classes = four_classes();
  const std::vector<bake::PatchBody> bodies = bake::patch_bodies(classes);
  const NodeBins bins = graph::make_bins(classes);
  size_t posed = 0, more = 0, entered = 0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    const bool rocks = seed > 6;
    const Scene scene = rocks ? test::builtin({.name = "landscape", .size = 64, .seed = seed})
                              : test::net_scene({.side = 3,
                                                 .cell = 10,
                                                 .relief = static_cast<double>(seed),
                                                 .jitter = seed % 2 == 0 ? 0.02 : 0,
                                                 .seed = seed});
    Scene blind = scene;
    blind.patch_part.clear();
    blind.patch_off.clear();
    const bake::TriangleSquares triangles(scene, 1), without(blind, 1);
    const verify::TriangleTree tree(scene, 1);
    bake::PatchJudge judge(triangles, classes, bins, 1), strict(without, classes, bins, 1);
    for (uint32_t p = 0; p < scene.patches.size(); ++p) {
      const bake::BezierCells cells = judge.judge(p), least = strict.judge(p);
      EXPECT_EQ(cells.makers, least.makers);
      const double side = cells.promise.side();
      for (size_t i = 0; i < cells.promise.cells.size(); ++i) {
        const graph::Promise& found = cells.promise.cells[i];
        const graph::Promise& expected = least.promise.cells[i];
        ASSERT_EQ(found.classes & expected.classes, expected.classes);
        ASSERT_EQ(found.inclination, expected.inclination);
        ASSERT_GE(found.height, expected.height);
        ASSERT_GE(found.headroom, expected.headroom);
        more += found.classes != expected.classes;
        for (size_t b = 0; b < bodies.size(); ++b) {
          if ((found.classes & ~expected.classes & bodies[b].bit) == 0) continue;
          const auto at = [&](uint64_t k) { return random_unit(seed, p * 64 + b, 2 * i + k); };
          const auto row = static_cast<size_t>(cells.promise.side());
          const double s = static_cast<double>(i % row) + at(0);
          const double t = static_cast<double>(i / row) + at(1);
          const BezierPatch& patch = scene.patches.patches[p];
          const verify::Pose pose{
              patch.at(s / side, t / side),
              bodies[b].climbs ? patch.normal(s / side, t / side) : Vec3d{0, 1, 0}};
          ++posed;
          entered += verify::turned_intruder(tree, classes[b], pose).has_value();
        }
      }
    }
  }
  EXPECT_EQ(entered, 0u);
  EXPECT_GT(posed, 5000u);
  EXPECT_GT(more, 5000u);
}

// The same triangles in another order, among which others are found with those near a cell.
Scene shuffled(const Scene& scene) {
  Scene out = scene;
  for (size_t t = scene.triangles.size() - 1; t > 0; --t) {
    const auto other = static_cast<size_t>(random_unit(5, t, 0) * static_cast<double>(t + 1));
    std::swap(out.triangles[t], out.triangles[other]);
    std::swap(out.area[t], out.area[other]);
    std::swap(out.patch_of_triangle[t], out.patch_of_triangle[other]);
    std::swap(out.patch_part[t], out.patch_part[other]);
  }
  return out;
}

TEST(PatchCells, DoNotDependOnTheOrderOfTriangles) {
  const std::vector<AvatarClass> classes = four_classes();
  const NodeBins bins = graph::make_bins(classes);
  // Patches so large that bodies on a part of one come near to a part of its triangles only.
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const Scene scene = test::net_scene(
        {.side = 3, .cell = 64, .relief = 3.0 * static_cast<double>(seed), .seed = seed});
    const Scene other = shuffled(scene);
    const bake::TriangleSquares triangles(scene, 1), others(other, 1);
    bake::PatchJudge judge(triangles, classes, bins, 1), again(others, classes, bins, 1);
    for (uint32_t p = 0; p < scene.patches.size(); p += 3) {
      const bake::BezierCells a = judge.judge(p), b = again.judge(p);
      EXPECT_TRUE(a.promise.cells == b.promise.cells) << seed << " " << p;
      EXPECT_EQ(a.makers, b.makers);
    }
  }
}

// Bodies begin above their feet, but makers are whatever comes into the surface.
TEST(PatchCells, APatchInTheSurfaceIsAMakerThoughItLiesBelowAllBodies) {
  PatchSet set;
  set.begin_run("", "", "");
  for (const double size : {1.0, 0.25}) {
    BezierPatch patch;
    for (size_t k = 0; k < 16; ++k) {
      patch.points[k] = {size * static_cast<double>(k % 4), 0, size * static_cast<double>(k / 4)};
    }
    set.add(patch);
  }
  const Scene scene = test::patch_scene(set);
  const std::vector<AvatarClass> classes{{.name = "adult"}};
  const NodeBins bins = graph::make_bins(classes);
  const bake::TriangleSquares triangles(scene, 1);
  bake::PatchJudge judge(triangles, classes, bins, 1);
  EXPECT_EQ(judge.judge(0).makers, std::vector<uint32_t>{1});
  EXPECT_EQ(judge.judge(1).makers, std::vector<uint32_t>{0});
}

}  // namespace
}  // namespace throng
