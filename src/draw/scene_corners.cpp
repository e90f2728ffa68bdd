// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/scene_corners.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "core/random.h"

// Makes the corners of a scene and finds its edges. Models are triangle soups: triangles that share
// a side do not share corners, and may have opposite windings. So sides are matched by position, to
// a tenth of a millimetre.
namespace throng::draw {
namespace {

constexpr size_t kMaxTriangles = 40'000'000;  // 1.9 GB.
constexpr double kWeld = 1e4;                 // Per metre.
constexpr double kSmoothCosine = 0.906;       // Cosine of 25 degrees.

using Lattice = std::array<int64_t, 3>;

struct Side {
  uint32_t low = 0, high = 0;  // Welded corners.
  uint32_t triangle = 0;       // Of those kept.
  uint8_t opposite = 0;        // The corner that is not on it.
};

int8_t signed_byte(double value) {
  return static_cast<int8_t>(std::lround(std::clamp(value, -1.0, 1.0) * 127));
}

// For each position a number that all positions at the same place share.
std::vector<uint32_t> weld(const std::vector<Vec3d>& positions) {
  std::vector<std::pair<Lattice, uint32_t>> sorted(positions.size());
  for (size_t i = 0; i < positions.size(); ++i) {
    const Vec3d p = positions[i] * kWeld;
    sorted[i] = {{std::llround(p.x), std::llround(p.y), std::llround(p.z)},
                 static_cast<uint32_t>(i)};
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<uint32_t> welded(positions.size());
  uint32_t number = 0;
  for (size_t i = 0; i < sorted.size(); ++i) {
    if (i > 0 && sorted[i].first != sorted[i - 1].first) ++number;
    welded[sorted[i].second] = number;
  }
  return welded;
}

// Marks the sides at which the surface bends or ends.
void mark_edges(std::vector<Side>& sides, const std::vector<Vec3d>& normals,
                std::vector<SceneCorner>& corners) {
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle, a.opposite) <
           std::tie(b.low, b.high, b.triangle, b.opposite);
  });
  for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    const Side& first = sides[begin];
    bool smooth = true;
    for (end = begin;
         end < sides.size() && sides[end].low == first.low && sides[end].high == first.high;
         ++end) {
      const double cosine = dot(normals[first.triangle], normals[sides[end].triangle]);
      smooth = smooth && std::abs(cosine) > kSmoothCosine;
    }
    if (smooth && end - begin > 1) continue;
    for (size_t i = begin; i < end; ++i) {
      for (size_t k = 0; k < 3; ++k) {
        corners[size_t{3} * sides[i].triangle + k].edges_tint |=
            static_cast<uint8_t>(1U << sides[i].opposite);
      }
    }
  }
}

uint8_t root_byte(float linear) {
  const double root = std::sqrt(std::clamp(static_cast<double>(linear), 0.0, 1.0));
  return static_cast<uint8_t>(root * 255 + 0.5);
}

// What all corners of a part share.
SurfaceCorner surface_of(const Scene& scene, const ScenePart& part,
                         std::span<const LayerOf> textures) {
  SurfaceCorner out;
  if (part.material1 == 0 || part.material1 > scene.materials.size()) return out;
  const Material& material = scene.materials[part.material1 - 1];
  for (size_t c = 0; c < 3; ++c) out.paint[c] = root_byte(material.colour[c]);
  out.paint[3] = static_cast<uint8_t>(
      std::clamp(static_cast<double>(material.colour[3]), 0.0, 1.0) * 255 + 0.5);
  out.look = 1;
  if (material.texture1 != 0 && material.texture1 <= textures.size()) {
    const LayerOf& texture = textures[material.texture1 - 1];
    if (texture.layer1 != 0) out.look = static_cast<uint16_t>(texture.layer1 + 1);
    for (size_t c = 0; c < 4; ++c) {
      out.paint[c] = static_cast<uint8_t>((out.paint[c] * texture.mean[c] + 127) / 255);
    }
  }
  if (material.opacity == Opacity::kBlended) out.threshold = 255;
  if (material.opacity == Opacity::kHoles) {
    out.threshold = static_cast<uint8_t>(
        std::clamp(static_cast<double>(material.threshold) * 255 + 0.5, 1.0, 254.0));
  }
  return out;
}

