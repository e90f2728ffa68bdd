// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/access.h"
#include "core/random.h"
#include "graph/node_data.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "world/region_data.h"
#include "world/zone_data.h"
#include "worlds.h"

// Damaged worlds: nothing in a file may crash a program, and nothing damaged may pass for whole.
namespace throng {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<uint8_t>;

// Floors over floors, planes, samples and constants, ceilings and two kinds of area.
Scene small_scene() {
  Scene scene = worlds::two_floors();
  scene.add_quad({0, 0, 7}, {0, 0, 9}, {6, 1, 9}, {6, 1, 7}, 5);
  scene.add_box({1, 0, 3}, {1.5, 0.3, 3.5}, 7);
  for (int i = 0; i < 20; ++i) {  // rough enough for samples
    const double x = 7 + 0.2 * (i % 5), z = 7 + 0.2 * static_cast<int>(i / 5);
    scene.add_quad({x, 0.01 * i, z}, {x, 0.01 * i, z + 0.2}, {x + 0.2, 0.02 * i, z + 0.2},
                   {x + 0.2, 0.02 * i, z});
  }
  return scene;
}

BakeConfig small_config() {
  return {.cell = 0.2, .zone = 12.8, .classes = {AvatarClass{}, {.name = "b", .height = 1}}};
}

Bytes read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::string& path, const Bytes& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

// Bytes as a zone would own them; the copy is exact, so that a read past it is seen.
Result<std::unique_ptr<world::Zone>> as_zone(const Bytes& bytes) {
  auto* copy = new uint8_t[bytes.size()];
  std::copy(bytes.begin(), bytes.end(), copy);
  return world::Zone::from_bytes(
      flatbuffers::DetachedBuffer(nullptr, false, copy, bytes.size(), copy, bytes.size()), "z.thz");
}

class ZoneFiles : public testing::Test {
 protected:
  void SetUp() override {
    Context context;
    const auto report = bake_world_to(path(), small_scene(), small_config(), context);
    ASSERT_TRUE(report) << report.error().message;
    for (const auto& entry : fs::directory_iterator(path())) {
      if (entry.path().extension() == ".thz") zone_path_ = entry.path().string();
    }
    manifest_ = read_bytes(manifest_path());
    zone_ = read_bytes(zone_path_);
    ASSERT_FALSE(zone_.empty());
  }
  [[nodiscard]] std::string path() const { return folder_.path() + "/w.throng"; }
  [[nodiscard]] std::string manifest_path() const { return path() + "/manifest.thm"; }

