// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "throng/base.h"
#include "throng/impostor.h"

/// One view of a figure, rasterised in software: the same texels on every machine, no driver.
namespace throng::impostor {

/// The camera of a view: parallel rays along -`towards`, onto a square around `centre`.
struct FigureCamera {
  Vec3d right, up, towards;  ///< Unit vectors; `towards` points from the figure to the eye.
  Vec3d centre;
  double side = 0;  ///< Of the square. [m]
};

/// The camera of a column and row. Source: [TC00] 2; sampled at half steps, so that mirroring gives
/// exactly twice the directions.
[[nodiscard]] FigureCamera figure_camera(int32_t column, int32_t directions, int32_t row,
                                         int32_t elevations);

/// A square of texels, rows from the top.
struct FigureView {
  int32_t pixels = 0;
  std::vector<std::array<uint8_t, 4>> colour;
  std::vector<std::array<uint8_t, 2>> normal;
  std::vector<uint8_t> mask;
};

/// Draws views one after the other, in memory that it keeps.
class FigureRaster {
 public:
  FigureRaster(const Character& character, int32_t pixels);
  /// Draws the body. `positions` and `normals` have one entry for each vertex of the character.
  void draw(const PosedMesh& mesh, const FigureCamera& camera, FigureView& out);
  /// Draws what is not behind the body of a part that it wears. After draw() with the same mesh and
  /// camera.
  void draw_worn(const WornPart& part, const PosedMesh& mesh, const FigureCamera& camera,
                 FigureView& out);

 private:
  struct Sample {
    double depth = 0;
    uint32_t triangle = 0;
    float u = 0, v = 0;  // Weights of the second and third corner.
  };
  void draw_triangles(size_t first, size_t count);
  void draw_triangle(uint32_t index, const std::array<Vec3d, 3>& corners);
  void resolve(const PosedMesh& mesh, const FigureCamera& camera, size_t first,
               FigureView& out) const;

  const Character& character_;
  int32_t pixels_ = 0, samples_ = 0;  // Along a side.
  std::vector<Sample> grid_, body_;
  std::vector<Vec3d> projected_;
};

}  // namespace throng::impostor
