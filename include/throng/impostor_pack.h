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

/// Packs arrays of avatars into instances that a graphics card draws: culls avatars and chooses
/// their views. Runs on the processor; the same bytes for any number of threads.
namespace throng {

/// An eye that looks at a point. Y is up.
struct EyeCamera {
  Vec3d eye{0, 1.7, 5};
  Vec3d target{0, 1, 0};
  double field_of_view = 0.8;  ///< Top to bottom. [rad, > 0, < 3]
  double aspect = 16.0 / 9;    ///< Width by height. [> 0]
  double nearest = 0.2;        ///< Nearer things are not drawn. [m, > 0]
  double furthest = 10000;     ///< Farther things are not drawn. [m, > nearest]
};

/// Borrowed arrays, one entry per avatar. Positions are relative to a point of the caller's, near
/// enough for floats (a kilometre to 0.06 mm).
struct ImpostorArrays {
  std::span<const float> x, y, z;     ///< Feet. [m]
  std::span<const uint16_t> heading;  ///< From +Z towards +X. [65536 a turn]
  std::span<const uint16_t> phase;    ///< Of the clip's cycle, see walk_phase. [65536 a cycle]
  std::span<const uint16_t> look;  ///< Appearance: any number, which selects the outfit. [< 2048]
};

/// An avatar for the card, 16 bytes. `view`: AtlasShape::view in bits 0 to 19, mirrored in bit 20,
/// look in bits 21 to 31. For a mesh: heading in bits 0 to 10 [2048 a turn], phase in bits 11 to 20
/// [1024 a cycle], look as before.
struct ImpostorInstance {
  float x = 0, y = 0, z = 0;
  uint32_t view = 0;
};

/// An avatar for the card, 32 bytes, seen from between two directions or elevations and blended
/// from the four views around. `nearest_below` is that of the lower column and row, `others` those
/// of the next column, the next row and both, as ImpostorInstance::view without a look. `shares`:
/// of the next column in bits 0 to 8, of the next row in bits 9 to 17 [256: all].
struct BlendedInstance {
  ImpostorInstance nearest_below;
  std::array<uint32_t, 3> others{};
  uint32_t shares = 0;
};

/// Settings for pack_impostors and pack_levels.
struct PackConfig {
  EyeCamera camera;  ///< Relative to the same point as the arrays.
  size_t clip = 0;   ///< Index into Atlas::clips.
  /// If set, all are seen from this direction, as by the sun, and not from the eye. It points away
  /// from the avatars.
  std::optional<Vec3d> from_direction;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// Packs the avatars whose bounding ball, of half a view's side, may be in the camera's picture, in
/// order of index, and returns their number. Linear time. All spans of `avatars` must have one
/// length, at most 2^31 - 1, and `out` at least that.
THRONG_API size_t pack_impostors(const Atlas& atlas, const ImpostorArrays& avatars,
                                 const PackConfig& config, std::span<ImpostorInstance> out);

/// Distances from the eye at which an avatar is drawn as mesh, view or point. Where two ranges
/// overlap it is drawn as both, and they fade into each other. [m, 0 <= mesh_near <= mesh_far <=
/// point_near <= point_far]
struct LevelDistances {
  double mesh_near = 0, mesh_far = 0;  ///< Meshes end at `mesh_far`, views begin at `mesh_near`.
  /// Points begin at `point_near`, views end at `point_far`.
  double point_near = 1e18, point_far = 1e18;
  /// Nearer than this, a view fades into the next one as the eye moves around the avatar: over
  /// `blend_share` of the angle between two views [0 to 1; 0: never], and less in the last fifth of
  /// the distance.
  double blend_far = 0;
  double blend_share = 0;
};

/// Distances by the size of a texel in the picture: meshes where it is `mesh_texel` pixels or more,
/// points where a view's side is `point_pixels` pixels or less; each fades over a fifth of the
/// distance. 0: none. Views blend up to where a view's side is 24 pixels: beyond, the change from
/// one view to the next moves an arm by less than a pixel. `blend_share` stays 0. `height` is the
/// picture's. [px]
[[nodiscard]] THRONG_API LevelDistances level_distances(const AtlasShape& shape,
                                                        const EyeCamera& camera, double height,
                                                        double mesh_texel, double point_pixels);

/// Output of pack_levels: spans as long as the avatars. The spans of a level that cannot occur may
/// be empty.
struct LevelSpans {
  std::span<ImpostorInstance> meshes, views, points;
  std::span<BlendedInstance> blends = {};
};
/// Numbers of instances that pack_levels wrote.
struct LevelCounts {
  size_t meshes = 0, views = 0, points = 0, blends = 0;
};
/// Packs avatars as pack_impostors does, each for the level of its distance. Points use only place
/// and look.
THRONG_API LevelCounts pack_levels(const Atlas& atlas, const ImpostorArrays& avatars,
                                   const PackConfig& config, const LevelDistances& levels,
                                   const LevelSpans& out);

/// The axes of a camera: unit vectors.
struct CameraAxes {
  Vec3d right, up, forward;
};
/// The axes of a camera.
[[nodiscard]] THRONG_API CameraAxes camera_axes(const EyeCamera& camera);

}  // namespace throng
