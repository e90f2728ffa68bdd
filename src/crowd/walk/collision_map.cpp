// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/collision_map.h"

#include <algorithm>
#include <cstdlib>

// The bits of the collision map of [TC00]: made in time linear in the pixels; a test or a move of a
// body is constant time.
namespace throng::crowd {

CollisionMap::CollisionMap(int32_t width, int32_t depth, PixelGrid grid, int32_t low, int32_t high,
                           int32_t body_height, Pages pages)
    : grid_(grid), low_(low - kSlab) {
  stride_ = static_cast<uint32_t>(width / grid.cells()) + 3;
  plane_size_ = uint64_t{stride_} * (static_cast<uint32_t>(depth / grid.cells()) + 3);
  const int32_t slab = std::max(kSlab, body_height / 48);
  slab_magic_ = (uint64_t{1} << 32) / static_cast<uint64_t>(slab);
  const int64_t slabs = (static_cast<int64_t>(high) - low_ + body_height) / slab + 2;
  words_ = HugeArray<uint64_t>(plane_size_ * (static_cast<uint64_t>(slabs) / 64 + 2), pages);

  const int64_t row = stride_;
  for (int32_t dz = -1; dz <= 1; ++dz) {
    for (int32_t dx = -1; dx <= 1; ++dx) {
      Ring& ring = rings_[direction_index(dx, dz)];
      ring.to = dz * row + dx;
      size_t size = 0;
      for (int32_t z = dz - 1; z <= dz + 1; ++z) {
        for (int32_t x = dx - 1; x <= dx + 1; ++x) {
          if (std::abs(x) > 1 || std::abs(z) > 1) ring.ahead[size++] = z * row + x;
        }
      }
      for (; size > 0 && size < ring.ahead.size(); ++size) ring.ahead[size] = ring.ahead[size - 1];
    }
  }
}

}  // namespace throng::crowd
