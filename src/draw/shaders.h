// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

/// The shaders: OpenGL ES 3.0, which is WebGL 2. Colours are linear until the last line.
namespace throng::draw::shaders {

/// Of avatars: all upright, or each with an axis of its own.
enum class Leaning : uint8_t { kNo, kYes };

std::string sky_vertex();
std::string sky_fragment();
std::string scene_vertex();
std::string scene_fragment();
std::string surface_vertex();  ///< Of a scene that has materials.
std::string surface_fragment();
std::string depth_vertex();  ///< Of the scene, as the sun sees it.
std::string depth_fragment();
std::string surface_depth_vertex();  ///< The same where light comes through surfaces.
std::string surface_depth_fragment();
std::string furthest_vertex();  ///< The furthest depth of each block of 8 x 8.
std::string furthest_fragment();
std::string impostor_vertex(Leaning leaning = Leaning::kNo);
std::string impostor_fragment();
std::string blended_vertex();  ///< Of impostors between two directions or elevations.
std::string blended_fragment();
std::string model_vertex(Leaning leaning = Leaning::kNo);  ///< Of avatars near the eye: meshes.
std::string model_fragment();
std::string point_vertex();  ///< Of avatars that are too small for a view.
std::string point_fragment();
std::string plain_vertex();  ///< Of plain quads, for comparison.
std::string plain_fragment();
std::string shadow_vertex(Leaning leaning = Leaning::kNo);  ///< Of impostors, as the sun sees them.
std::string shadow_fragment();
std::string mark_vertex();  ///< Of overlays: coloured triangles and lines.
std::string mark_fragment();
std::string panel_vertex();
std::string panel_fragment();

}  // namespace throng::draw::shaders
