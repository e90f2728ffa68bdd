// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/bake.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "bake/air_bake.h"
#include "bake/clearance.h"
#include "bake/world_folder.h"
#include "bake/zone_bake.h"
#include "bake/zone_input.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "world/zone_data.h"

namespace throng {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMaxCells = 1 << 20;  // along a side: positions are 1/2048 cell in 31 bits

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Result<void> check_config(const BakeConfig& config) {
  const auto bad = [](const std::string& what) { return Error{Errc::kBadConfig, "bake: " + what}; };
  if (!(config.cell >= 0.02 && config.cell <= 5)) return bad("the cell must be 0.02 to 5 m");
  if (!(config.resolution >= 0.001 && config.resolution <= 1)) {
    return bad("the resolution must be 0.001 to 1 m");
  }
  if (!(config.zone > 0 && config.zone <= 10000)) return bad("the zone must be 0 to 10000 m");
  if (config.workers < 0) return bad("workers must be 0 (all cores) or more");
  if (auto ok = check_classes(config.classes); !ok) return ok.error();
  if (auto ok = check_air(config); !ok) return ok.error();
  for (const AvatarClass& avatar : config.classes) {
    if (avatar.radius / config.cell > 48) {
      return bad("class " + avatar.name + " is more than 48 cells in radius; use a larger cell");
    }
  }
  return {};
}

Result<void> check_scene(const Scene& scene) {
  const auto bad = [](const std::string& what) { return Error{Errc::kBadInput, "bake: " + what}; };
  if (scene.triangles.empty()) return bad("the scene has no triangles");
  if (!scene.area.empty() && scene.area.size() != scene.triangles.size()) {
    return bad("the scene has " + std::to_string(scene.triangles.size()) + " triangles but " +
               std::to_string(scene.area.size()) + " area kinds");
  }
  for (size_t i = 0; i < scene.positions.size(); ++i) {
    const Vec3d& p = scene.positions[i];
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) {
      return bad("position " + std::to_string(i) + " is not finite");
    }
  }
  const size_t count = scene.positions.size();
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    const auto& corner = scene.triangles[t];
    if (corner[0] >= count || corner[1] >= count || corner[2] >= count) {
      return bad("triangle " + std::to_string(t) + " names a position that is not there");
    }
  }
  return {};
}

Box3d triangle_bounds(const Scene& scene) {
  Box3d box;
  for (const auto& corner : scene.triangles) {
    for (const uint32_t c : corner) box.add(scene.positions[c]);
  }
  return box;
}

Result<BakePlan> make_plan(const Scene& scene, const BakeConfig& config, const Box3d& bounds,
                           const SurfaceCoder& coder) {
  const double width = (bounds.max.x - bounds.min.x) / config.cell;
  const double depth = (bounds.max.z - bounds.min.z) / config.cell;
  if (std::max(width, depth) > kMaxCells - 64) {
    return Error{Errc::kLimit,
                 "bake: the world is " +
                     std::to_string(static_cast<int64_t>(std::max(width, depth))) +
                     " cells across, at most 1048512 fit; use a larger cell or check the units"};
  }
  if (std::max(std::fabs(bounds.min.y), std::fabs(bounds.max.y)) > kMaxHeight) {
    return Error{Errc::kLimit, "bake: heights reach beyond 1000 km; check the units"};
  }
  BakePlan plan;
  plan.scene = &scene;
  plan.config = &config;
  plan.tiles_per_zone = static_cast<int32_t>(
      std::clamp(std::round(config.zone / (config.cell * kTileSide)), 1.0, 255.0));
  plan.put_on(make_grid(bounds, config.cell, kGridPhase));
  plan.coder = &coder;
  plan.codes = coder.codes();
  plan.limits = body_limits(config.classes, plan.codes, config.cell);
  for (size_t c = 0; c < config.classes.size(); ++c) {
    plan.bodies.push_back(body_window(config.classes[c], static_cast<int32_t>(c), config.cell));
    plan.reach = std::max(plan.reach, plan.bodies.back().reach);
    plan.max_step = std::max(plan.max_step, plan.bodies.back().step);
  }
  return plan;
}

