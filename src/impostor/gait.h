// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "throng/base.h"
#include "throng/impostor.h"

/// How a clip moves its figure.
namespace throng::impostor {

/// A clip's frame of reference: what is subtracted from a vertex so that the figure walks on the
/// spot, over the origin.
struct ClipPlace {
  Vec3d middle;  ///< Mean of all vertices, at height 0, when the cycle begins.
  Vec3d drift;   ///< How far it moves in one cycle, at height 0.
};

[[nodiscard]] ClipPlace place_of_clip(const Character& character, size_t clip);

/// How far a figure walks towards +Z in one cycle if its feet do not skate, in the character's own
/// units; 0 for a clip that stands.
[[nodiscard]] double stride_of_clip(const Character& character, size_t clip,
                                    const ClipPlace& place);

/// The vertex positions of a moment, on the spot.
void pose_in_place(const Character& character, size_t clip, const ClipPlace& place, double share,
                   PosedMesh& out);

}  // namespace throng::impostor
