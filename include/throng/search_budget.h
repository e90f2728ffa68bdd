// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>

/// When searches for ways stop without an answer.
namespace throng {

/// How far a search may go before it gives up. A number of its own nodes is one.
struct SearchBudget {
  // NOLINTNEXTLINE(google-explicit-constructor)
  SearchBudget(uint64_t most = UINT64_MAX, const std::atomic<bool>* stop = nullptr)
      : max_nodes(most), cancel(stop) {}

  uint64_t max_nodes;
  /// Set from any thread to stop; looked at every 64 nodes. May be null.
  const std::atomic<bool>* cancel;

  /// Asked with 1, 2, 3 ... before each node is looked at.
  [[nodiscard]] bool is_spent(uint64_t nodes) const {
    return nodes > max_nodes || (cancel != nullptr && nodes % 64 == 1 && *cancel);
  }
};

}  // namespace throng
