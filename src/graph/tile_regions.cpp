// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/tile_regions.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <span>
#include <tuple>
#include <utility>

#include "graph/ground_parts.h"
#include "world/place.h"

// The parts of every level for every class are found; parts of several classes that are the same
// place share a region; and parts of different levels of the tile are linked where sheets meet.
// Tiles are linked over their borders by what each part shows there.
namespace throng {
namespace {

uint64_t column(const CellRows& rows, int32_t x) {
  uint64_t bits = 0;
  for (size_t z = 0; z < 64; ++z) bits |= ((rows[z] >> x) & 1) << z;
  return bits;
}

uint32_t shared_cells(const CellRows& a, const CellRows& b) {
  uint32_t count = 0;
  for (size_t z = 0; z < 64; ++z) {
    const uint64_t both = a[z] & b[z];  // Most parts are small: most rows share nothing.
    if (both != 0) count += static_cast<uint32_t>(std::popcount(both));
  }
  return count;
}

CellRows together(std::span<const CellRows> parts) {
  CellRows all{};
  for (const CellRows& part : parts) {
    for (size_t z = 0; z < 64; ++z) all[z] |= part[z];
  }
  return all;
}

CellRows without(CellRows cells, const CellRows& taken) {
  for (size_t z = 0; z < 64; ++z) cells[z] &= ~taken[z];
  return cells;
}

// Is any cell of `a` beside one of `b`?
bool is_beside(const CellRows& a, const CellRows& b) {
  uint64_t found = 0;
  for (size_t z = 0; z < 64; ++z) {
    const uint64_t over = z > 0 ? a[z - 1] : 0, under = z < 63 ? a[z + 1] : 0;
    found |= (a[z] << 1 | a[z] >> 1 | over | under) & b[z];
  }
  return found != 0;
}

uint32_t first_cell(const CellRows& rows) {
  for (uint32_t z = 0; z < 64; ++z) {
    if (rows[z] != 0) return z * 64 + static_cast<uint32_t>(std::countr_zero(rows[z]));
  }
  return 0;
}

RegionPart make_part(uint32_t region, const CellRows& rows) {
  RegionPart part{region, 0, {column(rows, 0), column(rows, 63), rows[0], rows[63]}};
  for (const uint64_t row : rows) {
    if (row != 0) part.cells += static_cast<uint32_t>(std::popcount(row));
  }
  return part;
}

// The parts of one level, class after class, with the regions that they make.
class LevelRegions {
 public:
  LevelRegions(uint32_t level, TileParts& tile) : level_(level), tile_(&tile) {
    begin_ = tile.regions.size();
  }

  // Gives each part of a class its region: of those that other classes have made and no other part
  // of this class has taken, the one with which it shares most cells, or a new one.
  std::vector<uint32_t> add(std::span<const CellRows> parts, uint32_t class_bit) {
    std::vector<uint32_t> regions(parts.size());
    for (size_t p = 0; p < parts.size(); ++p) {
      size_t best = common_.size();
      uint32_t most = 0;
      for (size_t r = 0; r < common_.size(); ++r) {
        if ((tile_->regions[begin_ + r].classes & class_bit) != 0) continue;
        const uint32_t shared = shared_cells(common_[r], parts[p]);
        if (shared <= most) continue;
        most = shared;
        best = r;
      }
      if (best == common_.size()) {
        common_.push_back(parts[p]);
        tile_->regions.push_back({level_, 0, 0});
      }
      for (size_t z = 0; z < 64; ++z) common_[best][z] &= parts[p][z];
      Region& region = tile_->regions[begin_ + best];
      region.classes |= class_bit;
      region.key = first_cell(common_[best]);
      regions[p] = static_cast<uint32_t>(begin_ + best);
    }
    return regions;
  }

