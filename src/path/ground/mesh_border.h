// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "path/ground/mesh.h"
#include "world/walk.h"
#include "world/zone_data.h"

/// What lies beyond the borders of a mesh's rectangles: portals and corners.
namespace throng::path {

/// A corner before it has its number: the point, and the level of the cell across from the missing
/// one, which distinguishes corners above each other.
struct CornerKey {
  int32_t x = 0, z = 0;
  uint32_t level = 0;
  int8_t away_x = 0, away_z = 0;
  auto operator<=>(const CornerKey&) const = default;
};

struct FoundPortal {
  MeshPortal portal;
  std::optional<CornerKey> from_corner, to_corner;
};

/// The borders of rectangles of cells. A Ground is one of world/walk.h, and has
///   uint32_t number(Level)     the level's number in the world
template <class Ground>
class MeshBorder {
 public:
  using Level = typename Ground::Level;
  MeshBorder(const world::WorldData& world, const Ground& ground, int32_t step)
      : width_(world.width), depth_(world.depth), ground_(ground), step_(step) {}

  /// Appends the portals of a rectangle, around it. `rect_at(level, x, z)` is the rectangle of a
  /// cell that is legal.
  template <class RectAt>
  void find_portals(const Level& level, const MeshRect& rect, RectAt rect_at,
                    std::vector<FoundPortal>& portals) const {
    const int32_t w = rect.width, d = rect.depth;
    const auto side = [&](int32_t begin, int32_t length, auto cell_at, int32_t dx, int32_t dz) {
      uint32_t last = kNoRect;
      for (int32_t i = 0; i < length; ++i) {
        const auto [x, z] = cell_at(i);
        const auto beyond = step_both(level, x, z, x + dx, z + dz);
        const uint32_t to = beyond ? rect_at(*beyond, x + dx, z + dz) : kNoRect;
        if (to != kNoRect && to == last) {
          ++portals.back().portal.to;
        } else if (to != kNoRect) {
          portals.push_back({{to, begin + i, begin + i + 1, kNoCorner, kNoCorner}, {}, {}});
        }
        last = to;
      }
    };
    const int32_t x1 = rect.x + w - 1, z1 = rect.z + d - 1;
    side(
        0, w,
        [&](int32_t i) {
          return std::pair{rect.x + i, rect.z};
        },
        0, -1);
    side(
        w, d,
        [&](int32_t i) {
          return std::pair{x1, rect.z + i};
        },
        1, 0);
    side(
        w + d, w,
        [&](int32_t i) {
          return std::pair{x1 - i, z1};
        },
        0, 1);
    side(
        2 * w + d, d,
        [&](int32_t i) {
          return std::pair{rect.x, z1 - i};
        },
        -1, 0);
  }

  /// Those at both ends of one of its portals.
  void find_corners(const Level& level, const MeshRect& rect, FoundPortal& found) const {
    found.from_corner = corner_at(level, rect, found.portal.from, found.portal.from);
    found.to_corner = corner_at(level, rect, found.portal.to, found.portal.to - 1);
  }

 private:
  // The level on the other side of a step that leads there and back.
  [[nodiscard]] std::optional<Level> step_both(const Level& from, int32_t x, int32_t z, int32_t nx,
                                               int32_t nz) const {
    if (nx < 0 || nz < 0 || nx >= width_ || nz >= depth_) return {};
    const auto there = world::step_to(ground_, from, x, z, nx, nz, step_);
    if (!there) return {};
    const auto back = world::step_to(ground_, *there, nx, nz, x, z, step_);
    if (!back || ground_.number(*back) != ground_.number(from)) return {};
    return there;
  }

  // The corner at `at` cells around the rectangle, seen from the border cell `cell` around.
  [[nodiscard]] std::optional<CornerKey> corner_at(const Level& level, const MeshRect& rect,
                                                   int32_t at, int32_t cell) const {
    const int32_t w = rect.width, d = rect.depth;
    int32_t px = 0, pz = 0;  // the point
    int32_t cx = 0, cz = 0;  // a cell of the rectangle that touches it
    const int32_t side = cell < w ? 0 : cell < w + d ? 1 : cell < 2 * w + d ? 2 : 3;
    if (side == 0) {
      px = rect.x + at, pz = rect.z, cx = rect.x + cell, cz = rect.z;
    } else if (side == 1) {
      px = rect.x + w, pz = rect.z + at - w, cx = px - 1, cz = rect.z + cell - w;
    } else if (side == 2) {
      px = rect.x + w - (at - w - d), pz = rect.z + d;
      cx = rect.x + w - 1 - (cell - w - d), cz = pz - 1;
    } else {
      px = rect.x, pz = rect.z + d - (at - 2 * w - d);
      cx = px, cz = rect.z + d - 1 - (cell - 2 * w - d);
    }
    // The other three cells around the point.
    const int32_t ox = cx == px ? px - 1 : px, oz = cz == pz ? pz - 1 : pz;
    const auto beside_x = step_both(level, cx, cz, ox, cz);
    const auto beside_z = step_both(level, cx, cz, cx, oz);
    std::optional<Level> across_x, across_z;
    if (beside_x) across_x = step_both(*beside_x, ox, cz, ox, oz);
    if (beside_z) across_z = step_both(*beside_z, cx, oz, ox, oz);
    const auto key = [&](int32_t missing_x, int32_t missing_z, uint32_t across_level) {
      return CornerKey{px, pz, across_level, static_cast<int8_t>(missing_x < px ? 1 : -1),
                       static_cast<int8_t>(missing_z < pz ? 1 : -1)};
    };
    if (beside_x && beside_z) {
      // The fourth is missing, or a step to it is, or two levels part there.
      if (across_x && across_z && ground_.number(*across_x) == ground_.number(*across_z)) return {};
      return key(ox, oz, ground_.number(level));
    }
    if (across_x) return key(cx, oz, ground_.number(*beside_x));
    if (across_z) return key(ox, cz, ground_.number(*beside_z));
    return {};
  }

  int32_t width_, depth_;  // of the world [cells]
  const Ground& ground_;
  int32_t step_;
};

}  // namespace throng::path
