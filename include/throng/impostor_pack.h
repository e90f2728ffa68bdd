// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "throng/base.h"
#include "throng/impostor.h"
#include "throng/math.h"

/// From arrays of avatars to what a graphics card draws: who is seen, and by which view. Processor
/// only; the same bytes for any number of threads.
namespace throng {

/// An eye that looks at a point. Y is up.
struct EyeCamera {
  Vec3d eye{0, 1.7, 5};
  Vec3d target{0, 1, 0};
  double field_of_view = 0.8;  ///< Top to bottom. [rad, > 0, < 3]
  double aspect = 16.0 / 9;    ///< Width by height. [> 0]
  double nearest = 0.2;        ///< What is nearer is not seen. [m, > 0]
  double furthest = 10000;     ///< What is further is not seen. [m, > nearest]
};

/// Borrowed arrays, one entry an avatar, positions relative to a point of the caller's: near enough
/// that a float holds them (a kilometre to 0.06 mm).
struct ImpostorArrays {
  std::span<const float> x, y, z;     ///< Where the feet are. [m]
  std::span<const uint16_t> heading;  ///< From +Z towards +X. [65536 a turn]
  std::span<const uint16_t> phase;    ///< Of the clip's cycle, see walk_phase. [65536 a cycle]
  std::span<const uint16_t> look;     ///< Any number: which clothes to wear. [< 2048]
};

/// Sixteen bytes for the card. `view`: AtlasShape::view in bits 0 to 19, mirrored in bit 20, look
/// in bits 21 to 31. Of a mesh: heading in bits 0 to 10 [2048 a turn], phase in bits 11 to 20 [1024
/// a cycle], look as before.
struct ImpostorInstance {
  float x = 0, y = 0, z = 0;
  uint32_t view = 0;
};

/// Thirty-two bytes for the card: an avatar seen from between two directions or elevations, by the
/// four views around. `nearest_below` is that of the lower column and row, `others` those of the
/// next column, the next row and both, as ImpostorInstance::view without a look. `shares`: of the
/// next column in bits 0 to 8, of the next row in bits 9 to 17 [256: all].
struct BlendedInstance {
  ImpostorInstance nearest_below;
  std::array<uint32_t, 3> others{};
  uint32_t shares = 0;
};

struct PackConfig {
  EyeCamera camera;  ///< Relative to the same point as the arrays.
  size_t clip = 0;   ///< Index into Atlas::clips.
  /// All are seen from this direction, as by the sun; not from the eye. Points away from them.
  std::optional<Vec3d> from_direction;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// Writes the avatars whose ball of half a view's side, as seen by the camera, may be in the
/// picture, in order of index, and returns how many. Linear time. All spans of `avatars` must have
/// one length, at most 2^31 - 1, and `out` no less.
THRONG_API size_t pack_impostors(const Atlas& atlas, const ImpostorArrays& avatars,
                                 const PackConfig& config, std::span<ImpostorInstance> out);

/// How far from the eye an avatar is drawn as what. Where two ranges overlap it is drawn as both,
/// and they fade into each other. [m, 0 <= mesh_near <= mesh_far <= point_near <= point_far]
struct LevelDistances {
  double mesh_near = 0, mesh_far = 0;  ///< Meshes end at `mesh_far`, views begin at `mesh_near`.
  double point_near = 1e18, point_far = 1e18;  ///< Points begin at `near`, views end at `far`.
  /// Nearer than this, a view fades into the next one as the eye goes around: over `blend_share` of
  /// the angle between two views [0 to 1; 0: never], and less in the last fifth of the distance.
  double blend_far = 0;
  double blend_share = 0;
};

/// By how large a texel is in the picture: meshes where it is `mesh_texel` pixels or more, points
/// where a view's side is `point_pixels` pixels or less; each fades over a fifth of the distance.
/// 0: none. Views blend up to where a view's side is 24 pixels: beyond, the step from one to the
/// next moves an arm by less than a pixel. `blend_share` is left 0. `height` is the picture's. [px]
[[nodiscard]] THRONG_API LevelDistances level_distances(const AtlasShape& shape,
                                                        const EyeCamera& camera, double height,
                                                        double mesh_texel, double point_pixels);

/// Spans to write to, each as long as the avatars, those of a level that cannot be may be empty.
struct LevelSpans {
  std::span<ImpostorInstance> meshes, views, points;
  std::span<BlendedInstance> blends = {};
};
struct LevelCounts {
  size_t meshes = 0, views = 0, points = 0, blends = 0;
};
/// As pack_impostors, each avatar as what its distance says. Of points only place and look count.
THRONG_API LevelCounts pack_levels(const Atlas& atlas, const ImpostorArrays& avatars,
                                   const PackConfig& config, const LevelDistances& levels,
                                   const LevelSpans& out);

/// The axes of a camera: unit vectors.
struct CameraAxes {
  Vec3d right, up, forward;
};
[[nodiscard]] THRONG_API CameraAxes camera_axes(const EyeCamera& camera);

}  // namespace throng
