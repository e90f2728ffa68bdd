// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/body_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/surface/body_sweep.h"

// Proves that a body may move between two poses: the body, grown by as far as any of its points
// moves, enters no triangle; where it does, the motion is halved. Cost: triangles near, times
// halvings.
namespace throng::bake {
namespace {

constexpr double kGrowth = 0.03;  // The least growth of a body between poses. [m]
constexpr int kMaxSteps = 256;    // of a walker's move

// Height of a triangle on the vertical line through (x, z), if it is there.
bool supports(const LocalTriangle& t, Vec3d at, double reach) {
  double height = 0, sum = 0;
  std::array<double, 3> weight;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3d a = t[(i + 1) % 3], b = t[(i + 2) % 3];
    weight[i] = (a.x - at.x) * (b.z - at.z) - (a.z - at.z) * (b.x - at.x);
    sum += weight[i];
    height += weight[i] * t[i].y;
  }
  if (sum == 0) return false;
  for (const double w : weight) {
    if (w * sum < 0) return false;
  }
  return std::fabs(height / sum - at.y) <= reach;
}

bool holds(const Box3d& outer, const Box3d& inner) {
  return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
         outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

// From a body's feet to its farthest point. [m]
double farthest_of(const PatchBody& body) {
  return std::sqrt(body.height * body.height + body.radius * body.radius);
}

}  // namespace

double MotionJudge::reach_of(const PatchBody& body) { return farthest_of(body) + kGrowth; }

void MotionJudge::list_triangles(const Box3d& box, Vec3d around, FilterList& out) {
  found_.clear();
  triangles_->find(box, found_);
  out.clear(around);
  for (const uint32_t t : found_) out.add(t, triangles_->corners(t));
  out.close();
}

void MotionJudge::look_around(const Box3d& box) {
  around_.box = box;
  closer_.box = {};
  list_triangles(box, (box.min + box.max) * 0.5, around_.list);
}

void MotionJudge::look_closer(const Box3d& box) {
  closer_.box = {};
  if (!holds(around_.box, box)) return;
  closer_.box = box;
  narrow(around_.list, box, closer_.list);
}

bool MotionJudge::is_free(const PatchBody& body, const BodyPose& from, const BodyPose& to) {
  if (dot(from.axis, to.axis) < -0.5) return false;  // The direction of the turn is ambiguous.
  const double far = farthest_of(body), around = reach_of(body);
  // The turning axis moves fastest at t = 1/2, by the angle's tangent: twice the chord bounds it.
  const double move = length(to.feet - from.feet) + 2 * far * length(to.axis - from.axis);
  Box3d box;
  for (const BodyPose& pose : {from, to}) {
    const Vec3d reach{around, around, around};
    box.add(pose.feet - reach);
    box.add(pose.feet + reach);
  }
  if (holds(closer_.box, box)) {
    narrow(closer_.list, box, near_);
  } else if (holds(around_.box, box)) {
    narrow(around_.list, box, near_);
  } else {
    list_triangles(box, from.feet, near_);
  }
  return is_free(body, from, to, move, 0, 1);
}

// The part of a motion from t0 to t1, halved until the grown body is free.
bool MotionJudge::is_free(const PatchBody& body, const BodyPose& from, const BodyPose& to,
                          double move, double t0, double t1) {
  const double t = (t0 + t1) / 2, growth = move * (t1 - t0) / 2;
  const Vec3d axis = from.axis * (1 - t) + to.axis * t;
  const BodyFrame frame =
      BodyFrame::around(from.feet * (1 - t) + to.feet * t, axis * (1 / length(axis)));
  const BodySweep exact{.radius = body.radius, .low = body.bottom, .high = body.height};
  const BodySweep grown{
      .radius = body.radius + growth, .low = body.bottom - growth, .high = body.height + growth};
  // The least growth is not halved any more.
  const bool last = growth <= kGrowth;
  const std::array<FilterTube, 2> tubes{
      {{.whole = exact, .decisive = exact}, {.whole = grown, .decisive = grown}}};
  const uint32_t answered =
      filter(near_, {.frame = frame, .first = grown, .second = grown, .tubes = tubes}, hits_);
  if ((answered & (last ? 3 : 1)) != 0) return false;
  bool free = (answered & 2) == 0;
  for (size_t i = 0; i < hits_.count; ++i) {
    LocalTriangle local = triangles_->corners(hits_.triangle[i]);
    for (Vec3d& corner : local) corner = frame.local(corner);
    if (free && lowest_entry(local, grown) < kNever) {
      if (last) return false;
      free = false;
    }
    if ((hits_.tubes[i] & 1) != 0 && lowest_entry(local, exact) < kNever) return false;
  }
  return free || (is_free(body, from, to, move, t0, t) && is_free(body, from, to, move, t, t1));
}

bool MotionJudge::is_supported(Vec3d from, Vec3d to, double reach, double spacing) {
  Box3d box;
  box.add(from);
  box.add(to);
  box.min.y -= reach;
  box.max.y += reach;
  found_.clear();
  triangles_->find(box, found_);
  const Scene& scene = triangles_->scene();
  std::erase_if(found_, [&](uint32_t triangle) { return scene.area[triangle] == kAreaBlocked; });
  const int steps = static_cast<int>(std::ceil(length(to - from) / spacing)) + 1;
  if (steps > kMaxSteps) return false;
  for (int k = 0; k <= steps; ++k) {
    const double t = static_cast<double>(k) / steps;
    const Vec3d at = from * (1 - t) + to * t;
    const bool supported = std::any_of(found_.begin(), found_.end(), [&](uint32_t triangle) {
      return supports(triangles_->corners(triangle), at, reach);
    });
    if (!supported) return false;
  }
  return true;
}

}  // namespace throng::bake
