// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/zonel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include "core/files/read_file.h"
#include "core/hash.h"
#include "core/random.h"
#include "import/patches/patch_edges.h"
#include "patch_bytes.h"
#include "patch_nets.h"
#include "scratch_folder.h"
#include "tiny_zonel.h"

namespace throng {
namespace {

constexpr test::PatchReader kReader{importer::read_zonel, "3_AC.zonel"};

Result<Scene> load(const std::vector<std::string>& paths, double tolerance = 0.02) {
  Context context;
  SceneConfig config;
  for (const std::string& path : paths) {
    config.sources.push_back({.path = path, .up = {}, .scale = {}, .transform = {}});
  }
  config.curve_tolerance = tolerance;
  return load_scene(config, context);
}

size_t count_kind(const PatchSet& set, EdgeBind bind) {
  size_t count = 0;
  for (const auto& four : set.edges) {
    for (const PatchEdge& edge : four) count += edge.bind == bind ? 1 : 0;
  }
  return count;
}

TEST(Zonel, AZoneIsNamedByRowAndColumn) {
  EXPECT_EQ(importer::zone_name(514), "3_AC");
  EXPECT_EQ(importer::zone_name(0), "1_AA");
  EXPECT_EQ(importer::zone_name(256 * 6 + 27), "7_BB");
}

TEST(Zonel, TwoZonesWithAllKindsOfNeighboursBecomeOneSurface) {
  const test::ScratchFolder folder;
  const auto zones = test::tiny_landscape();
  // Neighbours must not depend on the order of the files.
  for (const bool swapped : {false, true}) {
    const std::string a = folder.write("a.zonel", test::make_zonel(zones[swapped ? 1 : 0]));
    const std::string b = folder.write("b.zonel", test::make_zonel(zones[swapped ? 0 : 1]));
    const auto scene = load({a, b});
    ASSERT_TRUE(scene) << scene.error().message;
    const PatchSet& set = scene->patches;
    ASSERT_EQ(set.size(), 10u);
    EXPECT_EQ(count_kind(set, EdgeBind::kFour), 2u);
    EXPECT_EQ(count_kind(set, EdgeBind::kTwo), 1u);
    EXPECT_EQ(count_kind(set, EdgeBind::kPart), 10u);
    EXPECT_EQ(count_kind(set, EdgeBind::kOne), 12u);
    EXPECT_TRUE(scene->report.warnings.empty());
    for (const uint32_t component : patch_components(set)) EXPECT_EQ(component, 0u);
    EXPECT_EQ(set.runs[swapped ? 1 : 0].node, "3_AC");
    // All but one are flat, Z up: they lie in the plane y = 0, with normals up.
    const Box3d box = scene->bounds();
    EXPECT_EQ(box.min, (Vec3d{0, 0, -24}));
    EXPECT_EQ(box.max, (Vec3d{33, 3, 0}));
    EXPECT_EQ(set.patches[set.runs[swapped ? 1 : 0].first_patch].normal(0.5, 0.5),
              (Vec3d{0, 1, 0}));
    Context context;
    const auto mesh = tessellate_patches(set, {}, context);
    ASSERT_TRUE(mesh) << mesh.error().message;
    test::expect_watertight(set, *mesh);
    double area = 0;
    for (const auto& [i, j, k] : scene->triangles) {
      area += cross(scene->positions[j] - scene->positions[i],
                    scene->positions[k] - scene->positions[i])
                  .y /
              2;
    }
    EXPECT_NEAR(area, 4 * 144 + 4 * 9 + 2 * 36, 1e-9);
  }
}

TEST(Zonel, AFolderStandsForTheZonesInIt) {
  const test::ScratchFolder folder;
  const auto zones = test::tiny_landscape();
  const auto empty = load({folder.path()});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().message,
            folder.path() + ": is a folder without .zonel files; name a file inside it");
  folder.write("3_AC.zonel", test::make_zonel(zones[0]));
  folder.write("3_AD.ZONEL", test::make_zonel(zones[1]));
  folder.write("readme.txt", "not a zone");
  const auto scene = load({folder.path()});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->patches.size(), 10u);
}

