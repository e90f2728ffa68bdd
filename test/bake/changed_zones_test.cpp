// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "folder_bytes.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/scene.h"
#include "throng/surface.h"

// A bake into the folder of a world: what has changed is baked, the rest is reused, and the bytes
// are those of a new bake.
namespace throng {
namespace {

namespace fs = std::filesystem;
using Folder = test::FolderBytes;
using test::folder_bytes;

constexpr double kZone = 12.8;  // [m]
const BakeConfig kConfig{.cell = 0.2, .zone = kZone};

// Five by four zones of ground in patches of 3.2 m, with a wall here and there. The ground begins
// at a corner of a cell (15/32 of one), so that zone (x, z) begins at (x, z) * kZone + corner.
constexpr double kCorner = 0.2 * 15 / 32;
Scene field() {
  Scene scene;
  for (int z = 0; z < 16; ++z) {
    for (int x = 0; x < 20; ++x) {
      const double x0 = kCorner + 3.2 * x, z0 = kCorner + 3.2 * z;
      scene.add_quad({x0, 0, z0}, {x0, 0, z0 + 3.2}, {x0 + 3.2, 0, z0 + 3.2}, {x0 + 3.2, 0, z0});
      if ((x * 7 + z * 3) % 11 == 0) scene.add_box({x0 + 1, 0, z0 + 1}, {x0 + 1.4, 2, z0 + 2.5});
    }
  }
  return scene;
}

class ChangedZones : public testing::Test {
 protected:
  BakeReport bake(const std::string& name, const Scene& scene, const BakeConfig& config = kConfig) {
    Context context;
    const auto report = bake_world_to(at(name), scene, config, context);
    EXPECT_TRUE(report) << report.error().message;
    const auto world = World::open(at(name));
    EXPECT_TRUE(world && world->check_all());
    EXPECT_FALSE(fs::exists(at(name) + ".part"));
    EXPECT_FALSE(fs::exists(at(name) + "/journal"));
    return report ? *report : BakeReport{};
  }
  [[nodiscard]] std::string at(const std::string& name) const {
    return folder_.path() + "/" + name;
  }

  // What a bake says that is refused, which touches nothing.
  std::string refused(const std::string& name, const Scene& scene, const BakeConfig& config) {
    const auto files = [&] {
      std::set<std::string> found;
      for (const auto& file : fs::recursive_directory_iterator(folder_.path())) {
        found.insert(file.path().string());
      }
      return found;
    };
    const auto before = files();
    Context context;
    const auto report = bake_world_to(at(name), scene, config, context);
    EXPECT_EQ(files(), before);
    EXPECT_FALSE(report);
    return report ? "" : report.error().message;
  }

