// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Khronos Group. glTF 2.0 Specification. 2021. Every number of the file is checked before it is
// used; a value that is missing or of another type counts as its default, or as a fault if it has
// no default.
namespace throng::importer {
namespace {

using Json = nlohmann::json;

constexpr uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr size_t kDeepestNode = 256;           // Nodes below nodes.

enum Component : uint64_t { kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126 };

// An element of an array of the file, or nothing.
const Json* element_of(const Json& file, const char* array, uint64_t index) {
  const auto found = file.find(array);
  if (found == file.end() || !found->is_array() || index >= found->size()) return nullptr;
  const Json& one = (*found)[static_cast<size_t>(index)];
  return one.is_object() ? &one : nullptr;
}

std::optional<uint64_t> whole(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number_unsigned()) return std::nullopt;
  return found->get<uint64_t>();
}

std::string words(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// `count` numbers under a name, or nothing.
template <size_t kCount>
std::optional<std::array<double, kCount>> numbers(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array() || found->size() != kCount) return std::nullopt;
  std::array<double, kCount> out;
  for (size_t i = 0; i < kCount; ++i) {
    if (!(*found)[i].is_number()) return std::nullopt;
    out[i] = (*found)[i].template get<double>();
  }
  return out;
}

Transform product(const Transform& a, const Transform& b) {
  Transform out;
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 4; ++c) {
      out.m[r][c] = a.m[r][0] * b.m[0][c] + a.m[r][1] * b.m[1][c] + a.m[r][2] * b.m[2][c] +
                    (c == 3 ? a.m[r][3] : 0);
    }
  }
  return out;
}

