// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/air_bake.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/air/air_clearance.h"
#include "bake/columns/columns.h"
#include "core/hash.h"
#include "core/math/floor_div.h"
#include "core/parallel.h"
#include "world/air_rows.h"

// Columns are filled again, as for the ground, and what of a column lies in an air cell fills it:
// an air cell is free only if no solid, over-covered as it is, touches it anywhere. A ring of tiles
// around the zone shows how wide its free cubes are.
namespace throng::bake {
namespace {

constexpr int32_t kAirBakeVersion = 1;
constexpr double kLayerPhase = kGridPhase;
constexpr int32_t kSkyLayers = 16;             // flown in over the highest solid
constexpr double kDefaultAirCell = 0.4;        // minimum for flyers by default [m]
constexpr size_t kMaxBytes = size_t{1} << 31;  // of the rows of one zone

double asked_cell(const BakeConfig& config) {
  if (config.air > 0) return config.air;
  double cell = config.cell;
  while (cell < kDefaultAirCell - 1e-9 && cell < 15.9 * config.cell) cell *= 2;
  return cell;
}

// Layers that touch [low, high], closed. [mm]
struct Layers {
  int32_t first, last;
};
Layers layers_of(const world::AirShape& shape, int64_t low, int64_t high) {
  const auto layer = [&](int64_t height) {
    return static_cast<int32_t>(floor_div(height - shape.origin_y, int64_t{shape.cell}));
  };
  return {layer(low - 1), layer(high)};
}

}  // namespace

bool wants_air(const BakeConfig& config) {
  return config.air > 0 || std::any_of(config.classes.begin(), config.classes.end(),
                                       [](const AvatarClass& avatar) { return avatar.flies; });
}

Result<void> check_air(const BakeConfig& config) {
  const auto bad = [](const std::string& what) { return Error{Errc::kBadConfig, "bake: " + what}; };
  if (!(config.air >= 0 && config.air <= 80)) return bad("the air cell must be 0 (none) to 80 m");
  if (!wants_air(config)) return {};
  const double cell = asked_cell(config), multiple = cell / config.cell;
  const std::array<int, 5> multiples{1, 2, 4, 8, 16};
  if (std::none_of(multiples.begin(), multiples.end(),
                   [&](int m) { return std::fabs(multiple - m) < 1e-6; })) {
    return bad("the air cell must be 1, 2, 4, 8 or 16 times the cell");
  }
  if (std::fabs(cell * 1000 - std::round(cell * 1000)) > 1e-6) {
    return bad("the air cell must be a whole number of millimetres; choose another cell");
  }
  for (const AvatarClass& avatar : config.classes) {
    if (avatar.flies && avatar.radius / cell > 48) {
      return bad("class " + avatar.name + " is more than 48 air cells in radius; use a larger one");
    }
  }
  return {};
}

world::AirShape air_shape(const BakePlan& plan, const Box3d& bounds) {
  world::AirShape shape;
  const double cell = asked_cell(*plan.config);
  shape.multiple = static_cast<int32_t>(std::lround(cell / plan.config->cell));
  shape.cell = static_cast<int32_t>(std::lround(cell * 1000));
  shape.origin_y = -static_cast<int32_t>(shape.cell * kLayerPhase);
  const auto mm = [](double metres) { return static_cast<int64_t>(std::floor(metres * 1000)); };
  const Layers matter = layers_of(shape, mm(bounds.min.y), mm(bounds.max.y) + 1);
  shape.floor = matter.first;
  shape.ceiling = matter.last + 1 + kSkyLayers;
  for (size_t c = 0; c < plan.config->classes.size(); ++c) {
    if (plan.config->classes[c].flies) shape.flies |= 1u << c;
  }
  return shape;
}

namespace {

std::unique_ptr<world::AirData::Slot> slot_of(int32_t x, int32_t z, std::span<const uint8_t> bytes,
                                              std::unique_ptr<world::AirZone> zone) {
  auto slot = std::make_unique<world::AirData::Slot>();
  slot->entry = format::AirEntry(x, z, bytes.size(), hash_bytes(bytes.data(), bytes.size()));
  slot->zone = std::move(zone);
  return slot;
}

}  // namespace

struct AirBaker::Worker {
  TileColumns columns;
  TileSpans spans;
  std::vector<Layers> here;  // over one air cell's square
};

// Layers with a solid over each air cell's square of a tile, merged, ascending.
struct AirBaker::TileAir {
  std::vector<uint32_t> first;
  std::vector<Layers> layers;
};

AirBaker::AirBaker(const BakePlan& plan, const world::AirShape& shape, const WorldFolder* folder,
                   int32_t workers)
    : plan_(plan), shape_(shape), folder_(folder) {
  for (int32_t i = 0; i < workers; ++i) workers_.push_back(std::make_unique<Worker>());
}

AirBaker::AirBaker(AirBaker&&) noexcept = default;
AirBaker::~AirBaker() = default;

// One tile of the zone and its ring, whose rows and columns are 0 and n + 1.
void AirBaker::rasterise(int32_t tile_x, int32_t tile_z, const TileRect& rect,
                         std::span<const uint32_t> items, Worker& worker, TileAir& tile) const {
  rasterise_tile(triangles_, items, tile_x * kTileSide, tile_z * kTileSide, rect, 0,
                 worker.columns);
  sort_spans(worker.columns, worker.spans);
  const int32_t side = kTileSide / shape_.multiple;
  tile.first.assign(1, 0);
  std::vector<Layers>& here = worker.here;
  for (int32_t square = 0; square < side * side; ++square) {
    const int32_t x0 = square % side * shape_.multiple, z0 = square / side * shape_.multiple;
    here.clear();
    for (int32_t i = 0; i < shape_.multiple * shape_.multiple; ++i) {
      const int32_t x = x0 + i % shape_.multiple, z = z0 + i / shape_.multiple;
      const auto cell = static_cast<size_t>(z * kTileSide + x);
      for (uint32_t s = worker.spans.first[cell]; s < worker.spans.first[cell + 1]; ++s) {
        here.push_back(layers_of(shape_, worker.spans.low[s], worker.spans.high[s]));
      }
    }
    std::sort(here.begin(), here.end(), [](const Layers& a, const Layers& b) {
      return a.first != b.first ? a.first < b.first : a.last < b.last;
    });
    const size_t start = tile.layers.size();
    for (const Layers& l : here) {
      if (tile.layers.size() > start && l.first <= tile.layers.back().last + 1) {
        tile.layers.back().last = std::max(tile.layers.back().last, l.last);
      } else {
        tile.layers.push_back(l);
      }
    }
    tile.first.push_back(static_cast<uint32_t>(tile.layers.size()));
  }
}

// Measures of a zone and its apron, in air cells but for the ring.
struct AirBaker::ZoneCells {
  int32_t per_tile, apron, known, side, across;
  int32_t ring;            // tiles along a side of the zone and the ring around it
  int32_t grid_x, grid_z;  // of the world
};

// The tiles of the zone and the ring of tiles around it, row by row.
std::vector<AirBaker::TileAir> AirBaker::rasterise_ring(int32_t zone_x, int32_t zone_z,
                                                        std::span<const uint32_t> triangles,
                                                        int32_t apron, const Context& context) {
  const auto workers = static_cast<int32_t>(workers_.size());
  const int32_t tiles = plan_.tiles_per_zone, ring = tiles + 2;
  const int32_t first_x = zone_x * tiles - 1, first_z = zone_z * tiles - 1;
  triangles_.resize(triangles.size());
  parallel_for(triangles.size(), workers, [&](size_t i) {
    triangles_[i] =
        to_cell_triangle(*plan_.scene, triangles[i], plan_.grid, plan_.coder->code(triangles[i]));
  });
  const TriangleBins bins =
      bin_triangles(triangles_, first_x * kTileSide, first_z * kTileSide, ring, ring, kTileSide, 0);
  std::vector<TileAir> air(static_cast<size_t>(ring) * static_cast<size_t>(ring));
  parallel_for_worker(air.size(), workers, [&](size_t i, int32_t worker) {
    const auto items = bins.square(i);
    if (items.empty() || context.cancel) return;
    const int32_t column = static_cast<int32_t>(i) % ring, row = static_cast<int32_t>(i) / ring;
    TileRect rect;  // of a ring tile only what is read
    if (column == 0) rect.x0 = kTileSide - apron * shape_.multiple;
    if (column == ring - 1) rect.x1 = apron * shape_.multiple;
    if (row == 0) rect.z0 = kTileSide - apron * shape_.multiple;
    if (row == ring - 1) rect.z1 = apron * shape_.multiple;
    rasterise(first_x + column, first_z + row, rect, items, *workers_[static_cast<size_t>(worker)],
              air[i]);
  });
  return air;
}

// Makes the air cells with solids not free, and those beside the world and where nothing is known.
void AirBaker::fill_solids(const ZoneCells& c, int32_t zone_x, int32_t zone_z, int32_t base,
                           int32_t height, const std::vector<TileAir>& air,
                           world::AirRows& rows) const {
  const auto workers = static_cast<int32_t>(workers_.size());
  parallel_for(static_cast<size_t>(c.across), workers, [&](size_t i) {
    const auto z = static_cast<int32_t>(i);
    const int32_t cell_z = zone_z * c.side + z - c.apron, first_cell = zone_x * c.side - c.apron;
    const int32_t row = (z - c.apron + c.per_tile) / c.per_tile,
                  in_row = (z - c.apron + c.per_tile) % c.per_tile;
    for (int32_t y = 0; y < height; ++y) {  // beside the world, and where nothing is known
      const bool inside = cell_z >= 0 && cell_z < c.grid_z && z >= c.apron - c.known &&
                          z < c.apron + c.side + c.known;
      rows.fill(0, inside ? std::max(-first_cell, c.apron - c.known) : c.across, y, z, false);
      rows.fill(std::min(c.grid_x - first_cell, c.apron + c.side + c.known), c.across, y, z, false);
    }
    for (int32_t x = 0; x < c.across; ++x) {
      const int32_t column = (x - c.apron + c.per_tile) / c.per_tile,
                    in_column = (x - c.apron + c.per_tile) % c.per_tile;
      const TileAir& tile = air[static_cast<size_t>(row * c.ring + column)];
      if (tile.first.empty()) continue;
      const auto square = static_cast<size_t>(in_row * c.per_tile + in_column);
      for (uint32_t s = tile.first[square]; s < tile.first[square + 1]; ++s) {
        const int32_t last = std::min(tile.layers[s].last - base, height - 1);
        for (int32_t y = std::max(tile.layers[s].first - base, 0); y <= last; ++y) {
          rows.fill(x, x + 1, y, z, false);
        }
      }
    }
  });
}

Result<std::unique_ptr<world::AirData::Slot>> AirBaker::bake(int32_t zone_x, int32_t zone_z,
                                                             std::span<const uint32_t> triangles,
                                                             uint64_t input, Context& context) {
  const auto workers = static_cast<int32_t>(workers_.size());
  if (shape_.floor <= -world::kMaxAirLayers || shape_.ceiling >= world::kMaxAirLayers) {
    return Error{Errc::kLimit,
                 "bake: the air reaches over 2 million air cells above or below height 0; use a "
                 "larger air cell"};
  }
  const int32_t tiles = plan_.tiles_per_zone, ring = tiles + 2;
  // Rows are padded by whole blocks, but what lies beyond the zone's apron is not among the
  // triangles.
  const int32_t per_tile = kTileSide / shape_.multiple, apron = std::min(per_tile, 16);
  const int32_t known = std::min(apron, plan_.apron() / shape_.multiple);
  const int32_t side = tiles * per_tile, across = side + 2 * apron;
  const int32_t grid_x = (plan_.grid.width + shape_.multiple - 1) / shape_.multiple;
  const int32_t grid_z = (plan_.grid.depth + shape_.multiple - 1) / shape_.multiple;
  // How much of what is read is the world's: a world may grow within its last tiles, and no
  // triangle of this zone show it.
  const auto own_part = [&](int32_t grid, int32_t zone) {
    return static_cast<uint64_t>(std::clamp(grid - zone * side, 0, side + known));
  };
  const uint64_t words[] = {kAirBakeVersion,
                            input,
                            static_cast<uint64_t>(shape_.multiple),
                            static_cast<uint64_t>(shape_.cell),
                            own_part(grid_x, zone_x),
                            own_part(grid_z, zone_z)};
  const uint64_t key = hash_span(std::span<const uint64_t>(words));
  if (folder_ != nullptr) {
    if (auto reused = folder_->reuse_air(zone_x, zone_z, key)) {
      ++reused_;
      return slot_of(zone_x, zone_z, reused->bytes(), nullptr);
    }
  }
  const std::vector<TileAir> air = rasterise_ring(zone_x, zone_z, triangles, apron, context);
  if (context.cancel) return Error{Errc::kCancelled, "bake: cancelled; nothing was written"};

  int32_t low = INT32_MAX, high = INT32_MIN;  // of the solids here and around
  bool own = false;
  for (int32_t i = 0; i < ring * ring; ++i) {
    const bool beside =
        i % ring == 0 || i % ring == ring - 1 || i / ring == 0 || i / ring == ring - 1;
    for (const Layers& l : air[static_cast<size_t>(i)].layers) {
      low = std::min(low, l.first);
      high = std::max(high, l.last);
      own = own || !beside;
    }
  }
  if (!own) return std::unique_ptr<world::AirData::Slot>();  // nothing but air
  // The highest layer stays free: it stands for all that is higher or lower.
  const int32_t base = low & -4, height = ((high - base + 2) + 3) & -4;
  if (static_cast<double>(height) * across * across / 8 > static_cast<double>(kMaxBytes)) {
    return Error{Errc::kLimit, "bake: the air of zone " + std::to_string(zone_x) + ", " +
                                   std::to_string(zone_z) + " takes more than 2 GiB while it is " +
                                   "baked; use a larger air cell or smaller zones"};
  }
  world::AirRows rows(across, height, across, true);
  const ZoneCells cells{.per_tile = per_tile,
                        .apron = apron,
                        .known = known,
                        .side = side,
                        .across = across,
                        .ring = ring,
                        .grid_x = grid_x,
                        .grid_z = grid_z};
  fill_solids(cells, zone_x, zone_z, base, height, air, rows);
  const world::AirTreeSource source{.rows = &rows,
                                    .x = apron,
                                    .z = apron,
                                    .side = side,
                                    .width = std::min(side, grid_x - zone_x * side),
                                    .depth = std::min(side, grid_z - zone_z * side),
                                    .base = base,
                                    .largest = world::AirTree::kMaxSide,
                                    .free_beyond = true};
  world::AirTreeData tree = world::build_air_tree(source);
  measure_clearance(source, apron, workers, tree);
  auto bytes = world::air_zone_bytes(zone_x, zone_z, key, tree);
  const std::span<const uint8_t> view(bytes.data(), bytes.size());
  if (folder_ != nullptr) {
    if (auto ok = folder_->write_file_of_zone(world::air_file_name(zone_x, zone_z), view); !ok)
      return ok.error();
    return slot_of(zone_x, zone_z, view, nullptr);
  }
  auto zone = world::AirZone::from_bytes(std::move(bytes), world::air_file_name(zone_x, zone_z));
  if (!zone) return zone.error();
  const auto reused = (*zone)->bytes();
  return slot_of(zone_x, zone_z, reused, std::move(*zone));
}

std::shared_ptr<world::AirData> gather_air(
    const world::AirShape& shape, const world::WorldData& world,
    std::vector<std::unique_ptr<world::AirData::Slot>> zones) {
  auto air = std::make_shared<world::AirData>();
  air->shape = shape;
  air->fit(world);
  for (auto& slot : zones) {
    if (slot == nullptr) continue;
    const format::AirEntry& entry = slot->entry;
    air->slot_of_zone[static_cast<size_t>(entry.z() * air->zones_x + entry.x())] =
        static_cast<int32_t>(air->slots.size());
    air->bytes += entry.bytes();
    air->slots.push_back(std::move(slot));
  }
  return air;
}

}  // namespace throng::bake
