// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/tile_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "core/access.h"
#include "graph/ground_parts.h"
#include "graph/tile_steps.h"
#include "world/place.h"
#include "world/tile_grid.h"

// The cells of a level tile as those of a patch: what bodies may rely on in each, steps between
// them, and pairs over the tile's borders. Linear in the cells and classes.
namespace throng::graph {
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

namespace {

// Rows of what each class may stand on, merged: calls visit(first cell, count, classes) for runs of
// cells on which the same ones stand.
template <class Visit>
void for_runs(const std::array<world::CellRows, kMaxAvatarClasses>& legal, size_t classes,
              Visit visit) {
  for (size_t z = 0; z < kTileCells; ++z) {
    uint64_t any = 0, changes = 1;
    for (size_t c = 0; c < classes; ++c) {
      any |= legal[c][z];
      changes |= legal[c][z] ^ legal[c][z] << 1;
    }
    if (any == 0) continue;
    while (changes != 0) {
      const int32_t x = std::countr_zero(changes);
      changes &= changes - 1;
      const int32_t end = changes == 0 ? kTileCells : std::countr_zero(changes);
      uint16_t stands = 0;
      for (size_t c = 0; c < classes; ++c) {
        if ((legal[c][z] >> x & 1) != 0) stands |= bit_of(c);
      }
      if (stands != 0) visit(z * kTileCells + static_cast<size_t>(x), end - x, stands);
    }
  }
}

// Ceilings of a level above its floors, kNoValue for none.
std::optional<std::array<uint16_t, kArea>> unpack_ceilings(const world::Zone& zone,
                                                           const format::Level& level) {
  if (level.ceiling_kind() != format::HeightKind::Blocks) return std::nullopt;
  std::array<uint16_t, kArea> ceilings;
  world::unpack_values(zone.words(level.ceiling_offset()), ceilings.data());
  return ceilings;
}

}  // namespace

PatchCells tile_cells(const World& world, uint32_t level, uint16_t wanted, const NodeBins& bins) {
  const world::WorldData& data = *data_of(world);
  const std::vector<AvatarClass>& classes = data.summary.classes;
  PatchCells patch;
  patch.depth = kTileDepth;
  patch.partial = true;
  patch.cells.assign(kArea, {.classes = 0, .inclination = 15, .height = 0, .headroom = 0});
  world::GroundLevel ground = world::ground_level(data, level, 0);
  if (ground.zone == nullptr) return patch;
  const uint32_t zone_level = level - data.slots[data.slot_of_level(level)]->first_level;
  std::array<uint16_t, kArea> samples;
  if (ground.view.floor != nullptr) {
    world::unpack_floor(ground.view, samples.data());
    ground.view.samples = samples.data();
  }
  std::array<world::CellRows, kMaxAvatarClasses> legal;
  for (size_t c = 0; c < classes.size(); ++c) {
    legal[c] = {};
    if ((wanted & bit_of(c)) == 0) continue;
    world::set_class(ground, zone_level, static_cast<int32_t>(c));
    legal[c] = legal_rows(ground);
    if (ground.kind == format::CellsKind::None) continue;
    const auto cuts = step_cuts(ground, legal[c], world::step_mm(classes[c]));
    if (!cuts) continue;
    const auto note = [&](const world::CellRows& rows, std::vector<uint16_t>& out) {
      for (size_t z = 0; z < kTileCells; ++z) {
        for (uint64_t left = rows[z]; left != 0; left &= left - 1) {
          if (patch.cut_s.empty()) patch.cut_s.assign(kArea, 0);
          if (patch.cut_t.empty()) patch.cut_t.assign(kArea, 0);
          out[z * kTileCells + static_cast<size_t>(std::countr_zero(left))] |= bit_of(c);
        }
      }
    };
    note(cuts->across, patch.cut_s);
    note(cuts->along, patch.cut_t);
  }

  if (const auto steps = tile_steps(ground.view, step_limits(classes, data.summary.cell))) {
    patch.step_s.assign(steps->across.begin(), steps->across.end());
    patch.step_t.assign(steps->along.begin(), steps->along.end());
  }

  const format::Level& record = *ground.view.record;
  const auto ceilings = unpack_ceilings(*ground.zone, record);
  const bool is_flat = record.ceiling_kind() == format::HeightKind::Constant;
  const std::vector<uint8_t> inclination = inclination_by_class(classes, bins);
  const auto open = static_cast<uint8_t>(bins.height.size());
  // A body on a level tile stands upright: its height is the headroom.
  const auto headroom_over = [&](size_t cell) {
    if (!is_flat && (!ceilings || (*ceilings)[cell] == world::kNoValue)) return open;
    const int32_t ceiling = record.ceiling_base() + (is_flat ? 0 : (*ceilings)[cell]);
    // Feet slant evenly over a cell: the highest are at a corner.
    int32_t feet = INT32_MIN;
    for (const int32_t u : {0, world::kUnitsPerCell - 1}) {
      for (const int32_t v : {0, world::kUnitsPerCell - 1}) {
        feet =
            std::max(feet, ground.view.feet(world::x_of_cell(cell), world::z_of_cell(cell), u, v));
      }
    }
    return bins.height_code((static_cast<double>(ceiling) - feet) * 1e-3);
  };
  for_runs(legal, classes.size(), [&](size_t first, int32_t count, uint16_t stands) {
    uint8_t steepest = 15;
    for (uint32_t left = stands; left != 0; left &= left - 1) {
      steepest = std::min(steepest, inclination[static_cast<size_t>(std::countr_zero(left))]);
    }
    for (size_t i = first; i < first + static_cast<size_t>(count); ++i) {
      const uint8_t free_height = headroom_over(i);
      patch.cells[i] = {stands, steepest, free_height, free_height};
    }
  });
  return patch;
}

namespace {

// The cells along one side of a level: which classes may stand there, and how high.
struct Rim {
  std::array<uint16_t, kTileCells> classes{};
  std::array<int32_t, kTileCells> feet{};  // of cells where some class may [mm]
};

Rim rim_of(const world::WorldData& world, world::GroundLevel level, uint32_t zone_level,
           TileSide side) {
  Rim rim;
  const bool across = side == kWest || side == kEast, far = side == kEast || side == kSouth;
  const uint32_t in = far ? 7 : 0;  // block, and cell in it
  for (size_t c = 0; c < world.summary.classes.size(); ++c) {
    world::set_class(level, zone_level, static_cast<int32_t>(c));
    if (level.kind == format::CellsKind::None) continue;
    for (uint32_t b = 0; b < 8; ++b) {
      const uint64_t cells = level.legal_in(across ? b * 8 + in : in * 8 + b);
      for (uint32_t i = 0; cells != 0 && i < 8; ++i) {
        if ((cells >> (across ? i * 8 + in : in * 8 + i) & 1) != 0) {
          rim.classes[b * 8 + i] |= bit_of(c);
        }
      }
    }
  }
  for (int32_t i = 0; i < kTileCells; ++i) {
    const auto at = static_cast<size_t>(i);
    const int32_t last = far ? world::kInTile : 0;
    if (rim.classes[at] == 0) continue;
    rim.feet[at] = level.view.sample(across ? last : i, across ? i : last);
  }
  return rim;
}

// Finds pairs from the cells of one tile, towards greater x and z, by the moves' rule (step_to):
// of the levels on which the class may stand, the one whose floor is nearest, if within a step.
class PairFinder {
 public:
  PairFinder(const world::WorldData& world, int32_t tile_x, int32_t tile_z)
      : world_(world), tile_x_(tile_x), tile_z_(tile_z), here_(levels_of(tile_x, tile_z)) {
    for (const AvatarClass& avatar : world.summary.classes)
      steps_.push_back(world::step_mm(avatar));
    limits_ = step_limits(world.summary.classes, world.summary.cell);
  }