// Column by column as a matrix, or scaled, then turned by a quaternion, then moved.
Transform placement_of(const Json& node) {
  Transform out;
  if (const auto m = numbers<16>(node, "matrix")) {
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 4; ++c) out.m[r][c] = (*m)[c * 4 + r];
    }
    return out;
  }
  const auto t = numbers<3>(node, "translation").value_or(std::array<double, 3>{0, 0, 0});
  const auto s = numbers<3>(node, "scale").value_or(std::array<double, 3>{1, 1, 1});
  const auto [x, y, z, w] =
      numbers<4>(node, "rotation").value_or(std::array<double, 4>{0, 0, 0, 1});
  const std::array<std::array<double, 3>, 3> turn{
      {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
       {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
       {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) out.m[r][c] = turn[r][c] * s[c];
    out.m[r][3] = t[r];
  }
  return out;
}

// The elements of an accessor as they lie in the binary chunk.
struct Elements {
  const char* first = nullptr;
  uint64_t count = 0, stride = 0;
  uint64_t component = 0;

  template <class T>
  [[nodiscard]] T at(uint64_t i, uint64_t part = 0) const {
    T value;
    std::memcpy(&value, first + i * stride + part * sizeof(T), sizeof value);
    return value;
  }
  [[nodiscard]] uint32_t index(uint64_t i) const {
    if (component == kByte) return at<uint8_t>(i);
    return component == kShort ? at<uint16_t>(i) : at<uint32_t>(i);
  }
};

class GlbReader {
 public:
  explicit GlbReader(const ReadOptions& options)
      : name_(options.name),
        has_materials_(options.materials == SceneMaterials::kRead),
        writer_(options) {}

  Result<RawScene> read(std::string_view bytes, Context& context) {
    if (auto ok = read_chunks(bytes); !ok) return ok.error();
    if (has_materials_) read_materials();
    const Json* scene = element_of(file_, "scenes", whole(file_, "scene").value_or(0));
    const auto roots = scene == nullptr ? Json() : scene->value("nodes", Json());
    if (!roots.is_array()) return bad("names no scene with nodes");
    for (const Json& root : roots) {
      if (!root.is_number_unsigned()) return bad("names a node that does not exist");
      if (auto ok = read_node(root.get<uint64_t>(), {}, 0, context); !ok) return ok.error();
    }
    auto made = writer_.finish();
    if (!made) return made.error();
    RawScene raw{.scene = *std::move(made), .up = 'y', .metres_per_unit = 1};
    raw.scene.materials = std::move(materials_);
    raw.textures = std::move(textures_);
    return raw;
  }

 private:
  // What a node passes to its children.
  struct Above {
    Transform place;
    std::string path;
    AreaKind area = kAreaWalkable;
  };

  [[nodiscard]] Error bad(const std::string& why) const {
    return {Errc::kBadFile,
            fmt::format("{}: {}; export it again as GLB, without compression", name_, why)};
  }

  static uint32_t word_at(std::string_view bytes, size_t at) {
    uint32_t word;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
  }

  Result<void> read_chunks(std::string_view bytes) {
    static_assert(std::endian::native == std::endian::little, "glTF is little-endian");
    if (bytes.size() < 20 || word_at(bytes, 0) != kMagic || word_at(bytes, 4) != 2) {
      return bad("is no GLB of version 2");
    }
    for (size_t at = 12; at + 8 <= bytes.size();) {
      const uint64_t size = word_at(bytes, at);
      const uint32_t kind = word_at(bytes, at + 4);
      if (size > bytes.size() - at - 8) return bad("ends in the middle of a chunk");
      const std::string_view chunk = bytes.substr(at + 8, static_cast<size_t>(size));
      if (kind == kJsonChunk && file_.is_null()) {
        file_ = Json::parse(chunk, nullptr, /*allow_exceptions=*/false);
      } else if (kind == kBinaryChunk && binary_.empty()) {
        binary_ = chunk;
      }
      at += 8 + static_cast<size_t>(size);
    }
    if (!file_.is_object()) return bad("its first chunk is no JSON object");
    const auto required = file_.find("extensionsRequired");
    if (required != file_.end() && required->is_array() && !required->empty()) {
      const Json& first = required->front();
      return bad("needs " + (first.is_string() ? first.get<std::string>() : "an extension") +
                 ", which is not read here");
    }
    return {};
  }

  // Materials that cannot be read are left out; the triangles are read in any case.
  void read_materials() {
    const auto materials = file_.find("materials");
    if (materials == file_.end() || !materials->is_array()) return;
    std::vector<uint32_t> numbers1;  // Of images.
    for (const Json& one : *materials) {
      Material& out = materials_.emplace_back();
      if (!one.is_object()) continue;
      out.name = words(one, "name");
      const std::string mode = words(one, "alphaMode");
      if (mode == "MASK") out.opacity = Opacity::kHoles;
      if (mode == "BLEND") out.opacity = Opacity::kBlended;
      const auto limit = one.find("alphaCutoff");
      if (limit != one.end() && limit->is_number()) {
        out.threshold = static_cast<float>(std::clamp(limit->get<double>(), 0.0, 1.0));
      }
      const auto pbr = one.find("pbrMetallicRoughness");
      if (pbr == one.end() || !pbr->is_object()) continue;
      if (const auto colour = numbers<4>(*pbr, "baseColorFactor")) {
        for (size_t c = 0; c < 4; ++c) {
          out.colour[c] = static_cast<float>(std::clamp((*colour)[c], 0.0, 1.0));
        }
      }
      const auto texture = pbr->find("baseColorTexture");
      if (texture == pbr->end() || !texture->is_object()) continue;
      const Json* found = element_of(file_, "textures", whole(*texture, "index").value_or(~0ULL));
      if (found == nullptr) continue;
      out.texture1 = image1(whole(*found, "source").value_or(~0ULL), numbers1);
      texture_set_.resize(materials_.size(), 0);
      texture_set_.back() = whole(*texture, "texCoord").value_or(0);
    }
    texture_set_.resize(materials_.size(), 0);
  }

  // Number of an image of the file among textures_, 0 if there is no such image.
  uint32_t image1(uint64_t index, std::vector<uint32_t>& numbers1) {
    const Json* image = element_of(file_, "images", index);
    if (image == nullptr) return 0;
    if (numbers1.size() <= index) numbers1.resize(static_cast<size_t>(index) + 1, 0);
    uint32_t& number1 = numbers1[static_cast<size_t>(index)];
    if (number1 != 0) return number1;
    TextureSource source{.name = words(*image, "name"), .bytes = {}};
    const Json* view =
        element_of(file_, "bufferViews", whole(*image, "bufferView").value_or(~0ULL));
    if (view != nullptr && whole(*view, "buffer").value_or(0) == 0) {
      const uint64_t from = whole(*view, "byteOffset").value_or(0);
      const uint64_t length = whole(*view, "byteLength").value_or(0);
      if (from <= binary_.size() && length <= binary_.size() - from) {
        source.bytes = binary_.substr(static_cast<size_t>(from), static_cast<size_t>(length));
      }
      if (source.name.empty()) source.name = "image " + std::to_string(index);
      if (source.bytes.empty()) source.bytes = "none";  // Not a file of that name.
    } else {
      source.name = words(*image, "uri");
      if (source.name.starts_with("data:")) return 0;
    }
    textures_.push_back(std::move(source));
    return number1 = static_cast<uint32_t>(textures_.size());
  }

  Result<void> read_node(uint64_t index, const Above& above, size_t deep, Context& context) {
    const Json* node = element_of(file_, "nodes", index);
    if (node == nullptr) return bad("names a node that does not exist");
    if (deep > kDeepestNode) return bad("has more than 256 nodes below each other");
    // Each node is visited once, so that a small file cannot expand without limit.
    if (been_.size() <= index) been_.resize(static_cast<size_t>(index) + 1);
    if (been_[static_cast<size_t>(index)]) return bad("has a node below two others, or itself");
    been_[static_cast<size_t>(index)] = true;
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    Above here{product(above.place, placement_of(*node)), above.path, above.area};
    const std::string name = words(*node, "name");
    if (!name.empty()) here.path += (here.path.empty() ? "" : "/") + name;
    const auto extras = node->find("extras");
    if (extras != node->end() && extras->is_object()) {
      const auto area = extras->find("area");
      const double kind = area != extras->end() && area->is_number() ? area->get<double>() : -1;
      if (kind >= 0) here.area = kind <= kAreaLast ? static_cast<AreaKind>(kind) : kAreaWalkable;
    }
    if (const auto mesh = whole(*node, "mesh")) {
      if (auto ok = read_mesh(*mesh, here); !ok) return ok;
    }
    const auto children = node->find("children");
    if (children == node->end() || !children->is_array()) return {};
    for (const Json& child : *children) {
      if (!child.is_number_unsigned()) return bad("names a node that does not exist");
      if (auto ok = read_node(child.get<uint64_t>(), here, deep + 1, context); !ok) return ok;
    }
    return {};
  }

  Result<void> read_mesh(uint64_t index, const Above& here) {
    const Json* mesh = element_of(file_, "meshes", index);
    const auto parts = mesh == nullptr ? Json() : mesh->value("primitives", Json());
    if (!parts.is_array()) return bad("names a mesh that does not exist");
    for (const Json& part : parts) {
      if (!part.is_object()) return bad("has a mesh without triangles");
      const auto attributes = part.find("attributes");
      if (attributes == part.end() || !attributes->is_object()) continue;
      const auto positions = whole(*attributes, "POSITION");
      if (!positions) continue;
      const auto corners = elements(*positions, "VEC3", 12);
      if (!corners || corners->component != kFloat)
        return bad("has positions that it does not hold");
      std::optional<Elements> order;
      if (const auto indices = whole(part, "indices")) {
        order = elements(*indices, "SCALAR", 0);
        if (!order || order->component == kFloat) return bad("has indices that it does not hold");
      }
      std::string material;
      uint32_t material1 = 0;
      std::optional<Elements> places;
      if (const auto number = whole(part, "material")) {
        const Json* found = element_of(file_, "materials", *number);
        if (found != nullptr) material = words(*found, "name");
        if (*number < materials_.size()) {
          material1 = static_cast<uint32_t>(*number) + 1;
          places = texture_places(*attributes, material1);
        }
      }
      writer_.begin_part(here.path.empty() ? words(*mesh, "name") : here.path, material, material1);
      add_part(*corners, order, places, whole(part, "mode").value_or(4), here);
    }
    return {};
  }

  std::optional<Elements> texture_places(const Json& attributes, uint32_t material1) const {
    if (materials_[material1 - 1].texture1 == 0) return std::nullopt;
    const std::string name = "TEXCOORD_" + std::to_string(texture_set_[material1 - 1]);
    const auto number = whole(attributes, name.c_str());
    return number ? elements(*number, "VEC2", 0, 2) : std::nullopt;
  }

  // Of a corner; whole numbers stand for shares.
  static std::array<float, 2> place_at(const Elements& places, uint64_t i) {
    if (i >= places.count) return {};
    if (places.component == kFloat) return {places.at<float>(i, 0), places.at<float>(i, 1)};
    if (places.component == kByte) {
      return {static_cast<float>(places.at<uint8_t>(i, 0)) / 255.0F,
              static_cast<float>(places.at<uint8_t>(i, 1)) / 255.0F};
    }
    return {static_cast<float>(places.at<uint16_t>(i, 0)) / 65535.0F,
            static_cast<float>(places.at<uint16_t>(i, 1)) / 65535.0F};
  }

  void add_part(const Elements& corners, const std::optional<Elements>& order,
                const std::optional<Elements>& places, uint64_t mode, const Above& here) {
    const uint64_t count = order ? order->count : corners.count;
    if (mode < 4) {
      writer_.count_points_and_lines(count);
      return;
    }
    const auto base = static_cast<uint32_t>(writer_.scene().positions.size());
    for (uint64_t i = 0; i < corners.count && !writer_.full(); ++i) {
      writer_.add_vertex(
          here.place({corners.at<float>(i, 0), corners.at<float>(i, 1), corners.at<float>(i, 2)}));
    }
    const auto corner = [&](uint64_t i) {
      const uint64_t index = order ? order->index(i) : i;
      return index < corners.count ? base + static_cast<uint32_t>(index) : kNoVertex;
    };
    // Triangles, strips or fans.
    const uint64_t step = mode == 4 ? 3 : 1;
    for (uint64_t i = 0; i + 3 <= count && !writer_.full(); i += step) {
      const bool odd = mode == 5 && i % 2 == 1;
      const uint64_t a = mode == 6 ? 0 : odd ? i + 1 : i, b = odd ? i : i + 1;
      writer_.add_triangle(corner(a), corner(b), corner(i + 2));
      if (!places) continue;
      const auto place = [&](uint64_t k) { return place_at(*places, order ? order->index(k) : k); };
      writer_.set_texture_corners({place(a), place(b), place(i + 2)});
    }
    writer_.scene().area.resize(writer_.scene().triangles.size(), here.area);
  }

  // Nothing if the file does not hold them.
  std::optional<Elements> elements(uint64_t number, const char* type, uint64_t min_stride,
                                   uint64_t parts = 1) const {
    const Json* accessor = element_of(file_, "accessors", number);
    if (accessor == nullptr || words(*accessor, "type") != type || accessor->contains("sparse")) {
      return std::nullopt;
    }
    const Json* view =
        element_of(file_, "bufferViews", whole(*accessor, "bufferView").value_or(~0ULL));
    if (view == nullptr || whole(*view, "buffer").value_or(0) != 0) return std::nullopt;
    Elements out;
    out.component = whole(*accessor, "componentType").value_or(0);
    const uint64_t size = out.component == kByte                             ? 1
                          : out.component == kShort                          ? 2
                          : out.component == kInt || out.component == kFloat ? 4
                                                                             : 0;
    if (size == 0) return std::nullopt;
    const uint64_t whole_size = std::max(size * parts, min_stride);
    out.count = whole(*accessor, "count").value_or(0);
    out.stride = whole(*view, "byteStride").value_or(whole_size);
    const uint64_t from = whole(*view, "byteOffset").value_or(0);
    const uint64_t length = whole(*view, "byteLength").value_or(0);
    const uint64_t at = whole(*accessor, "byteOffset").value_or(0);
    if (from > binary_.size() || length > binary_.size() - from || at > length ||
        out.stride < whole_size || out.stride > 252 || out.count > binary_.size()) {
      return std::nullopt;
    }
    if (out.count > 0 && (out.count - 1) * out.stride + whole_size > length - at) {
      return std::nullopt;
    }
    out.first = binary_.data() + from + at;
    return out;
  }

  std::string name_;
  bool has_materials_;
  SceneWriter writer_;
  std::vector<Material> materials_;
  std::vector<uint64_t> texture_set_;  // By material.
  std::vector<TextureSource> textures_;
  Json file_;
  std::string_view binary_;
  std::vector<bool> been_;  // By node.
};

}  // namespace

Result<RawScene> read_glb(std::string_view bytes, const ReadOptions& options, Context& context) {
  return GlbReader(options).read(bytes, context);
}

}  // namespace throng::importer
