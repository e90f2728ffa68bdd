// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "render/storey_raster.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

// Averages the floors of level tiles into one image a storey. Linear in the cells of all level
// tiles.
namespace throng::render {
namespace {

constexpr size_t kNotShown = SIZE_MAX;

// Sums over the cells of one texel.
struct Sums {
  int64_t floor = 0;  // mm
  int32_t ceiling = INT32_MIN;
  uint32_t floors = 0;
  uint32_t stands = 0;
  uint32_t clearance = 0;
};

// First cell (from the grid's own first) of a texel; the rule by which cells fall on texels.
int32_t first_cell(int32_t texel, int32_t texels, int32_t cells) {
  return static_cast<int32_t>((int64_t{texel} * cells + texels - 1) / texels);
}

int32_t texel_of(int32_t cell, int32_t texels, int32_t cells) {
  return static_cast<int32_t>(int64_t{cell} * texels / cells);
}

using CellMask = std::bitset<static_cast<size_t>(kTileCells) * kTileCells>;

// Part of a level tile in which every cell is a small step from a neighbour.
struct Piece {
  size_t level = 0;
  double mean = 0;  // mm
  CellMask cells;
  size_t count = 0;
};

void find_pieces(const LevelTileContent& tile, size_t level, std::vector<Piece>& pieces) {
  constexpr int32_t kStep = 500;  // mm
  CellMask seen;
  std::vector<size_t> open;
  for (size_t start = 0; start < tile.floor.size(); ++start) {
    if (seen[start] || tile.floor[start] == kNoFloor) continue;
    Piece piece{.level = level, .mean = 0, .cells = {}, .count = 0};
    open.assign(1, start);
    seen.set(start);
    double sum = 0;
    while (!open.empty()) {
      const size_t c = open.back();
      open.pop_back();
      piece.cells.set(c);
      sum += tile.floor[c];
      ++piece.count;
      const auto try_cell = [&](size_t n) {
        if (seen[n] || tile.floor[n] == kNoFloor) return;
        if (std::abs(tile.floor[n] - tile.floor[c]) > kStep) return;
        seen.set(n);
        open.push_back(n);
      };
      if (c % kTileCells > 0) try_cell(c - 1);
      if (c % kTileCells + 1 < kTileCells) try_cell(c + 1);
      if (c >= kTileCells) try_cell(c - kTileCells);
      if (c + kTileCells < tile.floor.size()) try_cell(c + kTileCells);
    }
    piece.mean = sum / static_cast<double>(piece.count);
    pieces.push_back(piece);
  }
}

// A level tile belongs to one storey as a whole, but near a ramp or a stair it can hold pieces of
// several. A piece far from its storey's height is assigned to a storey around at about its own
// height, larger pieces first, if its cells are free there; else it is not shown. A piece of a
// storey that is not shown joins the nearest storey, or is not shown either. In its own storey a
// piece keeps the cells that no larger one occupies: ground under the low end of a ramp has the
// ramp's storey.
std::vector<size_t> assign_pieces(std::span<Piece> pieces, std::span<const size_t> home,
                                  const LocalStoreys& local) {
  constexpr double kMaxOwnOffset = 1500, kMaxOtherOffset = 500, kMaxOffset = 2500;  // mm
  std::vector<size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return pieces[a].count > pieces[b].count; });
  std::vector<CellMask> occupied(local.storey.size());
  std::vector<size_t> storey(pieces.size(), kNotShown);
  for (const size_t p : order) {
    const size_t own = home[pieces[p].level];
    const auto distance = [&](size_t s) { return std::fabs(pieces[p].mean - local.height[s]); };
    size_t at = 0;  // Where its own storey is in `local`.
    while (at < local.storey.size() && local.storey[at] != own) ++at;
    const bool is_hidden = at == local.storey.size();
    const bool is_far = !is_hidden && distance(at) > kMaxOwnOffset;
    size_t best = is_hidden ? kNotShown : at;
    if (is_hidden || is_far) {
      double smallest = is_hidden ? kMaxOffset : kMaxOtherOffset;
      for (size_t s = 0; s < local.storey.size(); ++s) {
        if (distance(s) >= smallest) continue;
        if ((occupied[s] & pieces[p].cells).any()) {
          if (is_far && distance(at) > kMaxOffset && best == at) best = kNotShown;
          continue;
        }
        smallest = distance(s);
        best = s;
      }
    }
    if (best == kNotShown) continue;
    pieces[p].cells &= ~occupied[best];
    occupied[best] |= pieces[p].cells;
    storey[p] = local.storey[best];
  }
  return storey;
}

