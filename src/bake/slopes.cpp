// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <bit>
#include <cmath>
#include <cstdlib>

#include "bake/legality.h"
#include "world/surface.h"

// Feet on a cell lie on a plane p with gradient g. For a body at P and matter at Q within its
// radius r,
//   y(Q) - p(P) = (y(Q) - p(Q)) + g (Q - P) <= (y(Q) - p(Q)) + |g| r,
// and over a cell B whose matter tops out at top, y(Q) - p(Q) <= top - min over B of p. So the body
// is free if, for the highest of these over all cells that it reaches, the sum stays below its
// bottom. Whole cells are compared with the plane where they are, not with one height. At creases,
// where the feet's slope is the gentler one, a plane between the two may prove what theirs
// cannot; it then owes how far the feet can be from it on the cell.
namespace throng {
namespace {

constexpr int32_t kRounding = 2;  // of feet and planes [mm]

struct Plane {
  int32_t height, gx, gz;  // at the middle of the cell [mm, mm per cell]
};

// All in half millimetres: centres of cells lie half a cell from their corners.
bool clears(const SheetWindow& window, const BodyWindow& body, int32_t x, int32_t z,
            const Plane& plane, int32_t owed, int32_t feet_tilt) {
  const int32_t tilt = std::abs(plane.gx) + std::abs(plane.gz);  // of the plane over a cell [mm]
  const auto lean =
      static_cast<int32_t>(std::ceil(std::sqrt(static_cast<double>(plane.gx) * plane.gx +
                                               static_cast<double>(plane.gz) * plane.gz) *
                                     body.radius));
  const int32_t budget = 2 * (body.bottom - lean - kRounding - owed);
  if (budget < 0) return false;
  // A column may also pass as in the window: its whole top against the lowest and highest feet.
  const int32_t level_high = 2 * (plane.height - feet_tilt + body.bottom - 1);
  const int32_t level_low = 2 * (plane.height + feet_tilt - body.bottom);
  for (int32_t dz = -body.reach; dz <= body.reach; ++dz) {
    const int32_t w = body.width[static_cast<size_t>(std::abs(dz))];
    for (int32_t dx = -w; dx <= w; ++dx) {
      const int32_t top = 2 * window.top[window.index(x + dx, z + dz)];
      const int32_t middle = 2 * (plane.height + plane.gx * dx + plane.gz * dz);
      if (top > level_high && top - (middle - tilt) > budget) return false;
      if (top < level_low && (middle + tilt) - top > budget) return false;
    }
  }
  return true;
}

}  // namespace

void recheck_slopes(const Sheet& sheet, const BodyWindow& body, const LegalityScratch& scratch,
                    LegalCells& cells) {
  for (int32_t z = 0; z < kTileSide; ++z) {
    uint64_t row = cells.slanted[static_cast<size_t>(z)];
    for (; row != 0; row &= row - 1) {
      const int32_t x = std::countr_zero(row);
      const auto feet = [&](int32_t cx, int32_t cz) {
        return static_cast<int32_t>(sheet.feet[static_cast<size_t>(cz * kTileSide + cx)]);
      };
      const auto has = [&](int32_t cx, int32_t cz) { return feet(cx, cz) != kNone16; };
      Plane plane{feet(x, z), 0, 0};
      plane.gx = sheet_slope(
          x, [&](int32_t i) { return feet(i, z); }, [&](int32_t i) { return has(i, z); });
      plane.gz = sheet_slope(
          z, [&](int32_t i) { return feet(x, i); }, [&](int32_t i) { return has(x, i); });
      const auto try_plane = [&](const Plane& other) {
        const int32_t apart = std::abs(other.gx - plane.gx) + std::abs(other.gz - plane.gz);
        const int32_t tilt = scratch.tilt[static_cast<size_t>(z * kTileSide + x)];
        return clears(scratch.window, body, x, z, other, (apart + 1) / 2, tilt);
      };
      bool free = (plane.gx | plane.gz) != 0 && try_plane(plane);
      if (!free && x > 0 && z > 0 && x < kTileSide - 1 && z < kTileSide - 1 && has(x - 1, z) &&
          has(x + 1, z) && has(x, z - 1) && has(x, z + 1)) {
        const Plane between{plane.height, (feet(x + 1, z) - feet(x - 1, z)) / 2,
                            (feet(x, z + 1) - feet(x, z - 1)) / 2};
        free = (between.gx != plane.gx || between.gz != plane.gz) && try_plane(between);
      }
      if (free) cells.legal[static_cast<size_t>(z)] |= 1ULL << x;
    }
  }
}

}  // namespace throng
