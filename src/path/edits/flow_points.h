// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "path/edits/ground_finder.h"
#include "path/edits/point_search.h"
#include "throng/base.h"
#include "throng/path.h"

/// The distances of a FlowField, apart from the ground: one table serves many workers, each with
/// its own copy of the ground.
namespace throng::path {

class FlowPoints {
 public:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  /// Searches outwards from all goals that are places of the class, up to a cost of `max_distance`
  /// metres. None if it was cancelled; without any points if no goal is a place.
  static std::optional<FlowPoints> create(GroundFinder& ground, std::span<const Place> goals,
                                          double max_distance, Context& context);
  [[nodiscard]] bool empty() const { return points_.empty(); }

  // `ground` is that of which they were made, or a copy of it, here and below.
  /// As FlowField::distance, next, find_path.
  [[nodiscard]] double distance(GroundFinder& ground, const Place& place) const;
  [[nodiscard]] Place next(GroundFinder& ground, const Place& place) const;
  void find_path(GroundFinder& ground, const Place& place, Path& path) const;

  [[nodiscard]] size_t size() const { return points_.size(); }
  [[nodiscard]] uint64_t bytes() const {
    return points_.size() * sizeof(Point) + link_ends_.size() * sizeof(LinkEnd);
  }

 private:
  static constexpr uint32_t kNoPoint = UINT32_MAX, kNoLink = UINT32_MAX;
  // A goal, or a point just inside a rectangle where the path to a goal leaves it, or the start of
  // an off-mesh link.
  struct Point {
    ViewStop stop;
    uint32_t next = kNoPoint;  // on the path; none at a goal
    uint32_t link = kNoLink;   // of link_ends_: the path takes an off-mesh link from here
    double cost = 0;           // [cells]
  };
  // The far end of an off-mesh link, in the rectangle of the next point.
  struct LinkEnd {
    world::GroundPoint at;
    double cost = 0;  // of the link [cells]
  };

  static bool before(const Point& a, const Point& b);
  [[nodiscard]] std::pair<uint32_t, double> leave_by(GroundView& mesh, const ViewStop& stop) const;
  [[nodiscard]] ViewStop stop_beyond(GroundView& mesh, const Point& point) const;

  // By level and rectangle, so that those of one lie together.
  std::vector<Point> points_;
  std::vector<LinkEnd> link_ends_;
  double max_distance_ = kNever;  // [cells]
};

}  // namespace throng::path