// Adds the floors of all level tiles of one tile to the sums of their storeys; `place` says where
// these are. Returns how many cells belong to no storey that is shown.
uint64_t add_tile(std::span<const LevelTileContent> levels, std::span<const size_t> home,
                  const LocalStoreys& local, const RasterGrid& grid, size_t avatar_class,
                  std::span<const size_t> place, std::vector<std::vector<Sums>>& sums) {
  std::vector<Piece> pieces;
  for (size_t l = 0; l < levels.size(); ++l) find_pieces(levels[l], l, pieces);
  const std::vector<size_t> storeys = assign_pieces(pieces, home, local);
  uint64_t left_out = 0;
  for (size_t p = 0; p < pieces.size(); ++p) {
    if (storeys[p] == kNotShown) {
      left_out += pieces[p].count;
      continue;
    }
    left_out += pieces[p].count - pieces[p].cells.count();
    const LevelTileContent& tile = levels[pieces[p].level];
    auto& out = sums[place[storeys[p]]];
    for (size_t i = 0; i < tile.floor.size(); ++i) {
      if (!pieces[p].cells[i]) continue;
      const int32_t x =
          tile.tile_x * kTileCells + static_cast<int32_t>(i) % kTileCells - grid.cell_x;
      const int32_t z =
          tile.tile_z * kTileCells + static_cast<int32_t>(i) / kTileCells - grid.cell_z;
      if (x < 0 || z < 0 || x >= grid.cells_x || z >= grid.cells_z) continue;
      Sums& sum = out[static_cast<size_t>(texel_of(z, grid.height, grid.cells_z)) *
                          static_cast<size_t>(grid.width) +
                      static_cast<size_t>(texel_of(x, grid.width, grid.cells_x))];
      sum.floor += tile.floor[i];
      sum.ceiling = std::max(sum.ceiling, tile.ceiling[i]);
      ++sum.floors;
      sum.stands += tile.clearance[avatar_class][i] > 0;
      sum.clearance += tile.clearance[avatar_class][i];
    }
  }
  return left_out;
}

uint8_t share(uint32_t part, uint32_t all) {
  return static_cast<uint8_t>(all > 0 ? (255 * part + all / 2) / all : 0);
}

StoreyRaster to_raster(const std::vector<Sums>& sums, const RasterGrid& grid, double origin_y) {
  StoreyRaster out;
  out.width = grid.width;
  out.height = grid.height;
  std::vector<float> heights;
  uint64_t floors = 0, stands = 0;
  for (size_t i = 0; i < sums.size(); ++i) {
    const Sums& sum = sums[i];
    const auto x = static_cast<int32_t>(i) % grid.width, z = static_cast<int32_t>(i) / grid.width;
    const auto cells = static_cast<uint32_t>(
        (first_cell(x + 1, grid.width, grid.cells_x) - first_cell(x, grid.width, grid.cells_x)) *
        (first_cell(z + 1, grid.height, grid.cells_z) - first_cell(z, grid.height, grid.cells_z)));
    const bool some = sum.floors > 0;
    const double mean = some ? static_cast<double>(sum.floor) / sum.floors : 0;
    out.floor.push_back(some ? static_cast<float>(origin_y + mean / 1000)
                             : std::numeric_limits<float>::quiet_NaN());
    out.ceiling.push_back(sum.ceiling == kOpenSky
                              ? std::numeric_limits<float>::infinity()
                              : static_cast<float>(origin_y + sum.ceiling / 1000.0));
    out.floor_share.push_back(share(std::min(sum.floors, cells), cells));
    out.stand_share.push_back(share(sum.stands, sum.floors));
    out.clearance.push_back(
        static_cast<uint8_t>(sum.stands > 0 ? 16 * sum.clearance / sum.stands : 0));
    out.kind.push_back(some ? TexelKind::kFloor : TexelKind::kOutside);
    floors += sum.floors;
    stands += sum.stands;
    if (some) heights.push_back(out.floor.back());
  }
  out.floor_area = static_cast<double>(floors) * grid.cell * grid.cell;
  out.stand_area = static_cast<double>(stands) * grid.cell * grid.cell;
  if (!heights.empty()) {
    const size_t margin = heights.size() / 100;
    const auto at = [&](size_t rank) {
      std::nth_element(heights.begin(), heights.begin() + static_cast<ptrdiff_t>(rank),
                       heights.end());
      return static_cast<double>(heights[rank]);
    };
    out.low = at(margin);
    out.high = at(heights.size() - 1 - margin);
  }
  return out;
}

// Calls visit(neighbour) for the four neighbours of texel i.
template <class Visit>
void for_each_neighbour(const StoreyRaster& raster, size_t i, Visit visit) {
  const auto width = static_cast<size_t>(raster.width);
  const size_t x = i % width;
  if (x > 0) visit(i - 1);
  if (x + 1 < width) visit(i + 1);
  if (i >= width) visit(i - width);
  if (i + width < raster.kind.size()) visit(i + width);
}

// Is texel i free from some lower storey's floor up to `height`?
bool is_open_below(const std::vector<StoreyRaster>& storeys, size_t upper, size_t i,
                   double height) {
  for (size_t s = 0; s < storeys.size(); ++s) {
    if (s == upper || storeys[s].kind[i] != TexelKind::kFloor) continue;
    if (storeys[s].floor[i] < height - 0.5 && storeys[s].ceiling[i] > height + 0.5) return true;
  }
  return false;
}

