// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "papers/slices/sparse_slices.h"

#include <algorithm>
#include <array>
#include <span>
#include <unordered_map>

#include "core/hash.h"

// Finds equal tiles by their hashes; those of one hash are compared.
namespace throng::papers {

SparseSlices::SparseSlices(const DepthSlices& slices)
    : tiles_x_((slices.width + kSide - 1) / kSide), tiles_z_((slices.depth + kSide - 1) / kSide) {
  std::unordered_multimap<uint64_t, uint32_t> stored;
  std::array<uint16_t, kCells> below{};
  for (const DepthSlice& slice : slices.slices) {
    heights_.push_back(slice.height);
    for (int32_t tile = 0; tile < tiles_x_ * tiles_z_; ++tile) {
      const int32_t x0 = tile % tiles_x_ * kSide, z0 = tile / tiles_x_ * kSide;
      below.fill(DepthSlice::kNone);  // also beyond the grid
      uint16_t least = DepthSlice::kNone, most = 0;
      for (int32_t z = z0; z < std::min(z0 + kSide, slices.depth); ++z) {
        for (int32_t x = x0; x < std::min(x0 + kSide, slices.width); ++x) {
          const uint16_t depth =
              slice.depths[static_cast<size_t>(z) * size_t(slices.width) + static_cast<size_t>(x)];
          below[static_cast<size_t>((z - z0) * kSide + x - x0)] = depth;
          least = std::min(least, depth);
          most = std::max(most, depth);
        }
      }
      if (least == DepthSlice::kNone) {
        tiles_.push_back({});
        continue;
      }
      const int32_t top = slice.height - least;
      const bool is_whole = x0 + kSide <= slices.width && z0 + kSide <= slices.depth;
      if (least == most && is_whole) {
        tiles_.push_back({kConstant, top});
        continue;
      }
      for (uint16_t& depth : below) {
        if (depth != DepthSlice::kNone) depth = static_cast<uint16_t>(depth - least);
      }
      const uint64_t hash = hash_span(std::span<const uint16_t>(below));
      const auto [first, last] = stored.equal_range(hash);
      const auto same = std::find_if(first, last, [&](const auto& entry) {
        return std::equal(below.begin(), below.end(),
                          depths_.begin() + static_cast<ptrdiff_t>(entry.second * kCells));
      });
      if (same != last) {
        tiles_.push_back({same->second, top});
        continue;
      }
      const auto number = static_cast<uint32_t>(depths_.size() / kCells);
      depths_.insert(depths_.end(), below.begin(), below.end());
      stored.emplace(hash, number);
      tiles_.push_back({number, top});
    }
  }
}

}  // namespace throng::papers
