// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/zone_builder.h"

#include <algorithm>
#include <cmath>

#include "bake/sheet_kernels.h"
#include "world/level_view.h"
#include "world/zone_data.h"

namespace throng {
namespace {

LevelView view_of(const FloorPlane& plane) {
  LevelView view;
  view.floor_base = plane.base;
  view.floor_part = plane.part;
  view.slope_x = plane.slope_x;
  view.slope_z = plane.slope_z;
  return view;
}

}  // namespace

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
  double sum = 0;
  for (int32_t z = 0; z < kTileSide; ++z) {
    for (int32_t x = z % 4; x < kTileSide; x += 4) {
      if (feet(x, z) != kNone16) sum += feet(x, z) - gx * x - gz * z;
    }
  }
  double counted = 0;
  for (int32_t z = 0; z < kTileSide; ++z) {
    for (int32_t x = z % 4; x < kTileSide; x += 4) counted += feet(x, z) != kNone16;
  }
  if (counted == 0) return plane;
  const auto base = static_cast<int64_t>(std::llround(sum / counted * 1024));
  plane.base = sheet.base + static_cast<int32_t>(base >> 10);
  plane.part = static_cast<int32_t>(base & 1023);
  plane.slope_x = static_cast<int32_t>(std::lround(gx * 1024));
  plane.slope_z = static_cast<int32_t>(std::lround(gz * 1024));
  const LevelView view = view_of(plane);
  for (int32_t z = 0; z < kTileSide; ++z) {
    for (int32_t x = 0; x < kTileSide; ++x) {
      const uint16_t h = sheet.feet[static_cast<size_t>(z * kTileSide + x)];
      if (h != kNone16 && std::abs(view.sample(x, z) - sheet.base - h) > 1) return plane;
    }
  }
  plane.found = true;
  sheet.low_feet = kNone16;
  sheet.high_feet = 0;
  for (int32_t z = 0; z < kTileSide; ++z) {
    for (int32_t x = 0; x < kTileSide; ++x) {
      uint16_t& h = sheet.feet[static_cast<size_t>(z * kTileSide + x)];
      if (h == kNone16) continue;
      h = static_cast<uint16_t>(view.sample(x, z) - sheet.base);
      sheet.low_feet = std::min(sheet.low_feet, h);
      sheet.high_feet = std::max(sheet.high_feet, h);
    }
  }
  return plane;
}

ZoneBuilder::ZoneBuilder(uint32_t tiles_per_side, size_t class_count, const SurfaceCodes& codes)
    : tiles_per_side_(tiles_per_side),
      class_count_(class_count),
      codes_(codes),
      levels_of_tile_(static_cast<size_t>(tiles_per_side) * tiles_per_side, 0),
      legal_cells_(class_count, 0) {}

uint32_t ZoneBuilder::add_planes(const BitPlane& plane) {
  const auto offset = static_cast<uint32_t>(planes_.size());
  planes_.insert(planes_.end(), plane.begin(), plane.end());
  return offset;
}

uint32_t ZoneBuilder::add_heights(std::span<const uint16_t> values) {
  const auto offset = static_cast<uint32_t>(heights_.size());
  heights_.insert(heights_.end(), values.begin(), values.end());
  return offset;
}

