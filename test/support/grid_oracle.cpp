// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "grid_oracle.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

// A* over all corners of blocked cells [LPW79]; visibility row by row, in integers.
namespace throng::test {
namespace {

int64_t floor_div(int64_t a, int64_t b) { return a / b - (a % b != 0 && (a < 0) != (b < 0)); }
int64_t ceil_div(int64_t a, int64_t b) { return -floor_div(-a, b); }

double length(HalfPoint a, HalfPoint b) {
  return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.z - b.z)) / 2;
}

}  // namespace

bool GridOracle::is_open(int64_t x, int64_t z) const {
  return x >= 0 && z >= 0 && x < cells_.width && z < cells_.depth &&
         cells_.passable[static_cast<size_t>(z * cells_.width + x)] != 0;
}

// Along one axis. On a line between cells one side must stay open past every corner.
bool GridOracle::sees_along(HalfPoint a, HalfPoint b) const {
  const bool upright = a.x == b.x;
  const int64_t line = upright ? a.x : a.z;
  int64_t low = upright ? a.z : a.x, high = upright ? b.z : b.x;
  if (low > high) std::swap(low, high);
  const bool inside = line % 2 != 0;  // of cells
  uint32_t last_open = 3;             // bit 0: before the line, bit 1: behind it
  for (int64_t i = floor_div(low, 2); 2 * i < high; ++i) {
    const auto open = [&](int64_t across) {
      return upright ? is_open(across, i) : is_open(i, across);
    };
    const uint32_t now =
        (open(inside ? line / 2 : line / 2 - 1) ? 1u : 0u) | (open(line / 2) ? 2u : 0u);
    if ((now & last_open) == 0) return false;
    last_open = now;
  }
  return true;
}

bool GridOracle::sees(HalfPoint a, HalfPoint b) const {
  if (a.x == b.x && a.z == b.z) return true;
  if (a.x == b.x || a.z == b.z) return sees_along(a, b);
  if (a.z > b.z) std::swap(a, b);
  const int64_t dx = b.x - a.x, dz = b.z - a.z;
  // Row by row: the cells that the segment's inside crosses between the row's two lines.
  for (int64_t row = floor_div(a.z, 2); 2 * row < b.z; ++row) {
    const int64_t z0 = std::max(2 * row, a.z), z1 = std::min(2 * row + 2, b.z);
    int64_t x0 = a.x * dz + dx * (z0 - a.z), x1 = a.x * dz + dx * (z1 - a.z);  // times dz
    if (x0 > x1) std::swap(x0, x1);
    const int64_t first = floor_div(x0, 2 * dz), last = ceil_div(x1, 2 * dz);
    for (int64_t x = first; x < last; ++x) {
      if (!is_open(x, row)) return false;
    }
    // Through a corner: one of the two cells beside the segment must be open.
    if (z1 == 2 * row + 2 && z1 < b.z) {
      const int64_t at = a.x * dz + dx * (z1 - a.z);
      if (at % (2 * dz) != 0) continue;
      const int64_t x = at / (2 * dz);
      const bool rising = dx > 0;
      if (!is_open(rising ? x : x - 1, row) && !is_open(rising ? x - 1 : x, row + 1)) return false;
    }
  }
  return true;
}

std::vector<HalfPoint> GridOracle::corners_within(HalfPoint from, HalfPoint to,
                                                  double limit) const {
  std::vector<HalfPoint> corners;
  // Half of the width of the ellipse of points on paths within the limit. [cells]
  const double straight = length(from, to);
  const double width = std::sqrt(std::max(0.0, limit * limit - straight * straight)) / 2;
  const auto spare = static_cast<int64_t>(width) + 2;
  const int64_t x0 = std::min(from.x, to.x) / 2, x1 = std::max(from.x, to.x) / 2;
  const int64_t z0 = std::min(from.z, to.z) / 2, z1 = std::max(from.z, to.z) / 2;
  for (int64_t z = std::max<int64_t>(0, z0 - spare);
       z <= std::min<int64_t>(cells_.depth, z1 + spare); ++z) {
    for (int64_t x = std::max<int64_t>(0, x0 - spare);
         x <= std::min<int64_t>(cells_.width, x1 + spare); ++x) {
      const int open =
          is_open(x - 1, z - 1) + is_open(x, z - 1) + is_open(x - 1, z) + is_open(x, z);
      const HalfPoint point{2 * x, 2 * z};
      if (open == 3 && length(from, point) + length(point, to) <= limit) corners.push_back(point);
    }
  }
  return corners;
}

std::optional<double> GridOracle::shortest(HalfPoint from, HalfPoint to, double limit) const {
  std::vector<HalfPoint> points = corners_within(from, to, limit);
  points.push_back(to);
  const size_t goal = points.size() - 1;
  points.push_back(from);
  std::vector<double> best(points.size(), 1e300);
  std::vector<uint8_t> done(points.size(), 0);
  using Entry = std::pair<double, size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  best[goal + 1] = 0;
  open.push({length(from, to), goal + 1});
  while (!open.empty()) {
    const size_t at = open.top().second;
    open.pop();
    if (done[at] != 0) continue;
    if (at == goal) return best[goal];
    done[at] = 1;
    for (size_t p = 0; p <= goal; ++p) {
      if (done[p] != 0) continue;
      const double there = best[at] + length(points[at], points[p]);
      const double whole = there + length(points[p], to);
      if (there >= best[p] || whole > limit || !sees(points[at], points[p])) continue;
      best[p] = there;
      open.push({whole, p});
    }
  }
  return std::nullopt;
}

}  // namespace throng::test
