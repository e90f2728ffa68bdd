// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "throng/impostor.h"
#include "throng_draw/draw.h"

/// Avatars whose axes are not upright, in the form that a card reads. They are few, so a serial
/// loop is fast enough.
namespace throng::draw {

/// Thirty-two bytes for the card: an instance and its axis.
struct LeaningInstance {
  ImpostorInstance body;  ///< Its view is that of a figure that leans with the eye around it.
  float up_x = 0, up_y = 1, up_z = 0;
  uint32_t unused = 0;
};

/// Output arrays, each as long as the avatars; meshes may be empty if there are none.
struct LeaningSpans {
  std::span<LeaningInstance> meshes, views;
};

/// As pack_levels, but without points and blends. [crowd: one axis an avatar]
LevelCounts pack_leaning(const Atlas& atlas, const DrawnCrowd& crowd, const PackConfig& config,
                         const LevelDistances& levels, const LeaningSpans& out);

}  // namespace throng::draw
