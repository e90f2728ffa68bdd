// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <assimp/GltfMaterial.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <span>
#include <system_error>
#include <type_traits>
#include <utility>

#include "import/raw/child_process.h"
#include "throng/impostor.h"

// assimp reads a character in a child process (for the reason see
// import/formats/assimp_reader.cpp). The child converts it to our own arrays and sends them; the
// parent checks every index and number first.
namespace throng {
namespace {

constexpr uint64_t kMaxItems = 1 << 24;  // Of any one array.

// --- In the child -------------------------------------------------------------------------------

Transform transform_of(const aiMatrix4x4& m) {
  Transform t;
  t.m[0] = {m.a1, m.a2, m.a3, m.a4};
  t.m[1] = {m.b1, m.b2, m.b3, m.b4};
  t.m[2] = {m.c1, m.c2, m.c3, m.c4};
  return t;
}

Vec3d vector_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

class Extractor {
 public:
  explicit Extractor(const aiScene& scene) : scene_(scene) {}

  Character extract() {
    add_node(*scene_.mRootNode, -1);
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) add_material(*scene_.mMaterials[i]);
    add_meshes(*scene_.mRootNode);
    for (unsigned i = 0; i < scene_.mNumAnimations; ++i) add_clip(*scene_.mAnimations[i]);
    return std::move(character_);
  }

  bool has_skeleton = false;
  size_t bones_found = 0;

 private:
  void add_node(const aiNode& node, int32_t parent) {
    const auto index = static_cast<int32_t>(character_.joints.size());
    character_.joints.push_back(
        {.name = node.mName.C_Str(), .parent = parent, .rest = transform_of(node.mTransformation)});
    joint_of_.emplace(node.mName.C_Str(), index);
    joint_of_node_.emplace(&node, index);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], index);
  }

  void add_material(const aiMaterial& material) {
    CharacterMaterial out;
    out.name = material.GetName().C_Str();
    aiColor4D colour(0.6F, 0.6F, 0.6F, 1);
    if (material.Get(AI_MATKEY_BASE_COLOR, colour) != aiReturn_SUCCESS) {
      material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
    }
    out.colour = {colour.r, colour.g, colour.b};
    out.part = body_part_of(out.name);
    character_.materials.push_back(std::move(out));
  }

  // The bone of this joint and bind matrix, new if there is none. Past the limit: counted only.
  uint8_t bone_of(int32_t joint, const Transform& inverse_bind) {
    for (size_t b = 0; b < character_.bones.size(); ++b) {
      const Bone& bone = character_.bones[b];
      if (bone.joint == joint && bone.inverse_bind.m == inverse_bind.m) {
        return static_cast<uint8_t>(b);
      }
    }
    ++bones_found;
    if (character_.bones.size() == kMaxBones) return 0;
    character_.bones.push_back({joint, inverse_bind});
    return static_cast<uint8_t>(character_.bones.size() - 1);
  }

  void add_meshes(const aiNode& node) {
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      add_mesh(*scene_.mMeshes[node.mMeshes[i]], joint_of_node_.at(&node));
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_meshes(*node.mChildren[i]);
  }

  void add_mesh(const aiMesh& mesh, int32_t node_joint) {
    const auto base = static_cast<uint32_t>(character_.positions.size());
    if (mesh.mVertices == nullptr || mesh.mNormals == nullptr) return;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      character_.positions.push_back(vector_of(mesh.mVertices[v]));
      character_.normals.push_back(vector_of(mesh.mNormals[v]));
    }
    character_.influences.resize(character_.positions.size());
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const auto joint = joint_of_.find(bone.mName.C_Str());
      if (joint == joint_of_.end()) continue;
      has_skeleton = true;
      const uint8_t index = bone_of(joint->second, transform_of(bone.mOffsetMatrix));
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        if (bone.mWeights[w].mVertexId >= mesh.mNumVertices) continue;
        add_weight(character_.influences[base + bone.mWeights[w].mVertexId], index,
                   bone.mWeights[w].mWeight);
      }
    }
    // A mesh without bones (an eye, a hat) moves with its node.
    for (size_t v = base; v < character_.influences.size(); ++v) {
      if (character_.influences[v].weight[0] > 0) continue;
      character_.influences[v].bone[0] = bone_of(node_joint, {});
      character_.influences[v].weight[0] = 1;
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      character_.triangles.push_back(
          {base + face.mIndices[0], base + face.mIndices[1], base + face.mIndices[2]});
      character_.material.push_back(static_cast<uint8_t>(std::min(mesh.mMaterialIndex, 255U)));
    }
  }

  // Keeps the four strongest, strongest first.
  static void add_weight(Influence& influence, uint8_t bone, float weight) {
    if (!(weight > 0)) return;
    for (size_t k = 0; k < 4; ++k) {
      if (weight <= influence.weight[k]) continue;
      std::swap(weight, influence.weight[k]);
      std::swap(bone, influence.bone[k]);
    }
  }

  void add_clip(const aiAnimation& animation) {
    const double rate = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 25;
    Clip clip{.name = animation.mName.C_Str(), .seconds = animation.mDuration / rate, .tracks = {}};
    for (unsigned i = 0; i < animation.mNumChannels; ++i) {
      const aiNodeAnim& channel = *animation.mChannels[i];
      const auto joint = joint_of_.find(channel.mNodeName.C_Str());
      if (joint == joint_of_.end()) continue;
      JointTrack track;
      track.joint = joint->second;
      for (unsigned k = 0; k < channel.mNumPositionKeys; ++k) {
        track.position_times.push_back(channel.mPositionKeys[k].mTime / rate);
        track.positions.push_back(vector_of(channel.mPositionKeys[k].mValue));
      }
      for (unsigned k = 0; k < channel.mNumRotationKeys; ++k) {
        const aiQuaternion& q = channel.mRotationKeys[k].mValue;
        track.rotation_times.push_back(channel.mRotationKeys[k].mTime / rate);
        track.rotations.push_back({q.x, q.y, q.z, q.w});
      }
      for (unsigned k = 0; k < channel.mNumScalingKeys; ++k) {
        track.scale_times.push_back(channel.mScalingKeys[k].mTime / rate);
        track.scales.push_back(vector_of(channel.mScalingKeys[k].mValue));
      }
      clip.tracks.push_back(std::move(track));
    }
    character_.clips.push_back(std::move(clip));
  }

  const aiScene& scene_;
  Character character_;
  std::map<std::string, int32_t> joint_of_;  // The first joint of a name: clips mean that one.
  std::map<const aiNode*, int32_t> joint_of_node_;
};

