// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "path/air/flight_endpoints.h"
#include "path/ground/mesh.h"

/// Which ground leads into which air: a query between ends that are not connected is answered
/// without a search.
namespace throng::path {

/// Pairs of a component of the ground (MeshRect::component) and one of the air
/// (FlightSpace::component) that a take-off joins.
class GroundAirLinks {
 public:
  GroundAirLinks() = default;
  /// Tries every legal cell of the class. The same for any number of workers. Linear in the cells.
  GroundAirLinks(const world::WorldData& world, const PathMesh& mesh, const FlightSpace& space,
                 int32_t workers);

  /// The air over some ground, ascending.
  [[nodiscard]] std::span<const uint32_t> air_over(uint32_t ground) const;
  [[nodiscard]] bool joins(uint32_t ground, uint32_t air) const;
  /// A cell of some ground from which feet come into some air that it leads into: always the same.
  struct Cell {
    uint32_t level = 0;  ///< of the world
    int32_t x = 0, z = 0;
  };
  [[nodiscard]] Cell cell(uint32_t ground, uint32_t air) const;
  [[nodiscard]] uint64_t bytes() const {
    return (ground_.size() + first_.size() + air_.size() + airs_.size() + under_first_.size() +
            under_.size()) *
               sizeof(uint32_t) +
           cell_.size() * sizeof(Cell);
  }

  /// A component of the ground or of the air.
  struct Part {
    uint32_t component = 0;
    bool is_air = false;

    friend bool operator==(const Part&, const Part&) = default;
  };
  /// Memory for searches of parts.
  struct Scratch {
    struct Step {
      Part part;
      uint32_t before = 0;  ///< The step that led there; of the first: itself.
    };
    std::vector<Step> steps;  ///< In the order in which they were found.
    std::vector<uint8_t> known_ground, known_air;
  };
  /// All parts that take-offs and landings lead to from one, itself first, the smallest number of
  /// turns first; stops at `goal`, if that is among them: then it is the last. Not between the
  /// ground and the air of a banned pair.
  using Pair = std::pair<uint32_t, uint32_t>;
  void search(Part from, Part goal, std::span<const Pair> banned, Scratch& scratch) const;

 private:
  [[nodiscard]] size_t pair(uint32_t ground, uint32_t air) const;

  std::vector<uint32_t> ground_;  // components that lead into any air, ascending
  std::vector<uint32_t> first_;   // of each: its first in air_; one more
  std::vector<uint32_t> air_;
  std::vector<Cell> cell_;             // likewise
  std::vector<uint32_t> airs_;         // components that ground leads into, ascending
  std::vector<uint32_t> under_first_;  // of each: its first in under_; one more
  std::vector<uint32_t> under_;        // places in ground_, ascending
};

}  // namespace throng::path
