// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>

#include "core/access.h"
#include "core/random.h"
#include "path/overlay/mesh_finder.h"
#include "throng/bake.h"
#include "throng/papers.h"
#include "throng/path.h"
#include "throng/world.h"
#include "world/zone_data.h"
#include "worlds.h"

// Zones that pass every check and are not true: any answer will do, a crash will not.
namespace throng {
namespace {

struct Baked {
  std::vector<uint8_t> manifest;
  std::vector<std::vector<uint8_t>> zones;
};

Baked bake_small() {
  Scene scene = worlds::two_floors();
  scene.add_quad({0, 0, 7}, {0, 0, 30}, {10, 3, 30}, {10, 3, 7}, 5);
  for (int i = 0; i < 20; ++i) {  // rough enough for values in blocks
    const double x = 11 + 0.2 * (i % 5), z = 7 + 0.2 * static_cast<int>(i / 5);
    scene.add_quad({x, 0.01 * i, z}, {x, 0.01 * i, z + 0.2}, {x + 0.2, 0.02 * i, z + 0.2},
                   {x + 0.2, 0.02 * i, z});
  }
  Context context;
  auto world = bake_world(scene, {.cell = 0.2, .zone = 12.8}, context);
  EXPECT_TRUE(world);
  Baked baked;
  const world::WorldData& data = *data_of(*world);
  baked.manifest = world::write_manifest(data);
  for (size_t s = 0; s < data.slots.size(); ++s) {
    const auto bytes = data.zone(s)->bytes();
    baked.zones.emplace_back(bytes.begin(), bytes.end());
  }
  return baked;
}

// One of a few values that are near or far, or beyond what a zone may say.
int32_t false_height(uint64_t seed, uint64_t n) {
  constexpr std::array<int32_t, 10> kHeights{0,           2500,         -700,         20'000,
                                             -300'000,    80'000'000,   -900'000'000, 1'049'999'999,
                                             -1049999999, 2'000'000'000};
  const size_t near = seed % 2 == 0 ? 3 : kHeights.size();  // Half of the worlds stay near.
  return kHeights[random_below(seed, n, 0, near)];
}

std::unique_ptr<world::Zone> with_false_heights(std::vector<uint8_t> bytes, uint64_t seed) {
  auto* root = flatbuffers::GetMutableRoot<format::Zone>(bytes.data());
  auto* words = const_cast<uint64_t*>(root->words()->data());
  auto* levels = reinterpret_cast<format::Level*>(const_cast<uint8_t*>(root->levels()->Data()));
  for (uint32_t i = 0; i < root->levels()->size(); ++i) {
    format::Level& level = levels[i];
    if (random_below(seed, i, 1, 2) == 0) continue;
    int32_t base = level.floor_base(), slope_x = level.slope_x(), slope_z = level.slope_z();
    format::HeightKind kind = level.floor_kind();
    if (random_below(seed, i, 2, 2) == 0) base = false_height(seed, i);
    if (kind == format::HeightKind::Blocks) {
      for (uint32_t b = 0; b < world::kBlocks;
           ++b) {  // Not the width: the values still lie in the file.
        words[level.floor_offset() + b] ^=
            random_below(seed, i * 64 + b, 3, uint64_t{1} << (seed % 2 == 0 ? 8 : 48));
      }
    } else if (random_below(seed, i, 4, 2) == 0) {
      const int32_t bits = seed % 2 == 0 ? 16 : 24;
      kind = format::HeightKind::Plane;
      slope_x = static_cast<int32_t>(random_below(seed, i, 5, 1 << bits)) - (1 << (bits - 1));
      slope_z = static_cast<int32_t>(random_below(seed, i, 6, 1 << bits)) - (1 << (bits - 1));
    }
    level = format::Level(level.tile(), kind, level.ceiling_kind(), base, level.ceiling_base(),
                          slope_x, slope_z, level.floor_offset(), level.ceiling_offset(),
                          level.floor_part(), level.present_kind(), level.area_kind(),
                          level.area_value(), level.present_offset(), level.area_offset());
  }
  auto* copy = new uint8_t[bytes.size()];
  std::copy(bytes.begin(), bytes.end(), copy);
  auto zone = world::Zone::from_bytes(
      flatbuffers::DetachedBuffer(nullptr, false, copy, bytes.size(), copy, bytes.size()), "z.thz");
  return zone ? std::move(*zone) : nullptr;
}

// Everything that a program may ask. True if the crowd could be made.
bool use(const World& world) {
  Context context;
  double sum = 0;
  for (uint64_t n = 0; n < 30; ++n) {
    const Place place = world.random_place(0, 7, n);
    const double dx = 3 * random_unit(1, n, 1) - 1.5, dz = 3 * random_unit(1, n, 2) - 1.5;
    sum += world.move(0, place, dx, dz).place.position.y + world.feet(place);
    sum += world.find_place(0, place.position, 1e9).position.y;
  }
  EXPECT_TRUE(std::isfinite(sum));
  EXPECT_EQ(world.storeys().size(), world.level_tile_count());
  EXPECT_TRUE(Graph::create(world, {}, context));
  auto finder = path::MeshFinder::create(world, {}, context);
  EXPECT_TRUE(finder);
  Path path;
  for (uint64_t n = 0; n < 20; ++n) {
    finder->find(world.random_place(0, 8, n), world.random_place(0, 9, n), path, 100'000);
  }
  auto crowd = Wanderers::create(world, {.avatars = 60, .speed = 20, .workers = 1});
  if (!crowd) {
    EXPECT_TRUE(crowd.error().code == Errc::kBadFile || crowd.error().code == Errc::kLimit);
    EXPECT_FALSE(crowd.error().message.empty());
    return false;
  }
  for (int step = 0; step < 60; ++step) crowd->step();
  return true;
}

TEST(FalseZones, WithAnyHeightsAnswerAndDoNotCrash) {
  const Baked baked = bake_small();
  ASSERT_GT(baked.zones.size(), 1u);
  int32_t unread = 0, refused = 0, run = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const auto data = world::read_manifest(baked.manifest, "m.thm");
    ASSERT_TRUE(data);
    bool sound = true;
    for (size_t s = 0; s < baked.zones.size(); ++s) {
      auto zone = with_false_heights(baked.zones[s], seed + 10'000 * s);
      sound &= zone != nullptr;
      (*data)->slots[s]->zone = std::move(zone);
      if (!sound) break;
    }
    if (!sound) {
      ++unread;
    } else {
      ++(use(Access::create<World>(*data)) ? run : refused);
    }
  }
  EXPECT_GT(unread, 0);
  EXPECT_GT(refused, 10);
  EXPECT_GT(run, 30);
}

// Costs and paints are looked up by the kind of a cell.
TEST(FalseZones, OfAKindThatIsNoneAreRefused) {
  std::vector<uint8_t> bytes = bake_small().zones[0];
  auto* root = flatbuffers::GetMutableRoot<format::Zone>(bytes.data());
  auto* levels = reinterpret_cast<format::Level*>(const_cast<uint8_t*>(root->levels()->Data()));
  const format::Level level = levels[0];
  for (const uint8_t kind : {uint8_t{0}, uint8_t{63}, uint8_t{64}, uint8_t{255}}) {
    levels[0] =
        format::Level(level.tile(), level.floor_kind(), level.ceiling_kind(), level.floor_base(),
                      level.ceiling_base(), level.slope_x(), level.slope_z(), level.floor_offset(),
                      level.ceiling_offset(), level.floor_part(), level.present_kind(),
                      level.area_kind(), kind, level.present_offset(), level.area_offset());
    auto* copy = new uint8_t[bytes.size()];
    std::copy(bytes.begin(), bytes.end(), copy);
    const auto zone = world::Zone::from_bytes(
        flatbuffers::DetachedBuffer(nullptr, false, copy, bytes.size(), copy, bytes.size()),
        "z.thz");
    EXPECT_EQ(static_cast<bool>(zone), kind <= 63);
    if (zone) continue;
    EXPECT_NE(zone.error().message.find("area kind"), std::string::npos);
  }
}

}  // namespace
}  // namespace throng
