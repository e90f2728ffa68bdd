// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/bake.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <utility>

#include "core/access.h"
#include "core/hash.h"
#include "flood.h"
#include "scratch_folder.h"
#include "simd_targets.h"
#include "throng/scene.h"
#include "world/zone_data.h"
#include "worlds.h"

namespace throng {
namespace {

World bake(const Scene& scene, const BakeConfig& config) {
  Context context;
  const auto world = bake_world(scene, config, context);
  EXPECT_TRUE(world) << world.error().message;
  return world ? *world : World{};
}

Scene builtin(const std::string& name) {
  auto scene = create_builtin_world({.name = name});
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? std::move(*scene) : Scene{};
}

// Every byte that would be written, but for the hashes of the zones' inputs: a world in memory does
// not know them.
uint64_t hash_of(const World& world) {
  const auto data = std::const_pointer_cast<world::WorldData>(data_of(world));
  const auto inputs = std::exchange(data->inputs, {});
  uint64_t hash = 0;
  for (size_t s = 0; s < data_of(world)->slots.size(); ++s) {
    hash = hash_span(data_of(world)->zone(s)->bytes(), hash);
  }
  hash = hash_span(std::span<const uint8_t>(world::write_manifest(*data)), hash);
  data->inputs = inputs;
  return hash;
}

// All that a world says, however its files say it.
uint64_t hash_of_content(const World& world) {
  uint64_t hash = 0;
  for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
    const LevelTileContent level = world.level_tile(l);
    hash = hash_span(std::span<const int32_t>(level.floor), hash);
    hash = hash_span(std::span<const int32_t>(level.ceiling), hash);
    hash = hash_span(std::span<const uint8_t>(level.area), hash);
    for (const auto& of_class : level.clearance) {
      hash = hash_span(std::span<const uint8_t>(of_class), hash);
    }
    const int32_t place[] = {level.tile_x, level.tile_z};
    hash = hash_bytes(place, sizeof place, hash);
  }
  return hash;
}

// What a world says of one floor of one cell.
struct Spot {
  int32_t ceiling;
  uint8_t area;
  std::vector<uint8_t> clearance;  // per class
  auto operator<=>(const Spot&) const = default;
};

// By cell of the world and height, whatever level tiles and zones it is stored in.
using Spots = std::map<std::tuple<int32_t, int32_t, int32_t>, Spot>;

// Without `margins` only which classes may stand there.
Spots spots_of(const World& world, bool margins = true) {
  Spots spots;
  for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
    const LevelTileContent level = world.level_tile(l);
    for (int32_t c = 0; c < 4096; ++c) {
      const auto i = static_cast<size_t>(c);
      if (level.floor[i] == kNoFloor) continue;
      Spot spot{level.ceiling[i], level.area[i], {}};
      bool any = false;
      for (const auto& of_class : level.clearance) {
        spot.clearance.push_back(margins ? of_class[i] : std::min<uint8_t>(of_class[i], 1));
        any = any || of_class[i] != 0;
      }
      if (!any) continue;
      const auto [at, is_new] = spots.insert(
          {{level.tile_z * 64 + c / 64, level.tile_x * 64 + c % 64, level.floor[i]}, spot});
      EXPECT_TRUE(is_new) << "two floors at one height";
    }
  }
  return spots;
}

std::string words(const Spot& spot) {
  return fmt::format("ceiling {}, clearance {}", spot.ceiling, fmt::join(spot.clearance, " "));
}

// Says where two worlds differ first.
void expect_same(const Spots& a, const Spots& b, const std::string& what) {
  EXPECT_EQ(a.size(), b.size()) << what;
  int32_t shown = 0;
  for (const auto& [key, spot] : a) {
    const auto [z, x, floor] = key;
    const auto found = b.find(key);
    const bool same = found != b.end() && found->second == spot;
    EXPECT_TRUE(same) << what << ": cell " << x << " " << z << ", floor " << floor
                      << (found == b.end() ? " is not there" : " differs: ")
                      << (found == b.end() ? "" : words(spot) + " and " + words(found->second));
    if (!same && ++shown == 12) return;
  }
}

