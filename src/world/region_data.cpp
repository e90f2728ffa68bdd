// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/region_data.h"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>

#include "core/hash.h"
#include "world/graph_index.h"
#include "world/place.h"

// Reads, checks and writes files of regions, links between zones, and the index of the graph.
namespace throng::world {
namespace {

constexpr const char* kRegionIdentifier = "THRZ";
constexpr const char* kLinkIdentifier = "THLZ";
constexpr const char* kGroupIdentifier = "THGI";

template <class T>
std::span<const T> numbers(const flatbuffers::Vector<T>& values) {
  return {reinterpret_cast<const T*>(values.Data()), values.size()};
}

// The root of a file of ours, or why it is none.
template <class Root>
Result<const Root*> checked_root(std::span<const uint8_t> bytes, const char* identifier,
                                 const std::string& name, const char* what) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (bytes.size() < 8 || !flatbuffers::BufferHasIdentifier(bytes.data(), identifier) ||
      !verifier.VerifyBuffer<Root>(identifier)) {
    return bad_file(name, std::string("not ") + what + ", or truncated");
  }
  const Root* root = flatbuffers::GetRoot<Root>(bytes.data());
  if (root->version() != kGraphVersion) {
    return bad_file(name, "graph version " + std::to_string(root->version()) +
                              ", this program reads " + std::to_string(kGraphVersion));
  }
  return root;
}

template <class T>
uint64_t chained(std::span<const T> values, uint64_t seed) {
  const uint64_t count = values.size();
  return hash_bytes(values.data(), values.size_bytes(), hash_bytes(&count, sizeof count, seed));
}

uint64_t head_sum(int32_t x, int32_t z, uint64_t input) {
  const std::array<uint64_t, 4> head{kGraphVersion, static_cast<uint64_t>(x),
                                     static_cast<uint64_t>(z), input};
  return hash_span(std::span<const uint64_t>(head));
}

uint64_t sum_of(uint64_t head, uint32_t classes, std::span<const uint32_t> first,
                std::span<const format::Region> regions, const RegionGroups& groups,
                std::span<const format::RegionLink> links) {
  head = chained(regions, chained(first, hash_bytes(&classes, sizeof classes, head)));
  head = chained(groups.blocks, chained(groups.groups, head));
  return chained(links, chained(groups.begun, chained(groups.names, head)));
}

uint64_t sum_of(uint64_t head, std::span<const format::RegionLink> east,
                std::span<const format::RegionLink> south) {
  return chained(south, chained(east, head));
}

uint64_t sum_of(uint64_t world_hash, std::span<const format::GraphZone> zones,
                std::span<const uint32_t> class_first, std::span<const uint8_t> components) {
  const uint64_t head = chained(class_first, chained(zones, head_sum(0, 0, world_hash)));
  return chained(components, head);
}

// Offsets from 0 to `end`, none before the last.
bool is_ascending(std::span<const uint32_t> offsets, size_t end) {
  return !offsets.empty() && offsets.front() == 0 && offsets.back() == end &&
         std::is_sorted(offsets.begin(), offsets.end());
}

bool in_order(std::span<const format::RegionLink> links) {
  return std::adjacent_find(links.begin(), links.end(),
                            [](const format::RegionLink& p, const format::RegionLink& q) {
                              return std::pair(p.a(), p.b()) >= std::pair(q.a(), q.b());
                            }) == links.end();
}

bool leads(const format::RegionLink& link, const RegionZone& from, const RegionZone& to) {
  return link.a() < from.regions().size() && link.b() < to.regions().size() &&
         (link.classes() & ~uint32_t{from.regions()[link.a()].classes()}) == 0 &&
         (link.classes() & ~uint32_t{to.regions()[link.b()].classes()}) == 0;
}

}  // namespace

flatbuffers::DetachedBuffer region_zone_bytes(int32_t x, int32_t z, uint64_t input,
                                              const RegionTables& t) {
  const GroupTables& g = t.groups;
  const RegionGroups groups{g.groups, g.blocks, g.names, g.begun};
  flatbuffers::FlatBufferBuilder builder(t.first.size() * 4 + t.regions.size() * 8 +
                                         g.groups.size() * 5 + g.names.size() + g.begun.size() +
                                         t.links.size() * 12 + 1024);
  const uint64_t sum =
      sum_of(head_sum(x, z, input), t.classes, t.first, t.regions, groups, t.links);
  const auto first = builder.CreateVector(t.first);
  const auto regions = builder.CreateVectorOfStructs(t.regions);
  const auto of_groups = builder.CreateVectorOfStructs(g.groups);
  const auto blocks = builder.CreateVectorOfStructs(g.blocks);
  const auto names = builder.CreateVector(g.names);
  const auto begun = builder.CreateVector(g.begun);
  const auto links = builder.CreateVectorOfStructs(t.links);
  builder.Finish(format::CreateZoneRegions(builder, kGraphVersion, x, z, input, sum, t.classes,
                                           first, regions, of_groups, blocks, names, begun, links),
                 kRegionIdentifier);
  return builder.Release();
}

