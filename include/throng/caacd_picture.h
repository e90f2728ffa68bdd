// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/caacd_experiment.h"
#include "throng/math.h"
#include "throng/picture.h"
#include "throng/result.h"

/// Pictures of the plane of throng/caacd_experiment.h.
namespace throng::caacd {

/// Settings for draw_simulation.
struct PictureConfig {
  double side = 400;     ///< The square from (0, 0) that is shown. [> 0]
  int32_t width = 1200;  ///< [px, 400 to 8000]
  std::string title = {};
};

/// Draws the present state as [CAACD] figure 9 does: obstacles, avatars with their fields, headings
/// and probes, and targets. trails[i], if given, holds the earlier positions of avatar i. Fails
/// with kBadConfig.
[[nodiscard]] THRONG_API Result<Image> draw_simulation(const Simulation& simulation,
                                                       std::span<const std::vector<Vec3d>> trails,
                                                       const PictureConfig& config);

}  // namespace throng::caacd
