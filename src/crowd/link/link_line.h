// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/base.h"
#include "throng/world.h"

/// Bodies that move along straight lines in space, against obstacles and each other.
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
/// May two such cylinders touch each other, wherever each is on its line? True may be wrong where
/// both lines rise.
bool meets(const LinkLine& a, const LinkLine& b);

}  // namespace throng::crowd
