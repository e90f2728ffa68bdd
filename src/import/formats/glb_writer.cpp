// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "import/raw/name_colour.h"
#include "import/raw/scene_output.h"
#include "throng/scene.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

// Writes binary glTF 2.0 (Khronos, 2017). Three passes over each run of triangles: the first
// measures, so that the header can be written first; the second writes corners, the third indices.
// Only a renumbering of the corners is kept: four bytes a corner, however large the file is. Runs
// with a texture share no corners, because neighbours may have other texture coordinates.
namespace throng {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr uint32_t kUnset = UINT32_MAX;

// Triangles of one part and one area kind: one mesh of the file.
struct Run {
  std::string_view node;
  std::string_view material;
  uint32_t material1 = 0;
  bool textured = false;
  AreaKind kind = kAreaWalkable;
  uint32_t first = 0;
  uint32_t count = 0;
  uint32_t corners = 0;
  Vec3d origin{};  // Of the run's node; corners are stored relative to it.
  std::array<float, 3> min{};
  std::array<float, 3> max{};
};

std::vector<Run> split_into_runs(const Scene& scene) {
  std::vector<Run> runs;
  const auto total = static_cast<uint32_t>(scene.triangles.size());
  const auto kind_of = [&](uint32_t t) {
    return t < scene.area.size() ? scene.area[t] : kAreaWalkable;
  };
  const auto add = [&](std::string_view node, std::string_view material, uint32_t material1,
                       uint32_t from, uint32_t to) {
    if (material1 > scene.materials.size()) material1 = 0;
    const bool textured = material1 > 0 && scene.materials[material1 - 1].texture1 > 0 &&
                          scene.materials[material1 - 1].texture1 <= scene.textures.size() &&
                          scene.texture_corners.size() == total;
    while (from < to) {
      uint32_t end = from + 1;
      while (end < to && kind_of(end) == kind_of(from)) ++end;
      runs.push_back({.node = node,
                      .material = material,
                      .material1 = material1,
                      .textured = textured,
                      .kind = kind_of(from),
                      .first = from,
                      .count = end - from});
      from = end;
    }
  };
  uint32_t at = 0;
  for (const ScenePart& part : scene.parts) {
    const uint32_t from = std::clamp(part.first_triangle, at, total);
    const auto to = static_cast<uint32_t>(std::clamp<uint64_t>(
        static_cast<uint64_t>(part.first_triangle) + part.triangle_count, from, total));
    add("scene", "surface", 0, at, from);  // Triangles that no part names.
    add(part.node, part.material, part.material1, from, to);
    at = to;
  }
  add("scene", "surface", 0, at, total);
  return runs;
}

// Numbers the corners of one run in the order of their first use.
class Renumbering {
 public:
  explicit Renumbering(const Scene& scene)
      : scene_(scene), number_(scene.positions.size(), kUnset) {}
  void start(const Run& run) {
    for (const uint32_t corner : used_) number_[corner] = kUnset;
    used_.clear();
    for (uint32_t t = run.first; t < run.first + run.count; ++t) {
      for (const uint32_t corner : scene_.triangles[t]) {
        if (number_[corner] != kUnset) continue;
        number_[corner] = static_cast<uint32_t>(used_.size());
        used_.push_back(corner);
      }
    }
  }
  [[nodiscard]] const std::vector<uint32_t>& used() const { return used_; }
  [[nodiscard]] uint32_t operator[](uint32_t corner) const { return number_[corner]; }

