// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "bake/columns/triangles.h"
#include "throng/base.h"
#include "throng/scene.h"

/// Where a body may be while its feet are anywhere in a sub-patch, against triangles.
namespace throng::bake {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// Right-handed axes around a point; `up` is the body's axis. Unit lengths.
struct BodyFrame {
  Vec3d centre, side, front, up;

  static BodyFrame around(Vec3d centre, Vec3d up);
  /// Coordinates along side and front, and the height along up.
  [[nodiscard]] Vec3d local(Vec3d p) const {
    const Vec3d d = p - centre;
    return {dot(d, side), dot(d, front), dot(d, up)};
  }
};

/// The cylinder that holds the body wherever its feet are. Heights along a frame's axis. [m]
struct BodySweep {
  double radius = 0, low = 0, high = 0;
};

using LocalTriangle = std::array<Vec3d, 3>;

/// The least height in a sweep that a triangle reaches there; infinite if it stays outside. The
/// triangle is clipped to the sweep's heights and what is left is compared with its radius, so the
/// height is at most the true one.
[[nodiscard]] double lowest_entry(const LocalTriangle& triangle, const BodySweep& sweep);

/// Does a triangle come into a sweep while that goes straight across its axis, by `along`? [m]
[[nodiscard]] bool enters_on_move(const LocalTriangle& triangle, const BodySweep& sweep,
                                  Vec3d along);

/// The box that holds a sweep.
[[nodiscard]] Box3d sweep_box(const BodyFrame& frame, const BodySweep& sweep);

/// Triangles of a scene in small clusters, by squares of the ground.
class TriangleSquares {
 public:
  TriangleSquares(const Scene& scene, int32_t workers);

  /// Appends the triangles of clusters whose boxes overlap `wanted`, each once.
  void find(const Box3d& wanted, std::vector<uint32_t>& out) const;
  [[nodiscard]] LocalTriangle corners(uint32_t triangle) const;
  [[nodiscard]] const Scene& scene() const { return *scene_; }

 private:
  struct Cluster {
    std::array<float, 6> box;      ///< From base_, rounded outward.
    uint32_t first = 0, last = 0;  ///< of order_
  };

  /// A cluster in one of its squares. Unset at first; many threads set all of them.
  struct Item {
    std::array<float, 6> box;
    uint32_t first;  ///< of order_
    uint8_t count;
    bool begins_x, begins_z;  ///< No square before this one has it.
  };
  std::vector<Cluster> make_clusters(int32_t workers);
  [[nodiscard]] Cluster measure(uint32_t first, uint32_t last) const;
  [[nodiscard]] int32_t square(double v, double origin, int32_t count) const;

  const Scene* scene_;
  double side_ = 2;  // [m]
  Vec3d base_;
  double origin_x_ = 0, origin_z_ = 0;  // from base_
  std::unique_ptr<uint32_t[]> order_;   // triangles
  std::unique_ptr<Item[]> items_;       // by square
  std::vector<uint32_t> first_;         // squares and the end
  int32_t squares_x_ = 0, squares_z_ = 0;
};

}  // namespace throng::bake
