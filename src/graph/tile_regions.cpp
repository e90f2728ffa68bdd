// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/tile_regions.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "core/arrays/prefetch.h"
#include "graph/ground_parts.h"
#include "world/place.h"
#include "world/tile_grid.h"

// The parts of every level for every class are found; parts of several classes that are the same
// place share a region; and parts of different levels of the tile are linked where level tiles
// meet. Tiles are linked over their borders by what each part shows there.
namespace throng::graph {
namespace {

using Part = PartList::Part;

// Cells of a row of a list's part that are not occupied.
uint64_t row_without(const PartList& list, const Part& part, size_t z,
                     const world::CellRows* occupied) {
  if (z < part.begin || z >= part.end) return 0;
  return list.row(part, z) & ~(occupied != nullptr ? (*occupied)[z] : 0);
}

// The rows that both parts have.
struct RowRange {
  size_t begin, end;

  RowRange(const Part& a, const Part& b)
      : begin(std::max(a.begin, b.begin)), end(std::min(a.end, b.end)) {}
};

bool share_cells(const PartList& a, const Part& p, const PartList& b, const Part& q) {
  const RowRange range(p, q);
  for (size_t z = range.begin; z < range.end; ++z) {
    if ((a.row(p, z) & b.row(q, z)) != 0) return true;
  }
  return false;
}

uint32_t shared_cells(const PartList& a, const Part& p, const PartList& b, const Part& q) {
  const RowRange range(p, q);
  uint32_t count = 0;
  for (size_t z = range.begin; z < range.end; ++z) {
    const uint64_t both = a.row(p, z) & b.row(q, z);
    if (both != 0) count += world::count_ones(both);
  }
  return count;
}

world::CellRows without(world::CellRows cells, const world::CellRows& occupied) {
  for (size_t z = 0; z < kTileCells; ++z) cells[z] &= ~occupied[z];
  return cells;
}

// Is any cell of `a` beside one of `b`?
bool is_beside(const world::CellRows& a, const world::CellRows& b) {
  uint64_t found = (a[0] << 1 | a[0] >> 1 | a[1]) & b[0];
  constexpr size_t kLast = world::kInTile;
  for (size_t z = 1; z < kLast; ++z) {
    found |= (a[z] << 1 | a[z] >> 1 | a[z - 1] | a[z + 1]) & b[z];
  }
  found |= (a[kLast] << 1 | a[kLast] >> 1 | a[kLast - 1]) & b[kLast];
  return found != 0;
}

// The regions of one level, as one class after the other makes them of its parts.
class LevelRegions {
 public:
  LevelRegions(uint32_t level, TileParts& tile, const PartList& shapes, PartList& common)
      : level_(level), tile_(tile), shapes_(shapes), common_(common), begin_(tile.regions.size()) {
    common_.clear();
  }

  // Gives a class's part its region: of those that other classes have made and no other part of
  // this class has taken, the one with which it shares most cells, or a new one. `alike` are the
  // classes before that have the same parts: regions of theirs hold nothing that is not the part's.
  uint32_t add(const Part& part, uint32_t class_bit, uint32_t alike) {
    const size_t best = best_region(part, class_bit);
    if (best == common_.parts.size()) {
      Part all = part;
      all.rows = static_cast<uint32_t>(common_.rows.size());
      common_.parts.push_back(all);
      const auto rows = shapes_.rows.begin() + part.rows;
      common_.rows.insert(common_.rows.end(), rows, rows + (part.end - part.begin));
      tile_.regions.push_back({level_, 0, 0});
    } else if ((tile_.regions[begin_ + best].classes & alike) == 0) {
      keep_shared(common_.parts[best], part);
    }
    tile_.regions[begin_ + best].classes |= class_bit;
    return static_cast<uint32_t>(begin_ + best);
  }

