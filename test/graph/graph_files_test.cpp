// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/scene.h"
#include "throng/world.h"
#include "whole_graph.h"
#include "world/place.h"
#include "world/region_data.h"
#include "worlds.h"

// The graph that a bake leaves on disk, zone by zone, against one made of the whole world at once.
namespace throng {
namespace {

namespace fs = std::filesystem;
using test::builtin;
using test::WholeGraph;

class GraphOnDisk : public testing::Test {
 protected:
  World bake(const Scene& scene, const BakeConfig& config) {
    Context context;
    const auto report = bake_world_to(path(), scene, config, context);
    EXPECT_TRUE(report) << report.error().message;
    if (report) report_ = *report;
    return open();
  }
  [[nodiscard]] World open(const WorldConfig& config = {}) const {
    const auto world = World::open(path(), config);
    EXPECT_TRUE(world) << world.error().message;
    return world ? *world : World{};
  }
  [[nodiscard]] std::string path() const { return folder_.path() + "/w.throng"; }
  [[nodiscard]] std::string file(const std::string& name) const { return path() + "/" + name; }

  test::ScratchFolder folder_;
  BakeReport report_;
};

Result<Graph> make(const World& world) {
  Context context;
  return Graph::create(world, {}, context);
}

template <class File>
std::unique_ptr<File> read(const std::string& name) {
  auto map = FileMap::open(name);
  EXPECT_TRUE(map) << name;
  auto file = File::from_file(std::move(*map), name);
  EXPECT_TRUE(file) << file.error().message;
  return std::move(*file);
}

std::string read_text(const std::string& name) {
  std::ifstream in(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_text(const std::string& name, const std::string& bytes) {
  fs::remove(name);  // It may be linked elsewhere.
  std::ofstream(name, std::ios::binary) << bytes;
}

// Regions, links and components of the files of a world, put together, are those of the oracle.
// Returns how many links lead over borders.
size_t expect_whole(const World& opened, const std::string& path) {
  const world::WorldData& world = *data_of(opened);
  const WholeGraph whole = test::whole_graph(opened);
  std::vector<std::unique_ptr<world::RegionZone>> zones;
  std::vector<uint32_t> base{0};
  for (const auto& slot : world.slots) {
    zones.push_back(read<world::RegionZone>(
        path + "/" + world::region_file_name(slot->entry.x(), slot->entry.z())));
    base.push_back(base.back() + static_cast<uint32_t>(zones.back()->regions().size()));
  }
  EXPECT_EQ(base.back(), whole.regions.size());
  if (base.back() != whole.regions.size()) return 0;
  size_t wrong = 0, over = 0;
  std::vector<graph::RegionLink> links;
  for (size_t s = 0; s < zones.size(); ++s) {
    const auto regions = zones[s]->regions();
    for (uint32_t level = 0; level < zones[s]->level_count(); ++level) {
      const auto [first, last] = zones[s]->level_regions(level);
      for (uint32_t r = first; r < last; ++r) {
        const graph::Region& same = whole.regions[base[s] + r];
        wrong += level + world.slots[s]->first_level != same.level ||
                 regions[r].classes() != same.classes || regions[r].key() != same.key;
      }
    }
    const auto add = [&](std::span<const format::RegionLink> found, size_t to) {
      for (const format::RegionLink& link : found) {
        links.push_back({link.a() + base[s], link.b() + base[to], link.classes()});
      }
    };
    add(zones[s]->links(), s);
    const auto& entry = world.slots[s]->entry;
    const auto between =
        read<world::LinkZone>(path + "/" + world::link_file_name(entry.x(), entry.z()));
    const auto next = [&](int32_t x, int32_t z) {
      return static_cast<size_t>(std::max(world::slot_at(world, x, z), 0));
    };
    add(between->east(), next(entry.x() + 1, entry.z()));
    add(between->south(), next(entry.x(), entry.z() + 1));
    over += between->east().size() + between->south().size();
  }
  EXPECT_EQ(wrong, 0u);
  graph::merge_links(links);
  EXPECT_EQ(links.size(), whole.links.size());
  for (size_t i = 0; i < std::min(links.size(), whole.links.size()); ++i) {
    wrong += links[i].a != whole.links[i].a || links[i].b != whole.links[i].b ||
             links[i].classes != whole.links[i].classes;
  }
  EXPECT_EQ(wrong, 0u);

  const auto graph = make(opened);
  EXPECT_TRUE(graph) << graph.error().message;
  if (!graph) return 0;
  EXPECT_TRUE(graph->summary().on_disk);
  EXPECT_EQ(graph->summary().regions, whole.regions.size());
  EXPECT_EQ(graph->summary().links, whole.links.size());
  for (size_t c = 0; c < whole.components.size(); ++c) {
    const auto found = graph->components(static_cast<int32_t>(c));
    EXPECT_EQ(found.size(), whole.components[c].size());
    for (size_t i = 0; i < std::min(found.size(), whole.components[c].size()); ++i) {
      const WholeGraph::Component& same = whole.components[c][i];
      const double cell = world.summary.cell;
      wrong += found[i].area != static_cast<double>(same.cells) * (cell * cell) ||
               found[i].regions != same.regions ||
               found[i].place.level1 != whole.regions[same.first_region].level + 1;
      const auto name = graph->component_at(static_cast<int32_t>(c), found[i].place);
      wrong += name != static_cast<int32_t>(i);
    }
    // Every region, at its key.
    for (uint32_t r = 0; r < whole.regions.size(); ++r) {
      if (whole.component[c][r] < 0) continue;
      const graph::Region& region = whole.regions[r];
      const world::GroundLevel level = world::ground_level(world, region.level, 0);
      const auto [tile_x, tile_z] = world::tile_of(world, *level.zone, *level.view.record);
      const auto middle = [](int32_t tile, uint32_t cell) {
        return ((int64_t{tile} * 64 + cell) << world::kUnitBits) + world::kUnitsPerCell / 2;
      };
      const Place place = world::place_at(
          world, level, {middle(tile_x, region.key % 64), middle(tile_z, region.key / 64)});
      wrong += graph->component_at(static_cast<int32_t>(c), place) != whole.component[c][r];
    }
  }
  EXPECT_EQ(wrong, 0u);
  return over;
}

TEST_F(GraphOnDisk, AreTheGraphOfTheWholeWorldOnAllBuiltinWorlds) {
  for (const BuiltinWorldInfo& info : builtin_worlds()) {
    SCOPED_TRACE(std::string(info.name));
    BuiltinWorldConfig config{.name = std::string(info.name)};
    if (info.name == "city") config.size = 250;
    if (info.name == "landscape") config.size = 120;
    if (info.name == "blocks") config.size = 100;
    if (info.name == "garage" || info.name == "maze") config.levels = 2;
    if (info.name == "maze") config.size = 40;
    const World world = bake(builtin(config), {.cell = 0.25, .zone = 16});
    const size_t over = expect_whole(world, path());
    EXPECT_TRUE(over > 0 || world.summary().zones == 1) << over;
  }
}

// Floors, ramps and walls at random heights, many over each other.
Scene random_floors(uint64_t seed) {
  Scene scene;
  for (uint64_t i = 0; i < 160; ++i) {
    const auto draw = [&](uint64_t n) { return random_unit(seed, i, n); };
    const double x = 36 * draw(0), z = 36 * draw(1), y = 0.4 * static_cast<int>(8 * draw(2));
    const double wide = 0.5 + 12 * draw(3) * draw(3), deep = 0.5 + 12 * draw(4) * draw(4);
    const double rise = draw(5) < 0.3 ? 1.5 * draw(6) : 0;
    if (draw(7) < 0.15) {
      scene.add_box({x, y, z}, {x + 0.3, y + 2 * draw(6), z + deep});
    } else {
      scene.add_quad({x, y, z}, {x, y, z + deep}, {x + wide, y + rise, z + deep},
                     {x + wide, y + rise, z});
    }
  }
  return scene;
}

TEST_F(GraphOnDisk, AreTheGraphOfTheWholeWorldOnRandomFloors) {
  auto classes = default_classes();
  classes.push_back(classes[0]);
  classes.back().name = "crawler";
  classes.back().height = 0.8;
  size_t over = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const double zone = seed % 2 == 0 ? 6.4 : 12.8;
    over += expect_whole(bake(random_floors(seed), {.cell = 0.1, .zone = zone, .classes = classes}),
                         path());
  }
  EXPECT_GT(over, 1000u);
}

TEST_F(GraphOnDisk, AreReadOnlyWhereSomethingIsAsked) {
  bake(builtin({.name = "city", .size = 200}), {.cell = 0.25, .zone = 32});
  const World world = open({.resident_bytes = uint64_t{1} << 40});
  const auto graph = make(world);
  ASSERT_TRUE(graph);
  EXPECT_TRUE(graph->summary().on_disk);
  ASSERT_GT(graph->components(0).size(), 1u);
  EXPECT_EQ(world.residency().zones, 0u);
  EXPECT_EQ(graph->component_at(0, graph->components(0)[0].place), 0);
  EXPECT_EQ(world.residency().zones, 1u);
}

TEST_F(GraphOnDisk, WithoutThemTheGraphIsMadeInMemoryAndTheSame) {
  bake(builtin({.name = "garage", .size = 45, .levels = 2}), {.cell = 0.2, .zone = 25.6});
  const auto on_disk = make(open());
  ASSERT_TRUE(on_disk);
  const std::string bare = folder_.path() + "/bare.throng";
  fs::copy(path(), bare);
  fs::remove(bare + "/" + world::kGraphIndexName);
  for (const auto& entry : fs::directory_iterator(path())) {
    const std::string kind = entry.path().extension().string();
    if (kind == ".thr" || kind == ".thl") fs::remove(bare / entry.path().filename());
  }
  const auto opened = World::open(bare);
  ASSERT_TRUE(opened);
  const World& world = *opened;
  const auto made = make(world);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made->summary().on_disk);
  EXPECT_TRUE(Graph::check_files(world));
  EXPECT_EQ(made->summary().regions, on_disk->summary().regions);
  EXPECT_EQ(made->summary().links, on_disk->summary().links);
  for (int32_t c = 0; c < 4; ++c) {
    const auto a = made->components(c), b = on_disk->components(c);
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].area, b[i].area);
      EXPECT_EQ(a[i].regions, b[i].regions);
      EXPECT_EQ(a[i].place.level1, b[i].place.level1);
      EXPECT_EQ(a[i].place.position.x, b[i].place.position.x);
      EXPECT_EQ(a[i].place.position.y, b[i].place.position.y);
      EXPECT_EQ(a[i].place.position.z, b[i].place.position.z);
    }
    for (uint64_t n = 0; n < 300; ++n) {
      const Place place = world.random_place(c, 7, n);
      EXPECT_EQ(made->component_at(c, place), on_disk->component_at(c, place));
    }
  }
}

