// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "verify/stance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <tuple>

// Finds by the triangles alone where a body could stand, and walks over a lattice of such points.
// Cost: points, times the triangles near each.
namespace throng::verify {
namespace {

/// Two surfaces closer than this are one: world heights are whole millimetres. [m]
constexpr double kSameSurface = 1e-3;

/// Slack of the step and support limits, far below anything built. [m]
constexpr double kHeightTolerance = 1e-6;

// Rings no further apart than `spacing`, points on them likewise, and the centre. The outermost has
// twice as many points and goes around the disc, not through it: a straight rim of the floor must
// not slip in between two of them. (It requires up to 1 mm too much for an adult.) Rounded, so that
// every machine tests the same points whatever its sine.
std::vector<std::array<double, 2>> disc_points(double radius, double spacing) {
  using std::numbers::pi;
  std::vector<std::array<double, 2>> points;
  const int rings = std::max(2, static_cast<int>(std::ceil(radius / spacing)));
  for (int ring = rings; ring > 0; --ring) {
    const bool outermost = ring == rings;
    const double gap = outermost ? spacing / 2 : spacing;
    const double inner = radius * ring / rings;
    const int count = std::max(8, static_cast<int>(std::ceil(2 * pi * inner / gap)));
    const double r = outermost ? inner / std::cos(pi / count) : inner;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * pi * i / count;
      points.push_back({std::round(r * std::cos(angle) * 1e9) * 1e-9,
                        std::round(r * std::sin(angle) * 1e9) * 1e-9});
    }
  }
  points.push_back({0, 0});
  return points;
}

}  // namespace

Stance::Stance(const TriangleTree& tree, const BodyShape& shape)
    : tree_(&tree), shape_(shape), disc_(disc_points(shape.radius, shape.spacing)) {
  for (const auto& [x, z] : disc_) reach_ = std::max({reach_, std::fabs(x), std::fabs(z)});
}

void Stance::gather(Vec3d feet) {
  Box3d box;
  box.min = {feet.x - reach_, feet.y - shape_.bottom - kHeightTolerance, feet.z - reach_};
  box.max = {feet.x + reach_, feet.y + shape_.height, feet.z + reach_};
  near_.clear();
  tree_->find(box, [&](uint32_t triangle, const Corners& corners) {
    near_.push_back({corners, triangle});
    return false;
  });
}

bool Stance::is_floor(Vec3d feet) const {
  double top = -std::numeric_limits<double>::infinity();
  for (const Candidate& c : near_) {
    const auto y = height_at(c.corners, feet.x, feet.z);
    if (y && *y <= feet.y + shape_.bottom + kHeightTolerance) top = std::max(top, *y);
  }
  if (!(std::fabs(top - feet.y) <= kSameSurface)) return false;
  // Several surfaces may coincide there; one that can be stood on is enough.
  for (const Candidate& c : near_) {
    const auto y = height_at(c.corners, feet.x, feet.z);
    if (!y || !(std::fabs(*y - top) <= kSameSurface)) continue;
    if (tree_->scene().area[c.triangle] == kAreaBlocked) continue;
    if (levelness(c.corners) >= shape_.levelness) return true;
  }
  return false;
}

bool Stance::is_free(Vec3d feet) const {
  const Cylinder body{feet.x, feet.z, feet.y + shape_.bottom, feet.y + shape_.height,
                      shape_.radius};
  return std::none_of(near_.begin(), near_.end(),
                      [&](const Candidate& c) { return meets(body, c.corners); });
}

bool Stance::is_supported(Vec3d feet) const {
  size_t last = 0;  // Mostly one triangle carries the whole disc.
  for (const auto& [dx, dz] : disc_) {
    const double x = feet.x + dx, z = feet.z + dz;
    const auto carries = [&](const Candidate& c) {
      const auto y = height_at(c.corners, x, z);
      return y && std::fabs(*y - feet.y) <= shape_.bottom + kHeightTolerance;
    };
    if (last < near_.size() && carries(near_[last])) continue;
    const auto found = std::find_if(near_.begin(), near_.end(), carries);
    if (found == near_.end()) return false;
    last = static_cast<size_t>(found - near_.begin());
  }
  return true;
}

bool Stance::stands(Vec3d feet) {
  gather(feet);
  return is_floor(feet) && is_free(feet) && is_supported(feet);
}

std::optional<double> Stance::floor_at(double x, double z, double y, double reach) const {
  Box3d box;
  box.min = {x, y - reach - kHeightTolerance, z};
  box.max = {x, y + reach + kHeightTolerance, z};
  std::optional<double> top;
  tree_->find(box, [&](uint32_t, const Corners& corners) {
    const auto height = height_at(corners, x, z);
    if (height && std::fabs(*height - y) <= reach + kHeightTolerance && (!top || *height > *top)) {
      top = height;
    }
    return false;
  });
  return top;
}

WalkEnd Stance::walk(Vec3d start, double spacing, size_t max_points,
                     const std::function<bool(Vec3d feet)>& accepts) {
  struct Point {
    int32_t x, z;
    double y;
  };
  // A lattice point may be met on two floors of a spiral; they are further apart than the body is
  // high, so half a height distinguishes them, and a point visited twice only costs time.
  std::set<std::tuple<int32_t, int32_t, int64_t>> seen;
  const auto is_new = [&](const Point& p) {
    const double band = std::max(shape_.height / 2, kSameSurface);
    return seen.emplace(p.x, p.z, std::llround((p.y - start.y) / band)).second;
  };
  std::vector<Point> queue{{0, 0, start.y}};
  is_new(queue[0]);
  for (size_t next = 0; next < queue.size(); ++next) {
    if (queue.size() > max_points) return WalkEnd::kLarge;
    const Point at = queue[next];
    constexpr std::array<std::array<int32_t, 2>, 4> kNeighbours = {
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (const auto& [dx, dz] : kNeighbours) {
      Point to{at.x + dx, at.z + dz, 0};
      const double x = start.x + to.x * spacing;
      const double z = start.z + to.z * spacing;
      const auto floor = floor_at(x, z, at.y, shape_.step);
      if (!floor) continue;
      to.y = *floor;
      const Vec3d feet{x, to.y, z};
      if (!is_new(to) || !stands(feet)) continue;
      if (accepts(feet)) return WalkEnd::kReached;
      queue.push_back(to);
    }
  }
  return WalkEnd::kIsland;
}

}  // namespace throng::verify