TEST(Bake, SameBytesForAnyNumberOfThreadsAndEverySimdWidth) {
  struct Golden {
    const char* name;
    uint64_t hash;
  };
  for (const auto& [name, golden] :
       {Golden{"cube", 0xfe1b8e89e43b72a4}, Golden{"stairs", 0x675c0e85825dd2b9},
        Golden{"garage", 0x5892bc9678f93249}, Golden{"bridge", 0x72842e23dcf99d4a}}) {
    const Scene scene = builtin(name);
    for (const int32_t workers : {1, 2, 3, 8}) {
      const uint64_t hash = hash_of(bake(scene, {.cell = 0.2, .zone = 51.2, .workers = workers}));
      EXPECT_EQ(hash, golden) << name << ", " << workers << " workers: 0x" << std::hex << hash;
    }
    test::for_every_simd_target([&, name = name, golden = golden](const char* target) {
      EXPECT_EQ(hash_of(bake(scene, {.cell = 0.2, .zone = 51.2})), golden)
          << name << ", " << target;
    });
  }
}

// These stay when the format of the files changes.
TEST(Bake, SameContentHoweverItIsStored) {
  for (const auto& [name, golden] : {std::pair<const char*, uint64_t>{"cube", 0x0b3f016a2b4ad4e8},
                                     {"stairs", 0x87a044fff0e5ef6a},
                                     {"garage", 0xf428ef256c99cb45},
                                     {"bridge", 0x47ac40f812acc0da}}) {
    const uint64_t hash = hash_of_content(bake(builtin(name), {.cell = 0.2, .zone = 51.2}));
    EXPECT_EQ(hash, golden) << name << ": 0x" << std::hex << hash;
  }
}

TEST(Bake, ZoneBordersChangeNothing) {
  for (const auto& [name, fine] :
       {std::pair{"stairs", false}, std::pair{"garage", false}, std::pair{"church", false},
        std::pair{"bridge", false}, std::pair{"church", true}, std::pair{"bridge", true}}) {
    const Scene scene = builtin(name);
    const World whole = bake(scene, {.cell = 0.2, .fine = fine, .zone = 102.4});
    const World pieces = bake(scene, {.cell = 0.2, .fine = fine, .zone = 12.8});
    EXPECT_LE(whole.summary().zones, 2u) << name;
    EXPECT_GT(pieces.summary().zones, 8u) << name;
    // Margins may: seen from a zone, a floor of the next one can fall into pieces
    // (docs/algorithms.md, layers), and a margin ends at a piece's end.
    expect_same(spots_of(whole, false), spots_of(pieces, false), name);
    EXPECT_EQ(whole.summary().walkable_area, pieces.summary().walkable_area) << name;
  }
}

Scene hall() {
  Scene scene = worlds::two_floors();
  const Scene ramp = worlds::ramp(20, 4);
  for (const auto& t : ramp.triangles) {
    const Vec3d aside{0, 0, 7};
    scene.add_triangle(ramp.positions[t[0]] + aside, ramp.positions[t[1]] + aside,
                       ramp.positions[t[2]] + aside);
  }
  return scene;
}

TEST(Bake, ATriangleFarBelowOrAboveMovesNothing) {
  const Spots before = spots_of(bake(hall(), {.cell = 0.1}));
  ASSERT_GT(before.size(), 5000u);
  for (const double height : {-100.0, -2000.0, -7900.0, 2000.0, 7900.0}) {
    for (const double wide : {1.0, 9.5}) {
      Scene scene = hall();
      scene.add_triangle({0.2, height, 0.2}, {0.2, height, 0.2 + wide}, {0.2 + wide, height, 0.2});
      Spots after = spots_of(bake(scene, {.cell = 0.1}));
      int32_t far = 0;
      std::erase_if(after, [&](const auto& entry) {
        const bool is_far = std::abs(std::get<2>(entry.first) / 1000.0 - height) < 1;
        far += is_far ? 1 : 0;
        return is_far;
      });
      EXPECT_GT(far, 0) << height;
      Spots same_sky = before;
      if (height > 0) {  // It is a ceiling for what lies under it.
        for (auto* spots : {&after, &same_sky}) {
          for (auto& [key, spot] : *spots) spot.ceiling = std::min(spot.ceiling, 50000);
        }
      }
      expect_same(same_sky, after, "a triangle at " + std::to_string(height));
    }
  }
}

