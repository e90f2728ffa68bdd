// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/gait.h"

#include <algorithm>
#include <limits>
#include <vector>

// Finds the speed of a walk without knowing which bones are feet. Under a figure that walks on the
// spot, a foot that stands is near the ground and moves back at the walking speed, and the other
// foot moves forward. So the speed at a moment is that of the low vertex that moves back fastest,
// and the median over all moments is the speed of the walk: toes that scrape the ground and heels
// that roll off it are few.
namespace throng::impostor {
namespace {

constexpr int32_t kMoments = 96;
constexpr double kNearGroundShare = 0.04;  // Of the figure's height: near the ground.
// Of the figure's height in a whole cycle: it does not walk.
constexpr double kMinStrideShare = 0.1;

Vec3d mean_on_ground(const PosedMesh& mesh) {
  Vec3d sum;
  for (const Vec3d& p : mesh.positions) sum = sum + p;
  sum = sum * (1.0 / static_cast<double>(std::max<size_t>(1, mesh.positions.size())));
  return {sum.x, 0, sum.z};
}

}  // namespace

ClipPlace place_of_clip(const Character& character, size_t clip) {
  const double seconds = character.clips[clip].seconds;
  PosedMesh mesh;
  pose_character(character, clip, 0, mesh);
  const Vec3d begin = mean_on_ground(mesh);
  // The last moment itself would wrap to the first.
  constexpr double kLastMoment = 1 - 1e-9;
  pose_character(character, clip, seconds * kLastMoment, mesh);
  ClipPlace place{.middle = {}, .drift = mean_on_ground(mesh) - begin};
  Vec3d sum;
  constexpr int32_t kSamples = 8;
  for (int32_t i = 0; i < kSamples; ++i) {
    const double share = static_cast<double>(i) / kSamples;
    pose_character(character, clip, seconds * share, mesh);
    sum = sum + mean_on_ground(mesh) - place.drift * share;
  }
  place.middle = sum * (1.0 / kSamples);
  return place;
}

void pose_in_place(const Character& character, size_t clip, const ClipPlace& place, double share,
                   PosedMesh& out) {
  pose_character(character, clip, character.clips[clip].seconds * share, out);
  const Vec3d off = place.middle + place.drift * share;
  for (Vec3d& p : out.positions) p = p - off;
}

double stride_of_clip(const Character& character, size_t clip, const ClipPlace& place) {
  PosedMesh now, next;
  std::vector<double> back;
  Box3d bounds;
  pose_in_place(character, clip, place, 0, now);
  for (const Vec3d& p : now.positions) bounds.add(p);
  const double height = bounds.max.y - bounds.min.y;
  for (int32_t i = 0; i < kMoments; ++i) {
    const double share = static_cast<double>(i + 1) / kMoments;
    pose_in_place(character, clip, place, share < 1 ? share : 1 - 1e-9, next);
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vec3d& p : now.positions) lowest = std::min(lowest, p.y);
    double fastest = -std::numeric_limits<double>::infinity();
    for (size_t v = 0; v < now.positions.size(); ++v) {
      if (now.positions[v].y > lowest + kNearGroundShare * height) continue;
      fastest = std::max(fastest, now.positions[v].z - next.positions[v].z);
    }
    back.push_back(fastest * kMoments);
    std::swap(now, next);
  }
  std::nth_element(back.begin(), back.begin() + kMoments / 2, back.end());
  const double stride = back[kMoments / 2];
  return stride < kMinStrideShare * height ? 0 : stride;
}

}  // namespace throng::impostor