  // When all classes have been added.
  void set_keys() {
    for (size_t r = 0; r < common_.parts.size(); ++r) {
      const Part& all = common_.parts[r];
      size_t z = all.begin;
      while (common_.row(all, z) == 0) ++z;
      const auto x = static_cast<uint32_t>(std::countr_zero(common_.row(all, z)));
      tile_.regions[begin_ + r].key = static_cast<uint32_t>(z) * kTileCells + x;
    }
  }

 private:
  [[nodiscard]] size_t best_region(const Part& part, uint32_t class_bit) const {
    size_t best = common_.parts.size();
    uint32_t max_shared = 0;  // 0: not counted, as only one is there to choose
    for (size_t r = 0; r < common_.parts.size(); ++r) {
      if ((tile_.regions[begin_ + r].classes & class_bit) != 0) continue;
      if (!share_cells(common_, common_.parts[r], shapes_, part)) continue;
      if (best == common_.parts.size()) {
        best = r;
        continue;
      }
      if (max_shared == 0) max_shared = shared_cells(common_, common_.parts[best], shapes_, part);
      if (max_shared == part.cells) break;
      const uint32_t shared = shared_cells(common_, common_.parts[r], shapes_, part);
      if (shared <= max_shared) continue;
      max_shared = shared;
      best = r;
    }
    return best;
  }

  void keep_shared(Part& all, const Part& part) {
    const RowRange range(all, part);
    uint64_t* kept = &common_.rows[all.rows + range.begin - all.begin];
    const uint64_t* rows = &shapes_.rows[part.rows + range.begin - part.begin];
    for (size_t z = 0; z < range.end - range.begin; ++z) kept[z] &= rows[z];
    all.rows += static_cast<uint32_t>(range.begin - all.begin);
    all.begin = static_cast<uint16_t>(range.begin);
    all.end = static_cast<uint16_t>(range.end);
  }

  uint32_t level_;
  TileParts& tile_;
  const PartList& shapes_;
  PartList& common_;
  size_t begin_;
};

// To the link of the pair, if another class has just made it.
void add_link(std::vector<RegionLink>& links, const RegionLink& link) {
  for (size_t i = links.size(), tries = 0; i > 0 && tries < 4; --i, ++tries) {
    RegionLink& last = links[i - 1];
    if (last.a != link.a || last.b != link.b) continue;
    last.classes |= link.classes;
    return;
  }
  links.push_back(link);
}

// One side of a border: which classes may stand where, and heights along it, each read once, and
// only if it is needed.
class BorderLevels {
 public:
  BorderLevels(const world::WorldData::TileLevels& levels, const TileParts& tile, TileSide side,
               size_t classes, TileScratch::Border& kept)
      : levels_(tile.levels), classes_(classes), side_(side), kept_(kept) {
    kept.views.clear();
    for (uint32_t l = 0; l < levels_; ++l) {
      kept.views.push_back(levels.zone->view(levels.zone_first + l));
    }
    kept.known.assign(levels_, 0);
    kept.heights.resize(std::max<size_t>(kept.heights.size(), levels_));
    kept.legal.assign(tile.classes.size(), 0);
    kept.any_class.assign(levels_, 0);
    for (size_t at = 0; at < tile.classes.size(); ++at) {
      const TileParts::ClassParts of = tile.classes[at];
      for (uint32_t p = of.first; p < of.last; ++p) kept.legal[at] |= tile.parts[p].side[side];
      kept.any_class[at / classes] |= kept.legal[at];
    }
    uint64_t once = 0;
    for (const uint64_t any_class : kept.any_class) {
      crowded_ |= once & any_class;
      once |= any_class;
    }
  }

  [[nodiscard]] uint64_t any_class(uint32_t l) const { return kept_.any_class[l]; }
  // Cells over which some class may stand on several levels.
  [[nodiscard]] uint64_t crowded() const { return crowded_; }
  [[nodiscard]] uint64_t legal(uint32_t l, size_t c) const { return kept_.legal[l * classes_ + c]; }

