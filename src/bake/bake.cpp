// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/bake.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <system_error>

#include "bake/clearance.h"
#include "bake/zone_bake.h"
#include "core/file_map.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "world/zone_data.h"

namespace throng {
namespace {

namespace fs = std::filesystem;
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
  plan.grid = make_grid(bounds, config.cell, kGridPhase);
  plan.tiles_per_zone = static_cast<int32_t>(
      std::clamp(std::round(config.zone / (config.cell * kTileSide)), 1.0, 255.0));
  plan.zones_x = (plan.grid.tiles_x() + plan.tiles_per_zone - 1) / plan.tiles_per_zone;
  plan.zones_z = (plan.grid.tiles_z() + plan.tiles_per_zone - 1) / plan.tiles_per_zone;
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

// Receives each zone that has levels, in order of z, then x.
using ZoneSink =
    std::function<Result<void>(int32_t x, int32_t z, flatbuffers::DetachedBuffer bytes)>;

Result<std::shared_ptr<WorldData>> bake_zones(const Scene& scene, const BakeConfig& config,
                                              Context& context, BakeReport& report,
                                              const ZoneSink& sink) {
  const auto start = Clock::now();
  if (auto ok = check_config(config); !ok) return ok.error();
  if (auto ok = check_scene(scene); !ok) return ok.error();
  const Box3d bounds = triangle_bounds(scene);
  const SurfaceCoder coder(scene, config.classes, config.workers);
  auto planned = make_plan(scene, config, bounds, coder);
  if (!planned) return planned.error();
  const BakePlan& plan = *planned;

  const int32_t side = plan.tiles_per_zone * kTileSide;
  TriangleBins bins;
  if (plan.zones_x == 1 && plan.zones_z == 1) {
    bins.first = {0, static_cast<uint32_t>(scene.triangles.size())};
    bins.items.resize(scene.triangles.size());
    std::iota(bins.items.begin(), bins.items.end(), 0u);
  } else {
    bins = bin_boxes(
        scene.triangles.size(),
        [&](size_t i) { return scene_box(scene, static_cast<uint32_t>(i), plan.grid); }, 0, 0,
        plan.zones_x, plan.zones_z, side, plan.apron());
  }

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

  ZoneScratch scratch(worker_count(config.workers));
  std::vector<uint64_t> legal_cells(config.classes.size(), 0);
  const uint64_t total = static_cast<uint64_t>(plan.zones_x) * static_cast<uint64_t>(plan.zones_z);
  uint64_t done = 0;
  for (int32_t z = 0; z < plan.zones_z; ++z) {
    for (int32_t x = 0; x < plan.zones_x; ++x) {
      if (context.on_progress) context.on_progress({"bake", done, total});
      const size_t bin = static_cast<size_t>(z * plan.zones_x + x);
      ZoneResult zone;
      const std::span<const uint32_t> items(bins.items.data() + bins.first[bin],
                                            bins.first[bin + 1] - bins.first[bin]);
      if (!bake_zone(plan, x, z, items, scratch, context, zone) || context.cancel) {
        return Error{Errc::kCancelled, "bake: cancelled; nothing was written"};
      }
      ++done;
      report.spans += zone.spans;
      report.seconds_columns += zone.seconds_columns;
      report.seconds_levels += zone.seconds_levels;
      report.seconds_clearance += zone.seconds_clearance;
      if (zone.bytes.size() == 0) continue;
      for (size_t c = 0; c < legal_cells.size(); ++c) legal_cells[c] += zone.legal_cells[c];
      report.tiles += zone.tiles;
      report.level_tiles += zone.levels;
      report.constant_level_tiles += zone.plain_levels;
      report.bytes += zone.bytes.size();
      ++report.zones;
      auto slot = std::make_unique<WorldData::Slot>();
      slot->entry = format::ZoneEntry(x, z, zone.levels, zone.tiles, zone.bytes.size(),
                                      hash_bytes(zone.bytes.data(), zone.bytes.size()));
      slot->first_level = world->level_count;
      if (uint64_t{world->level_count} + zone.levels >= UINT32_MAX) {
        return Error{Errc::kLimit, "bake: more than 2^32 level tiles; use a larger cell"};
      }
      world->level_count += zone.levels;
      world->slot_of_zone[bin] = static_cast<int32_t>(world->slots.size());
      world->slots.push_back(std::move(slot));
      const auto write_start = Clock::now();
      if (auto ok = sink(x, z, std::move(zone.bytes)); !ok) return ok.error();
      report.seconds_write += seconds_since(write_start);
    }
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

// Removes a half-written folder unless it was renamed away.
struct Partial {
  fs::path path;
  ~Partial() {
    std::error_code ignored;
    if (!path.empty()) fs::remove_all(path, ignored);
  }
};

}  // namespace

Result<World> bake_world(const Scene& scene, const BakeConfig& config, Context& context,
                         BakeReport* report) {
  BakeReport local;
  std::vector<std::unique_ptr<Zone>> zones;
  auto world =
      bake_zones(scene, config, context, local,
                 [&](int32_t x, int32_t z, flatbuffers::DetachedBuffer bytes) -> Result<void> {
                   auto zone = Zone::from_bytes(std::move(bytes), zone_file_name(x, z));
                   if (!zone) return zone.error();
                   zones.push_back(std::move(*zone));
                   return {};
                 });
  if (!world) return world.error();
  for (size_t i = 0; i < zones.size(); ++i) (*world)->slots[i]->zone = std::move(zones[i]);
  if (report != nullptr) *report = local;
  return World(std::move(*world));
}

Result<BakeReport> bake_world_to(const std::string& path, const Scene& scene,
                                 const BakeConfig& config, Context& context) {
  const fs::path target(path);
  const fs::path manifest = "manifest.thm";
  std::error_code error;
  if (fs::exists(target, error)) {
    const bool ours = fs::is_directory(target, error) &&
                      (fs::exists(target / manifest, error) || fs::is_empty(target, error));
    if (!ours) {
      return Error{Errc::kIo, path + ": exists and is not a baked world; choose another name"};
    }
  }
  Partial part{fs::path(path + ".part")};
  fs::remove_all(part.path, error);
  if (!fs::create_directories(part.path, error)) {
    return Error{Errc::kIo, part.path.string() + ": cannot be created: " + error.message()};
  }
  BakeReport report;
  auto world = bake_zones(scene, config, context, report,
                          [&](int32_t x, int32_t z, const flatbuffers::DetachedBuffer& bytes) {
                            return write_file((part.path / zone_file_name(x, z)).string(),
                                              {bytes.data(), bytes.size()});
                          });
  if (!world) return world.error();
  if (auto ok = write_file((part.path / manifest).string(), write_manifest(**world)); !ok) {
    return ok.error();
  }
  const fs::path old(path + ".old");
  fs::remove_all(old, error);
  if (fs::exists(target, error)) fs::rename(target, old, error);
  fs::rename(part.path, target, error);
  if (error) return Error{Errc::kIo, path + ": cannot be written: " + error.message()};
  part.path.clear();
  fs::remove_all(old, error);
  return report;
}

}  // namespace throng
