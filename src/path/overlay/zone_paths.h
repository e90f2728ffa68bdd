// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "path/ground/mesh.h"
#include "path/ground/sight.h"
#include "throng/base.h"

/// Paths inside one zone, between the entrances of its borders.
namespace throng::path {

/// The length of a path that does not exist.
inline constexpr float kNeverReached = std::numeric_limits<float>::infinity();

/// A point on the border of two zones through which paths between them are led.
struct Entrance {
  CellPoint at;                    // on the border, in the middle of a cell's side
  std::array<uint32_t, 2> zone{};  // slots of the world, the lower one first
  std::array<uint32_t, 2> rect{};  // on either side
  [[nodiscard]] uint32_t rect_in(uint32_t of) const { return rect[of == zone[0] ? 0 : 1]; }
};

inline constexpr uint16_t kStraight = UINT16_MAX;  // also one more than corners a zone may have

/// The shortest paths from each corner and each entrance of a zone to each of its entrances that do
/// not leave the zone. Made from the zone's part of the mesh alone, so that it can be rebuilt when
/// the zone has changed.
struct ZonePaths {
  uint32_t first_rect = 0, last_rect = 0;  // of the mesh, [first, last)
  std::vector<uint32_t> entrances;         // rising
  std::vector<uint32_t> corners;           // of the mesh, rising
  // For each corner, then for each entrance, one an entrance.
  std::vector<float> length;   // [cells]; infinite: there is none
  std::vector<uint16_t> next;  // the place in `corners` where the path turns first, or kStraight

  [[nodiscard]] size_t row(size_t node) const { return node * entrances.size(); }
  /// Places in `corners` and `entrances` of what is there.
  [[nodiscard]] size_t place_of_corner(uint32_t corner) const;
  [[nodiscard]] size_t place_of_entrance(uint32_t entrance) const;
  [[nodiscard]] uint64_t bytes() const {
    return (entrances.size() + corners.size()) * sizeof(uint32_t) +
           length.size() * (sizeof(float) + sizeof(uint16_t));
  }
};

/// Slot of the zone of each rectangle.
std::vector<uint32_t> zones_of_rects(const world::WorldData& world, const PathMesh& mesh);

/// The entrances of a world: one in the middle of each run of border over which steps lead, more of
/// them on long runs, about a tenth of a zone's side apart.
std::vector<Entrance> find_entrances(const world::WorldData& world, const PathMesh& mesh,
                                     const std::vector<uint32_t>& zone_of_rect);

/// `paths` has its rectangles and entrances; finds the rest. `sight` is scratch. False if the zone
/// has too many corners for `next`: then only `paths.corners` is filled.
[[nodiscard]] bool find_zone_paths(const PathMesh& mesh, const std::vector<Entrance>& entrances,
                                   uint32_t zone, Sight& sight, ZonePaths& paths);

/// From a point of a zone to each of its entrances, as a row of the tables.
void find_entrances_around(const PathMesh& mesh, const std::vector<Entrance>& entrances,
                           uint32_t zone, const ZonePaths& paths, const Stop& from, Sight& sight,
                           std::vector<float>& length, std::vector<uint16_t>& next);

}  // namespace throng::path
