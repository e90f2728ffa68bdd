// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "impostor/pack_loops.h"
#include "throng/impostor_pack.h"

/// From one view to the next without a step: near a border of two columns or rows an avatar is
/// shown by both, with shares that grow as the eye goes over.
namespace throng {

struct BlendShape {
  float share = 0;  ///< Of the angle between two views, over which they blend. [> 0, <= 1]
  float far = 0;    ///< Where it ends; over the last fifth `share` shrinks to nothing. [m]
};

/// Writes those of a block's `kSeenBetween` that are near a border, and returns how many; the
/// others become `kSeenByView`.
size_t write_blends(const PackShared& shared, const BlendShape& shape, const PackInput& input,
                    PackBlock& block, BlendedInstance* out);

}  // namespace throng
