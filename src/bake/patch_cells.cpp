// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/patch_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "world/node_data.h"

// A body with its feet at p, axis n and bottom b fills the points p + h n + l, where b <= h <=
// height and l is at most a radius long and across n. If all normals of a sub-patch lie within an
// angle w of m, and its points within a radius a of m's axis and between e0 and e1 along it, then
// all bodies on it lie within a + radius + height sin(w) of the axis and between
// e0 + b cos(w) - radius sin(w) and e1 + height + radius sin(w). No triangle there, no triangle in
// any body. The patch's own triangles and its neighbours' are tested like all others: only where
// they bend by more than a body's bottom do they get in its way.
namespace throng {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kWidestCone = 0.94;   // sine of its half angle
constexpr double kSlopeMargin = 1e-6;  // a plane at exactly a limit keeps it

// A triangle's box in a frame: most come into no body, and are not looked at more closely.
struct LocalBox {
  double left, right, back, front, low, high;

  explicit LocalBox(const LocalTriangle& t)
      : left(std::min(std::min(t[0].x, t[1].x), t[2].x)),
        right(std::max(std::max(t[0].x, t[1].x), t[2].x)),
        back(std::min(std::min(t[0].y, t[1].y), t[2].y)),
        front(std::max(std::max(t[0].y, t[1].y), t[2].y)),
        low(std::min(std::min(t[0].z, t[1].z), t[2].z)),
        high(std::max(std::max(t[0].z, t[1].z), t[2].z)) {}

  [[nodiscard]] bool meets(const BodySweep& sweep) const {
    return low <= sweep.high && high >= sweep.low && left <= sweep.radius &&
           right >= -sweep.radius && back <= sweep.radius && front >= -sweep.radius;
  }
};

double sine_of(double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }

// To 9 digits: the last bits of cos() differ between machines' libraries.
double rounded_cosine(double degrees) {
  return std::round(std::cos(degrees * std::numbers::pi / 180) * 1e9) / 1e9;
}

}  // namespace

std::vector<PatchBody> patch_bodies(std::span<const AvatarClass> classes) {
  std::vector<PatchBody> bodies;
  for (size_t c = 0; c < classes.size(); ++c) {
    const AvatarClass& avatar = classes[c];
    const bool climbs = avatar.climb_slope > 0;
    bodies.push_back(
        {.radius = avatar.radius,
         .bottom = climbs ? avatar.step : body_bottom(avatar),
         .height = avatar.height,
         .steepest = rounded_cosine(climbs ? avatar.climb_slope : avatar.max_slope) - kSlopeMargin,
         .climbs = climbs,
         .bit = static_cast<uint16_t>(1u << c)});
  }
  return bodies;
}

double SurfaceBound::steepest_cosine() const {
  const double up = std::clamp(frame.up.y, -1.0, 1.0), across = sine_of(up);
  if (across * cosine + up * sine < 0) return -1;  // The cone holds straight down.
  return up * cosine - across * sine;
}

std::optional<SurfaceBound> bound_surface(const BezierPatch& patch) {
  const auto& p = patch.points;
  std::array<Vec3d, 12> along_s, along_t;
  Vec3d mean_s, mean_t, centre;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      along_s[3 * j + i] = (p[4 * j + i + 1] - p[4 * j + i]) * 3;
      along_t[3 * j + i] = (p[4 * (i + 1) + j] - p[4 * i + j]) * 3;
      mean_s = mean_s + along_s[3 * j + i];
      mean_t = mean_t + along_t[3 * j + i];
    }
  }
  mean_s = mean_s * (1.0 / 12);
  mean_t = mean_t * (1.0 / 12);
  for (const Vec3d& point : p) centre = centre + point;
  centre = centre * (1.0 / 16);
  double off_s = 0, off_t = 0;
  for (size_t k = 0; k < 12; ++k) {
    const Vec3d ds = along_s[k] - mean_s, dt = along_t[k] - mean_t;
    off_s = std::max(off_s, dot(ds, ds));
    off_t = std::max(off_t, dot(dt, dt));
  }
  off_s = std::sqrt(off_s);
  off_t = std::sqrt(off_t);
  const Vec3d normal = cross(mean_t, mean_s);
  const double size = length(normal);
  // (t + dt) x (s + ds) differs from t x s by at most this.
  const double off = off_t * length(mean_s) + length(mean_t) * off_s + off_t * off_s;
  if (!(size > 0) || !(off < kWidestCone * size)) return std::nullopt;
  SurfaceBound bound;
  bound.sine = off / size;
  bound.cosine = std::sqrt(1 - bound.sine * bound.sine);
  bound.frame = BodyFrame::around(centre, normal * (1 / size));
  bound.area = size;
  bound.low = kNever;
  bound.high = -kNever;
  double radius2 = 0;
  for (const Vec3d& point : p) {
    const Vec3d q = bound.frame.local(point);
    radius2 = std::max(radius2, q.x * q.x + q.y * q.y);
    bound.low = std::min(bound.low, q.z);
    bound.high = std::max(bound.high, q.z);
  }
  bound.radius = std::sqrt(radius2);
  return bound;
}

