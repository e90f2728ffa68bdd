// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "throng/base.h"
#include "throng/picture.h"

/// Impostors: characters, their figures as triangles or as pictures from all sides, atlases.
namespace throng {

// ----
// Skinned characters: a mesh, the skeleton that moves it, and clips of movement.
// Y is up; a figure faces +Z. Lengths are the file's own until an atlas is built.

/// The part of the body that a surface belongs to, so that avatars of a crowd can have different
/// colours. It follows from the material's name.
enum class BodyPart : uint8_t { kOther, kSkin, kHair, kShirt, kPants, kShoes };
/// Number of BodyPart values.
inline constexpr int32_t kBodyParts = 6;

/// The body part that a material's name means: "Shirt", "suit_jacket" -> kShirt; "Socks" -> kShoes;
/// any other name -> kOther.
[[nodiscard]] THRONG_API BodyPart body_part_of(std::string_view material);
/// The name of a body part: "other", "skin", "hair", "shirt", "pants", "shoes".
[[nodiscard]] THRONG_API const char* word_for(BodyPart part);

/// What an avatar may wear over its body. Avatars of one body wear different parts.
enum class WornKind : uint8_t { kHair, kHat, kCoat, kBag, kSkirt };
/// Number of WornKind values.
inline constexpr int32_t kWornKinds = 5;
/// The name of a kind: "hair", "hat", "coat", "bag", "skirt".
[[nodiscard]] THRONG_API const char* word_for(WornKind kind);

/// A part that avatars wear or not, as triangles of Character: they follow the same skeleton. An
/// avatar wears at most one of a kind.
struct WornPart {
  std::string name;
  WornKind kind = WornKind::kHair;
  uint32_t first_triangle = 0;  ///< Into Character::triangles.
  uint32_t triangle_count = 0;
};
/// Maximum number of parts of a character.
inline constexpr size_t kMaxWorn = 16;

/// A joint of the skeleton: a frame of reference that clips move. Parents come before their
/// children.
struct Joint {
  std::string name;
  int32_t parent = -1;  ///< Index of an earlier joint, or -1.
  Transform rest;       ///< Relative to the parent, where a clip has no keys.
};

/// A bone: a joint that vertices follow.
struct Bone {
  int32_t joint = 0;       ///< Index into Character::joints.
  Transform inverse_bind;  ///< From the mesh at rest to the joint.
};

/// The bones that a vertex follows; weights add up to 1, unused ones are 0.
struct Influence {
  std::array<uint8_t, 4> bone{};  ///< Indices into Character::bones.
  std::array<float, 4> weight{};  ///< [0 to 1]
};

/// Keys of one joint. Times ascend [s]; an empty array leaves that part of `rest` as it is.
struct JointTrack {
  int32_t joint = 0;
  std::vector<double> position_times, rotation_times, scale_times;  ///< One per key. [s]
  std::vector<Vec3d> positions, scales;  ///< Relative to the parent. [the file's unit; factors]
  std::vector<std::array<double, 4>> rotations;  ///< Unit quaternions x, y, z, w.
};

/// A movement that repeats after `seconds`.
struct Clip {
  std::string name;
  double seconds = 0;              ///< Length of one cycle. [s]
  std::vector<JointTrack> tracks;  ///< Joints without one stay at rest.
};

/// A material of a character.
struct CharacterMaterial {
  std::string name;
  Vec3d colour;  ///< Red, green, blue as x, y, z; linear. [0 to 1]
  BodyPart part = BodyPart::kOther;
};

/// A character at rest. Triangle t has the corners triangles[t] and the material
/// materials[material[t]].
struct Character {
  std::vector<Joint> joints;
  std::vector<Bone> bones;
  std::vector<Vec3d> positions;       ///< In the file's unit.
  std::vector<Vec3d> normals;         ///< One per position; unit length.
  std::vector<Influence> influences;  ///< One per position.
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint8_t> material;  ///< One per triangle.
  std::vector<CharacterMaterial> materials;
  std::vector<Clip> clips;
  /// What not all avatars wear, in order: the triangles from the first one's on are these parts',
  /// all before are the body. No vertex is of two of them.
  std::vector<WornPart> worn = {};
  /// The number of triangles of the body.
  [[nodiscard]] size_t body_triangles() const {
    return worn.empty() ? triangles.size() : worn[0].first_triangle;
  }
};

/// Maximum number of bones of a character.
inline constexpr size_t kMaxBones = 256;

/// Reads a character from glTF, GLB, FBX, DAE or another format that assimp reads with a skeleton.
/// Fails with kBadFile, kBadInput (no mesh, no skeleton, no clip, indices out of range) or kLimit
/// (bones). Does not crash on any bytes.
[[nodiscard]] THRONG_API Result<Character> load_character(const std::string& path,
                                                          Context& context);

/// A generated character of 1.75 m with the clips "Walk" and "Idle". Left and right are alike.
[[nodiscard]] THRONG_API Character built_in_character();

/// The same with parts to wear: long hair, a bun, a hat, a cap, a coat, a rucksack, a skirt.
[[nodiscard]] THRONG_API Character built_in_character_with_parts();

/// Puts a part of one character on another: the triangles of `from` whose material is of
/// `part`, or, if `from` wears parts, those of its worn ones of `kind`. They follow the joints of
/// `onto` that have the same names. Fails with kNotFound: `from` has no such triangles, or `onto`
/// lacks a joint that moves them; with kLimit: bones, materials or parts.
[[nodiscard]] THRONG_API Result<void> wear_part(Character& onto, const Character& from,
                                                BodyPart part, WornKind kind);

/// The index of the clip with a name: the whole name or its last word ("Walk" finds
/// "Armature|Man_Walk"); case is ignored. Fails with kNotFound and the names of the clips.
[[nodiscard]] THRONG_API Result<size_t> find_clip(const Character& character,
                                                  std::string_view word);

/// A mesh in one pose.
struct PosedMesh {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;  ///< Unit length.
};

/// Poses the mesh at `seconds` into a clip by linear blending of its bones; times outside the clip
/// wrap. Arrays of `out` are resized.
THRONG_API void pose_character(const Character& character, size_t clip, double seconds,
                               PosedMesh& out);

// ----
// Impostors: pictures of a walking figure from many directions, drawn as one rectangle per avatar.
// Source: [TC00] 2 and 4. Angles are in turns from +Z towards +X: 0.25 faces +X.

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

/// Settings for create_atlas.
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

/// A part of an atlas that avatars wear or not. Its views are those of what is not behind the body.
struct AtlasPart {
  std::string name;
  WornKind kind = WornKind::kHair;
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
  // As in AtlasConfig, the fields of the same names.
  int32_t pixels = 0;
  int32_t directions = 0;
  int32_t elevations = 0;
  int32_t frames = 0;  ///< Of all clips together.
  double side = 0;     ///< Of a view's square. [m]
  double centre = 0;   ///< Height of the square's middle over the feet. [m]
  double height = 0;   ///< Of the figure. [m]
  /// Index into Atlas::views; rows are elevations from the horizon up, columns directions.
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
  /// See AtlasShape::view. Behind those of the body there are as many of each part.
  std::vector<AtlasView> views;
  AtlasFormat format = AtlasFormat::kRgba8;
  int32_t width = 0, height = 0;  ///< Of a page. [texels, multiples of 4]
  int32_t pages = 0;
  std::vector<uint8_t> colour;  ///< Texels of `format`, with alpha.
  std::vector<uint8_t> normal;  ///< As AtlasFormat says.
  /// One byte per texel: BodyPart << 5 | distance in front of the plane through the figure's
  /// middle, 16 +- 15 for half a `side`.
  std::vector<uint8_t> mask;
  /// Mean albedo of each BodyPart, stored like colours: the reference of a tint.
  std::array<std::array<uint8_t, 3>, kBodyParts> part_colour{};
  std::vector<AtlasPart> parts = {};  ///< What avatars may wear. [at most kMaxWorn]
};

/// Which parts an avatar of an appearance wears: bit i for parts[i]. Of each kind it wears one or
/// none, each chosen by a hash of its own, so that all exchange with all.
[[nodiscard]] THRONG_API uint32_t worn_by(std::span<const AtlasPart> parts, uint32_t appearance);

/// Makes an atlas: poses and draws a character from all sides. Linear in views and triangles. Fails
/// with kBadConfig, kNotFound (clip), kBadInput (a character without height), kLimit (too many
/// texels for 64 pages of 2048 x 2048), kCancelled.
[[nodiscard]] THRONG_API Result<Atlas> create_atlas(const Character& character,
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
  int32_t frame = 0;   ///< Of all clips together.
  int32_t row = 0;     ///< As in AtlasShape::view.
  int32_t column = 0;  ///< As in AtlasShape::view.
  bool mirrored = false;
  friend bool operator==(const ViewChoice&, const ViewChoice&) = default;
};

/// Chooses the view nearest to how an avatar is seen. `to_eye` points from the figure's middle to
/// the eye, any length; `heading` and `phase` are in turns, `phase` of the clip's cycle. From below
/// the horizon the lowest row is used.
[[nodiscard]] THRONG_API ViewChoice choose_view(const AtlasShape& shape, const AtlasClip& clip,
                                                Vec3d to_eye, double heading, double phase);

/// The phase of a figure that has walked `distance` since phase `start`: its feet do not slide. In
/// a clip of a figure that stands it goes by the time since then. `distance` in metres, `seconds`
/// in seconds; `start` and the result in turns, [0, 1).
[[nodiscard]] THRONG_API double walk_phase(const AtlasClip& clip, double distance, double start,
                                           double seconds = 0);

// ----
// Packs arrays of avatars into instances that a graphics card draws: culls avatars and chooses
// their views. Runs on the processor; the same bytes for any number of threads.

/// An eye that looks at a point. Y is up.
struct EyeCamera {
  Vec3d eye{0, 1.7, 5};        ///< [m]
  Vec3d target{0, 1, 0};       ///< Only the direction from the eye counts. [m]
  double field_of_view = 0.8;  ///< Top to bottom. [rad, > 0, < 3]
  double aspect = 16.0 / 9;    ///< Width by height. [> 0]
  double nearest = 0.2;        ///< Nearer things are not drawn. [m, > 0]
  double furthest = 10000;     ///< Farther things are not drawn. [m, > nearest]
};

/// Borrowed arrays, one entry per avatar. Positions are relative to a point of the caller's, near
/// enough for floats (a kilometre to 0.06 mm).
struct ImpostorArrays {
  std::span<const float> x, y, z;        ///< Feet. [m]
  std::span<const uint16_t> heading;     ///< From +Z towards +X. [65536 a turn]
  std::span<const uint16_t> phase;       ///< Of the clip's cycle, see walk_phase. [65536 a cycle]
  std::span<const uint16_t> appearance;  ///< Any number, which selects the outfit. [< 2048]
};

/// An avatar for the card, 16 bytes. `view`: AtlasShape::view in bits 0 to 19, mirrored in bit 20,
/// appearance in bits 21 to 31. For a mesh: heading in bits 0 to 10 [2048 a turn], phase in bits 11
/// to 20 [1024 a cycle], appearance as before.
struct ImpostorInstance {
  float x = 0, y = 0, z = 0;
  uint32_t view = 0;
};

/// An avatar for the card, 32 bytes, seen from between two directions or elevations and blended
/// from the four views around. `nearest_below` is that of the lower column and row, `others` those
/// of the next column, the next row and both, as ImpostorInstance::view without appearance.
/// `shares`: of the next column in bits 0 to 8, of the next row in bits 9 to 17 [256: all].
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
/// Packs avatars as pack_impostors does, each for the level of its distance. Points use only
/// position and appearance.
THRONG_API LevelCounts pack_levels(const Atlas& atlas, const ImpostorArrays& avatars,
                                   const PackConfig& config, const LevelDistances& levels,
                                   const LevelSpans& out);

/// The axes of a camera: unit vectors.
struct CameraAxes {
  Vec3d right, up, forward;
};
/// The axes of a camera.
[[nodiscard]] THRONG_API CameraAxes camera_axes(const EyeCamera& camera);

// ----
// A figure as an animated mesh, for avatars near the eye: the poses of its clips, ready for a
// graphics card. Far avatars are drawn from an Atlas.

/// A vertex of one pose. Positions are 65535ths of FigureModel::low to high.
struct PosedVertex {
  uint16_t x = 0, y = 0, z = 0;
  /// The unit normal on an octahedron folded flat: u in the low byte, v in the high, 128 is 0.
  uint16_t normal = 0;
  friend bool operator==(const PosedVertex&, const PosedVertex&) = default;
};

/// The colour of a vertex in all poses: albedo as Atlas keeps colours, and the BodyPart.
struct ModelPaint {
  std::array<uint8_t, 3> colour{};  ///< Red, green, blue.
  uint8_t part = 0;                 ///< A BodyPart.
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
  /// As Character::worn: their triangles are behind those of the body.
  std::vector<WornPart> worn = {};
};

/// Poses a character as create_atlas does; uses only `clips`, `frames` and `height` of the
/// settings. Linear in frames and triangles. Fails as create_atlas does, and with kLimit: more than
/// 4 million vertices in all poses.
[[nodiscard]] THRONG_API Result<FigureModel> create_figure_model(const Character& character,
                                                                 const AtlasConfig& config,
                                                                 Context& context);

}  // namespace throng
