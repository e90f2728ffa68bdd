// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/access.h"
#include "path/edits/blocked_cells.h"
#include "path/edits/plan_shapes.h"
#include "path/surface/floors_near.h"
#include "path/surface/node_changes.h"
#include "world/ground.h"

// Areas and off-mesh links on a mesh of nodes. Which cells and squares an area holds is found once;
// where a tile or block is cut, its areas are laid over each other in the order in which they were
// added. Time of an update: n log n in the cells and squares of the areas there.
namespace throng::path {

ChangeId NodeChanges::add_area(const Prism& prism, uint8_t kind) {
  Change change;
  change.kind = Kind::kArea;
  change.area = kind;
  const world::WorldData& world = *data_of(data_of(mesh_->nodes())->world);
  for_floors_near(
      *mesh_, prism.corners, world.summary.cell, [&](uint32_t patch, const TileFloor& floor) {
        const world::CellRows rows = cells_in(floor, prism);
        if (std::any_of(rows.begin(), rows.end(), [](uint64_t row) { return row != 0; })) {
          change.tiles.push_back({patch, rows});
        }
      });
  Box3d box;
  for (const auto& [x, z] : prism.corners) {
    box.add({x, prism.low, z});
    box.add({x, prism.high, z});
  }
  std::vector<uint32_t> near;
  squares_->for_each_near((box.min + box.max) * 0.5, length(box.max - box.min) / 2,
                          [&](uint32_t block) { near.push_back(block); });
  std::sort(near.begin(), near.end());
  for (const uint32_t block : near) mark_squares(prism, block, change);
  return keep(std::move(change));
}

ChangeId NodeChanges::add_link(const Link& link) {
  Change change;
  change.kind = Kind::kLink;
  change.link = link;
  return keep(std::move(change));
}

void NodeChanges::set_area_cost(uint8_t kind, double cost) {
  if (area_cost_[kind] == cost) return;
  area_cost_[kind] = cost;
  bool is_held = false;  // by some of the mesh
  for (const ChangeId id : active_) {
    const Change& change = changes_[id - 1];
    if (change.kind != Kind::kArea || change.area != kind) continue;
    list(id, true);
    is_held = is_held || !change.tiles.empty() || !change.squares.empty();
  }
  if (is_held) ++version_;
}

void NodeChanges::mark_squares(const Prism& prism, uint32_t block, Change& change) const {
  const graph::NodeBlock& whole = mesh_->blocks()[block];
  const graph::NodeSurface& surface = mesh_->surface(block);
  const uint8_t finest = finest_level(whole);
  const uint32_t times = 1u << (finest - whole.level);
  const double side = 1.0 / (1 << finest);
  for (uint32_t t = whole.t * times; t < (whole.t + 1) * times; ++t) {
    for (uint32_t s = whole.s * times; s < (whole.s + 1) * times; ++s) {
      const Vec3d middle = surface.at((s + 0.5) * side, (t + 0.5) * side);
      if (middle.y < prism.low || middle.y > prism.high) continue;
      if (is_nearer({middle.x, middle.z, middle.x, middle.z}, prism.corners, 1e-9))
        change.squares.push_back({block, graph::quad_order(s, t, finest)});
    }
  }
}

NodeChanges::TileLabels NodeChanges::tile_labels(uint32_t patch) const {
  TileLabels labels{patch, {}, {}};
  const auto changes = tile_changes_.find(patch);
  if (changes == tile_changes_.end()) return labels;
  for (const ChangeId id : changes->second) {
    const Change& change = changes_[id - 1];
    auto at = std::lower_bound(change.tiles.begin(), change.tiles.end(), patch,
                               [](const BlockedTile& one, uint32_t p) { return one.patch < p; });
    for (; at != change.tiles.end() && at->patch == patch; ++at) {
      const BlockedTile& tile = *at;
      world::CellRows* rows = &labels.blocked;
      if (change.kind == Kind::kArea) {
        for (auto& [area, cells] : labels.areas) {
          for (size_t k = 0; k < 64; ++k) cells[k] &= ~tile.rows[k];
        }
        auto known = std::find_if(labels.areas.begin(), labels.areas.end(),
                                  [&](const auto& one) { return one.first == change.area; });
        if (known == labels.areas.end())
          known = labels.areas.insert(known, {change.area, world::CellRows{}});
        rows = &known->second;
      }
      for (size_t k = 0; k < 64; ++k) (*rows)[k] |= tile.rows[k];
    }
  }
  for (const auto& [area, cells] : labels.areas) {
    if (!std::isinf(area_cost_[area])) continue;
    for (size_t k = 0; k < 64; ++k) labels.blocked[k] |= cells[k];
  }
  std::erase_if(labels.areas, [&](const auto& one) {
    return area_cost_[one.first] == 1 || std::isinf(area_cost_[one.first]);
  });
  return labels;
}

// By order, rising.
std::vector<NodeChanges::SquareLabel> NodeChanges::square_labels(uint32_t block) const {
  std::vector<RankedSquare> all;
  const auto changes = block_changes_.find(block);
  if (changes == block_changes_.end()) return {};
  for (const ChangeId id : changes->second) {
    const Change& change = changes_[id - 1];
    const bool is_area = change.kind == Kind::kArea;
    // They are in order of block.
    auto at = std::lower_bound(change.squares.begin(), change.squares.end(), block,
                               [](const BlockedSquare& s, uint32_t b) { return s.block < b; });
    for (; at != change.squares.end() && at->block == block; ++at)
      all.push_back({*at, is_area ? id : UINT32_MAX, is_area ? int{change.area} : kBlocked});
  }
  std::sort(all.begin(), all.end(), [](const RankedSquare& a, const RankedSquare& b) {
    return a.square != b.square ? a.square < b.square : a.rank < b.rank;
  });
  std::vector<SquareLabel> squares;
  for (size_t i = 0; i < all.size(); ++i) {
    if (i + 1 < all.size() && all[i + 1].square == all[i].square) continue;
    const double cost = area_cost_[static_cast<size_t>(all[i].label)];
    if (all[i].label != kBlocked && cost == 1) continue;
    squares.push_back({all[i].square, std::isinf(cost) ? kBlocked : all[i].label});
  }
  return squares;
}

// Where an end is blocked, a link is not in force.
void NodeChanges::add_links() {
  link_costs_.clear();
  first_link_ = static_cast<uint32_t>(mesh_->portals().size() + portals_.size());
  for (const ChangeId id : active_) {
    const Change& change = changes_[id - 1];
    if (change.kind != Kind::kLink) continue;
    const LinkEnd &from = change.link.from, &to = change.link.to;
    const uint32_t a = part_at(from.block, from.s, from.t), b = part_at(to.block, to.s, to.t);
    if (a == graph::kNoNode || b == graph::kNoNode) continue;
    const auto add = [&](bool backward, bool one_way) {
      graph::NodePortal portal{.a = a,
                               .b = b,
                               .on_a = {from.s, from.t, from.s, from.t},
                               .on_b = {to.s, to.t, to.s, to.t},
                               .kind = LinkKind::kOffMesh,
                               .over_hole = true,
                               .one_way = one_way};
      if (backward) std::swap(portal.on_a, portal.on_b);
      portals_.push_back(portal);
      link_costs_.push_back(change.link.cost);
    };
    // Within one block the sides of a portal do not state its direction.
    add(false, !change.link.two_way || a == b);
    if (change.link.two_way && a == b) add(true, true);
  }
}

void NodeChanges::find_min_factor() {
  min_factor_ = 1;
  for (const uint8_t area : area_of_part_) min_factor_ = std::min(min_factor_, area_cost_[area]);
  for (size_t k = 0; k < link_costs_.size(); ++k) {
    const graph::NodePortal& portal = portals_[portals_.size() - link_costs_.size() + k];
    const double straight =
        length(mesh_->patches()[block_of_part(portal.b).patch].at(portal.on_b[0], portal.on_b[1]) -
               mesh_->patches()[block_of_part(portal.a).patch].at(portal.on_a[0], portal.on_a[1]));
    if (link_costs_[k] < straight * min_factor_) min_factor_ = link_costs_[k] / straight;
  }
}

}  // namespace throng::path
