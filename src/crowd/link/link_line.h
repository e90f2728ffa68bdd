// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/base.h"
#include "throng/world.h"

/// A body that moves along a straight line in space, against obstacles.
namespace throng::crowd {

/// An upright cylinder whose feet move from one point to another.
struct LinkLine {
  Vec3d from, to;     // [m]
  double radius = 0;  // [m]
  double bottom = 0;  // above the feet, from which it counts [m]
  double top = 0;     // above the feet [m]
};

/// Does the cylinder touch the prism anywhere on its line?
bool meets(const LinkLine& line, const Prism& prism);

}  // namespace throng::crowd
