// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/share/column_owners.h"

#include <algorithm>

// A search around a column looks at all columns that its reach touches: nine as a rule.
namespace throng::crowd {

ColumnOwners::ColumnOwners(int32_t width, int32_t depth, int32_t rank) : rank_(rank) {
  const auto along = [&](int32_t cells) {
    return static_cast<int32_t>((((int64_t{cells} << world::kUnitBits) - 1) >> bits_) + 1);
  };
  while (static_cast<size_t>(along(width)) * static_cast<size_t>(along(depth)) > kMaxColumns) {
    ++bits_;
  }
  wide_ = along(width);
  deep_ = along(depth);
  set_owners(std::vector<int32_t>(static_cast<size_t>(wide_) * static_cast<size_t>(deep_), 0));
}

world::GroundPoint ColumnOwners::middle_of(uint32_t column) const {
  const int64_t x = column % static_cast<uint32_t>(wide_);
  const int64_t z = column / static_cast<uint32_t>(wide_);
  const int64_t half = int64_t{1} << (bits_ - 1);
  return {(x << bits_) + half, (z << bits_) + half};
}

void ColumnOwners::set_owners(std::vector<int32_t> owners) {
  owners_ = std::move(owners);
  find_neighbours();
}

void ColumnOwners::set_reach(int32_t reach) {
  if (reach == reach_) return;
  reach_ = reach;
  find_neighbours();
}

// Calls f(column, its x, its z) for each that lies, as a whole or in part, within the reach of
// some point of a column.
template <class F>
void ColumnOwners::for_columns_around(uint32_t column, F&& f) const {
  const auto x = static_cast<int32_t>(column % static_cast<uint32_t>(wide_));
  const auto z = static_cast<int32_t>(column / static_cast<uint32_t>(wide_));
  const int32_t ring = (reach_ >> bits_) + 1;
  for (int32_t row = std::max(z - ring, 0); row <= std::min(z + ring, deep_ - 1); ++row) {
    for (int32_t at = std::max(x - ring, 0); at <= std::min(x + ring, wide_ - 1); ++at) {
      f(static_cast<uint32_t>(row * wide_ + at), at, row);
    }
  }
}

void ColumnOwners::find_neighbours() {
  ++version_;
  neighbours_.clear();
  is_at_border_.assign(owners_.size(), false);
  is_near_.assign(owners_.size(), false);
  for (uint32_t column = 0; column < owners_.size(); ++column) {
    if (owners_[column] != rank_) continue;
    for_columns_around(column, [&](uint32_t other, int32_t, int32_t) {
      const int32_t owner = owners_[other];
      is_near_[other] = true;
      if (owner == rank_) return;
      is_at_border_[column] = true;
      const auto at = std::lower_bound(neighbours_.begin(), neighbours_.end(), owner);
      if (at == neighbours_.end() || *at != owner) neighbours_.insert(at, owner);
    });
  }
}

void ColumnOwners::find_near(int32_t x, int32_t z, std::vector<uint32_t>& near) const {
  near.clear();
  const uint32_t column = column_of(x, z);
  if (owners_[column] == rank_ && !is_at_border_[column]) return;
  for_columns_around(column, [&](uint32_t other, int32_t at, int32_t row) {
    const int32_t owner = owners_[other];
    if (owner == rank_) return;
    const auto gap = [&](int32_t from, int32_t of) -> int64_t {
      const int64_t low = int64_t{of} << bits_, high = low + (int64_t{1} << bits_) - 1;
      return std::max({low - from, from - high, int64_t{0}});
    };
    const int64_t dx = gap(x, at), dz = gap(z, row);
    if (dx * dx + dz * dz > int64_t{reach_} * reach_) return;
    const auto found = std::lower_bound(neighbours_.begin(), neighbours_.end(), owner);
    if (found == neighbours_.end() || *found != owner) return;
    const auto n = static_cast<uint32_t>(found - neighbours_.begin());
    const auto place = std::lower_bound(near.begin(), near.end(), n);
    if (place == near.end() || *place != n) near.insert(place, n);
  });
}

}  // namespace throng::crowd