TEST(Zonel, EdgesToAbsentZonesStayOpenAndAreCounted) {
  const test::ScratchFolder folder;
  const auto zones = test::tiny_landscape();
  const auto scene = load({folder.write("3_AC.zonel", test::make_zonel(zones[0]))});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->patches.size(), 6u);
  ASSERT_EQ(scene->report.warnings.size(), 1u);
  EXPECT_NE(scene->report.warnings[0].find("5 edges lead to zones that are not among the files"),
            std::string::npos);
}

TEST(Zonel, AllVersionsAreReadAlike) {
  const auto tiny = test::tiny_landscape()[0];
  const auto plain = kReader.read(test::make_zonel(tiny));
  ASSERT_TRUE(plain) << plain.error().message;
  for (const int version : {3, 4, 5}) {
    for (const int patch_version : {2, 3, 4, 5, 6, 7}) {
      for (const int connect_version : {0, 1}) {
        test::TinyZone zone = tiny;
        zone.version = static_cast<uint8_t>(version);
        zone.patch_version = static_cast<uint8_t>(patch_version);
        zone.connect_version = static_cast<uint8_t>(connect_version);
        const auto raw = kReader.read(test::make_zonel(zone));
        ASSERT_TRUE(raw) << raw.error().message;
        for (size_t p = 0; p < 6; ++p) {
          EXPECT_EQ(raw->scene.patches.patches[p].points, plain->scene.patches.patches[p].points);
        }
      }
    }
  }
}

TEST(Zonel, ControlPointsLandWhereTheyBelong) {
  test::TinyZone zone = test::tiny_landscape()[0];
  for (size_t i = 0; i < 16; ++i) {
    zone.patches[0].points[i] = {static_cast<double>(i), static_cast<double>(i * i), -5};
  }
  const auto raw = kReader.read(test::make_zonel(zone));
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(raw->scene.patches.patches[0].points, zone.patches[0].points);
}

TEST(Zonel, DamageIsNamedByItsPlace) {
  const auto tiny = test::tiny_landscape();
  const std::string whole = test::make_zonel(tiny[0]);
  EXPECT_EQ(kReader.fault_of(""),
            "3_AC.zonel: ends in its head (byte 0); the file is truncated or damaged, "
            "get it again");
  std::string bytes = whole;
  bytes[1] = 'B';
  EXPECT_EQ(kReader.fault_of(bytes),
            "3_AC.zonel: not a landscape zone: ZONE is missing from its head");
  bytes = whole;
  bytes[0] = 6;
  EXPECT_EQ(kReader.fault_of(bytes), "3_AC.zonel: zone of version 6; 3 to 5 are read");
  EXPECT_EQ(kReader.fault_of(whole + "x"),
            "3_AC.zonel: 1 bytes follow the last patch; the file is damaged");
  EXPECT_EQ(kReader.fault_of(whole.substr(0, whole.size() - 1)),
            "3_AC.zonel: ends in the neighbours of patch 5 of 6 (byte " +
                std::to_string(whole.size() - 1) +
                "); the file is truncated or damaged, get it again");
  // A wrong count: the border vertices begin at byte 52.
  bytes = whole;
  const int32_t many = 0x7fffffff;
  std::memcpy(bytes.data() + 52, &many, 4);
  EXPECT_NE(kReader.fault_of(bytes).find("ends in the border vertices"), std::string::npos);
  auto zone = tiny[0];
  zone.patch_version = 8;
  EXPECT_NE(
      kReader.fault_of(test::make_zonel(zone)).find("patch 0 of 6 (byte 75) has version 8; 2 to 7"),
      std::string::npos);
  zone = tiny[0];
  zone.binds[3][0].kind = 3;
  EXPECT_EQ(kReader.fault_of(test::make_zonel(zone)),
            "3_AC.zonel: edge 0 in the neighbours of patch 3 of 6 "
            "is of kind 3; kinds are 0, 1, 2, 4 and 5");
  zone = tiny[0];
  zone.binds[3][0].next[0] = 6;
  EXPECT_EQ(kReader.fault_of(test::make_zonel(zone)),
            "3_AC.zonel: edge 0 in the neighbours of patch 3 of 6 "
            "meets patch 6, and there are only 6");
  zone = tiny[0];
  zone.binds[3][2].edge[0] = 4;
  EXPECT_EQ(kReader.fault_of(test::make_zonel(zone)),
            "3_AC.zonel: edge 2 in the neighbours of patch 3 of 6 "
            "meets edge 4 of patch 0; edges are 0 to 3");
  zone = tiny[0];
  zone.scale = NAN;
  EXPECT_EQ(kReader.fault_of(test::make_zonel(zone)),
            "3_AC.zonel: its scale or bias is not a usable number");
}

