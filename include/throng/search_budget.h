// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>

/// When searches for ways stop without an answer.
namespace throng {

/// What a search had too little of.
enum class SpentBudget : uint8_t {
  kNone,
  kNodes,      ///< SearchBudget::max_nodes.
  kMemory,     ///< SearchBudget::max_bytes.
  kCancelled,  ///< SearchBudget::cancel was set.
};

/// How far a search may go before it gives up. A number of its own nodes is one.
struct SearchBudget {
  /// Enough for every path over worlds of cities and landscapes that was measured, and little
  /// beside what a machine has. [bytes]
  static constexpr uint64_t kDefaultBytes = uint64_t{256} << 20;

  // NOLINTNEXTLINE(google-explicit-constructor)
  SearchBudget(uint64_t nodes = UINT64_MAX, const std::atomic<bool>* stop = nullptr,
               uint64_t bytes = kDefaultBytes)
      : max_nodes(nodes), cancel(stop), max_bytes(bytes) {}

  uint64_t max_nodes;
  /// Set from any thread to stop; looked at every 64 nodes. May be null.
  const std::atomic<bool>* cancel;
  /// What one query may remember while it searches, beside what its finder holds of the world
  /// (corners, zones, labels). Does not depend on what earlier queries left allocated, so that the
  /// answer is the same on every machine. [bytes]
  uint64_t max_bytes;

  /// Asked with 1, 2, 3 ... before each node is looked at.
  [[nodiscard]] bool is_spent(uint64_t nodes) const {
    return nodes > max_nodes || (cancel != nullptr && nodes % 64 == 1 && *cancel);
  }
  /// The same, with what the search remembers by now. [bytes]
  [[nodiscard]] bool is_spent(uint64_t nodes, uint64_t bytes) const {
    return bytes > max_bytes || is_spent(nodes);
  }
  /// Why a search gave up after so many nodes.
  [[nodiscard]] SpentBudget spent(uint64_t nodes) const {
    if (nodes > max_nodes) return SpentBudget::kNodes;
    return cancel != nullptr && *cancel ? SpentBudget::kCancelled : SpentBudget::kMemory;
  }
  /// What is left of it after so many nodes.
  [[nodiscard]] SearchBudget after(uint64_t nodes) const {
    SearchBudget left = *this;
    left.max_nodes = nodes < max_nodes ? max_nodes - nodes : 0;
    return left;
  }
};

}  // namespace throng