flatbuffers::DetachedBuffer link_zone_bytes(int32_t x, int32_t z, uint64_t input,
                                            const std::vector<format::RegionLink>& east,
                                            const std::vector<format::RegionLink>& south) {
  flatbuffers::FlatBufferBuilder builder((east.size() + south.size()) * 12 + 256);
  const uint64_t sum = sum_of(head_sum(x, z, input), east, south);
  const auto over_east = builder.CreateVectorOfStructs(east);
  const auto over_south = builder.CreateVectorOfStructs(south);
  builder.Finish(
      format::CreateZoneLinks(builder, kGraphVersion, x, z, input, sum, over_east, over_south),
      kLinkIdentifier);
  return builder.Release();
}

bool RegionZone::is_sound(const format::RegionLink& link,
                          std::span<const uint32_t> begins_in) const {
  if (link.a() >= link.b() || !leads(link, *this, *this) || link.classes() == 0) return false;
  const uint32_t a = regions_[link.a()].group(), b = regions_[link.b()].group();
  if (a == b) return true;
  for (uint32_t left = link.classes(); left != 0; left &= left - 1) {
    const auto c = static_cast<size_t>(std::countr_zero(left));
    if (begins_in[a * size_t{class_count()} + c] != begins_in[b * size_t{class_count()} + c]) {
      return false;
    }
  }
  return true;
}

// What is checked here need not be checked by any look-up.
const char* RegionZone::fault() const {
  if (!is_ascending(first_, regions_.size())) return "its levels are out of order";
  if (class_count() == 0 || class_count() > kMaxAvatarClasses) return "it is of no classes";
  std::vector<uint32_t> begins_in;
  if (const char* what = groups_.fault(class_count(), begins_in)) return what;
  uint32_t groups = 0;  // seen
  for (const format::Region& region : regions_) {
    if (region.group() > groups || region.group() >= groups_.groups.size() ||
        region.key() >= kTileCells * kTileCells ||
        region.classes() != groups_.groups[region.group()].classes()) {
      return "a region makes no sense";
    }
    groups += region.group() == groups ? 1 : 0;
  }
  if (groups != groups_.groups.size()) return "a group has no regions";
  if (!in_order(links_)) return "its links are out of order";
  for (const format::RegionLink& link : links_) {
    if (!is_sound(link, begins_in)) return "a link makes no sense";
  }
  return nullptr;
}

std::vector<ZoneComponent> RegionZone::components() const {
  std::vector<ZoneComponent> found(component_count_);
  std::vector<uint32_t> count(groups_.groups.size(), 0);  // regions of a group
  uint32_t groups = 0, next = 0;
  BegunReader reader{groups_.begun};
  for (uint32_t level = 0; level < level_count(); ++level) {
    for (uint32_t r = first_[level]; r < first_[level + 1]; ++r) {
      const uint32_t group = regions_[r].group();
      ++count[group];
      if (group != groups) continue;
      ++groups;
      const uint32_t begins = groups_.groups[group].begins();
      if (begins != 0) reader.next_place();
      for (uint32_t left = begins; left != 0; left &= left - 1) {
        reader.next_cells();
        found[next++] = {.avatar_class = static_cast<uint32_t>(std::countr_zero(left)),
                         .cells = static_cast<uint64_t>(reader.cells),
                         .first_region = r,
                         .level = level,
                         .tile = reader.tile,
                         .feet = static_cast<int32_t>(reader.feet)};
      }
    }
  }
  for (uint32_t g = 0; g < groups; ++g) {
    for (uint32_t left = groups_.groups[g].classes(); left != 0; left &= left - 1) {
      found[groups_.component(g, static_cast<uint32_t>(std::countr_zero(left)))].regions +=
          count[g];
    }
  }
  return found;
}

