// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "throng/base.h"
#include "throng/scene.h"
#include "verify/cylinder.h"

/// A tree of boxes over the triangles of a scene, to find those near a body.
namespace throng::verify {

/// Perfectly balanced, split at the median: node i has the children 2i + 1 and 2i + 2, leaf k of
/// 2^depth holds order_[n k / 2^depth] to order_[n (k + 1) / 2^depth]. No pointers, no counts; a
/// triangle of 10 km widens the boxes of its own ancestors only. The scene must outlive the tree.
class TriangleTree {
 public:
  /// Time n log n. The scene has at least one triangle, and valid indices.
  TriangleTree(const Scene& scene, int32_t workers);

  [[nodiscard]] Corners corners(uint32_t triangle) const {
    const auto& t = scene_->triangles[triangle];
    return {scene_->positions[t[0]], scene_->positions[t[1]], scene_->positions[t[2]]};
  }
  [[nodiscard]] const Scene& scene() const { return *scene_; }

  /// Calls visit(triangle, corners) for each triangle whose box overlaps `box`, until one call
  /// returns true; returns whether one did. The order is the same on every run.
  template <class Visit>
  bool find(const Box3d& box, Visit&& visit) const {
    const auto low = to_float(box.min - base_);
    const auto high = to_float(box.max - base_);
    std::array<uint32_t, 64> stack;
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const uint32_t index = stack[--depth];
      const Node& node = nodes_[index];
      if (!(node.low[0] <= high[0] && low[0] <= node.high[0] && node.low[1] <= high[1] &&
            low[1] <= node.high[1] && node.low[2] <= high[2] && low[2] <= node.high[2])) {
        continue;
      }
      if (index < first_leaf_) {
        stack[depth++] = 2 * index + 2;
        stack[depth++] = 2 * index + 1;
        continue;
      }
      const uint32_t leaf = index - first_leaf_;
      for (size_t i = leaf_begin(leaf); i < leaf_begin(leaf + 1); ++i) {
        const Corners c = corners(order_[i]);
        if (overlaps(c, box) && visit(order_[i], c)) return true;
      }
    }
    return false;
  }

 private:
  /// From base_, in floats. Rounding keeps the order of numbers, and queries are rounded too: what
  /// overlaps in double overlaps here; what does not is sorted out by the triangles' own boxes.
  struct Node {
    std::array<float, 3> low;
    std::array<float, 3> high;
  };

  static std::array<float, 3> to_float(Vec3d p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  }
  static bool overlaps(const Corners& c, const Box3d& box);
  [[nodiscard]] size_t leaf_begin(size_t leaf) const { return order_.size() * leaf >> depth_; }

  const Scene* scene_;
  Vec3d base_;
  int depth_ = 0;
  uint32_t first_leaf_ = 0;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace throng::verify
