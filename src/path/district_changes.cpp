// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/district_changes.h"

#include <algorithm>
#include <limits>

namespace throng {

void DistrictChanges::update() {
  if (districts_->empty()) return;
  blocks_.clear();
  moved_.clear();
  rows_.clear();
  in_graph_ = kNoNode;
  const auto& tiers = districts_->tiers();
  if (stale_.empty()) {
    if (view_->is_as_baked()) return;
    for (const Districts::Tier& tier : tiers) stale_.emplace_back(tier.first.size() - 1);
    stale_of_tier_.resize(tiers.size());
  }
  for (size_t k = 0; k < tiers.size(); ++k) {
    for (const uint32_t district : stale_of_tier_[k]) stale_[k][district] = 0;
    stale_of_tier_[k].clear();
  }
  if (view_->is_as_baked()) return;
  const NodeChanges& changes = *view_->changes();
  for (const uint32_t block : changes.touched()) {
    uint32_t district = districts_->of_block()[block];
    for (size_t k = 0; k < tiers.size() && stale_[k][district] == 0; ++k) {
      stale_[k][district] = 1;
      stale_of_tier_[k].push_back(district);
      if (k + 1 < tiers.size()) district = tiers[k].above[district];
    }
  }
  for (const uint32_t district : stale_of_tier_.front()) {
    std::vector<uint32_t>& blocks = blocks_[district];
    for (const uint32_t block : districts_->blocks_of(district)) {
      const auto parts = changes.parts_of(block);
      if (!parts) blocks.push_back(block);
      for (uint32_t p = parts ? parts->first : 0; parts && p < parts->second; ++p)
        blocks.push_back(p);
    }
    std::sort(blocks.begin(), blocks.end());
  }
  for (const NodeChanges::Replaced& replaced : changes.replaced()) {
    const uint32_t entry = districts_->entry_of({replaced.portal, false});
    if (entry != kNoNode) move_gate(entry / 2, replaced.first, replaced.last);
  }
}

void DistrictChanges::move_gate(uint32_t gate, uint32_t first, uint32_t last) {
  const NodePortal old = view_->mesh().portals()[districts_->gates()[gate].portal];
  Gate moved;
  const auto size = [&](const NodePortal& portal) {
    const NodeSurface& surface = view_->surface(portal.a);
    return length(surface.at(portal.on_a[2], portal.on_a[3]) -
                  surface.at(portal.on_a[0], portal.on_a[1]));
  };
  double longest = -1;
  for (uint32_t p = first; p < last; ++p) {
    const double long_as = size(view_->portal(p));
    if (long_as <= longest) continue;
    longest = long_as;
    moved.portal = p;
  }
  if (moved.portal == kNoNode) {
    const std::vector<uint32_t>& of_block = districts_->of_block();
    const uint32_t from = of_block[old.a], to = of_block[old.b];
    const Vec3d was = districts_->at(2 * gate);
    double nearest = std::numeric_limits<double>::infinity();
    for (const uint32_t block : blocks_.at(from)) {
      for (const uint32_t p : view_->portals_of(block)) {
        const PortalSides portal = view_->sides(p);
        const bool turned = portal.a != block;
        if (portal.one_way != old.one_way || (portal.one_way && turned)) continue;
        if (of_block[view_->base_of(turned ? portal.a : portal.b)] != to) continue;
        const double far = length(position(*view_, ends_of(*view_, {p, turned}).in) - was);
        if (far > nearest || (far == nearest && p > moved.portal)) continue;
        nearest = far;
        moved.portal = p;
        moved.turned = turned;
      }
    }
  }
  if (moved.portal != kNoNode) {
    for (const bool backward : {false, true}) {
      const Crossing crossing{moved.portal, backward != moved.turned};
      moved.at[backward ? 1 : 0] = position(*view_, ends_of(*view_, crossing).in);
    }
  }
  moved_.emplace(gate, moved);
}

std::span<const float> DistrictChanges::costs_from(uint32_t entry) {
  const auto known = rows_.find(entry);
  if (known != rows_.end()) return known->second;
  const Districts::Tier& tier = districts_->tiers().front();
  const uint32_t district = tier.of_entry[entry];
  const auto entries = tier.entries_of(district);
  std::vector<float>& row = rows_[entry];
  row.assign(entries.size(), std::numeric_limits<float>::infinity());
  if (is_closed(entry)) return row;
  if (district != in_graph_) graph_.set(blocks_.at(district), true);
  in_graph_ = district;
  const std::vector<double>& costs = graph_.run(ends_of(*view_, crossing(entry)).in);
  for (size_t j = 0; j < entries.size(); ++j) {
    const uint32_t out = entries[j] ^ 1;
    if (entries[j] == entry || is_closed(out)) continue;
    const uint32_t way = graph_.way_of(crossing(out));
    if (way != kNoNode) row[j] = static_cast<float>(costs[way]);
  }
  return row;
}

}  // namespace throng
