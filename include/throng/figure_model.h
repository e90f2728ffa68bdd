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

/// A figure as an animated mesh, for avatars near the eye: the poses of its clips, ready for a
/// graphics card. Far avatars are drawn from an Atlas.
namespace throng {

/// A vertex of one pose. Positions are 65535ths of FigureModel::low to high.
struct PosedVertex {
  uint16_t x = 0, y = 0, z = 0;
  /// The unit normal on an octahedron folded flat: u in the low byte, v in the high, 128 is 0.
  uint16_t normal = 0;
  friend bool operator==(const PosedVertex&, const PosedVertex&) = default;
};

/// The colour of a vertex in all poses: albedo as Atlas keeps colours, and the BodyPart.
struct ModelPaint {
  std::array<uint8_t, 3> colour{};
  uint8_t part = 0;
  friend bool operator==(const ModelPaint&, const ModelPaint&) = default;
};

/// An animated mesh: triangles over vertices that have a position in each pose.
struct FigureModel {
  std::vector<AtlasClip> clips;  ///< As those of an atlas with the same settings.
  uint32_t vertices = 0;
  std::vector<PosedVertex> poses;  ///< Vertex v of frame f is poses[f * vertices + v].
  std::vector<ModelPaint> paint;   ///< One per vertex.
  std::vector<std::array<uint32_t, 3>> triangles;
  Vec3d low, high;  ///< Bounds of all poses; feet at 0, facing +Z. [m]
};

/// Poses a character as build_atlas does; uses only `clips`, `frames` and `height` of the settings.
/// Linear in frames and triangles. Fails as build_atlas does, and with kLimit: more than 4 million
/// vertices in all poses.
[[nodiscard]] THRONG_API Result<FigureModel> build_figure_model(const Character& character,
                                                                const AtlasConfig& config,
                                                                Context& context);

}  // namespace throng