TEST(Bake, AFlatFloorIsAFewBytesATile) {
  Scene scene;  // Just inside the borders of 1024 x 1024 cells.
  constexpr double kLow = -0.05, kHigh = 102.34;
  scene.add_quad({kLow, 0, kLow}, {kLow, 0, kHigh}, {kHigh, 0, kHigh}, {kHigh, 0, kLow});
  BakeReport report;
  Context context;
  const auto world = bake_world(scene, {.cell = 0.1, .classes = {AvatarClass{}}}, context, &report);
  ASSERT_TRUE(world);
  EXPECT_EQ(report.level_tiles, 256u);
  EXPECT_EQ(report.constant_level_tiles, 256u);
  const world::Zone& zone = *data_of(*world)->zone(0);
  // Only tiles at the rim need clearance cell by cell: four sides and four corners, shared.
  std::set<uint32_t> rims;
  for (const format::Clearance* c : *zone.root().clearance()) {
    if (c->kind() == format::CellsKind::Blocks) rims.insert(c->offset());
  }
  EXPECT_EQ(rims.size(), 8u);
  EXPECT_LT(zone.root().words()->size(), 8u * 80);
  const uint64_t level = sizeof(format::Level) + sizeof(format::Clearance);
  EXPECT_LT(report.bytes, 8 * 80 * 8 + 256 * level + 626 * 4 + 400);
  for (uint32_t l = 0; l < zone.level_count(); ++l) {
    EXPECT_EQ(zone.level(l).floor_kind(), format::HeightKind::Constant);
    EXPECT_EQ(zone.level(l).ceiling_kind(), format::HeightKind::None);
  }
  const double inner = 102.4 - 2 * 0.2;  // a body touches the rim up to two cells inside
  EXPECT_NEAR(report.walkable_area[0], inner * inner, 1e-6);
  EXPECT_EQ(report.walkable_area, world->summary().walkable_area);
}

TEST(Bake, ASteadyRampIsAPlaneAndMeetsTheModelWithinAMillimetre) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 25.6}, {25.6, 3.2, 25.6}, {25.6, 3.2, 0});
  BakeReport report;
  Context context;
  const auto world = bake_world(scene, {.cell = 0.1}, context, &report);
  ASSERT_TRUE(world);
  EXPECT_EQ(report.constant_level_tiles, report.level_tiles);
  for (const format::Level* level : *data_of(*world)->zone(0)->root().levels()) {
    EXPECT_NE(level->floor_kind(), format::HeightKind::Blocks);
  }
  for (uint64_t n = 0; n < 2000; ++n) {
    const Place place = world->random_place(0, 5, n);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place.position.y, place.position.x / 8, 0.00151);
  }
}

TEST(Bake, AStepOfExactlyTheClasssHeightIsClimbedAndAMillimetreMoreIsNot) {
  const BakeConfig config{.cell = 0.1, .classes = {AvatarClass{}}};
  const auto top_of = [&](double rise) {
    return flood_from(bake(worlds::steps(rise, 1.0, 2), config), 0, {1, 0, 1.5}).around(2 * rise);
  };
  EXPECT_GT(top_of(0.399), 4);
  EXPECT_GT(top_of(0.4), 4);
  EXPECT_EQ(top_of(0.401), 0);
}

void add_square(Scene& scene, double side, double y, bool faces_up) {
  const Vec3d a{0, y, 0}, b{side, y, 0}, c{side, y, side}, d{0, y, side};
  for (const auto& [p, q, r] : {std::array{a, c, b}, std::array{a, d, c}}) {
    faces_up ? scene.add_triangle(p, q, r) : scene.add_triangle(p, r, q);
  }
}

