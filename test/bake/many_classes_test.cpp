// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "exact_bodies.h"
#include "throng/verify.h"
#include "worlds.h"

// What others can walk on, under and over must not change what a class reaches: in a bake for six
// classes each stands where it does in one for it alone.
namespace throng {
namespace {

// Low and high, thin and wide, of small and large steps, for flat and for steep ground.
std::vector<AvatarClass> six_classes() {
  return {
      {.name = "adult"},
      {.name = "child", .height = 1.1, .radius = 0.18, .step_height = 0.3},
      {.name = "wheelchair", .height = 1.35, .radius = 0.4, .step_height = 0.02, .max_slope = 3.43},
      {.name = "giant", .height = 3.0, .radius = 0.5, .step_height = 0.8},
      {.name = "dog", .height = 0.6, .radius = 0.2, .step_height = 0.25, .max_slope = 40},
      {.name = "porter", .height = 2.1, .radius = 0.35, .step_height = 0.3, .max_slope = 20}};
}

// Places of a class: cell and feet, without the level tile they are stored in.
using Places = std::map<std::pair<int32_t, int32_t>, std::vector<int32_t>>;

Places places_of(const World& world, size_t avatar_class) {
  Places places;
  for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
    const LevelTileContent level = world.level_tile(l);
    for (int32_t c = 0; c < kTileCells * kTileCells; ++c) {
      const auto i = static_cast<size_t>(c);
      if (level.clearance[avatar_class][i] == 0) continue;
      const int32_t x = level.tile_x * kTileCells + c % kTileCells;
      places[{x, level.tile_z * kTileCells + c / kTileCells}].push_back(level.floor[i]);
    }
  }
  for (auto& [cell, feet] : places) std::sort(feet.begin(), feet.end());
  return places;
}

struct Difference {
  int64_t places = 0, unlike = 0;  // of all classes, alone
  int32_t feet = 0;                // furthest apart of a place that both have [mm]
};

// Places of `a` that have no like in `b`. Feet may be a plane's, a mm beside those of the solid.
void compare(const Places& a, const Places& b, Difference& out) {
  for (const auto& [cell, feet] : a) {
    const auto other = b.find(cell);
    for (size_t i = 0; i < feet.size(); ++i) {
      if (other == b.end() || other->second.size() != feet.size()) {
        ++out.unlike;
        continue;
      }
      const int32_t apart = std::abs(feet[i] - other->second[i]);
      out.unlike += apart > 3;
      if (apart <= 3) out.feet = std::max(out.feet, apart);
    }
  }
}

Difference six_and_alone(const Scene& scene, double cell, bool fine,
                         const std::vector<AvatarClass>& classes = six_classes()) {
  Difference out;
  const World six = test::bake(scene, cell, classes, fine);
  for (size_t c = 0; c < classes.size(); ++c) {
    const Places alone = places_of(test::bake(scene, cell, {classes[c]}, fine), 0);
    const Places together = places_of(six, c);
    for (const auto& [at, feet] : alone) out.places += static_cast<int64_t>(feet.size());
    compare(alone, together, out);
    compare(together, alone, out);
  }
  return out;
}

TEST(ManyClasses, EachStandsWhereItDoesAlone) {
  int64_t places = 0;
  for (const char* name : {"stairs", "garage", "bridge", "church", "maze"}) {
    for (const double cell : {0.1, 0.25}) {
      const Difference found = six_and_alone(test::builtin({.name = name}), cell, true);
      EXPECT_EQ(found.unlike, 0) << name << ", cells of " << cell;
      EXPECT_LE(found.feet, 2) << name;
      places += found.places;
    }
  }
  EXPECT_GT(places, 1000000);
  RecordProperty("places", std::to_string(places));
}

// Six bodies of any size that does not change how free spans are assigned.
std::vector<AvatarClass> random_classes(uint64_t seed) {
  std::vector<AvatarClass> classes;
  for (uint64_t n = 0; n < 6; ++n) {
    const auto pick = [&](uint64_t i, double low, double high) {
      return low + (high - low) * random_unit(seed, n, i);
    };
    AvatarClass avatar{.name = "class" + std::to_string(n), .radius = pick(0, 0.16, 0.7)};
    avatar.step_height = pick(1, 0.02, 0.9);
    avatar.max_slope = pick(2, 2, 45);
    // From those that crawl under tables to those that need a gate.
    const double bottom = std::max(avatar.step_height, avatar.radius);
    avatar.height = std::max(2 * avatar.step_height, bottom + pick(3, 0.3, 2.6));
    classes.push_back(avatar);
  }
  return classes;
}

TEST(ManyClasses, NorDoesItInSoupsForBodiesOfAnySize) {
  int64_t places = 0;
  for (uint64_t seed = 1; seed <= 24; ++seed) {
    const Scene soup = worlds::random_soup(seed, 60 + 40 * static_cast<uint32_t>(seed % 4), 14);
    const double cell = seed % 3 == 0 ? 0.25 : 0.1;
    const Difference found = six_and_alone(soup, cell, seed % 2 == 0, random_classes(seed));
    EXPECT_EQ(found.unlike, 0) << "seed " << seed;
    EXPECT_LE(found.feet, 2) << "seed " << seed;
    places += found.places;
  }
  EXPECT_GT(places, 100000);
  RecordProperty("places", std::to_string(places));
}

TEST(ManyClasses, NorDoesItInSharedWorlds) {
  const std::filesystem::path folder = THRONG_SHARED_WORLDS;
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no shared worlds here";
  int64_t places = 0;
  for (const char* model :
       {"recast/nav_test.obj", "recast/dungeon.obj", "recast/undulating.obj", "sponza/sponza.obj",
        "buildings/parking_garage.dae", "buildings/school.dae", "buildings/duplex_arch.obj",
        "buildings/schependomlaan.obj", "quake3/am_thornish.bsp", "cities/lod3_railway.obj"}) {
    Context context;
    SceneConfig config;
    config.sources.push_back({.path = folder / model, .up = {}, .scale = {}, .transform = {}});
    const auto scene = load_scene(config, context);
    ASSERT_TRUE(scene) << scene.error().message;
    const Difference found = six_and_alone(*scene, 0.15, true);
    EXPECT_EQ(found.unlike, 0) << model;
    EXPECT_LE(found.feet, 2) << model;
    places += found.places;
  }
  EXPECT_GT(places, 4000000);
  RecordProperty("places", std::to_string(places));
}

}  // namespace
}  // namespace throng
