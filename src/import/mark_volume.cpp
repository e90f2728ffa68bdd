// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "import/raw/raw_scene.h"
#include "throng/scene.h"

// Cuts triangles at the sides of a prism, one plane after the other (Sutherland and Hodgman, 1974,
// keeping both halves), so that what is inside can have its own kind. The bake then needs no notion
// of volumes.
namespace throng {
namespace {

// Inside is where normal . p >= offset.
struct Plane {
  Vec3d normal;
  double offset = 0;
  [[nodiscard]] double operator()(const Vec3d& p) const { return dot(normal, p) - offset; }
};

std::vector<Plane> planes_of(const Prism& prism) {
  std::vector<Plane> planes{{{0, 1, 0}, prism.low}, {{0, -1, 0}, -prism.high}};
  double around = 0;  // twice the area, by the sense of its corners
  const size_t count = prism.corners.size();
  for (size_t i = 0; i < count; ++i) {
    const auto &a = prism.corners[i], &b = prism.corners[(i + 1) % count];
    around += a[0] * b[1] - a[1] * b[0];
  }
  for (size_t i = 0; i < count; ++i) {
    const auto &a = prism.corners[i], &b = prism.corners[(i + 1) % count];
    const double sign = around > 0 ? 1 : -1;
    const Vec3d normal{sign * (a[1] - b[1]), 0, sign * (b[0] - a[0])};
    if (normal.x == 0 && normal.z == 0) continue;  // the same corner twice
    planes.push_back({normal, normal.x * a[0] + normal.z * a[1]});
  }
  return planes;
}

class Cutter {
 public:
  Cutter(Scene& scene, const AreaVolume& volume)
      : scene_(scene),
        kind_(volume.kind),
        planes_(planes_of(volume.prism)),
        vertices_(scene.positions.size()) {
    for (const auto& corner : volume.prism.corners) {
      box_.add({corner[0], volume.prism.low, corner[1]});
      box_.add({corner[0], volume.prism.high, corner[1]});
    }
  }

  void cut() {
    uint32_t done = 0;
    const auto cut_until = [&](uint32_t end) {
      while (done < end) cut(done++);
    };
    for (ScenePart& part : scene_.parts) {
      cut_until(part.first_triangle);  // what no part names
      const auto first = static_cast<uint32_t>(triangles_.size());
      cut_until(part.first_triangle + part.triangle_count);
      part.first_triangle = first;
      part.triangle_count = static_cast<uint32_t>(triangles_.size()) - first;
    }
    cut_until(static_cast<uint32_t>(scene_.triangles.size()));
    scene_.triangles = std::move(triangles_);
    scene_.area = std::move(area_);
    if (!scene_.patch_of_triangle.empty()) scene_.patch_of_triangle = std::move(patch_);
    if (!scene_.patch_part.empty()) scene_.patch_part = std::move(part_);
    if (!scene_.texture_corners.empty()) scene_.texture_corners = std::move(texture_);
  }

 private:
  using Polygon = std::vector<uint32_t>;  // corners, into the scene's positions

  void keep(uint32_t a, uint32_t b, uint32_t c, uint32_t from, AreaKind kind) {
    triangles_.push_back({a, b, c});
    area_.push_back(kind);
    if (!scene_.patch_of_triangle.empty()) patch_.push_back(scene_.patch_of_triangle[from]);
    if (!scene_.patch_part.empty()) part_.push_back(scene_.patch_part[from]);
    if (scene_.texture_corners.empty()) return;
    TextureCorners& corners = texture_.emplace_back();
    const std::array<uint32_t, 3> piece{a, b, c};
    for (size_t k = 0; k < 3; ++k) corners[k] = place_in_texture(from, piece[k]);
  }
  // Of a corner of a piece of triangle t.
  [[nodiscard]] std::array<float, 2> place_in_texture(uint32_t t, uint32_t corner) const {
    const auto& whole = scene_.triangles[t];
    const TextureCorners& places = scene_.texture_corners[t];
    for (size_t k = 0; k < 3; ++k) {
      if (whole[k] == corner) return places[k];
    }
    if (corner >= scene_.positions.size()) return places[0];
    const Vec3d a = scene_.positions[whole[0]];
    const Vec3d u = scene_.positions[whole[1]] - a, v = scene_.positions[whole[2]] - a;
    const Vec3d normal = cross(u, v), p = scene_.positions[corner] - a;
    const double area = dot(normal, normal);
    if (!(area > 0)) return places[0];
    const double s = dot(cross(p, v), normal) / area, r = dot(cross(u, p), normal) / area;
    std::array<float, 2> place{};
    for (size_t k = 0; k < 2; ++k) {
      place[k] = static_cast<float>(places[0][k] + s * (places[1][k] - places[0][k]) +
                                    r * (places[2][k] - places[0][k]));
    }
    return place;
  }
  void keep(const Polygon& polygon, uint32_t from, AreaKind kind) {
    for (size_t i = 2; i < polygon.size(); ++i)
      keep(polygon[0], polygon[i - 1], polygon[i], from, kind);
  }

