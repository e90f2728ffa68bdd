// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/builtin/world_builder.h"

#include <cmath>
#include <numbers>
#include <utility>

// The materials of built-in worlds, and the assembly of triangles into parts.
namespace throng::importer {
namespace {

constexpr std::array<MaterialInfo, static_cast<size_t>(Mat::kCount)> kMaterialTable = {{
    {"floor"},
    {"slab"},
    {"wall"},
    {"roof"},
    {"ramp"},
    {"stairs"},
    {"pillar"},
    {"kerb"},
    {"pavement"},
    {"road"},
    {"grass"},
    {"stone"},
    {"wood"},
    {"grating"},
    {"steel"},
    {"railing", kAreaBlocked},
    {"pipe", kAreaBlocked},
    {"tank", kAreaBlocked},
    {"car", kAreaBlocked},
    {"car dark", kAreaBlocked},
    {"car light", kAreaBlocked},
    {"tyre", kAreaBlocked},
    {"glass", kAreaBlocked},
    {"trunk", kAreaBlocked},
    {"crown", kAreaBlocked},
    {"water", kAreaBlocked},
    {"tiles", kAreaBlocked},
}};

// The small shift keeps products such as 0.025 * cos(60 degrees) off the tie, where the last bit
// would decide.
double millimetres(double metres) { return std::floor(metres * 1000 + 0.5001) / 1000; }

}  // namespace

const MaterialInfo& material_info(Mat material) {
  return kMaterialTable[static_cast<size_t>(material)];
}

void WorldBuilder::node(std::string name) {
  nodes_.emplace_back();
  nodes_.back().name = std::move(name);
}

uint32_t WorldBuilder::vertex(Vec3d local) {
  const Vec3d p = frame_(local);
  positions_.push_back({millimetres(p.x), millimetres(p.y), millimetres(p.z)});
  return static_cast<uint32_t>(positions_.size() - 1);
}

void WorldBuilder::triangle(Mat material, uint32_t a, uint32_t b, uint32_t c) {
  const Vec3d n = cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
  if (!(dot(n, n) > 1e-14)) return;
  nodes_.back().triangles[static_cast<size_t>(material)].push_back({a, b, c});
  ++triangle_count_;
}

void WorldBuilder::quad(Mat material, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  triangle(material, a, b, c);
  triangle(material, a, c, d);
}

void WorldBuilder::polygon(Mat material, const std::vector<uint32_t>& corners) {
  for (size_t i = 2; i < corners.size(); ++i) {
    triangle(material, corners[0], corners[i - 1], corners[i]);
  }
}

Scene WorldBuilder::finish() {
  Scene scene;
  scene.positions = std::move(positions_);
  scene.triangles.reserve(triangle_count_);
  scene.area.reserve(triangle_count_);
  for (Node& node : nodes_) {
    for (size_t m = 0; m < kMaterials; ++m) {
      auto run = std::exchange(node.triangles[m], {});  // Freed run by run: never twice in memory.
      if (run.empty()) continue;
      const MaterialInfo& info = kMaterialTable[m];
      scene.parts.push_back({.file = {},
                             .node = node.name,
                             .material = std::string(info.name),
                             .first_triangle = static_cast<uint32_t>(scene.triangles.size()),
                             .triangle_count = static_cast<uint32_t>(run.size())});
      scene.triangles.insert(scene.triangles.end(), run.begin(), run.end());
      scene.area.insert(scene.area.end(), run.size(), info.kind);
    }
  }
  scene.report.triangles_read = scene.triangles.size();
  *this = WorldBuilder();
  return scene;
}

std::array<double, 2> unit_circle(double turns) {
  // Taylor's series on an eighth of a turn, then symmetry.
  const double whole = std::floor(turns * 4 + 0.5);
  const double angle = (turns - whole / 4) * 2 * std::numbers::pi;
  double cosine = 0;
  double sine = 0;
  double term = 1;
  for (int k = 0; k < 20; k += 2) {
    cosine += term;
    term *= angle / (k + 1);
    sine += term;
    term *= -angle / (k + 2);
  }
  switch (static_cast<int64_t>(whole) & 3) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

}  // namespace throng::importer
