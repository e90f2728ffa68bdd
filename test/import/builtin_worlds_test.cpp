// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/hash.h"
#include "throng/bake.h"
#include "throng/papers.h"
#include "throng/scene.h"

namespace throng {
namespace {

Scene make(const BuiltinWorldConfig& config) {
  auto scene = create_builtin_world(config);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? std::move(*scene) : Scene{};
}

// Corners lie on whole millimetres, so integers describe them exactly.
uint64_t hash_of(const Scene& scene) {
  std::vector<int64_t> numbers;
  for (const Vec3d& p : scene.positions) {
    for (const double c : {p.x, p.y, p.z}) {
      numbers.push_back(static_cast<int64_t>(std::floor(c * 1000 + 0.5)));
    }
  }
  for (const auto& t : scene.triangles) numbers.insert(numbers.end(), t.begin(), t.end());
  numbers.insert(numbers.end(), scene.area.begin(), scene.area.end());
  return hash_span(std::span<const int64_t>(numbers));
}

double doubled_area(const Scene& scene, const std::array<uint32_t, 3>& t) {
  const Vec3d a = scene.positions[t[0]];
  return length(cross(scene.positions[t[1]] - a, scene.positions[t[2]] - a));
}

// What every world must satisfy as a mesh.
void expect_sound(const Scene& scene, const std::string& name) {
  ASSERT_FALSE(scene.triangles.empty()) << name;
  ASSERT_EQ(scene.area.size(), scene.triangles.size()) << name;
  for (const auto& t : scene.triangles) {
    for (const uint32_t corner : t) ASSERT_LT(corner, scene.positions.size()) << name;
    ASSERT_GT(doubled_area(scene, t), 1e-8) << name;
  }
  for (const Vec3d& p : scene.positions) {
    for (const double c : {p.x, p.y, p.z}) {
      ASSERT_NEAR(c * 1000, std::floor(c * 1000 + 0.5), 1e-6) << name << ": not a whole mm";
    }
  }
  uint32_t at = 0;
  for (const ScenePart& part : scene.parts) {
    EXPECT_EQ(part.first_triangle, at) << name;
    EXPECT_GT(part.triangle_count, 0u) << name;
    EXPECT_FALSE(part.node.empty() || part.material.empty()) << name;
    at += part.triangle_count;
  }
  EXPECT_EQ(at, scene.triangles.size()) << name;
}

TEST(BuiltinWorlds, EveryWorldIsASoundMeshAtItsDefaultAndAnotherSize) {
  const std::map<std::string, double> other = {
      {"cube", 3},        {"stairs", 100}, {"garage", 130}, {"bridge", 300},    {"church", 60},
      {"powerplant", 48}, {"city", 730},   {"maze", 71},    {"landscape", 140}, {"blocks", 200}};
  for (const BuiltinWorldInfo& info : builtin_worlds()) {
    const std::string name(info.name);
    expect_sound(make({.name = name}), name);
    expect_sound(make({.name = name, .size = other.at(name), .seed = 9}), name);
  }
}

TEST(BuiltinWorlds, SameNameSizeAndSeedGiveTheSameBytesOnEveryMachine) {
  const std::map<std::string, uint64_t> golden = {
      {"cube", 0xa0538b85755696c5},      {"stairs", 0x3970f7f303cc7892},
      {"garage", 0xa22dff081f8ea3e2},    {"bridge", 0x7cd053ff056e2b41},
      {"church", 0xdbc7e7e137d0053},     {"powerplant", 0xa304e56f53c60dad},
      {"city", 0xc77e908054dab80a},      {"maze", 0xbcea4911f4a653bb},
      {"landscape", 0x79d7c965a55df67c}, {"blocks", 0x1ac65d9c4d7878b6}};
  for (const BuiltinWorldInfo& info : builtin_worlds()) {
    const std::string name(info.name);
    const uint64_t hash = hash_of(make({.name = name}));
    EXPECT_EQ(hash, golden.at(name)) << name << " is now 0x" << std::hex << hash;
  }
}

TEST(BuiltinWorlds, AnotherSeedGivesAnotherWorldWhereAWorldIsRandom) {
  for (const std::string name :
       {"garage", "bridge", "church", "powerplant", "city", "maze", "landscape"}) {
    EXPECT_NE(hash_of(make({.name = name})), hash_of(make({.name = name, .seed = 2}))) << name;
  }
}

TEST(BuiltinWorlds, HeightsAreThoseThatTheSliceCountsOfTheLostModelsImply) {
  const auto extent = [](const std::string& name) {
    const Box3d box = make({.name = name}).bounds();
    EXPECT_EQ(box.min.y, 0) << name;
    return box.max - box.min;
  };
  EXPECT_EQ(extent("cube"), (Vec3d{5.8, 5.8, 5.8}));
  EXPECT_EQ(extent("garage"), (Vec3d{60, 10.25, 40}));
  EXPECT_EQ(extent("church").y, 17.55);
  EXPECT_EQ(extent("powerplant").y, 85.125);
}

// [ML06] table 2. Cells of 0.25 m: the counts taken do not depend on the cell.
TEST(BuiltinWorlds, TheSliceCountsOfTheSeedAreTakenAgain) {
  const std::map<std::string, int32_t> taken = {
      {"cube", 42}, {"garage", 86}, {"church", 159}, {"powerplant", 835}};
  for (const auto& [name, count] : taken) {
    Context context;
    const SliceConfig config{.avatar_height = 1.75, .resolution = 0.1, .cell = 0.25};
    const auto slices = slice_scene(make({.name = name}), config, context);
    ASSERT_TRUE(slices) << name << ": " << slices.error().message;
    EXPECT_EQ(slices->taken, count) << name;
    if (name == "cube") {
      EXPECT_EQ(slices->kept.size(), 2u);
    }
  }
}

TEST(BuiltinWorlds, SizeIsTheSideOfTheFootprint) {
  const auto side = [](const BuiltinWorldConfig& config) {
    const Box3d box = make(config).bounds();
    return box.max.x - box.min.x;
  };
  EXPECT_NEAR(side({.name = "cube", .size = 12}), 12, 1e-9);
  EXPECT_NEAR(side({.name = "garage", .size = 333}), 333, 1e-9);
  EXPECT_NEAR(side({.name = "city", .size = 333}), 333, 1e-9);
  EXPECT_NEAR(side({.name = "maze", .size = 77}), 77, 1e-9);
  EXPECT_NEAR(side({.name = "bridge", .size = 400}), 400, 1e-9);
}

// Of what is allowed, the smallest is made; the largest takes too long here.
TEST(BuiltinWorlds, LimitsAreThoseThatTheListStates) {
  const auto is_refused = [](const BuiltinWorldConfig& config) {
    const auto scene = create_builtin_world(config);
    return !scene && scene.error().code == Errc::kBadConfig;
  };
  uint64_t with_levels = 0, growing = 0;
  for (const BuiltinWorldInfo& info : builtin_worlds()) {
    const std::string name(info.name);
    EXPECT_LE(info.min_size, info.default_size) << name;
    EXPECT_LE(info.default_size, info.max_size) << name;
    EXPECT_FALSE(make({.name = name, .size = info.min_size}).triangles.empty()) << name;
    EXPECT_TRUE(is_refused({.name = name, .size = info.min_size * 0.999})) << name;
    EXPECT_TRUE(is_refused({.name = name, .size = info.max_size * 1.001})) << name;
    EXPECT_TRUE(is_refused({.name = name, .levels = info.max_levels + 1})) << name;
    EXPECT_TRUE(is_refused({.name = name, .triangles = info.max_triangles + 1})) << name;
    if (info.max_levels > 0) {
      ++with_levels;
      EXPECT_EQ(hash_of(make({.name = name, .levels = info.default_levels})),
                hash_of(make({.name = name})))
          << name;
    }
    growing += info.max_triangles > 0 ? 1 : 0;
  }
  EXPECT_EQ(with_levels, 3u);  // garage, powerplant, maze
  EXPECT_EQ(growing, 3u);      // powerplant, city, blocks
}

TEST(BuiltinWorlds, LevelsSetTheStoreys) {
  const auto top = [](const BuiltinWorldConfig& config) { return make(config).bounds().max.y; };
  EXPECT_NEAR(top({.name = "garage", .levels = 7}), 7 * 2.9 + 1.55, 1e-9);
  EXPECT_NEAR(top({.name = "maze", .levels = 5}) - top({.name = "maze", .levels = 4}), 3.06, 1e-9);
  EXPECT_NEAR(top({.name = "powerplant", .levels = 5}), 5 * 3.5 + 8.125, 1e-9);
}

TEST(BuiltinWorlds, PowerplantAndCityGrowToTheRequestedTriangles) {
  for (const uint64_t triangles : {300'000ull, 700'000ull, 1'500'000ull}) {
    const auto count =
        static_cast<double>(make({.name = "powerplant", .triangles = triangles}).triangles.size());
    EXPECT_NEAR(count / static_cast<double>(triangles), 1, 0.1) << triangles;
  }
  const auto city =
      static_cast<double>(make({.name = "city", .triangles = 600'000}).triangles.size());
  EXPECT_NEAR(city / 600'000, 1, 0.1);
}

TEST(BuiltinWorlds, CityHoldsTheSameTrianglesPerAreaAtEverySize) {
  const auto density = [](double size) {
    return static_cast<double>(make({.name = "city", .size = size}).triangles.size()) /
           (size * size);
  };
  const double one = density(1000);
  EXPECT_GT(one, 0.3);
  EXPECT_LT(one, 0.5);
  EXPECT_NEAR(density(2000) / one, 1, 0.02);
}

// A body standing on the highest surface under a ceiling: the part of each storey that is high
// enough.
TEST(BuiltinWorlds, StoreysOfTheGarageAreAlmostAllFloorWithHeadroom) {
  Context context;
  const auto slices = slice_scene(
      make({.name = "garage"}), {.avatar_height = 1.75, .resolution = 0.1, .cell = 0.25}, context);
  ASSERT_TRUE(slices);
  for (const int32_t floor : {0, 2900, 5800, 8700}) {
    double area = 0;
    const auto cells = static_cast<size_t>(slices->width) * static_cast<size_t>(slices->depth);
    for (size_t cell = 0; cell < cells; ++cell) {
      for (const Slice& slice : slices->kept) {
        if (slice.surface[cell] != floor || slice.height - floor < 1750) continue;
        area += slices->cell * slices->cell;
        break;
      }
    }
    EXPECT_GT(area, 0.6 * 60 * 40) << "floor at " << floor << " mm";
  }
}

TEST(BuiltinWorlds, NoAvatarStandsOnCarsPipesOrTrees) {
  for (const std::string name : {"garage", "powerplant", "city"}) {
    const Scene scene = make({.name = name});
    uint32_t blocked = 0;
    for (const ScenePart& part : scene.parts) {
      const bool solid = part.material == "car" || part.material == "pipe" ||
                         part.material == "crown" || part.material == "railing";
      if (!solid) continue;
      for (uint32_t t = 0; t < part.triangle_count; ++t) {
        ASSERT_EQ(scene.area[part.first_triangle + t], kAreaBlocked)
            << name << " " << part.material;
      }
      blocked += part.triangle_count;
    }
    EXPECT_GT(blocked, 1000u) << name;
  }
}

TEST(BuiltinWorlds, WhatCannotBeBuiltIsRefusedWithASentence) {
  const auto refusal = [](const BuiltinWorldConfig& config) {
    const auto scene = create_builtin_world(config);
    EXPECT_FALSE(scene);
    return scene ? Error{} : scene.error();
  };
  const Error unknown = refusal({.name = "castle"});
  EXPECT_EQ(unknown.code, Errc::kNotFound);
  EXPECT_EQ(
      unknown.message,
      "world: there is no built-in world \"castle\"; use one of cube, stairs, garage, bridge, "
      "church, powerplant, city, maze, landscape, blocks");
  EXPECT_EQ(refusal({.name = "garage", .size = 5}).message,
            "world garage: size is 5 m, use 45 to 2000");
  EXPECT_EQ(refusal({.name = "maze", .size = NAN}).code, Errc::kBadConfig);
  EXPECT_EQ(refusal({.name = "maze", .size = -1}).code, Errc::kBadConfig);
  EXPECT_EQ(refusal({.name = "city", .size = 1e9}).code, Errc::kBadConfig);
  EXPECT_EQ(refusal({.name = "garage", .levels = -1}).code, Errc::kBadConfig);
  EXPECT_EQ(refusal({.name = "garage", .levels = 41}).code, Errc::kBadConfig);
  EXPECT_EQ(refusal({.name = "cube", .levels = 2}).code, Errc::kBadConfig);
  EXPECT_EQ(refusal({.name = "cube", .triangles = 100}).code, Errc::kBadConfig);
  EXPECT_EQ(refusal({.name = "city", .size = 500, .triangles = 100000}).code, Errc::kBadConfig);
  EXPECT_EQ(refusal({.name = "powerplant", .triangles = 10}).code, Errc::kBadConfig);
  EXPECT_EQ(refusal({.name = "powerplant", .triangles = 1ull << 40}).code, Errc::kBadConfig);
}

TEST(BuiltinWorlds, BlocksHaveExactlyAsManyTrianglesAsAreAskedFor) {
  for (const uint64_t polygons : {2, 3, 13, 14, 15, 193, 194, 195, 267, 2368, 32'128}) {
    const Scene scene = make({.name = "blocks", .triangles = polygons});
    EXPECT_EQ(scene.triangles.size(), polygons);
    expect_sound(scene, "blocks");
    const Box3d box = scene.bounds();
    EXPECT_NEAR(box.max.x - box.min.x, 316, 1e-9);
    EXPECT_NEAR(box.max.z - box.min.z, 316, 1e-9);
    // The ground is covered once, however it is cut.
    double ground = 0;
    for (const ScenePart& part : scene.parts) {
      if (part.material != "road") continue;
      for (uint32_t t = 0; t < part.triangle_count; ++t) {
        ground += doubled_area(scene, scene.triangles[part.first_triangle + t]) / 2;
      }
    }
    EXPECT_NEAR(ground, 316.0 * 316, 1);
  }
  const Scene large = make({.name = "blocks", .size = 3160, .triangles = 236'800});
  EXPECT_EQ(large.triangles.size(), 236'800u);
}

TEST(BuiltinWorlds, BlocksRefuseWhatTheyCannotHold) {
  const auto fault = [](const BuiltinWorldConfig& config) {
    const auto scene = create_builtin_world(config);
    return scene ? std::string() : scene.error().message;
  };
  EXPECT_EQ(fault({.name = "blocks", .triangles = 1}),
            "world blocks: triangles is 1, use 2 to 69314 for a size of 316 m");
  EXPECT_EQ(fault({.name = "blocks", .triangles = 69'314}), "");
  EXPECT_EQ(fault({.name = "blocks", .triangles = 69'315}),
            "world blocks: triangles is 69315, use 2 to 69314 for a size of 316 m");
}

// In the streets, and there alone: no roof and no bay window holds an avatar.
TEST(BuiltinWorlds, AvatarsAmongBlocksAreInTheStreets) {
  Context context;
  const auto world = bake_world(make({.name = "blocks"}),
                                {.cell = 0.5, .classes = {AvatarClass{}}, .workers = 1}, context);
  ASSERT_TRUE(world) << world.error().message;
  const double pitch = 316.0 / 4, half = 0.35 * pitch;
  for (uint64_t n = 0; n < 1000; ++n) {
    const Vec3d at = world->random_place(0, 1, n).position;
    EXPECT_EQ(at.y, 0);
    const double x = std::fmod(at.x, pitch) - pitch / 2, z = std::fmod(at.z, pitch) - pitch / 2;
    EXPECT_GT(std::max(std::fabs(x), std::fabs(z)), half);
  }
}

}  // namespace
}  // namespace throng