// Where zones go, in order of z, then x, and where some of them come from.
struct ZoneStore {
  // Receives each baked zone; `bytes` are empty where nobody can stand.
  std::function<Result<void>(const format::ZoneEntry&, uint64_t input, flatbuffers::DetachedBuffer)>
      write;
  // A zone that need not be baked, or null: then none is kept.
  std::function<std::optional<WorldFolder::Kept>(int32_t x, int32_t z, uint64_t input)> keep;
  const WorldData* old_world = nullptr;
  WorldFolder* folder = nullptr;  // where air files go; null: they stay in memory
};

// A kept zone as if it had just been baked.
ZoneResult result_of(const WorldFolder::Kept& kept, size_t classes) {
  ZoneResult result;
  result.levels = kept.entry.levels();
  result.tiles = kept.entry.tiles();
  result.legal_cells.assign(classes, 0);
  for (uint32_t i = 0; i < result.levels; ++i) {
    result.plain_levels += kept.zone->level(i).floor_kind() != format::HeightKind::Blocks ? 1 : 0;
    for (size_t c = 0; c < classes; ++c) {
      result.legal_cells[c] += kept.zone->clearance(i, static_cast<uint32_t>(c)).legal_cells();
    }
  }
  return result;
}

TriangleBins bin_zones(const BakePlan& plan) {
  const Scene& scene = *plan.scene;
  TriangleBins bins;
  if (plan.zones_x == 1 && plan.zones_z == 1) {
    bins.first = {0, static_cast<uint32_t>(scene.triangles.size())};
    bins.items.resize(scene.triangles.size());
    std::iota(bins.items.begin(), bins.items.end(), 0u);
    return bins;
  }
  return bin_boxes(
      scene.triangles.size(),
      [&](size_t i) { return scene_box(scene, static_cast<uint32_t>(i), plan.grid); }, 0, 0,
      plan.zones_x, plan.zones_z, plan.tiles_per_zone * kTileSide, plan.apron());
}

// Triangles by zone, and the inputs of the zones that have any.
struct ZoneInputs {
  TriangleBins bins;
  std::vector<format::ZoneInput> inputs;  // by z, then x

  [[nodiscard]] std::span<const uint32_t> triangles(size_t zone) const {
    return {bins.items.data() + bins.first[zone], bins.first[zone + 1] - bins.first[zone]};
  }
};

// In memory, where no zone is ever kept, nobody asks for the hashes: they are left 0.
ZoneInputs find_inputs(const BakePlan& plan, bool hashed) {
  ZoneInputs found{.bins = bin_zones(plan), .inputs = {}};
  for (int32_t z = 0; z < plan.zones_z; ++z) {
    for (int32_t x = 0; x < plan.zones_x; ++x) {
      const auto items = found.triangles(static_cast<size_t>(z * plan.zones_x + x));
      if (items.empty()) continue;
      found.inputs.emplace_back(x, z, hashed ? zone_input(plan, x, z, items) : 0);
    }
  }
  return found;
}

bool have_a_zone_in_common(std::span<const format::ZoneInput> a,
                           std::span<const format::ZoneInput> b) {
  std::set<std::tuple<int32_t, int32_t, uint64_t>> known;
  for (const format::ZoneInput& i : a) known.emplace(i.x(), i.z(), i.hash());
  return std::any_of(b.begin(), b.end(), [&](const format::ZoneInput& i) {
    return known.contains({i.x(), i.z(), i.hash()});
  });
}

// The grid of the world that is there, if the scene begins on it: else every zone would be another
// once a triangle at the rim moves.
std::optional<Grid> old_grid(const BakePlan& plan, const Box3d& bounds, const WorldData* old) {
  if (old == nullptr || old->summary.cell != plan.config->cell) return std::nullopt;
  Grid grid = plan.grid;
  grid.origin_x = old->summary.origin.x;
  grid.origin_z = old->summary.origin.z;
  const auto in_phase = [&](double origin) {
    const double cells = origin / grid.cell - kGridPhase;
    return std::fabs(cells - std::round(cells)) < 1e-3;
  };
  const double first_x = grid.to_cell_x(bounds.min.x), first_z = grid.to_cell_z(bounds.min.z);
  if (!in_phase(grid.origin_x) || !in_phase(grid.origin_z) || first_x < -1e-6 || first_z < -1e-6 ||
      first_x >= old->width || first_z >= old->depth) {
    return std::nullopt;
  }
  if (grid.origin_x == plan.grid.origin_x && grid.origin_z == plan.grid.origin_z) {
    return std::nullopt;
  }
  fit_grid(grid, bounds);
  if (std::max(grid.width, grid.depth) > static_cast<int32_t>(kMaxCells) - 64) return std::nullopt;
  return grid;
}

