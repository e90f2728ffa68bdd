// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/scene_chunks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

// Sorts triangles into chunks, and culls chunks by the view frustum and by a depth pyramid.
namespace throng::draw {
namespace {

constexpr double kPerChunk = 500;  // Triangles.
// The card computes in floats: what lies outside by less than this share may still be drawn.
constexpr double kClipTolerance = 1e-4;

using Corner = std::array<double, 4>;

Corner clip_of(const Matrix& m, double x, double y, double z) {
  Corner out{};
  for (size_t r = 0; r < 4; ++r) out[r] = m[r] * x + m[r + 4] * y + m[r + 8] * z + m[r + 12];
  return out;
}

std::array<Corner, 8> corners_of(const Matrix& m, const Box3d& box) {
  std::array<Corner, 8> out{};
  for (size_t k = 0; k < 8; ++k) {
    out[k] = clip_of(m, (k & 1) != 0 ? box.max.x : box.min.x, (k & 2) != 0 ? box.max.y : box.min.y,
                     (k & 4) != 0 ? box.max.z : box.min.z);
  }
  return out;
}

// Are all corners on the outer side of one of the six planes?
bool is_outside(const std::array<Corner, 8>& corners) {
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const bool out = std::all_of(corners.begin(), corners.end(), [&](const Corner& c) {
        return sign * c[axis] > c[3] + kClipTolerance * (1 + std::fabs(c[3]));
      });
      if (out) return true;
    }
  }
  return false;
}

bool is_hidden(const std::array<Corner, 8>& corners, const DepthPyramid& depths) {
  constexpr double kUnset = std::numeric_limits<double>::max();
  NdcBox box{kUnset, -kUnset, kUnset, -kUnset, kUnset};
  for (const Corner& c : corners) {
    if (c[3] <= 0 || c[2] <= -c[3]) return false;  // It reaches behind the near plane.
    const double x = c[0] / c[3], y = c[1] / c[3];
    box.left = std::min(box.left, x), box.right = std::max(box.right, x);
    box.low = std::min(box.low, y), box.high = std::max(box.high, y);
    box.nearest = std::min(box.nearest, c[2] / c[3]);
  }
  return depths.hides(box);
}

double distance_to(const Box3d& box, Vec3d p) {
  const auto beyond = [](double v, double low, double high) {
    return std::max({low - v, v - high, 0.0});
  };
  return std::hypot(beyond(p.x, box.min.x, box.max.x), beyond(p.y, box.min.y, box.max.y),
                    beyond(p.z, box.min.z, box.max.z));
}

}  // namespace

void sort_into_chunks(SceneCorners& scene) {
  const size_t triangles = scene.corners.size() / 3;
  scene.chunks.clear();
  if (triangles == 0) return;
  const Vec3d size = scene.bounds.max - scene.bounds.min;
  // As if triangles lay evenly over the plan, and storeys were as far apart as cells are wide.
  const double side = std::max({4.0,
                                std::sqrt(std::max(size.x, 1.0) * std::max(size.z, 1.0) *
                                          kPerChunk / static_cast<double>(triangles)),
                                std::max({size.x, size.y, size.z}) / 1000});
  std::vector<std::pair<uint32_t, uint32_t>> order(triangles);  // Cell, triangle.
  for (size_t t = 0; t < triangles; ++t) {
    Box3d box;
    for (size_t k = 0; k < 3; ++k) {
      const auto& p = scene.corners[3 * t + k].position;
      box.add({p[0], p[1], p[2]});
    }
    const Vec3d middle = (box.min + box.max) * 0.5, size_of = box.max - box.min;
    // Large ones by themselves, or they would make the boxes of all others large.
    const bool large = std::max({size_of.x, size_of.y, size_of.z}) > side;
    const auto cell = [&](double v, double low) {
      return static_cast<uint32_t>(std::clamp((v - low) / side, 0.0, 1023.0));
    };
    order[t] = {static_cast<uint32_t>(large) << 30 | cell(middle.y, scene.bounds.min.y) << 20 |
                    cell(middle.z, scene.bounds.min.z) << 10 | cell(middle.x, scene.bounds.min.x),
                static_cast<uint32_t>(t)};
  }
  std::sort(order.begin(), order.end());
  std::vector<SceneCorner> sorted;
  sorted.reserve(scene.corners.size() + 3);
  std::vector<SurfaceCorner> surfaces;
  if (!scene.surfaces.empty()) surfaces.reserve(scene.surfaces.size() + 3);
  for (size_t i = 0; i < triangles; ++i) {
    const SceneChunk* last = scene.chunks.empty() ? nullptr : &scene.chunks.back();
    if (last == nullptr || order[i].first != order[i - 1].first) {
      scene.chunks.push_back({.box = {}, .first = static_cast<uint32_t>(3 * i), .count = 0});
    }
    SceneChunk& chunk = scene.chunks.back();
    chunk.count += 3;
    for (size_t k = 0; k < 3; ++k) {
      const SceneCorner& corner = scene.corners[size_t{3} * order[i].second + k];
      sorted.push_back(corner);
      chunk.box.add({corner.position[0], corner.position[1], corner.position[2]});
    }
    if (scene.surfaces.empty()) continue;
    const auto from = scene.surfaces.begin() + std::ptrdiff_t{3} * order[i].second;
    surfaces.insert(surfaces.end(), from, from + 3);
  }
  scene.corners = std::move(sorted);
  scene.surfaces = std::move(surfaces);
}

std::vector<uint32_t> chunks_in_view(std::span<const SceneChunk> chunks,
                                     const Matrix& clip_from_world, Vec3d eye) {
  std::vector<std::pair<double, uint32_t>> seen;
  for (size_t i = 0; i < chunks.size(); ++i) {
    if (is_outside(corners_of(clip_from_world, chunks[i].box))) continue;
    seen.emplace_back(distance_to(chunks[i].box, eye), static_cast<uint32_t>(i));
  }
  std::sort(seen.begin(), seen.end());
  std::vector<uint32_t> out(seen.size());
  std::transform(seen.begin(), seen.end(), out.begin(), [](const auto& s) { return s.second; });
  return out;
}

void drop_hidden_chunks(std::span<const SceneChunk> chunks, const Matrix& clip_from_world,
                        const DepthPyramid& depths, std::vector<uint32_t>& indices) {
  std::erase_if(indices, [&](uint32_t i) {
    return is_hidden(corners_of(clip_from_world, chunks[i].box), depths);
  });
}

}  // namespace throng::draw
