// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/mode/leaving.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "crowd/ground/air_obstacle.h"

// Whether a path leads out of obstacles: tested in plan at points half a radius apart, so linear in
// its length.
namespace throng::crowd {
namespace {

constexpr double kMaxDetourFactor = 2;  // times the shortest exit, for a path that leads out
constexpr double kMaxPath = 2;          // [m] more than that

// Of any height.
AirObstacle column_of(const Prism& prism, const Vec3d& origin, double unit) {
  constexpr double kColumnHeight = 1e5;  // [m]
  return {{prism.corners, -kColumnHeight, kColumnHeight}, origin, unit};
}

}  // namespace

bool leads_out_along(const SharedState& shared, const Body& body, std::span<const uint32_t> slots,
                     std::span<const std::array<int32_t, 2>> points, double least) {
  std::vector<AirObstacle> columns;
  for (const uint32_t slot : slots) {
    columns.push_back(column_of(shared.obstacles.all()[slot].wanted, shared.origin(), shared.unit));
  }
  const double radius = shared.body_class(body.avatar_class).radius;
  const double limit = (kMaxDetourFactor * least + kMaxPath) / shared.unit;
  const double step_size = radius / 2 / shared.unit;
  double walked = 0, x = body.x, z = body.z;
  bool is_out = false;
  for (const auto& [to_x, to_z] : points) {
    const double dx = to_x - x, dz = to_z - z, size = std::sqrt(dx * dx + dz * dz);
    const auto count = static_cast<int64_t>(size / step_size) + 1;
    for (int64_t i = 1; i <= count; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(count);
      const AirPosition position{static_cast<int32_t>(x + part * dx),
                                 static_cast<int32_t>(z + part * dz), 0};
      const bool is_inside =
          std::any_of(columns.begin(), columns.end(),
                      [&](const AirObstacle& column) { return column.holds(position, radius, 1); });
      if (is_out && is_inside) return false;
      is_out = is_out || !is_inside;
      if (!is_out && walked + part * size > limit) return false;
    }
    walked += size;
    x = to_x;
    z = to_z;
  }
  return is_out;
}

}  // namespace throng::crowd
