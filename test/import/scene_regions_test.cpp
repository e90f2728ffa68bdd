// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "scratch_folder.h"
#include "throng/scene.h"

// Scenes region by region against the same scenes as a whole, triangle by triangle.
namespace throng {
namespace {

// A triangle with all that a bake reads of it; patches by their numbers in the whole scene.
struct Known {
  std::array<double, 9> corners{};
  AreaKind area = 0;
  uint32_t patch = kNoPatch;
  std::array<uint8_t, 4> part{};
  friend bool operator==(const Known&, const Known&) = default;

  [[nodiscard]] bool touches(const Box3d& box) const {
    const auto x = std::minmax({corners[0], corners[3], corners[6]});
    const auto z = std::minmax({corners[2], corners[5], corners[8]});
    return x.first <= box.max.x && x.second >= box.min.x && z.first <= box.max.z &&
           z.second >= box.min.z;
  }
};

Known known(const Scene& scene, size_t t, const std::vector<uint32_t>& numbers) {
  Known out{.area = scene.area[t]};
  for (size_t k = 0; k < 3; ++k) {
    const Vec3d p = scene.positions[scene.triangles[t][k]];
    out.corners[3 * k] = p.x;
    out.corners[3 * k + 1] = p.y;
    out.corners[3 * k + 2] = p.z;
  }
  const uint32_t patch = scene.patch_of_triangle.empty() ? kNoPatch : scene.patch_of_triangle[t];
  if (patch == kNoPatch) return out;
  out.patch = numbers.empty() ? patch : numbers[patch];
  const PatchPart part = scene.patch_part[t];
  out.part = {part.s0, part.s1, part.t0, part.t1};
  return out;
}

std::vector<Known> all_known(const Scene& scene, const std::vector<uint32_t>& numbers = {}) {
  std::vector<Known> out;
  for (size_t t = 0; t < scene.triangles.size(); ++t) out.push_back(known(scene, t, numbers));
  return out;
}

void expect_patches(const SceneRegion& region, const Scene& whole) {
  const PatchSet& set = region.scene.patches;
  ASSERT_EQ(region.patch_number.size(), set.size());
  ASSERT_TRUE(std::is_sorted(region.patch_number.begin(), region.patch_number.end()));
  ASSERT_TRUE(check_patches(set));
  for (uint32_t p = 0; p < set.size(); ++p) {
    const uint32_t number = region.patch_number[p];
    EXPECT_EQ(set.patches[p].points, whole.patches.patches[number].points);
  }
  // Patches with triangles have all their neighbours, and lie as far off their triangles.
  for (const uint32_t p : region.scene.patch_of_triangle) {
    if (p == kNoPatch) continue;
    const uint32_t number = region.patch_number[p];
    ASSERT_EQ(region.scene.patch_off[p], whole.patch_off[number]);
    for (size_t e = 0; e < 4; ++e) {
      const PatchEdge &edge = set.edges[p][e], &same = whole.patches.edges[number][e];
      ASSERT_EQ(edge.bind, same.bind);
      for (size_t n = 0; n < 4; ++n) {
        ASSERT_EQ(edge.next[n].patch == kNoPatch, same.next[n].patch == kNoPatch);
        if (edge.next[n].patch == kNoPatch) continue;
        ASSERT_EQ(region.patch_number[edge.next[n].patch], same.next[n].patch);
        ASSERT_EQ(edge.next[n].edge, same.next[n].edge);
      }
    }
  }
}

// Regions of all sizes, some of which reach beyond the scene or lie beside it.
void expect_regions(const SceneRegions& regions, const Scene& whole, int count) {
  const std::vector<Known> all = all_known(whole);
  const Box3d bounds = whole.bounds();
  ASSERT_EQ(regions.facts().triangles, all.size());
  ASSERT_EQ(regions.facts().patches, whole.patches.size());
  ASSERT_EQ(regions.facts().bounds.min, bounds.min);
  ASSERT_EQ(regions.facts().bounds.max, bounds.max);
  EXPECT_EQ(regions.facts().patch_triangles,
            static_cast<uint64_t>(std::count_if(all.begin(), all.end(), [](const Known& triangle) {
              return triangle.patch != kNoPatch;
            })));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-0.2, 1.2), side(0, 0.6);
  const Vec3d size = bounds.max - bounds.min;
  for (int n = 0; n < count; ++n) {
    Box3d box{
        .min = {bounds.min.x + unit(random) * size.x, 0, bounds.min.z + unit(random) * size.z},
        .max = {}};
    const double share = side(random) * side(random);
    box.max = box.min + Vec3d{share * size.x, 0, share * size.z};
    if (n == 0) box = bounds;
    Context context;
    const auto region = regions.region(box, context);
    ASSERT_TRUE(region) << region.error().message;
    const std::vector<Known> found = all_known(region->scene, region->patch_number);
    // All of them are triangles of the scene, in its order, and none that touches is left out.
    size_t at = 0, touching = 0;
    for (const Known& triangle : all) {
      const bool is_here = at < found.size() && found[at] == triangle;
      at += is_here ? 1 : 0;
      touching += triangle.touches(box) ? 1 : 0;
      ASSERT_TRUE(is_here || !triangle.touches(box)) << "region " << n;
    }
    ASSERT_EQ(at, found.size());
    EXPECT_GE(regions.estimate(box), touching);
    expect_patches(*region, whole);
  }
  EXPECT_EQ(regions.estimate(bounds), all.size());
}

TEST(SceneRegions, OfALandscapeHaveTheTrianglesOfTheWhole) {
  test::ScratchFolder folder;
  for (const uint64_t seed : {1, 5}) {
    const BuiltinWorldConfig config{.name = "landscape", .size = 420, .seed = seed};
    const auto whole = create_builtin_world(config);
    ASSERT_TRUE(whole);
    Context context;
    const auto regions = load_scene_regions({}, {{config}}, folder.path(), context);
    ASSERT_TRUE(regions) << regions.error().message;
    expect_regions(**regions, *whole, 40);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SceneRegions, OfTrianglesAndPatchesKeepTheirOrder) {
  test::ScratchFolder folder;
  const std::array<BuiltinWorldConfig, 4> configs{{{.name = "garage"},
                                                   {.name = "landscape", .size = 160},
                                                   {.name = "church"},
                                                   {.name = "landscape", .size = 100, .seed = 2}}};
  Scene whole;
  for (const BuiltinWorldConfig& config : configs) {
    const auto world = create_builtin_world(config);
    ASSERT_TRUE(world);
    whole.append(*world);
  }
  Context context;
  const auto regions = load_scene_regions({}, configs, folder.path(), context);
  ASSERT_TRUE(regions) << regions.error().message;
  expect_regions(**regions, whole, 30);
}

// Triangles in no order, from millimetres to kilometres, more than wait in memory at a time.
TEST(SceneRegions, OfFilesHaveTheTrianglesOfLoadScene) {
  test::ScratchFolder folder;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-900, 900), exponent(-3, 3.5);
  SceneConfig config;
  for (int file = 0; file < 3; ++file) {
    std::string text;
    const int count = file == 1 ? 150'000 : 500;
    for (int t = 0; t < count; ++t) {
      const double size = t % 500 == 0 ? 1500 : std::pow(10, exponent(random));
      const Vec3d at{place(random), place(random) / 30, place(random)};
      char line[200];
      for (int k = 0; k < 3; ++k) {
        std::snprintf(line, sizeof line, "v %.3f %.3f %.3f\n", at.x + size * (k == 1),
                      at.y + size * (k == 2) / 50, at.z + size * (k == 2));
        text += line;
      }
      if (t % 100 == 0) text += "usemtl " + std::string(t % 300 == 0 ? "water" : "grass") + "\n";
      text += "f -3 -2 -1\n";
    }
    const std::string name = "soup" + std::to_string(file) + ".obj";
    config.sources.push_back(
        {.path = folder.write(name, text), .up = {}, .scale = {}, .transform = {}});
  }
  config.sources[2].up = 'z';
  config.sources[2].transform.m[0][3] = 40;
  config.rules.push_back({.material = "water", .node = "", .kind = kAreaBlocked});
  Context context;
  const auto whole = load_scene(config, context);
  ASSERT_TRUE(whole) << whole.error().message;
  const auto regions = load_scene_regions(config, {}, folder.path(), context);
  ASSERT_TRUE(regions) << regions.error().message;
  expect_regions(**regions, *whole, 25);
}

// Each block of a bake reads what is near it, however long the triangles are.
TEST(SceneRegions, OfLongTrianglesAreFoundWithoutReadingAll) {
  test::ScratchFolder folder;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> place(0, 20'000), length(70, 200);
  std::string text;
  constexpr uint64_t kTriangles = 20'000;
  for (uint64_t t = 0; t < kTriangles; ++t) {
    const double x = place(random), z = place(random), size = length(random);
    char lines[200];
    std::snprintf(lines, sizeof lines, "v %.3f 0 %.3f\nv %.3f 0 %.3f\nv %.3f 1 %.3f\nf -3 -2 -1\n",
                  x, z, x + size, z, x, z + size);
    text += lines;
  }
  SceneConfig config;
  config.sources.push_back(
      {.path = folder.write("long.obj", text), .up = {}, .scale = {}, .transform = {}});
  Context context;
  const auto regions = load_scene_regions(config, {}, folder.path(), context);
  ASSERT_TRUE(regions) << regions.error().message;
  for (const double at : {0.0, 9'000.0, 19'000.0}) {
    const Box3d box{.min = {at, 0, at}, .max = {at + 256, 0, at + 256}};
    EXPECT_LT((*regions)->estimate(box), kTriangles / 100);
    const auto region = (*regions)->region(box, context);
    ASSERT_TRUE(region) << region.error().message;
    EXPECT_GT(region->scene.triangles.size(), 0u);
  }
}

TEST(SharedWorlds, RegionsOfARealLandscapeHaveTheTrianglesOfTheWhole) {
  const std::string path = std::string(THRONG_SHARED_WORLDS) + "/nel";
  if (!std::filesystem::is_directory(path)) GTEST_SKIP() << "no shared worlds here";
  test::ScratchFolder folder;
  SceneConfig config;
  config.sources.push_back({.path = path, .up = {}, .scale = {}, .transform = {}});
  Context context;
  const auto whole = load_scene(config, context);
  ASSERT_TRUE(whole) << whole.error().message;
  const auto regions = load_scene_regions(config, {}, folder.path(), context);
  ASSERT_TRUE(regions) << regions.error().message;
  expect_regions(**regions, *whole, 25);
}

// One of several files may have nothing that can be used, as in a scene in memory.
TEST(SceneRegions, OfFilesOfWhichSomeAreEmptyHaveTheRest) {
  test::ScratchFolder folder;
  SceneConfig config;
  for (const auto& [name, text] :
       {std::pair{"floor.obj", "v 0 0 0\nv 9 0 0\nv 0 0 9\nf 1 2 3\n"},
        {"empty.obj", ""},
        {"nan.obj", "v nan 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n"},
        {"glass.obj", "usemtl glass\nv 0 1 0\nv 9 1 0\nv 0 1 9\nf 1 2 3\n"}}) {
    config.sources.push_back(
        {.path = folder.write(name, text), .up = {}, .scale = {}, .transform = {}});
  }
  config.rules.push_back({.material = "glass", .node = "", .kind = kAreaIgnored});
  Context context;
  const auto whole = load_scene(config, context);
  ASSERT_TRUE(whole) << whole.error().message;
  const auto regions = load_scene_regions(config, {}, folder.path(), context);
  ASSERT_TRUE(regions) << regions.error().message;
  expect_regions(**regions, *whole, 10);
  EXPECT_EQ((*regions)->facts().report.non_finite, 1u);
  EXPECT_EQ((*regions)->facts().report.ignored, 1u);
  config.sources.erase(config.sources.begin());
  const auto none = load_scene_regions(config, {}, folder.path(), context);
  const auto none_whole = load_scene(config, context);
  ASSERT_FALSE(none || none_whole);
  EXPECT_EQ(none.error().message, none_whole.error().message);
}

TEST(SceneRegions, RefuseWhatTheyCannotKeep) {
  test::ScratchFolder folder;
  Context context;
  SceneConfig volumes;
  volumes.volumes.emplace_back();
  SceneConfig materials;
  materials.materials = SceneMaterials::kRead;
  SceneConfig missing;
  missing.sources.push_back(
      {.path = folder.path() + "/none.obj", .up = {}, .scale = {}, .transform = {}});
  const std::array<BuiltinWorldConfig, 1> cube{{{.name = "cube"}}};
  const std::array<BuiltinWorldConfig, 1> unknown{{{.name = "atlantis"}}};
  EXPECT_EQ(load_scene_regions(volumes, cube, folder.path(), context).error().code,
            Errc::kBadConfig);
  EXPECT_EQ(load_scene_regions(materials, cube, folder.path(), context).error().code,
            Errc::kBadConfig);
  EXPECT_FALSE(load_scene_regions(missing, {}, folder.path(), context));
  EXPECT_FALSE(load_scene_regions({}, {}, folder.path(), context));
  EXPECT_EQ(load_scene_regions({}, unknown, folder.path(), context).error().code, Errc::kNotFound);
  const std::string file = folder.write("file", "");
  EXPECT_EQ(load_scene_regions({}, cube, file, context).error().code, Errc::kIo);
}

}  // namespace
}  // namespace throng
