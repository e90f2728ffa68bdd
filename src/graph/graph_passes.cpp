// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/graph_passes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>
#include <vector>

#include "core/arrays/disjoint_sets.h"
#include "core/hash.h"
#include "core/side_by_side.h"
#include "graph/zone_regions.h"
#include "world/graph_index.h"
#include "world/place.h"

// Pass 1 reads one zone at a time, pass 2 at a zone and the two behind its eastern and southern
// border: each border belongs to one zone, so a zone that changes costs its own links and those of
// its western and northern neighbours. A step leads over sides of cells only, so zones that touch
// at a corner have no link; and a zone is as high as the world, so there is none over or under it.
// Components are joined over borders from those within zones: pass 2 reads no single parts.
namespace throng::graph {
namespace {

constexpr uint64_t kMaxZoneBytes = (uint64_t{1} << 31) - (1 << 20);  // FlatBuffers' limit

Error cancelled() { return {Errc::kCancelled, "graph: cancelled"}; }

format::GraphZone with(const format::GraphZone& entry, uint32_t first_component,
                       const LinksOfZone& links) {
  const auto count = links.bytes == 0 ? entry.links() : static_cast<uint32_t>(links.count);
  return {entry.x(),          entry.z(),       entry.regions(),      count,
          entry.components(), first_component, entry.region_bytes(), entry.region_hash(),
          links.bytes,        links.hash};
}

}  // namespace

class GraphPasses::Passes {
 public:
  Passes(const world::WorldData& world, GraphFiles* files) : world_(world), files_(files) {
    made_.graph = std::make_shared<world::GraphData>();
    made_.graph->slots.resize(world.slots.size());
    inputs_.resize(world.slots.size());
  }

  Result<RegionsOfZone> find_regions(size_t slot, int32_t workers, const Context& context);
  void enter(const RegionsOfZone& found);
  Result<void> end_regions();
  Result<Found> find_links(size_t slot, int32_t workers, const Context& context);
  void enter(const LinksOfZone& links, std::span<const std::pair<uint32_t, uint32_t>> joined);
  GraphMade finish();

 private:
  // A slot, or none.
  struct Side {
    int32_t slot = -1;
    const world::RegionZone* zone = nullptr;
  };
  struct Around {
    Side own, east, south;
  };

  Result<flatbuffers::DetachedBuffer> make_links(size_t slot, uint64_t input, const Around& around,
                                                 int32_t workers) const;
  [[nodiscard]] Joined joined(const world::LinkZone& links, const Around& around) const;
  [[nodiscard]] world::GraphComponent place_of(size_t slot, const world::ZoneComponent& part,
                                               const world::RegionZone& zone) const;
  void number_components();
  [[nodiscard]] uint64_t region_input(size_t slot) const;
  [[nodiscard]] Result<Side> side(int32_t slot) const;
  [[nodiscard]] uint64_t link_input(const Around& around) const;
  [[nodiscard]] Result<void> usable(int32_t slot) const;

