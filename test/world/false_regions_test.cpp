// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "graph/graph_passes.h"
#include "scratch_folder.h"
#include "world/region_data.h"
#include "worlds.h"

// Files of regions and links that are not true: refused by name, or used without reading beyond
// them. Their sums are made right, so that it is the other checks that see it.
namespace throng {
namespace {

// Keeps the bytes of the zones' files.
class FilesInMemory : public graph::GraphFiles {
 public:
  std::unique_ptr<world::RegionZone> reuse_regions(int32_t, int32_t, uint64_t) override {
    return nullptr;
  }
  std::unique_ptr<world::LinkZone> reuse_links(int32_t, int32_t, uint64_t) override {
    return nullptr;
  }
  Result<void> write(const std::string& name, std::span<const uint8_t> bytes) override {
    files.emplace_back(name, std::vector<uint8_t>(bytes.begin(), bytes.end()));
    return write_file(folder.path() + "/" + name, bytes);
  }

  test::ScratchFolder folder;
  std::vector<std::pair<std::string, std::vector<uint8_t>>> files;
};

flatbuffers::DetachedBuffer owned(std::span<const uint8_t> bytes) {
  auto* copy = new uint8_t[bytes.size()];
  std::copy(bytes.begin(), bytes.end(), copy);
  return {nullptr, false, copy, bytes.size(), copy, bytes.size()};
}

struct Made {
  World world;
  std::shared_ptr<world::GraphData> graph;
  std::vector<std::vector<uint8_t>> regions, links;
};

Made make_small(FilesInMemory& files) {
  Made made;
  made.world = test::bake(test::builtin({.name = "garage", .size = 60, .levels = 2}), 0.2);
  // The passes read the files back from where they have put them.
  auto* world = const_cast<world::WorldData*>(data_of(made.world).get());
  world->path = files.folder.path();
  Context context;
  auto graph = graph::make_graph(*world, &files, 1, context);
  world->path.clear();
  EXPECT_TRUE(graph) << graph.error().message;
  if (!graph) return made;
  made.graph = graph->graph;
  for (const auto& [name, bytes] : files.files) {
    (name.ends_with(".thr") ? made.regions : made.links).push_back(bytes);
  }
  return made;
}

world::RegionTables tables_of(const world::RegionZone& zone) {
  world::RegionTables t;
  const auto copy = [](auto& to, const auto& from) { to.assign(from.begin(), from.end()); };
  t.classes = zone.class_count();
  copy(t.first, *zone.root().first());
  copy(t.regions, zone.regions());
  copy(t.groups.groups, zone.groups().groups);
  copy(t.groups.blocks, zone.groups().blocks);
  copy(t.groups.names, zone.groups().names);
  copy(t.groups.begun, zone.groups().begun);
  copy(t.links, zone.links());
  return t;
}

// One number changed at random, near or far.
template <class T>
void change(std::vector<T>& values, uint64_t seed) {
  if (values.empty()) return;
  auto* words = reinterpret_cast<uint8_t*>(values.data());
  const size_t at = random_below(seed, 1, 0, values.size() * sizeof(T));
  words[at] = static_cast<uint8_t>(random_below(seed, 2, 0, 2) == 0
                                       ? words[at] + 1 - 2 * random_below(seed, 3, 0, 2)
                                       : random_u64(seed, 4, 0));
}

// Everything that may be asked of it.
uint64_t use(const world::RegionZone& zone) {
  uint64_t sum = 0;
  const auto components = zone.components();
  std::vector<uint32_t> regions(components.size(), 0);
  for (uint32_t level = 0; level < zone.level_count(); ++level) {
    const auto [first, last] = zone.level_regions(level);
    for (uint32_t r = first; r < last; ++r) {
      for (uint32_t c = 0; c < zone.class_count(); ++c) {
        if ((zone.regions()[r].classes() >> c & 1) == 0) continue;
        const uint32_t of = zone.component(r, c);
        EXPECT_LT(of, components.size());
        if (of >= components.size()) return 0;
        EXPECT_EQ(components[of].avatar_class, c);
        EXPECT_LE(components[of].first_region, r);
        EXPECT_LE(components[of].level, level);
        ++regions[of];
        sum += components[of].cells;
      }
    }
  }
  for (size_t i = 0; i < components.size(); ++i) {
    EXPECT_GT(components[i].cells, 0u);
    EXPECT_EQ(components[i].regions, regions[i]);
  }
  for (const format::RegionLink& link : zone.links()) {
    sum += zone.regions()[link.a()].key() + zone.regions()[link.b()].key();
  }
  return sum;
}

TEST(FalseRegions, AreRefusedByNameOrUsedWithoutACrash) {
  FilesInMemory files;
  const Made made = make_small(files);
  size_t refused = 0, used = 0;
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    const auto zone =
        world::RegionZone::from_bytes(owned(made.regions[seed % made.regions.size()]), "it");
    ASSERT_TRUE(zone);
    world::RegionTables t = tables_of(**zone);
    for (uint64_t k = 0; k <= seed % 2; ++k) {
      const uint64_t n = seed * 2 + k;
      switch (random_below(n, 0, 0, 8)) {
        case 0:
          change(t.first, n);
          break;
        case 1:
          change(t.regions, n);
          break;
        case 2:
          change(t.groups.groups, n);
          break;
        case 3:
          change(t.groups.blocks, n);
          break;
        case 4:
          change(t.groups.names, n);
          break;
        case 5:
          change(t.groups.begun, n);
          break;
        case 6:
          t.classes += static_cast<uint32_t>(random_below(n, 5, 0, 3)) - 1;
          break;
        default:
          change(t.links, n);
      }
    }
    const auto found = world::RegionZone::from_bytes(world::region_zone_bytes(0, 0, 0, t), "it");
    if (found) {
      used += use(**found) > 0 ? 1 : 0;
      continue;
    }
    EXPECT_EQ(found.error().message.substr(0, 4), "it: ");
    ++refused;
  }
  EXPECT_GT(refused, 1500u);
  EXPECT_GT(used, 200u);
}

TEST(FalseRegions, ChangedBytesAndCutFilesAreRefusedByTheSum) {
  FilesInMemory files;
  const Made made = make_small(files);
  size_t refused = 0, filling = 0;
  const auto expect_refused = [&](const std::vector<uint8_t>& bytes, bool regions) {
    const bool sound = regions
                           ? static_cast<bool>(world::RegionZone::from_bytes(owned(bytes), "it"))
                           : static_cast<bool>(world::LinkZone::from_bytes(owned(bytes), "it"));
    ++(sound ? filling : refused);
  };
  for (const auto* kind : {&made.regions, &made.links}) {
    const bool regions = kind == &made.regions;
    for (uint64_t seed = 0; seed < 800; ++seed) {
      std::vector<uint8_t> bytes = (*kind)[seed % kind->size()];
      bytes[random_below(seed, 0, 0, bytes.size())] ^=
          static_cast<uint8_t>(1 + random_below(seed, 1, 0, 255));
      expect_refused(bytes, regions);
    }
    const std::vector<uint8_t>& whole = kind->front();
    for (size_t size = 0; size < whole.size(); size += 1 + size / 5) {
      std::vector<uint8_t> cut(whole.begin(), whole.begin() + static_cast<int64_t>(size));
      if (cut.empty()) cut.push_back(0);
      expect_refused(cut, regions);
    }
  }
  EXPECT_GT(refused, 1500u);
  EXPECT_LT(filling, 80u);  // What fills up words, or encodes the same numbers differently.
  EXPECT_FALSE(world::RegionZone::from_bytes(owned(made.links[0]), "it"));
  EXPECT_FALSE(world::LinkZone::from_bytes(owned(made.regions[0]), "it"));
}

TEST(FalseRegions, LinksThatLeadNowhereDoNotFit) {
  FilesInMemory files;
  const Made made = make_small(files);
  const world::WorldData& world = *data_of(made.world);
  size_t fitting = 0, refused = 0;
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    const size_t s = seed % made.links.size();
    const auto links = world::LinkZone::from_bytes(owned(made.links[s]), "it");
    ASSERT_TRUE(links);
    const auto& entry = world.slots[s]->entry;
    const auto zone = [&](int32_t x, int32_t z) -> const world::RegionZone* {
      const int32_t slot = world::slot_at(world, x, z);
      return slot < 0 ? nullptr : made.graph->zone(world, static_cast<size_t>(slot));
    };
    const world::RegionZone* own = zone(entry.x(), entry.z());
    const world::RegionZone *to_east = zone(entry.x() + 1, entry.z()),
                            *to_south = zone(entry.x(), entry.z() + 1);
    ASSERT_NE(own, nullptr);
    EXPECT_TRUE((*links)->fits(*own, to_east, to_south));
    std::vector<format::RegionLink> east((*links)->east().begin(), (*links)->east().end());
    std::vector<format::RegionLink> south((*links)->south().begin(), (*links)->south().end());
    change(random_below(seed, 5, 0, 2) == 0 ? east : south, seed);
    const auto found =
        world::LinkZone::from_bytes(world::link_zone_bytes(0, 0, 0, east, south), "it");
    if (!found || !(*found)->fits(*own, to_east, to_south)) {
      ++refused;
      continue;
    }
    for (const format::RegionLink& link : (*found)->east()) {
      ASSERT_LT(link.a(), own->regions().size());
      ASSERT_LT(link.b(), to_east->regions().size());
      ASSERT_EQ(link.classes() & ~uint32_t{own->regions()[link.a()].classes()}, 0u);
    }
    ++fitting;
  }
  EXPECT_GT(refused, 500u);
  EXPECT_GT(fitting, 300u);
}

