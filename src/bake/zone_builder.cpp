// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/zone_builder.h"

#include <algorithm>
#include <cmath>

#include "bake/sheet_kernels.h"
#include "core/parallel.h"
#include "world/zone_data.h"

namespace throng {
FloorPlane fit_plane(Sheet& sheet) {
  FloorPlane plane;
  if (sheet.present == 0) return plane;
  if (sheet.low_feet == sheet.high_feet) {
    plane.found = true;
    plane.base = sheet.base + sheet.low_feet;
    return plane;
  }
  if (!may_be_plane(sheet)) return plane;
  // Neighbours differ alike, so the ends of rows and columns tell the slopes.
  const auto feet = [&](int32_t x, int32_t z) {
    return sheet.feet[static_cast<size_t>(z * kTileSide + x)];
  };
  double rise_x = 0, run_x = 0, rise_z = 0, run_z = 0;
  for (int32_t i = 0; i < kTileSide; ++i) {
    const auto ends = [&](auto at, double& rise, double& run) {
      int32_t first = 0, last = kTileSide - 1;
      while (first <= last && at(first) == kNone16) ++first;
      while (last > first && at(last) == kNone16) --last;
      if (first >= last) return;
      rise += static_cast<double>(at(last)) - at(first);
      run += last - first;
    };
    ends([&](int32_t x) { return feet(x, i); }, rise_x, run_x);
    ends([&](int32_t z) { return feet(i, z); }, rise_z, run_z);
  }
  const double gx = run_x > 0 ? rise_x / run_x : 0, gz = run_z > 0 ? rise_z / run_z : 0;
  constexpr double kSteepest = kMaxSlope / 1024 - 1;
  if (!(std::fabs(gx) < kSteepest && std::fabs(gz) < kSteepest)) return plane;
  // The mean of every fourth cell's distance to a plane through nought.
  int64_t sum = 0, sum_x = 0, sum_z = 0, counted = 0;
  for (int32_t z = 0; z < kTileSide; ++z) {
    for (int32_t x = z % 4; x < kTileSide; x += 4) {
      const uint16_t h = feet(x, z);
      if (h == kNone16) continue;
      sum += h;
      sum_x += x;
      sum_z += z;
      ++counted;
    }
  }
  if (counted == 0) return plane;
  const double rest =
      static_cast<double>(sum) - gx * static_cast<double>(sum_x) - gz * static_cast<double>(sum_z);
  const auto base = static_cast<int64_t>(std::llround(rest / static_cast<double>(counted) * 1024));
  LevelPlane level;
  level.base = static_cast<int32_t>(base >> 10);
  level.part = static_cast<int32_t>(base & 1023);
  level.slope_x = static_cast<int32_t>(std::lround(gx * 1024));
  level.slope_z = static_cast<int32_t>(std::lround(gz * 1024));
  if (!plane_fits(sheet, level)) return plane;
  put_on_plane(level, sheet);
  summarise(sheet);
  plane.found = true;
  plane.base = sheet.base + level.base;
  plane.part = level.part;
  plane.slope_x = level.slope_x;
  plane.slope_z = level.slope_z;
  return plane;
}

namespace {

uint32_t add_plane(const BitPlane& plane, TilePack& pack) {
  const auto offset = static_cast<uint32_t>(pack.planes.size());
  pack.planes.insert(pack.planes.end(), plane.begin(), plane.end());
  return offset;
}

// Heights of the cells that have feet, above `low`.
uint32_t add_heights(const std::array<uint16_t, kTileArea>& values, const Sheet& sheet,
                     uint16_t low, TilePack& pack) {
  const size_t offset = pack.heights.size();
  pack.heights.resize(offset + kTileArea);
  relative_heights(values, sheet, low, &pack.heights[offset]);
  return static_cast<uint32_t>(offset);
}

bool has_one_area(const Sheet& sheet, const SurfaceCodes& codes) {
  if (sheet.one_code) return true;
  const AreaKind area = codes.codes[sheet.some_code].area;
  for (size_t c = 0; c < kTileArea; ++c) {
    if (sheet.feet[c] != kNone16 && codes.codes[sheet.code[c]].area != area) return false;
  }
  return true;
}

format::Clearance pack_clearance(const ClearancePlanes& planes, uint8_t step_safe, TilePack& pack) {
  const auto cells = static_cast<uint16_t>(planes.cells);
  if (cells == 0) return {format::BitsKind::None, step_safe, cells, 0};
  if (planes.all) return {format::BitsKind::All, step_safe, cells, 0};
  const uint32_t offset = add_plane(planes.legal, pack);
  for (const BitPlane& bits : planes.margin) add_plane(bits, pack);
  return {format::BitsKind::Planes, step_safe, cells, offset};
}

}  // namespace

void pack_level(uint32_t tile, const Sheet& sheet, const FloorPlane& plane,
                std::span<const ClearancePlanes> clearance, std::span<const uint8_t> step_safe,
                const SurfaceCodes& codes, TilePack& pack) {
  const bool all_present = sheet.present == kTileArea;
  uint32_t present_offset = 0;
  if (!all_present) {
    BitPlane present;
    present_bits(sheet, present);
    present_offset = add_plane(present, pack);
  }

  format::HeightKind floor_kind = format::HeightKind::Samples;
  uint32_t floor_offset = 0;
  int32_t floor_base = sheet.base + sheet.low_feet;
  if (plane.found) {
    const bool flat = (plane.slope_x | plane.slope_z) == 0;
    floor_kind = flat ? format::HeightKind::Constant : format::HeightKind::Plane;
    floor_base = plane.base;
    ++pack.plain;
  } else {
    floor_offset = add_heights(sheet.feet, sheet, sheet.low_feet, pack);
  }

  const HeightRange ceiling = ceiling_range(sheet);
  format::HeightKind ceiling_kind = format::HeightKind::Samples;
  uint32_t ceiling_offset = 0;
  int32_t ceiling_base = sheet.base + ceiling.low;
  if (ceiling.low == kNone16) {
    ceiling_kind = format::HeightKind::None;
    ceiling_base = 0;
  } else if (ceiling.low == ceiling.high) {
    ceiling_kind = format::HeightKind::Constant;
  } else {
    ceiling_offset = add_heights(sheet.ceiling, sheet, ceiling.low, pack);
  }

  const bool one_area = has_one_area(sheet, codes);
  const auto area_offset = static_cast<uint32_t>(one_area ? 0 : pack.areas.size());
  if (!one_area) {
    for (size_t c = 0; c < kTileArea; ++c) {
      const bool stands = sheet.feet[c] != kNone16;
      pack.areas.push_back(stands ? codes.codes[sheet.code[c]].area : kAreaBlocked);
    }
  }

  pack.levels.emplace_back(static_cast<uint16_t>(tile), floor_kind, ceiling_kind, floor_base,
                           ceiling_base, plane.found ? plane.slope_x : 0,
                           plane.found ? plane.slope_z : 0, floor_offset, ceiling_offset,
                           static_cast<int16_t>(plane.found ? plane.part : 0),
                           all_present ? format::BitsKind::All : format::BitsKind::Planes,
                           one_area ? format::BitsKind::All : format::BitsKind::Planes,
                           codes.codes[sheet.some_code].area, present_offset, area_offset);
  for (size_t c = 0; c < clearance.size(); ++c) {
    pack.clearance.push_back(pack_clearance(clearance[c], step_safe[c], pack));
  }
}

namespace {

// Where a tile's arrays begin in the zone's.
struct PackOffsets {
  size_t levels = 0, heights = 0, planes = 0, areas = 0;
};

format::Level moved(const format::Level& l, const PackOffsets& by) {
  const auto shift = [](bool used, uint32_t offset, size_t distance) {
    return used ? offset + static_cast<uint32_t>(distance) : 0;
  };
  return {l.tile(),
          l.floor_kind(),
          l.ceiling_kind(),
          l.floor_base(),
          l.ceiling_base(),
          l.slope_x(),
          l.slope_z(),
          shift(l.floor_kind() == format::HeightKind::Samples, l.floor_offset(), by.heights),
          shift(l.ceiling_kind() == format::HeightKind::Samples, l.ceiling_offset(), by.heights),
          l.floor_part(),
          l.present_kind(),
          l.area_kind(),
          l.area_value(),
          shift(l.present_kind() == format::BitsKind::Planes, l.present_offset(), by.planes),
          shift(l.area_kind() == format::BitsKind::Planes, l.area_offset(), by.areas)};
}

}  // namespace

flatbuffers::DetachedBuffer zone_bytes(const ZoneShape& shape, std::span<TilePack> packs,
                                       int32_t workers) {
  std::vector<PackOffsets> at(packs.size() + 1);
  std::vector<uint32_t> first(packs.size() + 1, 0);
  for (size_t t = 0; t < packs.size(); ++t) {
    const TilePack& pack = packs[t];
    at[t + 1] = {at[t].levels + pack.levels.size(), at[t].heights + pack.heights.size(),
                 at[t].planes + pack.planes.size(), at[t].areas + pack.areas.size()};
    first[t + 1] = static_cast<uint32_t>(at[t + 1].levels);
  }
  const PackOffsets& total = at.back();
  const size_t clearances = total.levels * shape.class_count;
  // Room for all, so that the arrays stay where they are while they are filled.
  constexpr size_t kTables = 4096;
  flatbuffers::FlatBufferBuilder builder(first.size() * 4 + total.levels * sizeof(format::Level) +
                                         clearances * sizeof(format::Clearance) +
                                         total.heights * 2 + total.planes * 8 + total.areas +
                                         kTables);
  uint16_t* heights = nullptr;
  uint64_t* planes = nullptr;
  uint8_t* areas = nullptr;
  format::Level* levels = nullptr;
  format::Clearance* clearance = nullptr;
  const auto first_at = builder.CreateVector(first);
  // Not CreateUninitializedVectorOfStructs: it takes a struct's size for its alignment, and 44 is
  // no power of two, which leaves the 64-bit words behind it between two words.
  const auto levels_at = builder.CreateVectorOfStructs<format::Level>(
      total.levels, [&](size_t i, format::Level* level) {
        if (i == 0) levels = level;
      });
  const auto clearance_at = builder.CreateUninitializedVectorOfStructs(clearances, &clearance);
  const auto heights_at = builder.CreateUninitializedVector(total.heights, &heights);
  const auto planes_at = builder.CreateUninitializedVector(total.planes, &planes);
  const auto areas_at = builder.CreateUninitializedVector(total.areas, &areas);
  parallel_for(packs.size(), workers, [&](size_t t) {
    TilePack& pack = packs[t];
    const PackOffsets& by = at[t];
    format::Level* level = levels + by.levels;
    for (const auto& l : pack.levels) *level++ = moved(l, by);
    format::Clearance* entry = clearance + by.levels * shape.class_count;
    for (const auto& c : pack.clearance) {
      const bool moves = c.kind() == format::BitsKind::Planes;
      *entry++ = {c.kind(), c.step_safe(), c.legal_cells(),
                  moves ? c.offset() + static_cast<uint32_t>(by.planes) : 0};
    }
    std::copy(pack.heights.begin(), pack.heights.end(), heights + by.heights);
    std::copy(pack.planes.begin(), pack.planes.end(), planes + by.planes);
    std::copy(pack.areas.begin(), pack.areas.end(), areas + by.areas);
    pack = {};
  });
  builder.Finish(format::CreateZone(builder, kZoneVersion, shape.x, shape.z, shape.tiles_per_side,
                                    shape.class_count, first_at, levels_at, clearance_at,
                                    heights_at, planes_at, areas_at),
                 format::ZoneIdentifier());
  return builder.Release();
}

}  // namespace throng
