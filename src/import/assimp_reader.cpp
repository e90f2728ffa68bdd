// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/assimp_reader.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "import/child_process.h"

// assimp parses untrusted files with raw pointers, and some files crash it, loop in it or make it
// take all memory. So it runs in a child process, which streams mesh by mesh and frees each one as
// it goes; the parent believes nothing that it has not counted itself.
namespace throng {
namespace {

enum class Tag : uint32_t { kConvention = 1, kPart, kThin, kRefused, kDone };

struct Message {
  Tag tag = Tag::kDone;
  uint32_t node_size = 0;      // Of kPart; the text's of kRefused.
  uint32_t material_size = 0;  // Of kPart; the up axis of kConvention.
  int32_t area = -1;           // Of kPart; kNoArea if the file does not say.
  uint64_t vertices = 0;       // Of kPart; the count of kThin.
  uint64_t triangles = 0;
  double metres_per_unit = 1;
};

constexpr uint32_t kLongestText = 1 << 16;
constexpr int32_t kNoArea = -1;

// --- In the child -------------------------------------------------------------------------------

// Nodes that assimp adds by itself: they would hide the file's own names.
bool is_helper(const std::string& name) {
  return name.empty() || name.find("_$AssimpFbx$_") != std::string::npos ||
         name.starts_with("$Rel") || name.starts_with("IfcMappedItem") ||
         name.starts_with("$ColladaAutoName$");
}

// The area kind that write_glb puts into a node's extras; other programs call extras "custom
// properties" and write numbers of any type. A kind that does not exist is passed on as it is.
int32_t area_of(const aiNode& node, int32_t above) {
  const aiMetadata* data = node.mMetaData;
  if (data == nullptr) return above;
  for (unsigned i = 0; i < data->mNumProperties; ++i) {
    if (std::string_view(data->mKeys[i].C_Str()) != "area" || data->mValues[i].mData == nullptr) {
      continue;
    }
    const auto number = [&]<class T>(T) {
      T value{};
      std::memcpy(&value, data->mValues[i].mData, sizeof value);
      const auto kind = static_cast<double>(value);
      return kind >= 0 && kind < 1e9 ? static_cast<int32_t>(kind) : INT32_MAX;
    };
    switch (data->mValues[i].mType) {
      case AI_INT32:
        return number(int32_t{});
      case AI_UINT64:
        return number(uint64_t{});
      case AI_FLOAT:
        return number(float{});
      case AI_DOUBLE:
        return number(double{});
      default:
        break;  // Words, say.
    }
  }
  return above;
}

class Sender {
 public:
  Sender(aiScene& scene, const std::string& path, const PipeWriter& pipe)
      : scene_(scene), pipe_(pipe), extension_(std::filesystem::path(path).extension().string()) {
    for (char& c : extension_) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    has_areas_ = extension_ == ".glb" || extension_ == ".gltf";
    uses_.assign(scene.mNumMeshes, 0);
    if (scene.mRootNode != nullptr) count_uses(*scene.mRootNode);
  }

  void send() {
    Message convention{.tag = Tag::kConvention, .material_size = 'y'};
    if (extension_ == ".fbx" && scene_.mMetaData != nullptr) {
      double centimetres = 1;
      float single = 1;
      int32_t up = 1;
      if (!scene_.mMetaData->Get("UnitScaleFactor", centimetres) &&
          scene_.mMetaData->Get("UnitScaleFactor", single)) {
        centimetres = single;
      }
      convention.metres_per_unit = centimetres * 0.01;
      if (scene_.mMetaData->Get("UpAxis", up) && up == 2) convention.material_size = 'z';
    }
    pipe_.write(&convention, sizeof convention);
    if (scene_.mRootNode != nullptr) {
      send_node(*scene_.mRootNode, {}, kNoArea, aiMatrix4x4t<double>());
    }
    const Message thin{.tag = Tag::kThin, .vertices = thin_};
    pipe_.write(&thin, sizeof thin);
    const Message done{.tag = Tag::kDone};
    pipe_.write(&done, sizeof done);
  }

 private:
  void count_uses(const aiNode& node) {
    for (unsigned i = 0; i < node.mNumMeshes; ++i) ++uses_.at(node.mMeshes[i]);
    for (unsigned i = 0; i < node.mNumChildren; ++i) count_uses(*node.mChildren[i]);
  }