 private:
  uint32_t level_;
  TileParts* tile_;
  size_t begin_ = 0;
  std::vector<CellRows> common_;  // per region: cells that all its classes' parts share
};

}  // namespace

TileRegions::TileRegions(const WorldData& world) : world_(world) {
  for (const AvatarClass& avatar : world.summary.classes) steps_.push_back(step_mm(avatar));
}

TileParts TileRegions::find(int32_t tile_x, int32_t tile_z, Shapes& shapes) const {
  TileParts tile;
  const auto levels = world_.tile_levels(tile_x, tile_z);
  tile.first_level = levels.first;
  tile.levels = levels.last - levels.first;
  tile.classes.resize(tile.levels * steps_.size());
  shapes.assign(tile.classes.size(), {});
  for (uint32_t l = 0; l < tile.levels; ++l) {
    tile.first.push_back(static_cast<uint32_t>(tile.regions.size()));
    find_level(levels, l, tile, shapes);
  }
  tile.first.push_back(static_cast<uint32_t>(tile.regions.size()));
  return tile;
}

TileParts TileRegions::parts(int32_t tile_x, int32_t tile_z) const {
  Shapes shapes;
  return find(tile_x, tile_z, shapes);
}

TileParts TileRegions::linked_parts(int32_t tile_x, int32_t tile_z) const {
  Shapes shapes;
  TileParts tile = find(tile_x, tile_z, shapes);
  for (size_t c = 0; c < steps_.size(); ++c) {
    for (uint32_t a = 0; a < tile.levels; ++a) {
      for (uint32_t b = a + 1; b < tile.levels; ++b) {
        link_seam(tile_x, tile_z, c, a, b, shapes, tile);
      }
    }
  }
  return tile;
}

std::vector<RegionLink> TileRegions::border(int32_t tile_x, int32_t tile_z, TileSide side,
                                            const TileParts& from, const TileParts& to) const {
  std::vector<RegionLink> links;
  const TileSide back = side == kEast ? kWest : kNorth;
  for (size_t c = 0; c < steps_.size(); ++c) {
    for (uint32_t a = 0; a < from.levels; ++a) {
      const auto as = from.classes[a * steps_.size() + c];
      if (as.first == as.last) continue;
      const GroundLevel level_a = ground(from.first_level + a, c);
      for (uint32_t b = 0; b < to.levels; ++b) {
        const auto bs = to.classes[b * steps_.size() + c];
        if (bs.first == bs.last) continue;
        const GroundLevel level_b = ground(to.first_level + b, c);
        for (uint32_t p = as.first; p < as.last; ++p) {
          for (uint32_t q = bs.first; q < bs.last; ++q) {
            const uint64_t both = from.parts[p].side[side] & to.parts[q].side[back];
            if (!crosses(tile_x, tile_z, side, c, level_a, level_b, both)) continue;
            links.push_back({from.parts[p].region, to.parts[q].region, uint32_t{1} << c});
          }
        }
      }
    }
  }
  return links;
}

void TileRegions::find_level(const WorldData::TileLevels& levels, uint32_t l, TileParts& tile,
                             Shapes& shapes) const {
  LevelRegions regions(levels.first + l, tile);
  for (size_t c = 0; c < steps_.size(); ++c) {
    const size_t at = l * steps_.size() + c;
    const GroundLevel ground = ground_level(*levels.zone, levels.zone_first + l, levels.first + l,
                                            static_cast<int32_t>(c));
    const CellRows legal = legal_rows(ground);
    if (ground.kind == format::CellsKind::All && ground.step_safe) {
      shapes[at] = {legal};
    } else {
      const auto cuts = step_cuts(ground, legal, steps_[c]);
      shapes[at] = connected_parts(legal, cuts ? &*cuts : nullptr);
    }
    const std::vector<uint32_t> of = regions.add(shapes[at], uint32_t{1} << c);
    tile.classes[at].first = static_cast<uint32_t>(tile.parts.size());
    for (size_t p = 0; p < of.size(); ++p) tile.parts.push_back(make_part(of[p], shapes[at][p]));
    tile.classes[at].last = static_cast<uint32_t>(tile.parts.size());
  }
}

GroundLevel TileRegions::ground(uint32_t level, size_t c) const {
  return ground_level(world_, level, static_cast<int32_t>(c));
}

// True if a class steps from cell (x, z) of the grid on level `a` to (nx, nz) on level `b`, and
// back.
bool TileRegions::steps_both_ways(size_t c, const GroundLevel& a, const GroundLevel& b, int32_t x,
                                  int32_t z, int32_t nx, int32_t nz) const {
  const int32_t rise = b.view.sample(nx & 63, nz & 63) - a.view.sample(x & 63, z & 63);
  if (std::abs(rise) > steps_[c]) return false;
  const WorldGround ground{world_, static_cast<int32_t>(c)};
  const auto there = step_to(ground, a, x, z, nx, nz, steps_[c]);
  if (!there || there->world_level != b.world_level) return false;
  const auto back = step_to(ground, b, nx, nz, x, z, steps_[c]);
  return back && back->world_level == a.world_level;
}

// True if a step crosses the border at one of the cells in `both`.
bool TileRegions::crosses(int32_t tile_x, int32_t tile_z, TileSide side, size_t c,
                          const GroundLevel& a, const GroundLevel& b, uint64_t both) const {
  if (a.view.is_constant() && b.view.is_constant() &&
      std::abs(a.view.floor_base - b.view.floor_base) > steps_[c])
    return false;
  for (; both != 0; both &= both - 1) {
    const int32_t i = std::countr_zero(both);
    const int32_t x = tile_x * 64 + (side == kEast ? 63 : i);
    const int32_t z = tile_z * 64 + (side == kEast ? i : 63);
    const int32_t nx = side == kEast ? x + 1 : x, nz = side == kEast ? z : z + 1;
    if (steps_both_ways(c, a, b, x, z, nx, nz)) return true;
  }
  return false;
}

// Links the parts of two levels of one tile where their sheets meet.
void TileRegions::link_seam(int32_t tile_x, int32_t tile_z, size_t c, uint32_t a, uint32_t b,
                            const Shapes& shapes, TileParts& tile) const {
  const size_t at_a = a * steps_.size() + c, at_b = b * steps_.size() + c;
  if (shapes[at_a].empty() || shapes[at_b].empty()) return;
  const GroundLevel level_a = ground(tile.first_level + a, c);
  const GroundLevel level_b = ground(tile.first_level + b, c);
  // A body stays on its level where that goes on: it changes to the other only over cells where
  // its own has nothing, unless a step may be too high.
  const CellRows all_a = together(shapes[at_a]), all_b = together(shapes[at_b]);
  const CellRows taken_a = level_a.step_safe ? all_a : CellRows{};
  const CellRows taken_b = level_b.step_safe ? all_b : CellRows{};
  const CellRows to_any = without(all_b, taken_a);
  if (!is_beside(without(all_a, taken_b), to_any)) return;
  for (size_t p = 0; p < shapes[at_a].size(); ++p) {
    const CellRows from_cells = without(shapes[at_a][p], taken_b);
    if (!is_beside(from_cells, to_any)) continue;
    for (size_t q = 0; q < shapes[at_b].size(); ++q) {
      const CellRows to_cells = without(shapes[at_b][q], taken_a);
      if (!touch(tile_x, tile_z, c, level_a, level_b, from_cells, to_cells)) continue;
      const uint32_t from = tile.parts[tile.classes[at_a].first + p].region;
      const uint32_t to = tile.parts[tile.classes[at_b].first + q].region;
      tile.links.push_back({from, to, uint32_t{1} << c});
    }
  }
}

bool TileRegions::touch(int32_t tile_x, int32_t tile_z, size_t c, const GroundLevel& a,
                        const GroundLevel& b, const CellRows& p, const CellRows& q) const {
  const auto any = [&](uint64_t pairs, int32_t dx, int32_t dz, size_t row) {
    for (; pairs != 0; pairs &= pairs - 1) {
      const int32_t x = tile_x * 64 + std::countr_zero(pairs);
      const int32_t z = tile_z * 64 + static_cast<int32_t>(row);
      if (steps_both_ways(c, a, b, x, z, x + dx, z + dz)) return true;
    }
    return false;
  };
  for (size_t z = 0; z < 64; ++z) {
    if (any(p[z] & (q[z] >> 1), 1, 0, z) || any(p[z] & (q[z] << 1), -1, 0, z)) return true;
    if (z < 63 && any(p[z] & q[z + 1], 0, 1, z)) return true;
    if (z > 0 && any(p[z] & q[z - 1], 0, -1, z)) return true;
  }
  return false;
}

void merge_links(std::vector<RegionLink>& links) {
  std::sort(links.begin(), links.end(), [](const RegionLink& p, const RegionLink& q) {
    return std::tie(p.a, p.b) < std::tie(q.a, q.b);
  });
  size_t kept = 0;
  for (const RegionLink& link : links) {
    if (kept > 0 && links[kept - 1].a == link.a && links[kept - 1].b == link.b) {
      links[kept - 1].classes |= link.classes;
    } else {
      links[kept++] = link;
    }
  }
  links.resize(kept);
}

}  // namespace throng
