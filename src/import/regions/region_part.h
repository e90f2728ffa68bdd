// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/base.h"
#include "throng/scene.h"

/// What a scene that is read region by region is put together from.
namespace throng::importer {

/// Consecutive triangles of a scene. Functions that are const may be called from several threads.
class RegionPart {
 public:
  virtual ~RegionPart() = default;
  [[nodiscard]] virtual uint64_t triangles() const = 0;
  [[nodiscard]] virtual uint64_t patches() const = 0;
  [[nodiscard]] virtual Box3d bounds() const = 0;
  /// As SceneRegions::estimate.
  [[nodiscard]] virtual uint64_t estimate(const Box3d& box) const = 0;
  /// Puts what a box holds behind what a region has already, as SceneRegions::region. Patches are
  /// numbered from `first_patch`.
  [[nodiscard]] virtual Result<void> append(const Box3d& box, uint32_t first_patch,
                                            SceneRegion& out, Context& context) const = 0;
};

/// Do two boxes touch, seen from above?
[[nodiscard]] inline bool touch(const Box3d& a, const Box3d& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.z <= b.max.z && b.min.z <= a.max.z;
}

}  // namespace throng::importer
