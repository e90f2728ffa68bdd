// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/surface/node_island.h"

// Finds the blocks that obstacles cut off from the rest, by a breadth-first flood over crossings
// that stops at kMax blocks. Time: linear in the crossings of the blocks that it visits.
namespace throng::path {

void NodeIsland::clear(const NodeView& view) {
  marks_.resize(view.block_count());
  if (++query_ == 0) {  // After 2^32 queries the marks start over.
    marks_.clear();
    query_ = 1;
  }
}

bool NodeIsland::close(const NodeView& view, uint32_t from, uint32_t other, Direction direction) {
  if (from == other) return false;
  if (holds(from)) return true;
  marks_[from] = query_;
  found_.assign(1, from);
  for (size_t i = 0; i < found_.size(); ++i) {
    const uint32_t block = found_[i];
    bool meets = false;
    const auto add = [&](const Crossing& crossing) {
      const graph::PortalSides portal = view.sides(crossing.portal);
      const uint32_t next = portal.a == block ? portal.b : portal.a;
      meets |= next == other;
      if (holds(next)) return;
      marks_[next] = query_;
      found_.push_back(next);
    };
    if (direction == Direction::kOut) {
      for_each_arc_out(view, block, add);
    } else {
      for_each_arc_in(view, block, add);
    }
    if (!meets && found_.size() <= kMax) continue;
    for (const uint32_t open : found_) marks_[open] = 0;
    return false;
  }
  return true;
}

}  // namespace throng::path
