// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/figure_frames.h"

#include <algorithm>
#include <string>

#include "impostor/gait.h"
#include "impostor/worn_parts.h"

// Poses all frames of all clips of a figure, on the spot, and measures them.
namespace throng::impostor {

Result<void> check_atlas_config(const AtlasConfig& config) {
  const auto bad = [](const std::string& what) {
    return Error{Errc::kBadConfig, "atlas: " + what};
  };
  if (config.clips.empty() || config.clips.size() > 16) return bad("need 1 to 16 clips");
  const bool even = config.frames == 1 || config.frames % 2 == 0;
  if (!(config.frames >= 1 && config.frames <= 64 && even)) {
    return bad("frames " + std::to_string(config.frames) +
               ": need 1, or an even number up to 64 (a mirrored view is half a cycle on)");
  }
  if (!(config.directions >= 2 && config.directions <= 64)) {
    return bad("directions " + std::to_string(config.directions) + ": need 2 to 64");
  }
  if (!(config.elevations >= 1 && config.elevations <= 32)) {
    return bad("elevations " + std::to_string(config.elevations) + ": need 1 to 32");
  }
  if (!(config.pixels >= 8 && config.pixels <= 256)) {
    return bad("pixels " + std::to_string(config.pixels) + ": need 8 to 256 a side of a view");
  }
  if (!(config.height >= 0 && config.height <= 100) || config.workers < 0) {
    return bad("need a height of 0 to 100 m, and workers >= 0");
  }
  return {};
}

Result<FigureFrames> pose_frames(const Character& character, const AtlasConfig& config) {
  FigureFrames poses;
  if (auto sound = check_worn(character); !sound) return sound.error();
  // The gait and the height are the body's, whatever it wears.
  const Character body = body_of(character);
  poses.body_vertices = body.positions.size();
  Box3d first_clip;
  for (const std::string& word : config.clips) {
    const Result<size_t> clip = find_clip(character, word);
    if (!clip) return clip.error();
    const ClipPlace place = place_of_clip(body, *clip);
    poses.clips.push_back({.name = character.clips[*clip].name,
                           .first_frame = static_cast<int32_t>(poses.frames.size()),
                           .frames = config.frames,
                           .seconds = character.clips[*clip].seconds,
                           .stride = stride_of_clip(body, *clip, place)});
    for (int32_t f = 0; f < config.frames; ++f) {
      pose_in_place(character, *clip, place, static_cast<double>(f) / config.frames,
                    poses.frames.emplace_back());
      const std::vector<Vec3d>& positions = poses.frames.back().positions;
      for (size_t v = 0; v < poses.body_vertices && poses.clips.size() == 1; ++v) {
        first_clip.add(positions[v]);
      }
    }
  }
  const double own_height = first_clip.max.y - first_clip.min.y;
  if (!(own_height > 1e-9 && own_height < 1e9)) {
    return Error{Errc::kBadInput,
                 "atlas: the character has no height in its first clip; "
                 "check its mesh and its skeleton"};
  }
  const double scale = config.height > 0 ? config.height / own_height : 1;
  poses.height = own_height * scale;
  double worn_radius = 0;
  for (PosedMesh& mesh : poses.frames) {
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      Vec3d& p = mesh.positions[v];
      p = Vec3d{p.x, p.y - first_clip.min.y, p.z} * scale;
      double& radius = v < poses.body_vertices ? poses.radius : worn_radius;
      radius = std::max(radius, length(p - Vec3d{0, 0.5 * poses.height, 0}));
    }
  }
  // A view has an empty texel more around the body than it needs: what is worn may reach into it.
  poses.radius = std::max(poses.radius, worn_radius * (1 - 2.0 / config.pixels));
  for (AtlasClip& clip : poses.clips) clip.stride *= scale;
  return poses;
}

}  // namespace throng::impostor
