// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/layers/clearance.h"
#include "bake/layers/layers.h"
#include "world/zone_generated.h"

/// Packs the layers of a zone into a zone file's arrays: constants and planes where they serve, and
/// blocks of cells (world/cell_blocks.h), of which the zone holds each only once.
namespace throng::bake {

/// Replaces a layer's feet by a plane if that changes no height by more than 1 mm. Run before
/// legality is judged, so that everything after sees the feet that the moves will see.
struct FloorPlane {
  bool found = false;
  int32_t base = 0;                  // [mm], absolute, at the centre of cell (0, 0)
  int32_t part = 0;                  // of the base below 1 mm [1/1024 mm]
  int32_t slope_x = 0, slope_z = 0;  // [1/1024 mm per cell]
};
FloorPlane fit_plane(Layer& layer);

/// The levels of one tile. Their offsets count the tile's runs until the zone's words are laid out.
struct TilePack {
  /// Words that something is stored in: a set, a level's values, or a class's clearance.
  struct Run {
    uint32_t first = 0, count = 0;  // of `words`
    uint64_t hash = 0;              // of them
  };
  std::vector<format::Level> levels;
  std::vector<format::Clearance> clearance;  // per level and class
  std::vector<uint64_t> words;
  std::vector<Run> runs;
  uint32_t flat = 0;  // levels whose floor is a constant or a plane
};

/// Adds one level of tile `tile` to its pack.
void pack_level(uint32_t tile, const Layer& layer, const FloorPlane& plane,
                std::span<const ClearancePlanes> clearance, std::span<const uint8_t> step_safe,
                const SurfaceCodes& codes, TilePack& pack);

struct ZoneShape {
  int32_t x = 0, z = 0;  // of the zone
  uint32_t tiles_per_side = 0;
  uint32_t class_count = 0;
};

/// The zone file's bytes, from the packs of all its tiles, row by row. Packs are emptied.
flatbuffers::DetachedBuffer zone_bytes(const ZoneShape& shape, std::span<TilePack> packs,
                                       int32_t workers);

}  // namespace throng::bake
