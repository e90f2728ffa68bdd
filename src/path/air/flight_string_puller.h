// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "path/air/air_view.h"

/// Pulls a path through the air taut.
namespace throng::path {

/// Leaves out waypoints that are not needed and slides the others to where the path is shortest, as
/// far as the lines to their neighbours stay legal. Never makes a path longer. Owns its memory.
class FlightStringPuller {
 public:
  void pull(const AirView& air, std::vector<AirPoint>& path);

 private:
  void shortcut();
  void cut_corners();
  void slide(size_t waypoint);

  std::optional<AirView> air_;
  std::vector<AirPoint>* path_ = nullptr;
  std::vector<AirPoint> next_;
};

}  // namespace throng::path
