// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "impostor/pack_loops.h"
#include "throng/impostor.h"

/// Transitions between views without a step: near the border of two columns or rows an avatar is
/// shown by both, with shares that change as the eye crosses the border.
namespace throng::impostor {

struct BlendShape {
  float share = 0;  ///< Of the angle between two views, over which they blend. [> 0, <= 1]
  float far = 0;    ///< Distance at which it ends; over the last fifth `share` falls to 0. [m]
};

/// Writes the avatars of a block with `kSeenBetween` that are near a border, and returns their
/// number; the others become `kSeenByView`.
size_t write_blends(const PackShared& shared, const BlendShape& shape, const PackInput& input,
                    PackBlock& block, BlendedInstance* out);

}  // namespace throng::impostor
