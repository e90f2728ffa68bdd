// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "path/air/air_view.h"

/// A string in the air.
namespace throng::path {

/// Leaves out waypoints that are not needed and slides the others to where the path is shortest, as
/// far as the lines to their neighbours stay legal. Never makes a path longer. Owns its memory.
class AirString {
 public:
  /// Pulls the path taut.
  void pull(const AirView& air, std::vector<AirPoint>& path);

  static constexpr int kRounds = 6;
  static constexpr size_t kEnds = 2;
  void leave_out(std::vector<AirPoint>& path) const;
  bool move(std::vector<AirPoint>& path, int round);

 private:
  void cut_corners(std::vector<AirPoint>& path);
  void slide(std::vector<AirPoint>& path, size_t waypoint) const;

  std::optional<AirView> air_;
  std::vector<AirPoint> next_;
  double length_ = 0;  // when the round before began
};

}  // namespace throng::path
