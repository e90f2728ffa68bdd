// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/crowd_check.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/access.h"
#include "core/parallel.h"
#include "world/air_data.h"
#include "world/ground.h"
#include "world/tile_grid.h"

// Counts overlapping pairs, bodies off legal ground or air, and bodies in obstacles, by exact
// distances: sorted along one axis of squares, so n log n unless the crowd is dense.
namespace throng::crowd {
namespace {

// Square of the distance of a point from a convex polygon, 0 inside. [m2]
double square_to(const Prism& prism, double x, double z) {
  double nearest = 1e300, around = 0;
  for (size_t i = 0; i < prism.corners.size(); ++i) {
    const auto& [ax, az] = prism.corners[i];
    const auto& [bx, bz] = prism.corners[(i + 1) % prism.corners.size()];
    const double ux = ax - x, uz = az - z, vx = bx - x, vz = bz - z;
    // The angle under which the side is seen: the sum is a full turn if the point is inside.
    around += std::atan2(ux * vz - uz * vx, ux * vx + uz * vz);
    const double wx = bx - ax, wz = bz - az;
    const double along = -(ux * wx + uz * wz), whole = wx * wx + wz * wz;
    if (along <= 0 || whole == 0) {
      nearest = std::min(nearest, ux * ux + uz * uz);
    } else if (along >= whole) {
      nearest = std::min(nearest, vx * vx + vz * vz);
    } else {
      const double across = ux * wz - uz * wx;
      nearest = std::min(nearest, across * across / whole);
    }
  }
  return std::fabs(around) > std::numbers::pi ? 0 : nearest;
}

// Pairs of a body and an obstacle that it is in.
uint64_t count_inside(const world::WorldData& data, std::span<const CheckedBody> bodies,
                      std::span<const Prism> obstacles) {
  const double unit = data.summary.cell / world::kUnitsPerCell;
  const Vec3d& origin = data.summary.origin;
  struct Entry {
    double x, z, y, radius, bottom, height;
  };
  std::vector<Entry> entries;
  double widest = 0;
  for (const CheckedBody& body : bodies) {
    if (body.climbs) continue;  // The crowd tests the body itself: this one only encloses it.
    const AvatarClass& avatar = data.summary.classes[static_cast<size_t>(body.avatar_class)];
    const double lean = avatar.radius * std::tan(avatar.max_slope * std::numbers::pi / 180);
    const double bottom = body.flies ? 0 : std::max(avatar.step_height, lean);
    entries.push_back({origin.x + (body.x + 0.5) * unit, origin.z + (body.z + 0.5) * unit,
                       body.y * 1e-3, avatar.radius, bottom, body.height});
    widest = std::max(widest, avatar.radius);
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.x < b.x; });
  uint64_t found = 0;
  for (const Prism& prism : obstacles) {
    double x0 = 1e300, x1 = -1e300;
    for (const auto& [x, z] : prism.corners) {
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
    }
    auto entry = std::lower_bound(entries.begin(), entries.end(), x0 - widest,
                                  [](const Entry& e, double x) { return e.x < x; });
    for (; entry != entries.end() && entry->x <= x1 + widest; ++entry) {
      const double range = entry->radius - 1e-9;
      found += prism.low < entry->y + entry->height && prism.high > entry->y + entry->bottom &&
               square_to(prism, entry->x, entry->z) < range * range;
    }
  }
  return found;
}

// May the feet of a class be at this position in the air? By the octrees of the zones, as they were
// baked; or between the ground and the lowest air straight above it, which begins no higher than
// the body is tall.
class AirCheck {
 public:
  AirCheck(const world::WorldData& data, int32_t avatar_class)
      : data_(data),
        avatar_class_(avatar_class),
        height_(data.summary.classes[static_cast<size_t>(avatar_class)].height * 1e3) {
    if (data.air == nullptr) return;
    body_ =
        world::air_body(data.summary.classes[static_cast<size_t>(avatar_class)], data.air->shape);
  }

  [[nodiscard]] bool allows(const CheckedBody& a) const {
    if (data_.air == nullptr || a.x < 0 || a.z < 0) return false;
    const world::AirShape& shape = data_.air->shape;
    const int32_t across = world::kUnitsPerCell * shape.multiple;
    const int32_t x = a.x / across, z = a.z / across;
    const auto is_air = [&](int32_t layer) {
      return layer < shape.ceiling && data_.air->is_legal(body_, x, layer, z);
    };
    const auto layer_of = [&](int32_t y) {
      return static_cast<int32_t>(std::floor((y - shape.origin_y) / double{1} / shape.cell));
    };
    if (is_air(layer_of(a.y))) return true;
    const auto [cx, cz] = std::pair{a.x >> world::kUnitBits, a.z >> world::kUnitBits};
    const auto tile = data_.tile_levels(world::tile_along(cx), world::tile_along(cz));
    for (uint32_t i = tile.first; i < tile.last; ++i) {
      const world::GroundLevel level = world::ground_level(data_, i, avatar_class_);
      if (level.zone == nullptr || !level.is_legal(world::in_tile(cx), world::in_tile(cz)))
        continue;
      const int32_t feet =
          level.view.feet(world::in_tile(cx), world::in_tile(cz), a.x & (world::kUnitsPerCell - 1),
                          a.z & (world::kUnitsPerCell - 1));
      if (feet > a.y) continue;
      for (int32_t layer = layer_of(a.y);; ++layer) {
        if (layer * shape.cell + shape.origin_y > feet + height_) break;
        if (is_air(layer)) return true;
      }
    }
    return false;
  }

