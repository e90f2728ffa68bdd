// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "throng/math.h"
#include "throng/scene.h"

namespace throng {

/// What hides: the triangles that are drawn, relative to an origin.
struct Occluders {
  Vec3d origin;
  std::vector<std::array<float, 3>> corners;
  std::vector<std::array<uint32_t, 3>> triangles;
};

[[nodiscard]] std::shared_ptr<const Occluders> occluders_of(const Scene& scene, Vec3d origin);

/// From where one looks. In the world's coordinates.
struct EyePlace {
  Vec3d eye;
  double nearest = 0.1;  ///< Nothing is drawn that is nearer. [m, > 0]
  double cut = 1e9;      ///< Nor what reaches above this height. [m]
  friend bool operator==(const EyePlace& a, const EyePlace& b) {
    return a.eye == b.eye && a.nearest == b.nearest && a.cut == b.cut;
  }
};

/// Tells what an eye cannot see wherever it turns: six pictures of depth around it, of pixels that
/// surfaces cover whole. Says yes of some that is hidden, never no of what can be seen. Copies
/// share what is the same for all eyes.
class EyeSight {
 public:
  explicit EyeSight(std::shared_ptr<const Occluders> occluders, int32_t pixels = 512);

  /// What is farther than `reach` along X and Z need not be told. Time: the triangles.
  void look_from(const EyePlace& place, double reach);
  /// Whether something inside a box may be seen. In the world's coordinates.
  [[nodiscard]] bool sees(const Box3d& box) const;

 private:
  struct Face;
  struct Line;
  // Two triangles of one side (u, v), as corners: of the whole, of what is left.
  struct Seam {
    uint32_t u = 0, v = 0, a = 0, b = 0;
  };
  void draw_triangle(const Face& face, const std::array<Vec3d, 3>& corners);
  void draw_seam(const Face& face, const std::array<Vec3d, 4>& corners);
  template <size_t kLines, size_t kPlanes>
  void fill(const Face& face, const std::array<Line, kLines>& lines,
            const std::array<Vec3d, kPlanes>& planes, double low, double high);

  // Triangles by corners that are one where places are.
  struct Shape {
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<Seam> seams;
  };

  std::shared_ptr<const Occluders> occluders_;
  std::shared_ptr<const Shape> shape_;
  int32_t pixels_;
  EyePlace place_;
  std::vector<float> nearness_;  // One by the largest depth in a pixel, 0: open. Six faces.
};

}  // namespace throng
