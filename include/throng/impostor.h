// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/character.h"
#include "throng/context.h"
#include "throng/math.h"
#include "throng/picture.h"
#include "throng/result.h"

/// Impostors: pictures of a walking figure from many directions, drawn as one rectangle per avatar.
/// Source: [TC00] 2 and 4. Angles are in turns from +Z towards +X: 0.25 faces +X.
namespace throng {

/// The texel format of an atlas. Normals and masks are stored beside the colours.
enum class AtlasFormat : uint8_t {
  kRgba8,   ///< 32 bits a texel; normals 16 bits.
  kRgb5a1,  ///< 16 bits, one of them alpha, as in [TC00]; normals 16 bits.
  kBc1,     ///< 4 bits (S3TC DXT1), alpha is 0 or 1; normals BC5, 8 bits.
  kBc3,     ///< 8 bits (S3TC DXT5); normals BC5, 8 bits.
  kEtc2a1,  ///< 4 bits (ETC2, punch-through alpha), alpha is 0 or 1; normals EAC RG11, 8 bits.
  kEtc2,    ///< 8 bits (ETC2 with EAC alpha); normals EAC RG11, 8 bits.
};
/// Number of AtlasFormat values.
inline constexpr int32_t kAtlasFormats = 6;
/// The name of a format: "rgba8", "rgb5a1", "bc1", "bc3", "etc2a1", "etc2".
[[nodiscard]] THRONG_API const char* word_for(AtlasFormat format);

/// Settings for build_atlas.
struct AtlasConfig {
  std::vector<std::string> clips{"Walk"};  ///< See find_clip. [1 to 16]
  int32_t frames = 10;                     ///< Of each clip. [1, or even and up to 64]
  int32_t directions = 16;                 ///< Over half a turn; mirrored to twice as many. [2-64]
  int32_t elevations = 8;                  ///< From the horizon to straight above. [1 to 32]
  int32_t pixels = 64;                     ///< Side of a view. [8 to 256]
  double height = 1.75;  ///< Height that the figure is scaled to. [m, > 0; 0: as in the file]
  int32_t workers = 0;   ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// A clip in an atlas: frames [first_frame, first_frame + frames) of `seconds` / `frames` each.
struct AtlasClip {
  std::string name;
  int32_t first_frame = 0;
  int32_t frames = 0;
  double seconds = 0;  ///< Length of one cycle.
  double stride = 0;   ///< Distance walked in one cycle; 0 if it stands. [m]
};

/// The place of a view in the atlas: `width` x `height` texels at (x, y) of `page` are the part at
/// (left, top) of a square of AtlasShape::pixels, the rest of which is empty. Texel rows go down.
struct AtlasView {
  uint16_t page = 0;
  uint16_t x = 0, y = 0;
  uint16_t width = 0, height = 0;
  uint16_t left = 0, top = 0;
  friend bool operator==(const AtlasView&, const AtlasView&) = default;
};

/// The dimensions of an atlas.
struct AtlasShape {
  int32_t pixels = 0;
  int32_t directions = 0;
  int32_t elevations = 0;
  int32_t frames = 0;  ///< Of all clips together.
  double side = 0;     ///< Of a view's square. [m]
  double centre = 0;   ///< Height of the square's middle over the feet. [m]
  double height = 0;   ///< Of the figure. [m]
  [[nodiscard]] size_t view(int32_t frame, int32_t row, int32_t column) const {
    return (static_cast<size_t>(frame) * elevations + row) * directions + column;
  }
};

/// An atlas: all views of a figure. Texels are rows of a page from the top, page after page; blocks
/// of 4 x 4 likewise. Views are aligned to blocks of 4 x 4 and have a border of empty texels.
/// Colours are albedo without light, as square roots of linear light (near to sRGB); normals are in
/// the view's axes: right, up (128 is 0), the rest towards the eye.
struct Atlas {
  AtlasShape shape;
  std::vector<AtlasClip> clips;
  std::vector<AtlasView> views;  ///< See AtlasShape::view.
  AtlasFormat format = AtlasFormat::kRgba8;
  int32_t width = 0, height = 0;  ///< Of a page. [texels, multiples of 4]
  int32_t pages = 0;
  std::vector<uint8_t> colour;
  std::vector<uint8_t> normal;
  /// One byte per texel: BodyPart << 5 | distance in front of the plane through the figure's
  /// middle, 16 +- 15 for half a `side`.
  std::vector<uint8_t> mask;
  /// Mean albedo of each BodyPart, stored like colours: the reference of a tint.
  std::array<std::array<uint8_t, 3>, kBodyParts> part_colour{};
};

/// Makes an atlas: poses and draws a character from all sides. Linear in views and triangles. Fails
/// with kBadConfig, kNotFound (clip), kBadInput (a character without height), kLimit (too many
/// texels for 64 pages of 2048 x 2048), kCancelled.
[[nodiscard]] THRONG_API Result<Atlas> build_atlas(const Character& character,
                                                   const AtlasConfig& config, Context& context);

/// Converts an atlas to another format; views, masks and clips stay.
[[nodiscard]] THRONG_API Atlas convert_atlas(const Atlas& atlas, AtlasFormat format,
                                             int32_t workers = 0);

/// Size of a texture of colour and alpha: packed as it is, and as a grid of equal squares, the
/// layout of [TC00]. [bytes]
[[nodiscard]] THRONG_API uint64_t packed_colour_bytes(const Atlas& atlas, AtlasFormat format);
[[nodiscard]] THRONG_API uint64_t sheet_colour_bytes(const AtlasShape& shape, AtlasFormat format);

/// Peak signal-to-noise ratio of the colours over all texels that `exact` covers by half or more
/// [dB]; infinite if they are equal. Both must have the same views.
[[nodiscard]] THRONG_API double atlas_psnr(const Atlas& exact, const Atlas& other);

/// Writes an atlas beside `path` and renames it. Fails with kIo.
[[nodiscard]] THRONG_API Result<void> save_atlas(const Atlas& atlas, const std::string& path);
/// Reads an atlas. Fails with kIo or kBadFile: another format, truncated, damaged, of another
/// version.
[[nodiscard]] THRONG_API Result<Atlas> load_atlas(const std::string& path);

/// Draws all views of one frame, lit, on grey, one row per elevation: for inspection.
[[nodiscard]] THRONG_API Image draw_atlas(const Atlas& atlas, int32_t frame);

/// The view to show. `mirrored`: left and right are exchanged, and `frame` is half a cycle later,
/// because the mirror image of a step of the left foot is one of the right. Source: [TC00] 2.
struct ViewChoice {
  int32_t frame = 0;
  int32_t row = 0;
  int32_t column = 0;
  bool mirrored = false;
  friend bool operator==(const ViewChoice&, const ViewChoice&) = default;
};

/// Chooses the view nearest to how an avatar is seen. `to_eye` points from the figure's middle to
/// the eye, any length; `heading` and `phase` are in turns, `phase` of the clip's cycle. From below
/// the horizon the lowest row is used.
[[nodiscard]] THRONG_API ViewChoice choose_view(const AtlasShape& shape, const AtlasClip& clip,
                                                Vec3d to_eye, double heading, double phase);

/// The phase of a figure that has walked `distance` since phase `start`: its feet do not slide.
/// `distance` in metres; `start` and the result in turns, [0, 1).
[[nodiscard]] THRONG_API double walk_phase(const AtlasClip& clip, double distance, double start);

}  // namespace throng