TEST(Zonel, ZonesThatContradictEachOtherAreRefused) {
  const test::ScratchFolder folder;
  const auto tiny = test::tiny_landscape();
  const auto fault = [&](const test::TinyZone& west, const test::TinyZone& east) {
    const auto scene = load({folder.write("w.zonel", test::make_zonel(west)),
                             folder.write("e.zonel", test::make_zonel(east))});
    EXPECT_FALSE(scene);
    if (scene) return std::string();
    EXPECT_EQ(scene.error().code, Errc::kBadInput);
    const std::string& message = scene.error().message;
    return message.substr(message.find(".zonel") - 1);
  };
  EXPECT_NE(fault(tiny[0], tiny[0]).find("e.zonel: zone 3_AC was already read from"),
            std::string::npos);
  auto west = tiny[0];
  west.binds[5][2].next[0] = 9;
  EXPECT_EQ(
      fault(west, tiny[1]),
      "w.zonel: patch 5, edge 2: meets patch 9 of zone 3_AD, which has only 4; both files must "
      "come from one world");
  west = tiny[0];
  west.border.pop_back();
  EXPECT_EQ(fault(west, tiny[1]),
            "w.zonel: patch 5, edge 2: meets zone 3_AD at vertices that its border vertices do not "
            "pair; both files must come from one world");
  west = tiny[0];
  west.binds[2][2] = {};
  EXPECT_NE(fault(west, tiny[1]).find("does not name it in return; bind both"), std::string::npos);
  west = tiny[0];
  for (Vec3d& p : west.patches[5].points) p.z = 1;
  EXPECT_NE(fault(west, tiny[1]).find("lies 1 m from"), std::string::npos);
}

// The real landscape. The expected counts were made independently of this reader.
class NelLandscape : public testing::Test {
 protected:
  static std::string folder() { return std::string(THRONG_SHARED_WORLDS) + "/nel"; }
  void SetUp() override {
    if (!std::filesystem::is_directory(folder())) GTEST_SKIP() << "no shared worlds here";
  }
};