// The normals' heights lie in the hull of those of all products: a wall that bends sideways is
// nowhere steeper than a wall, which the cone cannot tell.
double steepest_cosine(const BezierPatch& patch, const SurfaceBound& bound) {
  const auto& p = patch.points;
  double least = kNever;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      const Vec3d s = p[4 * j + i + 1] - p[4 * j + i];
      for (size_t k = 0; k < 12; ++k) {
        const Vec3d t = p[k + 4] - p[k];
        least = std::min(least, 9 * (t.z * s.x - t.x * s.z));
      }
    }
  }
  // The normal's length: within `sine` of the mean's.
  const double length = bound.area * (least > 0 ? 1 + bound.sine : 1 - bound.sine);
  return std::max(-1.0, least / length);
}

BodySweep sweep_of(const SurfaceBound& surface, const PatchBody& body) {
  return {.radius = surface.radius + body.radius + body.height * surface.sine,
          .low = surface.low + body.bottom * surface.cosine - body.radius * surface.sine,
          .high = surface.high + body.height + body.radius * surface.sine};
}

PatchJudge::PatchJudge(const TriangleSquares& triangles, std::span<const AvatarClass> classes,
                       const NodeBins& bins, double size)
    : triangles_(&triangles),
      set_(&triangles.scene().patches),
      bodies_(patch_bodies(classes)),
      bins_(&bins),
      size_(size) {
  for (const double edge : bins.inclination) {
    bin_cosine_.push_back(rounded_cosine(edge) - kSlopeMargin);
  }
  tallest_ = bins.height.back();
  least_bottom_ = kNever;
  for (const PatchBody& body : bodies_) least_bottom_ = std::min(least_bottom_, body.bottom);
}

int32_t PatchJudge::depth_of(const BezierPatch& patch) const {
  double longest = 0;
  for (int32_t e = 0; e < 4; ++e) {
    const auto curve = patch.edge(e);
    longest = std::max(longest, length(curve[1] - curve[0]) + length(curve[2] - curve[1]) +
                                    length(curve[3] - curve[2]));
  }
  int32_t depth = 0;
  while (depth < kDeepestPatch && longest > size_ * (1 << depth)) ++depth;
  return depth;
}

BezierCells PatchJudge::judge(uint32_t patch) {
  // The patch, its neighbours and theirs, among them those that share a corner with it.
  beside_ = {patch};
  for (int ring = 0; ring < 2; ++ring) {
    for (size_t i = 0, count = beside_.size(); i < count; ++i) {
      for (const PatchEdge& edge : set_->edges[beside_[i]]) {
        for (const PatchSide& next : edge.next) {
          if (next.patch == kNoPatch) continue;
          if (std::find(beside_.begin(), beside_.end(), next.patch) == beside_.end()) {
            beside_.push_back(next.patch);
          }
        }
      }
    }
  }
  is_beside_.resize(set_->size());
  for (const uint32_t p : beside_) is_beside_[p] = 1;
  BezierCells out;
  const BezierPatch& whole = set_->patches[patch];
  out.promise.depth = depth_of(whole);
  const size_t cells = size_t{1} << (2 * out.promise.depth);
  out.promise.cells.resize(cells);
  out.shape.resize(cells);
  visit(whole, 0, 0, 0, out);
  for (const uint32_t p : beside_) is_beside_[p] = 0;
  std::sort(out.makers.begin(), out.makers.end());
  out.makers.erase(std::unique(out.makers.begin(), out.makers.end()), out.makers.end());
  return out;
}

void PatchJudge::visit(const BezierPatch& part, int32_t level, int32_t s, int32_t t,
                       BezierCells& out) {
  if (level == out.promise.depth) {
    judge_cell(part, out.promise.index(s, t), out);
    return;
  }
  const auto by_s = split_s(part, 0.5);
  for (int32_t i = 0; i < 2; ++i) {
    const auto by_t = split_t(by_s[static_cast<size_t>(i)], 0.5);
    for (int32_t j = 0; j < 2; ++j) {
      visit(by_t[static_cast<size_t>(j)], level + 1, 2 * s + i, 2 * t + j, out);
    }
  }
}