  const world::WorldData& world_;
  GraphFiles* files_;
  GraphMade made_;
  std::vector<uint64_t> inputs_;    // of the slots' regions
  std::vector<LinksOfZone> links_;  // of the slots, while others still read their entries
  uint32_t components_ = 0;         // of zones
  DisjointSets sets_{0};            // of these
};

// All that regions are made from: the zone's bytes and what they leave out, the steps of classes.
uint64_t GraphPasses::Passes::region_input(size_t slot) const {
  std::vector<uint64_t> words{world::kGraphVersion, world_.slots[slot]->entry.hash()};
  for (const AvatarClass& avatar : world_.summary.classes) {
    words.push_back(static_cast<uint64_t>(world::step_mm(avatar)));
  }
  return hash_span(std::span<const uint64_t>(words));
}

Result<void> GraphPasses::Passes::usable(int32_t slot) const {
  if (slot < 0 || world_.zone(static_cast<size_t>(slot)) != nullptr) return {};
  return Error{Errc::kBadFile, world_.slots[static_cast<size_t>(slot)]->error};
}

uint64_t GraphPasses::Passes::link_input(const Around& around) const {
  std::vector<uint64_t> words{world::kGraphVersion};
  for (const Side& of : {around.own, around.east, around.south}) {
    words.push_back(of.slot < 0 ? 0 : inputs_[static_cast<size_t>(of.slot)]);
  }
  return hash_span(std::span<const uint64_t>(words));
}

Result<GraphPasses::Passes::Side> GraphPasses::Passes::side(int32_t slot) const {
  if (slot < 0) return Side{};
  const world::RegionZone* zone = made_.graph->zone(world_, static_cast<size_t>(slot));
  if (zone != nullptr) return Side{slot, zone};
  return Error{Errc::kBadFile, made_.graph->slots[static_cast<size_t>(slot)]->error};
}

Result<RegionsOfZone> GraphPasses::Passes::find_regions(size_t slot, int32_t workers,
                                                        const Context& context) {
  const format::ZoneEntry& entry = world_.slots[slot]->entry;
  const uint64_t input = region_input(slot);
  inputs_[slot] = input;
  std::unique_ptr<world::RegionZone> zone;
  if (files_ != nullptr) {
    zone = files_->reuse_regions(entry.x(), entry.z(), input);
    if (zone && !world::is_of_slot(*zone, world_, slot)) zone = nullptr;
  }
  if (zone == nullptr) {
    if (auto ok = usable(static_cast<int32_t>(slot)); !ok) return ok.error();
    const auto tables = find_zone_regions(world_, slot, workers, context);
    if (!tables) return cancelled();
    const std::string name = world::region_file_name(entry.x(), entry.z());
    const uint64_t bytes =
        tables->first.size() * sizeof(uint32_t) + tables->regions.size() * sizeof(format::Region) +
        tables->groups.groups.size() * 5 + tables->groups.names.size() +
        tables->groups.begun.size() + tables->links.size() * sizeof(format::RegionLink);
    if (bytes > kMaxZoneBytes) {
      return Error{Errc::kLimit, name + ": more than 2 GiB of regions; use smaller zones"};
    }
    auto made = world::RegionZone::from_bytes(
        world::region_zone_bytes(entry.x(), entry.z(), input, *tables), name);
    if (!made) return made.error();
    zone = std::move(*made);
    if (files_ != nullptr) {
      if (auto ok = files_->write(name, zone->bytes()); !ok) return ok.error();
    }
  }
  auto own = std::make_unique<world::GraphData::Slot>();
  own->entry = {entry.x(),
                entry.z(),
                static_cast<uint32_t>(zone->regions().size()),
                static_cast<uint32_t>(zone->links().size()),
                zone->component_count(),
                0,
                zone->bytes().size(),
                hash_bytes(zone->bytes().data(), zone->bytes().size()),
                0,
                0};
  // Those in a folder are mapped again when pass 2 comes to them.
  if (files_ == nullptr) own->zone = std::move(zone);
  const format::GraphZone found = own->entry;
  made_.graph->slots[slot] = std::move(own);
  return RegionsOfZone{static_cast<uint32_t>(slot), found, input};
}

void GraphPasses::Passes::enter(const RegionsOfZone& found) {
  auto slot = std::make_unique<world::GraphData::Slot>();
  slot->entry = found.entry;
  made_.graph->slots[found.slot] = std::move(slot);
  inputs_[found.slot] = found.input;
}

// Where the components of each zone come among those of all.
Result<void> GraphPasses::Passes::end_regions() {
  for (const auto& slot : made_.graph->slots) {
    format::GraphZone& entry = slot->entry;
    if (uint64_t{components_} + entry.components() >= UINT32_MAX) {
      return Error{Errc::kLimit, "graph: more than 2^32 parts; use a larger cell"};
    }
    entry = with(entry, components_, {});
    components_ += entry.components();
  }
  if (files_ != nullptr) made_.graph->path = world_.path;
  sets_ = DisjointSets(components_);
  links_.resize(made_.graph->slots.size());
  return {};
}

Result<flatbuffers::DetachedBuffer> GraphPasses::Passes::make_links(size_t slot, uint64_t input,
                                                                    const Around& around,
                                                                    int32_t workers) const {
  const format::GraphZone& entry = made_.graph->slots[slot]->entry;
  std::array<std::vector<format::RegionLink>, 2> links;
  for (size_t i = 0; i < links.size(); ++i) {
    const Side& next = i == 0 ? around.east : around.south;
    if (next.slot < 0) continue;
    for (const Side& zone : {around.own, next}) {
      if (auto ok = usable(zone.slot); !ok) return ok.error();
    }
    links[i] = find_zone_links(world_, {slot, around.own.zone},
                               {static_cast<size_t>(next.slot), next.zone}, workers);
  }
  return world::link_zone_bytes(entry.x(), entry.z(), input, links[0], links[1]);
}

// Each pair once: thousands of links over a border join a few parts.
GraphPasses::Joined GraphPasses::Passes::joined(const world::LinkZone& links,
                                                const Around& around) const {
  const auto& slots = made_.graph->slots;
  const uint32_t first = slots[static_cast<size_t>(around.own.slot)]->entry.first_component();
  Joined pairs;
  const auto add = [&](std::span<const format::RegionLink> over, const Side& to) {
    for (const format::RegionLink& link : over) {
      for (uint32_t left = link.classes(); left != 0; left &= left - 1) {
        const auto c = static_cast<uint32_t>(std::countr_zero(left));
        const auto& next = slots[static_cast<size_t>(to.slot)]->entry;
        const std::pair pair{first + around.own.zone->component(link.a(), c),
                             next.first_component() + to.zone->component(link.b(), c)};
        if (pairs.empty() || pairs.back() != pair) pairs.push_back(pair);
      }
    }
  };
  add(links.east(), around.east);
  add(links.south(), around.south);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

Result<GraphPasses::Found> GraphPasses::Passes::find_links(size_t slot, int32_t workers,
                                                           const Context& context) {
  if (context.cancel) return cancelled();
  const format::GraphZone& entry = made_.graph->slots[slot]->entry;
  const auto own = side(static_cast<int32_t>(slot)),
             east = side(world::slot_at(world_, entry.x() + 1, entry.z())),
             south = side(world::slot_at(world_, entry.x(), entry.z() + 1));
  for (const auto* zone : {&own, &east, &south}) {
    if (!*zone) return zone->error();
  }
  const Around around{*own, *east, *south};
  const uint64_t input = link_input(around);
  const auto fits = [&](const world::LinkZone& made) {
    return made.root().x() == entry.x() && made.root().z() == entry.z() &&
           made.fits(*own->zone, east->zone, south->zone);
  };
  std::unique_ptr<world::LinkZone> links;
  if (files_ != nullptr) {
    links = files_->reuse_links(entry.x(), entry.z(), input);
    if (links && !fits(*links)) links = nullptr;
  }
  const bool is_new = links == nullptr;
  if (is_new) {
    auto bytes = make_links(slot, input, around, workers);
    if (!bytes) return bytes.error();
    const std::string name = world::link_file_name(entry.x(), entry.z());
    auto made = world::LinkZone::from_bytes(*std::move(bytes), name);
    if (!made) return made.error();
    links = std::move(*made);
    // Reused regions may differ from those of today if their file is forged.
    if (!fits(*links)) {
      return world::bad_file(world::region_file_name(entry.x(), entry.z()),
                             "or one beside it, is not of this zone",
                             "bake the world again with --rebuild");
    }
    if (files_ != nullptr) {
      if (auto ok = files_->write(name, links->bytes()); !ok) return ok.error();
    }
  }
  Found found{.links = {.slot = static_cast<uint32_t>(slot),
                        .is_new = is_new,
                        .count = entry.links() + links->east().size() + links->south().size(),
                        .bytes = links->bytes().size(),
                        .hash = hash_bytes(links->bytes().data(), links->bytes().size())},
              .joined = joined(*links, around)};
  own->zone->give_back();  // Most of those around it have had their links with it.
  return found;
}

void GraphPasses::Passes::enter(const LinksOfZone& links,
                                std::span<const std::pair<uint32_t, uint32_t>> joined) {
  links_[links.slot] = links;
  made_.zones_relinked += links.is_new ? 1 : 0;
  for (const auto& [a, b] : joined) sets_.join(a, b);
}

// A component of the world that begins with one of a zone, without what it is made of.
world::GraphComponent GraphPasses::Passes::place_of(size_t slot, const world::ZoneComponent& part,
                                                    const world::RegionZone& zone) const {
  const uint32_t key = zone.regions()[part.first_region].key();
  const auto cell = [&](int32_t of_zone, uint32_t tile, uint32_t in_tile) {
    return (of_zone * static_cast<int32_t>(world_.tiles_per_zone) + static_cast<int32_t>(tile)) *
               kTileCells +
           static_cast<int32_t>(in_tile);
  };
  return {.level = world_.slots[slot]->first_level + part.level,
          .cell_x = cell(zone.root().x(), part.tile % world_.tiles_per_zone, key % kTileCells),
          .cell_z = cell(zone.root().z(), part.tile / world_.tiles_per_zone, key / kTileCells),
          .feet = part.feet};
}

// The components of each class, the largest first, then by their first region: the roots of the
// sets are in that order.
void GraphPasses::Passes::number_components() {
  world::GraphData& graph = *made_.graph;
  const size_t classes = world_.summary.classes.size();
  std::vector<std::vector<world::GraphComponent>> found(classes);
  std::vector<uint8_t> class_of(components_);  // of the components of zones
  std::vector<uint32_t> of_root(components_, 0), component_of(components_, 0);
  for (size_t s = 0; s < graph.slots.size(); ++s) {
    const world::RegionZone& zone = *graph.zone(world_, s);
    uint32_t i = graph.slots[s]->entry.first_component();
    for (const world::ZoneComponent& part : zone.components()) {
      auto& of_class = found[part.avatar_class];
      const uint32_t root = sets_.find(i);
      class_of[i] = static_cast<uint8_t>(part.avatar_class);
      if (root == i) {
        of_root[i] = static_cast<uint32_t>(of_class.size());
        of_class.push_back(place_of(s, part, zone));
      }
      world::GraphComponent& all = of_class[of_root[root]];
      all.cells += part.cells;
      all.regions += part.regions;
      ++i;
    }
    zone.give_back();
  }
  const auto rank = world::rank_components(found, graph);
  for (uint32_t i = 0; i < components_; ++i) {
    component_of[i] = rank[class_of[i]][of_root[sets_.find(i)]];
  }
  graph.component_of = std::move(component_of);
  graph.class_of = std::move(class_of);
}

GraphMade GraphPasses::Passes::finish() {
  world::GraphData& graph = *made_.graph;
  for (size_t s = 0; s < links_.size(); ++s) {
    format::GraphZone& entry = graph.slots[s]->entry;
    entry = with(entry, entry.first_component(), links_[s]);
  }
  number_components();
  graph.show(world_);
  return std::move(made_);
}

GraphPasses::GraphPasses(const world::WorldData& world, GraphFiles* files)
    : passes_(std::make_unique<Passes>(world, files)) {}

GraphPasses::~GraphPasses() = default;

Result<RegionsOfZone> GraphPasses::find_regions(size_t slot, int32_t workers,
                                                const Context& context) {
  return passes_->find_regions(slot, workers, context);
}

void GraphPasses::enter(const RegionsOfZone& found) { passes_->enter(found); }

Result<void> GraphPasses::end_regions() { return passes_->end_regions(); }

Result<GraphPasses::Found> GraphPasses::find_links(size_t slot, int32_t workers,
                                                   const Context& context) {
  return passes_->find_links(slot, workers, context);
}

void GraphPasses::enter(const LinksOfZone& links,
                        std::span<const std::pair<uint32_t, uint32_t>> joined) {
  passes_->enter(links, joined);
}

GraphMade GraphPasses::finish() { return passes_->finish(); }

Result<GraphMade> make_graph(const world::WorldData& world, GraphFiles* files, int32_t workers,
                             Context& context) {
  const size_t zones = world.slots.size();
  const WorkerGroups groups = assign_workers(zones, workers);
  const auto over_zones = [&](const char* stage, auto pass) -> Result<void> {
    auto ok = side_by_side(
        zones, groups, context,
        [&](size_t slot) {
          if (context.on_progress) context.on_progress({stage, slot, zones});
        },
        [&](size_t slot, int32_t) -> Result<void> { return pass(slot); });
    if (ok && context.cancel) return cancelled();
    return ok;
  };
  GraphPasses passes(world, files);
  auto ok = over_zones("regions", [&](size_t slot) -> Result<void> {
    if (auto found = passes.find_regions(slot, groups.workers, context); !found) {
      return found.error();
    }
    return {};
  });
  if (ok) ok = passes.end_regions();
  if (!ok) return ok.error();
  std::mutex mutex;
  ok = over_zones("links", [&](size_t slot) -> Result<void> {
    auto found = passes.find_links(slot, groups.workers, context);
    if (!found) return found.error();
    const std::lock_guard lock(mutex);
    passes.enter(found->links, found->joined);
    return {};
  });
  if (!ok) return ok.error();
  return passes.finish();
}

}  // namespace throng::graph
