// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "flood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>
#include <vector>

// A flood fill with World::move, one place per level and cell.
namespace throng {

double Flood::around(double height) const {
  const auto centimetres = static_cast<int32_t>(std::lround(height * 100));
  double sum = 0;
  for (auto it = area_at.lower_bound(centimetres - 5); it != area_at.end(); ++it) {
    if (it->first > centimetres + 5) break;
    sum += it->second;
  }
  return sum;
}

Flood flood_from(const World& world, int32_t avatar_class, Vec3d start) {
  const WorldSummary summary = world.summary();
  const double cell = summary.cell;
  const auto column = [&](double x, double origin) {
    return static_cast<int64_t>(std::floor((x - origin) / cell));
  };
  const auto middle = [&](double x, double origin) {
    return origin + (static_cast<double>(column(x, origin)) + 0.5) * cell;
  };
  std::unordered_set<uint64_t> seen;  // Level, z, x: 24, 20 and 20 bits.
  std::vector<Place> open;
  const auto visit = [&](const Place& place) {
    const Vec3d p = place.position;
    const auto x = static_cast<uint64_t>(column(p.x, summary.origin.x));
    const auto z = static_cast<uint64_t>(column(p.z, summary.origin.z));
    if (seen.insert(uint64_t{place.level1} << 40 | z << 20 | x).second) open.push_back(place);
  };
  const Vec3d centre{middle(start.x, summary.origin.x), start.y, middle(start.z, summary.origin.z)};
  if (const Place place = world.find_place(avatar_class, centre, 1.0)) visit(place);

  Flood flood;
  while (!open.empty()) {
    const Place place = open.back();
    open.pop_back();
    flood.area += cell * cell;
    flood.area_at[static_cast<int32_t>(std::lround(place.position.y * 100))] += cell * cell;
    for (const auto& [dx, dz] : {std::array{cell, 0.0}, {-cell, 0.0}, {0.0, cell}, {0.0, -cell}}) {
      const MoveResult move = world.move(avatar_class, place, dx, dz);
      if (move.end != MoveEnd::kArrived) continue;
      flood.steepest =
          std::max(flood.steepest, std::fabs(move.place.position.y - place.position.y));
      visit(move.place);
    }
  }
  return flood;
}

}  // namespace throng
