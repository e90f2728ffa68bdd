// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/assimp_reader.h"

#include <assimp/GltfMaterial.h>
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

#include "import/raw/child_process.h"

// assimp parses untrusted files with raw pointers, and some files crash it, loop in it or make it
// take all memory. So it runs in a child process, which sends mesh by mesh and frees each one that
// is sent. The parent checks every count, index and number itself.
namespace throng::importer {
namespace {

enum class Tag : uint32_t { kConvention = 1, kMaterial, kTexture, kPart, kThin, kRefused, kDone };

struct Message {
  Tag tag = Tag::kDone;
  uint32_t node_size = 0;      // Of kPart; the text's of kRefused.
  uint32_t material_size = 0;  // Of kPart; the up axis of kConvention.
  int32_t area = -1;           // Of kPart; kNoArea if the file does not say.
  uint64_t vertices = 0;       // Of kPart; the count of kThin.
  uint64_t triangles = 0;
  double metres_per_unit = 1;
  uint32_t material1 = 0;   // Of kPart; the texture of kMaterial.
  uint32_t has_places = 0;  // Of kPart: where in its texture each vertex is.
};

// What follows a kMaterial, before its name. A kTexture is followed by its name and `vertices`
// bytes; `triangles` holds width and height where they are texels.
struct MaterialMessage {
  std::array<float, 4> colour{};
  float threshold = 0.5F;
  uint32_t opacity = 0;
};

constexpr uint64_t kMaxTextures = 1 << 16;
constexpr uint64_t kMaxTextureBytes = uint64_t{1} << 30;  // Of all that a file holds.
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
        break;  // Text, for example.
    }
  }
  return above;
}

class Sender {
 public:
  Sender(aiScene& scene, const std::string& path, SceneMaterials materials, const PipeWriter& pipe)
      : scene_(scene),
        pipe_(pipe),
        has_materials_(materials == SceneMaterials::kRead),
        extension_(std::filesystem::path(path).extension().string()) {
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
    if (has_materials_) send_materials();
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

  void send_materials() {
    texture_sets_.assign(scene_.mNumMaterials, -1);
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) send_material(i);
    for (const auto& [name, index] : textures_) send_texture(name, index);
  }