TEST_F(GraphOnDisk, AreTheSameBytesForAnyNumberOfThreads) {
  std::map<std::string, std::string> first;
  for (const int32_t workers : {1, 2, 3, 8}) {
    bake(builtin({.name = "garage", .size = 45, .levels = 2}),
         {.cell = 0.2, .zone = 25.6, .workers = workers, .old_zones = OldZones::kBakeAgain});
    EXPECT_EQ(report_.zones_relinked, report_.zones);
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::directory_iterator(path())) {
      all[entry.path().filename().string()] = read_text(entry.path().string());
    }
    if (first.empty()) first = all;
    EXPECT_EQ(all, first) << workers;
  }
}

// Which file of a zone in the middle of the world.
class DamagedGraphFile : public GraphOnDisk, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    bake(builtin({.name = "city", .size = 100}), {.cell = 0.25, .zone = 32});
    name_ = file(GetParam());
    whole_ = read_text(name_);
    ASSERT_FALSE(whole_.empty());
    const auto graph = make(open());
    ASSERT_TRUE(graph && Graph::check_files(open()));
  }
  // The error of a read that touches it; empty if there is none.
  [[nodiscard]] std::string said() const {
    const World world = open();
    const auto graph = make(world);
    if (!graph) return graph.error().message;
    const auto checked = Graph::check_files(world);
    if (name_.ends_with(".thr")) {
      const Vec3d inside = world.summary().origin + Vec3d{1.5 * 32, 0, 1.5 * 32};
      EXPECT_EQ(static_cast<bool>(graph->check_at(inside)), static_cast<bool>(checked));
      const Place place = world.find_place(0, inside, 100);
      if (!checked) {
        EXPECT_EQ(graph->component_at(0, place), -1);
      }
    }
    return checked ? "" : checked.error().message;
  }

  std::string name_, whole_;
};

