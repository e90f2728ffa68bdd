// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>

#include "throng/scene.h"

/// A scene in memory, taken region by region.
namespace throng::test {

class RegionsOf : public SceneRegions {
 public:
  explicit RegionsOf(const Scene& scene);
  [[nodiscard]] const SceneFacts& facts() const override { return facts_; }
  [[nodiscard]] uint64_t estimate(const Box3d& box) const override;
  [[nodiscard]] Result<SceneRegion> region(const Box3d& box, Context& context) const override;

  /// Triangles of the largest region that was taken, and how many were.
  [[nodiscard]] uint64_t largest() const { return largest_; }
  [[nodiscard]] uint64_t count() const { return count_; }

 private:
  const Scene& scene_;
  SceneFacts facts_;
  mutable std::atomic<uint64_t> largest_ = 0, count_ = 0;
};

}  // namespace throng::test
