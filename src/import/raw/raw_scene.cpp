// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/raw_scene.h"

#include <fmt/format.h>

#include <algorithm>

// Collects the triangles of a reader into parts and counts bad corners and faces.
namespace throng::importer {

void SceneWriter::begin_part(std::string_view node, std::string_view material, uint32_t material1) {
  const auto first = static_cast<uint32_t>(scene_.triangles.size());
  if (!scene_.parts.empty()) {
    ScenePart& last = scene_.parts.back();
    if (last.node == node && last.material == material && last.material1 == material1) return;
    last.triangle_count = first - last.first_triangle;
    if (last.triangle_count == 0) scene_.parts.pop_back();
  }
  scene_.parts.push_back({.file = file_,
                          .node = std::string(node),
                          .material = std::string(material),
                          .first_triangle = first,
                          .triangle_count = 0,
                          .material1 = material1});
}

uint32_t SceneWriter::add_vertex(Vec3d p) {
  scene_.positions.push_back(p);
  return static_cast<uint32_t>(scene_.positions.size() - 1);
}

void SceneWriter::add_triangle(uint32_t a, uint32_t b, uint32_t c) {
  if (scene_.parts.empty()) begin_part({}, {});
  scene_.triangles.push_back({a, b, c});
}

void SceneWriter::add_polygon(std::span<const Vec3d> points, std::span<const uint32_t> ring_first) {
  const uint32_t corners = ring_first[1] - ring_first[0];
  if (corners < 3 || full()) {
    ++bad_;
    return;
  }
  const auto base = static_cast<uint32_t>(scene_.positions.size());
  scene_.positions.insert(scene_.positions.end(), points.begin(), points.end());
  cut_.clear();
  if (!cutter_.cut(points, ring_first, cut_)) ++inexact_;
  for (const auto& [a, b, c] : cut_) add_triangle(base + a, base + b, base + c);
}

void SceneWriter::set_texture_corners(const TextureCorners& corners) {
  scene_.texture_corners.resize(scene_.triangles.size());
  scene_.texture_corners.back() = corners;
}

void SceneWriter::add_face(std::span<const uint32_t> corners) { add_face(corners, {}); }

void SceneWriter::add_face(std::span<const uint32_t> corners,
                           std::span<const std::array<float, 2>> places) {
  const bool bad = std::find(corners.begin(), corners.end(), kNoVertex) != corners.end();
  if (corners.size() < 3 || bad) {
    count_bad(corners.size() > 3 ? corners.size() - 2 : 1);
    return;
  }
  if (corners.size() == 3) {
    add_triangle(corners[0], corners[1], corners[2]);
    if (places.size() == 3) set_texture_corners({places[0], places[1], places[2]});
    return;
  }
  points_.clear();
  for (const uint32_t corner : corners) points_.push_back(scene_.positions[corner]);
  const uint32_t rings[2] = {0, static_cast<uint32_t>(corners.size())};
  cut_.clear();
  if (!cutter_.cut(points_, rings, cut_)) ++inexact_;
  for (const auto& [a, b, c] : cut_) {
    add_triangle(corners[a], corners[b], corners[c]);
    if (places.size() == corners.size()) set_texture_corners({places[a], places[b], places[c]});
  }
}

bool SceneWriter::full() const { return scene_.positions.size() >= kNoVertex - 65536; }

Result<Scene> SceneWriter::finish() {
  if (full() || scene_.triangles.size() >= kNoVertex) {
    return Error{Errc::kLimit,
                 file_ + ": more than 4.29 thousand million vertices; split the file"};
  }
  if (!scene_.parts.empty()) {
    ScenePart& last = scene_.parts.back();
    last.triangle_count = static_cast<uint32_t>(scene_.triangles.size()) - last.first_triangle;
    if (last.triangle_count == 0) scene_.parts.pop_back();
  }
  scene_.area.resize(scene_.triangles.size(), kAreaWalkable);
  if (!scene_.texture_corners.empty()) scene_.texture_corners.resize(scene_.triangles.size());
  scene_.report.bad_index += bad_;
  scene_.report.triangles_read = scene_.triangles.size() + bad_;
  if (thin_ > 0) {
    warn(fmt::format("{}: skipped {} points and lines; only surfaces are matter", file_, thin_));
  }
  if (inexact_ > 0) {
    warn(fmt::format("{}: {} polygons cross themselves; their area is a best effort", file_,
                     inexact_));
  }
  return std::move(scene_);
}

}  // namespace throng::importer