  std::vector<CellPair> find() {
    if (here_.empty()) return {};
    find_beyond(kEast);
    find_beyond(kSouth);
    if (here_.size() > 1) find_seams();
    return std::move(pairs_);
  }

 private:
  struct TileLevel {
    world::GroundLevel ground;  // of class 0
    uint32_t zone_level = 0;
  };

  [[nodiscard]] std::vector<TileLevel> levels_of(int32_t x, int32_t z) const {
    std::vector<TileLevel> levels;
    const auto tile = world_.tile_levels(x, z);
    for (uint32_t l = tile.first; l < tile.last; ++l) {
      const uint32_t zone_level = tile.zone_first + l - tile.first;
      levels.push_back({world::ground_level(*tile.zone, zone_level, l, 0), zone_level});
    }
    return levels;
  }

  // Of levels the first whose floor is nearest, within a step: `rise(level)` is INT32_MAX where the
  // class may not stand. kNoNode: none.
  template <class Rise>
  static uint32_t nearest(size_t levels, int32_t step, Rise rise) {
    uint32_t best = kNoNode;
    int32_t min_rise = INT32_MAX;
    for (uint32_t l = 0; l < levels; ++l) {
      const int32_t r = rise(l);
      if (r > step || r >= min_rise) continue;
      min_rise = r;
      best = l;
    }
    return best;
  }

