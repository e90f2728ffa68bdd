// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "throng/scenario.h"

/// Points of the plane, as likely as a density map says.
namespace throng {

class DensityDraw {
 public:
  explicit DensityDraw(const DensityMap& map);
  /// From three numbers in [0, 1). [m]
  [[nodiscard]] std::array<double, 2> point(double which, double along_x, double along_z) const;

 private:
  const DensityMap* map_;
  std::vector<uint64_t> before_;  // weights of the pixels before, and of all at last
};

}  // namespace throng
