// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "throng/base.h"
#include "throng/impostor.h"

namespace throng::impostor {

/// Fails with kBadConfig.
[[nodiscard]] Result<void> check_atlas_config(const AtlasConfig& config);

/// All frames of all clips, on the spot, feet at 0, in metres.
struct FigureFrames {
  std::vector<PosedMesh> frames;
  std::vector<AtlasClip> clips;
  size_t body_vertices = 0;       ///< The first ones of each frame; the others are worn.
  double height = 0, radius = 0;  ///< Radius of a ball around (0, height / 2, 0) that holds all.
};

/// Fails with kNotFound (a clip), kBadInput (a character without height).
[[nodiscard]] Result<FigureFrames> pose_frames(const Character& character,
                                               const AtlasConfig& config);

}  // namespace throng::impostor
