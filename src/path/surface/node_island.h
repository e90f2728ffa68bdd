// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/arrays/paged.h"
#include "path/surface/node_view.h"

/// Blocks that are cut off from the rest by obstacles.
namespace throng::path {

class NodeIsland {
 public:
  enum class Direction { kOut, kIn };
  static constexpr size_t kMax = 4096;  ///< Blocks that are visited.

  /// Before the first of a query.
  void clear(const NodeView& view);
  /// Finds all blocks that paths lead to from a block, or from which they lead to it. True if these
  /// are an island that does not hold `other`: it is kept. False if it may be reached.
  bool close(const NodeView& view, uint32_t from, uint32_t other, Direction direction);
  /// Is a block in one of the islands found since clear()?
  [[nodiscard]] bool holds(uint32_t block) { return marks_[block] == query_; }

 private:
  Paged<uint32_t> marks_;  // by block
  uint32_t query_ = 0;
  std::vector<uint32_t> found_;
};

}  // namespace throng::path
