// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "recast_bake.h"

#include <Recast.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace throng::bench {
namespace {

struct Walker {
  int height = 0;  // [cells]
  int climb = 0;
  int radius = 0;
  float slope = 0;  // [degrees]
};

Walker make_walker(const RecastConfig& config) {
  const auto up = [](double value) { return static_cast<int>(std::ceil(value - 1e-6)); };
  return {
      .height = std::max(3, up(config.avatar.height / config.cell_height)),
      .climb = static_cast<int>(std::floor(config.avatar.step_height / config.cell_height + 1e-6)),
      .radius = up(config.avatar.radius / config.cell),
      .slope = static_cast<float>(config.avatar.max_slope)};
}

// One heightfield over [min, max] in the plane, from triangles whose corners are `triangles`.
struct Field {
  float min[3];
  float max[3];
  int width = 0;
  int depth = 0;
  int border = 0;
};

void bake_field(const RecastInput& input, const int* triangles, int count, const Field& field,
                const RecastConfig& config, RecastResult& result, std::vector<RecastFloor>* floors,
                int tile_x, int tile_z) {
  rcContext context(false);
  const Walker walker = make_walker(config);
  const std::unique_ptr<rcHeightfield, decltype(&rcFreeHeightField)> solid(rcAllocHeightfield(),
                                                                           rcFreeHeightField);
  if (!rcCreateHeightfield(&context, *solid, field.width, field.depth, field.min, field.max,
                           config.cell, config.cell_height)) {
    return;
  }
  const int vertices = static_cast<int>(input.vertices.size() / 3);
  std::vector<unsigned char> areas(static_cast<size_t>(count), 0);
  rcMarkWalkableTriangles(&context, walker.slope, input.vertices.data(), vertices, triangles, count,
                          areas.data());
  rcRasterizeTriangles(&context, input.vertices.data(), vertices, triangles, areas.data(), count,
                       *solid, walker.climb);
  rcFilterLowHangingWalkableObstacles(&context, walker.climb, *solid);
  rcFilterLedgeSpans(&context, walker.height, walker.climb, *solid);
  rcFilterWalkableLowHeightSpans(&context, walker.height, *solid);
  const std::unique_ptr<rcCompactHeightfield, decltype(&rcFreeCompactHeightfield)> compact(
      rcAllocCompactHeightfield(), rcFreeCompactHeightfield);
  rcBuildCompactHeightfield(&context, walker.height, walker.climb, *solid, *compact);
  rcErodeWalkableArea(&context, walker.radius, *compact);

  result.bytes += static_cast<uint64_t>(field.width) * static_cast<uint64_t>(field.depth) *
                      sizeof(rcCompactCell) +
                  static_cast<uint64_t>(compact->spanCount) * (sizeof(rcCompactSpan) + 1);
  for (int z = field.border; z < field.depth - field.border; ++z) {
    for (int x = field.border; x < field.width - field.border; ++x) {
      const rcCompactCell& cell = compact->cells[x + z * field.width];
      result.spans += cell.count;
      const unsigned end = cell.index + cell.count;
      for (unsigned i = cell.index; i < end; ++i) {
        if (compact->areas[i] == RC_NULL_AREA) continue;
        ++result.walkable;
        if (floors == nullptr) continue;
        const auto height = static_cast<float>(compact->spans[i].y) * config.cell_height;
        floors->push_back({tile_x * config.tile + x - field.border,
                           tile_z * config.tile + z - field.border, field.min[1] + height});
      }
    }
  }
}

int tile_count(float low, float high, const RecastConfig& config) {
  const float side = static_cast<float>(config.tile) * config.cell;
  return std::max(1, static_cast<int>(std::ceil((high - low) / side)));
}

Field whole_field(const RecastInput& input, const RecastConfig& config) {
  Field field{};
  std::copy(input.min, input.min + 3, field.min);
  std::copy(input.max, input.max + 3, field.max);
  rcCalcGridSize(field.min, field.max, config.cell, &field.width, &field.depth);
  return field;
}

Field tile_field(const RecastInput& input, const RecastConfig& config, int x, int z) {
  Field field = whole_field(input, config);
  field.border = make_walker(config).radius + 3;  // As Recast's own tiled sample.
  field.width = field.depth = config.tile + 2 * field.border;
  const float side = static_cast<float>(config.tile) * config.cell;
  const float rim = static_cast<float>(field.border) * config.cell;
  field.min[0] = input.min[0] + static_cast<float>(x) * side - rim;
  field.min[2] = input.min[2] + static_cast<float>(z) * side - rim;
  field.max[0] = input.min[0] + static_cast<float>(x + 1) * side + rim;
  field.max[2] = input.min[2] + static_cast<float>(z + 1) * side + rim;
  return field;
}

}  // namespace