  void send_material(unsigned index) {
    const aiMaterial& material = *scene_.mMaterials[index];
    const bool is_gltf = has_areas_;
    MaterialMessage out{.colour = {1, 1, 1, 1}};
    aiColor4D colour(1, 1, 1, 1);
    if (!is_gltf || material.Get(AI_MATKEY_BASE_COLOR, colour) != aiReturn_SUCCESS) {
      material.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
    }
    const float parts[3] = {colour.r, colour.g, colour.b};
    // Other formats store colours as a screen shows them; their squares are nearly linear light.
    for (size_t c = 0; c < 3; ++c) {
      const float part = parts[c] > 0 ? std::min(parts[c], 1.0F) : 0.0F;
      out.colour[c] = is_gltf ? part : part * part;
    }
    uint32_t texture1 = 0;
    aiString path;
    for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
      if (texture1 != 0 || material.GetTexture(type, 0, &path) != aiReturn_SUCCESS) continue;
      texture1 = texture_number1(path.C_Str());
      int set = 0;
      material.Get(AI_MATKEY_UVWSRC(type, 0), set);
      texture_sets_[index] = texture1 != 0 ? std::max(set, 0) : -1;
    }
    const bool is_black = std::max({out.colour[0], out.colour[1], out.colour[2]}) < 0.02F;
    if (texture1 != 0 && is_black && !is_gltf) out.colour = {1, 1, 1, 1};
    float opaque = is_gltf ? colour.a : 1;
    if (!is_gltf) material.Get(AI_MATKEY_OPACITY, opaque);
    // A file that confuses opacity with transparency would show nothing.
    if (!(opaque > 0.01F && opaque < 1)) opaque = 1;
    if (opaque < 1) out.opacity = static_cast<uint32_t>(Opacity::kBlended);
    if (is_gltf) {
      aiString mode;
      material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode);
      material.Get(AI_MATKEY_GLTF_ALPHACUTOFF, out.threshold);
      const std::string_view word = mode.C_Str();
      out.opacity = static_cast<uint32_t>(word == "MASK"    ? Opacity::kHoles
                                          : word == "BLEND" ? Opacity::kBlended
                                                            : Opacity::kOpaque);
    } else if (texture1 != 0 && material.GetTextureCount(aiTextureType_OPACITY) > 0) {
      out.opacity = static_cast<uint32_t>(Opacity::kHoles);
    }
    out.colour[3] = opaque;
    std::string name = material.GetName().C_Str();
    name.resize(std::min<size_t>(name.size(), kLongestText));
    Message message{.tag = Tag::kMaterial, .material1 = texture1};
    message.node_size = static_cast<uint32_t>(name.size());
    pipe_.write(&message, sizeof message);
    pipe_.write(&out, sizeof out);
    pipe_.write(name.data(), name.size());
  }

  // Equal names are one texture. A texture that the file holds is named by its number or its name.
  uint32_t texture_number1(const std::string& name) {
    for (size_t i = 0; i < textures_.size(); ++i) {
      if (textures_[i].first == name) return static_cast<uint32_t>(i + 1);
    }
    if (name.empty() || textures_.size() >= kMaxTextures) return 0;
    const aiTexture* embedded = scene_.GetEmbeddedTexture(name.c_str());
    textures_.emplace_back(name, embedded);
    return static_cast<uint32_t>(textures_.size());
  }

  void send_texture(std::string name, const aiTexture* embedded) {
    name.resize(std::min<size_t>(name.size(), kLongestText));
    Message message{.tag = Tag::kTexture, .node_size = static_cast<uint32_t>(name.size())};
    const bool is_texels = embedded != nullptr && embedded->mHeight > 0;
    if (embedded != nullptr && embedded->pcData != nullptr) {
      message.vertices =
          is_texels ? uint64_t{embedded->mWidth} * embedded->mHeight * 4 : embedded->mWidth;
      if (is_texels) message.triangles = uint64_t{embedded->mHeight} << 32 | embedded->mWidth;
    }
    texture_bytes_ += message.vertices;
    if (texture_bytes_ > kMaxTextureBytes) message.vertices = message.triangles = 0;
    pipe_.write(&message, sizeof message);
    pipe_.write(name.data(), name.size());
    if (message.vertices == 0) return;
    if (!is_texels) {
      pipe_.write(embedded->pcData, message.vertices);
      return;
    }
    std::vector<uint8_t> row(size_t{embedded->mWidth} * 4);
    for (unsigned y = 0; y < embedded->mHeight; ++y) {
      for (unsigned x = 0; x < embedded->mWidth; ++x) {
        const aiTexel& t = embedded->pcData[size_t{y} * embedded->mWidth + x];
        const uint8_t rgba[4] = {t.r, t.g, t.b, t.a};
        std::copy_n(rgba, 4, row.begin() + std::ptrdiff_t{x} * 4);
      }
      pipe_.write(row.data(), row.size());
    }
  }

  // Of a mesh, if its material has a texture.
  [[nodiscard]] const aiVector3D* places_of(const aiMesh& mesh) const {
    if (!has_materials_ || mesh.mMaterialIndex >= texture_sets_.size()) return nullptr;
    if (texture_sets_[mesh.mMaterialIndex] < 0) return nullptr;
    const auto set = static_cast<size_t>(texture_sets_[mesh.mMaterialIndex]);
    if (set < AI_MAX_NUMBER_OF_TEXTURECOORDS && mesh.mTextureCoords[set] != nullptr) {
      return mesh.mTextureCoords[set];
    }
    return mesh.mTextureCoords[0];
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
    const aiVector3D* places = part.vertices > 0 ? places_of(mesh) : nullptr;
    part.has_places = places != nullptr ? 1 : 0;
    if (has_materials_ && mesh.mMaterialIndex < scene_.mNumMaterials) {
      part.material1 = mesh.mMaterialIndex + 1;
    }
    pipe_.write(&part, sizeof part);
    pipe_.write(node.data(), node.size());
    pipe_.write(material.data(), material.size());
    const double rows[12] = {m.a1, m.a2, m.a3, m.a4, m.b1, m.b2,
                             m.b3, m.b4, m.c1, m.c2, m.c3, m.c4};
    pipe_.write(rows, sizeof rows);
    static_assert(sizeof(aiVector3D) == 3 * sizeof(float), "assimp built with double precision");
    pipe_.write(mesh.mVertices, part.vertices * sizeof(aiVector3D));
    if (places != nullptr) pipe_.write(places, part.vertices * sizeof(aiVector3D));
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
  bool has_materials_;
  std::string extension_;
  bool has_areas_ = false;  // In other formats "area" means something else.
  std::vector<uint32_t> uses_;
  std::vector<int> texture_sets_;  // By material, -1: it has no texture.
  std::vector<std::pair<std::string, const aiTexture*>> textures_;
  uint64_t texture_bytes_ = 0;
  uint64_t thin_ = 0;
};

void refuse(const PipeWriter& pipe, std::string why) {
  why.resize(std::min<size_t>(why.size(), 1000));
  Message message{.tag = Tag::kRefused};
  message.node_size = static_cast<uint32_t>(why.size());
  pipe.write(&message, sizeof message);
  pipe.write(why.data(), why.size());
}

