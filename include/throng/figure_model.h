// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "throng/base.h"
#include "throng/character.h"
#include "throng/context.h"
#include "throng/impostor.h"
#include "throng/result.h"

/// A figure as a mesh that moves, for who is near the eye: the poses of its clips, ready for a
/// graphics card. What an Atlas is from afar.
namespace throng {

/// A vertex of one pose. Positions are 65535ths of FigureModel::low to high.
struct PosedVertex {
  uint16_t x = 0, y = 0, z = 0;
  /// Of the unit normal, on an octahedron folded flat: u in the low byte, v in the high, 128 is 0.
  uint16_t normal = 0;
  friend bool operator==(const PosedVertex&, const PosedVertex&) = default;
};

/// A vertex in all poses: its albedo as Atlas keeps colours, and its BodyPart.
struct ModelPaint {
  std::array<uint8_t, 3> colour{};
  uint8_t part = 0;
  friend bool operator==(const ModelPaint&, const ModelPaint&) = default;
};

struct FigureModel {
  std::vector<AtlasClip> clips;  ///< As those of the atlas made with the same settings.
  uint32_t vertices = 0;
  std::vector<PosedVertex> poses;  ///< Of frame f, vertex v: poses[f * vertices + v].
  std::vector<ModelPaint> paint;   ///< One a vertex.
  std::vector<std::array<uint32_t, 3>> triangles;
  Vec3d low, high;  ///< Around all poses; feet at 0, facing +Z. [m]
};

/// Poses a character as build_atlas does: `clips`, `frames` and `height` count, the rest does not.
/// Linear in frames and triangles. Fails as build_atlas does, and with kLimit: more than 4 million
/// vertices in all poses.
[[nodiscard]] THRONG_API Result<FigureModel> build_figure_model(const Character& character,
                                                                const AtlasConfig& config,
                                                                Context& context);

}  // namespace throng
