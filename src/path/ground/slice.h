// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

/// Searches in parts, for slices over frames.
namespace throng::path {

/// The nodes that one call of a search in parts may still expand. Every search that the call comes
/// to takes from the same slice. Unlike a SearchBudget it does not end a search: when nothing is
/// left, the search stays as it is, and the next call continues.
struct Slice {
  uint64_t left = UINT64_MAX;

  [[nodiscard]] bool is_empty() const { return left == 0; }
  /// For a node that is expanded now. [not empty]
  void take() { --left; }
  void take(uint64_t nodes) { left -= std::min(left, nodes); }
};

}  // namespace throng::path
