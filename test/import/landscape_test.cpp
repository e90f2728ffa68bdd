// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "patch_nets.h"
#include "scratch_folder.h"
#include "throng/scene.h"

// What the built-in landscape guarantees beyond what every world does.
namespace throng {
namespace {

Scene make(double size, uint64_t seed) {
  auto scene = create_builtin_world({.name = "landscape", .size = size, .seed = seed});
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? *std::move(scene) : Scene{};
}

struct Component {
  std::vector<uint32_t> patches;
  Box3d box;
  std::string node;
};

std::vector<Component> components_of(const PatchSet& set) {
  const auto number = patch_components(set);
  std::vector<Component> components;
  for (const PatchRun& run : set.runs) {
    for (uint32_t p = run.first_patch; p < run.first_patch + run.patch_count; ++p) {
      if (number[p] == components.size()) components.emplace_back();
      Component& component = components[number[p]];
      component.patches.push_back(p);
      component.node = run.node;
      for (const Vec3d& point : set.patches[p].points) component.box.add(point);
    }
  }
  return components;
}

size_t count_open(const PatchSet& set, const Component& component) {
  size_t open = 0;
  for (const uint32_t p : component.patches) {
    for (const PatchEdge& edge : set.edges[p]) open += edge.bind == EdgeBind::kOpen ? 1 : 0;
  }
  return open;
}

TEST(Landscape, EverySizeAndSeedHasNeighboursOfAllKindsAndNoCrack) {
  for (const double size : {64.0, 150.0, 400.0}) {
    for (const uint64_t seed : {1, 2, 3}) {
      const PatchSet set = make(size, seed).patches;
      const auto checked = check_patches(set);
      ASSERT_TRUE(checked) << checked.error().message;
      std::map<EdgeBind, size_t> kinds;
      for (const auto& four : set.edges) {
        for (const PatchEdge& edge : four) ++kinds[edge.bind];
      }
      for (const EdgeBind kind :
           {EdgeBind::kOpen, EdgeBind::kOne, EdgeBind::kTwo, EdgeBind::kFour, EdgeBind::kPart}) {
        EXPECT_GT(kinds[kind], 0u) << size << " m, seed " << seed;
      }
      EXPECT_EQ(kinds[EdgeBind::kPart], 2 * kinds[EdgeBind::kTwo] + 4 * kinds[EdgeBind::kFour]);
      Context context;
      const auto mesh = tessellate_patches(set, {.tolerance = 0.5}, context);
      ASSERT_TRUE(mesh) << mesh.error().message;
      EXPECT_GT(test::expect_watertight(set, *mesh), 0u);
    }
  }
}

TEST(Landscape, RocksAreClosedAndSunkAndArchesStandOnBothFeet) {
  const Scene scene = make(300, 5);
  const PatchSet& set = scene.patches;
  const auto components = components_of(set);
  EXPECT_EQ(components[0].node, "ground");
  size_t rocks = 0;
  size_t arches = 0;
  size_t buried = 0;
  for (size_t c = 1; c < components.size(); ++c) {
    const Component& component = components[c];
    const Vec3d middle = (component.box.min + component.box.max) * 0.5;
    if (component.node == "rocks") {
      ++rocks;
      EXPECT_EQ(component.patches.size(), 6u);
      EXPECT_EQ(count_open(set, component), 0u);
      for (const uint32_t p : component.patches) {
        EXPECT_GT(dot(set.patches[p].normal(0.5, 0.5), set.patches[p].at(0.5, 0.5) - middle), 0);
      }
    } else {
      ++arches;
      EXPECT_EQ(component.node, "arches");
      EXPECT_EQ(component.patches.size(), 20u);
      EXPECT_EQ(count_open(set, component), 8u);  // The feet, below the ground.
    }
    // The ground passes between the highest and the lowest of it.
    double nearest = INFINITY;
    double height = 0;
    for (const uint32_t p : components[0].patches) {
      for (const double s : {0.25, 0.5, 0.75}) {
        for (const double t : {0.25, 0.5, 0.75}) {
          const Vec3d q = set.patches[p].at(s, t);
          const double away = std::hypot(q.x - middle.x, q.z - middle.z);
          if (away < nearest) {
            nearest = away;
            height = q.y;
          }
        }
      }
    }
    EXPECT_LT(component.box.min.y, height);
    buried += component.box.max.y < height ? 1 : 0;
  }
  EXPECT_LE(buried, (rocks + arches) / 20);  // The smaller one of two on a slope may be.
  EXPECT_GT(rocks, 20u);
  EXPECT_GE(arches, 2u);
}

TEST(Landscape, TheGroundHasFlatsSteepsAndOverhangs) {
  const PatchSet set = make(600, 1).patches;
  size_t flat = 0;
  size_t steep = 0;
  size_t overhanging = 0;
  for (uint32_t p = 0; p < set.runs[0].patch_count; ++p) {
    for (const double s : {0.1, 0.5, 0.9}) {
      for (const double t : {0.1, 0.5, 0.9}) {
        const double up = set.patches[p].normal(s, t).y;
        flat += up > 0.9 ? 1 : 0;
        steep += up < 0.6 && up > 0 ? 1 : 0;
        overhanging += up < -0.1 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(flat, 5000u);
  EXPECT_GT(steep, 800u);
  EXPECT_GT(overhanging, 200u);
}

TEST(Landscape, ItGrowsInProportionToItsArea) {
  const auto density = [](double size) {
    return static_cast<double>(make(size, 1).patches.size()) / (size * size);
  };
  EXPECT_NEAR(density(1000) / density(500), 1, 0.1);
  for (const double size : {64.0, 333.0, 600.0}) {
    for (const uint64_t seed : {1, 2, 3}) {
      const Box3d box = make(size, seed).bounds();
      for (const double low : {box.min.x, box.min.z}) EXPECT_EQ(low, 0);
      for (const double high : {box.max.x, box.max.z}) EXPECT_EQ(high, size);
    }
  }
}

TEST(Landscape, ItsPatchFileGivesTheSameScene) {
  const test::ScratchFolder folder;
  const Scene made = make(100, 4);
  const std::string path = folder.path() + "/hills.patches.json";
  ASSERT_TRUE(write_patches(made.patches, path));
  Context context;
  SceneConfig config;
  config.sources.push_back({.path = path, .up = {}, .scale = {}, .transform = {}});
  const auto read = load_scene(config, context);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->positions, made.positions);
  EXPECT_EQ(read->triangles, made.triangles);
  EXPECT_EQ(read->area, made.area);
  EXPECT_EQ(read->patch_of_triangle, made.patch_of_triangle);
}

}  // namespace
}  // namespace throng