Result<void> RegionZone::attach(const std::string& name) {
  auto root =
      checked_root<format::ZoneRegions>(bytes(), kRegionIdentifier, name, "a file of regions");
  if (!root) return root.error();
  root_ = *root;
  if (!root_->first() || !root_->regions() || !root_->groups() || !root_->blocks() ||
      !root_->names() || !root_->begun() || !root_->links()) {
    return bad_file(name, "an array is missing");
  }
  first_ = numbers(*root_->first());
  regions_ = structs(*root_->regions());
  groups_ = {structs(*root_->groups()), structs(*root_->blocks()), numbers(*root_->names()),
             numbers(*root_->begun())};
  links_ = structs(*root_->links());
  const uint64_t head = head_sum(root_->x(), root_->z(), root_->input());
  if (root_->sum() != sum_of(head, root_->classes(), first_, regions_, groups_, links_)) {
    return bad_file(name, "its checksum is wrong");
  }
  if (const char* what = fault()) return bad_file(name, what);
  component_count_ = groups_.component_count();
  return {};
}

Result<void> LinkZone::attach(const std::string& name) {
  auto root = checked_root<format::ZoneLinks>(bytes(), kLinkIdentifier, name, "a file of links");
  if (!root) return root.error();
  root_ = *root;
  if (!root_->east() || !root_->south()) return bad_file(name, "an array is missing");
  east_ = structs(*root_->east());
  south_ = structs(*root_->south());
  const uint64_t head = head_sum(root_->x(), root_->z(), root_->input());
  if (root_->sum() != sum_of(head, east_, south_)) return bad_file(name, "its checksum is wrong");
  const auto is_empty = [](const format::RegionLink& link) { return link.classes() == 0; };
  if (!in_order(east_) || !in_order(south_) || std::any_of(east_.begin(), east_.end(), is_empty) ||
      std::any_of(south_.begin(), south_.end(), is_empty)) {
    return bad_file(name, "its links are out of order");
  }
  return {};
}

bool LinkZone::fits(const RegionZone& own, const RegionZone* east, const RegionZone* south) const {
  const auto all_lead = [&](std::span<const format::RegionLink> links, const RegionZone* to) {
    if (to == nullptr) return links.empty();
    return std::all_of(links.begin(), links.end(),
                       [&](const format::RegionLink& link) { return leads(link, own, *to); });
  };
  return all_lead(east_, east) && all_lead(south_, south);
}

bool is_of_slot(const RegionZone& regions, const WorldData& world, size_t slot) {
  const format::ZoneEntry& entry = world.slots[slot]->entry;
  return regions.root().x() == entry.x() && regions.root().z() == entry.z() &&
         regions.level_count() == entry.levels() &&
         regions.class_count() == world.summary.classes.size();
}

int32_t slot_at(const WorldData& world, int32_t x, int32_t z) {
  if (x < 0 || z < 0 || x >= world.zones_x || z >= world.zones_z) return -1;
  return world.slot_of_zone[static_cast<size_t>(z * world.zones_x + x)];
}

std::string region_file_name(int32_t x, int32_t z) {
  return "zone_" + std::to_string(x) + "_" + std::to_string(z) + ".thr";
}

std::string link_file_name(int32_t x, int32_t z) {
  return "zone_" + std::to_string(x) + "_" + std::to_string(z) + ".thl";
}

const RegionZone* GraphData::zone(const WorldData& of_world, size_t slot) const {
  const Slot& own = *slots[slot];
  std::call_once(own.once, [&] {
    if (own.zone || path.empty()) return;
    const format::GraphZone& entry = own.entry;
    own.open({.name = path + "/" + region_file_name(entry.x(), entry.z()),
              .bytes = entry.region_bytes(),
              .hash = entry.region_hash(),
              .whose = "the graph index's"},
             [&](const RegionZone& found) {
               bool fits = is_of_slot(found, of_world, slot) &&
                           found.regions().size() == entry.regions() &&
                           found.component_count() == entry.components();
               // While a bake makes the components of the world, there are none to name.
               if (!fits || component_of.empty()) return fits;
               uint32_t component = entry.first_component();
               for (const format::RegionGroup& group : found.groups().groups) {
                 for (uint32_t left = group.begins(); left != 0; left &= left - 1) {
                   const auto c = static_cast<size_t>(std::countr_zero(left));
                   fits = fits && component_of[component++] < class_first[c + 1] - class_first[c];
                 }
               }
               return fits;
             });
  });
  return own.zone.get();
}

Result<void> GraphData::check_links(const WorldData& of_world, size_t slot) const {
  const format::GraphZone& entry = slots[slot]->entry;
  std::array<const RegionZone*, 3> zones{};  // this, east, south
  const std::array<int32_t, 3> around{static_cast<int32_t>(slot),
                                      slot_at(of_world, entry.x() + 1, entry.z()),
                                      slot_at(of_world, entry.x(), entry.z() + 1)};
  for (size_t i = 0; i < zones.size(); ++i) {
    if (around[i] < 0) continue;
    zones[i] = zone(of_world, static_cast<size_t>(around[i]));
    if (zones[i] == nullptr) {
      return Error{Errc::kBadFile, slots[static_cast<size_t>(around[i])]->error};
    }
  }
  const std::string name = path + "/" + link_file_name(entry.x(), entry.z());
  const auto links = open_listed<LinkZone>({.name = name,
                                            .bytes = entry.link_bytes(),
                                            .hash = entry.link_hash(),
                                            .whose = "the graph index's"});
  if (!links) return Error{Errc::kBadFile, links.error().message};
  if ((*links)->root().x() != entry.x() || (*links)->root().z() != entry.z() ||
      !(*links)->fits(*zones[0], zones[1], zones[2])) {
    return bad_file(name, "belongs to another world");
  }
  return {};
}

