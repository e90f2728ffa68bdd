// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/access.h"
#include "core/check_class.h"
#include "throng/bake.h"

// The walkable surface of a class as triangles: a rectangle of legal cells becomes two of them.
namespace throng {
namespace {

constexpr double kTolerance = 1.5;  // of a merged rectangle's plane [mm]

struct Rect {
  int32_t x = 0, z = 0, width = 1, depth = 1;
};

// Cuts the legal cells of one level tile into rectangles over which the floor is one plane,
// greedily: time linear in the cells times the length of a rectangle's sides.
class TileCutter {
 public:
  TileCutter(const LevelTileContent& tile, size_t avatar_class)
      : floor_(tile.floor), free_(tile.clearance[avatar_class]) {}

  template <class Take>
  void cut(Take take) {
    for (int32_t z = 0; z < kTileCells; ++z) {
      for (int32_t x = 0; x < kTileCells; ++x) {
        if (!is_free(x, z)) continue;
        const Rect rect = grow(x, z);
        for (int32_t k = rect.z; k < rect.z + rect.depth; ++k) {
          std::fill_n(free_.begin() + k * kTileCells + rect.x, rect.width, uint8_t{0});
        }
        take(rect);
      }
    }
  }

 private:
  [[nodiscard]] bool is_free(int32_t x, int32_t z) const {
    return x < kTileCells && z < kTileCells && free_[static_cast<size_t>(z * kTileCells + x)] != 0;
  }
  [[nodiscard]] double height(int32_t x, int32_t z) const {
    return floor_[static_cast<size_t>(z * kTileCells + x)];
  }
  // The rise along x that fits the first `width` cells of a row. [mm per cell]
  [[nodiscard]] double rise_along(const Rect& rect) const {
    return rect.width == 1 ? 0
                           : (height(rect.x + rect.width - 1, rect.z) - height(rect.x, rect.z)) /
                                 (rect.width - 1);
  }
  [[nodiscard]] bool fits(const Rect& rect) const {
    const double gx = rise_along(rect);
    const double gz =
        rect.depth == 1
            ? 0
            : (height(rect.x, rect.z + rect.depth - 1) - height(rect.x, rect.z)) / (rect.depth - 1);
    for (int32_t k = 0; k < rect.depth; ++k) {
      for (int32_t i = 0; i < rect.width; ++i) {
        const double plane = height(rect.x, rect.z) + gx * i + gz * k;
        if (std::fabs(height(rect.x + i, rect.z + k) - plane) > kTolerance) return false;
      }
    }
    return true;
  }
  // The longest row, then as many like it as fit.
  [[nodiscard]] Rect grow(int32_t x, int32_t z) const {
    Rect rect{x, z};
    while (is_free(rect.x + rect.width, z)) {
      ++rect.width;
      if (fits(rect)) continue;
      --rect.width;
      break;
    }
    const auto row_is_free = [&](int32_t k) {
      for (int32_t i = 0; i < rect.width; ++i) {
        if (!is_free(rect.x + i, k)) return false;
      }
      return true;
    };
    while (row_is_free(rect.z + rect.depth)) {
      ++rect.depth;
      if (fits(rect)) continue;
      --rect.depth;
      break;
    }
    return rect;
  }

  const std::vector<int32_t>& floor_;
  std::vector<uint8_t> free_;
};

// Corners lie on the plane through the middles of the rectangle's cells. Across a single cell it
// rises as the feet do.
void add_rect(const World& world, const WorldSummary& summary, uint32_t level,
              const LevelTileContent& tile, const Rect& rect, Scene& scene) {
  const double cell = summary.cell;
  const auto x_of = [&](double i) {
    return summary.origin.x + (tile.tile_x * kTileCells + rect.x + i) * cell;
  };
  const auto z_of = [&](double k) {
    return summary.origin.z + (tile.tile_z * kTileCells + rect.z + k) * cell;
  };
  const auto feet = [&](double i, double k) {
    Place place;
    place.level1 = level + 1;
    place.position = {x_of(i), 0, z_of(k)};
    return world.feet(place);
  };
  const double first = feet(0.5, 0.5);
  const double gx = rect.width > 1 ? (feet(rect.width - 0.5, 0.5) - first) / (rect.width - 1)
                                   : 2 * (feet(0.75, 0.5) - feet(0.25, 0.5));
  const double gz = rect.depth > 1 ? (feet(0.5, rect.depth - 0.5) - first) / (rect.depth - 1)
                                   : 2 * (feet(0.5, 0.75) - feet(0.5, 0.25));
  const auto corner = [&](int32_t i, int32_t k) {
    return Vec3d{x_of(i), first + gx * (i - 0.5) + gz * (k - 0.5), z_of(k)};
  };
  scene.add_quad(corner(0, 0), corner(0, rect.depth), corner(rect.width, rect.depth),
                 corner(rect.width, 0));
}

}  // namespace

Result<Scene> walkable_surface(const World& world, int32_t avatar_class, Context& context) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "surface: the world is empty"};
  const WorldSummary summary = world.summary();
  if (auto ok = check_class(summary.classes, avatar_class, "surface"); !ok) return ok.error();
  if (auto ok = world.check_ground(); !ok) return ok.error();
  const std::vector<int32_t> storeys = world.storeys();
  std::vector<uint32_t> order(world.level_tile_count());
  for (uint32_t l = 0; l < order.size(); ++l) order[l] = l;
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return storeys[a] < storeys[b]; });
  Scene scene;
  uint64_t done = 0;
  for (const uint32_t level : order) {
    if (done % 256 == 0) {
      if (context.on_progress) context.on_progress({"surface", done, order.size()});
      if (context.cancel) return Error{Errc::kCancelled, "surface: cancelled"};
    }
    ++done;
    const std::string node = "storey " + std::to_string(storeys[level]);
    if (scene.parts.empty() || scene.parts.back().node != node) {
      scene.parts.push_back({.file = {},
                             .node = node,
                             .material = "floor",
                             .first_triangle = static_cast<uint32_t>(scene.triangles.size())});
    }
    const LevelTileContent tile = world.level_tile(level);
    TileCutter(tile, static_cast<size_t>(avatar_class)).cut([&](const Rect& rect) {
      add_rect(world, summary, level, tile, rect, scene);
    });
    ScenePart& part = scene.parts.back();
    part.triangle_count = static_cast<uint32_t>(scene.triangles.size()) - part.first_triangle;
  }
  std::erase_if(scene.parts, [](const ScenePart& part) { return part.triangle_count == 0; });
  return scene;
}

}  // namespace throng
