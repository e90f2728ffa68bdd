// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string_view>
#include <vector>

#include "impostor/figure_mesh.h"
#include "throng/impostor.h"

// Makes what the built-in character may wear: closed tubes a little outside of its body, of the
// body's materials. Left and right are alike, as mirrored views need it.
namespace throng {
namespace {

enum Materials : uint8_t { kHairM = 1, kShirtM = 2, kPantsM = 3, kShoesM = 4 };

uint8_t bone_of(const Character& c, std::string_view joint) {
  const auto found = std::find_if(c.bones.begin(), c.bones.end(), [&](const Bone& bone) {
    return c.joints[static_cast<size_t>(bone.joint)].name == joint;
  });
  return static_cast<uint8_t>(found - c.bones.begin());
}

template <class Build>
void add_part(Character& c, const char* name, WornKind kind, Build build) {
  const auto first = static_cast<uint32_t>(c.triangles.size());
  build();
  c.worn.push_back({name, kind, first, static_cast<uint32_t>(c.triangles.size()) - first});
}

void add_hair_and_hats(Character& c) {
  const uint8_t head = bone_of(c, "head"), chest = bone_of(c, "chest");
  add_part(c, "long hair", WornKind::kHair, [&] {
    impostor::add_tube(c,
                       {{{0, 1.345, -0.110}, 0.060, 0.022, chest, head, 0.4},
                        {{0, 1.40, -0.100}, 0.085, 0.036, chest, head, 0.5},
                        {{0, 1.47, -0.088}, 0.096, 0.050, head},
                        {{0, 1.56, -0.058}, 0.100, 0.074, head},
                        {{0, 1.64, -0.028}, 0.097, 0.098, head},
                        {{0, 1.69, -0.014}, 0.094, 0.108, head},
                        {{0, 1.73, -0.010}, 0.078, 0.098, head},
                        {{0, 1.757, -0.010}, 0.030, 0.040, head}},
                       kHairM);
  });
  add_part(c, "bun", WornKind::kHair, [&] {
    impostor::add_tube(c,
                       {{{0, 1.640, -0.118}, 0.020, 0.018, head},
                        {{0, 1.655, -0.132}, 0.048, 0.040, head},
                        {{0, 1.690, -0.138}, 0.058, 0.050, head},
                        {{0, 1.725, -0.128}, 0.046, 0.040, head},
                        {{0, 1.738, -0.115}, 0.020, 0.018, head}},
                       kHairM);
  });
  add_part(c, "hat", WornKind::kHat, [&] {
    impostor::add_tube(
        c, {{{0, 1.688, -0.006}, 0.150, 0.172, head}, {{0, 1.700, -0.006}, 0.154, 0.176, head}},
        kPantsM);
    impostor::add_tube(c,
                       {{{0, 1.690, -0.008}, 0.100, 0.118, head},
                        {{0, 1.765, -0.008}, 0.092, 0.110, head},
                        {{0, 1.795, -0.008}, 0.075, 0.092, head}},
                       kPantsM);
  });
  add_part(c, "cap", WornKind::kHat, [&] {
    impostor::add_tube(c,
                       {{{0, 1.672, -0.008}, 0.098, 0.114, head},
                        {{0, 1.715, -0.008}, 0.092, 0.110, head},
                        {{0, 1.752, -0.008}, 0.066, 0.082, head},
                        {{0, 1.768, -0.008}, 0.030, 0.040, head}},
                       kPantsM);
    impostor::add_tube(
        c, {{{0, 1.672, 0.100}, 0.066, 0.078, head}, {{0, 1.686, 0.094}, 0.064, 0.074, head}},
        kPantsM);
  });
}

void add_clothes(Character& c) {
  const uint8_t hips = bone_of(c, "hips"), chest = bone_of(c, "chest");
  add_part(c, "coat", WornKind::kCoat, [&] {
    impostor::add_tube(c,
                       {{{0, 0.850, -0.004}, 0.188, 0.152, hips},
                        {{0, 0.89, -0.004}, 0.184, 0.144, hips},
                        {{0, 0.97, -0.006}, 0.180, 0.132, hips},
                        {{0, 1.10, -0.002}, 0.168, 0.124, chest, hips, 0.4},
                        {{0, 1.20, 0.002}, 0.176, 0.130, chest},
                        {{0, 1.30, 0.004}, 0.193, 0.136, chest},
                        {{0, 1.38, -0.002}, 0.203, 0.128, chest},
                        {{0, 1.43, -0.008}, 0.182, 0.108, chest},
                        {{0, 1.475, -0.012}, 0.118, 0.086, chest},
                        {{0, 1.515, -0.010}, 0.078, 0.074, chest}},
                       kShirtM);
    for (const double side : {1.0, -1.0}) {
      const bool left = side > 0;
      const uint8_t arm = bone_of(c, left ? "arm.L" : "arm.R");
      const uint8_t forearm = bone_of(c, left ? "forearm.L" : "forearm.R");
      const auto at = [&](double x, double y, double z) { return Vec3d{side * x, y, z}; };
      impostor::add_tube(c,
                         {{at(0.222, 0.865, 0.002), 0.046, 0.052, forearm},
                          {at(0.222, 0.960, -0.004), 0.048, 0.052, forearm},
                          {at(0.218, 1.080, -0.008), 0.054, 0.057, forearm, arm, 0.3},
                          {at(0.215, 1.150, -0.010), 0.058, 0.061, arm, forearm, 0.3},
                          {at(0.209, 1.240, -0.010), 0.062, 0.066, arm},
                          {at(0.197, 1.360, -0.010), 0.066, 0.073, arm},
                          {at(0.182, 1.422, -0.010), 0.064, 0.072, arm, chest, 0.3},
                          {at(0.158, 1.458, -0.010), 0.048, 0.056, chest}},
                         kShirtM);
    }
  });
  add_part(c, "rucksack", WornKind::kBag, [&] {
    impostor::add_tube(c,
                       {{{0, 1.060, -0.190}, 0.110, 0.052, chest},
                        {{0, 1.100, -0.205}, 0.148, 0.086, chest},
                        {{0, 1.250, -0.215}, 0.156, 0.096, chest},
                        {{0, 1.370, -0.200}, 0.142, 0.082, chest},
                        {{0, 1.430, -0.175}, 0.096, 0.046, chest}},
                       kShoesM);
  });
  add_part(c, "skirt", WornKind::kSkirt, [&] {
    impostor::add_tube(c,
                       {{{0, 0.660, 0.000}, 0.206, 0.252, hips},
                        {{0, 0.750, -0.004}, 0.198, 0.222, hips},
                        {{0, 0.880, -0.006}, 0.182, 0.145, hips},
                        {{0, 0.960, -0.006}, 0.172, 0.124, hips},
                        {{0, 1.015, -0.004}, 0.160, 0.114, hips}},
                       kPantsM);
  });
}

}  // namespace

Character built_in_character_with_parts() {
  Character c = built_in_character();
  add_hair_and_hats(c);
  add_clothes(c);
  return c;
}

}  // namespace throng
