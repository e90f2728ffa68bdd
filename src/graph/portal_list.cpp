// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/portal_list.h"

#include <cmath>

// Portals packed to 20 bytes where their ends are multiples of 1/128; others are stored in full.
namespace throng::graph {

bool PortalList::pack(const std::array<double, 4>& line, std::array<uint8_t, 4>& at,
                      uint8_t& insets) {
  insets = 0;
  for (size_t k = 0; k < 4; ++k) {
    const double half_cells = std::round(line[k] * kParts);
    if (!(half_cells >= 0 && half_cells <= kParts)) return false;
    at[k] = static_cast<uint8_t>(half_cells);
    int32_t inset = -1;
    while (inset <= 1 && number(at[k], inset) != line[k]) ++inset;
    if (inset > 1) return false;
    insets = static_cast<uint8_t>(insets | (inset + 1) << (2 * k));
  }
  return true;
}

void PortalList::add(const NodePortal& portal) {
  Packed packed{.a = portal.a, .b = portal.b, .on_a = {}, .on_b = {}, .kind = portal.kind};
  packed.flags =
      static_cast<uint8_t>((portal.over_hole ? kOverHole : 0) | (portal.one_way ? kOneWay : 0) |
                           (portal.inside ? kInside : 0));
  if (!pack(portal.on_a, packed.on_a, packed.insets_a) ||
      !pack(portal.on_b, packed.on_b, packed.insets_b)) {
    packed.flags |= kWide;
    packed.set_wide(static_cast<uint32_t>(wide_.size()));
    wide_.push_back(portal);
  }
  packed_.push_back(packed);
}

PortalList::PortalList(const std::vector<NodePortal>& portals) {
  packed_.reserve(portals.size());
  for (const NodePortal& portal : portals) add(portal);
}

void PortalList::add_all(std::vector<PortalList>& lists) {
  size_t count = packed_.size();
  for (const PortalList& list : lists) count += list.size();
  packed_.reserve(count);
  for (PortalList& list : lists) {
    const auto before = static_cast<uint32_t>(wide_.size());
    for (Packed packed : list.packed_) {
      if ((packed.flags & kWide) != 0) packed.set_wide(packed.wide() + before);
      packed_.push_back(packed);
    }
    wide_.insert(wide_.end(), list.wide_.begin(), list.wide_.end());
    list = {};
  }
}

}  // namespace throng::graph