// --- Both ends: one function lists the fields that the pipe carries, in order. -----------------

template <class Pipe>
bool pass_text(Pipe& pipe, std::string& text) {
  return pipe.array(text);
}

template <class Pipe>
bool pass_track(Pipe& pipe, JointTrack& t) {
  return pipe.value(t.joint) && pipe.array(t.position_times) && pipe.array(t.rotation_times) &&
         pipe.array(t.scale_times) && pipe.array(t.positions) && pipe.array(t.scales) &&
         pipe.array(t.rotations);
}

template <class Pipe>
bool pass_character(Pipe& pipe, Character& c) {
  return pipe.items(c.joints,
                    [&](Joint& j) {
                      return pass_text(pipe, j.name) && pipe.value(j.parent) && pipe.value(j.rest);
                    }) &&
         pipe.array(c.bones) && pipe.array(c.positions) && pipe.array(c.normals) &&
         pipe.array(c.influences) && pipe.array(c.triangles) && pipe.array(c.material) &&
         pipe.items(c.materials,
                    [&](CharacterMaterial& m) {
                      return pass_text(pipe, m.name) && pipe.value(m.colour);
                    }) &&
         pipe.items(c.clips, [&](Clip& clip) {
           return pass_text(pipe, clip.name) && pipe.value(clip.seconds) &&
                  pipe.items(clip.tracks, [&](JointTrack& t) { return pass_track(pipe, t); });
         });
}

struct Sending {
  const importer::PipeWriter& pipe;
  template <class T>
  bool value(T& v) const {
    static_assert(std::is_trivially_copyable_v<T>);
    pipe.write(&v, sizeof v);
    return true;
  }
  template <class Array>
  bool array(Array& v) const {
    uint64_t count = v.size();
    value(count);
    if (count > 0) pipe.write(v.data(), count * sizeof v[0]);
    return true;
  }
  template <class T, class Pass>
  bool items(std::vector<T>& v, Pass pass) const {
    uint64_t count = v.size();
    value(count);
    for (T& item : v) pass(item);
    return true;
  }
};

