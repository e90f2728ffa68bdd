// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/region_groups.h"

#include <utility>

#include "core/files/var_number.h"
#include "world/cell_blocks.h"

// Packs and reads the groups of a zone's regions and where their components begin. Linear.
namespace throng::world {
namespace {

constexpr int64_t kMaxGroupCells = int64_t{1} << 40;    // of a component: sums fit 64 bits
constexpr uint64_t kMaxFeetChange = uint64_t{1} << 34;  // folded [mm]

uint32_t named_classes(const format::RegionGroup& group) {
  return group.classes() & ~uint32_t{group.begins()};
}

uint32_t below(uint32_t avatar_class) { return (uint32_t{1} << avatar_class) - 1; }

}  // namespace

bool BegunReader::next_place() {
  const auto tile_change = take_number(bytes, at), feet_change = take_number(bytes, at);
  if (!tile_change || !feet_change || *feet_change > kMaxFeetChange) return false;
  // Wraps in forged files, into what is refused.
  const uint64_t next = tile + static_cast<uint64_t>(unfolded(*tile_change));
  feet += unfolded(*feet_change);
  tile = static_cast<uint32_t>(next);
  cells = 0;
  return next <= UINT16_MAX && feet >= INT32_MIN && feet <= INT32_MAX;
}

bool BegunReader::next_cells() {
  const auto change = take_number(bytes, at);
  if (!change || *change > 2 * kMaxGroupCells) return false;
  // The first as it is, the rest folded: where classes begin together they have about as many.
  cells = cells == 0 ? static_cast<int64_t>(*change) : cells + unfolded(*change);
  return cells > 0 && cells <= kMaxGroupCells;
}

void GroupWriter::add(const Group& group) {
  const auto own = static_cast<uint32_t>(tables_.groups.size());
  if (own % RegionGroups::kBlock == 0) {
    tables_.blocks.emplace_back(static_cast<uint32_t>(tables_.names.size()), components_);
  }
  uint32_t begins = 0;
  size_t part = 0, begun = 0;
  int64_t before = 0;
  for (uint32_t left = group.classes; left != 0; left &= left - 1, ++part) {
    if (group.begins_in[part] != own) {
      put_number(tables_.names, group.begins_in[part]);
      continue;
    }
    if (begins == 0) {
      put_number(tables_.begun, folded(group.tile - tile_));
      put_number(tables_.begun, folded(group.feet - feet_));
      tile_ = group.tile;
      feet_ = group.feet;
    }
    begins |= left & (0 - left);
    const auto cells = static_cast<int64_t>(group.cells[begun++]);
    put_number(tables_.begun, before == 0 ? static_cast<uint64_t>(cells) : folded(cells - before));
    before = cells;
  }
  components_ += static_cast<uint32_t>(begun);
  tables_.groups.emplace_back(static_cast<uint16_t>(group.classes), static_cast<uint16_t>(begins));
}

const char* RegionGroups::fault(uint32_t classes, std::vector<uint32_t>& begins_in) const {
  if (blocks.size() != (groups.size() + kBlock - 1) / kBlock) return "its groups miss their blocks";
  begins_in.assign(groups.size() * classes, 0);
  size_t name = 0;
  uint32_t components = 0;
  BegunReader reader{begun};
  for (uint32_t g = 0; g < groups.size(); ++g) {
    const uint32_t all = groups[g].classes(), begins = groups[g].begins();
    if (all == 0 || all >> classes != 0 || (begins & ~all) != 0) return "a group makes no sense";
    if (g % kBlock == 0 && (blocks[g / kBlock].first_name() != name ||
                            blocks[g / kBlock].components() != components)) {
      return "a block of groups miscounts";
    }
    if (begins != 0 && !reader.next_place()) return "a component is nowhere";
    for (uint32_t c = 0; c < classes; ++c) {
      if ((all >> c & 1) == 0) continue;
      uint32_t& in = begins_in[size_t{g} * classes + c] = g;
      if ((begins >> c & 1) != 0) {
        ++components;
        if (!reader.next_cells()) return "a component makes no sense";
        continue;
      }
      const auto number = take_number(names, name);
      if (!number || *number >= g || (groups[*number].begins() >> c & 1) == 0) {
        return "a group is of a component that does not begin there";
      }
      in = static_cast<uint32_t>(*number);
    }
  }
  if (name != names.size() || reader.at != begun.size()) {
    return "its groups miscount their components";
  }
  return nullptr;
}

uint32_t RegionGroups::component_count() const {
  if (groups.empty()) return 0;
  uint32_t count = blocks.back().components();
  for (size_t g = (blocks.size() - 1) * kBlock; g < groups.size(); ++g) {
    count += count_ones(groups[g].begins());
  }
  return count;
}

uint32_t RegionGroups::begins_in(uint32_t group, uint32_t avatar_class) const {
  const format::RegionGroup& own = groups[group];
  if ((own.begins() >> avatar_class & 1) != 0) return group;
  uint32_t skipped = count_ones(named_classes(own) & below(avatar_class));
  for (uint32_t g = group / kBlock * kBlock; g < group; ++g) {
    skipped += count_ones(named_classes(groups[g]));
  }
  size_t at = blocks[group / kBlock].first_name();
  for (; skipped > 0; ++at) skipped -= names[at] < 0x80 ? 1 : 0;
  uint32_t number = 0, shift = 0;
  for (; names[at] > 0x7f; shift += 7) number |= (names[at++] & 0x7fU) << shift;
  return number | uint32_t{names[at]} << shift;
}

uint32_t RegionGroups::component(uint32_t group, uint32_t avatar_class) const {
  const uint32_t in = begins_in(group, avatar_class);
  uint32_t number = blocks[in / kBlock].components();
  for (uint32_t g = in / kBlock * kBlock; g < in; ++g) number += count_ones(groups[g].begins());
  return number + count_ones(groups[in].begins() & below(avatar_class));
}

}  // namespace throng::world
