// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/arrays/huge_array.h"
#include "crowd/ground/avatars.h"
#include "crowd/ground/pixel_grid.h"

/// Which avatars move at the same time.
namespace throng::crowd {

/// The world in square blocks of pixels. Blocks of one colour (of four) lie a whole block apart, so
/// an avatar that moves in one of them reads and writes nothing that an avatar in another touches,
/// as long as avatars have not drifted far since they were last sorted. Within a block avatars move
/// in a fixed order. So every move sees the current places of all others, and the order, hence the
/// result, is the same for any number of threads.
class CrowdBlocks {
 public:
  static constexpr uint32_t kColours = 4;

  CrowdBlocks(int32_t width, int32_t depth, PixelGrid grid, int32_t block_pixels);

  /// Blocks are numbered by colour, then row by row: what moves at the same time lies together.
  [[nodiscard]] uint32_t block(const Avatar& avatar) const {
    const auto x = static_cast<uint32_t>(grid_.pixel(avatar.x >> world::kUnitBits) / block_pixels_);
    const auto z = static_cast<uint32_t>(grid_.pixel(avatar.z >> world::kUnitBits) / block_pixels_);
    const uint32_t colour = (z & 1) * 2 + (x & 1);
    return (colour * half_z_ + z / 2) * half_x_ + x / 2;
  }
  /// Sorts avatars by block and, within it, by level: neighbours in memory read the same ground.
  void sort(HugeArray<Avatar>& avatars, HugeArray<Avatar>& scratch, int32_t workers);

  /// A block that holds avatars: [first, last).
  struct Run {
    uint32_t first, last;
  };
  [[nodiscard]] const std::vector<Run>& runs(uint32_t colour) const { return runs_[colour]; }
  [[nodiscard]] uint64_t bytes() const;

 private:
  PixelGrid grid_;
  int32_t block_pixels_;
  uint32_t half_x_, half_z_;  // blocks of a colour
  std::vector<uint32_t> first_;
  std::array<std::vector<Run>, kColours> runs_;
};

}  // namespace throng::crowd