  void cut(uint32_t t) {
    const std::array<uint32_t, 3>& corners = scene_.triangles[t];
    if (!is_sound(corners)) return keep_broken(t);
    Box3d box;
    for (const uint32_t c : corners) box.add(scene_.positions[c]);
    const bool apart = box.min.x > box_.max.x || box.max.x < box_.min.x || box.min.y > box_.max.y ||
                       box.max.y < box_.min.y || box.min.z > box_.max.z || box.max.z < box_.min.z;
    if (apart) return keep(corners[0], corners[1], corners[2], t, scene_.area[t]);
    Polygon inside(corners.begin(), corners.end());
    std::vector<Polygon> outside;
    for (size_t p = 0; p < planes_.size() && !inside.empty(); ++p) {
      Polygon in, out;
      split(inside, p, in, out);
      if (!out.empty()) outside.push_back(std::move(out));
      inside = std::move(in);
    }
    if (inside.empty()) return keep(corners[0], corners[1], corners[2], t, scene_.area[t]);
    for (const Polygon& polygon : outside) keep(polygon, t, scene_.area[t]);
    if (kind_ == kAreaIgnored) {
      ++scene_.report.ignored;
    } else {
      keep(inside, t, kind_);
    }
  }

  [[nodiscard]] bool is_sound(const std::array<uint32_t, 3>& corners) const {
    return std::all_of(corners.begin(), corners.end(), [&](uint32_t c) {
      if (c >= vertices_) return false;
      const Vec3d& p = scene_.positions[c];
      return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    });
  }
  // Volumes come before clean_scene, which counts and drops such a triangle. Its missing corners
  // must not become those that cuts add.
  void keep_broken(uint32_t t) {
    std::array<uint32_t, 3> corners = scene_.triangles[t];
    for (uint32_t& c : corners) {
      if (c >= vertices_) c = importer::kNoVertex;
    }
    keep(corners[0], corners[1], corners[2], t, scene_.area[t]);
  }

  // A polygon of which no corner lies off the plane on one side is not cut.
  void split(const Polygon& polygon, size_t plane, Polygon& in, Polygon& out) {
    const auto side = [&](uint32_t corner) { return planes_[plane](scene_.positions[corner]); };
    const bool any_in =
        std::any_of(polygon.begin(), polygon.end(), [&](uint32_t c) { return side(c) > 0; });
    const bool any_out =
        std::any_of(polygon.begin(), polygon.end(), [&](uint32_t c) { return side(c) < 0; });
    if (!any_out) in = polygon;  // also what lies in the plane itself
    if (any_out && !any_in) out = polygon;
    if (!any_in || !any_out) return;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const uint32_t a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      const double da = side(a), db = side(b);
      if (da >= 0) in.push_back(a);
      if (da <= 0) out.push_back(a);
      if ((da > 0) != (db > 0) && da != 0 && db != 0) {
        const uint32_t c = crossing(a, b, plane);
        in.push_back(c);
        out.push_back(c);
      }
    }
  }

  // Triangles that share an edge share the corner that a plane cuts out of it: no crack.
  uint32_t crossing(uint32_t a, uint32_t b, size_t plane) {
    const std::array<uint32_t, 3> key{std::min(a, b), std::max(a, b), static_cast<uint32_t>(plane)};
    const auto [found, is_new] =
        crossings_.try_emplace(key, static_cast<uint32_t>(scene_.positions.size()));
    if (is_new) {
      const Vec3d p = scene_.positions[key[0]], q = scene_.positions[key[1]];
      const double dp = planes_[plane](p), dq = planes_[plane](q);
      scene_.positions.push_back(p + (q - p) * (dp / (dp - dq)));
    }
    return found->second;
  }

  Scene& scene_;
  AreaKind kind_;
  std::vector<Plane> planes_;
  size_t vertices_;  // before any cut
  Box3d box_;
  std::map<std::array<uint32_t, 3>, uint32_t> crossings_;
  std::vector<std::array<uint32_t, 3>> triangles_;
  std::vector<AreaKind> area_;
  std::vector<uint32_t> patch_;
  std::vector<PatchPart> part_;
  std::vector<TextureCorners> texture_;
};

}  // namespace

Result<void> mark_volume(Scene& scene, const AreaVolume& volume) {
  if (auto ok = check_prism(volume.prism); !ok) return ok.error();
  if (volume.kind > kAreaLast && volume.kind != kAreaIgnored) {
    return Error{Errc::kBadInput, "volume: " + std::to_string(volume.kind) +
                                      " is not an area kind; they go up to " +
                                      std::to_string(kAreaLast)};
  }
  if (scene.area.empty()) scene.area.assign(scene.triangles.size(), kAreaWalkable);
  Cutter(scene, volume).cut();
  return {};
}

}  // namespace throng