  test::ScratchFolder folder_;
  std::string zone_path_;
  Bytes manifest_, zone_;
};

// Touches everything that a program can ask of a world.
void use(const World& world) {
  const WorldSummary summary = world.summary();
  double sum = 0;
  for (uint32_t l = 0; l < world.level_tile_count() && l < 100; ++l) {
    sum += world.level_tile(l).floor[0];
  }
  if (world.level_tile_count() < 1000) {
    EXPECT_EQ(world.storeys().size(), world.level_tile_count());
  }
  for (int32_t c = -1; c <= static_cast<int32_t>(summary.classes.size()); ++c) {
    for (uint64_t n = 0; n < 20; ++n) {
      const double dx = 1.5 * random_unit(1, n, 1) - 0.7, dz = 1.5 * random_unit(1, n, 2) - 0.7;
      const Place place = world.random_place(c, 1, n);
      sum += world.move(c, place, dx, dz).place.position.y + world.feet(place);
      const Vec3d anywhere{10 * random_unit(1, n, 3), 1, 10 * random_unit(1, n, 4)};
      sum += world.find_place(c, anywhere, 10).position.y;
    }
  }
  EXPECT_FALSE(std::isinf(sum));
}

TEST_F(ZoneFiles, AZoneOfAnyOtherLengthIsRefused) {
  for (size_t length = 0; length < zone_.size(); length += length < 400 ? 1 : 61) {
    const auto zone = as_zone(Bytes(zone_.begin(), zone_.begin() + static_cast<int64_t>(length)));
    ASSERT_FALSE(zone) << length;
    EXPECT_EQ(zone.error().code, Errc::kBadFile);
    EXPECT_NE(zone.error().message.find("z.thz"), std::string::npos);
  }
  for (const size_t length : {size_t{0}, size_t{1}, zone_.size() / 2, zone_.size() - 1}) {
    write_bytes(zone_path_, Bytes(zone_.begin(), zone_.begin() + static_cast<int64_t>(length)));
    const auto world = World::open(path());
    ASSERT_TRUE(world);  // Zones are looked at when they are touched.
    const auto checked = world->check_all();
    ASSERT_FALSE(checked) << length;
    EXPECT_NE(checked.error().message.find("zone_0_0.thz"), std::string::npos);
    use(*world);
  }
  Bytes longer = zone_;
  longer.push_back(0);
  write_bytes(zone_path_, longer);
  EXPECT_FALSE(World::open(path())->check_all());
}

TEST_F(ZoneFiles, AManifestOfAnyOtherLengthIsRefused) {
  const Bytes content(manifest_.begin(), manifest_.end() - 8);  // the sum is for the whole file
  for (size_t length = 0; length < manifest_.size(); ++length) {
    const Bytes cut(manifest_.begin(), manifest_.begin() + static_cast<int64_t>(length));
    write_bytes(manifest_path(), cut);
    const auto opened = World::open(path());
    ASSERT_FALSE(opened) << length;
    EXPECT_EQ(opened.error().code, Errc::kBadFile);
    EXPECT_NE(opened.error().message.find("manifest.thm"), std::string::npos);
    // And none is read past its end, whatever its sum.
    const auto world = world::read_manifest(cut, "m.thm");
    if (world) {
      ASSERT_GT(length + 8, content.size());  // Only what fills up the last word may be missing.
      EXPECT_EQ(world::write_manifest(**world), content);
    }
  }
  Bytes longer = manifest_;
  longer.push_back(0);
  write_bytes(manifest_path(), longer);
  EXPECT_FALSE(World::open(path()));
}

TEST_F(ZoneFiles, AnyChangedBitOfAManifestIsSeen) {
  for (size_t i = 0; i < manifest_.size(); ++i) {
    Bytes bytes = manifest_;
    bytes[i] ^= static_cast<uint8_t>(1 << i % 8);
    write_bytes(manifest_path(), bytes);
    EXPECT_FALSE(World::open(path())) << i;
  }
}

TEST_F(ZoneFiles, AFlippedByteOfAZoneIsSeenByItsChecksum) {
  for (uint64_t n = 0; n < 60; ++n) {
    Bytes bytes = zone_;
    const size_t at = random_below(3, n, 0, bytes.size());
    bytes[at] ^= static_cast<uint8_t>(1 + random_below(3, n, 1, 255));
    write_bytes(zone_path_, bytes);
    const auto world = World::open(path());
    ASSERT_TRUE(world);
    const auto checked = world->check_all();
    ASSERT_FALSE(checked) << at;
    EXPECT_EQ(checked.error().code, Errc::kBadFile);
    EXPECT_NE(checked.error().message.find("checksum"), std::string::npos);
    use(*world);
  }
}

// scripts/fuzz begins with this file. After a change of the format, write it again: bake
// small_scene with small_config and take its zone.
TEST(FuzzSeeds, TheZoneIsOfThisVersion) {
  const Bytes bytes = read_bytes(THRONG_TEST_DATA "/../fuzz/seeds/zone/small.thz");
  const auto zone = as_zone(bytes);
  ASSERT_TRUE(zone) << zone.error().message;
  EXPECT_GT((*zone)->root().words()->size(), 400u);
}

TEST(FuzzSeeds, RegionsAndLinksAreOfThisVersion) {
  const auto map = [](const char* name) {
    auto file = FileMap::open(std::string(THRONG_TEST_DATA "/../fuzz/seeds/regions/") + name);
    EXPECT_TRUE(file);
    return file ? *std::move(file) : FileMap{};
  };
  EXPECT_TRUE(world::RegionZone::from_file(map("small.thr"), "small.thr"));
  EXPECT_TRUE(world::LinkZone::from_file(map("small.thl"), "small.thl"));
}

// Of the built-in cube at cells of 0.2 m, baked with --nodes.
TEST(FuzzSeeds, TheNodesAreOfThisVersion) {
  auto file = FileMap::open(THRONG_TEST_DATA "/../fuzz/seeds/nodes/small.thn");
  ASSERT_TRUE(file);
  const auto zone = graph::NodeZone::from_file(*std::move(file), "small.thn");
  ASSERT_TRUE(zone) << zone.error().message;
  EXPECT_GT((*zone)->nodes().size(), 0u);
}

// A zone that lies about its content but carries the right checksum, as an attacker would make it.
TEST_F(ZoneFiles, AFlippedByteBehindTheChecksumIsRefusedOrHarmless) {
  const auto whole = as_zone(zone_);
  ASSERT_TRUE(whole) << whole.error().message;
  const format::Zone& root = (*whole)->root();
  ASSERT_GT(root.words()->size(), 400u);
  int32_t refused = 0, harmless = 0;
  for (size_t at = 0; at < zone_.size(); ++at) {
    for (const int mask : {0x01, 0x80, 0xff}) {
      Bytes bytes = zone_;
      bytes[at] = static_cast<uint8_t>(bytes[at] ^ mask);
      auto zone = as_zone(bytes);
      if (!zone) {
        ++refused;
        ASSERT_EQ(zone.error().code, Errc::kBadFile);
        continue;
      }
      ++harmless;
      const auto& other = (*zone)->root();
      if (other.tiles_per_side() != root.tiles_per_side() || other.x() != root.x() ||
          other.z() != root.z() || other.class_count() != root.class_count() ||
          (*zone)->level_count() != (*whole)->level_count()) {
        continue;  // WorldData::zone refuses these: "belongs to another world".
      }
      const auto data = world::read_manifest(manifest_, "m.thm");
      ASSERT_TRUE(data);
      ASSERT_EQ((*data)->slots.size(), 1u);
      (*data)->slots[0]->zone = std::move(*zone);
      use(Access::create<World>(*data));
    }
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(harmless, 100);
}

TEST_F(ZoneFiles, AFlippedByteOfTheManifestIsRefusedOrHarmless) {
  int32_t refused = 0, opened = 0;
  for (size_t at = 0; at < manifest_.size(); ++at) {
    for (const int mask : {0x01, 0x10, 0x80, 0xff}) {
      Bytes bytes = manifest_;
      bytes[at] = static_cast<uint8_t>(bytes[at] ^ mask);
      const auto data = world::read_manifest(bytes, "m.thm");
      if (!data) {
        ++refused;
        continue;
      }
      ++opened;
      (*data)->path = path();
      const auto world = Access::create<World>(*data);
      if (const auto checked = world.check_all(); !checked) {
        EXPECT_EQ(checked.error().code, Errc::kBadFile);
      }
      use(world);
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(opened, 100);
}

TEST_F(ZoneFiles, AnotherWorldsZoneIsRefused) {
  const std::string other = folder_.path() + "/other.throng";
  Scene scene = small_scene();
  scene.add_box({2, 0, 3}, {2.5, 0.3, 3.5});
  Context context;
  ASSERT_TRUE(bake_world_to(other, scene, small_config(), context));
  fs::copy_file(other + "/zone_0_0.thz", zone_path_, fs::copy_options::overwrite_existing);
  const auto world = World::open(path());
  ASSERT_TRUE(world);
  EXPECT_FALSE(world->check_all());
  fs::remove(zone_path_);
  const auto without = World::open(path());
  ASSERT_TRUE(without);
  const auto checked = without->check_all();
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("zone_0_0.thz"), std::string::npos);
  use(*without);
}

TEST(OpenWorld, WhatIsNotAWorldIsRefusedByName) {
  const test::ScratchFolder folder;
  const std::string file = folder.write("model.obj", "v 0 0 0\n");
  fs::create_directories(folder.path() + "/empty");
  fs::create_directories(folder.path() + "/hollow");
  folder.write("hollow/manifest.thm", "");
  fs::create_directories(folder.path() + "/text");
  folder.write("text/manifest.thm", "This is a letter, not a manifest of anything at all.");
  for (const std::string& path : {folder.path() + "/missing", folder.path() + "/empty", file,
                                  folder.path() + "/hollow", folder.path() + "/text"}) {
    const auto world = World::open(path);
    ASSERT_FALSE(world) << path;
    EXPECT_EQ(world.error().code, Errc::kBadFile) << path;
    EXPECT_NE(world.error().message.find(path), std::string::npos) << world.error().message;
  }
  EXPECT_FALSE(World::open(""));
}

TEST_F(ZoneFiles, VersionsFromTheFutureAreRefusedByNumber) {
  const auto bump = [](Bytes bytes, uint32_t version, size_t field) {
    auto* table = flatbuffers::GetMutableRoot<flatbuffers::Table>(bytes.data());
    const bool set =
        table->SetField<uint32_t>(static_cast<flatbuffers::voffset_t>(field), version, 0);
    EXPECT_TRUE(set);
    return bytes;
  };
  const auto zone = as_zone(bump(zone_, 77, format::Zone::VT_VERSION));
  ASSERT_FALSE(zone);
  EXPECT_EQ(zone.error().code, Errc::kBadFile);
  EXPECT_NE(zone.error().message.find("version 77, this program reads 2"), std::string::npos);
  write_bytes(manifest_path(), bump(manifest_, 77, format::Manifest::VT_VERSION));
  const auto world = World::open(path());
  ASSERT_FALSE(world);
  EXPECT_EQ(world.error().code, Errc::kBadFile);
  EXPECT_NE(world.error().message.find("version 77, this program reads 2"), std::string::npos);
}

}  // namespace
}  // namespace throng