void GraphData::show(const WorldData& of_world) {
  const WorldSummary& of = of_world.summary;
  const auto middle = [&](int32_t cell) {
    const int64_t units = (int64_t{cell} << kUnitBits) + kUnitsPerCell / 2;
    return (static_cast<double>(units) + 0.5) * (of.cell / kUnitsPerCell);  // as place_at
  };
  by_class.assign(class_first.size() - 1, {});
  for (size_t c = 0; c < by_class.size(); ++c) {
    for (uint32_t i = class_first[c]; i < class_first[c + 1]; ++i) {
      const GraphComponent& from = components[i];
      by_class[c].push_back({static_cast<double>(from.cells) * (of.cell * of.cell),
                             from.regions,
                             {{of.origin.x + middle(from.cell_x), from.feet * 1e-3,
                               of.origin.z + middle(from.cell_z)},
                              from.level + 1}});
    }
  }
  summary.regions = summary.links = 0;
  for (const auto& slot : slots) {
    summary.regions += slot->entry.regions();
    summary.links += slot->entry.links();
  }
  summary.bytes =
      summary.regions * sizeof(format::Region) + summary.links * sizeof(format::RegionLink);
}

std::vector<uint8_t> write_graph_index(const GraphData& graph, uint64_t world_hash) {
  const std::vector<uint8_t> packed = pack_components(graph);
  std::vector<format::GraphZone> zones;
  for (const auto& slot : graph.slots) zones.push_back(slot->entry);
  // Room for all of it: as it grew it would be there three times.
  flatbuffers::FlatBufferBuilder builder(zones.size() * sizeof(format::GraphZone) + packed.size() +
                                         1024);
  builder.Finish(
      format::CreateGraphIndexDirect(builder, kGraphVersion, world_hash,
                                     sum_of(world_hash, zones, graph.class_first, packed), &zones,
                                     &graph.class_first, &packed),
      kGroupIdentifier);
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

Result<std::shared_ptr<GraphData>> read_graph_index(std::span<const uint8_t> bytes,
                                                    const std::string& name, const WorldData& world,
                                                    uint64_t world_hash) {
  auto found =
      checked_root<format::GraphIndex>(bytes, kGroupIdentifier, name, "the index of a graph");
  if (!found) return found.error();
  const format::GraphIndex& root = **found;
  if (root.world() != world_hash) return bad_file(name, "belongs to another bake of this world");
  if (!root.zones() || !root.class_first() || !root.components() || !is_aligned(*root.zones())) {
    return bad_file(name, "an array is missing");
  }
  const auto class_first = numbers(*root.class_first());
  const auto packed = numbers(*root.components());
  if (root.sum() != sum_of(world_hash, structs(*root.zones()), class_first, packed)) {
    return bad_file(name, "its checksum is wrong");
  }
  if (root.zones()->size() != world.slots.size() || class_first.size() < 2 ||
      class_first.size() != world.summary.classes.size() + 1 ||
      !is_ascending(class_first, class_first.back())) {
    return bad_file(name, "its arrays do not fit together");
  }
  auto graph = std::make_shared<GraphData>();
  uint64_t components = 0;
  for (size_t s = 0; s < world.slots.size(); ++s) {
    const format::GraphZone& entry = *root.zones()->Get(static_cast<uint32_t>(s));
    const format::ZoneEntry& of = world.slots[s]->entry;
    if (entry.x() != of.x() || entry.z() != of.z() || entry.first_component() != components) {
      return bad_file(name, "zone " + std::to_string(s) + " makes no sense");
    }
    components += entry.components();
    graph->slots.push_back(std::make_unique<GraphData::Slot>());
    graph->slots.back()->entry = entry;
  }
  graph->class_first.assign(class_first.begin(), class_first.end());
  if (const char* what = unpack_components(packed, world, *graph)) {
    return bad_file(name, what);
  }
  if (components != graph->component_of.size()) {
    return bad_file(name, "its zones miscount their components");
  }
  graph->show(world);
  return graph;
}

}  // namespace throng::world
