// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "impostor/affine.h"
#include "throng/impostor.h"

// Linear blend skinning: every vertex is moved by the weighted sum of its bones' matrices.
namespace throng {
namespace {

using impostor::operator*;

// The two keys around `time`, and the share of the second; constant before the first and after the
// last.
struct Keys {
  size_t low = 0, high = 0;
  double share = 0;
};

Keys find_keys(const std::vector<double>& times, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return {};
  const auto low = static_cast<size_t>(after - times.begin()) - 1;
  if (after == times.end()) return {low, low, 0};
  const double interval = times[low + 1] - times[low];
  return {low, low + 1, interval > 0 ? (time - times[low]) / interval : 0};
}

Vec3d value_at(const std::vector<double>& times, const std::vector<Vec3d>& values, double time) {
  const Keys b = find_keys(times, time);
  return values[b.low] + (values[b.high] - values[b.low]) * b.share;
}

// Interpolates linearly between two unit quaternions, on the shorter side, and normalises: with
// keys as dense as those of a walk the difference to the arc is not visible.
std::array<double, 4> rotation_at(const JointTrack& track, double time) {
  const Keys b = find_keys(track.rotation_times, time);
  const auto& low = track.rotations[b.low];
  const auto& high = track.rotations[b.high];
  double along = 0;
  for (size_t k = 0; k < 4; ++k) along += low[k] * high[k];
  const double sign = along < 0 ? -1 : 1;
  std::array<double, 4> q{};
  double square = 0;
  for (size_t k = 0; k < 4; ++k) {
    q[k] = low[k] + (sign * high[k] - low[k]) * b.share;
    square += q[k] * q[k];
  }
  if (!(square > 0)) return low;
  for (double& value : q) value /= std::sqrt(square);
  return q;
}

// The rotation of a joint at rest, without its scale.
Transform without_scale(const Transform& rest, Vec3d scale) {
  Transform t = rest;
  const double by[3] = {scale.x, scale.y, scale.z};
  for (auto& row : t.m) {
    for (size_t c = 0; c < 3; ++c) row[c] = by[c] > 0 ? row[c] / by[c] : row[c];
  }
  return t;
}

Transform local_pose(const Joint& joint, const JointTrack& track, double time) {
  const Transform& rest = joint.rest;
  Vec3d scale{length(impostor::column(rest, 0)), length(impostor::column(rest, 1)),
              length(impostor::column(rest, 2))};
  const Transform rest_turn = without_scale(rest, scale);
  if (!track.scales.empty()) scale = value_at(track.scale_times, track.scales, time);
  const Vec3d position = track.positions.empty()
                             ? impostor::column(rest, 3)
                             : value_at(track.position_times, track.positions, time);
  if (!track.rotations.empty()) return impostor::compose(position, rotation_at(track, time), scale);
  Transform t;
  const double by[3] = {scale.x, scale.y, scale.z};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) t.m[r][c] = rest_turn.m[r][c] * by[c];
  }
  t.m[0][3] = position.x;
  t.m[1][3] = position.y;
  t.m[2][3] = position.z;
  return t;
}

Transform blend(const std::vector<Transform>& bones, const Influence& influence) {
  Transform sum;
  for (auto& row : sum.m) row = {};
  for (size_t k = 0; k < 4; ++k) {
    const double weight = influence.weight[k];
    if (weight == 0) continue;
    const Transform& bone = bones[influence.bone[k]];
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 4; ++c) sum.m[r][c] += weight * bone.m[r][c];
    }
  }
  return sum;
}

}  // namespace

void pose_character(const Character& character, size_t clip, double seconds, PosedMesh& out) {
  THRONG_ASSERT(clip < character.clips.size());
  const Clip& movement = character.clips[clip];
  const double length_of_cycle = movement.seconds;
  double time = 0;
  if (length_of_cycle > 0) {
    time = seconds - std::floor(seconds / length_of_cycle) * length_of_cycle;
  }
  std::vector<Transform> placed;
  placed.reserve(character.joints.size());
  for (const Joint& joint : character.joints) placed.push_back(joint.rest);
  for (const JointTrack& track : movement.tracks) {
    const auto joint = static_cast<size_t>(track.joint);
    placed[joint] = local_pose(character.joints[joint], track, time);
  }
  for (size_t j = 0; j < placed.size(); ++j) {
    const int32_t parent = character.joints[j].parent;
    if (parent >= 0) placed[j] = placed[static_cast<size_t>(parent)] * placed[j];
  }
  std::vector<Transform> bones;
  bones.reserve(character.bones.size());
  for (const Bone& bone : character.bones) {
    bones.push_back(placed[static_cast<size_t>(bone.joint)] * bone.inverse_bind);
  }
  out.positions.resize(character.positions.size());
  out.normals.resize(character.positions.size());
  for (size_t v = 0; v < character.positions.size(); ++v) {
    const Transform t = blend(bones, character.influences[v]);
    out.positions[v] = t(character.positions[v]);
    const Vec3d normal = impostor::turn(t, character.normals[v]);
    const double size = length(normal);
    out.normals[v] = size > 0 ? normal * (1 / size) : Vec3d{0, 1, 0};
  }
}

}  // namespace throng
