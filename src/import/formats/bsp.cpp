// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/bsp.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "import/patches/patch_edges.h"

// Format: 17 lumps after a header of 8 bytes; little-endian 32-bit numbers throughout.
// Source: K. Proudfoot. Unofficial Quake 3 map specs. 2000; flags after the game's surfaceflags.h.
namespace throng::importer {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the reader copies little-endian numbers");

constexpr double kMetresPerUnit = 0.0254;
constexpr int32_t kBspVersion = 46;
// A damaged file can make many faces share the same corners, so the counts have a limit.
constexpr size_t kMaxVertices = 20'000'000;
constexpr size_t kMaxPatches = 500'000;

enum Lump {
  kEntities = 0,
  kTextures = 1,
  kModels = 7,
  kVertices = 10,
  kMeshVertices = 11,
  kFaces = 13,
  kLumps = 17
};

struct BspTexture {
  char name[64];
  int32_t surface;
  int32_t content;
};
struct Model {
  float low[3], high[3];
  int32_t face, face_count, brush, brush_count;
};
struct Vertex {
  float at[3];
  float unused[7];
  uint8_t colour[4];
};
struct Face {
  int32_t texture, effect, type, vertex, vertex_count, mesh_vertex, mesh_vertex_count;
  int32_t unused[14];
  float normal[3];
  int32_t size[2];
};
static_assert(sizeof(BspTexture) == 72 && sizeof(Model) == 40 && sizeof(Vertex) == 44 &&
              sizeof(Face) == 104);

enum FaceType { kPolygon = 1, kPatch = 2, kMesh = 3, kBillboard = 4 };

constexpr int32_t kContentSolid = 0x1;
constexpr int32_t kContentPlayerClip = 0x10000;
constexpr int32_t kContentTrigger = 0x40000000;
constexpr int32_t kSurfaceSky = 0x4;
constexpr int32_t kSurfaceHint = 0x100;
constexpr int32_t kSurfaceSkip = 0x200;
constexpr int32_t kSurfaceNonSolid = 0x4000;

bool is_solid(const BspTexture& texture) {
  if ((texture.content & kContentTrigger) != 0) return false;
  if ((texture.surface & (kSurfaceSky | kSurfaceHint | kSurfaceSkip | kSurfaceNonSolid)) != 0) {
    return false;
  }
  return (texture.content & (kContentSolid | kContentPlayerClip)) != 0;
}

class BspReader {
 public:
  BspReader(std::string_view bytes, const ReadOptions& options, Context& context)
      : bytes_(bytes), options_(options), context_(context), writer_(options) {}

