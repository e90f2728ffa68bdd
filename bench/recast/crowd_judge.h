// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Judges crowds by positions alone; shares nothing with what moved them.
namespace throng::bench {

/// A disc with a height, its feet at (x, y, z). [m]
struct Stander {
  double x = 0, y = 0, z = 0;
  double radius = 0, height = 0;
};

struct Overlaps {
  uint64_t pairs = 0;  ///< Nearer than the sum of both radii by more than `slack`,
  uint64_t deep = 0;   ///< by more than 5 % of it,
  double deepest = 0;  ///< and the most. [m]
};

/// All pairs that are near along X, one by one.
inline Overlaps count_overlaps(std::vector<Stander> all, double slack = 1e-4) {
  std::sort(all.begin(), all.end(), [](const Stander& a, const Stander& b) { return a.x < b.x; });
  double widest = 0;
  for (const Stander& s : all) widest = std::max(widest, s.radius);
  Overlaps found;
  for (size_t i = 0; i < all.size(); ++i) {
    const Stander& a = all[i];
    for (size_t j = i + 1; j < all.size() && all[j].x - a.x < a.radius + widest; ++j) {
      const Stander& b = all[j];
      if (a.y >= b.y + b.height || b.y >= a.y + a.height) continue;
      const double radii = a.radius + b.radius;
      const double depth = radii - std::hypot(a.x - b.x, a.z - b.z);
      if (depth <= slack) continue;
      ++found.pairs;
      found.deep += depth > 0.05 * radii;
      found.deepest = std::max(found.deepest, depth);
    }
  }
  return found;
}

}  // namespace throng::bench
