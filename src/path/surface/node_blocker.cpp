// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "graph/node_mesh.h"
#include "path/surface/node_changes.h"
#include "world/ground.h"

// Which change keeps a class from a point of a block. Time: the changes of its tile or block, with
// the cells and squares of each.
namespace throng::path {

FoundBlocker NodeChanges::blocker_at(uint32_t block, double s, double t) const {
  const graph::NodeBlock& whole = mesh_->blocks()[block];
  const bool is_tile = mesh_->surface(block).points == nullptr;
  const uint8_t level = is_tile ? uint8_t{6} : finest_level(whole);
  const double count = 1 << level;
  const auto index = [&](double part) {
    return static_cast<uint32_t>(std::clamp(std::floor(part * count), 0.0, count - 1));
  };
  const uint32_t x = index(s), z = index(t);
  const uint32_t order = graph::quad_order(x, z, level);
  const auto holds = [&](const Change& change) {
    const auto has_cell = [&](const BlockedTile& tile) {
      return tile.patch == whole.patch && (tile.rows[z] >> x & 1) != 0;
    };
    const auto is_square = [&](const BlockedSquare& square) {
      return square.block == block && square.order == order;
    };
    return is_tile ? std::any_of(change.tiles.begin(), change.tiles.end(), has_cell)
                   : std::any_of(change.squares.begin(), change.squares.end(), is_square);
  };
  const ChangesByPlace& by_place = is_tile ? tile_changes_ : block_changes_;
  const auto here = by_place.find(is_tile ? whole.patch : block);
  if (here == by_place.end()) return {};
  FoundBlocker found;
  for (const ChangeId id : here->second) {
    const Change& change = changes_[id - 1];
    if (!holds(change)) continue;
    if (change.kind == Kind::kSolid) return {Blocker::kObstacle, id};
    // Of areas the last one counts.
    found = {};
    if (std::isinf(area_cost_[change.area])) found = {Blocker::kClosed, id};
  }
  return found;
}

}  // namespace throng::path
