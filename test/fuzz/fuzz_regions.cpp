// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "world/graph_index.h"
#include "world/region_data.h"

// Files of regions and links that pass the checks must answer every look-up without reading past
// their bytes. The input is tried as a file, and as the numbers of one whose checksum is right.
namespace throng {
namespace {

volatile uint64_t seen = 0;

void ask(const world::RegionZone& zone) {
  const std::vector<world::ZoneComponent> components = zone.components();
  for (uint32_t level = 0; level < zone.level_count(); ++level) {
    const auto [first, last] = zone.level_regions(level);
    for (uint32_t r = first; r < last; ++r) {
      for (uint32_t c = 0; c < zone.class_count(); ++c) {
        if ((zone.regions()[r].classes() >> c & 1) == 0) continue;
        const uint32_t of = zone.component(r, c);
        if (of >= components.size() || components[of].avatar_class != c) std::abort();
        seen = seen + components[of].cells;
      }
    }
  }
  for (const format::RegionLink& link : zone.links()) {
    seen = seen + zone.regions()[link.a()].key() + zone.regions()[link.b()].key();
  }
}

void try_regions(flatbuffers::DetachedBuffer bytes) {
  const auto zone = world::RegionZone::from_bytes(std::move(bytes), "fuzz");
  if (!zone) return;
  ask(**zone);
  std::vector<format::RegionLink> links((*zone)->links().begin(), (*zone)->links().end());
  const auto between =
      world::LinkZone::from_bytes(world::link_zone_bytes(0, 0, 0, links, {}), "fuzz");
  if (between && !(*between)->fits(**zone, zone->get(), nullptr)) std::abort();
}

void try_links(flatbuffers::DetachedBuffer bytes) {
  const auto zone = world::LinkZone::from_bytes(std::move(bytes), "fuzz");
  if (!zone) return;
  for (const auto links : {(*zone)->east(), (*zone)->south()}) {
    for (const format::RegionLink& link : links) seen = seen + link.a() + link.b();
  }
}

template <class T>
std::vector<T> take(const uint8_t*& at, const uint8_t* end, size_t count) {
  std::vector<T> values(std::min(count, static_cast<size_t>(end - at) / sizeof(T)));
  if (!values.empty()) std::memcpy(values.data(), at, values.size() * sizeof(T));
  at += values.size() * sizeof(T);
  return values;
}

// As the numbers of an index, of a world with the zones and classes that it names.
void try_index(const uint8_t* bytes, size_t size) {
  const uint8_t *at = bytes + 6, *end = bytes + size;
  world::GraphData graph;
  world::WorldData world;
  for (const format::GraphZone& entry : take<format::GraphZone>(at, end, bytes[0])) {
    graph.slots.push_back(std::make_unique<world::GraphData::Slot>());
    graph.slots.back()->entry = entry;
    world.slots.push_back(std::make_unique<world::WorldData::Slot>());
    world.slots.back()->entry = format::ZoneEntry(entry.x(), entry.z(), 1, 1, 0, 0);
  }
  graph.class_first = take<uint32_t>(at, end, bytes[1]);
  graph.components = take<world::GraphComponent>(at, end, bytes[2]);
  graph.component_of = take<uint32_t>(at, end, bytes[3]);
  graph.class_of.assign(graph.component_of.size(), 0);
  if (graph.class_first.empty()) return;
  world.summary.classes.resize(std::max<size_t>(graph.class_first.size(), 1) - 1);
  world.level_count = bytes[4];
  world.width = world.depth = 1000;
  const auto found = world::read_graph_index(world::write_graph_index(graph, 7), "fuzz", world, 7);
  if (!found) return;
  for (const auto& of_class : (*found)->by_class) {
    for (const Component& component : of_class) seen = seen + component.regions;
  }
}

// As the packed components of an index.
void try_packed(const uint8_t* bytes, size_t size) {
  if (size < 4) return;
  world::GraphData graph;
  graph.class_first = {0, bytes[0], uint32_t{bytes[0]} + bytes[1]};
  world::WorldData world;
  world.level_count = world.width = world.depth = 1000;
  if (world::unpack_components({bytes + 2, size - 2}, world, graph)) return;
  const std::vector<uint8_t> packed = world::pack_components(graph);
  world::GraphData again;
  again.class_first = graph.class_first;
  if (world::unpack_components(packed, world, again) || again.component_of != graph.component_of) {
    std::abort();
  }
}

}  // namespace
}  // namespace throng

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace throng;
  const auto owned = [&] {
    auto* copy = new uint8_t[size];
    std::copy_n(bytes, size, copy);
    return flatbuffers::DetachedBuffer(nullptr, false, copy, size, copy, size);
  };
  try_regions(owned());
  try_links(owned());
  (void)world::read_graph_index({bytes, size}, "fuzz", world::WorldData{}, 0);
  try_packed(bytes, size);
  if (size < 8) return 0;
  // The first bytes give the lengths of the arrays.
  const uint8_t *at = bytes + 8, *end = bytes + size;
  world::RegionTables t;
  t.classes = bytes[4];
  t.first = take<uint32_t>(at, end, bytes[0]);
  t.regions = take<format::Region>(at, end, bytes[1]);
  t.groups.groups = take<format::RegionGroup>(at, end, bytes[2]);
  t.groups.blocks = take<format::GroupBlock>(at, end, bytes[3]);
  t.groups.names = take<uint8_t>(at, end, bytes[5]);
  t.groups.begun = take<uint8_t>(at, end, bytes[6]);
  t.links = take<format::RegionLink>(at, end, bytes[7]);
  try_regions(world::region_zone_bytes(0, 0, 0, t));
  try_index(bytes, size);
  return 0;
}