TEST(FalseRegions, AFalseIndexIsRefusedOrNamesWhatIsThere) {
  FilesInMemory files;
  const Made made = make_small(files);
  const world::WorldData& world = *data_of(made.world);
  const std::vector<uint8_t> whole = world::write_graph_index(*made.graph, 7);
  ASSERT_TRUE(world::read_graph_index(whole, "it", world, 7));
  EXPECT_FALSE(world::read_graph_index(whole, "it", world, 8));  // Of another bake.
  for (size_t size = 0; size < whole.size(); size += 1 + size / 5) {
    EXPECT_FALSE(world::read_graph_index(std::span(whole).first(size), "it", world, 7)) << size;
  }
  size_t refused = 0, used = 0;
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    const auto own = world::read_graph_index(whole, "it", world, 7);
    world::GraphData& graph = **own;
    std::vector<format::GraphZone> zones;
    for (const auto& slot : graph.slots) zones.push_back(slot->entry);
    switch (random_below(seed, 0, 0, 4)) {
      case 0:
        change(zones, seed);
        break;
      case 1:
        change(graph.class_first, seed);
        break;
      case 2:
        change(graph.components, seed);
        break;
      default:
        change(graph.component_of, seed);
    }
    for (size_t s = 0; s < zones.size(); ++s) graph.slots[s]->entry = zones[s];
    const auto found = world::read_graph_index(world::write_graph_index(graph, 7), "it", world, 7);
    if (!found) {
      EXPECT_EQ(found.error().message.substr(0, 4), "it: ");
      ++refused;
      continue;
    }
    (*found)->path = files.folder.path();
    bool usable = true;
    for (size_t s = 0; s < world.slots.size(); ++s) {
      const world::RegionZone* zone = (*found)->zone(world, s);
      usable = usable && zone != nullptr;
      if (zone == nullptr) continue;
      uint32_t i = (*found)->slots[s]->entry.first_component();
      for (const world::ZoneComponent& part : zone->components()) {
        ASSERT_LT((*found)->component_of[i++], (*found)->by_class[part.avatar_class].size());
      }
    }
    ++(usable ? used : refused);
  }
  EXPECT_GT(refused, 500u);
  EXPECT_GT(used, 200u);
}

}  // namespace
}  // namespace throng
