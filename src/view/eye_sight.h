// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "throng/base.h"
#include "throng/scene.h"

namespace throng::view {

/// The opaque triangles of a scene, relative to an origin.
struct Occluders {
  Vec3d origin;
  std::vector<std::array<float, 3>> corners;
  std::vector<std::array<uint32_t, 3>> triangles;
};

[[nodiscard]] std::shared_ptr<const Occluders> occluders_of(const Scene& scene, Vec3d origin);

/// Position and clipping of an eye. In the world's coordinates.
struct EyePlace {
  Vec3d eye;
  double nearest = 0.1;  ///< Near plane: what is nearer is not drawn. [m, > 0]
  double cut = 1e9;      ///< What lies above this height is not drawn. [m]
  friend bool operator==(const EyePlace& a, const EyePlace& b) {
    return a.eye == b.eye && a.nearest == b.nearest && a.cut == b.cut;
  }
};

/// Conservative visibility from an eye in all directions: six depth images around it, in which only
/// pixels count that surfaces cover completely. Some hidden boxes are reported as visible, but no
/// visible box as hidden. Copies share the triangles.
class EyeSight {
 public:
  explicit EyeSight(std::shared_ptr<const Occluders> occluders, int32_t pixels = 512);

  /// Triangles farther than `max_distance` along X and Z are skipped. Time: linear in triangles.
  void look_from(const EyePlace& place, double max_distance);
  /// Can anything inside a box be visible? In the world's coordinates.
  [[nodiscard]] bool sees(const Box3d& box) const;

 private:
  struct Face;
  struct Line;
  // Two triangles (u, v, a) and (u, v, b) that share a side.
  struct Seam {
    uint32_t u = 0, v = 0, a = 0, b = 0;
  };
  void draw_triangle(const Face& face, const std::array<Vec3d, 3>& corners);
  void draw_seam(const Face& face, const std::array<Vec3d, 4>& corners);
  template <size_t kLines, size_t kPlanes>
  void fill(const Face& face, const std::array<Line, kLines>& lines,
            const std::array<Vec3d, kPlanes>& planes, double low, double high);

  // Triangles over welded corners: one index per position.
  struct Shape {
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<Seam> seams;
  };

  std::shared_ptr<const Occluders> occluders_;
  std::shared_ptr<const Shape> shape_;
  int32_t pixels_;
  EyePlace place_;
  std::vector<float> nearness_;  // 1 / largest depth in a pixel, 0: open. Six faces.
};

}  // namespace throng::view
