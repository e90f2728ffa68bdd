// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "crowd/ground/body.h"
#include "crowd/ground/crowd_ground.h"
#include "path/edits/ground_finder.h"
#include "throng/base.h"
#include "throng/path.h"
#include "throng/world.h"

/// Targets: regions that many avatars head to.
namespace throng::crowd {

/// A prism in the units of bodies. A body whose centre is inside, or on the border, is inside.
class TargetRegion {
 public:
  TargetRegion(const world::WorldData& world, const Prism& prism);
  [[nodiscard]] bool contains(int32_t x, int32_t z, int32_t y) const;

  /// Points whose cells may be inside. [units, of the world]
  struct Bounds {
    double x0, z0, x1, z1;
  };
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }
  [[nodiscard]] int32_t low() const { return low_; }    // [mm]
  [[nodiscard]] int32_t high() const { return high_; }  // [mm]

 private:
  // Inside is on the left of each side. [units]
  struct Side {
    double x, z, dx, dz;
  };
  std::vector<Side> sides_;
  Bounds bounds_{};
  int32_t low_ = 0, high_ = 0;
};

struct Target {
  std::vector<Prism> prisms;
  std::vector<TargetRegion> regions;

  /// Fails with kBadInput: no prism, or an invalid one.
  static Result<Target> create(const world::WorldData& world, std::span<const Prism> areas);
  [[nodiscard]] bool contains(const Body& body) const;
};

/// Legal cells whose centres are inside, each once, by region, level and row: all, or every n-th of
/// a row and every n-th row, and of these every m-th if they would be more than twice `max_count`.
/// Y at the feet. With `live`: those that are legal there, whatever else is blocked in `ground`.
std::vector<Place> places_inside(const world::WorldData& world, const CrowdGround& ground,
                                 std::span<const TargetRegion> regions, size_t max_count,
                                 path::GroundFinder* live = nullptr);

}  // namespace throng::crowd
