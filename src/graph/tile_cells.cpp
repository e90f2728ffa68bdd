// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/tile_cells.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "graph/ground_parts.h"
#include "world/place.h"

namespace throng {
namespace {

constexpr size_t kArea = 4096;

uint16_t bit_of(size_t avatar_class) { return static_cast<uint16_t>(1u << avatar_class); }

// The least inclination that is known to hold: of the classes that may stand on a cell, the
// gentlest limit. It is one of the bins' edges.
std::vector<uint8_t> inclination_by_class(const std::vector<AvatarClass>& classes,
                                          const NodeBins& bins) {
  std::vector<uint8_t> codes;
  for (const AvatarClass& avatar : classes) {
    codes.push_back(bins.inclination_code(avatar.max_slope));
  }
  return codes;
}

}  // namespace

PatchCells tile_cells(const World& world, uint32_t level, uint16_t wanted, const NodeBins& bins) {
  const WorldData& data = *world.data();
  const std::vector<AvatarClass>& classes = data.summary.classes;
  const std::vector<uint8_t> inclination = inclination_by_class(classes, bins);
  PatchCells patch;
  patch.depth = kTileDepth;
  patch.cells.assign(kArea, {.classes = 0, .inclination = 15, .height = 0, .headroom = 0});
  for (size_t c = 0; c < classes.size(); ++c) {
    const GroundLevel ground = ground_level(data, level, static_cast<int32_t>(c));
    if ((wanted & bit_of(c)) == 0) continue;
    if (ground.zone == nullptr || ground.kind == format::CellsKind::None) continue;
    const CellRows legal = legal_rows(ground);
    for (size_t z = 0; z < 64; ++z) {
      for (uint64_t left = legal[z]; left != 0; left &= left - 1) {
        Promise& cell = patch.cells[z * 64 + static_cast<size_t>(std::countr_zero(left))];
        cell.classes |= bit_of(c);
        cell.inclination = std::min(cell.inclination, inclination[c]);
      }
    }
    const auto cuts = step_cuts(ground, legal, step_mm(classes[c]));
    if (!cuts) continue;
    const auto note = [&](const CellRows& rows, std::vector<uint16_t>& out) {
      for (size_t z = 0; z < 64; ++z) {
        for (uint64_t left = rows[z]; left != 0; left &= left - 1) {
          if (patch.cut_s.empty()) patch.cut_s.assign(kArea, 0);
          if (patch.cut_t.empty()) patch.cut_t.assign(kArea, 0);
          out[z * 64 + static_cast<size_t>(std::countr_zero(left))] |= bit_of(c);
        }
      }
    };
    note(cuts->across, patch.cut_s);
    note(cuts->along, patch.cut_t);
  }

  const LevelTileContent content = world.level_tile(level);
  const LevelView view = ground_level(data, level, 0).view;
  const auto open = static_cast<uint8_t>(bins.height.size());
  for (int32_t z = 0; z < 64; ++z) {
    for (int32_t x = 0; x < 64; ++x) {
      const size_t i = patch.index(x, z);
      if (patch.cells[i].classes == 0) continue;
      uint8_t& room = patch.cells[i].headroom;
      room = open;
      if (content.ceiling[i] != kOpenSky) {
        // Feet slant evenly over a cell: the highest are at a corner.
        int32_t feet = INT32_MIN;
        for (const int32_t u : {0, kUnitsPerCell - 1}) {
          for (const int32_t v : {0, kUnitsPerCell - 1}) {
            feet = std::max(feet, view.feet(x, z, u, v));
          }
        }
        room = bins.height_code((static_cast<double>(content.ceiling[i]) - feet) * 1e-3);
      }
      patch.cells[i].height = room;  // A body on a level tile stands upright.
    }
  }
  return patch;
}

namespace {

// Finds pairs from the cells of one level, towards greater x and z.
class PairFinder {
 public:
  PairFinder(const WorldData& world, int32_t tile_x, int32_t tile_z)
      : world_(world), tile_x_(tile_x), tile_z_(tile_z) {
    for (const AvatarClass& avatar : world.summary.classes) steps_.push_back(step_mm(avatar));
  }

