// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/triangle_tree.h"

#include <algorithm>
#include <limits>

#include "core/math/float_origin.h"
#include "core/parallel.h"

// Builds a balanced box tree by median splits. n log n.
namespace throng::verify {
namespace {

constexpr size_t kLeafTriangles = 4;

// What the build sorts: 16 bytes that travel together, so that a split reads memory in order.
struct Item {
  std::array<float, 3> centre;
  uint32_t triangle;
};

// Along the longest side of the centres' box, ties by index, so that the tree is always the same.
void split_at_median(Item* begin, Item* middle, Item* end) {
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::max());
  high.fill(std::numeric_limits<float>::lowest());
  for (const Item* item = begin; item != end; ++item) {
    for (size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], item->centre[k]);
      high[k] = std::max(high[k], item->centre[k]);
    }
  }
  size_t axis = 0;
  for (size_t k = 1; k < 3; ++k) {
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  }
  std::nth_element(begin, middle, end, [axis](const Item& a, const Item& b) {
    if (a.centre[axis] != b.centre[axis]) return a.centre[axis] < b.centre[axis];
    return a.triangle < b.triangle;
  });
}

}  // namespace

bool TriangleTree::overlaps(const Corners& c, const Box3d& box) {
  const auto apart = [&](double Vec3d::*axis) {
    return std::min({c[0].*axis, c[1].*axis, c[2].*axis}) > box.max.*axis ||
           std::max({c[0].*axis, c[1].*axis, c[2].*axis}) < box.min.*axis;
  };
  return !apart(&Vec3d::x) && !apart(&Vec3d::y) && !apart(&Vec3d::z);
}

TriangleTree::TriangleTree(const Scene& scene, int32_t workers) : scene_(&scene) {
  const size_t count = scene.triangles.size();
  // Any triangle will do: what lies far away has wider boxes, and is rare.
  base_ = float_origin(corners(static_cast<uint32_t>(count / 2))[0]);
  while ((count >> depth_) > kLeafTriangles) ++depth_;
  first_leaf_ = (1u << depth_) - 1;

  std::vector<Item> items(count);
  constexpr size_t kGrain = 4096;
  parallel_ranges(count, kGrain, workers, [&](size_t begin, size_t end) {
    for (size_t t = begin; t < end; ++t) {
      const Corners c = corners(static_cast<uint32_t>(t));
      items[t] = {to_float((c[0] + c[1] + c[2]) * (1.0 / 3.0) - base_), static_cast<uint32_t>(t)};
    }
  });

  // Level by level from the root: the nodes of a level own disjoint ranges.
  for (int level = 0; level < depth_; ++level) {
    parallel_for(size_t{1} << level, workers, [&](size_t k) {
      split_at_median(items.data() + (count * k >> level),
                      items.data() + (count * (2 * k + 1) >> (level + 1)),
                      items.data() + (count * (k + 1) >> level));
    });
  }
  order_.resize(count);
  for (size_t i = 0; i < count; ++i) order_[i] = items[i].triangle;

  // Boxes from the leaves up.
  nodes_.resize(2 * static_cast<size_t>(first_leaf_) + 1);
  parallel_ranges(size_t{1} << depth_, kGrain, workers, [&](size_t begin, size_t end) {
    for (size_t leaf = begin; leaf < end; ++leaf) {
      Box3d box;
      for (size_t i = leaf_begin(leaf); i < leaf_begin(leaf + 1); ++i) {
        for (const Vec3d& p : corners(order_[i])) box.add(p);
      }
      nodes_[first_leaf_ + leaf] = {to_float(box.min - base_), to_float(box.max - base_)};
    }
  });
  for (size_t i = first_leaf_; i-- > 0;) {
    const Node& a = nodes_[2 * i + 1];
    const Node& b = nodes_[2 * i + 2];
    for (size_t k = 0; k < 3; ++k) {
      nodes_[i].low[k] = std::min(a.low[k], b.low[k]);
      nodes_[i].high[k] = std::max(a.high[k], b.high[k]);
    }
  }
}

}  // namespace throng::verify
