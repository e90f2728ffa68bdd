// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/flight_ports.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "world/place.h"

namespace throng {
namespace {

using Pair = std::pair<uint32_t, uint32_t>;  // ground, air

void sort_once(std::vector<Pair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace

FlightPorts::FlightPorts(const WorldData& world, const PathMesh& mesh, const FlightSpace& space,
                         int32_t workers) {
  const FlightEnds ends(world, space, mesh.avatar_class);
  std::vector<std::vector<Pair>> of_level(mesh.first.size() - 1);
  parallel_for(of_level.size(), workers, [&](size_t l) {
    std::vector<Pair>& pairs = of_level[l];
    const auto level = static_cast<uint32_t>(l);
    if (mesh.first[l] == mesh.first[l + 1]) return;
    const GroundLevel ground = ground_level(world, level, mesh.avatar_class);
    for (uint32_t r = mesh.first[l]; r < mesh.first[l + 1]; ++r) {
      const MeshRect& rect = mesh.rects[r];
      for (int32_t z = rect.z; z < rect.z + rect.depth; ++z) {
        for (int32_t x = rect.x; x < rect.x + rect.width; ++x) {
          const Place place = place_at(world, ground,
                                       {(int64_t{x} << kUnitBits) + kUnitsPerCell / 2,
                                        (int64_t{z} << kUnitBits) + kUnitsPerCell / 2});
          const auto up = ends.take_off(place);
          if (!up) continue;
          const Pair pair{rect.component, space.component[space.box_at(*up)]};
          if (pairs.empty() || pairs.back() != pair) pairs.push_back(pair);
        }
      }
    }
    sort_once(pairs);
  });
  std::vector<Pair> all;
  for (const auto& pairs : of_level) all.insert(all.end(), pairs.begin(), pairs.end());
  sort_once(all);
  for (const auto& [ground, air] : all) {
    if (ground_.empty() || ground_.back() != ground) {
      ground_.push_back(ground);
      first_.push_back(static_cast<uint32_t>(air_.size()));
    }
    air_.push_back(air);
  }
  first_.push_back(static_cast<uint32_t>(air_.size()));
}

std::span<const uint32_t> FlightPorts::air_over(uint32_t ground) const {
  const auto found = std::lower_bound(ground_.begin(), ground_.end(), ground);
  if (found == ground_.end() || *found != ground) return {};
  const auto i = static_cast<size_t>(found - ground_.begin());
  return {air_.data() + first_[i], first_[i + 1] - first_[i]};
}

bool FlightPorts::joins(uint32_t ground, uint32_t air) const {
  const auto over = air_over(ground);
  return std::binary_search(over.begin(), over.end(), air);
}

}  // namespace throng
