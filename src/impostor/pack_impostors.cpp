// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "impostor/blend_views.h"
#include "impostor/pack_loops.h"
#include "throng/impostor.h"

// Packs visible avatars, block by block: short loops over arrays that fit the first-level cache
// find which avatars are in the picture and by which view, and another loop writes these out. A
// block writes at its own place; then the gaps that invisible avatars left are closed, in order.
// Linear.
namespace throng {
namespace {

// The six planes of the view frustum, each moved out by `margin`.
std::array<impostor::PackPlane, 6> planes_of(const EyeCamera& camera, double margin) {
  const CameraAxes axes = camera_axes(camera);
  const double up = std::tan(0.5 * camera.field_of_view), right = up * camera.aspect;
  const auto plane = [&](Vec3d normal, double offset) {
    normal = normal * (1 / length(normal));
    return impostor::PackPlane{static_cast<float>(normal.x), static_cast<float>(normal.y),
                               static_cast<float>(normal.z),
                               static_cast<float>(offset - dot(normal, camera.eye) + margin)};
  };
  return {plane(axes.forward * right + axes.right, 0), plane(axes.forward * right - axes.right, 0),
          plane(axes.forward * up + axes.up, 0),       plane(axes.forward * up - axes.up, 0),
          plane(axes.forward, -camera.nearest),        plane(axes.forward * -1, camera.furthest)};
}

// Without a branch: the next avatar overwrites one that is not seen.
size_t write_seen(const impostor::PackInput& in, const impostor::PackBlock& block, uint32_t bit,
                  ImpostorInstance* out) {
  size_t written = 0;
  for (size_t i = 0; i < in.count; ++i) {
    out[written] = {in.x[i], in.y[i], in.z[i], block.view[i]};
    written += block.seen[i] >> bit & 1;
  }
  return written;
}

// Few avatars are that near, so a branch is faster.
size_t write_meshes(const impostor::PackInput& in, const impostor::PackBlock& block,
                    ImpostorInstance* out) {
  size_t written = 0;
  for (size_t i = 0; i < in.count; ++i) {
    if ((block.seen[i] & impostor::kSeenAsMesh) == 0) continue;
    const uint32_t heading = ((in.heading[i] + 16U) & 0xffffU) >> 5, phase = in.phase[i] >> 6;
    out[written++] = {in.x[i], in.y[i], in.z[i],
                      heading | phase << 11 | static_cast<uint32_t>(in.look[i]) << 21};
  }
  return written;
}

// Closes the gaps that each block left; returns the number of instances.
template <class Instance>
size_t close_gaps(const std::vector<uint32_t>& kept, std::span<Instance> out) {
  size_t total = 0;
  for (size_t b = 0; b < kept.size(); ++b) {
    if (total != b * impostor::kPackBlock && kept[b] > 0) {
      std::memmove(&out[total], &out[b * impostor::kPackBlock], kept[b] * sizeof out[0]);
    }
    total += kept[b];
  }
  return total;
}

impostor::PackShared shared_of(const Atlas& atlas, const PackConfig& config,
                               const LevelDistances& levels) {
  const AtlasClip& clip = atlas.clips[config.clip];
  const auto square = [](double v) { return static_cast<float>(v * v); };
  impostor::PackShared s{.planes = planes_of(config.camera, 0.5 * atlas.shape.side),
                         .eye_x = static_cast<float>(config.camera.eye.x),
                         .eye_y = static_cast<float>(config.camera.eye.y),
                         .eye_z = static_cast<float>(config.camera.eye.z),
                         .fixed = config.from_direction.has_value(),
                         .centre = static_cast<float>(atlas.shape.centre),
                         .directions = static_cast<uint32_t>(atlas.shape.directions),
                         .rows = static_cast<uint32_t>(atlas.shape.elevations),
                         .frames = static_cast<uint32_t>(clip.frames),
                         .first_frame = static_cast<uint32_t>(clip.first_frame),
                         .mesh_near = square(levels.mesh_near),
                         .mesh_far = square(levels.mesh_far),
                         .point_near = square(levels.point_near),
                         .point_far = square(levels.point_far),
                         .blend_far = levels.blend_share > 0 ? square(levels.blend_far) : 0};
  if (s.fixed) {
    s.to_x = static_cast<float>(config.from_direction->x);
    s.to_y = static_cast<float>(config.from_direction->y);
    s.to_z = static_cast<float>(config.from_direction->z);
  }
  return s;
}

}  // namespace

CameraAxes camera_axes(const EyeCamera& camera) {
  const auto unit = [](Vec3d v, Vec3d otherwise) {
    const double size = length(v);
    return size > 1e-12 ? v * (1 / size) : otherwise;
  };
  CameraAxes axes;
  axes.forward = unit(camera.target - camera.eye, {0, 0, -1});
  axes.right = unit(cross(axes.forward, {0, 1, 0}), {1, 0, 0});  // Straight down: east is right.
  axes.up = cross(axes.right, axes.forward);
  return axes;
}

LevelDistances level_distances(const AtlasShape& shape, const EyeCamera& camera, double height,
                               double mesh_texel, double point_pixels) {
  constexpr double kFade = 0.2, kBlendPixels = 24;
  // A side at this distance is a pixel high.
  const double one = shape.side * 0.5 * height / std::tan(0.5 * camera.field_of_view);
  LevelDistances out;
  if (mesh_texel > 0) {
    out.mesh_far = one / (mesh_texel * shape.pixels);
    out.mesh_near = (1 - kFade) * out.mesh_far;
  }
  if (point_pixels > 0) {
    out.point_far = std::max(one / point_pixels, out.mesh_far);
    out.point_near = std::max((1 - kFade) * out.point_far, out.mesh_far);
  }
  out.blend_far = one / kBlendPixels;
  return out;
}

LevelCounts pack_levels(const Atlas& atlas, const ImpostorArrays& avatars, const PackConfig& config,
                        const LevelDistances& levels, const LevelSpans& out) {
  const size_t count = avatars.x.size();
  THRONG_ASSERT(avatars.y.size() == count && avatars.z.size() == count &&
                avatars.heading.size() == count && avatars.phase.size() == count &&
                avatars.appearance.size() == count && config.clip < atlas.clips.size());
  THRONG_ASSERT(out.views.size() >= count && (levels.mesh_far == 0 || out.meshes.size() >= count) &&
                (levels.point_near >= 1e18 || out.points.size() >= count) &&
                (levels.blend_share == 0 || out.blends.size() >= count));
  const impostor::PackShared s = shared_of(atlas, config, levels);
  const size_t blocks = (count + impostor::kPackBlock - 1) / impostor::kPackBlock;
  std::vector<uint32_t> views(blocks), meshes(blocks), points(blocks), blends(blocks);
  const impostor::BlendShape blend{static_cast<float>(levels.blend_share),
                                   static_cast<float>(levels.blend_far)};
  parallel_ranges(blocks, 4, config.workers, [&](size_t begin, size_t end) {
    impostor::PackBlock block;
    for (size_t b = begin; b < end; ++b) {
      const size_t first = b * impostor::kPackBlock;
      const impostor::PackInput in{&avatars.x[first],
                                   &avatars.y[first],
                                   &avatars.z[first],
                                   &avatars.heading[first],
                                   &avatars.phase[first],
                                   &avatars.appearance[first],
                                   std::min(impostor::kPackBlock, count - first)};
      impostor::find_views(s, in, block);
      const auto any = [&](uint32_t as) { return (block.seen_any & as) != 0; };
      const auto number = [](size_t n) { return static_cast<uint32_t>(n); };
      if (any(impostor::kSeenBetween)) {
        blends[b] = number(impostor::write_blends(s, blend, in, block, &out.blends[first]));
      }
      if (any(impostor::kSeenByView | impostor::kSeenBetween))
        views[b] = number(write_seen(in, block, 0, &out.views[first]));
      if (any(impostor::kSeenAsMesh))
        meshes[b] = number(write_meshes(in, block, &out.meshes[first]));
      if (any(impostor::kSeenAsPoint))
        points[b] = number(write_seen(in, block, 2, &out.points[first]));
    }
  });
  return {.meshes = close_gaps(meshes, out.meshes),
          .views = close_gaps(views, out.views),
          .points = close_gaps(points, out.points),
          .blends = close_gaps(blends, out.blends)};
}

size_t pack_impostors(const Atlas& atlas, const ImpostorArrays& avatars, const PackConfig& config,
                      std::span<ImpostorInstance> out) {
  return pack_levels(atlas, avatars, config, {}, {.meshes = {}, .views = out, .points = {}}).views;
}

}  // namespace throng