  // Over a border of the tile.
  void find_beyond(TileSide side) {
    const bool east = side == kEast;
    const auto beyond = levels_of(tile_x_ + (east ? 1 : 0), tile_z_ + (east ? 0 : 1));
    if (beyond.empty()) return;
    std::vector<Rim> ours, theirs;
    for (const TileLevel& l : here_) ours.push_back(rim_of(world_, l.ground, l.zone_level, side));
    for (const TileLevel& l : beyond) {
      theirs.push_back(rim_of(world_, l.ground, l.zone_level, east ? kWest : kNorth));
    }
    std::vector<uint16_t> classes(beyond.size());  // that step to each
    for (int32_t i = 0; i < kTileCells; ++i) {
      const auto at = static_cast<size_t>(i);
      const auto to_one_of = [&](const std::vector<Rim>& rims, int32_t feet, size_t c) {
        return nearest(rims.size(), steps_[c], [&](uint32_t l) {
          if ((rims[l].classes[at] & bit_of(c)) == 0) return INT32_MAX;
          return std::abs(rims[l].feet[at] - feet);
        });
      };
      for (uint32_t l = 0; l < ours.size(); ++l) {
        if (ours[l].classes[at] == 0) continue;
        std::fill(classes.begin(), classes.end(), uint16_t{0});
        for (uint32_t left = ours[l].classes[at]; left != 0; left &= left - 1) {
          const auto c = static_cast<size_t>(std::countr_zero(left));
          const uint32_t to = to_one_of(theirs, ours[l].feet[at], c);
          if (to == kNoNode || to_one_of(ours, theirs[to].feet[at], c) != l) continue;
          classes[to] |= bit_of(c);
        }
        for (uint32_t to = 0; to < classes.size(); ++to) {
          if (classes[to] == 0) continue;
          add(here_[l].ground, beyond[to].ground, classes[to], east ? world::kInTile : i,
              east ? i : world::kInTile, east);
        }
      }
    }
  }

  // Within a tile a body changes its level only where its own ends and another continues.
  void find_seams() {
    legal_.resize(here_.size());
    safe_.resize(here_.size());
    std::array<uint16_t, kArea> samples;
    for (size_t c = 0; c < steps_.size(); ++c) {
      for (size_t l = 0; l < here_.size(); ++l) {
        world::GroundLevel level = here_[l].ground;
        world::set_class(level, here_[l].zone_level, static_cast<int32_t>(c));
        legal_[l] = legal_rows(level);
        safe_[l] = level.step_safe ? 1 : 0;
      }
      for (uint32_t l = 0; l < here_.size(); ++l) {
        const world::CellRows& own = legal_[l];
        world::CellRows others{};
        for (size_t o = 0; o < here_.size(); ++o) {
          for (size_t z = 0; z < kTileCells && o != l; ++z) others[z] |= legal_[o][z];
        }
        uint64_t beside = 0;
        for (size_t z = 0; z < kTileCells; ++z) {
          beside |= own[z] & (others[z] >> 1 | (z < world::kInTile ? others[z + 1] : 0));
        }
        if (beside == 0) continue;
        world::GroundLevel level = here_[l].ground;
        world::set_class(level, here_[l].zone_level, static_cast<int32_t>(c));
        if (level.view.floor != nullptr && !level.step_safe) {
          world::unpack_floor(level.view, samples.data());
          level.view.samples = samples.data();
        }
        const auto cuts = step_cuts(level, own, steps_[c]);
        for (size_t z = 0; z < kTileCells; ++z) {
          uint64_t ends = ~(own[z] >> 1);
          if (cuts) ends |= cuts->across[z];
          ends &= own[z] & others[z] >> 1;
          for (; ends != 0; ends &= ends - 1) {
            cross_seam(l, c, std::countr_zero(ends), static_cast<int32_t>(z), true);
          }
          if (z == world::kInTile) break;
          ends = ~own[z + 1];
          if (cuts) ends |= cuts->along[z];
          ends &= own[z] & others[z + 1];
          for (; ends != 0; ends &= ends - 1) {
            cross_seam(l, c, std::countr_zero(ends), static_cast<int32_t>(z), false);
          }
        }
      }
    }
  }

