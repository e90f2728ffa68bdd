// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "in_world.h"

#include <fmt/format.h>

#include <cmath>

#include "command.h"

// Positions of options, checked against the bounds of the world.
namespace throng::app {

Error bad_position(const std::string& world, const std::string& option, const Vec3d& position,
                   const std::string& what) {
  return {Errc::kBadInput, fmt::format("{}: {} ({}) {}", world, option, where(position), what)};
}

Result<Vec3d> position_in(const World& world, const std::string& name, const std::string& option,
                          const std::vector<double>& at) {
  const Vec3d position{at[0], at[1], at[2]};
  if (!std::isfinite(position.x + position.y + position.z)) {
    return bad_position(name, option, position, "is not a finite position");
  }
  const Box3d bounds = world.summary().bounds;
  if (position.x < bounds.min.x || position.x > bounds.max.x || position.z < bounds.min.z ||
      position.z > bounds.max.z) {
    return bad_position(name, option, position,
                        fmt::format("lies outside the world, which reaches from ({}) to ({})",
                                    where(bounds.min), where(bounds.max)));
  }
  return position;
}

}  // namespace throng::app
