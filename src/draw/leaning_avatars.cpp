// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/leaning_avatars.h"

#include <cmath>

#include "throng/avatar.h"

// Packs avatars that lean. A leaning figure looks like an upright one to an eye turned by the
// opposite rotation, so the same views serve, on cards that lean. An avatar on a wall is seen from
// the free side of the wall, which is above it, so the rows over the horizon suffice.
namespace throng::draw {
namespace {

uint32_t word_of(const AtlasShape& shape, const ViewChoice& choice) {
  return static_cast<uint32_t>(shape.view(choice.frame, choice.row, choice.column)) |
         (choice.mirrored ? 1U << 20 : 0U);
}

}  // namespace

LevelCounts pack_leaning(const Atlas& atlas, const DrawnCrowd& crowd, const PackConfig& config,
                         const LevelDistances& levels, const LeaningSpans& out) {
  const ImpostorArrays& a = crowd.avatars;
  THRONG_ASSERT(crowd.up_vectors.size() == a.x.size());
  const EyeCamera& camera = config.camera;
  const CameraAxes axes = camera_axes(camera);
  const double up = std::tan(0.5 * camera.field_of_view), right = up * camera.aspect;
  const double radius = 0.5 * atlas.shape.side;
  LevelCounts counts;
  for (size_t i = 0; i < a.x.size(); ++i) {
    const Vec3d feet{a.x[i], a.y[i], a.z[i]}, axis = crowd.up_vectors[i];
    const Vec3d from_eye = feet + axis * atlas.shape.centre - camera.eye;
    const double depth = dot(from_eye, axes.forward);
    // Is the figure outside a side plane of the view frustum by more than its radius?
    const auto outside = [&](Vec3d across, double slope) {
      return std::fabs(dot(from_eye, across)) - depth * slope > radius * std::hypot(1, slope);
    };
    if (depth + radius < camera.nearest || depth - radius > camera.furthest ||
        outside(axes.right, right) || outside(axes.up, up)) {
      continue;
    }
    const double far = length(from_eye);
    const uint32_t look = static_cast<uint32_t>(a.appearance[i]) << 21;
    LeaningInstance instance{.body = {a.x[i], a.y[i], a.z[i], 0},
                             .up_x = static_cast<float>(axis.x),
                             .up_y = static_cast<float>(axis.y),
                             .up_z = static_cast<float>(axis.z),
                             .unused = 0};
    if (far < levels.mesh_far) {
      const uint32_t heading = ((a.heading[i] + 16U) & 0xffffU) >> 5, phase = a.phase[i] >> 6;
      instance.body.view = heading | phase << 11 | look;
      out.meshes[counts.meshes++] = instance;
    }
    if (far < levels.mesh_near) continue;
    const Vec3d to_eye = unleaned(config.from_direction.value_or(from_eye * -1), axis);
    instance.body.view =
        word_of(atlas.shape, choose_view(atlas.shape, atlas.clips[config.clip], to_eye,
                                         a.heading[i] / 65536.0, a.phase[i] / 65536.0)) |
        look;
    out.views[counts.views++] = instance;
  }
  return counts;
}

}  // namespace throng::draw