// Puts the plan on the old world's grid if that spares a zone.
ZoneInputs choose_grid(BakePlan& plan, const Box3d& bounds, const ZoneStore& store) {
  const WorldData* old = store.old_world;
  const bool hashed = static_cast<bool>(store.keep);
  if (const auto grid = old_grid(plan, bounds, old)) {
    const Grid own = plan.grid;
    plan.put_on(*grid);
    ZoneInputs inputs = find_inputs(plan, hashed);
    if (have_a_zone_in_common(inputs.inputs, old->inputs)) return inputs;
    plan.put_on(own);
  }
  return find_inputs(plan, hashed);
}

Result<std::shared_ptr<WorldData>> bake_zones(const Scene& scene, const BakeConfig& config,
                                              Context& context, BakeReport& report,
                                              const ZoneStore& store) {
  const auto start = Clock::now();
  const Box3d bounds = triangle_bounds(scene);
  const SurfaceCoder coder(scene, config.classes, config.workers);
  auto planned = make_plan(scene, config, bounds, coder);
  if (!planned) return planned.error();
  const ZoneInputs inputs = choose_grid(*planned, bounds, store);
  const BakePlan& plan = *planned;

  auto world = std::make_shared<WorldData>();
  WorldSummary& summary = world->summary;
  summary.cell = config.cell;
  summary.resolution = config.resolution;
  summary.origin = {plan.grid.origin_x, 0, plan.grid.origin_z};
  summary.bounds = bounds;
  summary.tiles_x = plan.grid.tiles_x();
  summary.tiles_z = plan.grid.tiles_z();
  summary.source_triangles = scene.triangles.size();
  summary.classes = config.classes;
  world->width = plan.grid.width;
  world->depth = plan.grid.depth;
  world->tiles_per_zone = static_cast<uint32_t>(plan.tiles_per_zone);
  world->zones_x = plan.zones_x;
  world->zones_z = plan.zones_z;
  world->slot_of_zone.assign(static_cast<size_t>(plan.zones_x) * static_cast<size_t>(plan.zones_z),
                             -1);

  std::optional<AirBaker> air;
  if (wants_air(config)) air.emplace(plan, air_shape(plan, bounds), store.folder);
  ZoneScratch scratch(worker_count(config.workers));
  std::vector<uint64_t> legal_cells(config.classes.size(), 0);
  const uint64_t total = static_cast<uint64_t>(plan.zones_x) * static_cast<uint64_t>(plan.zones_z);
  const Error cancelled{Errc::kCancelled, "bake: cancelled; nothing was written"};
  for (const format::ZoneInput& input : inputs.inputs) {
    const int32_t x = input.x(), z = input.z();
    const auto place = static_cast<size_t>(z * plan.zones_x + x);
    if (context.on_progress) context.on_progress({"bake", place, total});
    if (context.cancel) return cancelled;
    if (air) {
      const auto air_start = Clock::now();
      if (auto ok = air->bake(x, z, inputs.triangles(place), input.hash(), context); !ok) {
        return ok.error();
      }
      report.seconds_air += seconds_since(air_start);
    }
    ZoneResult zone;
    format::ZoneEntry entry;
    auto kept = store.keep ? store.keep(x, z, input.hash()) : std::nullopt;
    if (kept) {
      zone = result_of(*kept, legal_cells.size());
      entry = kept->entry;
      ++report.zones_kept;
    } else {
      if (!bake_zone(plan, x, z, inputs.triangles(place), scratch, context, zone) ||
          context.cancel) {
        return cancelled;
      }
      entry =
          format::ZoneEntry(x, z, zone.levels, zone.tiles, zone.bytes.size(),
                            zone.levels > 0 ? hash_bytes(zone.bytes.data(), zone.bytes.size()) : 0);
      const auto write_start = Clock::now();
      if (auto ok = store.write(entry, input.hash(), std::move(zone.bytes)); !ok) return ok.error();
      report.seconds_write += seconds_since(write_start);
      ++report.zones_baked;
    }
    report.spans += zone.spans;
    report.seconds_columns += zone.seconds_columns;
    report.seconds_levels += zone.seconds_levels;
    report.seconds_clearance += zone.seconds_clearance;
    if (zone.levels == 0) continue;
    for (size_t c = 0; c < legal_cells.size(); ++c) legal_cells[c] += zone.legal_cells[c];
    report.tiles += zone.tiles;
    report.level_tiles += zone.levels;
    report.constant_level_tiles += zone.plain_levels;
    report.bytes += entry.bytes();
    ++report.zones;
    auto slot = std::make_unique<WorldData::Slot>();
    slot->entry = entry;
    slot->first_level = world->level_count;
    if (uint64_t{world->level_count} + zone.levels >= UINT32_MAX) {
      return Error{Errc::kLimit, "bake: more than 2^32 level tiles; use a larger cell"};
    }
    world->level_count += zone.levels;
    world->slot_of_zone[place] = static_cast<int32_t>(world->slots.size());
    world->slots.push_back(std::move(slot));
  }
  if (store.keep) world->inputs = inputs.inputs;
  if (air) {
    world->air = air->finish(*world);
    report.air_zones = world->air->slots.size();
    report.air_bytes = world->air->bytes;
  }
  for (const uint64_t cells : legal_cells) {
    summary.walkable_area.push_back(static_cast<double>(cells) * config.cell * config.cell);
    world->class_index.push_back(std::make_unique<ClassIndex>());
  }
  report.walkable_area = summary.walkable_area;
  summary.zones = world->slots.size();
  summary.level_tiles = world->level_count;
  summary.bytes = report.bytes;
  report.seconds_total = seconds_since(start);
  if (context.on_progress) context.on_progress({"bake", total, total});
  return world;
}

