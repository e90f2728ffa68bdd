// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "throng/impostor.h"

/// Bodies from rings: a limb is a tube through ellipses that lie flat.
namespace throng::impostor {

/// An ellipse around `centre` that follows `bone`, and `other` by `share`.
struct BodyRing {
  Vec3d centre;
  double wide = 0, deep = 0;  ///< Half axes along x and z.
  uint8_t bone = 0;
  uint8_t other = 0;
  double share = 0;
};

/// Adds a closed tube through the rings, from below to above, with smooth normals.
void add_tube(Character& character, const std::vector<BodyRing>& rings, uint8_t material);

}  // namespace throng::impostor
