// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "impostor/figure_frames.h"
#include "impostor/srgb.h"
#include "throng/impostor.h"

// Makes the poses of a figure's clips as vertices in textures: the card blends two poses with two
// texel fetches a vertex, whatever the skeleton. Bones stay on the processor.
namespace throng {
namespace {

constexpr size_t kMaxPosed = 4'000'000;

// Two bytes on the octahedron |x| + |y| + |z| = 1, its lower half folded over the upper.
uint16_t fold_normal(Vec3d n) {
  const double size = std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z);
  double u = n.x / size, v = n.z / size;
  if (n.y < 0) {
    const double old = u;
    u = (1 - std::fabs(v)) * (u < 0 ? -1 : 1);
    v = (1 - std::fabs(old)) * (v < 0 ? -1 : 1);
  }
  const auto byte = [](double value) {
    return static_cast<uint32_t>(std::clamp(value, -1.0, 1.0) * 127 + 128.5);
  };
  return static_cast<uint16_t>(byte(u) | byte(v) << 8);
}

uint16_t share_of(double value, double low, double high) {
  const double share = high > low ? (value - low) / (high - low) : 0;
  return static_cast<uint16_t>(std::clamp(share, 0.0, 1.0) * 65535 + 0.5);
}

}  // namespace

Result<FigureModel> create_figure_model(const Character& character, const AtlasConfig& config,
                                        Context& context) {
  if (auto sound = impostor::check_atlas_config(config); !sound) return sound.error();
  Result<impostor::FigureFrames> frames = impostor::pose_frames(character, config);
  if (!frames) return frames.error();
  FigureModel model;
  model.clips = std::move(frames->clips);
  // A position of two materials becomes two vertices.
  std::map<std::pair<uint32_t, uint8_t>, uint32_t> numbers;
  std::vector<uint32_t> position_of;
  for (size_t t = 0; t < character.triangles.size(); ++t) {
    std::array<uint32_t, 3> corners{};
    for (size_t k = 0; k < 3; ++k) {
      const auto next = static_cast<uint32_t>(position_of.size());
      const uint32_t position = character.triangles[t][k];
      const auto [at, is_new] = numbers.try_emplace({position, character.material[t]}, next);
      corners[k] = at->second;
      if (!is_new) continue;
      position_of.push_back(position);
      const CharacterMaterial& material = character.materials[character.material[t]];
      model.paint.push_back({.colour = {impostor::encode_colour(material.colour.x),
                                        impostor::encode_colour(material.colour.y),
                                        impostor::encode_colour(material.colour.z)},
                             .part = static_cast<uint8_t>(material.part)});
    }
    model.triangles.push_back(corners);
  }
  model.worn = character.worn;
  model.vertices = static_cast<uint32_t>(position_of.size());
  const size_t posed = position_of.size() * frames->frames.size();
  if (posed > kMaxPosed) {
    return Error{Errc::kLimit, "figure: " + std::to_string(posed) +
                                   " vertices in all poses, more "
                                   "than " +
                                   std::to_string(kMaxPosed) +
                                   "; take fewer frames, or a simpler character"};
  }
  Box3d box;
  for (const PosedMesh& frame : frames->frames) {
    for (const Vec3d& p : frame.positions) box.add(p);
  }
  model.low = box.min;
  model.high = box.max;
  model.poses.reserve(posed);
  for (const PosedMesh& frame : frames->frames) {
    if (context.cancel) return Error{Errc::kCancelled, "figure: cancelled"};
    for (const uint32_t position : position_of) {
      const Vec3d p = frame.positions[position];
      model.poses.push_back({.x = share_of(p.x, box.min.x, box.max.x),
                             .y = share_of(p.y, box.min.y, box.max.y),
                             .z = share_of(p.z, box.min.z, box.max.z),
                             .normal = fold_normal(frame.normals[position])});
    }
  }
  return model;
}

}  // namespace throng
