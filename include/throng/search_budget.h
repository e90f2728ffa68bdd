// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>

/// Limits after which a search for a path stops without a result.
namespace throng {

/// The part of a budget that a search exhausted.
enum class SpentBudget : uint8_t {
  kNone,
  kNodes,      ///< SearchBudget::max_nodes.
  kMemory,     ///< SearchBudget::max_bytes.
  kCancelled,  ///< SearchBudget::cancel was set.
};

/// The budget of a search. A plain number converts to `max_nodes`.
struct SearchBudget {
  /// Enough for every measured path over cities and landscapes, and small beside a machine's
  /// memory. [bytes]
  static constexpr uint64_t kDefaultBytes = uint64_t{256} << 20;

  // NOLINTNEXTLINE(google-explicit-constructor)
  SearchBudget(uint64_t nodes = UINT64_MAX, const std::atomic<bool>* stop = nullptr,
               uint64_t bytes = kDefaultBytes)
      : max_nodes(nodes), cancel(stop), max_bytes(bytes) {}

  uint64_t max_nodes;
  /// Set from any thread to stop; read every 64 nodes. May be null.
  const std::atomic<bool>* cancel;
  /// Limit of the memory of one query, beside what the finder holds of the world (corners, zones,
  /// labels). It counts what the query uses, not what earlier queries allocated, so the result is
  /// the same on every machine. [bytes]
  uint64_t max_bytes;

  /// Is the budget exhausted? Call it with 1, 2, 3 ... before each node is expanded.
  [[nodiscard]] bool is_spent(uint64_t nodes) const {
    return nodes > max_nodes || (cancel != nullptr && nodes % 64 == 1 && *cancel);
  }
  /// The same, with the memory of the search so far. [bytes]
  [[nodiscard]] bool is_spent(uint64_t nodes, uint64_t bytes) const {
    return bytes > max_bytes || is_spent(nodes);
  }
  /// Which part a search exhausted that stopped after so many nodes.
  [[nodiscard]] SpentBudget spent(uint64_t nodes) const {
    if (nodes > max_nodes) return SpentBudget::kNodes;
    return cancel != nullptr && *cancel ? SpentBudget::kCancelled : SpentBudget::kMemory;
  }
  /// The budget that is left after so many nodes.
  [[nodiscard]] SearchBudget after(uint64_t nodes) const {
    SearchBudget left = *this;
    left.max_nodes = nodes < max_nodes ? max_nodes - nodes : 0;
    return left;
  }
};

}  // namespace throng