  Result<RawScene> read() {
    if (!read_lumps()) return Error{Errc::kBadFile, options_.name + ": " + message_};
    for (size_t m = 0; m < models_.size(); ++m) {
      const Model& model = models_[m];
      const std::string node = m == 0 ? "worldspawn" : class_of_model(m);
      if (node.starts_with("trigger_")) continue;
      for (int64_t f = model.face; f < int64_t{model.face} + model.face_count; ++f) {
        if (context_.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
        if (f < 0 || f >= static_cast<int64_t>(faces_.size())) {
          writer_.count_bad(1);
          break;  // The rest of a bad range is bad as well, and may be huge.
        }
        if (faces_read_[static_cast<size_t>(f)]) continue;  // Models of a sound file share no face.
        faces_read_[static_cast<size_t>(f)] = true;
        read_face(faces_[static_cast<size_t>(f)], node);
        if (writer_.scene().positions.size() > kMaxVertices ||
            writer_.scene().patches.size() > kMaxPatches) {
          return Error{Errc::kLimit,
                       fmt::format("{}: gives more than {} vertices or {} patches; no level does, "
                                   "so the file is damaged",
                                   options_.name, kMaxVertices, kMaxPatches)};
        }
      }
    }
    if (left_out_ > 0) {
      writer_.warn(fmt::format("{}: left out {} faces that are not solid (water, sky, fog, marks)",
                               options_.name, left_out_));
    }
    auto scene = writer_.finish();
    if (!scene) return scene.error();
    bind_equal_edges(scene->patches, 0);
    return RawScene{.scene = *std::move(scene), .up = 'z', .metres_per_unit = kMetresPerUnit};
  }

 private:
  bool fail(std::string why) {
    message_ = std::move(why);
    return false;
  }

  bool read_lumps() {
    int32_t header[2 + 2 * kLumps];
    if (bytes_.size() < sizeof header) return fail("too short for a level's header");
    std::memcpy(header, bytes_.data(), sizeof header);
    if (bytes_.substr(0, 4) != "IBSP") {
      return fail("not a Quake 3 level: it does not begin with IBSP");
    }
    if (header[1] != kBspVersion) {
      return fail(
          fmt::format("level of version {}; only {} (Quake 3) is read", header[1], kBspVersion));
    }
    std::memcpy(lumps_, header + 2, sizeof lumps_);
    return read_lump(kTextures, "textures", textures_) && read_lump(kModels, "models", models_) &&
           read_lump(kVertices, "vertices", vertices_) &&
           read_lump(kMeshVertices, "mesh vertices", mesh_vertices_) &&
           read_lump(kFaces, "faces", faces_) && read_entities();
  }

  bool find_lump(Lump lump, const char* what, std::string_view& out) {
    const int64_t offset = lumps_[lump][0];
    const int64_t size = lumps_[lump][1];
    if (offset < 0 || size < 0 || offset + size > static_cast<int64_t>(bytes_.size())) {
      return fail(fmt::format("the lump of {} ends beyond the file; it is truncated", what));
    }
    out = bytes_.substr(static_cast<size_t>(offset), static_cast<size_t>(size));
    return true;
  }

  template <class T>
  bool read_lump(Lump lump, const char* what, std::vector<T>& out) {
    std::string_view data;
    if (!find_lump(lump, what, data)) return false;
    out.resize(data.size() / sizeof(T));
    if (!out.empty()) std::memcpy(out.data(), data.data(), out.size() * sizeof(T));
    return true;
  }

  // Entities are text: { "classname" "func_door" "model" "*3" ... }. Only these two keys matter.
  bool read_entities() {
    faces_read_.assign(faces_.size(), false);
    std::string_view text;
    if (!find_lump(kEntities, "entities", text)) return false;
    std::string_view key, class_name, model;
    bool has_key = false;
    for (size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '{') {
        class_name = model = {};
        has_key = false;
      } else if (text[i] == '}') {
        if (model.size() > 1 && model[0] == '*')
          model_classes_.emplace_back(model.substr(1), class_name);
      } else if (text[i] == '"') {
        const size_t end = text.find('"', i + 1);
        if (end == std::string_view::npos) break;
        const std::string_view word = text.substr(i + 1, end - i - 1);
        if (!has_key)
          key = word;
        else if (key == "classname")
          class_name = word;
        else if (key == "model")
          model = word;
        has_key = !has_key;
        i = end;
      }
    }
    return true;
  }

  std::string class_of_model(size_t index) const {
    const std::string number = std::to_string(index);
    for (const auto& [model, name] : model_classes_) {
      if (model == number) return std::string(name);
    }
    return "model";
  }

  void read_face(const Face& face, const std::string& node) {
    if (face.type == kBillboard) {
      writer_.count_points_and_lines(1);
      return;
    }
    const bool good =
        face.texture >= 0 && static_cast<size_t>(face.texture) < textures_.size() &&
        face.vertex >= 0 && face.vertex_count >= 0 &&
        int64_t{face.vertex} + face.vertex_count <= static_cast<int64_t>(vertices_.size());
    if (!good) {
      writer_.count_bad(1);
      return;
    }
    const BspTexture& texture = textures_[static_cast<size_t>(face.texture)];
    if (!is_solid(texture)) {
      ++left_out_;
      return;
    }
    const size_t name_size = strnlen(texture.name, sizeof texture.name);
    if (face.type == kPatch) {
      read_patch(face, node, {texture.name, name_size});
    } else if (face.type == kPolygon || face.type == kMesh) {
      writer_.begin_part(node, {texture.name, name_size});
      read_mesh(face);
    } else {
      writer_.count_bad(1);
    }
  }