  void send_node(const aiNode& node, const std::string& path, int32_t area_above,
                 const aiMatrix4x4t<double>& above) {
    const auto& m = node.mTransformation;
    const int32_t area = has_areas_ ? area_of(node, area_above) : kNoArea;
    const aiMatrix4x4t<double> here =
        above * aiMatrix4x4t<double>(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2,
                                     m.c3, m.c4, m.d1, m.d2, m.d3, m.d4);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const unsigned index = node.mMeshes[i];
      send_mesh(*scene_.mMeshes[index],
                path.empty() && !is_helper(node.mName.C_Str()) ? node.mName.C_Str() : path, area,
                here);
      if (--uses_[index] == 0) free_mesh(*scene_.mMeshes[index]);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      const aiNode& child = *node.mChildren[i];
      const std::string name = child.mName.C_Str();
      const bool helper = is_helper(name);
      std::string below = path;
      if (!helper) below += (path.empty() ? "" : "/") + name;
      send_node(child, below, area, here);
    }
  }

  void send_mesh(const aiMesh& mesh, std::string node, int32_t area,
                 const aiMatrix4x4t<double>& m) {
    if (node.empty()) node = mesh.mName.C_Str();
    std::string material;
    if (mesh.mMaterialIndex < scene_.mNumMaterials) {
      material = scene_.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
    }
    node.resize(std::min<size_t>(node.size(), kLongestText));
    material.resize(std::min<size_t>(material.size(), kLongestText));
    Message part{.tag = Tag::kPart, .area = area};
    part.node_size = static_cast<uint32_t>(node.size());
    part.material_size = static_cast<uint32_t>(material.size());
    part.vertices = mesh.mVertices != nullptr ? mesh.mNumVertices : 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const unsigned corners = mesh.mFaces[f].mNumIndices;
      part.triangles += corners > 2 ? corners - 2 : 0;
      thin_ += corners < 3 ? 1 : 0;
    }
    if (part.triangles == 0) return;
    pipe_.write(&part, sizeof part);
    pipe_.write(node.data(), node.size());
    pipe_.write(material.data(), material.size());
    const double rows[12] = {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2,
                             m.b3, m.b4, m.c1, m.c2, m.c3, m.c4};
    pipe_.write(rows, sizeof rows);
    static_assert(sizeof(aiVector3D) == 3 * sizeof(float), "assimp built with double precision");
    pipe_.write(mesh.mVertices, part.vertices * sizeof(aiVector3D));
    std::vector<std::array<uint32_t, 3>> piece;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      for (unsigned k = 2; k < face.mNumIndices; ++k) {
        piece.push_back({face.mIndices[0], face.mIndices[k - 1], face.mIndices[k]});
      }
      if (piece.size() >= 16384 || f + 1 == mesh.mNumFaces) {
        pipe_.write(piece.data(), piece.size() * sizeof piece[0]);
        piece.clear();
      }
    }
  }

  static void free_mesh(aiMesh& mesh) {
    delete[] mesh.mVertices;
    mesh.mVertices = nullptr;
    delete[] mesh.mFaces;
    mesh.mFaces = nullptr;
    mesh.mNumFaces = 0;
  }

  aiScene& scene_;
  const PipeWriter& pipe_;
  std::string extension_;
  bool has_areas_ = false;  // In other formats "area" is somebody else's measure.
  std::vector<uint32_t> uses_;
  uint64_t thin_ = 0;
};

void refuse(const PipeWriter& pipe, std::string why) {
  why.resize(std::min<size_t>(why.size(), 1000));
  Message message{.tag = Tag::kRefused};
  message.node_size = static_cast<uint32_t>(why.size());
  pipe.write(&message, sizeof message);
  pipe.write(why.data(), why.size());
}