  std::vector<CellPair> find() {
    const auto levels = world_.tile_levels(tile_x_, tile_z_);
    const auto beside = [&](int32_t x, int32_t z) {
      const auto tile = world_.tile_levels(x, z);
      return tile.last > tile.first;
    };
    const bool east = beside(tile_x_ + 1, tile_z_), south = beside(tile_x_, tile_z_ + 1);
    const bool seams = levels.last - levels.first > 1;
    for (uint32_t l = levels.first; l < levels.last; ++l) {
      for (size_t c = 0; c < steps_.size(); ++c) {
        const GroundLevel level = ground_level(world_, l, static_cast<int32_t>(c));
        if (level.kind == format::CellsKind::None) continue;
        const CellRows legal = legal_rows(level);
        for (int32_t i = 0; i < 64; ++i) {
          if (east && ((legal[static_cast<size_t>(i)] >> 63) & 1) != 0)
            try_step(level, c, 63, i, 1, 0);
          if (south && ((legal[63] >> i) & 1) != 0) try_step(level, c, i, 63, 0, 1);
        }
        if (seams) find_seams(level, c, legal);
      }
    }
    return std::move(pairs_);
  }

 private:
  // Within a tile a body changes its level only where its own does not go on.
  void find_seams(const GroundLevel& level, size_t c, const CellRows& legal) {
    const auto cuts = step_cuts(level, legal, steps_[c]);
    for (size_t z = 0; z < 64; ++z) {
      uint64_t ends = legal[z] & ~(legal[z] >> 1) & ~(uint64_t{1} << 63);
      if (cuts) ends |= cuts->across[z];
      for (; ends != 0; ends &= ends - 1) {
        try_step(level, c, std::countr_zero(ends), static_cast<int32_t>(z), 1, 0);
      }
      if (z == 63) break;
      ends = legal[z] & ~legal[z + 1];
      if (cuts) ends |= cuts->along[z];
      for (; ends != 0; ends &= ends - 1) {
        try_step(level, c, std::countr_zero(ends), static_cast<int32_t>(z), 0, 1);
      }
    }
  }

  void try_step(const GroundLevel& from, size_t c, int32_t x, int32_t z, int32_t dx, int32_t dz) {
    const WorldGround ground{world_, static_cast<int32_t>(c)};
    const int32_t gx = tile_x_ * 64 + x, gz = tile_z_ * 64 + z;
    const auto to = step_to(ground, from, gx, gz, gx + dx, gz + dz, steps_[c]);
    if (!to || to->world_level == from.world_level) return;
    const auto back = step_to(ground, *to, gx + dx, gz + dz, gx, gz, steps_[c]);
    if (!back || back->world_level != from.world_level) return;
    pairs_.push_back({.patch_a = from.world_level,
                      .cell_a = static_cast<uint32_t>(z * 64 + x),
                      .patch_b = to->world_level,
                      .cell_b = static_cast<uint32_t>(((z + dz) & 63) * 64 + ((x + dx) & 63)),
                      .classes = bit_of(c),
                      .side_a = static_cast<uint8_t>(dx != 0 ? 2 : 1),
                      .side_b = static_cast<uint8_t>(dx != 0 ? 0 : 3)});
  }

  const WorldData& world_;
  int32_t tile_x_, tile_z_;
  std::vector<int32_t> steps_;  // per class [mm]
  std::vector<CellPair> pairs_;
};

}  // namespace

std::vector<CellPair> tile_pairs(const WorldData& world, int32_t tile_x, int32_t tile_z) {
  std::vector<CellPair> pairs = PairFinder(world, tile_x, tile_z).find();
  merge_cell_pairs(pairs);  // one for all its classes
  return pairs;
}

}  // namespace throng
