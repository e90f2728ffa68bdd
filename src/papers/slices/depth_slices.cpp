// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "throng/papers.h"

// Slices with 16 bits a cell, [ML06] section 3.3. A body reads the lowest slice at or above its
// head. If that is further above its feet than 16 bits can say, an extra slice is put in between,
// with the values of the kept slice above it; cells whose surface lies above the extra cut get
// none. They lose nothing: a body under such a surface, with its head above the next kept slice,
// finds no floor in the kept slice above either.
namespace throng {
namespace {

constexpr uint64_t kMaxBytes = uint64_t{16} << 30;
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

// The extra cuts between a kept slice and the `next` one, highest first. A surface that is too deep
// below the kept slice needs the lowest cut above it, and for heads above that the one before.
std::vector<int32_t> extra_cuts(const Slice& slice, int32_t next, int32_t far_plane) {
  std::set<int64_t> needed;  // cuts at so many times kApart below the kept slice
  for (const int32_t value : slice.surface) {
    const int64_t depth = int64_t{slice.height} - value;
    const bool is_read = value != far_plane && value > int64_t{next} - DepthSlices::kMaxBody;
    if (!is_read || depth <= kDeepest) continue;
    for (const int64_t n : {depth / kApart, depth / kApart - 1}) {
      if (n > 0 && slice.height - n * kApart > next) needed.insert(n);
    }
  }
  std::vector<int32_t> cuts;
  for (const int64_t n : needed) cuts.push_back(static_cast<int32_t>(slice.height - n * kApart));
  return cuts;
}

}  // namespace

Result<DepthSlices> store_depths(const SliceSet& set) {
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
  std::vector<std::vector<int32_t>> cuts;
  uint64_t count = set.kept.size();
  for (size_t i = 0; i < set.kept.size(); ++i) {
    // Below the last slice no head is below the far plane.
    const int32_t next = i + 1 < set.kept.size() ? set.kept[i + 1].height : set.far_plane;
    cuts.push_back(extra_cuts(set.kept[i], next, set.far_plane));
    count += cuts.back().size();
  }
  const uint64_t bytes = count * 2 * uint64_t(set.width) * uint64_t(set.depth);
  if (bytes > kMaxBytes) {
    return Error{Errc::kLimit,
                 fmt::format("slices: {} slices of {} x {} cells, most of them for floors deeper "
                             "than 65 m, pass 16 GiB; use a larger cell",
                             count, set.width, set.depth)};
  }
  for (size_t i = 0; i < set.kept.size(); ++i) {
    const Slice& slice = set.kept[i];
    out.slices.push_back(depths_of(slice, slice.height, set.far_plane));
    for (const int32_t height : cuts[i]) {
      out.slices.push_back(depths_of(slice, height, set.far_plane));
      ++out.extra;
    }
  }
  return out;
}

}  // namespace throng
