// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "world/air_data.h"
#include "world/air_rows.h"

/// Where a body may fly: the free air eroded by it.
namespace throng::world {

/// Clears every voxel of `free` around which the body is not free; layers over the rows count as
/// free, voxels beside them do not. Word by word.
void erode_air(const AirBody& body, const AirRows& free, AirRows& legal);

/// The voxels of a zone in which a body may be, wherever in the voxel its feet are.
struct LegalAir {
  AirRows rows;      ///< The zone's first voxel is at (pad, base, pad).
  int32_t pad = 0;   ///< Voxels beside the zone. What is legal there is not known.
  int32_t base = 0;  ///< Layer of the rows' first.
};
/// None: the air of the zone, or of one near it, cannot be used.
[[nodiscard]] std::optional<LegalAir> find_legal_air(const AirData& air, const AirBody& body,
                                                     int32_t zone_x, int32_t zone_z);

}  // namespace throng::world