TEST(Bake, OneSidedOnlyWhatFacesUpIsFloor) {
  const auto area = [](const Scene& scene, bool one_sided) {
    BakeConfig config{.one_sided = one_sided, .classes = {AvatarClass{}}};
    const World world = bake(scene, config);
    return world.summary().walkable_area.front();
  };
  Scene floor;
  add_square(floor, 10, 0, true);
  const double one = area(floor, false);
  ASSERT_GT(one, 80);
  EXPECT_EQ(area(floor, true), one);
  Scene room = floor;  // with a ceiling without thickness
  add_square(room, 10, 3, false);
  EXPECT_EQ(area(room, false), 2 * one);
  EXPECT_EQ(area(room, true), one);
  Scene low = floor;  // What faces down blocks, too.
  add_square(low, 10, 1, false);
  EXPECT_EQ(area(low, true), 0);
  Scene both = room;  // One floor from both sides, cut in other triangles.
  const Vec3d a{0, 3, 0}, b{10, 3, 0}, c{10, 3, 10}, d{0, 3, 10};
  both.add_triangle(a, d, b);
  both.add_triangle(b, d, c);
  EXPECT_EQ(area(both, true), 2 * one);
  Scene inverted;
  add_square(inverted, 10, 0, false);
  EXPECT_EQ(area(inverted, true), 0);
}

// Wound by chance: no body stands where it would not if windings were ignored.
TEST(Bake, OneSidedAllowsNothingMore) {
  uint64_t legal = 0, fewer = 0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    const Scene scene = worlds::random_soup(seed, 400, 20);
    BakeConfig config;
    const World all = bake(scene, config);
    config.one_sided = true;
    const World some = bake(scene, config);
    for (uint32_t l = 0; l < some.level_tile_count(); ++l) {
      const LevelTileContent level = some.level_tile(l);
      for (size_t c = 0; c < level.clearance.size(); ++c) {
        for (int32_t cell = 0; cell < kTileCells * kTileCells; ++cell) {
          const auto at = static_cast<size_t>(cell);
          if (level.clearance[c][at] == 0) continue;
          const WorldSummary summary = some.summary();
          const Vec3d feet{
              summary.origin.x +
                  (level.tile_x * kTileCells + cell % kTileCells + 0.5) * summary.cell,
              summary.origin.y + level.floor[at] * 0.001,
              summary.origin.z +
                  (level.tile_z * kTileCells + cell / kTileCells + 0.5) * summary.cell};
          ++legal;
          EXPECT_TRUE(all.find_place(static_cast<int32_t>(c), feet, 0.002)) << seed << ' ' << c;
        }
      }
    }
    for (size_t c = 0; c < config.classes.size(); ++c) {
      EXPECT_LE(some.summary().walkable_area[c], all.summary().walkable_area[c]);
      fewer += some.summary().walkable_area[c] < all.summary().walkable_area[c] ? 1 : 0;
    }
  }
  EXPECT_GT(legal, 1000U);
  EXPECT_GT(fewer, 8U);
}

TEST(Bake, WalkableAreaIsTheSumOfTheLegalCells) {
  const World world = bake(builtin("stairs"), {.cell = 0.2, .zone = 25.6});
  std::vector<double> area(world.summary().classes.size());
  for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
    const LevelTileContent level = world.level_tile(l);
    for (size_t c = 0; c < area.size(); ++c) {
      for (const uint8_t k : level.clearance[c]) area[c] += k != 0 ? 0.04 : 0;
    }
  }
  for (size_t c = 0; c < area.size(); ++c) {
    EXPECT_NEAR(world.summary().walkable_area[c], area[c], 1e-6);
  }
}

TEST(Bake, BadConfigsAreRefusedWithASentence) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  AvatarClass wide;
  wide.radius = 4.9;
  AvatarClass bad;
  bad.height = nan;
  const std::vector<BakeConfig> configs{
      {.cell = 0},
      {.cell = 0.019},
      {.cell = 5.01},
      {.cell = -1},
      {.cell = nan},
      {.cell = inf},
      {.resolution = 0},
      {.resolution = 1.1},
      {.resolution = nan},
      {.zone = 0},
      {.zone = -5},
      {.zone = nan},
      {.zone = 10001},
      {.classes = {}},
      {.classes = {AvatarClass{}, AvatarClass{}}},
      {.classes = {bad}},
      {.workers = -1},
      {.cell = 0.1, .classes = {wide}},
      {.classes = std::vector<AvatarClass>(17)},
  };
  const Scene scene = worlds::flat(3);
  for (size_t i = 0; i < configs.size(); ++i) {
    Context context;
    const auto world = bake_world(scene, configs[i], context);
    ASSERT_FALSE(world) << i;
    EXPECT_EQ(world.error().code, Errc::kBadConfig) << i << ": " << world.error().message;
    EXPECT_GT(world.error().message.size(), 20u) << i;
  }
}