TEST_P(DamagedGraphFile, IsRefusedByName) {
  size_t refused = 0;
  const auto expect_named = [&](const std::string& what) {
    const std::string why = said();
    EXPECT_NE(why.find(name_), std::string::npos) << what << ": " << why;
    EXPECT_NE(why.find("bake the world again"), std::string::npos) << why;
    ++refused;
  };
  for (const size_t size :
       {size_t{0}, size_t{1}, size_t{7}, whole_.size() / 2, whole_.size() - 1}) {
    write_text(name_, whole_.substr(0, size));
    expect_named("cut to " + std::to_string(size));
  }
  for (uint64_t n = 0; n < 60; ++n) {
    std::string bytes = whole_;
    const size_t at = random_below(5, n, 0, bytes.size());
    bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + random_below(5, n, 1, 255)));
    write_text(name_, bytes);
    // The index has no list with its checksum: what fills it up may change.
    if (name_.ends_with(world::kGraphIndexName) && said().empty()) continue;
    expect_named("flipped at " + std::to_string(at));
  }
  EXPECT_GT(refused, 50u);
  write_text(name_, whole_);
  EXPECT_EQ(said(), "");
}

TEST_P(DamagedGraphFile, OfAnotherBakeIsRefusedByName) {
  fs::rename(path(), folder_.path() + "/here");
  Scene other = builtin({.name = "city", .size = 100, .seed = 2});
  bake(other, {.cell = 0.25, .zone = 32});
  const std::string of_another = read_text(name_);
  fs::remove_all(path());
  fs::rename(folder_.path() + "/here", path());
  ASSERT_NE(of_another, whole_);
  write_text(name_, of_another);
  EXPECT_NE(said().find(name_), std::string::npos) << said();
}

TEST_P(DamagedGraphFile, IsMadeAgainByTheNextBake) {
  for (const std::string& bytes : {whole_.substr(0, 40), std::string()}) {
    write_text(name_, bytes);
    if (bytes.empty()) fs::remove(name_);
    bake(builtin({.name = "city", .size = 100}), {.cell = 0.25, .zone = 32});
    EXPECT_EQ(report_.zones_baked, 0u);
    EXPECT_EQ(report_.zones_relinked, name_.ends_with(".thl") ? 1u : 0u);
    EXPECT_EQ(read_text(name_), whole_);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, DamagedGraphFile,
                         testing::Values("zone_1_1.thr", "zone_1_1.thl", "graph.thm"),
                         [](const auto& test) {
                           const std::string name = test.param;
                           return name.substr(name.size() - 3) == "thm" ? std::string("index")
                                                                        : name.substr(9);
                         });

}  // namespace
}  // namespace throng
