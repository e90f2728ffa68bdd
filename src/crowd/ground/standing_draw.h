// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "crowd/ground/crowd_ground.h"
#include "world/walk.h"

/// Random places on the ground of a class.
namespace throng::crowd {

/// Points where a class can stand, drawn at random, uniform over the ground.
class StandingDraw {
 public:
  StandingDraw(const CrowdGround& ground, uint64_t seed);
  /// Can the class stand nowhere?
  [[nodiscard]] bool is_empty() const { return before_.back() == 0; }
  /// Cells where it can stand.
  [[nodiscard]] uint64_t cells() const { return before_.back(); }
  struct Stand {
    uint32_t level;
    world::GroundPoint point;
  };
  /// The n-th point of the stream.
  [[nodiscard]] Stand draw(uint64_t n) const;

 private:
  const CrowdGround* ground_;
  uint64_t seed_;
  std::vector<uint64_t> before_;  // legal cells of the levels before
};

}  // namespace throng::crowd