// Large coordinates have no digits left for texels: whole repetitions are subtracted.
void set_places(const TextureCorners& places, SurfaceCorner* corners) {
  for (size_t axis = 0; axis < 2; ++axis) {
    const float low = std::floor(std::min({places[0][axis], places[1][axis], places[2][axis]}));
    for (size_t k = 0; k < 3; ++k) {
      const float place = places[k][axis] - low;
      corners[k].place[axis] = std::isfinite(place) ? place : 0.0F;
    }
  }
}

}  // namespace

Result<SceneCorners> scene_corners(const Scene& scene, Vec3d origin,
                                   std::span<const LayerOf> textures) {
  if (scene.triangles.size() > kMaxTriangles) {
    return Error{Errc::kLimit, "drawing: " + std::to_string(scene.triangles.size()) +
                                   " triangles, more than " + std::to_string(kMaxTriangles) +
                                   "; draw a part of the model"};
  }
  SceneCorners out;
  out.origin = origin;
  out.corners.reserve(3 * scene.triangles.size() + 3);
  const std::vector<uint32_t> welded = weld(scene.positions);
  std::vector<Vec3d> normals;
  std::vector<Side> sides;
  size_t part = 0;
  const bool has_surfaces = !scene.materials.empty();
  const bool has_places = scene.texture_corners.size() == scene.triangles.size();
  if (has_surfaces) out.surfaces.reserve(3 * scene.triangles.size() + 3);
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    while (part + 1 < scene.parts.size() && t >= scene.parts[part + 1].first_triangle) ++part;
    const auto& corner = scene.triangles[t];
    std::array<Vec3d, 3> p;
    for (size_t k = 0; k < 3; ++k) p[k] = scene.positions[corner[k]] - origin;
    Vec3d normal = cross(p[1] - p[0], p[2] - p[0]);
    const double size = length(normal);
    if (!(size > 0)) continue;
    normal = normal * (1 / size);
    const double tint = random_unit(7, 0, part);  // Parts of a model differ a little.
    const auto triangle = static_cast<uint32_t>(normals.size());
    normals.push_back(normal);
    for (uint8_t k = 0; k < 3; ++k) {
      out.bounds.add(p[k]);
      out.corners.push_back(
          {{static_cast<float>(p[k].x), static_cast<float>(p[k].y), static_cast<float>(p[k].z)},
           {signed_byte(normal.x), signed_byte(normal.y), signed_byte(normal.z)},
           static_cast<uint8_t>((1 + std::lround(tint * 30)) << 3)});
      const uint32_t a = welded[corner[(k + 1U) % 3]], b = welded[corner[(k + 2U) % 3]];
      sides.push_back({std::min(a, b), std::max(a, b), triangle, k});
    }
    if (!has_surfaces) continue;
    const ScenePart* of = scene.parts.empty() ? nullptr : &scene.parts[part];
    const bool named =
        of != nullptr && t >= of->first_triangle && t - of->first_triangle < of->triangle_count;
    const SurfaceCorner surface = named ? surface_of(scene, *of, textures) : SurfaceCorner();
    out.has_holes |= surface.threshold != 0;
    out.surfaces.insert(out.surfaces.end(), 3, surface);
    if (has_places && surface.look > 1) {
      set_places(scene.texture_corners[t], &out.surfaces[out.surfaces.size() - 3]);
    }
  }
  mark_edges(sides, normals, out.corners);
  return out;
}

// One triangle: where two of that size met and were clipped, the sky would show through.
void add_ground_plane(SceneCorners& scene) {
  if (scene.bounds.empty()) return;
  const double half_side = 40 * length(scene.bounds.max - scene.bounds.min) + 100;
  const auto middle = (scene.bounds.min + scene.bounds.max) * 0.5;
  const double y = scene.bounds.min.y - 0.02;
  const auto corner = [&](double x, double z) {
    scene.corners.push_back({{static_cast<float>(middle.x + x * half_side), static_cast<float>(y),
                              static_cast<float>(middle.z + z * half_side)},
                             {0, 127, 0},
                             0});
  };
  corner(-1, -1), corner(-1, 3), corner(3, -1);
  if (!scene.surfaces.empty()) scene.surfaces.resize(scene.corners.size());
}

}  // namespace throng::draw
