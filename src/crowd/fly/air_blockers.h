// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crowd/ground/body.h"
#include "crowd/ground/obstacle_grid.h"
#include "crowd/mode/mode.h"
#include "crowd/mode/shared_state.h"

/// Flyers and climbers where obstacles would appear or pass.
namespace throng::crowd {

class AirBlockers {
 public:
  /// `slots`: of obstacles, of which those that wait count.
  AirBlockers(const SharedState& shared, std::span<const uint32_t> slots);
  [[nodiscard]] bool is_empty() const { return passed_.is_empty(); }
  /// Adds the obstacles that hold a body's cylinder. [m]
  void add(const Body& body, uint32_t index, double radius, BlockerPairs& found);

 private:
  ObstacleGrid passed_;
  std::vector<const ObstacleGrid::Item*> near_;
};

}  // namespace throng::crowd
