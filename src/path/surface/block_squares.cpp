// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/surface/block_squares.h"

#include <numeric>

#include "core/math/float_origin.h"
#include "world/zone_data.h"

// Balls around the blocks of Bezier patches, in a uniform grid of about one ball a square. The
// nearest point of a block is found by Gauss-Newton steps. Built in time linear in the blocks; the
// nearest point of a block takes kNewtonSteps at most.
namespace throng::path {
namespace {

constexpr int kNewtonSteps = 12;
constexpr double kEdgeStep = 1e-4;  // of a patch's parameters, for derivatives

// A patch's longest derivatives, by the hulls of its control points. [m]
std::pair<double, double> longest_derivatives(const graph::NodeSurface& surface) {
  const auto point = [&](size_t k) {
    return Vec3d{surface.points[3 * k], surface.points[3 * k + 1], surface.points[3 * k + 2]};
  };
  double s = 0, t = 0;
  for (size_t j = 0; j < 4; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      s = std::max(s, 3 * length(point(4 * j + i + 1) - point(4 * j + i)));
      t = std::max(t, 3 * length(point(4 * (i + 1) + j) - point(4 * i + j)));
    }
  }
  return {s, t};
}

}  // namespace

std::pair<double, double> nearest_in(const graph::NodeSurface& surface,
                                     const graph::NodeBlock& block, Vec3d position) {
  const double side = block.side(), s0 = block.s * side, t0 = block.t * side;
  if (surface.points == nullptr) {
    const Vec3d corner = surface.at(0, 0);
    const double tile = surface.world->summary.cell * kTileCells;
    const auto inside = [&](double at, double low) {
      return std::clamp(at, low + graph::kTileInset, low + side - graph::kTileInset);
    };
    return {inside((position.x - corner.x) / tile, s0), inside((position.z - corner.z) / tile, t0)};
  }
  double s = s0 + side / 2, t = t0 + side / 2;
  for (int k = 0; k < kNewtonSteps; ++k) {
    const Vec3d at = surface.at(s, t);
    const Vec3d ds =
        (surface.at(s + kEdgeStep, t) - surface.at(s - kEdgeStep, t)) * (0.5 / kEdgeStep);
    const Vec3d dt =
        (surface.at(s, t + kEdgeStep) - surface.at(s, t - kEdgeStep)) * (0.5 / kEdgeStep);
    const Vec3d left = position - at;
    const double a = dot(ds, ds), b = dot(ds, dt), c = dot(dt, dt);
    const double det = a * c - b * b;
    if (!(det > 1e-12 * a * c)) break;
    const double u = dot(left, ds), v = dot(left, dt);
    s = std::clamp(s + (c * u - b * v) / det, s0, s0 + side);
    t = std::clamp(t + (a * v - b * u) / det, t0, t0 + side);
  }
  return {s, t};
}

BlockSquares::BlockSquares(const graph::NodeMesh& mesh) {
  std::vector<Ball> balls;
  Box3d box;
  for (uint32_t p = 0; p < mesh.patches().size(); ++p) {
    const graph::NodeSurface& surface = mesh.patches()[p];
    if (surface.points == nullptr) continue;
    const auto [by_s, by_t] = longest_derivatives(surface);
    const auto blocks = mesh.blocks_of(p);
    for (uint32_t b = 0; b < blocks.size(); ++b) {
      const double side = blocks[b].side();
      const Vec3d at = surface.at((blocks[b].s + 0.5) * side, (blocks[b].t + 0.5) * side);
      if (balls.empty()) base_ = float_origin(at);
      const Vec3d off = at - base_;
      Ball ball{static_cast<float>(off.x), static_cast<float>(off.y), static_cast<float>(off.z), 0,
                mesh.first_block(p) + b};
      const Vec3d middle = ball.middle(base_);
      const double radius = (by_s + by_t) * side / 2 + length(at - middle);
      ball.radius = static_cast<float>(radius * (1 + 1e-6) + 1e-6);
      largest_ = std::max(largest_, double{ball.radius});
      box.add(middle);
      balls.push_back(ball);
    }
  }
  if (balls.empty()) return;
  // About a block a square, and no square much smaller than a ball.
  const double width = box.max.x - box.min.x, depth = box.max.z - box.min.z;
  side_ = std::max({1.0, largest_ / 2,
                    std::sqrt((width + 1) * (depth + 1) / static_cast<double>(balls.size()))});
  origin_x_ = box.min.x;
  origin_z_ = box.min.z;
  squares_x_ = static_cast<size_t>(width / side_) + 1;
  squares_z_ = static_cast<size_t>(depth / side_) + 1;
  const auto square_of = [&](const Ball& ball) {
    const Vec3d middle = ball.middle(base_);
    const auto [x, z] = square(middle.x, middle.z);
    return z * squares_x_ + x;
  };
  first_.assign(squares_x_ * squares_z_ + 1, 0);
  for (const Ball& ball : balls) ++first_[square_of(ball) + 1];
  std::inclusive_scan(first_.begin(), first_.end(), first_.begin());
  balls_.resize(balls.size());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Ball& ball : balls) balls_[next[square_of(ball)]++] = ball;
}

uint64_t BlockSquares::bytes() const {
  return first_.size() * sizeof(uint32_t) + balls_.size() * sizeof(Ball);
}

}  // namespace throng::path
