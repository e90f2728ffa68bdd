// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/base.h"

namespace throng::view {

/// Settings that are saved between starts.
struct ViewSettings {
  bool panel = true;
  bool shadows = true;
  bool smooth = true;      ///< 2 x 2 samples a pixel.
  bool hints = true;       ///< The line that names F1 and Tab.
  bool only_seen = false;  ///< CrowdStart::only_seen.
  bool coarse_far = false;
  double edges = 0.5;      ///< [0 to 1]
  double view_angle = 45;  ///< [degrees, 10 to 120]
  double fly_speed = 8;    ///< [m/s]
  double speed = 1;        ///< Of time. [0.05 to 16]
  std::string layout;      ///< Places of the panel's windows.
};

[[nodiscard]] std::string settings_text(const ViewSettings& settings);
/// Values that are missing or outside their limits get their defaults. Fails with kBadFile if the
/// text is not a JSON object.
[[nodiscard]] Result<ViewSettings> read_settings(const std::string& text);

}  // namespace throng::view
