// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// Processes that share a task. All call the same in the same order.
namespace throng {

class RankGroup {
 public:
  using Bytes = std::vector<uint8_t>;

  virtual ~RankGroup() = default;
  [[nodiscard]] virtual int32_t rank() const = 0;
  [[nodiscard]] virtual int32_t size() const = 0;

  /// What each rank gave, by rank. Stays until the next call.
  virtual std::span<const Bytes> gather(std::span<const uint8_t> mine) = 0;
  /// Sends to[n] to rank ranks[n], and returns what that sent to this one; stays until the next
  /// call. A rank is among the ranks of those that are among its own. None is this rank.
  virtual std::span<const Bytes> exchange(std::span<const int32_t> ranks,
                                          std::span<const Bytes> to) = 0;

  /// A point of the plane and how much it counts.
  struct Weight {
    double x = 0, z = 0;
    float weight = 0;
  };
  /// Divides points among the ranks, so that those of each lie together and weigh about as much as
  /// those of any other: the rank of each. The same for the same points.
  [[nodiscard]] virtual std::vector<int32_t> divide(std::span<const Weight> points) = 0;
};

}  // namespace throng
