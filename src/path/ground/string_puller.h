// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "path/ground/mesh.h"
#include "path/ground/sight.h"

/// Pulls a path taut.
namespace throng::path {

/// A point that a path leads over: a corner, or anywhere in a rectangle.
struct Waypoint {
  CellPoint at;
  uint32_t rect = kNoRect;      // of which it is a point, if it is no corner
  uint32_t corner = kNoCorner;  // none: the path need not turn here
};

/// The waypoint of a corner.
inline Waypoint waypoint(const PathMesh& mesh, uint32_t corner) {
  const MeshCorner& at = mesh.corners[corner];
  return {{double(at.x), double(at.z)}, kNoRect, corner};
}

/// Makes paths that are pieced together the shortest of their kind: those that pass every obstacle
/// on the same side. Owns its memory: one per thread.
class StringPuller {
 public:
  /// Of a path whose points see each other one after the other, the corners at which it turns once
  /// it is taut, ends left out; `length` in cells. False if it does not come to an end.
  bool pull(const PathMesh& mesh, const std::vector<Waypoint>& path, std::vector<uint32_t>& corners,
            double& length);

 private:
  void prefetch_waypoints(const PathMesh& mesh, const std::vector<Waypoint>& path);
  void wrap(const PathMesh& mesh, const Waypoint& from, const Waypoint& over, const Waypoint& to);

  Sight sight_;
  std::vector<Waypoint> taut_;        // the path so far
  std::vector<Waypoint> ahead_;       // the rest of it, the next one last
  std::vector<uint32_t> prefetched_;  // corners that are prefetched
  std::vector<Waypoint> chain_;       // what stands between two points
};

}  // namespace throng::path