void PatchJudge::judge_cell(const BezierPatch& part, size_t cell, BezierCells& out) {
  const auto bound = bound_surface(part);
  Promise& promise = out.promise.cells[cell];
  promise = {.classes = 0, .inclination = 15, .height = 0, .headroom = 0};
  CellShape& shape = out.shape[cell];
  if (!bound) {
    const Box3d box = part.bounds();
    const Vec3d middle = (box.min + box.max) * 0.5;
    shape = {static_cast<float>(middle.x), static_cast<float>(middle.y),
             static_cast<float>(middle.z), static_cast<float>(length(box.max - middle)), 0};
    return;
  }
  const Vec3d c = bound->frame.centre;
  const double deep = std::max(-bound->low, bound->high);
  shape = {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z),
           static_cast<float>(std::sqrt(bound->radius * bound->radius + deep * deep)),
           static_cast<float>(bound->area)};
  const auto bin_of = [&](double cosine) {
    uint8_t code = 0;
    while (code < bin_cosine_.size() && cosine < bin_cosine_[code]) ++code;
    return code;
  };
  double steepest = bound->steepest_cosine();
  promise.inclination = bin_of(steepest);
  // Every class's limit is an edge, so a closer look can change a verdict only if it can change
  // the bin.
  if (promise.inclination != bin_of(bound->frame.up.y)) {
    steepest = std::max(steepest, steepest_cosine(part, *bound));
    promise.inclination = bin_of(steepest);
  }
  const auto open = static_cast<uint8_t>(bins_->height.size());
  promise.height = promise.headroom = open;
  triangles_->find_patches(bound->frame,
                           {.radius = bound->radius, .low = bound->low, .high = bound->high},
                           is_beside_, out.makers);
  judge_posture(bound->frame, *bound, true, steepest, promise);
  if (bound->frame.up.y <= bound->sine) {  // It may lean over: it is its own ceiling.
    promise.headroom = 0;
    return;
  }
  SurfaceBound upright = *bound;
  upright.frame = {bound->frame.centre, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  upright.sine = 0;
  upright.cosine = 1;
  upright.low = kNever;
  upright.high = -kNever;
  double radius2 = 0;
  for (const Vec3d& point : part.points) {
    const Vec3d q = point - c;
    radius2 = std::max(radius2, q.x * q.x + q.z * q.z);
    upright.low = std::min(upright.low, q.y);
    upright.high = std::max(upright.high, q.y);
  }
  upright.radius = std::sqrt(radius2);
  judge_posture(upright.frame, upright, false, steepest, promise);
}

// Tests the classes of one posture, and the free height along it.
void PatchJudge::judge_posture(const BodyFrame& frame, const SurfaceBound& surface, bool climbs,
                               double steepest, Promise& promise) {
  const BodySweep prism{.radius = surface.radius + tallest_ * surface.sine,
                        .low = surface.low + least_bottom_ * surface.cosine,
                        .high = surface.high + tallest_};
  asked_.clear();
  BodySweep bodies;
  for (const PatchBody& body : bodies_) {
    if (body.climbs != climbs || !(steepest >= body.steepest)) continue;
    promise.classes |= body.bit;
    const BodySweep sweep = sweep_of(surface, body);
    if (asked_.empty()) bodies = sweep;
    bodies = {.radius = std::max(bodies.radius, sweep.radius),
              .low = std::min(bodies.low, sweep.low),
              .high = std::max(bodies.high, sweep.high)};
    asked_.push_back({sweep, body.bit});
  }
  // Bodies are wider than what tells the height, but begin higher: one cylinder around both would
  // hold the ground at their feet.
  found_.clear();
  triangles_->find(frame, prism, asked_.empty() ? prism : bodies, found_);
  double free = kNever;
  bool measures = true;  // until nothing can be promised any more
  for (const uint32_t triangle : found_) {
    if (!measures && asked_.empty()) break;
    LocalTriangle local = triangles_->corners(triangle);
    for (Vec3d& corner : local) corner = frame.local(corner);
    const LocalBox box(local);
    if (measures && box.low < free && box.meets(prism)) {
      free = std::min(free, lowest_entry(local, prism));
      measures = free == kNever || bins_->height_code(std::max(0.0, free - surface.high)) > 0;
    }
    std::erase_if(asked_, [&](const AskedBody& body) {
      if (!box.meets(body.sweep) || lowest_entry(local, body.sweep) == kNever) return false;
      promise.classes = static_cast<uint16_t>(promise.classes & ~body.bit);
      return true;
    });
  }
  // The highest feet have the least.
  if (free < kNever) {
    (climbs ? promise.height : promise.headroom) =
        bins_->height_code(std::max(0.0, free - surface.high));
  }
}

}  // namespace throng
