// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "throng/avatar.h"
#include "throng/base.h"
#include "verify/triangle_tree.h"

/// What the triangles say of one claimed place of one avatar class.
namespace throng::verify {

class BodyCheck {
 public:
  BodyCheck(const TriangleTree& tree, const AvatarClass& avatar, double cell);

  /// A triangle that meets the body from feet + body_bottom to feet + height, if any.
  [[nodiscard]] std::optional<uint32_t> intruder(Vec3d feet) const;

  /// Is there something to stand on: a surface within one cell of the centre, not steeper than the
  /// class allows and not blocked, within a step below the feet? It may lie above them by what the
  /// steepest slope rises over a cell, and 5 mm for rounding.
  [[nodiscard]] bool is_supported(Vec3d feet) const;

  /// Distance from the feet to the surface exactly under (or over) the centre that is nearest to
  /// them and within a step; nothing where the line meets none (a crack, a rim). [m]
  [[nodiscard]] std::optional<double> feet_error(Vec3d feet) const;

 private:
  const TriangleTree* tree_;
  double radius_, bottom_, height_, step_, cell_;
  double support_above_;  ///< [m]
  double levelness_;
};

/// Cosine of the steepest slope, less a rounding margin of 1e-5 for planes at exactly the limit.
[[nodiscard]] double levelness_limit(const AvatarClass& avatar);

}  // namespace throng::verify
