// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/math/trig.h"

/// The arithmetic that chooses a view, for one avatar and for arrays. Angles are 65536 steps
/// a turn, so that sums wrap by themselves.
namespace throng::impostor {

/// An angle in turns as steps; any finite turns in [-1e4, 1e4].
inline uint32_t angle_steps(float turns) {
  return static_cast<uint32_t>(static_cast<int32_t>(turns * 65536.0F)) & 0xffffU;
}

/// The sector, of `sectors` in a turn, in which the direction to the eye lies relative to the
/// heading, and the position in it: 65536 a sector.
inline uint32_t fine_sector(float x, float z, uint32_t heading, uint32_t sectors) {
  const uint32_t seen = (angle_steps(turns_of(x, z)) - heading) & 0xffffU;
  return seen * sectors;
}
inline uint32_t view_sector(float x, float z, uint32_t heading, uint32_t sectors) {
  return fine_sector(x, z, heading, sectors) >> 16;
}

/// What a mirrored view shows instead of a frame.
inline uint32_t half_cycle_on(uint32_t frame, uint32_t frames) {
  const uint32_t half = frame + frames / 2;
  return half >= frames ? half - frames : half;
}

/// The row, of `rows` from the horizon to straight above, and the position in it: 65536 a row.
inline uint32_t fine_row(float flat, float rise, uint32_t rows) {
  const float above = rise > 0 ? rise : 0;
  // The angle from `flat` towards `rise` is at most a quarter turn.
  const uint32_t row = angle_steps(turns_of(above, flat)) * 4 * rows;
  return row < rows << 16 ? row : (rows << 16) - 1;
}
inline uint32_t view_row(float flat, float rise, uint32_t rows) {
  return fine_row(flat, rise, rows) >> 16;
}

}  // namespace throng::impostor