Result<void> check(const Scene& scene, const BakeConfig& config) {
  if (auto ok = check_config(config); !ok) return ok.error();
  return check_scene(scene);
}

}  // namespace

Result<World> bake_world(const Scene& scene, const BakeConfig& config, Context& context,
                         BakeReport* report) {
  if (auto ok = check(scene, config); !ok) return ok.error();
  BakeReport local;
  std::vector<std::unique_ptr<Zone>> zones;
  ZoneStore store;
  store.write = [&](const format::ZoneEntry& entry, uint64_t /*input*/,
                    flatbuffers::DetachedBuffer bytes) -> Result<void> {
    if (entry.levels() == 0) return {};
    auto zone = Zone::from_bytes(std::move(bytes), zone_file_name(entry.x(), entry.z()));
    if (!zone) return zone.error();
    zones.push_back(std::move(*zone));
    return {};
  };
  auto world = bake_zones(scene, config, context, local, store);
  if (!world) return world.error();
  for (size_t i = 0; i < zones.size(); ++i) (*world)->slots[i]->zone = std::move(zones[i]);
  if (report != nullptr) *report = local;
  return World(std::move(*world));
}

Result<BakeReport> bake_world_to(const std::string& path, const Scene& scene,
                                 const BakeConfig& config, Context& context) {
  if (auto ok = check(scene, config); !ok) return ok.error();
  auto folder = WorldFolder::begin(path, config.old_zones);
  if (!folder) return folder.error();
  ZoneStore store;
  store.old_world = folder->old_world();
  store.folder = &*folder;
  store.keep = [&](int32_t x, int32_t z, uint64_t input) { return folder->keep(x, z, input); };
  store.write = [&](const format::ZoneEntry& entry, uint64_t input,
                    const flatbuffers::DetachedBuffer& bytes) {
    return folder->write(entry, input, {bytes.data(), bytes.size()});
  };
  BakeReport report;
  auto world = bake_zones(scene, config, context, report, store);
  if (!world) return world.error();
  if (auto ok = folder->finish(**world); !ok) return ok.error();
  return report;
}

}  // namespace throng
