// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/tile_grid.h"
#include "world/walk.h"

/// How long ground takes now. docs/design/017-congestion.md.
namespace throng::path {

/// By squares of level tiles and by the direction in which they are walked: the share of their
/// desired speed at which avatars get on. A metre at a share of 1/4 takes the time of three metres
/// more, which count kWeight times.
class GroundDelays {
 public:
  static constexpr int32_t kSide = 16;  // of a square [cells]
  static constexpr int32_t kAcross = kTileCells / kSide;
  static constexpr size_t kDirections = 4;  // +x, +z, -x, -z
  static constexpr size_t kBins = size_t{kAcross} * kAcross * kDirections;
  /// Of the squares of a level, row by row, by direction. [kFree: the whole speed]
  using Shares = std::array<uint16_t, kBins>;
  static constexpr uint16_t kFree = UINT16_MAX;
  static constexpr double kWeight = 8;       // of delay by time on free ground
  static constexpr double kMaxDelayed = 40;  // the time that a metre is taken to need, at most
  static constexpr double kMaxFactor = 1 + kWeight * (kMaxDelayed - 1);

  explicit GroundDelays(size_t levels);

  /// Of a cell of a level's tile: the number of its first share.
  static size_t first_bin(int32_t x, int32_t z) {
    return static_cast<size_t>(z / kSide * kAcross + x / kSide) * kDirections;
  }
  /// The number of the direction that is nearest to a vector.
  static size_t direction(int64_t dx, int64_t dz);

  [[nodiscard]] size_t levels() const { return shares_.size(); }
  [[nodiscard]] Shares& shares(uint32_t level) { return shares_[level]; }
  [[nodiscard]] const Shares& shares(uint32_t level) const { return shares_[level]; }
  /// To be set where a share is not kFree.
  void set_slow(uint32_t level, uint8_t slow) { is_slow_[level] = slow; }
  [[nodiscard]] bool is_slow(uint32_t level) const { return is_slow_[level] != 0; }

  /// How much the delay in each direction counts for a segment: whole within 60 degrees of it, a
  /// quarter across it, hardly against it. No zigzag through a jam costs less than straight on.
  struct Heading {
    std::array<double, kDirections> weights{};
  };
  static Heading heading(world::GroundPoint from, world::GroundPoint to);
  /// By how much a metre at a cell of a level's tile is longer. [1 to kMaxFactor]
  [[nodiscard]] double factor(uint32_t level, int32_t x, int32_t z, const Heading& heading) const;
  /// Of a segment that stays on a level: its length times these factors. [cells]
  [[nodiscard]] double length(uint32_t level, world::GroundPoint from, world::GroundPoint to) const;

  [[nodiscard]] uint64_t bytes() const { return shares_.size() * (sizeof(Shares) + 1); }

 private:
  std::vector<Shares> shares_;    // by level
  std::vector<uint8_t> is_slow_;  // by level
};

}  // namespace throng::path
