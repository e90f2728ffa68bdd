// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/scene.h"

/// How far a patch's own triangles may come up towards bodies that stand on it.
namespace throng::bake {

/// A part of a Bezier patch around some of its cells. A body that stands on it need not be tested
/// against the triangles of the same part if these rise by less than its bottom.
class SelfSupport {
 public:
  /// The part that covers `cells`, and as much beside it as most bodies reach.
  SelfSupport(const BezierPatch& whole, const PatchPart& cells);

  /// Does a triangle of the patch that covers `part` belong to it?
  [[nodiscard]] bool holds(const PatchPart& part) const {
    return part.s0 >= part_.s0 && part.s1 <= part_.s1 && part.t0 >= part_.t0 && part.t1 <= part_.t1;
  }

  /// At most how far a triangle whose parameters span so many 256ths is from the surface at equal
  /// parameters, if its corners are on it. [m]
  [[nodiscard]] double deviation(int32_t span_s, int32_t span_t) const;

  /// At most how high above feet on the part its triangles come within `radius` of an axis through
  /// the feet, if they are nowhere farther than `deviation` from the surface at equal parameters;
  /// infinite if nothing is known. The axis is upright, or the surface's normal at the feet. [m]
  [[nodiscard]] double rise(bool upright, double radius, double deviation) const;

 private:
  void bound_slopes(const BezierPatch& piece);

  PatchPart part_;
  double upright_slope_, along_slope_;  // Tangents; infinite.
  double ss_ = 0, st_ = 0, tt_ = 0;     // Second derivatives by 256ths, at most. [m]
};

}  // namespace throng::bake