void ZoneBuilder::add_level(uint32_t tile, const Sheet& sheet, const FloorPlane& plane,
                            std::span<const ClearancePlanes> clearance,
                            std::span<const uint8_t> step_safe) {
  ++levels_of_tile_[tile];
  if (tile != last_tile_) ++tiles_with_levels_;
  last_tile_ = tile;

  BitPlane present{};
  uint16_t low_ceiling = kNone16, high_ceiling = 0;
  for (size_t c = 0; c < kTileArea; ++c) {
    if (sheet.feet[c] == kNone16) continue;
    present[c / 64] |= 1ULL << (c % 64);
    low_ceiling = std::min(low_ceiling, sheet.ceiling[c]);
    high_ceiling = std::max(high_ceiling, sheet.ceiling[c]);
  }
  const bool all_present = sheet.present == kTileArea;
  const uint32_t present_offset = all_present ? 0 : add_planes(present);

  format::HeightKind floor_kind = format::HeightKind::Samples;
  uint32_t floor_offset = 0;
  int32_t floor_base = sheet.base + sheet.low_feet;
  if (plane.found) {
    const bool flat = (plane.slope_x | plane.slope_z) == 0;
    floor_kind = flat ? format::HeightKind::Constant : format::HeightKind::Plane;
    floor_base = plane.base;
    ++plain_;
  } else {
    std::array<uint16_t, kTileArea> values;
    for (size_t c = 0; c < kTileArea; ++c) {
      values[c] = sheet.feet[c] == kNone16 ? kNone16
                                           : static_cast<uint16_t>(sheet.feet[c] - sheet.low_feet);
    }
    floor_offset = add_heights(values);
  }

  format::HeightKind ceiling_kind = format::HeightKind::Samples;
  uint32_t ceiling_offset = 0;
  int32_t ceiling_base = sheet.base + low_ceiling;
  if (low_ceiling == kNone16) {
    ceiling_kind = format::HeightKind::None;
    ceiling_base = 0;
  } else if (low_ceiling == high_ceiling) {
    ceiling_kind = format::HeightKind::Constant;
  } else {
    std::array<uint16_t, kTileArea> values;
    for (size_t c = 0; c < kTileArea; ++c) {
      const bool open = sheet.feet[c] == kNone16 || sheet.ceiling[c] == kNone16;
      values[c] = open ? kNone16 : static_cast<uint16_t>(sheet.ceiling[c] - low_ceiling);
    }
    ceiling_offset = add_heights(values);
  }

  AreaKind area_value = codes_.codes[sheet.some_code].area;
  bool one_area = true;
  if (!sheet.one_code) {
    for (size_t c = 0; c < kTileArea && one_area; ++c) {
      one_area = sheet.feet[c] == kNone16 || codes_.codes[sheet.code[c]].area == area_value;
    }
  }
  uint32_t area_offset = 0;
  if (!one_area) {
    area_offset = static_cast<uint32_t>(areas_.size());
    for (size_t c = 0; c < kTileArea; ++c) {
      areas_.push_back(sheet.feet[c] == kNone16 ? kAreaBlocked : codes_.codes[sheet.code[c]].area);
    }
  }

  levels_.emplace_back(static_cast<uint16_t>(tile), floor_kind, ceiling_kind, floor_base,
                       ceiling_base, plane.found ? plane.slope_x : 0,
                       plane.found ? plane.slope_z : 0, floor_offset, ceiling_offset,
                       static_cast<int16_t>(plane.found ? plane.part : 0),
                       all_present ? format::BitsKind::All : format::BitsKind::Planes,
                       one_area ? format::BitsKind::All : format::BitsKind::Planes, area_value,
                       present_offset, area_offset);
  for (size_t c = 0; c < class_count_; ++c) {
    const ClearancePlanes& planes = clearance[c];
    legal_cells_[c] += static_cast<uint64_t>(planes.cells);
    format::BitsKind kind = format::BitsKind::Planes;
    uint32_t offset = 0;
    if (planes.cells == 0) {
      kind = format::BitsKind::None;
    } else if (planes.all) {
      kind = format::BitsKind::All;
    } else {
      offset = add_planes(planes.legal);
      for (const BitPlane& bits : planes.margin) add_planes(bits);
    }
    clearance_.emplace_back(kind, step_safe[c], static_cast<uint16_t>(planes.cells), offset);
  }
}

std::vector<uint8_t> ZoneBuilder::finish(int32_t zone_x, int32_t zone_z) const {
  std::vector<uint32_t> first(levels_of_tile_.size() + 1, 0);
  for (size_t t = 0; t < levels_of_tile_.size(); ++t) first[t + 1] = first[t] + levels_of_tile_[t];
  flatbuffers::FlatBufferBuilder builder(heights_.size() * 2 + planes_.size() * 8 + areas_.size() +
                                         4096);
  builder.Finish(format::CreateZoneDirect(builder, kZoneVersion, zone_x, zone_z, tiles_per_side_,
                                          static_cast<uint32_t>(class_count_), &first, &levels_,
                                          &clearance_, &heights_, &planes_, &areas_),
                 format::ZoneIdentifier());
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

}  // namespace throng