RecastInput make_recast_input(const Scene& scene) {
  RecastInput input;
  for (const Vec3d& p : scene.positions) {
    for (const double value : {p.x, p.y, p.z}) input.vertices.push_back(static_cast<float>(value));
  }
  for (const auto& triangle : scene.triangles) {
    for (const uint32_t corner : triangle) input.triangles.push_back(static_cast<int>(corner));
  }
  rcCalcBounds(input.vertices.data(), static_cast<int>(scene.positions.size()), input.min,
               input.max);
  return input;
}

TileTriangles sort_into_tiles(const RecastInput& input, const RecastConfig& config) {
  TileTriangles tiles;
  if (config.tile == 0) return tiles;
  const int tiles_x = tile_count(input.min[0], input.max[0], config);
  const int tiles_z = tile_count(input.min[2], input.max[2], config);
  tiles.resize(static_cast<size_t>(tiles_x * tiles_z));
  const float side = static_cast<float>(config.tile) * config.cell;
  const float rim = static_cast<float>(make_walker(config).radius + 3) * config.cell;
  for (size_t t = 0; t < input.triangles.size(); t += 3) {
    float low[2] = {INFINITY, INFINITY};
    float high[2] = {-INFINITY, -INFINITY};
    for (size_t corner = 0; corner < 3; ++corner) {
      const float* v = &input.vertices[static_cast<size_t>(input.triangles[t + corner]) * 3];
      for (const int axis : {0, 1}) {
        low[axis] = std::min(low[axis], v[axis * 2]);
        high[axis] = std::max(high[axis], v[axis * 2]);
      }
    }
    const auto first = [&](int axis, int count) {
      const float offset = low[axis] - rim - input.min[axis * 2];
      return std::clamp(static_cast<int>(std::floor(offset / side)), 0, count - 1);
    };
    const auto last = [&](int axis, int count) {
      const float offset = high[axis] + rim - input.min[axis * 2];
      return std::clamp(static_cast<int>(std::floor(offset / side)), 0, count - 1);
    };
    for (int z = first(1, tiles_z); z <= last(1, tiles_z); ++z) {
      for (int x = first(0, tiles_x); x <= last(0, tiles_x); ++x) {
        auto& list = tiles[static_cast<size_t>(z * tiles_x + x)];
        list.insert(list.end(), &input.triangles[t], &input.triangles[t] + 3);
      }
    }
  }
  return tiles;
}

RecastResult recast_bake(const RecastInput& input, const RecastConfig& config,
                         const TileTriangles& tiles, std::vector<RecastFloor>* floors) {
  RecastResult result;
  if (config.tile == 0) {
    bake_field(input, input.triangles.data(), static_cast<int>(input.triangles.size() / 3),
               whole_field(input, config), config, result, floors, 0, 0);
    return result;
  }
  const int tiles_x = tile_count(input.min[0], input.max[0], config);
  for (size_t tile = 0; tile < tiles.size(); ++tile) {
    const int x = static_cast<int>(tile) % tiles_x;
    const int z = static_cast<int>(tile) / tiles_x;
    if (tiles[tile].empty()) continue;
    bake_field(input, tiles[tile].data(), static_cast<int>(tiles[tile].size() / 3),
               tile_field(input, config, x, z), config, result, floors, x, z);
  }
  return result;
}

}  // namespace throng::bench