void read_and_send(const std::string& path, SceneMaterials materials, const PipeWriter& pipe) {
  try {
    auto* importer = new Assimp::Importer;  // Never destroyed: the child ends by _exit.
    const int of_materials =
        materials == SceneMaterials::kRead ? 0 : aiComponent_TEXCOORDS | aiComponent_TEXTURES;
    importer->SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                                 aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                     aiComponent_COLORS | aiComponent_BONEWEIGHTS |
                                     aiComponent_ANIMATIONS | aiComponent_LIGHTS |
                                     aiComponent_CAMERAS | of_materials);
    const aiScene* read =
        importer->ReadFile(path, aiProcess_Triangulate | aiProcess_RemoveComponent);
    if (read == nullptr) {
      refuse(pipe, importer->GetErrorString());
      return;
    }
    aiScene* scene = importer->GetOrphanedScene();
    Sender(*scene, path, materials, pipe).send();
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
        case Tag::kMaterial:
          if (!receive_material(pipe, message)) return false;
          break;
        case Tag::kTexture:
          if (!receive_texture(pipe, message)) return false;
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
    raw_.scene.materials = std::move(materials_);
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

  bool receive_material(PipeReader& pipe, const Message& message) {
    MaterialMessage body;
    Material material;
    if (!pipe.read(&body, sizeof body) || !receive_text(pipe, message.node_size, material.name) ||
        body.opacity > static_cast<uint32_t>(Opacity::kBlended)) {
      return false;
    }
    material.colour = body.colour;
    material.threshold = body.threshold;
    material.opacity = static_cast<Opacity>(body.opacity);
    material.texture1 = message.material1;
    materials_.push_back(std::move(material));
    return true;
  }

  bool receive_texture(PipeReader& pipe, const Message& message) {
    TextureSource source;
    if (!receive_text(pipe, message.node_size, source.name)) return false;
    texture_bytes_ += message.vertices;
    if (raw_.textures.size() >= kMaxTextures || message.vertices > kMaxTextureBytes ||
        texture_bytes_ > kMaxTextureBytes) {
      return false;
    }
    source.bytes.resize(static_cast<size_t>(message.vertices));
    if (!pipe.read(source.bytes.data(), source.bytes.size())) return false;
    source.width = static_cast<int32_t>(message.triangles & 0x7fffffff);
    source.height = static_cast<int32_t>(message.triangles >> 32 & 0x7fffffff);
    raw_.textures.push_back(std::move(source));
    return true;
  }

  // assimp counts up from the lower edge.
  bool receive_places(PipeReader& pipe, uint64_t vertices) {
    places_.clear();
    for (uint64_t left = vertices; left > 0;) {
      const size_t count = std::min<uint64_t>(left, floats_.size());
      if (!pipe.read(floats_.data(), count * sizeof floats_[0])) return false;
      for (size_t i = 0; i < count; ++i) places_.push_back({floats_[i][0], 1 - floats_[i][1]});
      left -= count;
    }
    return true;
  }

  bool receive_part(PipeReader& pipe, const Message& part) {
    std::string node, material;
    Transform place;
    if (!receive_text(pipe, part.node_size, node)) return false;
    if (!receive_text(pipe, part.material_size, material)) return false;
    if (!pipe.read(place.m.data(), sizeof place.m)) return false;
    writer_.begin_part(node, material, part.material1 <= materials_.size() ? part.material1 : 0);
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
    if (part.has_places != 0 && !receive_places(pipe, part.vertices)) return false;
    for (uint64_t left = part.triangles; left > 0;) {
      const size_t count = std::min<uint64_t>(left, corners_.size());
      if (!pipe.read(corners_.data(), count * sizeof corners_[0])) return false;
      for (size_t i = 0; i < count; ++i) {
        const auto corner = [&](int k) {  // An index into another mesh is as bad as none.
          return corners_[i][k] < part.vertices ? base + corners_[i][k] : kNoVertex;
        };
        writer_.add_triangle(corner(0), corner(1), corner(2));
        if (part.has_places == 0) continue;
        const auto texture_place = [&](int k) {
          return corners_[i][k] < part.vertices ? places_[corners_[i][k]] : std::array<float, 2>{};
        };
        writer_.set_texture_corners({texture_place(0), texture_place(1), texture_place(2)});
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
  uint64_t texture_bytes_ = 0;
  std::vector<Material> materials_;
  std::vector<std::array<float, 2>> places_;
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
      limits, context,
      [&](const PipeWriter& pipe) { read_and_send(path, options.materials, pipe); },
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

}  // namespace throng::importer
