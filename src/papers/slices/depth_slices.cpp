// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "throng/papers.h"

// Slices with 16 bits a cell, [ML06] section 3.3. A body reads the lowest slice at or above its
// head. If that is further above its feet than 16 bits can say, an extra slice is put in between,
// with the values of the kept slice above it; cells whose surface lies above the extra cut get
// none. They lose nothing: a body under such a surface, with its head above the next kept slice,
// finds no floor in the kept slice above either.
namespace throng {
namespace {

constexpr int32_t kDeepest = DepthSlice::kNone - 1;  // [mm]
// So far apart, a body of kMaxBody whose head is below one slice but above the next has its feet at
// most kDeepest below it.
constexpr int32_t kApart = kDeepest - DepthSlices::kMaxBody;  // [mm]

DepthSlice depths_of(const Slice& slice, int32_t height, int32_t far_plane) {
  DepthSlice out{.height = height, .depths = std::vector<uint16_t>(slice.surface.size())};
  std::transform(
      slice.surface.begin(), slice.surface.end(), out.depths.begin(), [&](int32_t value) {
        const bool is_stored = value != far_plane && value <= height && height - value <= kDeepest;
        return is_stored ? static_cast<uint16_t>(height - value) : DepthSlice::kNone;
      });
  return out;
}

// The lowest surface that a body reads from this slice, with its head above the next; `height` if
// there is none. [mm]
int32_t lowest_read(const Slice& slice, int32_t next, int32_t far_plane) {
  int32_t lowest = slice.height;
  for (const int32_t value : slice.surface) {
    const bool is_read = value != far_plane && value > next - DepthSlices::kMaxBody;
    if (is_read) lowest = std::min(lowest, value);
  }
  return lowest;
}

}  // namespace

DepthSlices store_depths(const SliceSet& set) {
  DepthSlices out{.width = set.width,
                  .depth = set.depth,
                  .cell = set.cell,
                  .origin_x = set.origin_x,
                  .origin_z = set.origin_z,
                  .far_plane = set.far_plane,
                  .avatar_height = set.avatar_height,
                  .resolution = set.resolution,
                  .taken = set.taken,
                  .slices = {}};
  for (size_t i = 0; i < set.kept.size(); ++i) {
    const Slice& slice = set.kept[i];
    out.slices.push_back(depths_of(slice, slice.height, set.far_plane));
    // Below the last slice no head is below the far plane.
    const int32_t next = i + 1 < set.kept.size() ? set.kept[i + 1].height : set.far_plane;
    const int32_t lowest = lowest_read(slice, next, set.far_plane);
    int32_t height = slice.height;
    while (height - lowest > kDeepest && height - kApart > next) {
      height -= kApart;
      out.slices.push_back(depths_of(slice, height, set.far_plane));
      ++out.extra;
    }
  }
  return out;
}

}  // namespace throng