 private:
  const Scene& scene_;
  std::vector<uint32_t> number_;
  std::vector<uint32_t> used_;
};

std::array<float, 3> local_corner(const Scene& scene, const Run& run, uint32_t corner) {
  const Vec3d p = scene.positions[corner] - run.origin;
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

void measure(const Scene& scene, Renumbering& order, Run& run) {
  order.start(run);
  run.corners = run.textured ? 3 * run.count : static_cast<uint32_t>(order.used().size());
  Box3d box;
  for (const uint32_t corner : order.used()) box.add(scene.positions[corner]);
  // Near the origin floats are precise enough. Whole metres are exact as floats, too.
  const auto origin = [](double low, double high) {
    return std::fmax(std::fabs(low), std::fabs(high)) <= 256 ? 0 : std::floor((low + high) / 2);
  };
  run.origin = {origin(box.min.x, box.max.x), origin(box.min.y, box.max.y),
                origin(box.min.z, box.max.z)};
  run.min.fill(std::numeric_limits<float>::infinity());
  run.max.fill(-std::numeric_limits<float>::infinity());
  for (const uint32_t corner : order.used()) {
    const auto p = local_corner(scene, run, corner);
    for (size_t axis = 0; axis < 3; ++axis) {
      run.min[axis] = std::min(run.min[axis], p[axis]);
      run.max[axis] = std::max(run.max[axis], p[axis]);
    }
  }
}

std::string quoted(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

// Images of the file, as PNG.
struct Images {
  std::vector<std::string> bytes;  // Each a multiple of four long.
  [[nodiscard]] uint64_t size() const {
    uint64_t sum = 0;
    for (const std::string& one : bytes) sum += one.size();
    return sum;
  }
};

void append_bytes(void* to, void* data, int size) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<size_t>(size));
}

Images make_images(const Scene& scene, const std::vector<Run>& runs) {
  Images out;
  const bool any = std::any_of(runs.begin(), runs.end(), [](const Run& r) { return r.textured; });
  for (size_t i = 0; any && i < scene.textures.size(); ++i) {
    const Texture& t = scene.textures[i];
    std::string& bytes = out.bytes.emplace_back();
    stbi_write_png_to_func(append_bytes, &bytes, t.width, t.height, 4, t.rgba.data(), t.width * 4);
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
  }
  return out;
}

// What the binary chunk holds, in this order.
struct Sizes {
  uint64_t corners = 0, places = 0, triangles = 0;  // Places in textures.
  uint64_t images = 0;
  [[nodiscard]] uint64_t bytes() const {
    return 12 * corners + 8 * places + 12 * triangles + images;
  }
};

std::string material_json(const Scene& scene, std::string_view name, uint32_t material1,
                          bool textured) {
  const std::array<float, 4> c =
      material1 > 0 ? scene.materials[material1 - 1].colour : importer::any_colour(name);
  const std::string texture = textured ? fmt::format(",\"baseColorTexture\":{{\"index\":{}}}",
                                                     scene.materials[material1 - 1].texture1 - 1)
                                       : std::string();
  const Opacity opacity = material1 > 0 ? scene.materials[material1 - 1].opacity : Opacity::kOpaque;
  std::string mode;
  if (opacity == Opacity::kBlended) mode = ",\"alphaMode\":\"BLEND\"";
  if (opacity == Opacity::kHoles) {
    mode = fmt::format(",\"alphaMode\":\"MASK\",\"alphaCutoff\":{}",
                       scene.materials[material1 - 1].threshold);
  }
  return fmt::format(
      "{{\"name\":{},\"doubleSided\":true,\"pbrMetallicRoughness\":{{\"baseColorFactor\":"
      "[{},{},{},{}],\"metallicFactor\":0,\"roughnessFactor\":0.9{}}}{}}}",
      quoted(name), c[0], c[1], c[2], c[3], texture, mode);
}

std::string make_header(const Scene& scene, const std::vector<Run>& runs, const Sizes& sizes,
                        const Images& images) {
  struct Look {
    std::string_view material;
    uint32_t material1 = 0;
    bool textured = false;
    bool operator==(const Look&) const = default;
  };
  std::vector<Look> materials;
  std::string nodes;
  std::string meshes;
  std::string accessors;
  std::string roots;
  uint64_t corner = 0;
  uint64_t triangle = 0;
  uint64_t place = 0;
  for (size_t i = 0, accessor = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    const std::string_view comma = i == 0 ? "" : ",";
    const Look look{run.material, run.material1, run.textured};
    auto found = std::find(materials.begin(), materials.end(), look);
    if (found == materials.end()) found = materials.insert(materials.end(), look);
    const std::string name = quoted(run.node);
    roots += fmt::format("{}{}", comma, i);
    nodes += fmt::format("{}{{\"name\":{},\"mesh\":{}", comma, name, i);
    if (run.origin != Vec3d{}) {
      nodes += fmt::format(",\"translation\":[{},{},{}]", run.origin.x, run.origin.y, run.origin.z);
    }
    nodes += fmt::format(",\"extras\":{{\"area\":{}}}}}", run.kind);
    const std::string places =
        run.textured ? fmt::format(",\"TEXCOORD_0\":{}", accessor + 2) : std::string();
    meshes += fmt::format(
        "{}{{\"name\":{},\"primitives\":[{{\"attributes\":{{\"POSITION\":{}{}}},\"indices\":{},"
        "\"material\":{}}}]}}",
        comma, name, accessor, places, accessor + 1, found - materials.begin());
    accessors += fmt::format(
        "{}{{\"bufferView\":0,\"byteOffset\":{},\"componentType\":5126,\"count\":{},\"type\":"
        "\"VEC3\","
        "\"min\":[{},{},{}],\"max\":[{},{},{}]}},"
        "{{\"bufferView\":1,\"byteOffset\":{},\"componentType\":5125,\"count\":{},\"type\":"
        "\"SCALAR\"}}",
        comma, corner * 12, run.corners, run.min[0], run.min[1], run.min[2], run.max[0], run.max[1],
        run.max[2], triangle * 12, 3 * static_cast<uint64_t>(run.count));
    accessor += 2;
    if (run.textured) {
      accessors += fmt::format(
          ",{{\"bufferView\":2,\"byteOffset\":{},\"componentType\":5126,\"count\":{},\"type\":"
          "\"VEC2\"}}",
          place * 8, run.corners);
      place += run.corners;
      ++accessor;
    }
    corner += run.corners;
    triangle += run.count;
  }
  std::string looks;
  for (const Look& look : materials) {
    looks += looks.empty() ? "" : ",";
    looks += material_json(scene, look.material, look.material1, look.textured);
  }
  std::string views = fmt::format(
      "{{\"buffer\":0,\"byteLength\":{},\"target\":34962}},"
      "{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"target\":34963}}",
      sizes.corners * 12, sizes.corners * 12, sizes.triangles * 12);
  std::string textures;
  if (!images.bytes.empty()) {
    uint64_t at = (sizes.corners + sizes.triangles) * 12;
    views += fmt::format(",{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"target\":34962}}",
                         at, sizes.places * 8);
    at += sizes.places * 8;
    std::string list, uses;
    for (size_t i = 0; i < images.bytes.size(); ++i) {
      views += fmt::format(",{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}", at,
                           images.bytes[i].size());
      at += images.bytes[i].size();
      list +=
          fmt::format("{}{{\"name\":{},\"mimeType\":\"image/png\",\"bufferView\":{}}}",
                      i == 0 ? "" : ",", quoted(std::string_view(scene.textures[i].name)), 3 + i);
      uses += fmt::format("{}{{\"source\":{}}}", i == 0 ? "" : ",", i);
    }
    textures = fmt::format("\"images\":[{}],\"textures\":[{}],", list, uses);
  }
  std::string json = fmt::format(
      "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"throng\"}},\"scene\":0,\"scenes\":[{{"
      "\"nodes\":"
      "[{}]}}],\"nodes\":[{}],\"meshes\":[{}],\"materials\":[{}],{}\"accessors\":[{}],"
      "\"bufferViews\":[{}],"
      "\"buffers\":[{{\"byteLength\":{}}}]}}",
      roots, nodes, meshes, looks, textures, accessors, views, sizes.bytes());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  return json;
}

}  // namespace

