// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

/// How feet follow a level tile between the centres of its cells: a plane through the cell's sample
/// whose slope is the gentler of the two that its neighbours suggest (minmod, van Leer's limiter),
/// so that planes are met exactly and stairs stay stairs. Bake and moves share this rule.
namespace throng::world {

/// The smaller in size of two differences, 0 if they disagree in sign.
constexpr int32_t minmod(int32_t a, int32_t b) {
  if ((a > 0) != (b > 0)) return 0;
  return a > 0 ? std::min(a, b) : std::max(a, b);
}

/// Slope along one axis at cell `i` of 64. sample(i) gives mm, has(i) whether there is a floor.
/// Cells at the tile's rim use the two differences inside. [mm per cell]
template <class Sample, class Has>
constexpr int32_t sheet_slope(int32_t i, Sample sample, Has has) {
  const int32_t middle = i == 0 ? 1 : (i == 63 ? 62 : i);
  if (!has(middle - 1) || !has(middle) || !has(middle + 1)) return 0;
  return minmod(sample(middle) - sample(middle - 1), sample(middle + 1) - sample(middle));
}

}  // namespace throng::world
