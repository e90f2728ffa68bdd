// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/air_obstacle.h"

#include <algorithm>
#include <cmath>

// A cylinder against an upright prism: the disc of its feet against the polygon, its height against
// the prism's. Linear in the polygon's corners.
namespace throng::crowd {
namespace {

constexpr double kRangeMargin = 8;  // [units] farther than needed

bool overlap(int32_t y, int32_t height, int32_t other_y, int32_t other_height) {
  return y < other_y + other_height && other_y < y + height;
}

int32_t whole(double v) { return static_cast<int32_t>(std::clamp(std::floor(v), -2e9, 2e9)); }

}  // namespace

AirObstacle::AirObstacle(const Prism& prism, const Vec3d& origin, double unit, bool closes)
    : unit_(unit),
      x0_(HUGE_VAL),
      z0_(HUGE_VAL),
      x1_(-HUGE_VAL),
      z1_(-HUGE_VAL),
      low_(static_cast<int32_t>(std::clamp(std::floor(prism.low * 1000), -2e9, 2e9))),
      high_(static_cast<int32_t>(std::clamp(std::ceil(prism.high * 1000), -2e9, 2e9))),
      closes_(closes) {
  double area2 = 0;
  for (size_t i = 0; i < prism.corners.size(); ++i) {
    const auto& [x, z] = prism.corners[i];
    const auto& [nx, nz] = prism.corners[(i + 1) % prism.corners.size()];
    corners_.push_back({(x - origin.x) / unit, (z - origin.z) / unit});
    area2 += x * nz - nx * z;
    x0_ = std::min(x0_, corners_.back()[0]);
    z0_ = std::min(z0_, corners_.back()[1]);
    x1_ = std::max(x1_, corners_.back()[0]);
    z1_ = std::max(z1_, corners_.back()[1]);
  }
  if (area2 < 0) std::reverse(corners_.begin(), corners_.end());  // inside is on the left
}

bool AirObstacle::holds(const AirPosition& feet, double radius, int32_t height) const {
  if (!overlap(feet.y, height, low_, high_ - low_)) return false;
  const double range = AirObstacle::range(radius, unit_);
  const double x = feet.x + 0.5, z = feet.z + 0.5;
  if (x < x0_ - range || x > x1_ + range || z < z0_ - range || z > z1_ + range) return false;
  bool inside = true;
  for (size_t i = 0; i < corners_.size(); ++i) {
    const auto& [ax, az] = corners_[i];
    const auto& [bx, bz] = corners_[(i + 1) % corners_.size()];
    const double wx = bx - ax, wz = bz - az, px = x - ax, pz = z - az;
    inside = inside && wx * pz - wz * px >= 0;
    const double whole = wx * wx + wz * wz;
    const double part = whole > 0 ? std::clamp((px * wx + pz * wz) / whole, 0.0, 1.0) : 0;
    const double dx = px - part * wx, dz = pz - part * wz;
    if (dx * dx + dz * dz < range * range) return true;
  }
  return inside;
}

void AirObstacle::list_exits(const AirPosition& feet, double radius, int32_t height,
                             std::vector<AirPosition>& exits) const {
  const double range = radius / unit_ + 2 + kRangeMargin;
  const double x = feet.x + 0.5, z = feet.z + 0.5;
  for (size_t i = 0; i < corners_.size(); ++i) {
    const auto& [ax, az] = corners_[i];
    const auto& [bx, bz] = corners_[(i + 1) % corners_.size()];
    const double wx = bx - ax, wz = bz - az;
    const double size = std::sqrt(wx * wx + wz * wz);
    if (!(size > 0)) continue;
    // Inside is on the left: out of it is to the right, (wz, -wx).
    const double inside = (wx * (z - az) - wz * (x - ax)) / size;
    const double factor = (inside + range) / size;
    const double to_x = std::floor(x + factor * wz), to_z = std::floor(z - factor * wx);
    if (to_x < 0 || to_z < 0) continue;
    exits.push_back({whole(to_x), whole(to_z), feet.y});
  }
  exits.push_back({feet.x, feet.z, high_});
  exits.push_back({feet.x, feet.z, low_ - height});
}

}  // namespace throng::crowd