TEST(Bake, ScenesThatCannotBeBakedAreRefusedWithASentence) {
  const auto refused = [](const Scene& scene, Errc code, const std::string& words) {
    Context context;
    const auto world = bake_world(scene, {}, context);
    ASSERT_FALSE(world) << words;
    EXPECT_EQ(world.error().code, code);
    EXPECT_NE(world.error().message.find(words), std::string::npos) << world.error().message;
  };
  refused(Scene{}, Errc::kBadInput, "no triangles");
  Scene scene = worlds::flat(3);
  scene.area.pop_back();
  refused(scene, Errc::kBadInput, "area kinds");
  for (const double x :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    scene = worlds::flat(3);
    scene.positions[1].y = x;
    refused(scene, Errc::kBadInput, "position 1 is not finite");
  }
  scene = worlds::flat(3);
  scene.triangles[1][2] = 4;
  refused(scene, Errc::kBadInput, "triangle 1 names a position");
  scene = worlds::flat(3);
  scene.add_triangle({2e5, 0, 0}, {2e5, 0, 1}, {2e5 + 1, 0, 0});
  refused(scene, Errc::kLimit, "use a larger cell");
  scene = worlds::flat(3);
  scene.add_triangle({0, 2.1e6, 0}, {0, 0, 1}, {1, 0, 0});
  refused(scene, Errc::kLimit, "check the units");
}

TEST(Bake, AWorldWhereNoBodyCanStandHasNoZones) {
  Scene wall;
  wall.add_quad({0, 0, 0}, {0, 3, 0}, {5, 3, 0}, {5, 0, 0});
  const World world = bake(wall, {});
  EXPECT_EQ(world.summary().zones, 0u);
  EXPECT_EQ(world.level_tile_count(), 0u);
  EXPECT_FALSE(world.random_place(0, 1, 1));
  EXPECT_FALSE(world.find_place(0, {1, 0, 0}, 100));
}

TEST(Bake, CancelledItSaysSoAndLeavesWhatWasThere) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/w.throng";
  const Scene scene = worlds::flat(40);
  const BakeConfig config{.cell = 0.2, .zone = 12.8};
  Context calm;
  ASSERT_TRUE(bake_world_to(path, scene, config, calm));
  const auto old = World::open(path);
  ASSERT_TRUE(old);
  const uint64_t before = hash_of(*old);

  for (const uint64_t after : {0, 1, 5, 15}) {
    Context context;
    context.on_progress = [&](const Progress& p) {
      if (p.done >= after) context.cancel = true;
    };
    const auto report = bake_world_to(path, scene, config, context);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, Errc::kCancelled);
    const auto in_memory = bake_world(scene, config, context);
    ASSERT_FALSE(in_memory);
    EXPECT_EQ(in_memory.error().code, Errc::kCancelled);
  }
  const auto now = World::open(path);
  ASSERT_TRUE(now);
  EXPECT_TRUE(now->check_all());
  EXPECT_EQ(hash_of(*now), before);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_EQ(entry.path().filename(), "w.throng");
  }
}

TEST(Bake, IntoAFolderAndIntoMemoryAreTheSameWorld) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/w.throng";
  const BakeConfig config{.cell = 0.2, .zone = 12.8};
  Context context;
  ASSERT_TRUE(bake_world_to(path, hall(), config, context));
  const auto opened = World::open(path);
  ASSERT_TRUE(opened);
  EXPECT_TRUE(opened->check_all());
  EXPECT_EQ(hash_of(*opened), hash_of(bake(hall(), config)));
}

TEST(Bake, AFolderThatIsNotAWorldIsNotOverwritten) {
  const test::ScratchFolder folder;
  folder.write("letter.txt", "dear reader");
  Context context;
  const auto report = bake_world_to(folder.path(), worlds::flat(3), {}, context);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::kIo);
  EXPECT_NE(report.error().message.find("choose another name"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/letter.txt"));
}

}  // namespace
}  // namespace throng