Result<void> write_glb(const Scene& scene, const std::string& path) {
  if (const auto fine = importer::check_scene(scene, path); !fine) return fine;
  std::vector<Run> runs = split_into_runs(scene);
  Renumbering order(scene);
  Sizes sizes{.triangles = scene.triangles.size()};
  for (Run& run : runs) {
    measure(scene, order, run);
    sizes.corners += run.corners;
    sizes.places += run.textured ? run.corners : 0;
  }
  const Images images = make_images(scene, runs);
  sizes.images = images.size();
  const std::string header = make_header(scene, runs, sizes, images);
  const uint64_t body = sizes.bytes();
  const uint64_t size = 12 + 8 + header.size() + 8 + body;
  if (size > UINT32_MAX) {
    return Error{
        Errc::kLimit,
        fmt::format("{}: {} triangles need {} bytes, and a GLB file ends at 4 GiB; write the "
                    "scene in pieces",
                    path, sizes.triangles, size)};
  }

  importer::SceneOutput out(path);
  const auto put_chunk = [&](const char* type, uint64_t length) {
    out.put(static_cast<uint32_t>(length));
    out.put_bytes(type, 4);
  };
  const auto each_corner = [](const Run& run, auto put) {
    for (uint32_t t = run.first; t < run.first + run.count; ++t) {
      for (size_t k = 0; k < 3; ++k) put(t, k);
    }
  };
  out.put_bytes("glTF", 4);
  out.put(uint32_t{2});
  out.put(static_cast<uint32_t>(size));
  put_chunk("JSON", header.size());
  out.put_bytes(header.data(), header.size());
  put_chunk("BIN\0", body);
  for (const Run& run : runs) {
    order.start(run);
    if (run.textured) {
      each_corner(run, [&](uint32_t t, size_t k) {
        out.put(local_corner(scene, run, scene.triangles[t][k]));
      });
    } else {
      for (const uint32_t corner : order.used()) out.put(local_corner(scene, run, corner));
    }
  }
  for (const Run& run : runs) {
    order.start(run);
    uint32_t next = 0;
    each_corner(run, [&](uint32_t t, size_t k) {
      out.put(run.textured ? next++ : order[scene.triangles[t][k]]);
    });
  }
  for (const Run& run : runs) {
    if (!run.textured) continue;
    each_corner(run, [&](uint32_t t, size_t k) { out.put(scene.texture_corners[t][k]); });
  }
  for (const std::string& image : images.bytes) out.put_bytes(image.data(), image.size());
  return out.close();
}

}  // namespace throng