  [[nodiscard]] Vec3d point(size_t index) const {
    const float* at = vertices_[index].at;
    return {at[0], at[1], at[2]};
  }

  void read_mesh(const Face& face) {
    if (face.mesh_vertex < 0 || face.mesh_vertex_count < 0 ||
        int64_t{face.mesh_vertex} + face.mesh_vertex_count >
            static_cast<int64_t>(mesh_vertices_.size())) {
      writer_.count_bad(1);
      return;
    }
    const uint32_t base = static_cast<uint32_t>(writer_.scene().positions.size());
    if (face.mesh_vertex_count < 3) return;
    for (int32_t i = 0; i < face.vertex_count; ++i) {
      writer_.add_vertex(point(static_cast<size_t>(face.vertex) + i));
    }
    const int32_t* corner = mesh_vertices_.data() + face.mesh_vertex;
    for (int32_t i = 0; i + 2 < face.mesh_vertex_count; i += 3) {
      const auto index = [&](int k) {
        const int32_t local = corner[i + k];
        return local >= 0 && local < face.vertex_count ? base + static_cast<uint32_t>(local)
                                                       : kNoVertex;
      };
      writer_.add_triangle(index(0), index(1), index(2));
    }
  }

  void read_patch(const Face& face, std::string_view node, std::string_view material) {
    const int64_t columns = face.size[0];
    const int64_t rows = face.size[1];
    if (columns < 3 || rows < 3 || columns % 2 == 0 || rows % 2 == 0 || columns > 1024 ||
        rows > 1024 || columns * rows > face.vertex_count) {
      writer_.count_bad(1);
      return;
    }
    std::vector<Vec3d> grid;
    for (int64_t i = 0; i < columns * rows; ++i) {
      grid.push_back(point(static_cast<size_t>(face.vertex + i)));
      const Vec3d& p = grid.back();
      if (std::fabs(p.x) < 1e9 && std::fabs(p.y) < 1e9 && std::fabs(p.z) < 1e9) continue;
      writer_.count_bad(1);  // Also NaN.
      return;
    }
    // Each 3 x 3 piece is a patch; neighbouring pieces share their border, and so do many faces.
    PatchSet& patches = writer_.scene().patches;
    patches.begin_run(options_.name, node, material);
    for (int64_t j = 0; j + 2 < rows; j += 2) {
      for (int64_t i = 0; i + 2 < columns; i += 2) {
        std::array<Vec3d, 9> piece;
        for (int64_t k = 0; k < 9; ++k) {
          piece[static_cast<size_t>(k)] =
              grid[static_cast<size_t>((j + k / 3) * columns + i + k % 3)];
        }
        patches.add(raise_degree(2, 2, piece));
      }
    }
  }

  std::string_view bytes_;
  const ReadOptions& options_;
  Context& context_;
  SceneWriter writer_;
  std::string message_;
  int32_t lumps_[kLumps][2] = {};
  std::vector<BspTexture> textures_;
  std::vector<Model> models_;
  std::vector<Vertex> vertices_;
  std::vector<int32_t> mesh_vertices_;
  std::vector<Face> faces_;
  std::vector<bool> faces_read_;
  std::vector<std::pair<std::string_view, std::string_view>> model_classes_;
  uint64_t left_out_ = 0;
};

}  // namespace

Result<RawScene> read_bsp(std::string_view bytes, const ReadOptions& options, Context& context) {
  return BspReader(bytes, options, context).read();
}

}  // namespace throng::importer
