// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "world/walk.h"

/// Which rank moves the bodies of which part of the plane. docs/design/019-ranks.md.
namespace throng::crowd {

/// The plane in square columns of whole tiles, all levels above each other; each has an owner.
class ColumnOwners {
 public:
  static constexpr size_t kMaxColumns = size_t{1} << 18;

  /// Of a world of so many cells; `rank` is this one. At first rank 0 owns all.
  ColumnOwners(int32_t width, int32_t depth, int32_t rank);

  [[nodiscard]] size_t columns() const { return owners_.size(); }
  [[nodiscard]] uint32_t column_of(int32_t x, int32_t z) const {  // [units]
    return static_cast<uint32_t>((z >> bits_) * wide_ + (x >> bits_));
  }
  /// The middle of a column. [units]
  [[nodiscard]] world::GroundPoint middle_of(uint32_t column) const;
  [[nodiscard]] int32_t owner_at(int32_t x, int32_t z) const { return owners_[column_of(x, z)]; }
  /// Tiles along a column's side.
  [[nodiscard]] int32_t tiles() const { return 1 << (bits_ - kTileUnitBits); }

  void set_owners(std::vector<int32_t> owners);
  /// Another one after each change of owners or reach.
  [[nodiscard]] uint64_t version() const { return version_; }
  /// Bodies that far off matter to each other. [units]
  void set_reach(int32_t reach);
  /// Ranks that own something so near to what this one owns that bodies there may matter to each
  /// other, in order. They have this one among theirs.
  [[nodiscard]] std::span<const int32_t> neighbours() const { return neighbours_; }
  /// Does this rank own a column within the reach of a tile's?
  [[nodiscard]] bool is_near(int32_t tile_x, int32_t tile_z) const {
    const int32_t bits = bits_ - kTileUnitBits;
    return is_near_[static_cast<size_t>((tile_z >> bits) * wide_ + (tile_x >> bits))];
  }
  /// Writes which of neighbours() own ground within the reach of a point of a column of this rank,
  /// or of one beside it, in order. [units]
  void find_near(int32_t x, int32_t z, std::vector<uint32_t>& near) const;

 private:
  static constexpr int32_t kTileUnitBits = world::kUnitBits + 6;

  void find_neighbours();
  template <class F>
  void for_columns_around(uint32_t column, F&& f) const;

  int32_t rank_ = 0;
  int32_t bits_ = kTileUnitBits;  // of the units along a side
  int32_t wide_ = 0, deep_ = 0;   // columns
  int32_t reach_ = 0;
  uint64_t version_ = 0;
  std::vector<int32_t> owners_;
  std::vector<bool> is_at_border_;  // of columns of this rank
  std::vector<bool> is_near_;
  std::vector<int32_t> neighbours_;
};

}  // namespace throng::crowd