TEST_F(NelLandscape, HasTheNeighboursThatWereCounted) {
  const auto scene = load({folder()}, 0.5);
  ASSERT_TRUE(scene) << scene.error().message;
  const PatchSet& set = scene->patches;
  EXPECT_EQ(set.size(), 3692u);
  EXPECT_EQ(set.runs.size(), 96u);
  EXPECT_EQ(count_kind(set, EdgeBind::kOne), 14260u);
  EXPECT_EQ(count_kind(set, EdgeBind::kTwo), 81u);
  EXPECT_EQ(count_kind(set, EdgeBind::kFour), 0u);
  EXPECT_EQ(count_kind(set, EdgeBind::kPart), 162u);
  EXPECT_EQ(count_kind(set, EdgeBind::kOpen), 265u);
  EXPECT_TRUE(check_patches(set));  // All reciprocal, all in opposite directions.
  for (const uint32_t component : patch_components(set)) ASSERT_EQ(component, 0u);
  EXPECT_TRUE(scene->report.warnings.empty());

  // The zones lie in [320, 2880] x [-1280, -320], up is y. Their outer patches reach across that
  // border or fall short of it by up to 22 m; open edges farther in belong to embedded outcrops.
  size_t inside = 0;
  size_t overhanging = 0;
  for (uint32_t p = 0; p < set.size(); ++p) {
    overhanging += set.patches[p].normal(0.5, 0.5).y < 0 ? 1 : 0;
    for (uint32_t e = 0; e < 4; ++e) {
      if (set.edges[p][e].bind != EdgeBind::kOpen) continue;
      const auto curve = set.patches[p].edge(static_cast<int32_t>(e));
      const Vec3d middle = (curve[0] + curve[3]) * 0.5;
      const double depth = std::fmin(std::fmin(middle.x - 320, 2880 - middle.x),
                                     std::fmin(middle.z - 320, 1280 - middle.z));
      inside += depth > 22 ? 1 : 0;
    }
  }
  EXPECT_EQ(inside, 175u);
  EXPECT_NEAR(static_cast<double>(overhanging), 536, 1);  // One patch stands all but upright.
}

TEST_F(NelLandscape, HasNoCrackAndSharesWhatIsStoredTwice) {
  const auto scene = load({folder()}, 2);
  ASSERT_TRUE(scene) << scene.error().message;
  Context context;
  const auto mesh = tessellate_patches(scene->patches, {.tolerance = 2}, context);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_GE(test::expect_watertight(scene->patches, *mesh), 265u);
  // Across zones vertices are stored apart by up to 0.031 m; by index they are one.
  std::set<uint32_t> corners;
  for (const uint32_t corner : importer::weld_corners(scene->patches)) corners.insert(corner);
  std::vector<uint64_t> numbers{corners.size(), mesh->positions.size(), mesh->triangles.size()};
  for (const auto& t : mesh->triangles) numbers.insert(numbers.end(), t.begin(), t.end());
  EXPECT_EQ(hash_span(std::span<const uint64_t>(numbers)), 0x26faef06455719a0);
}

// Cuts and changes of a real file: the result is an error or a usable surface.
TEST_F(NelLandscape, SurvivesDamageToARealFile) {
  const auto whole = read_file(folder() + "/4_AE.zonel");
  ASSERT_TRUE(whole) << whole.error().message;
  uint64_t kept = 0;
  const auto use = [&](const std::string& bytes) {
    const auto raw = kReader.read(bytes);
    if (!raw) {
      EXPECT_EQ(raw.error().message.rfind("3_AC.zonel: ", 0), 0u) << raw.error().message;
      return;
    }
    PatchSet set = raw->scene.patches;
    SceneReport report;
    std::vector<importer::PatchZone> zones{*raw->zone};
    EXPECT_TRUE(importer::join_zones(set, zones, report));
    Context context;
    const auto mesh = tessellate_patches(set, {.tolerance = 1}, context);
    if (mesh) ++kept;
    if (!mesh) {
      EXPECT_FALSE(mesh.error().message.empty());
    }
  };
  for (uint64_t i = 0; i < 300; ++i) use(whole->substr(0, random_below(3, i, 0, whole->size())));
  EXPECT_EQ(kept, 0u);  // Only a complete file is a zone.
  for (uint64_t i = 0; i < 600; ++i) {
    std::string bytes = *whole;
    const uint64_t changes = 1 + random_below(4, i, 0, 4);
    for (uint64_t k = 0; k < changes; ++k) {
      // Half of them in the last tenth, which lists the neighbours.
      const size_t from = random_below(4, i, 3 * k + 1, 2) == 0 ? 0 : bytes.size() / 10 * 9;
      bytes[from + random_below(4, i, 3 * k + 2, bytes.size() - from)] =
          static_cast<char>(random_below(4, i, 3 * k + 3, 256));
    }
    use(bytes);
  }
  EXPECT_GT(kept, 100u);
}

}  // namespace
}  // namespace throng
