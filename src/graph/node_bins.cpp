// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/node_bins.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

// Chooses the edges of the bins of slopes, heights and widths: the classes' limits first.
namespace throng {
namespace {

constexpr size_t kMaxEdges = 15;  // a code is 4 bits

// All of `needed` if they fit, then of `wanted` what is left room for. What does not fit is
// dropped where edges lie closest: classes' verdicts are kept by bits, not by these codes.
std::vector<double> edges(std::vector<double> needed, std::initializer_list<double> wanted) {
  const auto tidy = [&] {
    std::sort(needed.begin(), needed.end());
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
  };
  tidy();
  for (const double edge : wanted) {
    if (needed.size() < kMaxEdges) needed.push_back(edge);
  }
  tidy();
  while (needed.size() > kMaxEdges) {
    size_t closest = 1;
    for (size_t i = 2; i < needed.size(); ++i) {
      if (needed[i] - needed[i - 1] < needed[closest] - needed[closest - 1]) closest = i;
    }
    needed.erase(needed.begin() + static_cast<ptrdiff_t>(closest));
  }
  return needed;
}

uint8_t length_code(const std::vector<double>& edges, double metres) {
  return static_cast<uint8_t>(std::upper_bound(edges.begin(), edges.end(), metres) - edges.begin());
}

}  // namespace

NodeBins graph::make_bins(std::span<const AvatarClass> classes) {
  std::vector<double> slopes, heights, widths;
  for (const AvatarClass& avatar : classes) {
    slopes.push_back(avatar.max_slope);
    if (avatar.climb_slope > 0) slopes.push_back(avatar.climb_slope);
    heights.push_back(avatar.height);
    widths.push_back(avatar.radius);
  }
  const double tallest = *std::max_element(heights.begin(), heights.end());
  const double widest = *std::max_element(widths.begin(), widths.end());
  // Heights beyond the tallest class's serve no class, and finding them costs most.
  return {edges(std::move(slopes), {45, 90, 25, 120, 65}),
          edges(std::move(heights), {std::min(1.0, tallest), std::min(2.0, tallest)}),
          edges(std::move(widths), {2 * widest, 4 * widest})};
}

uint8_t NodeBins::inclination_code(double degrees) const {
  return static_cast<uint8_t>(std::lower_bound(inclination.begin(), inclination.end(), degrees) -
                              inclination.begin());
}

uint8_t NodeBins::height_code(double metres) const { return length_code(height, metres); }

uint8_t NodeBins::width_code(double metres) const { return length_code(width, metres); }

}  // namespace throng