  // From a cell beyond which its own level ends.
  void cross_seam(uint32_t from, size_t c, int32_t x, int32_t z, bool east) {
    const int32_t nx = x + (east ? 1 : 0), nz = z + (east ? 0 : 1);
    const auto to_level = [&](int32_t feet, int32_t at_x, int32_t at_z) {
      return nearest(here_.size(), steps_[c], [&](uint32_t l) {
        if ((legal_[l][static_cast<size_t>(at_z)] >> at_x & 1) == 0) return INT32_MAX;
        return std::abs(here_[l].ground.view.sample(at_x, at_z) - feet);
      });
    };
    const int32_t feet = here_[from].ground.view.sample(x, z);
    const uint32_t to = to_level(feet, nx, nz);
    if (to == kNoNode || to == from) return;
    const int32_t there = here_[to].ground.view.sample(nx, nz);
    // Its level may continue to the first cell; then no class comes back.
    if ((legal_[to][static_cast<size_t>(z)] >> x & 1) != 0 &&
        (safe_[to] != 0 || std::abs(here_[to].ground.view.sample(x, z) - there) <= steps_[c])) {
      return;
    }
    if (to_level(there, x, z) != from) return;
    add(here_[from].ground, here_[to].ground, bit_of(c), x, z, east);
  }

  void add(const world::GroundLevel& from, const world::GroundLevel& to, uint16_t classes,
           int32_t x, int32_t z, bool east) {
    const int32_t nx = x + (east ? 1 : 0), nz = z + (east ? 0 : 1);
    const bool steps =
        is_step(from.view, x, z, to.view, world::in_tile(nx), world::in_tile(nz), limits_);
    pairs_.push_back(
        {.patch_a = from.world_level,
         .cell_a = static_cast<uint32_t>(world::cell_index(x, z)),
         .patch_b = to.world_level,
         .cell_b = static_cast<uint32_t>(world::cell_index(world::in_tile(nx), world::in_tile(nz))),
         .classes = classes,
         .kind = steps ? LinkKind::kStep : LinkKind::kWalk,
         .side_a = static_cast<uint8_t>(east ? 2 : 1),
         .side_b = static_cast<uint8_t>(east ? 0 : 3)});
  }

  const world::WorldData& world_;
  int32_t tile_x_, tile_z_;
  std::vector<TileLevel> here_;
  std::vector<int32_t> steps_;  // per class [mm]
  StepLimits limits_;
  std::vector<world::CellRows> legal_;  // of a class, by level of the tile
  std::vector<uint8_t> safe_;           // likewise: no step on the level is too high
  std::vector<CellPair> pairs_;
};

}  // namespace

std::vector<CellPair> tile_pairs(const world::WorldData& world, int32_t tile_x, int32_t tile_z) {
  std::vector<CellPair> pairs = PairFinder(world, tile_x, tile_z).find();
  merge_cell_pairs(pairs);                                   // one for all its classes
  return std::vector<CellPair>(pairs.begin(), pairs.end());  // no room to grow: these are many
}

}  // namespace throng::graph
