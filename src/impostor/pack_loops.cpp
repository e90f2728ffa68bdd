// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/pack_loops.h"

#include <cmath>

#include "impostor/choose_view.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "impostor/pack_loops.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

// Loops without a branch, compiled once for each set of vector instructions: the compiler
// vectorises them, and the results are those of choose_view.
HWY_BEFORE_NAMESPACE();
namespace throng::impostor {
namespace HWY_NAMESPACE {

void FindSeen(const PackShared& s, const PackInput& in, PackBlock& block) {
  for (size_t i = 0; i < in.count; ++i) {
    const float px = in.x[i], py = in.y[i] + s.centre, pz = in.z[i];
    float min_inside =
        s.planes[0].x * px + s.planes[0].y * py + s.planes[0].z * pz + s.planes[0].offset;
    for (size_t k = 1; k < 6; ++k) {
      const PackPlane& p = s.planes[k];
      const float inside = p.x * px + p.y * py + p.z * pz + p.offset;
      min_inside = inside < min_inside ? inside : min_inside;
    }
    const float dx = s.eye_x - px, dy = s.eye_y - py, dz = s.eye_z - pz;
    const float far = dx * dx + dy * dy + dz * dz;
    const uint32_t near_view = far < s.blend_far ? kSeenBetween : kSeenByView;
    const uint32_t by_view = far >= s.mesh_near && far < s.point_far ? near_view : 0;
    const uint32_t as_mesh = far < s.mesh_far ? kSeenAsMesh : 0;
    const uint32_t as_point = far >= s.point_near ? kSeenAsPoint : 0;
    block.seen[i] = min_inside >= 0 ? by_view | as_mesh | as_point : 0;
    block.to_x[i] = s.fixed ? s.to_x : dx;
    block.to_y[i] = s.fixed ? s.to_y : dy;
    block.to_z[i] = s.fixed ? s.to_z : dz;
  }
  uint32_t any = 0;
  for (size_t i = 0; i < in.count; ++i) any |= block.seen[i];
  block.seen_any = any;
}

void FindViews(const PackShared& shared, const PackInput& input, PackBlock& block) {
  const PackShared s = shared;  // A copy, so that no write in the loop can change it.
  const PackInput in = input;
  FindSeen(s, in, block);
  if (block.seen_any == 0) return;  // None is drawn, so no view is needed.
  for (size_t i = 0; i < in.count; ++i) {
    const float x = block.to_x[i], y = block.to_y[i], z = block.to_z[i];
    const uint32_t sector = view_sector(x, z, in.heading[i], 2 * s.directions);
    const uint32_t row = view_row(std::sqrt(x * x + z * z), y, s.rows);
    const uint32_t mirrored = sector >= s.directions ? 1 : 0;
    const uint32_t column = mirrored != 0 ? 2 * s.directions - 1 - sector : sector;
    uint32_t frame = (in.phase[i] * s.frames + 32768) >> 16;
    frame = frame >= s.frames ? frame - s.frames : frame;
    const uint32_t other = half_cycle_on(frame, s.frames);
    frame = (mirrored != 0 ? other : frame) + s.first_frame;
    block.view[i] = ((frame * s.rows + row) * s.directions + column) | mirrored << 20 |
                    static_cast<uint32_t>(in.look[i]) << 21;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::impostor
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::impostor {

HWY_EXPORT(FindViews);

void find_views(const PackShared& shared, const PackInput& input, PackBlock& block) {
  HWY_DYNAMIC_DISPATCH(FindViews)(shared, input, block);
}

}  // namespace throng::impostor
#endif
