// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "papers/slices/slice_ground.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

// [ML06] algorithm 1 and its occupancy bits. Time of a move: cells that it touches.
//
// Why bodies cannot overlap: a body's feet stand on the highest surface that it covers, and each
// column that it covers is free from its surface to the body's head. If two bodies cover a column
// on the same surface, they meet in one bit. If on two surfaces, the higher one lies above the
// lower body's head, because that column is free up to there, and the other's feet lie no lower
// than its surface.
namespace throng::papers {

CellBox box_of(const CellBox& a, const CellBox& b) {
  return {std::min(a.x0, b.x0), std::min(a.z0, b.z0), std::max(a.x1, b.x1), std::max(a.z1, b.z1)};
}

SliceGround::SliceGround(DepthSlices slices)
    : slices_(std::move(slices)), stride_((static_cast<size_t>(slices_.width) + 7) / 8) {
  heights_.reserve(slices_.slices.size());
  for (const DepthSlice& slice : slices_.slices) heights_.push_back(slice.height);
  taken_.resize(heights_.size() * stride_ * static_cast<size_t>(slices_.depth));
}

size_t SliceGround::slice_above(int32_t head) const { return index_above(heights_, head); }

std::optional<int32_t> SliceGround::feet_after(int32_t feet, const CellBox& swept,
                                               const CellBox& to, const SliceBody& body) const {
  const size_t read = slice_above(feet + body.height);
  const DepthSlice& slice = slices_.slices[read];
  int32_t highest = feet, highest_to = std::numeric_limits<int32_t>::min();
  int32_t lowest_to = std::numeric_limits<int32_t>::max();
  for (int32_t z = swept.z0; z <= swept.z1; ++z) {
    for (int32_t x = swept.x0; x <= swept.x1; ++x) {
      const size_t at = cell(x, z);
      if (slice.depths[at] == DepthSlice::kNone) return {};
      const int32_t surface = slice.surface(at);
      if (std::abs(surface - feet) >= body.step) return {};
      highest = std::max(highest, surface);
      if (z < to.z0 || z > to.z1 || x < to.x0 || x > to.x1) continue;
      highest_to = std::max(highest_to, surface);
      lowest_to = std::min(lowest_to, surface);
    }
  }
  if (highest_to - lowest_to >= body.step) return {};

  // Nothing is between a surface and the cut. Up past the cut, all columns must stay free up to the
  // slice above the raised head; above the first slice there is nothing.
  const size_t above = slice_above(highest + body.height);
  if (above == read) return highest_to;
  const DepthSlice& raised = slices_.slices[above];
  for (int32_t z = swept.z0; z <= swept.z1; ++z) {
    for (int32_t x = swept.x0; x <= swept.x1; ++x) {
      const size_t at = cell(x, z);
      if (raised.depths[at] == DepthSlice::kNone || raised.surface(at) != slice.surface(at))
        return {};
    }
  }
  return highest_to;
}

size_t SliceGround::byte_of(size_t slice, int32_t x, int32_t z) const {
  const int32_t surface = slices_.slices[slice].surface(cell(x, z));
  while (slice + 1 < heights_.size() && heights_[slice + 1] >= surface) ++slice;
  const size_t row = slice * static_cast<size_t>(slices_.depth) + static_cast<size_t>(z);
  return row * stride_ + static_cast<size_t>(x) / 8;
}

bool SliceGround::is_free(size_t slice, const CellBox& box) const {
  for (int32_t z = box.z0; z <= box.z1; ++z) {
    for (int32_t x = box.x0; x <= box.x1; ++x) {
      if ((taken_[byte_of(slice, x, z)] >> (x & 7) & 1) != 0) return false;
    }
  }
  return true;
}

void SliceGround::set(size_t slice, const CellBox& box, bool is_taken) {
  for (int32_t z = box.z0; z <= box.z1; ++z) {
    for (int32_t x = box.x0; x <= box.x1; ++x) {
      uint8_t& byte = taken_[byte_of(slice, x, z)];
      const auto bit = static_cast<uint8_t>(1u << (x & 7));
      byte = is_taken ? static_cast<uint8_t>(byte | bit) : static_cast<uint8_t>(byte & ~bit);
    }
  }
}

}  // namespace throng::papers
