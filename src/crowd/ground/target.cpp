// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/target.h"

#include <algorithm>
#include <cmath>

#include "world/place.h"
#include "world/tile_grid.h"

// Targets in the units of bodies, and the legal cells inside: a raster of each prism's bounds,
// linear in its cells.
namespace throng::crowd {
namespace {

int32_t millimetres(double metres) {
  return static_cast<int32_t>(std::clamp(std::round(metres * 1000), -2e9, 2e9));
}

}  // namespace

TargetRegion::TargetRegion(const world::WorldData& world, const Prism& prism)
    : low_(millimetres(prism.low)), high_(millimetres(prism.high)) {
  const double scale = world::kUnitsPerCell / world.summary.cell;
  const Vec3d& origin = world.summary.origin;
  const size_t count = prism.corners.size();
  bounds_ = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  double area2 = 0;
  for (size_t i = 0; i < count; ++i) {
    const auto& [ax, az] = prism.corners[i];
    const auto& [bx, bz] = prism.corners[(i + 1) % count];
    const double x = (ax - origin.x) * scale, z = (az - origin.z) * scale;
    sides_.push_back({x, z, (bx - ax) * scale, (bz - az) * scale});
    area2 += (ax - prism.corners[0][0]) * (bz - prism.corners[0][1]) -
             (bx - prism.corners[0][0]) * (az - prism.corners[0][1]);
    bounds_.x0 = std::min(bounds_.x0, x);
    bounds_.z0 = std::min(bounds_.z0, z);
    bounds_.x1 = std::max(bounds_.x1, x);
    bounds_.z1 = std::max(bounds_.z1, z);
  }
  if (area2 >= 0) return;
  for (Side& side : sides_) side = {side.x, side.z, -side.dx, -side.dz};
}

bool TargetRegion::contains(int32_t x, int32_t z, int32_t y) const {
  if (y < low_ || y > high_) return false;
  const double px = x + 0.5, pz = z + 0.5;
  if (px < bounds_.x0 || px > bounds_.x1 || pz < bounds_.z0 || pz > bounds_.z1) return false;
  return std::all_of(sides_.begin(), sides_.end(), [&](const Side& side) {
    return side.dx * (pz - side.z) - side.dz * (px - side.x) >= 0;
  });
}

Result<Target> Target::create(const world::WorldData& world, std::span<const Prism> areas) {
  if (areas.empty()) return Error{Errc::kBadInput, "crowd: a region needs at least one prism"};
  Target made;
  for (const Prism& prism : areas) {
    if (auto ok = check_prism(prism); !ok) return ok.error();
    made.prisms.push_back(prism);
    made.regions.emplace_back(world, prism);
  }
  return made;
}

bool Target::contains(const Body& body) const {
  return std::any_of(regions.begin(), regions.end(),
                     [&](const TargetRegion& r) { return r.contains(body.x, body.z, body.y); });
}

std::vector<Place> places_inside(const world::WorldData& world, const CrowdGround& ground,
                                 std::span<const TargetRegion> regions, size_t max_count,
                                 path::GroundFinder* live) {
  const auto cell_of = [](double units, int32_t cells) {
    return static_cast<int32_t>(
        std::clamp<double>(std::floor(units / world::kUnitsPerCell), 0, cells - 1));
  };
  const auto is_legal = [&](uint32_t level, int32_t x, int32_t z) {
    const world::CellRows* baked = live != nullptr ? ground.baked_legal(level) : nullptr;
    if (baked == nullptr) return ground.is_legal(level, x, z);
    return (((*baked)[static_cast<size_t>(z)] >> x) & 1) != 0;
  };
  const auto place_of = [&](uint32_t level, world::GroundPoint p, int32_t feet) {
    const double unit = world.summary.cell / world::kUnitsPerCell;
    const Vec3d& origin = world.summary.origin;
    return Place{{origin.x + (static_cast<double>(p.x) + 0.5) * unit, feet * 1e-3,
                  origin.z + (static_cast<double>(p.z) + 0.5) * unit},
                 level + 1};
  };
  const auto for_cells = [&](int32_t stride, auto visit) {
    for (size_t r = 0; r < regions.size(); ++r) {
      const TargetRegion& region = regions[r];
      const std::span<const TargetRegion> before = regions.first(r);
      const int32_t x0 = cell_of(region.bounds().x0, world.width),
                    x1 = cell_of(region.bounds().x1, world.width),
                    z0 = cell_of(region.bounds().z0, world.depth),
                    z1 = cell_of(region.bounds().z1, world.depth);
      for (int32_t tz = world::tile_along(z0); tz <= world::tile_along(z1); ++tz) {
        for (int32_t tx = world::tile_along(x0); tx <= world::tile_along(x1); ++tx) {
          ground.for_tile(tx, tz, region.low(), region.high(), [&](uint32_t level) {
            for (int32_t z = std::max(z0, world::first_cell(tz));
                 z <= std::min(z1, world::last_cell(tz)); ++z) {
              if (z % stride != 0) continue;
              for (int32_t x = std::max(x0, world::first_cell(tx));
                   x <= std::min(x1, world::last_cell(tx)); ++x) {
                if (x % stride != 0 || !is_legal(level, world::in_tile(x), world::in_tile(z)))
                  continue;
                const world::GroundPoint middle{
                    (int64_t{x} << world::kUnitBits) + world::kUnitsPerCell / 2,
                    (int64_t{z} << world::kUnitBits) + world::kUnitsPerCell / 2};
                const auto mx = static_cast<int32_t>(middle.x), mz = static_cast<int32_t>(middle.z);
                const int32_t feet = ground.feet(level, middle);
                if (!region.contains(mx, mz, feet)) continue;
                const bool is_known = std::any_of(
                    before.begin(), before.end(),
                    [&](const TargetRegion& other) { return other.contains(mx, mz, feet); });
                if (is_known) continue;
                const Place place = place_of(level, middle, feet);
                if (live == nullptr || live->is_free(place)) visit(place);
              }
            }
          });
        }
      }
    }
  };
  // As coarse as required; a narrow region that a coarse raster misses is rasterised more finely.
  double area = 0;
  for (const TargetRegion& r : regions) {
    area += (r.bounds().x1 - r.bounds().x0) * (r.bounds().z1 - r.bounds().z0);
  }
  const double cells = area / world::kUnitsPerCell / world::kUnitsPerCell;
  auto stride = static_cast<int32_t>(
      std::clamp(std::ceil(std::sqrt(cells / static_cast<double>(max_count))), 1.0, 1e6));
  std::vector<Place> places;
  for (;; stride = std::max(1, stride / 2)) {
    for_cells(stride, [&](const Place& place) { places.push_back(place); });
    if (!places.empty() || stride == 1) break;
  }
  // A raster that is fine enough for a narrow region has many more points along it.
  if (places.size() / 2 <= max_count) return places;
  const size_t every = (places.size() + max_count - 1) / max_count;
  size_t kept = 0;
  for (size_t i = every / 2; i < places.size(); i += every) places[kept++] = places[i];
  places.resize(kept);
  return places;
}

}  // namespace throng::crowd
