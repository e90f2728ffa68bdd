// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/choose_view.h"

#include <cmath>

#include "throng/impostor.h"

// Chooses the view of an atlas for one avatar: column by heading and direction, row by elevation,
// frame by phase. Source: [TC00] 2.
namespace throng {
namespace {

double wrap(double turns) {
  const double rest = turns - std::floor(turns);
  return rest < 1 ? rest : 0;
}

}  // namespace

ViewChoice choose_view(const AtlasShape& shape, const AtlasClip& clip, Vec3d to_eye, double heading,
                       double phase) {
  const auto x = static_cast<float>(to_eye.x), z = static_cast<float>(to_eye.z);
  const auto sectors = static_cast<uint32_t>(2 * shape.directions);
  const auto sector = static_cast<int32_t>(impostor::view_sector(
      x, z, impostor::angle_steps(static_cast<float>(wrap(heading))), sectors));
  ViewChoice choice;
  choice.mirrored = sector >= shape.directions;
  choice.column = choice.mirrored ? 2 * shape.directions - 1 - sector : sector;
  choice.row = static_cast<int32_t>(impostor::view_row(std::sqrt(x * x + z * z),
                                                       static_cast<float>(to_eye.y),
                                                       static_cast<uint32_t>(shape.elevations)));
  auto frame = static_cast<int32_t>(wrap(phase) * clip.frames + 0.5) % clip.frames;
  if (choice.mirrored) frame = (frame + clip.frames / 2) % clip.frames;
  choice.frame = clip.first_frame + frame;
  return choice;
}

double walk_phase(const AtlasClip& clip, double distance, double start, double seconds) {
  if (clip.stride != 0) return wrap(start + distance / clip.stride);
  return wrap(clip.seconds > 0 ? start + seconds / clip.seconds : start);
}

}  // namespace throng
