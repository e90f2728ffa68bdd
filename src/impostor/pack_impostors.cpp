// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "impostor/pack_loops.h"
#include "throng/impostor_pack.h"

// Blocks of avatars: short loops over arrays that stay in the first cache find who is in the
// picture and which view shows them, another writes out those who are. A block writes at its own
// place; then the gaps that those left behind who are not seen are closed, in order.
namespace throng {
namespace {

// The six sides of what a camera sees, each moved out by `reach`.
std::array<PackPlane, 6> planes_of(const EyeCamera& camera, double reach) {
  const CameraAxes axes = camera_axes(camera);
  const double up = std::tan(0.5 * camera.field_of_view), right = up * camera.aspect;
  const auto plane = [&](Vec3d normal, double offset) {
    normal = normal * (1 / length(normal));
    return PackPlane{static_cast<float>(normal.x), static_cast<float>(normal.y),
                     static_cast<float>(normal.z),
                     static_cast<float>(offset - dot(normal, camera.eye) + reach)};
  };
  return {plane(axes.forward * right + axes.right, 0), plane(axes.forward * right - axes.right, 0),
          plane(axes.forward * up + axes.up, 0),       plane(axes.forward * up - axes.up, 0),
          plane(axes.forward, -camera.nearest),        plane(axes.forward * -1, camera.furthest)};
}

// Without a branch: who is not seen is overwritten by the next.
size_t write_seen(const float* x, const float* y, const float* z, size_t count,
                  const PackBlock& block, ImpostorInstance* out) {
  size_t written = 0;
  for (size_t i = 0; i < count; ++i) {
    out[written] = {x[i], y[i], z[i], block.view[i]};
    written += block.seen[i];
  }
  return written;
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

size_t pack_impostors(const Atlas& atlas, const ImpostorArrays& avatars, const PackConfig& config,
                      std::span<ImpostorInstance> out) {
  const size_t count = avatars.x.size();
  THRONG_ASSERT(avatars.y.size() == count && avatars.z.size() == count &&
                avatars.heading.size() == count && avatars.phase.size() == count &&
                avatars.look.size() == count && out.size() >= count &&
                config.clip < atlas.clips.size());
  const AtlasClip& clip = atlas.clips[config.clip];
  PackShared s{.planes = planes_of(config.camera, 0.5 * atlas.shape.side),
               .eye_x = static_cast<float>(config.camera.eye.x),
               .eye_y = static_cast<float>(config.camera.eye.y),
               .eye_z = static_cast<float>(config.camera.eye.z),
               .fixed = config.from_direction.has_value(),
               .centre = static_cast<float>(atlas.shape.centre),
               .directions = static_cast<uint32_t>(atlas.shape.directions),
               .rows = static_cast<uint32_t>(atlas.shape.elevations),
               .frames = static_cast<uint32_t>(clip.frames),
               .first_frame = static_cast<uint32_t>(clip.first_frame)};
  if (s.fixed) {
    s.to_x = static_cast<float>(config.from_direction->x);
    s.to_y = static_cast<float>(config.from_direction->y);
    s.to_z = static_cast<float>(config.from_direction->z);
  }
  const size_t blocks = (count + kPackBlock - 1) / kPackBlock;
  std::vector<uint32_t> kept(blocks);
  parallel_ranges(blocks, 4, config.workers, [&](size_t begin, size_t end) {
    PackBlock block;
    for (size_t b = begin; b < end; ++b) {
      const size_t first = b * kPackBlock, size = std::min(kPackBlock, count - first);
      find_views(s,
                 {&avatars.x[first], &avatars.y[first], &avatars.z[first], &avatars.heading[first],
                  &avatars.phase[first], &avatars.look[first], size},
                 block);
      kept[b] = static_cast<uint32_t>(write_seen(&avatars.x[first], &avatars.y[first],
                                                 &avatars.z[first], size, block, &out[first]));
    }
  });
  size_t total = 0;
  for (size_t b = 0; b < blocks; ++b) {
    if (total != b * kPackBlock && kept[b] > 0) {
      std::memmove(&out[total], &out[b * kPackBlock], kept[b] * sizeof out[0]);
    }
    total += kept[b];
  }
  return total;
}

}  // namespace throng
