// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/math/trig.h"
#include "impostor/figure_mesh.h"
#include "throng/impostor.h"

// Makes a simple person: 16 joints, tubes for a body, and a gait with the joint angles of
// textbooks: the hip follows a cosine, the knee flexes a little as it takes the weight and more as
// it swings, the foot is flat while it stands. The height of the pelvis follows from the standing
// foot.
namespace throng {
namespace {

enum Bones : uint8_t {
  kHips,
  kChest,
  kHead,
  kThighL,
  kThighR,
  kShinL,
  kShinR,
  kFootL,
  kFootR,
  kArmL,
  kArmR,
  kForearmL,
  kForearmR,
  kBoneCount
};

enum Materials : uint8_t { kSkinM, kHairM, kShirtM, kPantsM, kShoesM, kEyesM };

struct JointPlan {
  const char* name;
  int32_t parent;
  Vec3d place;  // At rest, from the ground.
};

constexpr std::array<JointPlan, kBoneCount> kPlan{{
    {"hips", -1, {0, 0.95, 0}},
    {"chest", kHips, {0, 1.12, -0.005}},
    {"head", kChest, {0, 1.50, -0.005}},
    {"thigh.L", kHips, {0.092, 0.91, 0}},
    {"thigh.R", kHips, {-0.092, 0.91, 0}},
    {"shin.L", kThighL, {0.092, 0.49, 0.005}},
    {"shin.R", kThighR, {-0.092, 0.49, 0.005}},
    {"foot.L", kShinL, {0.092, 0.085, -0.015}},
    {"foot.R", kShinR, {-0.092, 0.085, -0.015}},
    {"arm.L", kChest, {0.185, 1.405, -0.01}},
    {"arm.R", kChest, {-0.185, 1.405, -0.01}},
    {"forearm.L", kArmL, {0.215, 1.125, -0.01}},
    {"forearm.R", kArmR, {-0.215, 1.125, -0.01}},
}};

void add_leg(Character& c, double side, uint8_t thigh, uint8_t shin, uint8_t foot) {
  const double x = side * 0.092;
  impostor::add_tube(c,
                     {{{x, 0.075, -0.012}, 0.048, 0.052, shin},
                      {{x, 0.10, -0.012}, 0.050, 0.055, shin},
                      {{x, 0.22, -0.012}, 0.052, 0.060, shin},
                      {{x, 0.34, -0.010}, 0.058, 0.066, shin},
                      {{x, 0.43, 0.000}, 0.058, 0.063, shin, thigh, 0.2},
                      {{x, 0.49, 0.006}, 0.059, 0.064, shin, thigh, 0.5},
                      {{x, 0.55, 0.006}, 0.064, 0.069, thigh, shin, 0.2},
                      {{x, 0.68, 0.004}, 0.076, 0.082, thigh},
                      {{x * 0.97, 0.80, 0.000}, 0.086, 0.094, thigh},
                      {{x * 0.93, 0.88, -0.004}, 0.088, 0.102, thigh, kHips, 0.4},
                      {{x * 0.80, 0.94, -0.004}, 0.080, 0.100, kHips}},
                     kPantsM);
  impostor::add_tube(c,
                     {{{x, 0.0, 0.045}, 0.046, 0.135, foot},
                      {{x, 0.028, 0.045}, 0.050, 0.138, foot},
                      {{x, 0.055, 0.030}, 0.048, 0.112, foot},
                      {{x, 0.085, -0.005}, 0.044, 0.068, foot},
                      {{x, 0.110, -0.012}, 0.040, 0.050, foot}},
                     kShoesM);
}

void add_arm(Character& c, double side, uint8_t arm, uint8_t forearm) {
  const auto at = [&](double x, double y, double z) { return Vec3d{side * x, y, z}; };
  impostor::add_tube(c,
                     {{at(0.217, 1.10, -0.008), 0.047, 0.050, forearm, arm, 0.4},
                      {at(0.215, 1.14, -0.010), 0.048, 0.051, arm, forearm, 0.4},
                      {at(0.209, 1.24, -0.010), 0.051, 0.055, arm},
                      {at(0.197, 1.36, -0.010), 0.055, 0.062, arm},
                      {at(0.182, 1.415, -0.010), 0.054, 0.062, arm, kChest, 0.3},
                      {at(0.160, 1.447, -0.010), 0.040, 0.048, kChest}},
                     kShirtM);
  impostor::add_tube(c,
                     {{at(0.222, 0.765, 0.010), 0.012, 0.022, forearm},
                      {at(0.222, 0.800, 0.008), 0.022, 0.042, forearm},
                      {at(0.222, 0.850, 0.004), 0.023, 0.044, forearm},
                      {at(0.222, 0.885, 0.000), 0.025, 0.032, forearm},
                      {at(0.222, 0.960, -0.004), 0.031, 0.035, forearm},
                      {at(0.219, 1.060, -0.008), 0.040, 0.042, forearm},
                      {at(0.217, 1.120, -0.010), 0.040, 0.042, forearm, arm, 0.4}},
                     kSkinM);
}

void add_trunk(Character& c) {
  impostor::add_tube(c,
                     {{{0, 0.845, -0.004}, 0.100, 0.090, kHips},
                      {{0, 0.90, -0.006}, 0.160, 0.116, kHips},
                      {{0, 0.97, -0.006}, 0.160, 0.112, kHips},
                      {{0, 1.01, -0.004}, 0.150, 0.104, kHips}},
                     kPantsM);
  impostor::add_tube(c,
                     {{{0, 0.955, -0.004}, 0.166, 0.118, kHips},
                      {{0, 1.02, -0.004}, 0.158, 0.112, kHips, kChest, 0.3},
                      {{0, 1.10, -0.002}, 0.150, 0.108, kChest, kHips, 0.4},
                      {{0, 1.20, 0.002}, 0.160, 0.114, kChest},
                      {{0, 1.30, 0.004}, 0.178, 0.120, kChest},
                      {{0, 1.38, -0.002}, 0.188, 0.112, kChest},
                      {{0, 1.43, -0.008}, 0.166, 0.090, kChest},
                      {{0, 1.465, -0.012}, 0.105, 0.068, kChest},
                      {{0, 1.485, -0.010}, 0.062, 0.060, kChest}},
                     kShirtM);
}

void add_head(Character& c) {
  impostor::add_tube(c,
                     {{{0, 1.46, -0.008}, 0.054, 0.054, kChest},
                      {{0, 1.50, -0.002}, 0.052, 0.053, kHead, kChest, 0.4},
                      {{0, 1.525, 0.010}, 0.055, 0.066, kHead},
                      {{0, 1.55, 0.018}, 0.064, 0.086, kHead},
                      {{0, 1.60, 0.010}, 0.075, 0.098, kHead},
                      {{0, 1.65, 0.006}, 0.078, 0.100, kHead},
                      {{0, 1.70, 0.000}, 0.070, 0.092, kHead},
                      {{0, 1.733, -0.004}, 0.045, 0.062, kHead}},
                     kSkinM);
  impostor::add_tube(c,
                     {{{0, 1.545, -0.046}, 0.052, 0.048, kHead},
                      {{0, 1.59, -0.036}, 0.078, 0.070, kHead},
                      {{0, 1.64, -0.024}, 0.086, 0.088, kHead},
                      {{0, 1.685, -0.010}, 0.086, 0.100, kHead},
                      {{0, 1.72, -0.006}, 0.074, 0.094, kHead},
                      {{0, 1.742, -0.008}, 0.050, 0.066, kHead},
                      {{0, 1.75, -0.008}, 0.020, 0.030, kHead}},
                     kHairM);
  for (const double side : {1.0, -1.0}) {
    impostor::add_tube(c,
                       {{{side * 0.031, 1.630, 0.094}, 0.006, 0.006, kHead},
                        {{side * 0.031, 1.638, 0.096}, 0.011, 0.009, kHead},
                        {{side * 0.031, 1.646, 0.094}, 0.006, 0.006, kHead}},
                       kEyesM);
  }
}

// --- Movement. Angles in turns; bending forward is positive. ------------------------------------

// A rounded bump of height 1 around `at`, `width` to each side; phases wrap.
double bump(double phase, double at, double width) {
  double off = phase - at;
  off -= std::floor(off + 0.5);
  return std::fabs(off) < width ? 0.5 + 0.5 * cos_turns(0.5 * off / width) : 0;
}

// Phase 0: the heel of this leg touches the ground.
struct LegAngles {
  double hip = 0, knee = 0, foot = 0;  // Foot: to the ground, toes up positive.
};

LegAngles leg_at(double phase) {
  LegAngles a;
  a.hip = 0.018 + 0.062 * cos_turns(phase - 0.02);
  a.knee = 0.012 + 0.040 * bump(phase, 0.14, 0.15) + 0.160 * bump(phase, 0.72, 0.25);
  a.foot = 0.050 * bump(phase, 0.0, 0.12) - 0.105 * bump(phase, 0.62, 0.2);
  return a;
}

std::array<double, 4> pitch(double forward) {
  return {-sin_turns(0.5 * forward), 0, 0, cos_turns(0.5 * forward)};
}

std::array<double, 4> yaw(double left) {
  return {0, sin_turns(0.5 * left), 0, cos_turns(0.5 * left)};
}

std::array<double, 4> roll(double left_up) {
  return {0, 0, sin_turns(0.5 * left_up), cos_turns(0.5 * left_up)};
}

std::array<double, 4> product(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

using Pose = std::array<std::array<double, 4>, kBoneCount>;

Pose walking(double phase) {
  Pose pose;
  pose.fill({0, 0, 0, 1});
  for (const int side : {0, 1}) {
    const double own = phase + 0.5 * side;
    const auto s = static_cast<size_t>(side);
    const LegAngles leg = leg_at(own - std::floor(own));
    pose[kThighL + s] = pitch(leg.hip);
    pose[kShinL + s] = pitch(-leg.knee);
    pose[kFootL + s] = pitch(leg.foot - leg.hip + leg.knee);
    const double swing = -cos_turns(own - 0.02);  // Opposite to the leg of its side.
    const double outward = side == 0 ? 0.012 : -0.012;
    pose[kArmL + s] = product(pitch(0.005 + 0.060 * swing), roll(outward));
    pose[kForearmL + s] = pitch(0.045 + 0.030 * swing);
  }
  const double twist = cos_turns(phase);
  pose[kHips] = product(yaw(-0.012 * twist), roll(0.006 * sin_turns(phase)));
  pose[kChest] = product(yaw(0.026 * twist), pitch(-0.008));
  pose[kHead] = product(yaw(-0.014 * twist), pitch(0.004));
  return pose;
}

// Weight on both feet; breathing, and a slow turn of the head.
Pose standing(double phase) {
  Pose pose;
  pose.fill({0, 0, 0, 1});
  const double breath = 0.5 - 0.5 * cos_turns(2 * phase);
  pose[kChest] = pitch(-0.003 - 0.003 * breath);
  pose[kHead] = product(yaw(0.05 * sin_turns(phase)), pitch(0.004));
  for (const int side : {0, 1}) {
    const auto s = static_cast<size_t>(side);
    pose[kArmL + s] = product(pitch(0.004 * breath), roll(side == 0 ? 0.014 : -0.014));
    pose[kForearmL + s] = pitch(0.030);
  }
  return pose;
}

double lowest_of(const Character& character, size_t clip, double seconds) {
  PosedMesh mesh;
  pose_character(character, clip, seconds, mesh);
  double lowest = mesh.positions[0].y;
  for (const Vec3d& p : mesh.positions) lowest = std::min(lowest, p.y);
  return lowest;
}

template <class PoseAt>
void add_clip(Character& character, const char* name, double seconds, PoseAt pose_at) {
  constexpr int32_t kKeys = 40;
  Clip clip{.name = name, .seconds = seconds, .tracks = {}};
  for (int32_t bone = 0; bone < kBoneCount; ++bone) {
    JointTrack& track = clip.tracks.emplace_back();
    track.joint = bone;
    for (int32_t k = 0; k <= kKeys; ++k) {
      track.rotation_times.push_back(seconds * k / kKeys);
      track.rotations.push_back(
          pose_at(static_cast<double>(k % kKeys) / kKeys)[static_cast<size_t>(bone)]);
    }
  }
  character.clips.push_back(std::move(clip));
  // Then the height of the hips follows from the lowest foot.
  const size_t index = character.clips.size() - 1;
  std::vector<double> lowest;
  for (int32_t k = 0; k < kKeys; ++k) {
    lowest.push_back(lowest_of(character, index, seconds * k / kKeys));
  }
  JointTrack& hips = character.clips[index].tracks[kHips];
  for (int32_t k = 0; k <= kKeys; ++k) {
    hips.position_times.push_back(seconds * k / kKeys);
    hips.positions.push_back(kPlan[kHips].place -
                             Vec3d{0, lowest[static_cast<size_t>(k % kKeys)], 0});
  }
}

}  // namespace

Character built_in_character() {
  Character c;
  c.materials = {{"Skin", {0.50, 0.30, 0.20}, BodyPart::kSkin},
                 {"Hair", {0.045, 0.028, 0.020}, BodyPart::kHair},
                 {"Shirt", {0.42, 0.45, 0.48}, BodyPart::kShirt},
                 {"Pants", {0.13, 0.15, 0.20}, BodyPart::kPants},
                 {"Shoes", {0.06, 0.05, 0.045}, BodyPart::kShoes},
                 {"Eyes", {0.03, 0.025, 0.02}, BodyPart::kOther}};
  for (size_t j = 0; j < kBoneCount; ++j) {
    const JointPlan& plan = kPlan[j];
    const auto moved = [](Vec3d by) {
      Transform t;
      t.m[0][3] = by.x;
      t.m[1][3] = by.y;
      t.m[2][3] = by.z;
      return t;
    };
    const Vec3d above = plan.parent < 0 ? Vec3d{} : kPlan[static_cast<size_t>(plan.parent)].place;
    c.joints.push_back(
        {.name = plan.name, .parent = plan.parent, .rest = moved(plan.place - above)});
    c.bones.push_back({.joint = static_cast<int32_t>(j), .inverse_bind = moved(plan.place * -1.0)});
  }
  add_trunk(c);
  add_head(c);
  add_leg(c, 1, kThighL, kShinL, kFootL);
  add_leg(c, -1, kThighR, kShinR, kFootR);
  add_arm(c, 1, kArmL, kForearmL);
  add_arm(c, -1, kArmR, kForearmR);
  add_clip(c, "Walk", 1.06, walking);
  add_clip(c, "Idle", 4.0, standing);
  return c;
}

}  // namespace throng
