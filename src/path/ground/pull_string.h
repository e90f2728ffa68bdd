// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

/// The string puller of all paths that are not drawn over corners: one loop, and a string for each
/// space, which knows whether a straight segment may be moved along and where a point moves to.
namespace throng::path {

/// Which of the points that a straight segment may lead to is tried first.
enum class LeaveOut {
  kFarthestFirst,  ///< The last one, then one less: the segment is as long as can be, n tests.
  kDoubling,  ///< 1, 2, 4 ... points on, then halving: about log n tests, not always the farthest.
};

/// Keeps the first point, the last one and those that are needed between: from each point kept on
/// to another that `reaches(from, index of from, index of to)` says a straight segment reaches. The
/// next point needs no test. Indices are those of before.
template <LeaveOut kOrder, class Points, class Reaches>
void leave_out(Points& points, Reaches reaches) {
  const size_t size = points.size();
  if (size < 3) return;
  size_t kept = 1;
  for (size_t at = 0; at + 1 < size;) {
    const auto from = points[kept - 1];
    size_t to = at + 1;
    if constexpr (kOrder == LeaveOut::kFarthestFirst) {
      for (size_t far = size - 1; far > at + 1; --far) {
        if (!reaches(from, at, far)) continue;
        to = far;
        break;
      }
    } else {
      size_t stride = 1;
      for (; to + stride < size && reaches(from, at, to + stride); stride *= 2) to += stride;
      for (; stride > 0; stride /= 2) {
        if (to + stride < size && reaches(from, at, to + stride)) to += stride;
      }
    }
    points[kept++] = points[to];
    at = to;
  }
  points.resize(kept);
}

/// Pulls a path taut, in rounds: points that are not needed are left out, the others move to where
/// the path costs less. A String has
/// - `kRounds`, and `kEnds`, how many of the points never move;
/// - `leave_out(points)`;
/// - `move(points, round)`: moves the points, each as far as its segments stay legal and cost less;
///   false if that no longer pays.
/// So the result costs no more than the path did, and is as legal.
template <class String, class Points>
void pull_string(String& string, Points& points) {
  string.leave_out(points);
  for (int round = 0; round < String::kRounds; ++round) {
    if (points.size() <= String::kEnds || !string.move(points, round)) return;
    string.leave_out(points);
  }
}

}  // namespace throng::path
