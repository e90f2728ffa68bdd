// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/math.h"
#include "throng/result.h"

/// Skinned characters: a mesh, the skeleton that moves it, and clips of movement.
/// Y is up; a figure faces +Z. Lengths are the file's own until an atlas is built.
namespace throng {

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

/// A joint of the skeleton: a frame of reference that clips move. Parents come before their
/// children.
struct Joint {
  std::string name;
  int32_t parent = -1;  ///< Index of an earlier joint, or -1.
  Transform rest;       ///< Relative to the parent, where a clip has no keys.
};

/// A bone: a joint that vertices follow.
struct Bone {
  int32_t joint = 0;
  Transform inverse_bind;  ///< From the mesh at rest to the joint.
};

/// The bones that a vertex follows; weights add up to 1, unused ones are 0.
struct Influence {
  std::array<uint8_t, 4> bone{};
  std::array<float, 4> weight{};
};

/// Keys of one joint. Times ascend [s]; an empty array leaves that part of `rest` as it is.
struct JointTrack {
  int32_t joint = 0;
  std::vector<double> position_times, rotation_times, scale_times;
  std::vector<Vec3d> positions, scales;
  std::vector<std::array<double, 4>> rotations;  ///< Unit quaternions x, y, z, w.
};

/// A movement that repeats after `seconds`.
struct Clip {
  std::string name;
  double seconds = 0;
  std::vector<JointTrack> tracks;
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
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;         ///< One per position; unit length.
  std::vector<Influence> influences;  ///< One per position.
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint8_t> material;  ///< One per triangle.
  std::vector<CharacterMaterial> materials;
  std::vector<Clip> clips;
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

}  // namespace throng
