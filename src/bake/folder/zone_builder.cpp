// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/zone_builder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "bake/folder/cell_packer.h"
#include "bake/layers/layer_kernels.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "world/zone_data.h"

// Packs finished layers into a zone file: constants, planes or blocks of values for floors, and
// sets of bits for the classes. Equal runs of words are stored once.
namespace throng::bake {
FloorPlane fit_plane(Layer& layer) {
  FloorPlane plane;
  if (layer.present == 0) return plane;
  if (layer.low_feet == layer.high_feet) {
    plane.found = true;
    plane.base = layer.base + layer.low_feet;
    return plane;
  }
  if (!may_be_plane(layer)) return plane;
  // Neighbours differ alike, so the ends of rows and columns give the slopes.
  const auto feet = [&](int32_t x, int32_t z) {
    return layer.feet[static_cast<size_t>(z * kTileSide + x)];
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
  constexpr double kSteepest = world::kMaxSlope / 1024 - 1;
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
  if (!plane_fits(layer, level)) return plane;
  put_on_plane(level, layer);
  summarise(layer);
  plane.found = true;
  plane.base = layer.base + level.base;
  plane.part = level.part;
  plane.slope_x = level.slope_x;
  plane.slope_z = level.slope_z;
  return plane;
}

namespace {

// Makes a run of the words from `first` on. Returns its number.
uint32_t close_run(size_t first, TilePack& pack) {
  const size_t count = pack.words.size() - first;
  pack.runs.push_back({.first = static_cast<uint32_t>(first),
                       .count = static_cast<uint32_t>(count),
                       .hash = hash_bytes(&pack.words[first], count * sizeof(uint64_t))});
  return static_cast<uint32_t>(pack.runs.size() - 1);
}

uint32_t add_bits(const BitPlane& bits, TilePack& pack) {
  const size_t first = pack.words.size();
  pack_bits(bits, pack.words);
  return close_run(first, pack);
}

uint32_t add_values(const uint16_t* values, const Layer& layer, const world::CellRows* has,
                    uint16_t low, TilePack& pack) {
  const size_t first = pack.words.size();
  pack_values(values, layer.feet.data(), has, low, pack.words);
  return close_run(first, pack);
}

bool has_one_area(const Layer& layer, const SurfaceCodes& codes) {
  if (layer.one_code) return true;
  const AreaKind area = codes.codes[layer.some_code].area;
  for (size_t c = 0; c < kTileArea; ++c) {
    if (layer.feet[c] != kNone16 && codes.codes[layer.code[c]].area != area) return false;
  }
  return true;
}

format::Clearance pack_clearance(const ClearancePlanes& planes, uint8_t step_safe, TilePack& pack) {
  const auto cells = static_cast<uint16_t>(planes.cells);
  if (cells == 0) return {format::CellsKind::None, step_safe, cells, 0};
  if (planes.all) return {format::CellsKind::All, step_safe, cells, 0};
  const size_t first = pack.words.size();
  pack_bits(planes.legal, pack.words);
  for (const BitPlane& bits : planes.margin) pack_bits(bits, pack.words);
  return {format::CellsKind::Blocks, step_safe, cells, close_run(first, pack)};
}

}  // namespace

void pack_level(uint32_t tile, const Layer& layer, const FloorPlane& plane,
                std::span<const ClearancePlanes> clearance, std::span<const uint8_t> step_safe,
                const SurfaceCodes& codes, TilePack& pack) {
  pack.words.reserve(2048);  // Most tiles take less; growing to it by halves copies it all again.
  const bool all_present = layer.present == kTileArea;
  uint32_t present_offset = 0;
  BitPlane present;
  const world::CellRows* has = all_present ? nullptr : &present;
  if (!all_present) {
    present_bits(layer, present);
    present_offset = add_bits(present, pack);
  }

  format::HeightKind floor_kind = format::HeightKind::Blocks;
  uint32_t floor_offset = 0;
  int32_t floor_base = layer.base + layer.low_feet;
  if (plane.found) {
    const bool flat = (plane.slope_x | plane.slope_z) == 0;
    floor_kind = flat ? format::HeightKind::Constant : format::HeightKind::Plane;
    floor_base = plane.base;
    ++pack.flat;
  } else {
    floor_offset = add_values(layer.feet.data(), layer, has, layer.low_feet, pack);
  }

  const HeightRange ceiling = ceiling_range(layer);
  format::HeightKind ceiling_kind = format::HeightKind::Blocks;
  uint32_t ceiling_offset = 0;
  int32_t ceiling_base = layer.base + ceiling.low;
  if (ceiling.low == kNone16) {
    ceiling_kind = format::HeightKind::None;
    ceiling_base = 0;
  } else if (ceiling.low == ceiling.high) {
    ceiling_kind = format::HeightKind::Constant;
  } else {
    ceiling_offset = add_values(layer.ceiling.data(), layer, has, ceiling.low, pack);
  }

  const bool one_area = has_one_area(layer, codes);
  uint32_t area_offset = 0;
  if (!one_area) {
    std::array<uint16_t, kTileArea + 32> areas{};
    for (size_t c = 0; c < kTileArea; ++c) {
      if (layer.feet[c] != kNone16) areas[c] = codes.codes[layer.code[c]].area;
    }
    area_offset = add_values(areas.data(), layer, has, 0, pack);
  }

  pack.levels.emplace_back(static_cast<uint16_t>(tile), floor_kind, ceiling_kind, floor_base,
                           ceiling_base, plane.found ? plane.slope_x : 0,
                           plane.found ? plane.slope_z : 0, floor_offset, ceiling_offset,
                           static_cast<int16_t>(plane.found ? plane.part : 0),
                           all_present ? format::CellsKind::All : format::CellsKind::Blocks,
                           one_area ? format::CellsKind::All : format::CellsKind::Blocks,
                           codes.codes[layer.some_code].area, present_offset, area_offset);
  for (size_t c = 0; c < clearance.size(); ++c) {
    pack.clearance.push_back(pack_clearance(clearance[c], step_safe[c], pack));
  }
}

namespace {

// The distinct runs of all tiles, in order of their first use, and where the zone keeps them.
class SharedRuns {
 public:
  explicit SharedRuns(std::span<const TilePack> packs) : packs_(packs), place_(packs.size()) {
    size_t runs = 0;
    for (const TilePack& pack : packs) runs += pack.runs.size();
    table_.resize(std::bit_ceil(2 * runs + 1));
    for (size_t t = 0; t < packs.size(); ++t) {
      place_[t].reserve(packs[t].runs.size());
      for (uint32_t r = 0; r < packs[t].runs.size(); ++r) place_[t].push_back(keep(t, r));
    }
  }
  /// Where run `run` of a tile begins in the zone's words.
  [[nodiscard]] uint32_t place(size_t tile, uint32_t run) const { return place_[tile][run].first; }
  /// True for the tile whose words are the ones that are kept.
  [[nodiscard]] bool is_first(size_t tile, uint32_t run) const {
    return place_[tile][run].is_first;
  }
  [[nodiscard]] size_t words() const { return words_; }

 private:
  struct Entry {
    uint64_t hash = 0;
    uint32_t tile1 = 0, run = 0;  // tile plus one: 0 is free
  };
  struct Place {
    uint32_t first = 0;
    bool is_first = false;
  };
  [[nodiscard]] std::span<const uint64_t> content(size_t tile, uint32_t run) const {
    const TilePack::Run& at = packs_[tile].runs[run];
    return {&packs_[tile].words[at.first], at.count};
  }
  Place keep(size_t tile, uint32_t run) {
    const uint64_t hash = packs_[tile].runs[run].hash;
    const std::span<const uint64_t> words = content(tile, run);
    for (size_t i = hash & (table_.size() - 1);; i = (i + 1) & (table_.size() - 1)) {
      Entry& entry = table_[i];
      if (entry.tile1 == 0) {
        entry = {.hash = hash, .tile1 = static_cast<uint32_t>(tile + 1), .run = run};
        const auto first = static_cast<uint32_t>(words_);
        words_ += words.size();
        return {.first = first, .is_first = true};
      }
      if (entry.hash == hash && std::ranges::equal(words, content(entry.tile1 - 1, entry.run))) {
        return {.first = place_[entry.tile1 - 1][entry.run].first, .is_first = false};
      }
    }
  }

  std::span<const TilePack> packs_;
  std::vector<std::vector<Place>> place_;  // per tile and run
  std::vector<Entry> table_;               // open addressing
  size_t words_ = 0;
};

format::Level placed(const format::Level& l, size_t tile, const SharedRuns& runs) {
  const auto at = [&](bool used, uint32_t run) { return used ? runs.place(tile, run) : 0; };
  return {l.tile(),
          l.floor_kind(),
          l.ceiling_kind(),
          l.floor_base(),
          l.ceiling_base(),
          l.slope_x(),
          l.slope_z(),
          at(l.floor_kind() == format::HeightKind::Blocks, l.floor_offset()),
          at(l.ceiling_kind() == format::HeightKind::Blocks, l.ceiling_offset()),
          l.floor_part(),
          l.present_kind(),
          l.area_kind(),
          l.area_value(),
          at(l.present_kind() == format::CellsKind::Blocks, l.present_offset()),
          at(l.area_kind() == format::CellsKind::Blocks, l.area_offset())};
}

}  // namespace

flatbuffers::DetachedBuffer zone_bytes(const ZoneShape& shape, std::span<TilePack> packs,
                                       int32_t workers) {
  std::vector<uint32_t> first(packs.size() + 1, 0);
  for (size_t t = 0; t < packs.size(); ++t) {
    first[t + 1] = first[t] + static_cast<uint32_t>(packs[t].levels.size());
  }
  const SharedRuns runs(packs);
  const size_t level_count = first.back(), clearances = level_count * shape.class_count;
  // Room for all, so that the arrays stay where they are while they are filled.
  constexpr size_t kTables = 4096;
  flatbuffers::FlatBufferBuilder builder(first.size() * 4 + level_count * sizeof(format::Level) +
                                         clearances * sizeof(format::Clearance) +
                                         runs.words() * sizeof(uint64_t) + kTables);
  uint64_t* words = nullptr;
  format::Level* levels = nullptr;
  format::Clearance* clearance = nullptr;
  const auto first_at = builder.CreateVector(first);
  // Not CreateUninitializedVectorOfStructs: it takes a struct's size for its alignment, and 44 is
  // no power of two, which leaves the 64-bit words behind it between two words.
  const auto levels_at = builder.CreateVectorOfStructs<format::Level>(
      level_count, [&](size_t i, format::Level* level) {
        if (i == 0) levels = level;
      });
  const auto clearance_at = builder.CreateUninitializedVectorOfStructs(clearances, &clearance);
  const auto words_at = builder.CreateUninitializedVector(runs.words(), &words);
  parallel_for(packs.size(), workers, [&](size_t t) {
    TilePack& pack = packs[t];
    format::Level* level = levels + first[t];
    for (const auto& l : pack.levels) *level++ = placed(l, t, runs);
    format::Clearance* entry = clearance + size_t{first[t]} * shape.class_count;
    for (const auto& c : pack.clearance) {
      const bool stored = c.kind() == format::CellsKind::Blocks;
      *entry++ = {c.kind(), c.step_safe(), c.legal_cells(), stored ? runs.place(t, c.offset()) : 0};
    }
    for (uint32_t r = 0; r < pack.runs.size(); ++r) {
      if (!runs.is_first(t, r)) continue;
      std::copy_n(&pack.words[pack.runs[r].first], pack.runs[r].count, words + runs.place(t, r));
    }
    pack = {};
  });
  builder.Finish(
      format::CreateZone(builder, world::kZoneVersion, shape.x, shape.z, shape.tiles_per_side,
                         shape.class_count, first_at, levels_at, clearance_at, words_at),
      format::ZoneIdentifier());
  return builder.Release();
}

}  // namespace throng::bake
