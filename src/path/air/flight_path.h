// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "path/ground/reset_path.h"
#include "throng/path.h"

/// Builds the path that a query in the air returns, segment by segment.
namespace throng::path {

inline double distance(Vec3d a, Vec3d b) {
  const Vec3d d = a - b;
  return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

/// Clears all but the nodes, which count what all parts of a search expand.
inline void clear(Path& path) {
  const uint64_t nodes = path.nodes;
  reset(path);
  path.nodes = nodes;
}

inline void add(Vec3d point, SegmentKind kind, Path& path) {
  if (!path.points.empty()) {
    path.length += distance(path.points.back().position, point);
    path.segments.push_back(kind);
  }
  path.points.push_back({point});
}

inline double length_of(const Path& ground) {
  double length = 0;
  for (size_t i = 1; i < ground.points.size(); ++i) {
    length += distance(ground.points[i - 1].position, ground.points[i].position);
  }
  return length;
}

inline void add_walk(const Path& ground, size_t first, Path& path) {
  for (size_t i = first; i < ground.points.size(); ++i) {
    add(ground.points[i].position, SegmentKind::kWalk, path);
    path.points.back() = ground.points[i];
  }
}

}  // namespace throng::path