void read_and_send(const std::string& path, const PipeWriter& pipe) {
  try {
    auto* importer = new Assimp::Importer;  // Never destroyed: the child ends by _exit.
    importer->SetPropertyInteger(
        AI_CONFIG_PP_RVC_FLAGS,
        aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
            aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
            aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
    const aiScene* read =
        importer->ReadFile(path, aiProcess_Triangulate | aiProcess_RemoveComponent);
    if (read == nullptr) {
      refuse(pipe, importer->GetErrorString());
      return;
    }
    aiScene* scene = importer->GetOrphanedScene();
    Sender(*scene, path, pipe).send();
  } catch (const std::bad_alloc&) {
    refuse(pipe, "not enough memory");
  } catch (const std::exception& error) {
    refuse(pipe, error.what());
  } catch (...) {
    refuse(pipe, "unknown failure");
  }
}

// --- In the parent ------------------------------------------------------------------------------

class Receiver {
 public:
  explicit Receiver(const ReadOptions& options) : name_(options.name), writer_(options) {}

  // True once the child has sent everything, or has refused the file.
  bool receive(PipeReader& pipe) {
    Message message;
    while (pipe.read(&message, sizeof message)) {
      switch (message.tag) {
        case Tag::kConvention:
          raw_.up = message.material_size == 'z' ? 'z' : 'y';
          if (message.metres_per_unit > 1e-9 && message.metres_per_unit < 1e9) {
            raw_.metres_per_unit = message.metres_per_unit;
          }
          break;
        case Tag::kPart:
          if (!receive_part(pipe, message)) return false;
          break;
        case Tag::kThin:
          writer_.count_points_and_lines(message.vertices);
          break;
        case Tag::kRefused:
          return receive_text(pipe, message.node_size, refused);
        case Tag::kDone:
          return true;
        default:
          return false;
      }
    }
    return false;
  }

  Result<RawScene> finish() {
    if (unknown_kinds_ > 0) {
      writer_.warn(fmt::format("{}: {} meshes name an area kind outside 0 to {}; they are walkable",
                               name_, unknown_kinds_, kAreaLast));
    }
    auto scene = writer_.finish();
    if (!scene) return scene.error();
    raw_.scene = *std::move(scene);
    return std::move(raw_);
  }

  std::string refused;
  bool too_large = false;

 private:
  static bool receive_text(PipeReader& pipe, uint32_t size, std::string& text) {
    if (size > kLongestText) return false;
    text.resize(size);
    return pipe.read(text.data(), size);
  }

  bool receive_part(PipeReader& pipe, const Message& part) {
    std::string node, material;
    Transform place;
    if (!receive_text(pipe, part.node_size, node)) return false;
    if (!receive_text(pipe, part.material_size, material)) return false;
    if (!pipe.read(place.m.data(), sizeof place.m)) return false;
    writer_.begin_part(node, material);
    auto& positions = writer_.scene().positions;
    if (positions.size() + part.vertices >= kNoVertex ||
        writer_.scene().triangles.size() + part.triangles >= kNoVertex) {
      too_large = true;
      return false;
    }
    const auto base = static_cast<uint32_t>(positions.size());
    for (uint64_t left = part.vertices; left > 0;) {
      const size_t count = std::min<uint64_t>(left, floats_.size());
      if (!pipe.read(floats_.data(), count * sizeof floats_[0])) return false;
      for (size_t i = 0; i < count; ++i) {
        positions.push_back(place({floats_[i][0], floats_[i][1], floats_[i][2]}));
      }
      left -= count;
    }
    for (uint64_t left = part.triangles; left > 0;) {
      const size_t count = std::min<uint64_t>(left, corners_.size());
      if (!pipe.read(corners_.data(), count * sizeof corners_[0])) return false;
      for (size_t i = 0; i < count; ++i) {
        const auto corner = [&](int k) {  // An index into another mesh is as bad as none.
          return corners_[i][k] < part.vertices ? base + corners_[i][k] : kNoVertex;
        };
        writer_.add_triangle(corner(0), corner(1), corner(2));
      }
      left -= count;
    }
    set_area(part.area);
    return true;
  }

  // Of all triangles that have no area kind yet.
  void set_area(int32_t kind) {
    if (kind > kAreaLast) ++unknown_kinds_;
    const bool known = kind >= 0 && kind <= kAreaLast;
    Scene& scene = writer_.scene();
    scene.area.resize(scene.triangles.size(), known ? static_cast<AreaKind>(kind) : kAreaWalkable);
  }

  std::string name_;
  SceneWriter writer_;
  RawScene raw_;
  uint64_t unknown_kinds_ = 0;
  std::vector<std::array<float, 3>> floats_{1 << 14};
  std::vector<std::array<uint32_t, 3>> corners_{1 << 14};
};

}  // namespace

Result<RawScene> read_with_assimp(const std::string& path, const ReadOptions& options,
                                  Context& context) {
  std::error_code failure;
  const uint64_t size = std::filesystem::file_size(path, failure);
  if (failure) return Error{Errc::kBadFile, path + ": no such file; check the path"};
  // Generous: a damaged small file may cost a second, never the machine.
  const ChildLimits limits{.bytes = (uint64_t{2} << 30) + 100 * size, .seconds = 5 + size / 20'000};
  Receiver receiver(options);
  const auto done = run_in_child(
      limits, context, [&](const PipeWriter& pipe) { read_and_send(path, pipe); },
      [&](PipeReader& pipe) { return receiver.receive(pipe); });
  if (receiver.too_large) {
    return Error{Errc::kLimit, path + ": more than 4.29 thousand million corners; split the file"};
  }
  if (!done && done.error().code == Errc::kBadFile) {
    return Error{Errc::kBadFile, fmt::format("{}: {}; export it again, or as another format", path,
                                             done.error().message)};
  }
  if (!done) return Error{done.error().code, path + ": " + done.error().message};
  if (!receiver.refused.empty()) {
    return Error{Errc::kBadFile, fmt::format("{}: {}; the file may be damaged or not of the format "
                                             "that its name says",
                                             path, receiver.refused)};
  }
  return receiver.finish();
}

}  // namespace throng
