// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "graph/node_mesh.h"
#include "throng/base.h"

/// Which blocks of Bezier patches lie near a point.
namespace throng::path {

/// The parameters of a block's point nearest to a position: from its middle by Gauss-Newton steps,
/// kept inside; on a level tile the nearest in the plane.
[[nodiscard]] std::pair<double, double> nearest_in(const graph::NodeSurface& surface,
                                                   const graph::NodeBlock& block, Vec3d position);

/// Balls around the blocks of Bezier patches, by the square of the ground that holds their middle.
class BlockSquares {
 public:
  explicit BlockSquares(const graph::NodeMesh& mesh);

  /// Calls visit(block) for each block that may have a point no farther than `radius`, which the
  /// calls may reduce. In no order.
  template <class Visit>
  void for_each_near(Vec3d position, const double& radius, Visit visit) const {
    if (balls_.empty()) return;
    const double far = std::min(radius, 1e9) + largest_;
    const auto [x0, z0] = square(position.x - far, position.z - far);
    const auto [x1, z1] = square(position.x + far, position.z + far);
    for (size_t z = z0; z <= z1; ++z) {
      for (size_t k = first_[z * squares_x_ + x0]; k < first_[z * squares_x_ + x1 + 1]; ++k) {
        const Ball& ball = balls_[k];
        const Vec3d d = ball.middle(base_) - position;
        const double within = radius + ball.radius;
        if (dot(d, d) <= within * within) visit(ball.block);
      }
    }
  }
  [[nodiscard]] uint64_t bytes() const;

 private:
  /// Holds all of the block's points. From base_.
  struct Ball {
    float x = 0, y = 0, z = 0, radius = 0;
    uint32_t block = 0;
    [[nodiscard]] Vec3d middle(Vec3d base) const { return {base.x + x, base.y + y, base.z + z}; }
  };
  /// The nearest square: outermost ones for what lies outside.
  [[nodiscard]] std::pair<size_t, size_t> square(double x, double z) const {
    const auto along = [&](double at, size_t count) {
      return static_cast<size_t>(std::clamp(at / side_, 0.0, static_cast<double>(count - 1)));
    };
    return {along(x - origin_x_, squares_x_), along(z - origin_z_, squares_z_)};
  }

  Vec3d base_;  // Near the first block, for floats.
  double origin_x_ = 0, origin_z_ = 0, side_ = 1, largest_ = 0;
  size_t squares_x_ = 0, squares_z_ = 0;
  std::vector<uint32_t> first_;  // squares, row by row, and the end
  std::vector<Ball> balls_;      // by square
};

}  // namespace throng::path
