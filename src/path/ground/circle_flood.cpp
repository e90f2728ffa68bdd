// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/circle_flood.h"

#include <algorithm>

#include "world/tile_grid.h"

// The visited cells of a flood fill: a hash table with linear probing, emptied run by run. Constant
// time a cell on average.
namespace throng::path {
namespace {

// Never 0: levels count from 1 here.
uint64_t key_of(uint32_t level, int32_t x, int32_t z) {
  return (uint64_t{level} + 1) << 12 |
         static_cast<uint64_t>(world::cell_index(world::in_tile(x), world::in_tile(z)));
}

size_t slot_of(uint64_t key, size_t mask) {
  return static_cast<size_t>((key * 0x9e3779b97f4a7c15) >> 20) & mask;
}

}  // namespace

void CircleFlood::start(const world::GroundLevel& level, int32_t x, int32_t z) {
  if (seen_.empty()) seen_.resize(1024);
  if (cells_.size() * 8 < seen_.size()) {  // few: it is faster to erase them one by one
    for (const Cell& cell : cells_) {
      // A key in a run of occupied slots is probed only as far as the run goes: emptying the runs
      // of all keys empties the table.
      const uint64_t key = key_of(cell.level.world_level, cell.x, cell.z);
      for (size_t s = slot_of(key, seen_.size() - 1); seen_[s] != 0;
           s = (s + 1) & (seen_.size() - 1)) {
        seen_[s] = 0;
      }
    }
  } else {
    std::fill(seen_.begin(), seen_.end(), 0);
  }
  cells_.clear();
  next_ = 0;
  add_once(level.world_level, x, z);
  cells_.push_back({level, x, z});
}

bool CircleFlood::add_once(uint32_t level, int32_t x, int32_t z) {
  const uint64_t key = key_of(level, x, z);
  size_t slot = slot_of(key, seen_.size() - 1);
  for (; seen_[slot] != 0; slot = (slot + 1) & (seen_.size() - 1)) {
    if (seen_[slot] == key) return false;
  }
  seen_[slot] = key;
  if (cells_.size() * 2 > seen_.size()) grow();
  return true;
}

void CircleFlood::grow() {
  std::vector<uint64_t> old(seen_.size() * 4, 0);
  old.swap(seen_);
  const size_t mask = seen_.size() - 1;
  for (const uint64_t key : old) {
    if (key == 0) continue;
    size_t slot = slot_of(key, mask);
    while (seen_[slot] != 0) slot = (slot + 1) & mask;
    seen_[slot] = key;
  }
}

}  // namespace throng::path
