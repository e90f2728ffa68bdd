// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/crowd_blocks.h"

#include <algorithm>
#include <numeric>

#include "core/parallel.h"

// Sorts avatars by block with a counting sort, then each block by level and id. Linear in the
// avatars and blocks, but for the sorts of single blocks.
namespace throng::crowd {

CrowdBlocks::CrowdBlocks(int32_t width, int32_t depth, PixelGrid grid, int32_t block_pixels)
    : grid_(grid), block_pixels_(block_pixels) {
  const int32_t pair = 2 * block_pixels * grid.cells();
  half_x_ = static_cast<uint32_t>(width / pair) + 1;
  half_z_ = static_cast<uint32_t>(depth / pair) + 1;
  const size_t blocks = size_t{half_x_} * half_z_;
  first_.resize(kColours * blocks + 1);
  for (auto& runs : runs_) runs.reserve(blocks);  // No allocation in a step.
}

void CrowdBlocks::sort(HugeArray<Avatar>& avatars, HugeArray<Avatar>& scratch, int32_t workers) {
  std::fill(first_.begin(), first_.end(), 0);
  for (const Avatar& avatar : avatars.span()) ++first_[block(avatar) + 1];
  std::inclusive_scan(first_.begin(), first_.end(), first_.begin());
  const size_t blocks = size_t{half_x_} * half_z_;
  for (uint32_t colour = 0; colour < kColours; ++colour) {
    runs_[colour].clear();
    for (size_t b = colour * blocks; b < (colour + 1) * blocks; ++b) {
      if (first_[b] != first_[b + 1]) runs_[colour].push_back({first_[b], first_[b + 1]});
    }
  }
  for (const Avatar& avatar : avatars.span()) scratch[first_[block(avatar)]++] = avatar;
  std::swap(avatars, scratch);
  for (const auto& runs : runs_) {
    parallel_ranges(runs.size(), 16, workers, [&](size_t begin, size_t end) {
      for (size_t r = begin; r < end; ++r) {
        std::sort(avatars.data() + runs[r].first, avatars.data() + runs[r].last,
                  [](const Avatar& a, const Avatar& b) {
                    return a.level != b.level ? a.level < b.level : a.id < b.id;
                  });
      }
    });
  }
}

uint64_t CrowdBlocks::bytes() const {
  uint64_t bytes = first_.capacity() * sizeof(uint32_t);
  for (const auto& runs : runs_) bytes += runs.capacity() * sizeof(Run);
  return bytes;
}

}  // namespace throng::crowd
