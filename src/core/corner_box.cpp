// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/corner_box.h"

#include <mutex>

#include "core/parallel.h"

// The bounding box of a scene's used corners, in parallel blocks. Linear.
namespace throng {

Box3d corner_box(std::span<const Vec3d> positions,
                 std::span<const std::array<uint32_t, 3>> triangles, int32_t workers) {
  constexpr size_t kGrain = size_t{1} << 16;
  Box3d box;
  std::mutex mutex;
  parallel_ranges(triangles.size(), kGrain, workers, [&](size_t begin, size_t end) {
    Box3d share;
    for (const auto& corners : triangles.subspan(begin, end - begin)) {
      for (const uint32_t corner : corners) share.add(positions[corner]);
    }
    const std::scoped_lock lock(mutex);
    box.add(share.min);
    box.add(share.max);
  });
  return box;
}

}  // namespace throng
