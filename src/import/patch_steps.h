// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "throng/patch.h"

/// How finely a patch must be cut.
namespace throng {

/// A patch is cut into 2^s steps along s and 2^t along t.
struct Halvings {
  int32_t s = 0;
  int32_t t = 0;
  friend bool operator==(Halvings, Halvings) = default;
};

inline constexpr int32_t kMostHalvings = 7;

/// The coarsest steps, found one halving at a time, whose triangles are nowhere farther than
/// `tolerance` from the surface; or the finest allowed.
[[nodiscard]] Halvings steps_within(const BezierPatch& patch, double tolerance);

}  // namespace throng
