// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <cstdint>
#include <span>
#include <vector>

#include "bake/columns/triangles.h"
#include "bake/layers/layers.h"
#include "bake/layers/legality.h"
#include "throng/bake.h"
#include "throng/base.h"

/// One zone, from its triangles to its file's bytes.
namespace throng::bake {

/// What all zones of a bake share.
struct BakePlan {
  const Scene* scene = nullptr;
  const BakeConfig* config = nullptr;
  Grid grid;
  int32_t tiles_per_zone = 0;
  int32_t zones_x = 0, zones_z = 0;
  SurfaceCodes codes;
  const SurfaceCoder* coder = nullptr;
  BodyLimits limits;
  std::vector<bool> is_tall;  // classes that need free spans of BodyLimits::kHighFreeSpan
  std::vector<BodyWindow> bodies;
  int32_t reach = 0;     // of the widest body [cells]
  int32_t max_step = 0;  // [mm]

  /// How far beyond a zone its bake looks. [cells]
  [[nodiscard]] int32_t apron() const;
  /// Sets the grid and the zones on it.
  void put_on(const Grid& to);
};

struct ZoneResult {
  flatbuffers::DetachedBuffer bytes;  // empty: no class can stand in this zone
  uint32_t levels = 0;
  uint32_t flat_levels = 0;
  uint32_t tiles = 0;
  uint64_t spans = 0;
  std::vector<uint64_t> legal_cells;  // per class
  double seconds_columns = 0, seconds_levels = 0, seconds_clearance = 0;
};

/// Memory of a zone bake, kept from zone to zone, and how many threads it has.
class ZoneScratch;

/// `triangles` are those of the scene that may touch the zone or its apron, in order.
/// Returns false if the context was cancelled.
bool bake_zone(const BakePlan& plan, int32_t zone_x, int32_t zone_z,
               std::span<const uint32_t> triangles, ZoneScratch& scratch, Context& context,
               ZoneResult& result);

class ZoneScratch {
 public:
  explicit ZoneScratch(int32_t workers);
  ~ZoneScratch();
  struct Worker;

  LayerPool pool;
  std::vector<std::unique_ptr<Worker>> workers;
  std::vector<CellTriangle> triangles;
};

}  // namespace throng::bake
