// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/legal_air.h"

#include <algorithm>
#include <bit>
#include <cmath>

// The free air of a zone and around it, eroded by a body, word by word. Linear in the voxels times
// the body's width.
namespace throng::world {
namespace {

// dst &= src moved by `cells` along x: bit x of dst meets bit x + cells of src. Bits beyond the row
// are not free.
void and_shifted(uint64_t* dst, const uint64_t* src, int32_t words, int32_t cells) {
  const int32_t whole = std::abs(cells) / 64, part = std::abs(cells) % 64;
  for (int32_t w = 0; w < words; ++w) {
    const auto at = [&](int32_t i) { return i >= 0 && i < words ? src[i] : 0; };
    uint64_t moved;
    if (cells >= 0) {
      moved = at(w + whole) >> part;
      if (part != 0) moved |= at(w + whole + 1) << (64 - part);
    } else {
      moved = at(w - whole) << part;
      if (part != 0) moved |= at(w - whole - 1) >> (64 - part);
    }
    dst[w] &= moved;
  }
}

// Free voxels of all zones around one, by rows of the window.
bool fill_window(const AirData& air, int32_t first_x, int32_t first_z, int32_t base,
                 AirRows& rows) {
  const int32_t side = air.zone_side;
  const int32_t zx0 = std::max(first_x, 0) / side, zz0 = std::max(first_z, 0) / side;
  const int32_t zx1 = std::min((first_x + rows.width - 1) / side, air.zones_x - 1);
  const int32_t zz1 = std::min((first_z + rows.depth - 1) / side, air.zones_z - 1);
  for (int32_t zz = zz0; zz <= zz1; ++zz) {
    for (int32_t zx = zx0; zx <= zx1; ++zx) {
      if (!air.is_there(zx, zz)) continue;
      const AirData::ZoneAir zone = air.zone(zx, zz);
      if (!zone.usable) return false;
      const int32_t x0 = zx * side - first_x, z0 = zz * side - first_z;
      const int32_t x1 = std::min(x0 + side, air.width - first_x);
      const int32_t z1 = std::min(z0 + side, air.depth - first_z);
      const auto fill = [&](int32_t y0, int32_t y1) {  // all of the zone
        for (int32_t y = std::max(y0, 0); y < std::min(y1, rows.height); ++y) {
          for (int32_t z = std::max(z0, 0); z < std::min(z1, rows.depth); ++z) {
            rows.fill(x0, x1, y, z, true);
          }
        }
      };
      if (zone.tree == nullptr) {
        fill(0, rows.height);
        continue;
      }
      const int32_t under = zone.tree->base - base;
      fill(0, under);
      fill(under + zone.tree->side * static_cast<int32_t>(zone.tree->roots), rows.height);
      zone.tree->for_each([&](const AirCube& cube, uint32_t word) {
        if (air_kind(word) == AirKind::kFull) return;
        const int32_t y0 = cube.y - base;
        const int32_t cx1 = std::min(x0 + cube.x + cube.side, x1);
        if (air_kind(word) == AirKind::kFree) {
          for (int32_t y = std::max(y0, 0); y < std::min(y0 + cube.side, rows.height); ++y) {
            for (int32_t z = std::max(z0 + cube.z, 0);
                 z < std::min(z0 + cube.z + cube.side, std::min(z1, rows.depth)); ++z) {
              rows.fill(x0 + cube.x, cx1, y, z, true);
            }
          }
          return;
        }
        const uint64_t cells = zone.tree->leaves[air_number(word)];
        for (uint64_t rest = cells; rest != 0; rest &= rest - 1) {
          const int32_t bit = std::countr_zero(rest);
          const int32_t x = x0 + cube.x + (bit & 3), z = z0 + cube.z + (bit >> 4);
          if (x < x1 && z < z1) rows.fill(x, x + 1, y0 + (bit >> 2 & 3), z, true);
        }
      });
    }
  }
  return true;
}

}  // namespace

void erode_air(const AirBody& body, const AirRows& free, AirRows& legal) {
  legal = free;
  for (int32_t y = 0; y < free.height; ++y) {
    for (int32_t z = 0; z < free.depth; ++z) {
      uint64_t* out = legal.row(y, z);
      for (int32_t up = 1; up <= body.up && y + up < free.height; ++up) {
        and_shifted(out, free.row(y + up, z), free.words, 0);
      }
    }
  }
  if (body.reach == 0) return;
  const AirRows tall = legal;
  for (int32_t y = 0; y < free.height; ++y) {
    for (int32_t z = 0; z < free.depth; ++z) {
      uint64_t* out = legal.row(y, z);
      for (int32_t dz = -body.reach; dz <= body.reach; ++dz) {
        const int32_t half = body.half_width[static_cast<size_t>(std::abs(dz))];
        if (z + dz < 0 || z + dz >= free.depth) {
          std::fill(out, out + free.words, 0);
          break;
        }
        for (int32_t dx = -half; dx <= half; ++dx) {
          and_shifted(out, tall.row(y, z + dz), free.words, dx);
        }
      }
    }
  }
}

std::optional<LegalAir> find_legal_air(const AirData& air, const AirBody& body, int32_t zone_x,
                                       int32_t zone_z) {
  LegalAir legal;
  legal.pad = (body.reach + 3) & -4;
  legal.base = air.shape.floor & -4;
  const int32_t pad = legal.pad, base = legal.base;
  const int32_t height = ((air.shape.ceiling - base) + 3) & -4;
  const int32_t across = air.zone_side + 2 * pad;
  AirRows free(across, height, across, false);
  if (!fill_window(air, zone_x * air.zone_side - pad, zone_z * air.zone_side - pad, base, free)) {
    return std::nullopt;
  }
  for (int32_t y = 0; y < air.shape.floor - base; ++y) {  // no air below
    for (int32_t z = 0; z < across; ++z) free.fill(0, across, y, z, false);
  }
  erode_air(body, free, legal.rows);
  for (int32_t y = 0; y < height; ++y) {
    if (base + y < air.shape.ceiling) continue;
    for (int32_t z = 0; z < across; ++z) legal.rows.fill(0, across, y, z, false);
  }
  return legal;
}

}  // namespace throng::world