struct Receiving {
  importer::PipeReader& pipe;
  template <class T>
  bool value(T& v) const {
    static_assert(std::is_trivially_copyable_v<T>);
    return pipe.read(&v, sizeof v);
  }
  // Grows as the bytes arrive, so that a false count costs nothing.
  template <class Array>
  bool array(Array& v) const {
    uint64_t count = 0;
    if (!value(count) || count > kMaxItems) return false;
    constexpr uint64_t kPiece = 1 << 16;
    for (uint64_t have = 0; have < count;) {
      const uint64_t more = std::min(kPiece, count - have);
      v.resize(have + more);
      if (!pipe.read(v.data() + have, more * sizeof v[0])) return false;
      have += more;
    }
    return true;
  }
  template <class T, class Pass>
  bool items(std::vector<T>& v, Pass pass) const {
    uint64_t count = 0;
    if (!value(count) || count > kMaxItems) return false;
    for (uint64_t i = 0; i < count; ++i) {
      if (!pass(v.emplace_back())) return false;
    }
    return true;
  }
};

enum class Answer : uint32_t { kCharacter = 1, kRefused, kNoSkeleton, kTooManyBones };

void refuse(const importer::PipeWriter& pipe, std::string why) {
  why.resize(std::min<size_t>(why.size(), 1000));
  const Sending send{pipe};
  Answer answer = Answer::kRefused;
  send.value(answer);
  send.array(why);
}

void read_and_send(const std::string& path, const importer::PipeWriter& pipe) {
  try {
    auto* importer = new Assimp::Importer;  // Never destroyed: the child ends by _exit.
    importer->SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    const aiScene* scene =
        importer->ReadFile(path, aiProcess_Triangulate | aiProcess_GenSmoothNormals);
    if (scene == nullptr || scene->mRootNode == nullptr) {
      refuse(pipe, importer->GetErrorString());
      return;
    }
    Extractor extractor(*scene);
    Character character = extractor.extract();
    const Sending send{pipe};
    Answer answer = Answer::kCharacter;
    if (extractor.bones_found > kMaxBones) answer = Answer::kTooManyBones;
    if (!extractor.has_skeleton) answer = Answer::kNoSkeleton;
    send.value(answer);
    if (answer == Answer::kTooManyBones) {
      uint64_t bones = extractor.bones_found;
      send.value(bones);
    } else if (answer == Answer::kCharacter) {
      pass_character(send, character);
    }
  } catch (const std::bad_alloc&) {
    refuse(pipe, "not enough memory");
  } catch (const std::exception& error) {
    refuse(pipe, error.what());
  } catch (...) {
    refuse(pipe, "unknown failure");
  }
}

// --- In the parent ------------------------------------------------------------------------------

bool is_finite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool is_finite(const Transform& t) {
  for (const auto& row : t.m) {
    for (const double value : row) {
      if (!std::isfinite(value)) return false;
    }
  }
  return true;
}

template <class T>
bool is_series(const std::vector<double>& times, const std::vector<T>& values) {
  if (times.size() != values.size()) return false;
  for (size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || (i > 0 && times[i] < times[i - 1])) return false;
  }
  return true;
}

bool is_sound(const JointTrack& track, size_t joints) {
  if (track.joint < 0 || static_cast<size_t>(track.joint) >= joints) return false;
  if (!is_series(track.position_times, track.positions) ||
      !is_series(track.scale_times, track.scales) ||
      !is_series(track.rotation_times, track.rotations)) {
    return false;
  }
  for (const Vec3d& p : track.positions) {
    if (!is_finite(p)) return false;
  }
  for (const Vec3d& s : track.scales) {
    if (!is_finite(s)) return false;
  }
  for (const auto& q : track.rotations) {
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(square > 0.5 && square < 2)) return false;
  }
  return true;
}

