// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/function_ref.h"
#include "crowd/ground/body.h"
#include "crowd/ground/stride_ground.h"
#include "crowd/walk/routes.h"

/// Where a body can stand aside: not on the paths of others.
namespace throng::crowd {

/// The next part of a path, from where its body is.
class PathLine {
 public:
  struct Point {
    double x = 0, z = 0;  // [units]
    double y = 0;         // feet [mm]
    double along = 0;     // the line up to here [units]
  };
  /// The nearest point of the line.
  struct Nearest {
    double square = 1e300;            // of the distance [units]
    double along = 0;                 // [units]
    double ahead_x = 0, ahead_z = 0;  // direction of the line there
  };

  void reserve(size_t points) { points_.reserve(points); }
  void clear(int32_t radius) {
    points_.clear();
    radius_ = radius;
  }
  void add(double x, double z, double y);
  [[nodiscard]] double length() const { return points_.empty() ? 0 : points_.back().along; }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] int32_t radius() const { return radius_; }
  /// Of those at most `height` above or below. [units, mm]
  [[nodiscard]] Nearest nearest(double x, double z, double y, double height) const;

 private:
  std::vector<Point> points_;
  int32_t radius_ = 0;  // of the body [units]
};

/// A search over the cells around a body, breadth first: the nearest place that is good. It reuses
/// its memory.
class AsideSearch {
 public:
  static constexpr int32_t kSide = 256;      ///< Cells of the window around the body.
  static constexpr size_t kMaxCells = 6000;  ///< So many are visited at most.

  void reserve() {
    seen_.reserve(size_t{kSide} * kSide);
    nodes_.reserve(kMaxCells + 4);
    chain_.reserve(kMaxCells + 4);
  }
  /// Writes the corners of a path over the ground to the nearest place at which `is_good`, through
  /// places that `is_free` accepts. False: there is none near.
  bool find(const StrideGround& ground, const Body& body, FunctionRef<bool(const Stand&)> is_free,
            FunctionRef<bool(const Stand&)> is_good, std::vector<PathPoint>& corners);

 private:
  struct Node {
    Stand at;
    uint32_t parent = 0;
  };
  void write_corners(const StrideGround& ground, size_t last, std::vector<PathPoint>& corners);

  std::vector<uint8_t> seen_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> chain_;
};

}  // namespace throng::crowd
