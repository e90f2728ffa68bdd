// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// The inner loops of packing: a block of avatars at a time, in arrays that fit the first-level
/// cache.
namespace throng::impostor {

inline constexpr size_t kPackBlock = 1024;

/// Inside: x * px + y * py + z * pz + offset >= 0.
struct PackPlane {
  float x = 0, y = 0, z = 0, offset = 0;
};

/// Values of a picture that are the same for all avatars.
struct PackShared {
  std::array<PackPlane, 6> planes;
  float eye_x = 0, eye_y = 0, eye_z = 0;
  bool fixed = false;                  ///< Seen from one direction, not from the eye.
  float to_x = 0, to_y = 0, to_z = 0;  ///< That direction.
  float centre = 0;                    ///< Of a view over the feet.
  uint32_t directions = 0, rows = 0, frames = 0, first_frame = 0;
  // Squares of LevelDistances.
  float mesh_near = 0, mesh_far = 0, point_near = 0, point_far = 0, blend_far = 0;
};

/// Bits of PackBlock::seen. `kSeenBetween`: by a view, or by four that blend.
inline constexpr uint32_t kSeenByView = 1, kSeenAsMesh = 2, kSeenAsPoint = 4, kSeenBetween = 8;

/// The same entries of each array of the avatars.
struct PackInput {
  const float *x, *y, *z;
  const uint16_t *heading, *phase, *look;
  size_t count;  ///< [<= kPackBlock]
};

struct PackBlock {
  alignas(64) std::array<float, kPackBlock> to_x, to_y, to_z;
  alignas(64) std::array<uint32_t, kPackBlock> view;  ///< ImpostorInstance::view.
  alignas(64) std::array<uint32_t, kPackBlock> seen;  ///< Drawn as what; 0: not in the picture.
  uint32_t seen_any = 0;                              ///< All of `seen`, or-ed.
};

/// Fills `seen` and `seen_any`, and `view` if any avatar is seen.
void find_views(const PackShared& shared, const PackInput& input, PackBlock& block);

}  // namespace throng::impostor