 private:
  const world::WorldData& data_;
  int32_t avatar_class_;
  double height_;  // [mm]
  world::AirBody body_;
};

}  // namespace

CrowdCheck check_bodies(const World& world, std::span<const CheckedBody> bodies,
                        std::span<const Prism> obstacles, int32_t workers) {
  const world::WorldData& data = *data_of(world);
  const double unit = data.summary.cell / world::kUnitsPerCell;

  std::vector<AirCheck> air;
  for (size_t c = 0; c < data.summary.classes.size(); ++c) {
    air.emplace_back(data, static_cast<int32_t>(c));
  }
  std::atomic<uint64_t> wall_entries{0}, overlaps{0};
  parallel_ranges(bodies.size(), 1024, workers, [&](size_t begin, size_t end) {
    uint64_t found = 0;
    for (size_t i = begin; i < end; ++i) {
      const CheckedBody& a = bodies[i];
      if (a.climbs || a.on_link) continue;
      if (a.flies) {
        found += air[static_cast<size_t>(a.avatar_class)].allows(a) ? 0 : 1;
        continue;
      }
      const world::GroundLevel level = world::ground_level(data, a.level, a.avatar_class);
      const auto [cx, cz] = std::pair{a.x >> world::kUnitBits, a.z >> world::kUnitBits};
      const auto tile = data.tile_levels(world::tile_along(cx), world::tile_along(cz));
      const bool on_tile = a.level >= tile.first && a.level < tile.last;
      const bool stands = on_tile && level.zone != nullptr &&
                          level.is_legal(world::in_tile(cx), world::in_tile(cz));
      const int32_t feet = stands ? level.view.feet(world::in_tile(cx), world::in_tile(cz),
                                                    a.x & (world::kUnitsPerCell - 1),
                                                    a.z & (world::kUnitsPerCell - 1))
                                  : 0;
      found += !stands || feet != a.y;
    }
    wall_entries += found;
  });

  // Bodies in order of a column of squares as wide as the widest, then along it: pairs are close in
  // the list.
  double width = 0;
  for (const CheckedBody& body : bodies) width = std::max(width, 2 * body.radius);
  struct Entry {
    int64_t column;
    double x, z, y, radius, height;
  };
  std::vector<Entry> entries(bodies.size());
  for (size_t i = 0; i < bodies.size(); ++i) {
    const CheckedBody& a = bodies[i];
    const double x = a.x * unit;
    entries[i] = {
        static_cast<int64_t>(std::floor(x / width)), x, a.z * unit, a.y * 1e-3, a.radius, a.height};
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.column != b.column ? a.column < b.column : a.z < b.z;
  });
  const auto overlaps_with = [&](const Entry& a, const Entry& b) {
    const double dx = a.x - b.x, dz = a.z - b.z;
    const double range = a.radius + b.radius - 1e-9;
    // One may stand exactly on top of the other.
    const bool level = a.y < b.y + b.height - 1e-9 && b.y < a.y + a.height - 1e-9;
    return dx * dx + dz * dz < range * range && level;
  };
  parallel_ranges(entries.size(), 1024, workers, [&](size_t begin, size_t end) {
    uint64_t found = 0;
    for (size_t i = begin; i < end; ++i) {
      const Entry& a = entries[i];
      for (size_t j = i + 1;
           j < entries.size() && entries[j].column == a.column && entries[j].z - a.z < width; ++j) {
        found += overlaps_with(a, entries[j]);
      }
      const Entry key{a.column + 1, 0, a.z - width, 0, 0, 0};
      auto next =
          std::lower_bound(entries.begin(), entries.end(), key, [](const Entry& p, const Entry& q) {
            return p.column != q.column ? p.column < q.column : p.z < q.z;
          });
      for (; next != entries.end() && next->column == a.column + 1 && next->z - a.z < width;
           ++next) {
        found += overlaps_with(a, *next);
      }
    }
    overlaps += found;
  });
  const uint64_t inside = obstacles.empty() ? 0 : count_inside(data, bodies, obstacles);
  return {wall_entries, overlaps, inside};
}

}  // namespace throng::crowd
