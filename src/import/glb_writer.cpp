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

#include "import/scene_output.h"
#include "throng/scene.h"

// Writes binary glTF 2.0 (Khronos, 2017). Three walks over each run of triangles: one measures, so
// that the header can be written first; one writes corners; one writes indices. Only a renumbering
// of the corners is ever held, so the memory is four bytes a corner whatever the file's size.
namespace throng {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr uint32_t kUnset = UINT32_MAX;

struct Colour {
  std::string_view material;
  double r, g, b, a;
};

// Linear base colours, so that other viewers show something nice. Unknown names get one by hash.
constexpr std::array<Colour, 26> kColours = {{
    {"floor", 0.50, 0.49, 0.46, 1},     {"slab", 0.38, 0.38, 0.38, 1},
    {"wall", 0.72, 0.66, 0.56, 1},      {"roof", 0.42, 0.14, 0.09, 1},
    {"ramp", 0.62, 0.47, 0.22, 1},      {"stairs", 0.68, 0.52, 0.32, 1},
    {"pillar", 0.60, 0.60, 0.62, 1},    {"kerb", 0.66, 0.64, 0.58, 1},
    {"pavement", 0.44, 0.42, 0.39, 1},  {"road", 0.10, 0.10, 0.11, 1},
    {"grass", 0.16, 0.32, 0.09, 1},     {"stone", 0.60, 0.54, 0.43, 1},
    {"wood", 0.30, 0.16, 0.07, 1},      {"grating", 0.40, 0.43, 0.46, 1},
    {"steel", 0.14, 0.24, 0.36, 1},     {"railing", 0.80, 0.58, 0.06, 1},
    {"pipe", 0.55, 0.58, 0.60, 1},      {"tank", 0.72, 0.74, 0.76, 1},
    {"car", 0.55, 0.03, 0.03, 1},       {"car dark", 0.03, 0.06, 0.16, 1},
    {"car light", 0.70, 0.71, 0.73, 1}, {"tyre", 0.02, 0.02, 0.02, 1},
    {"glass", 0.06, 0.12, 0.16, 1},     {"trunk", 0.16, 0.09, 0.04, 1},
    {"crown", 0.10, 0.26, 0.06, 1},     {"water", 0.05, 0.18, 0.26, 1},
}};

Colour colour_of(std::string_view material) {
  for (const Colour& colour : kColours) {
    if (colour.material == material) return colour;
  }
  uint32_t hash = 2166136261u;  // FNV-1a
  for (const char c : material) hash = (hash ^ static_cast<uint8_t>(c)) * 16777619u;
  const auto part = [&](uint32_t shift) { return 0.15 + 0.6 * ((hash >> shift) & 255) / 255.0; };
  return {material, part(0), part(8), part(16), 1};
}

// Triangles of one part and one area kind: one mesh of the file.
struct Run {
  std::string_view node;
  std::string_view material;
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
  const auto add = [&](std::string_view node, std::string_view material, uint32_t from,
                       uint32_t to) {
    while (from < to) {
      uint32_t end = from + 1;
      while (end < to && kind_of(end) == kind_of(from)) ++end;
      runs.push_back({.node = node,
                      .material = material,
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
    add("scene", "surface", at, from);  // Triangles that no part names.
    add(part.node, part.material, from, to);
    at = to;
  }
  add("scene", "surface", at, total);
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
  run.corners = static_cast<uint32_t>(order.used().size());
  Box3d box;
  for (const uint32_t corner : order.used()) box.add(scene.positions[corner]);
  // Near the origin floats are fine enough. Whole metres are exact as floats, too.
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

std::string make_header(const std::vector<Run>& runs, uint64_t corners, uint64_t triangles) {
  std::vector<std::string_view> materials;
  std::string nodes;
  std::string meshes;
  std::string accessors;
  std::string roots;
  uint64_t corner = 0;
  uint64_t triangle = 0;
  for (size_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    const std::string_view comma = i == 0 ? "" : ",";
    auto found = std::find(materials.begin(), materials.end(), run.material);
    if (found == materials.end()) found = materials.insert(materials.end(), run.material);
    const std::string name = quoted(run.node);
    roots += fmt::format("{}{}", comma, i);
    nodes += fmt::format("{}{{\"name\":{},\"mesh\":{}", comma, name, i);
    if (run.origin != Vec3d{}) {
      nodes += fmt::format(",\"translation\":[{},{},{}]", run.origin.x, run.origin.y, run.origin.z);
    }
    nodes += fmt::format(",\"extras\":{{\"area\":{}}}}}", run.kind);
    meshes += fmt::format(
        "{}{{\"name\":{},\"primitives\":[{{\"attributes\":{{\"POSITION\":{}}},\"indices\":{},"
        "\"material\":{}}}]}}",
        comma, name, 2 * i, 2 * i + 1, found - materials.begin());
    accessors += fmt::format(
        "{}{{\"bufferView\":0,\"byteOffset\":{},\"componentType\":5126,\"count\":{},\"type\":"
        "\"VEC3\","
        "\"min\":[{},{},{}],\"max\":[{},{},{}]}},"
        "{{\"bufferView\":1,\"byteOffset\":{},\"componentType\":5125,\"count\":{},\"type\":"
        "\"SCALAR\"}}",
        comma, corner * 12, run.corners, run.min[0], run.min[1], run.min[2], run.max[0], run.max[1],
        run.max[2], triangle * 12, 3 * static_cast<uint64_t>(run.count));
    corner += run.corners;
    triangle += run.count;
  }
  std::string looks;
  for (const std::string_view material : materials) {
    const Colour c = colour_of(material);
    looks += fmt::format(
        "{}{{\"name\":{},\"doubleSided\":true,\"pbrMetallicRoughness\":{{\"baseColorFactor\":"
        "[{},{},{},{}],\"metallicFactor\":0,\"roughnessFactor\":0.9}}}}",
        looks.empty() ? "" : ",", quoted(material), c.r, c.g, c.b, c.a);
  }
  std::string json = fmt::format(
      "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"throng\"}},\"scene\":0,\"scenes\":[{{"
      "\"nodes\":"
      "[{}]}}],\"nodes\":[{}],\"meshes\":[{}],\"materials\":[{}],\"accessors\":[{}],"
      "\"bufferViews\":"
      "[{{\"buffer\":0,\"byteLength\":{},\"target\":34962}},"
      "{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"target\":34963}}],"
      "\"buffers\":[{{\"byteLength\":{}}}]}}",
      roots, nodes, meshes, looks, accessors, corners * 12, corners * 12, triangles * 12,
      corners * 12 + triangles * 12);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  return json;
}

}  // namespace

Result<void> write_glb(const Scene& scene, const std::string& path) {
  if (const auto fine = check_scene(scene, path); !fine) return fine;
  std::vector<Run> runs = split_into_runs(scene);
  Renumbering order(scene);
  uint64_t corners = 0;
  for (Run& run : runs) {
    measure(scene, order, run);
    corners += run.corners;
  }
  const uint64_t triangles = scene.triangles.size();
  const std::string header = make_header(runs, corners, triangles);
  const uint64_t body = 12 * (corners + triangles);
  const uint64_t size = 12 + 8 + header.size() + 8 + body;
  if (size > UINT32_MAX) {
    return Error{
        Errc::kLimit,
        fmt::format("{}: {} triangles need {} bytes, and a GLB file ends at 4 GiB; write the "
                    "scene in pieces",
                    path, triangles, size)};
  }

  SceneOutput out(path);
  const auto put_chunk = [&](const char* type, uint64_t length) {
    out.put(static_cast<uint32_t>(length));
    out.put_bytes(type, 4);
  };
  out.put_bytes("glTF", 4);
  out.put(uint32_t{2});
  out.put(static_cast<uint32_t>(size));
  put_chunk("JSON", header.size());
  out.put_bytes(header.data(), header.size());
  put_chunk("BIN\0", body);
  for (const Run& run : runs) {
    order.start(run);
    for (const uint32_t corner : order.used()) out.put(local_corner(scene, run, corner));
  }
  for (const Run& run : runs) {
    order.start(run);
    for (uint32_t t = run.first; t < run.first + run.count; ++t) {
      const auto& corner = scene.triangles[t];
      out.put(std::array<uint32_t, 3>{order[corner[0]], order[corner[1]], order[corner[2]]});
    }
  }
  return out.close();
}

}  // namespace throng
