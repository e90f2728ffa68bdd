// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/figure_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/trig.h"
#include "impostor/srgb.h"

// Rasterises with a z-buffer of kSub x kSub samples a texel. It uses only sums and products of
// doubles, so that every machine makes the same bytes; a graphics driver would be faster, but its
// results differ between machines.
namespace throng::impostor {
namespace {

constexpr int32_t kSub = 4;
constexpr uint32_t kNothing = UINT32_MAX;

uint8_t signed_byte(double value) {
  return static_cast<uint8_t>(std::clamp(value, -1.0, 1.0) * 127 + 128.5);
}

}  // namespace

FigureCamera figure_camera(int32_t column, int32_t directions, int32_t row, int32_t elevations) {
  const double azimuth = (column + 0.5) / (2.0 * directions);
  const double elevation = (row + 0.5) / (4.0 * elevations);
  const double s = sin_turns(azimuth), c = cos_turns(azimuth);
  const double rise = sin_turns(elevation), flat = cos_turns(elevation);
  FigureCamera camera;
  camera.towards = {s * flat, rise, c * flat};
  camera.right = {c, 0, -s};
  camera.up = {-s * rise, flat, -c * rise};
  return camera;
}

FigureRaster::FigureRaster(const Character& character, int32_t pixels)
    : character_(character),
      pixels_(pixels),
      samples_(pixels * kSub),
      grid_(static_cast<size_t>(samples_) * static_cast<size_t>(samples_)) {}

void FigureRaster::draw(const PosedMesh& mesh, const FigureCamera& camera, FigureView& out) {
  std::fill(grid_.begin(), grid_.end(),
            Sample{.depth = -std::numeric_limits<double>::infinity(), .triangle = kNothing});
  const double scale = samples_ / camera.side;
  const double half = 0.5 * samples_;
  projected_.resize(mesh.positions.size());
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3d p = mesh.positions[v] - camera.centre;
    projected_[v] = {half + dot(p, camera.right) * scale, half - dot(p, camera.up) * scale,
                     dot(p, camera.towards)};
  }
  draw_triangles(0, character_.body_triangles());
  resolve(mesh, camera, 0, out);
  if (!character_.worn.empty()) body_ = grid_;
}

void FigureRaster::draw_worn(const WornPart& part, const PosedMesh& mesh,
                             const FigureCamera& camera, FigureView& out) {
  grid_ = body_;
  draw_triangles(part.first_triangle, part.triangle_count);
  resolve(mesh, camera, part.first_triangle, out);
}

void FigureRaster::draw_triangles(size_t first, size_t count) {
  for (size_t t = first; t < first + count; ++t) {
    const auto& corners = character_.triangles[t];
    draw_triangle(static_cast<uint32_t>(t),
                  {projected_[corners[0]], projected_[corners[1]], projected_[corners[2]]});
  }
}

void FigureRaster::draw_triangle(uint32_t index, const std::array<Vec3d, 3>& p) {
  const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
  if (area == 0) return;  // Seen edge-on.
  const auto range = [&](double a, double b, double c) {
    const double low = std::min({a, b, c}) - 0.5, high = std::max({a, b, c}) - 0.5;
    const double last = samples_ - 1;
    return std::array<int32_t, 2>{static_cast<int32_t>(std::ceil(std::clamp(low, 0.0, last + 1))),
                                  static_cast<int32_t>(std::floor(std::clamp(high, -1.0, last)))};
  };
  const auto [x0, x1] = range(p[0].x, p[1].x, p[2].x);
  const auto [y0, y1] = range(p[0].y, p[1].y, p[2].y);
  const double over = 1 / area;
  for (int32_t y = y0; y <= y1; ++y) {
    for (int32_t x = x0; x <= x1; ++x) {
      const double dx = x + 0.5 - p[0].x, dy = y + 0.5 - p[0].y;
      const double u = (dx * (p[2].y - p[0].y) - dy * (p[2].x - p[0].x)) * over;
      const double v = (dy * (p[1].x - p[0].x) - dx * (p[1].y - p[0].y)) * over;
      if (u < 0 || v < 0 || u + v > 1) continue;
      const double depth = p[0].z + u * (p[1].z - p[0].z) + v * (p[2].z - p[0].z);
      Sample& sample = grid_[static_cast<size_t>(y) * static_cast<size_t>(samples_) + x];
      if (depth <= sample.depth) continue;
      sample = {depth, index, static_cast<float>(u), static_cast<float>(v)};
    }
  }
}

// Triangles before `first` only hide. A texel belongs to the part that most of its samples show,
// and its colour and normal are the means of those samples alone, so that a tint leaves no fringe
// of another part.
void FigureRaster::resolve(const PosedMesh& mesh, const FigureCamera& camera, size_t first,
                           FigureView& out) const {
  const auto count = static_cast<size_t>(pixels_) * static_cast<size_t>(pixels_);
  out.pixels = pixels_;
  out.colour.assign(count, {0, 0, 0, 0});
  out.normal.assign(count, {128, 128});
  out.mask.assign(count, 0);
  for (size_t texel = 0; texel < count; ++texel) {
    const size_t corner = texel / static_cast<size_t>(pixels_) * kSub * samples_ +
                          texel % static_cast<size_t>(pixels_) * kSub;
    const auto sample_at = [&](int32_t i) -> const Sample& {
      return grid_[corner + static_cast<size_t>(i / kSub) * samples_ + i % kSub];
    };
    const auto is_shown = [&](const Sample& sample) {
      return sample.triangle != kNothing && sample.triangle >= first;
    };
    const auto material_of = [&](const Sample& sample) -> const CharacterMaterial& {
      return character_.materials[character_.material[sample.triangle]];
    };
    std::array<int32_t, kBodyParts> votes{};
    int32_t covered = 0;
    for (int32_t i = 0; i < kSub * kSub; ++i) {
      if (!is_shown(sample_at(i))) continue;
      ++votes[static_cast<size_t>(material_of(sample_at(i)).part)];
      ++covered;
    }
    if (covered == 0) continue;
    const auto part =
        static_cast<size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
    Vec3d colour, normal;
    double depth = 0;
    for (int32_t i = 0; i < kSub * kSub; ++i) {
      const Sample& sample = sample_at(i);
      if (!is_shown(sample)) continue;
      const CharacterMaterial& material = material_of(sample);
      if (static_cast<size_t>(material.part) != part) continue;
      const auto& corners = character_.triangles[sample.triangle];
      const double u = sample.u, v = sample.v;
      Vec3d n = mesh.normals[corners[0]] * (1 - u - v) + mesh.normals[corners[1]] * u +
                mesh.normals[corners[2]] * v;
      if (dot(n, camera.towards) < 0) n = n - camera.towards * (2 * dot(n, camera.towards));
      normal = normal + n;
      colour = colour + material.colour;
      depth += sample.depth;
    }
    const double share = 1.0 / votes[part];
    colour = colour * share;
    const double size = length(normal);
    if (size > 0) normal = normal * (1 / size);
    out.colour[texel] = {encode_colour(colour.x), encode_colour(colour.y), encode_colour(colour.z),
                         static_cast<uint8_t>(covered * 255 / (kSub * kSub))};
    out.normal[texel] = {signed_byte(dot(normal, camera.right)),
                         signed_byte(dot(normal, camera.up))};
    const double in_front = std::clamp(depth * share / (0.5 * camera.side), -1.0, 1.0);
    out.mask[texel] = static_cast<uint8_t>(part << 5 | static_cast<size_t>(in_front * 15 + 16.5));
  }
}

}  // namespace throng::impostor
