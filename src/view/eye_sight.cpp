// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/eye_sight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

// Finds out what an eye can see of a scene: draws its triangles into six depth images around the
// eye and tests boxes against these.
//
// A pixel is covered if one triangle covers it completely, or two that share a side do so together;
// where three meet at a corner it stays open. So nothing visible is ever reported as hidden,
// however narrow the slit, and walls of few triangles hide nearly all that lies behind them.
// Triangles are drawn as cones around the eye [Olano and Greer 1997, Triangle scan conversion using
// 2D homogeneous coordinates], so none must be clipped. Time: triangles x pixels that they cover.
namespace throng::view {
namespace {

constexpr double kEdgeOn = 1e-7;     // Cones of a smaller volume are seen edge-on. [m^3]
constexpr double kRoundDown = 1e-6;  // Relative, of nearness: covers the rounding to float.
// Distance of a near plane's corner from the eye, in near planes.
constexpr double kCornerFactor = 2.5;

double part(Vec3d p, size_t axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

Vec3d to_vec(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

// The first corner at the same position, for each corner.
std::vector<uint32_t> weld(const std::vector<std::array<float, 3>>& corners) {
  std::vector<uint32_t> order(corners.size()), first(corners.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return std::tie(corners[a], a) < std::tie(corners[b], b);
  });
  for (size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && corners[order[i]] == corners[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

}  // namespace

// One of six faces of a cube: maps points so that z points to the middle of the face.
struct EyeSight::Face {
  size_t number = 0;
  [[nodiscard]] Vec3d operator()(Vec3d p) const {
    const size_t axis = number / 2;
    const double z = part(p, axis);
    return {part(p, (axis + 1) % 3), part(p, (axis + 2) % 3), number % 2 == 0 ? z : -z};
  }
};

// The half plane a u + b v + c >= 0, evaluated at the middle of a pixel.
struct EyeSight::Line {
  double a = 0, b = 0, c = 0;
  // Pixels completely on the positive side of a plane through the eye.
  static Line inside(Vec3d n, double half) {
    return {n.x, n.y, n.z - half * (std::abs(n.x) + std::abs(n.y))};
  }
  // Pixels not completely on its negative side.
  static Line touching(Vec3d n, double half) {
    return {n.x, n.y, n.z + half * (std::abs(n.x) + std::abs(n.y))};
  }
};

std::shared_ptr<const Occluders> occluders_of(const Scene& scene, Vec3d origin) {
  auto out = std::make_shared<Occluders>();
  out->origin = origin;
  out->triangles.reserve(scene.triangles.size());
  size_t part = 0;
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    while (part < scene.parts.size() &&
           t >= size_t{scene.parts[part].first_triangle} + scene.parts[part].triangle_count) {
      ++part;
    }
    // Transparent surfaces hide nothing.
    const uint32_t material1 = part < scene.parts.size() && t >= scene.parts[part].first_triangle
                                   ? scene.parts[part].material1
                                   : 0;
    if (material1 != 0 && material1 <= scene.materials.size() &&
        scene.materials[material1 - 1].opacity != Opacity::kOpaque) {
      continue;
    }
    out->triangles.push_back(scene.triangles[t]);
  }
  out->corners.reserve(scene.positions.size());
  for (const Vec3d& p : scene.positions) {
    const Vec3d q = p - origin;
    out->corners.push_back(
        {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)});
  }
  return out;
}

EyeSight::EyeSight(std::shared_ptr<const Occluders> occluders, int32_t pixels)
    : occluders_(std::move(occluders)), pixels_(pixels) {
  auto shape = std::make_shared<Shape>();
  shape->triangles = occluders_->triangles;
  const std::vector<uint32_t> first = weld(occluders_->corners);
  struct Side {
    uint32_t u = 0, v = 0, opposite = 0;
  };
  std::vector<Side> sides;
  sides.reserve(3 * shape->triangles.size());
  for (auto& t : shape->triangles) {
    for (uint32_t& corner : t) corner = first[corner];
    for (size_t k = 0; k < 3; ++k) {
      const auto [u, v] = std::minmax(t[k], t[(k + 1) % 3]);
      if (u != v) sides.push_back({u, v, t[(k + 2) % 3]});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.u, a.v, a.opposite) < std::tie(b.u, b.v, b.opposite);
  });
  for (size_t i = 1; i < sides.size(); ++i) {
    const Side &a = sides[i - 1], &b = sides[i];
    if (a.u == b.u && a.v == b.v) shape->seams.push_back({a.u, a.v, a.opposite, b.opposite});
  }
  shape_ = std::move(shape);
  nearness_.resize(size_t{6} * static_cast<size_t>(pixels_) * static_cast<size_t>(pixels_));
}

// Fills rows from `low` to `high` [-1 to 1]. 1 / depth of a plane p is p . (u, v, 1).
template <size_t kLines, size_t kPlanes>
void EyeSight::fill(const Face& face, const std::array<Line, kLines>& lines,
                    const std::array<Vec3d, kPlanes>& planes, double low, double high) {
  const double half = 1.0 / pixels_, scale = 0.5 * pixels_;
  const auto row_of = [&](double v) {
    return static_cast<int32_t>(std::clamp((v + 1) * scale, 0.0, pixels_ - 1.0));
  };
  const double max_nearness = 1 / (kCornerFactor * place_.nearest);
  float* const image =
      nearness_.data() + face.number * static_cast<size_t>(pixels_) * static_cast<size_t>(pixels_);
  // A pixel stays open if a part of it can be nearer than the near plane.
  std::array<Line, kLines + kPlanes> all;
  std::copy(lines.begin(), lines.end(), all.begin());
  std::array<double, kPlanes> around;
  for (size_t k = 0; k < kPlanes; ++k) {
    around[k] = half * (std::abs(planes[k].x) + std::abs(planes[k].y));
    all[kLines + k] = {-planes[k].x, -planes[k].y, max_nearness - around[k] - planes[k].z};
  }
  for (int32_t y = row_of(low); y <= row_of(high); ++y) {
    const double v = (y + 0.5) / scale - 1;
    double left = -1, right = 1;
    for (const Line& line : all) {
      const double rest = line.b * v + line.c;
      if (line.a > 0) {
        left = std::max(left, -rest / line.a);
      } else if (line.a < 0) {
        right = std::min(right, -rest / line.a);
      } else if (rest < 0) {
        right = -2;
      }
    }
    if (!(left <= right)) continue;
    const int32_t x0 =
        std::max(static_cast<int32_t>(std::ceil((left + 1) * scale - 0.5 + 1e-9)), 0);
    const int32_t x1 =
        std::min(static_cast<int32_t>(std::floor((right + 1) * scale - 0.5 - 1e-9)), pixels_ - 1);
    float* const row = image + static_cast<size_t>(y) * static_cast<size_t>(pixels_);
    std::array<double, kPlanes> start,
        step;  // Nearness at the farthest corner of pixel 0, and its change per pixel.
    for (size_t k = 0; k < kPlanes; ++k) {
      const Vec3d& p = planes[k];
      start[k] = (p.x * (half - 1) + p.y * v + p.z - around[k]) * (1 - kRoundDown);
      step[k] = p.x / scale * (1 - kRoundDown);
    }
    for (int32_t x = x0; x <= x1; ++x) {
      double min_nearness = start[0] + x * step[0];
      if constexpr (kPlanes == 2) min_nearness = std::min(min_nearness, start[1] + x * step[1]);
      row[x] = std::max(row[x], static_cast<float>(min_nearness));
    }
  }
}

namespace {

// First and last row of a shape; all rows if a corner is behind the eye.
template <size_t kCorners>
std::pair<double, double> rows_of(const std::array<Vec3d, kCorners>& corners) {
  double low = 1, high = -1;
  for (const Vec3d& p : corners) {
    if (p.z < 1e-3) return {-1, 1};
    low = std::min(low, p.y / p.z);
    high = std::max(high, p.y / p.z);
  }
  return {low, high};
}

// Does the shape lie completely beyond one side of the face, or behind the eye?
template <size_t kCorners>
bool is_outside(const std::array<Vec3d, kCorners>& corners) {
  bool left = true, right = true, under = true, over = true;
  for (const Vec3d& p : corners) {
    left &= p.x < -p.z;
    right &= p.x > p.z;
    under &= p.y < -p.z;
    over &= p.y > p.z;
  }
  return left || right || under || over;
}

// 1 / depth in the plane of three corners, whose cone has the volume `c`.
Vec3d nearness_in(Vec3d a, Vec3d b, Vec3d d, double c) { return cross(b - a, d - a) * (1 / c); }

}  // namespace

void EyeSight::draw_triangle(const Face& face, const std::array<Vec3d, 3>& t) {
  const double c = dot(t[0], cross(t[1], t[2]));
  if (std::abs(c) < kEdgeOn) return;
  const double sign = c > 0 ? 1 : -1, half = 1.0 / pixels_;
  const auto [low, high] = rows_of(t);
  fill<3, 1>(
      face,
      {Line::inside(cross(t[0], t[1]) * sign, half), Line::inside(cross(t[1], t[2]) * sign, half),
       Line::inside(cross(t[2], t[0]) * sign, half)},
      {nearness_in(t[0], t[1], t[2], c)}, low, high);
}

// Corners: the two of the shared side, and one of each triangle.
void EyeSight::draw_seam(const Face& face, const std::array<Vec3d, 4>& s) {
  const auto& [u, v, a, b] = s;
  const Vec3d along = cross(u, v);
  const double ca = dot(a, along), cb = dot(b, along);
  // Both triangles on one side of it: the shared side is an outline.
  if (std::abs(ca) < kEdgeOn || std::abs(cb) < kEdgeOn || (ca > 0) == (cb > 0)) return;
  const double half = 1.0 / pixels_, sa = ca > 0 ? 1 : -1;
  const auto [low, high] = rows_of(std::array{u, v});
  fill<6, 2>(face,
             {Line::touching(along, half), Line::touching(along * -1.0, half),
              Line::inside(cross(v, a) * sa, half), Line::inside(cross(a, u) * sa, half),
              Line::inside(cross(v, b) * -sa, half), Line::inside(cross(b, u) * -sa, half)},
             {nearness_in(u, v, a, ca), nearness_in(u, v, b, cb)}, low - 2 * half, high + 2 * half);
}

void EyeSight::look_from(const EyePlace& place, double max_distance) {
  place_ = place;
  std::fill(nearness_.begin(), nearness_.end(), 0.0F);
  const Vec3d eye = place.eye - occluders_->origin;
  const double cut = place.cut - occluders_->origin.y;
  const auto& corners = occluders_->corners;
  // Skips shapes above the cut and beyond max_distance.
  const auto draw = [&](const auto& ids, auto each) {
    std::array<Vec3d, std::tuple_size_v<std::decay_t<decltype(ids)>>> at;
    Vec3d low{1e300, 1e300, 1e300}, high = low * -1.0;
    for (size_t k = 0; k < at.size(); ++k) {
      const Vec3d p = to_vec(corners[ids[k]]);
      if (!(p.y < cut)) return;
      at[k] = p - eye;
      low = {std::min(low.x, at[k].x), 0, std::min(low.z, at[k].z)};
      high = {std::max(high.x, at[k].x), 0, std::max(high.z, at[k].z)};
    }
    if (low.x > max_distance || low.z > max_distance || high.x < -max_distance ||
        high.z < -max_distance)
      return;
    for (size_t number = 0; number < 6; ++number) {
      const Face face{number};
      auto seen = at;
      for (Vec3d& p : seen) p = face(p);
      if (!is_outside(seen)) each(face, seen);
    }
  };
  for (const auto& t : shape_->triangles) {
    draw(t, [&](const Face& face, const auto& seen) { draw_triangle(face, seen); });
  }
  for (const Seam& s : shape_->seams) {
    draw(std::array{s.u, s.v, s.a, s.b},
         [&](const Face& face, const auto& seen) { draw_seam(face, seen); });
  }
}

bool EyeSight::sees(const Box3d& box) const {
  const Vec3d low = box.min - place_.eye, high = box.max - place_.eye;
  const double scale = 0.5 * pixels_;
  for (size_t number = 0; number < 6; ++number) {
    const Face face{number};
    Vec3d a = face(low), b = face(high);
    if (a.z > b.z) std::swap(a.z, b.z);
    if (b.z <= 0 || a.x > b.z || b.x < -b.z || a.y > b.z || b.y < -b.z) continue;
    if (a.z <= 1e-3) return true;  // Beside the eye.
    const auto span = [&](double from, double to) {
      const double first = std::min(from / a.z, from / b.z), last = std::max(to / a.z, to / b.z);
      const auto pixel = [&](double at) {
        return static_cast<int32_t>(std::clamp(std::floor((at + 1) * scale), 0.0, pixels_ - 1.0));
      };
      return std::pair{pixel(first - 1e-9), pixel(last + 1e-9)};
    };
    const auto [x0, x1] = span(a.x, b.x);
    const auto [y0, y1] = span(a.y, b.y);
    const auto nearest = static_cast<float>(1 / a.z);
    for (int32_t y = y0; y <= y1; ++y) {
      const size_t row = (number * static_cast<size_t>(pixels_) + static_cast<size_t>(y)) *
                         static_cast<size_t>(pixels_);
      for (int32_t x = x0; x <= x1; ++x) {
        if (nearness_[row + static_cast<size_t>(x)] <= nearest) return true;
      }
    }
  }
  return false;
}

}  // namespace throng::view
