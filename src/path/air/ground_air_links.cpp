// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/ground_air_links.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/parallel.h"
#include "world/place.h"

// Sorted pairs of ground and air, from one pass over all legal cells; turns between ground and air
// are counted by a breadth-first search.
namespace throng::path {
namespace {

// Ground, air, and where the one leads into the other.
struct Junction {
  uint32_t ground = 0, air = 0;
  GroundAirLinks::Cell cell;

  [[nodiscard]] auto key() const { return std::tuple(ground, air); }
  [[nodiscard]] auto order() const { return std::tuple(ground, air, cell.level, cell.z, cell.x); }
};

// One of each, with the first of its cells.
void sort_once(std::vector<Junction>& pairs) {
  std::sort(pairs.begin(), pairs.end(),
            [](const Junction& a, const Junction& b) { return a.order() < b.order(); });
  pairs.erase(std::unique(pairs.begin(), pairs.end(),
                          [](const Junction& a, const Junction& b) { return a.key() == b.key(); }),
              pairs.end());
}

}  // namespace

GroundAirLinks::GroundAirLinks(const world::WorldData& world, const PathMesh& mesh,
                               const FlightSpace& space, int32_t workers) {
  const FlightEndpoints ends(world, space, mesh.avatar_class);
  std::vector<std::vector<Junction>> of_level(mesh.first.size() - 1);
  parallel_for(of_level.size(), workers, [&](size_t l) {
    std::vector<Junction>& pairs = of_level[l];
    const auto level = static_cast<uint32_t>(l);
    if (mesh.first[l] == mesh.first[l + 1]) return;
    const world::GroundLevel ground = world::ground_level(world, level, mesh.avatar_class);
    for (uint32_t r = mesh.first[l]; r < mesh.first[l + 1]; ++r) {
      const MeshRect& rect = mesh.rects[r];
      for (int32_t z = rect.z; z < rect.z + rect.depth; ++z) {
        for (int32_t x = rect.x; x < rect.x + rect.width; ++x) {
          const Place place =
              world::place_at(world, ground,
                              {(int64_t{x} << world::kUnitBits) + world::kUnitsPerCell / 2,
                               (int64_t{z} << world::kUnitBits) + world::kUnitsPerCell / 2});
          const auto up = ends.take_off(place);
          if (!up) continue;
          const Junction pair{rect.component, space.component[space.box_at(*up)], {level, x, z}};
          if (pairs.empty() || pairs.back().key() != pair.key()) pairs.push_back(pair);
        }
      }
    }
    sort_once(pairs);
  });
  std::vector<Junction> all;
  for (const auto& pairs : of_level) all.insert(all.end(), pairs.begin(), pairs.end());
  sort_once(all);
  for (const Junction& pair : all) {
    if (ground_.empty() || ground_.back() != pair.ground) {
      ground_.push_back(pair.ground);
      first_.push_back(static_cast<uint32_t>(air_.size()));
    }
    air_.push_back(pair.air);
    cell_.push_back(pair.cell);
  }
  first_.push_back(static_cast<uint32_t>(air_.size()));
  airs_ = air_;
  std::sort(airs_.begin(), airs_.end());
  airs_.erase(std::unique(airs_.begin(), airs_.end()), airs_.end());
  under_first_.assign(airs_.size() + 1, 0);
  const auto place_of = [&](uint32_t air) {
    return static_cast<size_t>(std::lower_bound(airs_.begin(), airs_.end(), air) - airs_.begin());
  };
  for (const uint32_t air : air_) ++under_first_[place_of(air) + 1];
  std::partial_sum(under_first_.begin(), under_first_.end(), under_first_.begin());
  std::vector<uint32_t> next(under_first_.begin(), under_first_.end() - 1);
  under_.resize(air_.size());
  for (uint32_t g = 0; g < ground_.size(); ++g) {
    for (uint32_t p = first_[g]; p < first_[g + 1]; ++p) under_[next[place_of(air_[p])]++] = g;
  }
}

std::span<const uint32_t> GroundAirLinks::air_over(uint32_t ground) const {
  const auto found = std::lower_bound(ground_.begin(), ground_.end(), ground);
  if (found == ground_.end() || *found != ground) return {};
  const auto i = static_cast<size_t>(found - ground_.begin());
  return {air_.data() + first_[i], first_[i + 1] - first_[i]};
}

bool GroundAirLinks::joins(uint32_t ground, uint32_t air) const {
  const auto over = air_over(ground);
  return std::binary_search(over.begin(), over.end(), air);
}

size_t GroundAirLinks::pair(uint32_t ground, uint32_t air) const {
  const auto over = air_over(ground);
  return static_cast<size_t>(std::lower_bound(over.begin(), over.end(), air) - over.begin()) +
         static_cast<size_t>(over.data() - air_.data());
}

GroundAirLinks::Cell GroundAirLinks::cell(uint32_t ground, uint32_t air) const {
  return cell_[pair(ground, air)];
}

void GroundAirLinks::search(Part from, Part goal, std::span<const Pair> banned,
                            Scratch& scratch) const {
  scratch.known_ground.assign(ground_.size(), 0);
  scratch.known_air.assign(airs_.size(), 0);
  scratch.steps.assign(1, {from, 0});
  // No link leads back to where it began except over what is known by then.
  for (uint32_t i = 0; i < scratch.steps.size() && scratch.steps.back().part != goal; ++i) {
    const Part part = scratch.steps[i].part;
    const std::vector<uint32_t>& own = part.is_air ? airs_ : ground_;
    const auto found = std::lower_bound(own.begin(), own.end(), part.component);
    if (found == own.end() || *found != part.component) continue;
    const auto place = static_cast<size_t>(found - own.begin());
    (part.is_air ? scratch.known_air : scratch.known_ground)[place] = 1;
    const std::vector<uint32_t>& first = part.is_air ? under_first_ : first_;
    for (uint32_t k = first[place]; k < first[place + 1]; ++k) {
      const Part next = part.is_air ? Part{ground_[under_[k]], false} : Part{air_[k], true};
      uint8_t& known =
          part.is_air
              ? scratch.known_ground[under_[k]]
              : scratch.known_air[static_cast<size_t>(
                    std::lower_bound(airs_.begin(), airs_.end(), next.component) - airs_.begin())];
      if (known != 0) continue;
      if (!banned.empty()) {
        const Pair pair = part.is_air ? Pair{next.component, part.component}
                                      : Pair{part.component, next.component};
        if (std::find(banned.begin(), banned.end(), pair) != banned.end()) continue;
      }
      known = 1;
      scratch.steps.push_back({next, i});
      if (next == goal) return;
    }
  }
}

}  // namespace throng::path
