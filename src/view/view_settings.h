// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/result.h"

namespace throng {

/// What is kept from one time to the next.
struct ViewSettings {
  bool panel = true;
  bool shadows = true;
  bool smooth = true;      ///< 2 x 2 samples a pixel.
  bool hints = true;       ///< The line that tells of F1.
  bool only_seen = false;  ///< CrowdStart::only_seen.
  bool coarse_far = false;
  double edges = 0.5;      ///< [0 to 1]
  double view_angle = 45;  ///< [degrees, 10 to 120]
  double fly_speed = 8;    ///< [m/s]
  double speed = 1;        ///< Of time. [0.05 to 16]
  std::string layout;      ///< Where the panel's windows are.
};

[[nodiscard]] std::string settings_text(const ViewSettings& settings);
/// What the text does not say, or says out of its limits, stays as it is by default. Fails with
/// kBadFile: no JSON object.
[[nodiscard]] Result<ViewSettings> read_settings(const std::string& text);

}  // namespace throng
