// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/zone_components.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "core/arrays/disjoint_sets.h"
#include "core/hash.h"
#include "world/place.h"

// A part is one class's share of a region, and belongs to no other class: one forest serves all.
// Its roots are the first of their components, so that what a region belongs to is the list of the
// roots of its parts; regions with the same classes and the same list are a group.
namespace throng::graph {
namespace {

// Which of the regions so far has the same list. Numbers are given in the order of regions, so
// nothing depends on the order of the table.
class GroupTable {
 public:
  GroupTable(const world::RegionTables& tables, const ZoneParts& parts,
             std::span<const uint32_t> roots)
      : tables_(tables), parts_(parts), roots_(roots) {
    slots_.assign(std::bit_ceil(2 * tables.regions.size() + 1), kFree);
  }

  // The first region like this one: itself, if it is new.
  uint32_t first_like(uint32_t region) {
    const auto own = list(region);
    const uint64_t hash = hash_span(own, tables_.regions[region].classes());
    for (size_t i = hash & (slots_.size() - 1);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i] == kFree) return slots_[i] = region;
      const auto other = list(slots_[i]);
      if (tables_.regions[slots_[i]].classes() == tables_.regions[region].classes() &&
          std::equal(own.begin(), own.end(), other.begin(), other.end())) {
        return slots_[i];
      }
    }
  }

 private:
  static constexpr uint32_t kFree = UINT32_MAX;

  [[nodiscard]] std::span<const uint32_t> list(uint32_t region) const {
    return roots_.subspan(parts_.first[region], parts_.first[region + 1] - parts_.first[region]);
  }

  const world::RegionTables& tables_;
  const ZoneParts& parts_;
  std::span<const uint32_t> roots_;
  std::vector<uint32_t> slots_;
};

// Roots of all parts, by the links.
std::vector<uint32_t> find_roots(const ZoneParts& parts, const world::RegionTables& tables) {
  DisjointSets sets(parts.cells.size());
  const auto part_of = [&](uint32_t region, uint32_t below) {
    return parts.first[region] +
           static_cast<uint32_t>(std::popcount(tables.regions[region].classes() & below));
  };
  for (const format::RegionLink& link : tables.links) {
    for (uint32_t left = link.classes(); left != 0; left &= left - 1) {
      const uint32_t below = (left & (0 - left)) - 1;
      sets.join(part_of(link.a(), below), part_of(link.b(), below));
    }
  }
  std::vector<uint32_t> roots(parts.cells.size());
  for (uint32_t part = 0; part < roots.size(); ++part) roots[part] = sets.find(part);
  return roots;
}

}  // namespace

void find_components(const world::WorldData& world, size_t slot, const ZoneParts& parts,
                     world::RegionTables& tables) {
  const std::vector<uint32_t> roots = find_roots(parts, tables);
  std::vector<uint64_t> cells(roots.size(), 0);  // of the components, at their roots
  for (size_t part = 0; part < roots.size(); ++part) cells[roots[part]] += parts.cells[part];

  const uint32_t first_level = world.slots[slot]->first_level;
  std::vector<uint32_t> begins_in(roots.size(), 0);  // the group, at the roots
  std::vector<uint32_t> of_group;
  std::vector<uint64_t> begun;
  GroupTable like(tables, parts, roots);
  world::GroupWriter writer;
  uint32_t groups = 0;
  for (uint32_t level = 0; level + 1 < tables.first.size(); ++level) {
    for (uint32_t r = tables.first[level]; r < tables.first[level + 1]; ++r) {
      format::Region& region = tables.regions[r];
      const uint32_t first = like.first_like(r);
      const uint32_t group = first == r ? groups : tables.regions[first].group();
      region = {group, region.key(), region.classes()};
      if (first != r) continue;
      ++groups;
      of_group.clear();
      begun.clear();
      for (uint32_t part = parts.first[r]; part < parts.first[r + 1]; ++part) {
        if (roots[part] == part) {
          begins_in[part] = group;
          begun.push_back(cells[part]);
        }
        of_group.push_back(begins_in[roots[part]]);
      }
      world::GroupWriter::Group added{
          .classes = region.classes(), .begins_in = of_group, .cells = begun};
      if (!begun.empty()) {
        const world::GroundLevel ground = world::ground_level(world, first_level + level, 0);
        constexpr int32_t kMiddle = world::kUnitsPerCell / 2;
        added.tile = ground.view.record->tile();
        added.feet = ground.view.feet(region.key() % kTileCells, region.key() / kTileCells, kMiddle,
                                      kMiddle);
      }
      writer.add(added);
    }
  }
  tables.groups = writer.take();
}

}  // namespace throng::graph