// The first fault of a character, or nothing.
std::string fault_of(const Character& c) {
  if (c.triangles.empty()) return "has no mesh";
  const size_t vertices = c.positions.size();
  if (c.normals.size() != vertices || c.influences.size() != vertices ||
      c.material.size() != c.triangles.size() || c.bones.empty() || c.bones.size() > kMaxBones) {
    return "has arrays that do not fit together";
  }
  for (size_t v = 0; v < vertices; ++v) {
    if (!is_finite(c.positions[v]) || !is_finite(c.normals[v])) return "has a vertex not finite";
    for (size_t k = 0; k < 4; ++k) {
      const Influence& i = c.influences[v];
      const bool sound = i.bone[k] < c.bones.size() && i.weight[k] >= 0 && i.weight[k] < 1e6F;
      if (!sound) return "has a vertex with a bone or weight out of range";
    }
  }
  for (size_t t = 0; t < c.triangles.size(); ++t) {
    for (const uint32_t corner : c.triangles[t]) {
      if (corner >= vertices) return "has a triangle with a corner out of range";
    }
    if (c.material[t] >= c.materials.size()) return "has more than 256 materials";
  }
  for (size_t j = 0; j < c.joints.size(); ++j) {
    if (c.joints[j].parent >= static_cast<int32_t>(j) || !is_finite(c.joints[j].rest)) {
      return "has a skeleton with a node out of place";
    }
  }
  for (const Bone& bone : c.bones) {
    const bool known = bone.joint >= 0 && static_cast<size_t>(bone.joint) < c.joints.size();
    if (!known || !is_finite(bone.inverse_bind)) return "has a bone out of place";
  }
  for (const CharacterMaterial& m : c.materials) {
    if (!is_finite(m.colour)) return "has a material whose colour is no number";
  }
  for (const Clip& clip : c.clips) {
    if (!(clip.seconds >= 0 && clip.seconds < 1e6)) return "has a clip of no length";
    for (const JointTrack& track : clip.tracks) {
      if (!is_sound(track, c.joints.size())) return "has a clip with keys out of order";
    }
  }
  return {};
}

// Weights that add up to 1, unit normals, colours within limits.
void tidy(Character& c) {
  for (Influence& i : c.influences) {
    const float sum = i.weight[0] + i.weight[1] + i.weight[2] + i.weight[3];
    if (sum > 0) {
      for (float& weight : i.weight) weight /= sum;
    } else {
      i.weight = {1, 0, 0, 0};
    }
  }
  for (Vec3d& n : c.normals) {
    const double size = length(n);
    n = size > 0 ? n * (1 / size) : Vec3d{0, 1, 0};
  }
  for (CharacterMaterial& m : c.materials) {
    m.part = body_part_of(m.name);
    m.colour = {std::clamp(m.colour.x, 0.0, 1.0), std::clamp(m.colour.y, 0.0, 1.0),
                std::clamp(m.colour.z, 0.0, 1.0)};
  }
}

}  // namespace

Result<Character> load_character(const std::string& path, Context& context) {
  std::error_code failure;
  const uint64_t size = std::filesystem::file_size(path, failure);
  if (failure) return Error{Errc::kBadFile, path + ": no such file; check the path"};
  const importer::ChildLimits limits{.bytes = (uint64_t{2} << 30) + 100 * size,
                                     .seconds = 5 + size / 20'000};
  Character character;
  Answer answer = Answer::kCharacter;
  std::string refused;
  uint64_t bones = 0;
  const auto done = importer::run_in_child(
      limits, context, [&](const importer::PipeWriter& pipe) { read_and_send(path, pipe); },
      [&](importer::PipeReader& pipe) {
        const Receiving receive{pipe};
        if (!receive.value(answer)) return false;
        if (answer == Answer::kRefused) return receive.array(refused);
        if (answer == Answer::kTooManyBones) return receive.value(bones);
        return answer == Answer::kNoSkeleton || pass_character(receive, character);
      });
  if (!done && done.error().code == Errc::kBadFile) {
    return Error{Errc::kBadFile, fmt::format("{}: {}; export it again, or as another format", path,
                                             done.error().message)};
  }
  if (!done) return Error{done.error().code, path + ": " + done.error().message};
  if (answer == Answer::kRefused) {
    return Error{Errc::kBadFile, fmt::format("{}: {}; the file may be damaged or not of the format "
                                             "that its name says",
                                             path, refused)};
  }
  if (answer == Answer::kNoSkeleton) {
    return Error{Errc::kBadInput,
                 path +
                     ": no mesh in it follows a skeleton; export the character with its "
                     "armature and its skin weights"};
  }
  if (answer == Answer::kTooManyBones) {
    return Error{Errc::kLimit, fmt::format("{}: {} bones, more than {}; leave out bones of fingers "
                                           "and of the face",
                                           path, bones, kMaxBones)};
  }
  if (const std::string fault = fault_of(character); !fault.empty()) {
    return Error{Errc::kBadInput, fmt::format("{}: {}; export it again", path, fault)};
  }
  if (character.clips.empty()) {
    return Error{Errc::kBadInput,
                 path + ": no clip of movement in it; export the character with its animations"};
  }
  tidy(character);
  return character;
}

}  // namespace throng
