// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/overlay_changes.h"

#include <algorithm>
#include <limits>

// Marks the overlay cells that obstacles touch, moves their entrances, and computes their rows of
// costs when a search first needs them. Time of an update: n log n in the blocks of the lowest
// cells that obstacles touch; of a row: a Dijkstra search over one cell.
namespace throng::path {

void OverlayChanges::update() {
  if (overlay_->empty()) return;
  blocks_.clear();
  moved_.clear();
  rows_.clear();
  in_graph_ = graph::kNoNode;
  const auto& overlay_levels = overlay_->overlay_levels();
  if (stale_.empty()) {
    if (view_->is_as_baked()) return;
    for (const Overlay::OverlayLevel& overlay_level : overlay_levels)
      stale_.emplace_back(overlay_level.first.size() - 1);
    stale_of_level_.resize(overlay_levels.size());
  }
  for (size_t k = 0; k < overlay_levels.size(); ++k) {
    for (const uint32_t overlay_cell : stale_of_level_[k]) stale_[k][overlay_cell] = 0;
    stale_of_level_[k].clear();
  }
  if (view_->is_as_baked()) return;
  const NodeChanges& changes = *view_->changes();
  for (const uint32_t block : changes.touched()) {
    uint32_t overlay_cell = overlay_->of_block()[block];
    for (size_t k = 0; k < overlay_levels.size() && stale_[k][overlay_cell] == 0; ++k) {
      stale_[k][overlay_cell] = 1;
      stale_of_level_[k].push_back(overlay_cell);
      if (k + 1 < overlay_levels.size()) overlay_cell = overlay_levels[k].above[overlay_cell];
    }
  }
  for (const uint32_t overlay_cell : stale_of_level_.front()) {
    std::vector<uint32_t>& blocks = blocks_[overlay_cell];
    for (const uint32_t block : overlay_->blocks_of(overlay_cell)) {
      const auto parts = changes.parts_of(block);
      if (!parts) blocks.push_back(block);
      for (uint32_t p = parts ? parts->first : 0; parts && p < parts->second; ++p)
        blocks.push_back(p);
    }
    std::sort(blocks.begin(), blocks.end());
  }
  for (const NodeChanges::Replaced& replaced : changes.replaced()) {
    const uint32_t entry = overlay_->entry_of({replaced.portal, false});
    if (entry != graph::kNoNode) move_entrance(entry / 2, replaced.first, replaced.last);
  }
}

void OverlayChanges::move_entrance(uint32_t entrance, uint32_t first, uint32_t last) {
  const graph::NodePortal old = view_->mesh().portals()[overlay_->entrances()[entrance].portal];
  Entrance moved;
  const auto size = [&](const graph::NodePortal& portal) {
    const graph::NodeSurface& surface = view_->surface(portal.a);
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
  if (moved.portal == graph::kNoNode) {
    const std::vector<uint32_t>& of_block = overlay_->of_block();
    const uint32_t from = of_block[old.a], to = of_block[old.b];
    const Vec3d was = overlay_->at(2 * entrance);
    double nearest = std::numeric_limits<double>::infinity();
    for (const uint32_t block : blocks_.at(from)) {
      for (const uint32_t p : view_->portals_of(block)) {
        const graph::PortalSides portal = view_->sides(p);
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
  if (moved.portal != graph::kNoNode) {
    for (const bool backward : {false, true}) {
      const Crossing crossing{moved.portal, backward != moved.turned};
      moved.at[backward ? 1 : 0] = position(*view_, ends_of(*view_, crossing).in);
    }
  }
  moved_.emplace(entrance, moved);
}

std::span<const float> OverlayChanges::costs_from(uint32_t entry) {
  const auto known = rows_.find(entry);
  if (known != rows_.end()) return known->second;
  const Overlay::OverlayLevel& overlay_level = overlay_->overlay_levels().front();
  const uint32_t overlay_cell = overlay_level.of_entry[entry];
  const auto entries = overlay_level.entries_of(overlay_cell);
  std::vector<float>& row = rows_[entry];
  row.assign(entries.size(), std::numeric_limits<float>::infinity());
  if (is_closed(entry)) return row;
  if (overlay_cell != in_graph_) graph_.set(blocks_.at(overlay_cell), true);
  in_graph_ = overlay_cell;
  const std::vector<double>& costs = graph_.run(ends_of(*view_, crossing(entry)).in);
  for (size_t j = 0; j < entries.size(); ++j) {
    const uint32_t out = entries[j] ^ 1;
    if (entries[j] == entry || is_closed(out)) continue;
    const uint32_t arc = graph_.arc_of(crossing(out));
    if (arc != graph::kNoNode) row[j] = static_cast<float>(costs[arc]);
  }
  return row;
}

}  // namespace throng::path