  test::ScratchFolder folder_;
};

TEST_F(ChangedZones, NothingChangedNothingIsBaked) {
  const BakeReport first = bake("w", field());
  EXPECT_EQ(first.zones_baked, 20u);
  EXPECT_EQ(first.zones_reused, 0u);
  const Folder before = folder_bytes(at("w"));
  const BakeReport second = bake("w", field());
  EXPECT_EQ(second.zones_baked, 0u);
  EXPECT_EQ(second.zones_reused, 20u);
  EXPECT_EQ(first.zones_relinked, 20u);
  EXPECT_EQ(second.zones_relinked, 0u);
  EXPECT_EQ(second.graph_bytes, first.graph_bytes);
  EXPECT_EQ(folder_bytes(at("w")), before);
  EXPECT_EQ(second.walkable_area, first.walkable_area);
  EXPECT_EQ(second.constant_level_tiles, first.constant_level_tiles);
  EXPECT_EQ(second.tiles, first.tiles);
  EXPECT_EQ(second.bytes, first.bytes);
}

TEST_F(ChangedZones, EmptyZonesAreCountedApart) {
  Scene scene = field();
  scene.add_triangle({90, 0, 20}, {90, 5, 20}, {95, 5, 20});  // Upright, where no ground is.
  for (const uint64_t baked : {20, 0}) {
    const BakeReport report = bake("w", scene);
    EXPECT_EQ(report.zones, 20u);
    EXPECT_EQ(report.zones, World::open(at("w"))->summary().zones);
    EXPECT_EQ(report.zones_baked, baked);
    EXPECT_EQ(report.zones_reused, 20 - baked);
    EXPECT_EQ(report.zones_relinked, baked);
    EXPECT_EQ(report.zones_empty, 6u);  // Two near that one, and four beside the ground's end.
  }
}

TEST_F(ChangedZones, AirIsBakedAgainWhereItChanged) {
  BakeConfig config = kConfig;
  config.air = 0.4;
  Scene scene = field();
  const BakeReport first = bake("w", scene, config);
  EXPECT_EQ(first.air_zones, 20u);
  EXPECT_EQ(first.air_zones_reused, 0u);
  EXPECT_EQ(bake("w", scene, config).air_zones_reused, first.air_zones);
  // A beam in the middle of zone (2, 1), within the heights that the air has.
  scene.add_box({kCorner + 2.4 * kZone, 1, kCorner + 1.4 * kZone},
                {kCorner + 2.6 * kZone, 1.5, kCorner + 1.6 * kZone});
  const BakeReport touched = bake("w", scene, config);
  EXPECT_EQ(touched.air_zones, first.air_zones);
  EXPECT_EQ(touched.air_zones_reused, first.air_zones - 1);
  bake("fresh", scene, config);
  EXPECT_EQ(folder_bytes(at("w")), folder_bytes(at("fresh")));
}

// Zones whose area, widened by `apron`, meets the box. [m]
uint64_t zones_near(const Box3d& box, double apron) {
  uint64_t count = 0;
  for (int z = 0; z < 4; ++z) {
    for (int x = 0; x < 5; ++x) {
      const double x0 = kCorner + x * kZone, z0 = kCorner + z * kZone;
      count += box.max.x >= x0 - apron && box.min.x <= x0 + kZone + apron &&
                       box.max.z >= z0 - apron && box.min.z <= z0 + kZone + apron
                   ? 1
                   : 0;
    }
  }
  return count;
}

TEST_F(ChangedZones, ATouchedTriangleIsBakedWhereItIsSeenAndNowhereElse) {
  struct Touch {
    double x, z, wide, deep;
    uint64_t zones;  // by hand
    uint64_t links;  // zones whose links are made again: these, and those to the west and north
  };
  for (const Touch& touch : {Touch{6, 6, 0.5, 0.5, 1, 1}, Touch{12.4, 6, 0.2, 0.2, 2, 2},
                             Touch{12.5, 12.5, 0.3, 0.3, 4, 4}, Touch{20, 20, 0.5, 12, 2, 5},
                             Touch{3, 30, 58, 0.5, 5, 10}, Touch{30, 45, 1, 1, 1, 3}}) {
    Scene scene = field();
    bake("w", scene);
    const double x1 = touch.x + touch.wide, z1 = touch.z + touch.deep;
    Box3d box;
    box.add({touch.x, 0, touch.z});
    box.add({x1, 0, z1});
    // Half a metre around and two metres around lie the same zones.
    ASSERT_EQ(zones_near(box, 0.5), touch.zones);
    ASSERT_EQ(zones_near(box, 2.5), touch.zones);
    scene.add_triangle({touch.x, 1, touch.z}, {touch.x, 1, z1}, {x1, 1, touch.z});
    const BakeReport report = bake("w", scene);
    EXPECT_EQ(report.zones_baked, touch.zones) << touch.x << ", " << touch.z;
    EXPECT_EQ(report.zones_reused, 20 - touch.zones);
    EXPECT_EQ(report.zones_relinked, touch.links) << touch.x << ", " << touch.z;
    bake("new", scene, {.cell = 0.2, .zone = kZone, .old_zones = OldZones::kBakeAgain});
    EXPECT_EQ(folder_bytes(at("w")), folder_bytes(at("new")));
  }
}

// Which files a touched triangle changes: the others are the old ones, linked.
TEST_F(ChangedZones, ATouchedTriangleLeavesAllOtherFilesAsTheyAre) {
  Scene scene = field();
  bake("w", scene);
  fs::copy(at("w"), at("old"), fs::copy_options::recursive | fs::copy_options::create_hard_links);
  scene.add_triangle({30, 1, 45}, {30, 1, 46}, {31, 1, 45});  // zone (2, 3)
  bake("w", scene);
  std::set<std::string> made;
  for (const auto& entry : fs::directory_iterator(at("w"))) {
    const std::string name = entry.path().filename().string();
    if (!fs::equivalent(entry.path(), at("old") + "/" + name)) made.insert(name);
  }
  EXPECT_EQ(made,
            (std::set<std::string>{"manifest.thm", "graph.thm", "zone_2_3.thz", "zone_2_3.thr",
                                   "zone_2_3.thl", "zone_1_3.thl", "zone_2_2.thl"}));
}

// The ground is the same to the millimetre, but a class steps higher: other links.
TEST_F(ChangedZones, AnotherStepMakesOtherRegions) {
  bake("w", field());
  BakeConfig config = kConfig;
  for (AvatarClass& avatar : config.classes) avatar.step_height *= 0.9;
  EXPECT_EQ(bake("w", field(), config).zones_relinked, 20u);
  bake("new", field(), config);
  EXPECT_EQ(folder_bytes(at("w")), folder_bytes(at("new")));
}

// What is under the ground affects no class: the zone is baked, its bytes are the same.
TEST_F(ChangedZones, ATriangleThatChangesNothingRelinksNothing) {
  Scene scene = field();
  bake("w", scene);
  const Folder before = folder_bytes(at("w"));
  const double x0 = kCorner + 3.2 * 2, z0 = kCorner;
  scene.add_quad({x0, 0, z0}, {x0, 0, z0 + 3.2}, {x0 + 3.2, 0, z0 + 3.2}, {x0 + 3.2, 0, z0});
  const BakeReport report = bake("w", scene);
  EXPECT_EQ(report.zones_baked, 1u);
  EXPECT_EQ(report.zones_relinked, 0u);
  Folder after = folder_bytes(at("w"));
  EXPECT_EQ(after["zone_0_0.thz"], before.at("zone_0_0.thz"));
  EXPECT_NE(after["manifest.thm"], before.at("manifest.thm"));
}

// Files of regions and links are believed as far as they go: they carry their input and a sum.
TEST_F(ChangedZones, ABakeKilledBetweenItsPassesGoesOn) {
  bake("w", field());
  const Folder whole = folder_bytes(at("w"));
  for (const char* left : {".thz", ".thr", ".thl"}) {  // How far it came.
    fs::rename(at("w"), at("w.part"));
    fs::remove(at("w.part/manifest.thm"));
    fs::remove(at("w.part/graph.thm"));
    for (const auto& [name, bytes] : whole) {
      const bool links = name.ends_with(".thl"), regions = name.ends_with(".thr");
      if ((links && left != std::string(".thl")) || (regions && left == std::string(".thz"))) {
        fs::remove(at("w.part/") + name);
      }
    }
    std::ofstream(at("w.part/zone_1_1.thr.part"), std::ios::binary) << "half";
    fs::remove(at("w.part/zone_1_1.thl"));
    std::ofstream(at("w.part/zone_1_1.thl"), std::ios::binary) << whole.at("zone_1_1.thr");
    const BakeReport report = bake("w", field());
    EXPECT_EQ(report.zones_baked, 20u);  // No journal: the ground is baked again.
    EXPECT_EQ(report.zones_relinked, left == std::string(".thl") ? 1u : 20u);
    EXPECT_EQ(folder_bytes(at("w")), whole);
  }
}

TEST_F(ChangedZones, AnotherClassCellOrResolutionBakesAll) {
  bake("w", field());
  BakeConfig config = kConfig;
  config.classes[0].step_height += 0.01;
  EXPECT_EQ(bake("w", field(), config).zones_baked, 20u);
  EXPECT_EQ(bake("w", field(), config).zones_baked, 0u);
  config.classes[0].speed += 1;  // Of no zone's business.
  EXPECT_EQ(bake("w", field(), config).zones_baked, 0u);
  config.classes.pop_back();
  EXPECT_EQ(bake("w", field(), config).zones_baked, 20u);
  config.resolution = 0.05;
  EXPECT_EQ(bake("w", field(), config).zones_baked, 20u);
  config.cell = 0.25;
  EXPECT_EQ(bake("w", field(), config).zones_reused, 0u);
  config.old_zones = OldZones::kBakeAgain;
  EXPECT_EQ(bake("w", field(), config).zones_reused, 0u);
}

TEST_F(ChangedZones, AnotherResolutionChangesNoZone) {
  BakeConfig config = kConfig;
  Scene scene = field();
  // A ceiling that leaves an adult (1.75 m) 5 cm: a loss of 0.5 m would close the ground below.
  scene.add_box({3, 1.8, 3}, {9, 2.5, 9});
  config.resolution = 0.001;
  bake("fine", scene, config);
  config.resolution = 0.5;
  bake("coarse", scene, config);
  Folder fine = folder_bytes(at("fine")), coarse = folder_bytes(at("coarse"));
  EXPECT_EQ(World::open(at("fine"))->summary().resolution, 0.001);
  EXPECT_EQ(World::open(at("coarse"))->summary().resolution, 0.5);
  for (const std::string name : {"manifest.thm", "graph.thm"}) {  // The graph names its manifest.
    EXPECT_NE(fine.at(name), coarse.at(name));
    fine.erase(name);
    coarse.erase(name);
  }
  EXPECT_GT(fine.size(), 20u);  // Zones, their regions and links.
  EXPECT_EQ(fine, coarse);
}

TEST_F(ChangedZones, AnotherAreaKindIsBaked) {
  Scene scene = field();
  bake("w", scene);
  scene.area.assign(scene.triangles.size(), kAreaWalkable);
  EXPECT_EQ(bake("w", scene).zones_baked, 0u);
  scene.area[0] = 9;  // A new kind renumbers the surfaces of the whole scene.
  EXPECT_EQ(bake("w", scene).zones_baked, 1u);
  bake("new", scene);
  EXPECT_EQ(folder_bytes(at("w")), folder_bytes(at("new")));
}

TEST_F(ChangedZones, TheGridStaysWhereItWasIfTheRimMovesInOrTheFarSideOut) {
  Scene scene = field();
  bake("w", scene);
  scene.add_quad({-20, 0, -20}, {-20, 0, -19}, {-19, 0, -19}, {-19, 0, -20});
  EXPECT_EQ(bake("w", scene).zones_reused, 0u);  // It begins before the grid: another grid.
  const Folder wide = folder_bytes(at("w"));
  const BakeReport back = bake("w", field());  // The scene still begins on that grid.
  EXPECT_EQ(back.zones_reused, back.zones_baked + back.zones_reused);
  EXPECT_GT(back.zones_reused, 20u);
  EXPECT_LT(folder_bytes(at("w")).size(), wide.size());  // The island's zone is gone.

  Scene far = field();
  far.add_quad({90, 0, 6}, {90, 0, 7}, {91, 0, 7}, {91, 0, 6});
  const BakeReport more = bake("w", far);
  EXPECT_GT(more.zones_reused, 10u);
  EXPECT_GT(more.zones_baked, 0u);

  // Grown on the far side only, it is the world of an empty folder.
  bake("v", field());
  far.add_quad({64, 0, 0.5}, {64, 0, 51}, {80, 0, 51}, {80, 0, 0.5});
  EXPECT_GT(bake("v", far).zones_reused, 10u);
  bake("new", far);
  EXPECT_EQ(folder_bytes(at("v")), folder_bytes(at("new")));
  fs::remove_all(at("new"));

  // A scene that shares no zone gets the grid that it would get in an empty folder.
  Scene other;
  other.add_quad({1.3, 0, 1.3}, {1.3, 0, 9}, {9, 0, 9}, {9, 0, 1.3});
  EXPECT_EQ(bake("w", other).zones_reused, 0u);
  bake("new", other);
  EXPECT_EQ(folder_bytes(at("w")), folder_bytes(at("new")));
}

TEST_F(ChangedZones, DamagedZonesAndManifestsAreBakedAgain) {
  bake("w", field());
  const Folder whole = folder_bytes(at("w"));
  std::ofstream(at("w") + "/zone_1_1.thz", std::ios::binary) << "no zone";
  fs::remove(at("w") + "/zone_2_1.thz");
  EXPECT_EQ(bake("w", field()).zones_baked, 2u);
  EXPECT_EQ(folder_bytes(at("w")), whole);
  Scene other = field();
  other.add_box({20, 0, 20}, {21, 1, 21});
  bake("other", other);
  fs::copy_file(at("other") + "/zone_1_1.thz", at("w") + "/zone_1_1.thz",
                fs::copy_options::overwrite_existing);  // Sound, but of another bake.
  EXPECT_EQ(bake("w", field()).zones_baked, 1u);
  EXPECT_EQ(folder_bytes(at("w")), whole);
  std::ofstream(at("w") + "/manifest.thm", std::ios::binary) << "no manifest";
  EXPECT_EQ(bake("w", field()).zones_baked, 20u);
  EXPECT_EQ(folder_bytes(at("w")), whole);
}

TEST_F(ChangedZones, AJournalIsBelievedAsFarAsItsFilesAre) {
  bake("w", field());
  const Folder whole = folder_bytes(at("w"));
  for (const std::string& name :
       {std::string("junk"), std::string(47, '\0'), std::string(4800, 7)}) {
    fs::rename(at("w"), at("v"));
    fs::create_directories(at("w.part"));
    std::ofstream(at("w.part/journal"), std::ios::binary) << name;
    std::ofstream(at("w.part/zone_0_0.thz"), std::ios::binary) << name;
    std::ofstream(at("w.part/zone_9_9.thz"), std::ios::binary) << name;
    EXPECT_EQ(bake("w", field()).zones_baked, 20u);
    EXPECT_EQ(folder_bytes(at("w")), whole);
    fs::remove_all(at("v"));
  }
}

TEST_F(ChangedZones, ASecondBakeIntoAFolderIsRefusedWhileTheFirstIsAtWork) {
  const std::string busy = at("w") +
                           ": another bake is writing it; wait until that has ended, or "
                           "write into another folder";
  BakeConfig fresh = kConfig;
  fresh.old_zones = OldZones::kBakeAgain;
  for (const bool is_there : {false, true}) {
    for (const BakeConfig& config : {kConfig, fresh}) {
      int tried = 0;
      Context context;
      context.on_progress = [&](const Progress& progress) {
        if (progress.done != 1 || tried++ > 0) return;
        EXPECT_EQ(refused("w", field(), config), busy);
        EXPECT_EQ(refused("w/", field(), config), busy);
      };
      if (!is_there) fs::remove_all(at("w"));
      const auto report =
          bake_world_to(at("w"), field(), {.cell = 0.25, .zone = 16, .workers = 1}, context);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_GT(tried, 0);
      EXPECT_TRUE(World::open(at("w"))->check_all());
    }
  }
}

TEST_F(ChangedZones, WhileNodesAreMadeTheirWorldCannotBeReplaced) {
  const NodeConfig wanted;
  BakeConfig config = kConfig;
  config.nodes = &wanted;
  const Scene scene = field();
  Context context;
  auto report = bake_world_to(at("w"), scene, config, context);
  ASSERT_TRUE(report) << report.error().message;
  const std::string busy = ": another bake is writing it";
  EXPECT_NE(refused("w", scene, kConfig).find(busy), std::string::npos);  // Held for them.
  const auto world = World::open(at("w"));
  ASSERT_TRUE(world);
  for (const bool held : {true, false}) {
    if (!held) report->hold.reset();
    int tried = 0;
    context.on_progress = [&](const Progress&) {
      if (tried++ > 0) return;
      EXPECT_NE(refused("w", scene, kConfig).find(busy), std::string::npos);
      Context inner;
      const auto nodes = Nodes::create_in_folder(*world, scene, wanted, inner);
      ASSERT_FALSE(nodes);
      EXPECT_NE(nodes.error().message.find(busy), std::string::npos) << nodes.error().message;
    };
    NodeConfig again = wanted;
    again.rebuild = true;
    const auto nodes = Nodes::create_in_folder(*world, scene, again, context);
    ASSERT_TRUE(nodes) << nodes.error().message;
    EXPECT_GT(tried, 0);
  }
  EXPECT_EQ(bake("w", scene).zones_reused, 20u);
}

}  // namespace
}  // namespace throng