  [[nodiscard]] int32_t height(uint32_t l, int32_t i) const {
    int32_t& height = kept_.heights[l][static_cast<size_t>(i)];
    if ((kept_.known[l] >> i & 1) == 0) {
      const bool column = side_ == kWest || side_ == kEast;
      const int32_t end = side_ == kEast || side_ == kSouth ? world::kInTile : 0;
      height = kept_.views[l].sample(column ? end : i, column ? i : end);
      kept_.known[l] |= uint64_t{1} << i;
    }
    return height;
  }

  // Does a body of class c that comes from the other side at `feet` step onto level l at cell i, as
  // step_to has it: is no level nearer, and none before it as near?
  [[nodiscard]] bool is_nearest(uint32_t l, size_t c, int32_t i, int32_t feet) const {
    const int32_t rise = std::abs(height(l, i) - feet);
    for (uint32_t other = 0; other < levels_; ++other) {
      if (other == l || (legal(other, c) >> i & 1) == 0) continue;
      const int32_t its = std::abs(height(other, i) - feet);
      if (its < rise || (its == rise && other < l)) return false;
    }
    return true;
  }

 private:
  uint32_t levels_;
  size_t classes_;
  TileSide side_;
  uint64_t crowded_ = 0;
  TileScratch::Border& kept_;
};

}  // namespace

TileRegions::TileRegions(const world::WorldData& world) : world_(world) {
  for (const AvatarClass& avatar : world.summary.classes) {
    steps_.push_back(world::step_mm(avatar));
    longest_ = std::max(longest_, steps_.back());
    shortest_ = std::min(shortest_, steps_.back());
  }
}

TileParts TileRegions::parts(int32_t tile_x, int32_t tile_z, TileScratch& scratch) const {
  TileParts tile;
  const auto levels = world_.tile_levels(tile_x, tile_z);
  tile.first_level = levels.first;
  tile.levels = levels.last - levels.first;
  tile.classes.resize(tile.levels * steps_.size());
  tile.first.reserve(tile.levels + 1);
  tile.parts.reserve(tile.classes.size());
  scratch.legal.resize(std::max(scratch.legal.size(), tile.classes.size()));
  scratch.grounds.resize(std::max(scratch.grounds.size(), tile.classes.size()));
  scratch.alike.resize(std::max(scratch.alike.size(), tile.classes.size()));
  scratch.shapes_of.resize(std::max(scratch.shapes_of.size(), tile.classes.size()));
  scratch.shapes.clear();
  tile.heights.reserve(tile.levels);
  // Nearly half the time to unpack a set was the wait for its first word: prefetch all in time.
  for (uint32_t l = 0; l < tile.levels; ++l) {
    const uint32_t zone_level = levels.zone_first + l;
    world::GroundLevel ground = world::ground_level(*levels.zone, zone_level, levels.first + l, 0);
    for (size_t c = 0; c < steps_.size(); ++c) {
      world::set_class(ground, zone_level, static_cast<int32_t>(c));
      scratch.grounds[l * steps_.size() + c] = ground;
      if (ground.legal == nullptr) continue;
      prefetch(ground.legal);
      prefetch(ground.legal + 8);
    }
  }
  for (uint32_t l = 0; l < tile.levels; ++l) {
    tile.heights.push_back(world::floor_range(levels.zone->view(levels.zone_first + l)));
    tile.first.push_back(static_cast<uint32_t>(tile.regions.size()));
    find_level(l, tile, scratch);
  }
  tile.first.push_back(static_cast<uint32_t>(tile.regions.size()));
  return tile;
}

TileParts TileRegions::linked_parts(int32_t tile_x, int32_t tile_z, TileScratch& scratch) const {
  TileParts tile = parts(tile_x, tile_z, scratch);
  if (tile.levels < 2) return tile;
  scratch.any_class.assign(tile.levels, {});
  for (size_t at = 0; at < tile.classes.size(); ++at) {
    if (tile.classes[at].first == tile.classes[at].last || scratch.alike[at] != 0) continue;
    world::CellRows& any_class = scratch.any_class[at / steps_.size()];
    for (size_t z = 0; z < kTileCells; ++z) any_class[z] |= scratch.legal[at][z];
  }
  for (uint32_t a = 0; a < tile.levels; ++a) {
    for (uint32_t b = a + 1; b < tile.levels; ++b) {
      if (!tile.heights[a].is_near(tile.heights[b], longest_)) continue;
      if (!is_beside(scratch.any_class[a], scratch.any_class[b])) continue;
      for (world::CellRows& rows : scratch.rises.known) rows.fill(0);
      for (size_t c = 0; c < steps_.size(); ++c) {
        link_seam({tile_x, tile_z, c, a, b}, tile, scratch);
      }
    }
  }
  return tile;
}

std::vector<RegionLink> TileRegions::border(int32_t tile_x, int32_t tile_z, TileSide side,
                                            const TileParts& from, const TileParts& to,
                                            TileScratch& scratch) const {
  std::vector<RegionLink> links;
  if (from.levels == 0 || to.levels == 0) return links;
  const bool east = side == kEast;
  const TileSide back = east ? kWest : kNorth;
  const size_t classes = steps_.size();
  const BorderLevels here(world_.tile_levels(tile_x, tile_z), from, side, classes, scratch.from);
  const BorderLevels there(
      world_.tile_levels(east ? tile_x + 1 : tile_x, east ? tile_z : tile_z + 1), to, back, classes,
      scratch.to);
  const uint64_t crowded = here.crowded() | there.crowded();
  for (uint32_t a = 0; a < from.levels; ++a) {
    for (uint32_t b = 0; b < to.levels; ++b) {
      if ((here.any_class(a) & there.any_class(b)) == 0) continue;
      if (!from.heights[a].is_near(to.heights[b], longest_)) continue;
      // Cells where it is known if the step is low enough for any class, if so, and if for each of
      // them, with no other level to step onto: any class that stands there crosses.
      uint64_t known = 0, low = 0, open = 0;
      const auto any = [&](uint64_t cells, size_t c) {
        for (; cells != 0; cells &= cells - 1) {
          const int32_t i = std::countr_zero(cells);
          const int32_t feet = here.height(a, i), next = there.height(b, i);
          const int32_t rise = std::abs(next - feet);
          known |= uint64_t{1} << i;
          low |= uint64_t{rise <= longest_} << i;
          open |= uint64_t{rise <= shortest_} << i & ~crowded;
          if (rise <= steps_[c] && there.is_nearest(b, c, i, feet) &&
              here.is_nearest(a, c, i, next)) {
            return true;
          }
        }
        return false;
      };
      for (size_t c = 0; c < classes; ++c) {
        if ((here.legal(a, c) & there.legal(b, c)) == 0) continue;
        const TileParts::ClassParts as = from.classes[a * classes + c],
                                    bs = to.classes[b * classes + c];
        for (uint32_t p = as.first; p < as.last; ++p) {
          if ((from.parts[p].side[side] & there.legal(b, c)) == 0) continue;
          for (uint32_t q = bs.first; q < bs.last; ++q) {
            const uint64_t both = from.parts[p].side[side] & to.parts[q].side[back];
            // One will do: first where other classes have looked.
            if ((both & open) == 0 && !any(both & low, c) && !any(both & ~known, c)) continue;
            add_link(links, {from.parts[p].region, to.parts[q].region, uint32_t{1} << c});
          }
        }
      }
    }
  }
  return links;
}

// The parts of a level for each class.
void TileRegions::find_shapes(uint32_t l, TileScratch& scratch) const {
  const size_t begin = l * steps_.size();
  PartList& shapes = scratch.shapes;
  const auto shape_count = [&] { return static_cast<uint32_t>(shapes.parts.size()); };
  scratch.together.clear();
  for (size_t at = begin; at < begin + steps_.size(); ++at) {
    const world::GroundLevel& ground = scratch.grounds[at];
    uint32_t& alike = scratch.alike[at] = 0;
    scratch.shapes_of[at] = {};
    if (ground.kind == format::CellsKind::None) continue;
    // A set that classes share is in the zone's file once.
    for (size_t other = begin; ground.step_safe && other < at; ++other) {
      const world::GroundLevel& its = scratch.grounds[other];
      const bool is_same = its.kind == ground.kind && its.legal == ground.legal && its.step_safe;
      if (is_same) alike |= uint32_t{1} << (other - begin);
    }
    if (alike != 0) {
      scratch.legal[at] = scratch.legal[begin + static_cast<size_t>(std::countr_zero(alike))];
      continue;
    }
    world::CellRows& legal = scratch.legal[at] = legal_rows(ground);
    const auto cuts = step_cuts(ground, legal, steps_[at - begin]);
    const uint32_t first = shape_count();
    if (cuts || steps_.size() == 1) {
      scratch.finder.find(legal, cuts ? &*cuts : nullptr, shapes);
    } else if (!scratch.finder.find_few(legal, shapes)) {
      scratch.together.push_back(at);
    }
    scratch.shapes_of[at] = {first, shape_count()};
  }
  if (scratch.together.size() == 1) {
    const uint32_t first = shape_count();
    scratch.finder.find(scratch.legal[scratch.together[0]], nullptr, shapes);
    scratch.shapes_of[scratch.together[0]] = {first, shape_count()};
  } else if (!scratch.together.empty()) {
    std::array<const world::CellRows*, kMaxAvatarClasses> sets{};
    std::array<uint32_t, kMaxAvatarClasses + 1> first{};
    const size_t count = scratch.together.size();
    for (size_t i = 0; i < count; ++i) sets[i] = &scratch.legal[scratch.together[i]];
    find_parts_of({sets.data(), count}, scratch.lanes, shapes, {first.data(), count + 1});
    for (size_t i = 0; i < count; ++i) {
      scratch.shapes_of[scratch.together[i]] = {first[i], first[i + 1]};
    }
  }
  for (size_t at = begin; at < begin + steps_.size(); ++at) {
    const uint32_t alike = scratch.alike[at];
    if (alike == 0) continue;
    scratch.shapes_of[at] = scratch.shapes_of[begin + static_cast<size_t>(std::countr_zero(alike))];
  }
}

void TileRegions::find_level(uint32_t l, TileParts& tile, TileScratch& scratch) const {
  find_shapes(l, scratch);
  LevelRegions regions(tile.first_level + l, tile, scratch.shapes, scratch.common);
  for (size_t c = 0; c < steps_.size(); ++c) {
    const size_t at = l * steps_.size() + c;
    const auto first = static_cast<uint32_t>(tile.parts.size());
    const TileParts::ClassParts shapes = scratch.shapes_of[at];
    for (uint32_t p = shapes.first; p < shapes.last; ++p) {
      const Part& part = scratch.shapes.parts[p];
      const uint32_t region = regions.add(part, uint32_t{1} << c, scratch.alike[at]);
      tile.parts.push_back({region, part.cells, part.side});
    }
    tile.classes[at] = {first, static_cast<uint32_t>(tile.parts.size())};
  }
  regions.set_keys();
}

// True if a class steps from cell (x, z) of the grid on level `a` to (nx, nz) on level `b`, and
// back.
bool TileRegions::steps_in_both_directions(size_t c, const world::GroundLevel& a,
                                           const world::GroundLevel& b, int32_t x, int32_t z,
                                           int32_t nx, int32_t nz) const {
  const world::WorldGround ground{world_, static_cast<int32_t>(c)};
  const auto there = world::step_to(ground, a, x, z, nx, nz, steps_[c]);
  if (!there || there->world_level != b.world_level) return false;
  const auto back = world::step_to(ground, b, nx, nz, x, z, steps_[c]);
  return back && back->world_level == a.world_level;
}

// Links a class's parts of two levels of one tile where these meet.
void TileRegions::link_seam(const Seam& seam, TileParts& tile, TileScratch& scratch) const {
  const size_t c = seam.c;
  const size_t at_a = seam.a * steps_.size() + c, at_b = seam.b * steps_.size() + c;
  const TileParts::ClassParts as = tile.classes[at_a], bs = tile.classes[at_b];
  if (as.first == as.last || bs.first == bs.last) return;
  const world::GroundLevel &level_a = scratch.grounds[at_a], &level_b = scratch.grounds[at_b];
  // A body stays on its level where that continues: it changes to the other only over cells where
  // its own has nothing, unless a step may be too high.
  const world::CellRows &all_a = scratch.legal[at_a], &all_b = scratch.legal[at_b];
  const world::CellRows* occupied_a = level_a.step_safe ? &all_a : nullptr;
  const world::CellRows* occupied_b = level_b.step_safe ? &all_b : nullptr;
  const world::CellRows from_any = occupied_b != nullptr ? without(all_a, *occupied_b) : all_a;
  const world::CellRows to_any = occupied_a != nullptr ? without(all_b, *occupied_a) : all_b;
  if (!is_beside(from_any, to_any)) return;

  const PartList& shapes = scratch.shapes;
  const Part* parts_a = &shapes.parts[scratch.shapes_of[at_a].first];
  const Part* parts_b = &shapes.parts[scratch.shapes_of[at_b].first];
  TileScratch::Rises& rises = scratch.rises;
  // `direction` 0 to 3: to greater and less x, to greater and less z.
  const auto any = [&](uint64_t cells, size_t direction, size_t z) {
    const int32_t dx = direction == 0 ? 1 : direction == 1 ? -1 : 0;
    const int32_t dz = direction == 2 ? 1 : direction == 3 ? -1 : 0;
    uint64_t &known = rises.known[direction][z], &low = rises.low[direction][z];
    for (; cells != 0; cells &= cells - 1) {
      const int32_t x = std::countr_zero(cells), row = static_cast<int32_t>(z);
      const uint64_t bit = cells & (0 - cells);
      if ((known & bit) == 0) {
        const int32_t rise = level_b.view.sample(x + dx, row + dz) - level_a.view.sample(x, row);
        known |= bit;
        low = (low & ~bit) | (std::abs(rise) <= longest_ ? bit : 0);
      }
      if ((low & bit) == 0) continue;
      const int32_t gx = world::first_cell(seam.tile_x) + x,
                    gz = world::first_cell(seam.tile_z) + row;
      if (steps_in_both_directions(c, level_a, level_b, gx, gz, gx + dx, gz + dz)) return true;
    }
    return false;
  };
  const auto touch = [&](const Part& p, const Part& q) {
    const size_t begin = std::max<size_t>(p.begin, q.begin > 0 ? q.begin - 1 : 0);
    const size_t end = std::min<size_t>(p.end, q.end + 1);
    for (size_t z = begin; z < end; ++z) {
      const uint64_t from = row_without(shapes, p, z, occupied_b);
      if (from == 0) continue;
      const uint64_t beside = row_without(shapes, q, z, occupied_a);
      if (any(from & (beside >> 1), 0, z) || any(from & (beside << 1), 1, z)) return true;
      if (z < world::kInTile && any(from & row_without(shapes, q, z + 1, occupied_a), 2, z))
        return true;
      if (z > 0 && any(from & row_without(shapes, q, z - 1, occupied_a), 3, z)) return true;
    }
    return false;
  };
  for (uint32_t p = as.first; p < as.last; ++p) {
    for (uint32_t q = bs.first; q < bs.last; ++q) {
      if (!touch(parts_a[p - as.first], parts_b[q - bs.first])) continue;
      add_link(tile.links, {tile.parts[p].region, tile.parts[q].region, uint32_t{1} << c});
    }
  }
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

}  // namespace throng::graph
