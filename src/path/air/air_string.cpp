// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/air_string.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "path/ground/pull_string.h"

// A taut path turns at edges of blockers, and its angles to the edge are alike on both sides. Edges
// run along the axes, so a waypoint is slid along one axis at a time to where that is so; a
// waypoint that hangs in the air is cut off, which makes two of it that lie on the edges. Time:
// lines of sight, each linear in the boxes that it crosses: a constant number for each waypoint and
// round, and up to the square of the waypoints to leave some out.
namespace throng::path {
namespace {

constexpr int32_t kHalvings = 8;
constexpr double kGain = 1e-3;  // less is not worth a round, of the whole length

}  // namespace

void AirString::pull(const AirView& air, std::vector<AirPoint>& path) {
  air_ = air;
  pull_string(*this, path);
}

void AirString::leave_out(std::vector<AirPoint>& path) const {
  path::leave_out<LeaveOut::kFarthestFirst>(
      path, [&](AirPoint from, size_t, size_t to) { return air_->sees(from, path[to]); });
}

bool AirString::move(std::vector<AirPoint>& path, int round) {
  const double length = length_of(path);
  if (round > 0 && length > length_ * (1 - kGain)) return false;
  length_ = length;
  if (round < 3) cut_corners(path);
  for (size_t i = 1; i + 1 < path.size(); ++i) slide(path, i);
  return true;
}

// Two points on the segments of a waypoint, as far out as they see each other, instead of it.
void AirString::cut_corners(std::vector<AirPoint>& path) {
  next_.clear();
  next_.push_back(path[0]);
  for (size_t i = 1; i + 1 < path.size(); ++i) {
    const AirPoint before = next_.back(), here = path[i], after = path[i + 1];
    const auto toward = [&](AirPoint end, double part) {
      return off_faces(here + part * (end - here));
    };
    double low = 0, high = 1;
    for (int32_t h = 0; h < kHalvings; ++h) {
      const double part = (low + high) / 2;
      const AirPoint a = toward(before, part), b = toward(after, part);
      const bool legal = air_->sees(before, a) && air_->sees(a, b) && air_->sees(b, after);
      (legal ? low : high) = part;
    }
    if (low == 0) {
      next_.push_back(here);
      continue;
    }
    next_.push_back(toward(before, low));
    next_.push_back(toward(after, low));
  }
  next_.push_back(path.back());
  path.assign(next_.begin(), next_.end());  // Both keep what they have grown to.
}

void AirString::slide(std::vector<AirPoint>& path, size_t waypoint) const {
  AirPoint& here = path[waypoint];
  const AirPoint before = path[waypoint - 1], after = path[waypoint + 1];
  for (int axis = 0; axis < 3; ++axis) {
    // Where the angles are alike: the other two coordinates give the distance of either end.
    double across[2] = {0, 0};
    for (int other = 0; other < 3; ++other) {
      if (other == axis) continue;
      const double a = axis_of(before, other) - axis_of(here, other);
      const double b = axis_of(after, other) - axis_of(here, other);
      across[0] += a * a;
      across[1] += b * b;
    }
    const double da = std::sqrt(across[0]), db = std::sqrt(across[1]);
    if (!(da + db > 0)) continue;
    const double from = axis_of(here, axis);
    const double best =
        axis_of(before, axis) + (axis_of(after, axis) - axis_of(before, axis)) * (da / (da + db));
    const double old = air_distance(before, here) + air_distance(here, after);
    double low = 0, high = 1;
    AirPoint to = here;
    for (int32_t h = 0; h <= kHalvings; ++h) {
      const double part = h == 0 ? 1.0 : (low + high) / 2;
      axis_of(to, axis) = off_faces(from + part * (best - from));
      const bool legal = air_->sees(before, to) && air_->sees(to, after);
      (legal ? low : high) = part;
      if (h == 0 && legal) break;
    }
    if (low == 0) continue;
    axis_of(to, axis) = off_faces(from + low * (best - from));
    if (air_distance(before, to) + air_distance(to, after) >= old) continue;
    here = to;
  }
}

}  // namespace throng::path
