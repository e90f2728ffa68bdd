// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/depth_pyramid.h"

#include <algorithm>
#include <cmath>

#include "throng/base.h"

namespace throng::draw {
namespace {

// The card computes depths in floats and keeps 24 bits.
constexpr double kDepthSlack = 3e-6;

constexpr int32_t halved(int32_t size) { return (size + 1) / 2; }

}  // namespace

void DepthPyramid::set(std::span<const float> furthest, int32_t width, int32_t height) {
  width_ = width, height_ = height;
  Level level{(width + kBlock - 1) / kBlock, (height + kBlock - 1) / kBlock, {}};
  THRONG_ASSERT(furthest.size() ==
                static_cast<size_t>(level.width) * static_cast<size_t>(level.height));
  level.furthest.assign(furthest.begin(), furthest.end());
  levels_.clear();
  levels_.push_back(std::move(level));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level next{halved(fine.width), halved(fine.height), {}};
    next.furthest.resize(static_cast<size_t>(next.width) * static_cast<size_t>(next.height));
    for (int32_t y = 0; y < next.height; ++y) {
      for (int32_t x = 0; x < next.width; ++x) {
        const auto at = [&](int32_t dx, int32_t dy) {
          const int32_t fx = std::min(2 * x + dx, fine.width - 1);
          const int32_t fy = std::min(2 * y + dy, fine.height - 1);
          return fine.furthest[static_cast<size_t>(fy * fine.width + fx)];
        };
        next.furthest[static_cast<size_t>(y * next.width + x)] =
            std::max({at(0, 0), at(1, 0), at(0, 1), at(1, 1)});
      }
    }
    levels_.push_back(std::move(next));
  }
}

bool DepthPyramid::hides(const NdcBox& box) const {
  if (levels_.empty()) return false;
  // A sample more to each side, for the card's rounding.
  const auto first = [](double ndc, int32_t size) {
    return std::max(
        static_cast<int32_t>(std::clamp(std::floor((ndc * 0.5 + 0.5) * size) - 1, -1e6, 1e6)), 0);
  };
  const auto last = [](double ndc, int32_t size) {
    return std::min(
        static_cast<int32_t>(std::clamp(std::ceil((ndc * 0.5 + 0.5) * size) + 1, -1e6, 1e6)),
        size - 1);
  };
  int32_t x0 = first(box.left, width_), x1 = last(box.right, width_);
  int32_t y0 = first(box.low, height_), y1 = last(box.high, height_);
  if (x0 > x1 || y0 > y1) return false;
  x0 /= kBlock, x1 /= kBlock, y0 /= kBlock, y1 /= kBlock;
  size_t level = 0;
  while (level + 1 < levels_.size() && (x1 - x0 > 3 || y1 - y0 > 3)) {
    x0 /= 2, x1 /= 2, y0 /= 2, y1 /= 2;
    ++level;
  }
  const Level& l = levels_[level];
  const double nearest = box.nearest * 0.5 + 0.5 - kDepthSlack;
  for (int32_t y = y0; y <= y1; ++y) {
    for (int32_t x = x0; x <= x1; ++x) {
      if (l.furthest[static_cast<size_t>(y * l.width + x)] >= nearest) return false;
    }
  }
  return true;
}

}  // namespace throng::draw