// Parts the texels without a floor: regions that touch the rim are outside, the others obstacles,
// or open where a lower storey's free space reaches up to the floors around them.
void find_enclosed(std::vector<StoreyRaster>& storeys, size_t s) {
  StoreyRaster& raster = storeys[s];
  const size_t count = raster.kind.size();
  const auto width = static_cast<size_t>(raster.width);
  std::vector<uint8_t> seen(count, 0);
  std::vector<size_t> region;
  for (size_t start = 0; start < count; ++start) {
    if (seen[start] != 0 || raster.kind[start] == TexelKind::kFloor) continue;
    region.assign(1, start);
    seen[start] = 1;
    bool at_rim = false;
    double around = 0;
    size_t floors = 0;
    for (size_t next = 0; next < region.size(); ++next) {
      const size_t i = region[next];
      at_rim =
          at_rim || i % width == 0 || i % width == width - 1 || i < width || i + width >= count;
      for_each_neighbour(raster, i, [&](size_t n) {
        if (raster.kind[n] == TexelKind::kFloor) {
          around += raster.floor[n];
          ++floors;
        } else if (seen[n] == 0) {
          seen[n] = 1;
          region.push_back(n);
        }
      });
    }
    if (at_rim || floors == 0) continue;
    const double height = around / static_cast<double>(floors);
    for (const size_t i : region) {
      raster.kind[i] =
          is_open_below(storeys, s, i, height) ? TexelKind::kOpenBelow : TexelKind::kObstacle;
    }
  }
}

}  // namespace

RasterGrid make_raster_grid(const PictureWorld& world, int32_t max_width, int32_t max_height) {
  const auto first = [&](double low, double origin) {
    return static_cast<int32_t>(std::floor((low - origin) / world.cell + 1e-6));
  };
  const auto last = [&](double high, double origin) {
    return static_cast<int32_t>(std::ceil((high - origin) / world.cell - 1e-6));
  };
  RasterGrid grid;
  grid.cell = world.cell;
  grid.cell_x =
      std::clamp(first(world.bounds.min.x, world.origin.x), 0, world.tiles_x * kTileCells - 1);
  grid.cell_z =
      std::clamp(first(world.bounds.min.z, world.origin.z), 0, world.tiles_z * kTileCells - 1);
  const int32_t end_x =
      std::min(last(world.bounds.max.x, world.origin.x), world.tiles_x * kTileCells);
  const int32_t end_z =
      std::min(last(world.bounds.max.z, world.origin.z), world.tiles_z * kTileCells);
  grid.cells_x = std::max(1, end_x - grid.cell_x);
  grid.cells_z = std::max(1, end_z - grid.cell_z);
  grid.origin_x = world.origin.x + grid.cell_x * world.cell;
  grid.origin_z = world.origin.z + grid.cell_z * world.cell;
  const double scale = std::min({1.0, static_cast<double>(max_width) / grid.cells_x,
                                 static_cast<double>(max_height) / grid.cells_z});
  grid.width = std::max(1, static_cast<int32_t>(std::floor(grid.cells_x * scale + 1e-9)));
  grid.height = std::max(1, static_cast<int32_t>(std::floor(grid.cells_z * scale + 1e-9)));
  return grid;
}

StoreyRasters rasterise_storeys(const PictureWorld& world, const StoreyIndex& index,
                                std::span<const int32_t> shown, const RasterGrid& grid) {
  std::vector<std::vector<Sums>> sums(
      shown.size(),
      std::vector<Sums>(static_cast<size_t>(grid.width) * static_cast<size_t>(grid.height)));
  std::vector<size_t> place(index.storey_count(), kNotShown);
  for (size_t s = 0; s < shown.size(); ++s) place[static_cast<size_t>(shown[s])] = s;
  uint64_t left_out = 0;
  std::vector<LevelTileContent> levels;
  std::vector<size_t> home;
  for (const auto& [tile, entries] : index.tiles()) {
    levels.clear();
    home.clear();
    for (const LevelEntry& entry : entries) {
      const auto storey = static_cast<size_t>(world.storeys[entry.level]);
      levels.push_back(world.level_tile(entry.level));
      home.push_back(place[storey] == kNotShown ? kNotShown : storey);
    }
    LocalStoreys local = index.around(tile);
    for (size_t s = local.storey.size(); s-- > 0;) {
      if (place[local.storey[s]] != kNotShown) continue;
      local.storey.erase(local.storey.begin() + static_cast<ptrdiff_t>(s));
      local.height.erase(local.height.begin() + static_cast<ptrdiff_t>(s));
    }
    left_out +=
        add_tile(levels, home, local, grid, static_cast<size_t>(world.avatar_class), place, sums);
  }
  StoreyRasters out;
  out.left_out_area = static_cast<double>(left_out) * grid.cell * grid.cell;
  std::vector<StoreyRaster>& rasters = out.storeys;
  for (size_t s = 0; s < shown.size(); ++s) {
    rasters.push_back(to_raster(sums[s], grid, world.origin.y));
    rasters.back().storey = shown[s];
    sums[s] = {};
  }
  for (size_t s = 0; s < rasters.size(); ++s) find_enclosed(rasters, s);
  return out;
}

}  // namespace throng::render
