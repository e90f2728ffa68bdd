// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/collision_map.h"

#include <algorithm>
#include <new>

namespace throng {

CollisionMap::CollisionMap(int32_t width, int32_t depth, int32_t pixel_cells, int32_t low,
                           int32_t high, int32_t body_height)
    : low_(low - kSlab), body_height_(body_height) {
  const uint64_t units = static_cast<uint64_t>(pixel_cells) << kUnitBits;
  magic_ = ((uint64_t{1} << 52) + units - 1) / units;
  stride_ = static_cast<uint32_t>(width / pixel_cells) + 3;
  rows_ = static_cast<uint32_t>(depth / pixel_cells) + 3;
  plane_size_ = static_cast<uint64_t>(stride_) * rows_;
  const int32_t slab = std::max(kSlab, body_height / 48);
  slab_magic_ = (uint64_t{1} << 32) / static_cast<uint64_t>(slab);
  const int64_t slabs = (static_cast<int64_t>(high) - low_ + body_height) / slab + 2;
  size_ = plane_size_ * (static_cast<uint64_t>(slabs) / 64 + 2);
  // Zeroed by the system when first touched: an empty quarter of a city costs nothing.
  words_.reset(static_cast<uint64_t*>(std::calloc(size_, sizeof(uint64_t))));
  if (!words_) throw std::bad_alloc();
}

}  // namespace throng
