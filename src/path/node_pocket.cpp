// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/node_pocket.h"

namespace throng {

bool NodePocket::close(const NodeView& view, uint32_t from, uint32_t other, Way way) {
  if (from == other) return false;
  found_.assign(1, from);
  if (!of_block_.insert(from).second) return true;
  const auto give_up = [&] {
    for (const uint32_t block : found_) of_block_.erase(block);
    return false;
  };
  for (size_t i = 0; i < found_.size(); ++i) {
    bool meets = false;
    const auto look = [&](const Crossing& crossing) {
      const NodePortal& portal = view.portal(crossing.portal);
      const uint32_t next = portal.a == found_[i] ? portal.b : portal.a;
      meets |= next == other;
      if (of_block_.insert(next).second) found_.push_back(next);
    };
    const uint32_t block = found_[i];
    if (way == Way::kOut) {
      for_each_way_out(view, block, look);
    } else {
      for_each_way_in(view, block, look);
    }
    if (meets || found_.size() > kMost) return give_up();
  }
  return true;
}

}  // namespace throng
