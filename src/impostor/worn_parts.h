// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/base.h"
#include "throng/impostor.h"

/// What avatars wear over one body.
namespace throng::impostor {

/// The character without its worn parts.
[[nodiscard]] Character body_of(const Character& character);

/// Does a part keep its shape as its avatar walks? Then one frame of each clip is drawn, and the
/// others move it: hair, hats and bags, but not a coat or a skirt.
[[nodiscard]] bool is_rigid(WornKind kind);

/// How far a part is moved between two poses, in the mean of its corners. [m]
[[nodiscard]] Vec3d movement_of(const Character& character, const WornPart& part,
                                const PosedMesh& from, const PosedMesh& to);

/// Fails with kBadInput if the ranges of worn parts do not follow one another behind the body to
/// the last triangle, or share vertices with it, or are too many.
[[nodiscard]] Result<void> check_worn(const Character& character);

}  // namespace throng::impostor
