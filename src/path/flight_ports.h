// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "path/flight_ends.h"
#include "path/mesh.h"

/// Which ground leads into which air: what cannot be reached is told without a look around.
namespace throng {

/// Pairs of a component of the ground (MeshRect::component) and one of the air
/// (FlightSpace::component) that a take-off joins.
class FlightPorts {
 public:
  FlightPorts() = default;
  /// Tries every legal cell of the class. The same for any number of workers. Linear in the cells.
  FlightPorts(const WorldData& world, const PathMesh& mesh, const FlightSpace& space,
              int32_t workers);

  /// The air over some ground, ascending.
  [[nodiscard]] std::span<const uint32_t> air_over(uint32_t ground) const;
  [[nodiscard]] bool joins(uint32_t ground, uint32_t air) const;
  [[nodiscard]] uint64_t bytes() const {
    return (ground_.size() + first_.size() + air_.size()) * sizeof(uint32_t);
  }

 private:
  std::vector<uint32_t> ground_;  // components that lead into any air, ascending
  std::vector<uint32_t> first_;   // of each: its first in air_; one more
  std::vector<uint32_t> air_;
};

}  // namespace throng
