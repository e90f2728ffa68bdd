// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/world_bake.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "bake/folder/air_bake.h"
#include "bake/folder/zone_input.h"
#include "bake/layers/clearance.h"
#include "core/corner_box.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/side_by_side.h"
#include "world/world_part.h"
#include "world/zone_data.h"

// Plans a bake: checks it, lays the grid, sorts triangles into zones, hashes each zone's input, and
// puts baked zones together into a world.
namespace throng::bake {
namespace {

constexpr double kMaxCells = 1 << 20;  // along a side: positions are 1/2048 cell in 31 bits

Result<void> check_config(const BakeConfig& config) {
  const auto bad = [](const std::string& what) { return Error{Errc::kBadConfig, "bake: " + what}; };
  if (!(config.cell >= 0.02 && config.cell <= 5)) return bad("the cell must be 0.02 to 5 m");
  if (!(config.resolution >= 0.001 && config.resolution <= 1)) {
    return bad("the resolution must be 0.001 to 1 m");
  }
  if (!(config.zone > 0 && config.zone <= 10000)) {
    return bad("the zone must be above 0 m, and 10000 m at most");
  }
  if (config.workers < 0) return bad("workers must be 0 (all cores) or more");
  if (config.part && config.old_zones == OldZones::kBakeAgain) {
    return bad("a part keeps the zones beside it; bake all again, or the part without that");
  }
  if (config.part && config.nodes != nullptr) {
    return bad("nodes are made of whole worlds; bake them when all parts are there");
  }
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
  if (std::max(std::fabs(bounds.min.y), std::fabs(bounds.max.y)) > world::kMaxHeight) {
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
  for (const AvatarClass& avatar : config.classes) {
    plan.is_tall.push_back(min_free_span_of(avatar) >= BodyLimits::kHighFreeSpan);
  }
  for (size_t c = 0; c < config.classes.size(); ++c) {
    plan.bodies.push_back(
        body_window(config.classes[c], static_cast<int32_t>(c), config.cell, config.fine));
    plan.reach = std::max(plan.reach, plan.bodies.back().reach);
    plan.max_step = std::max(plan.max_step, plan.bodies.back().step);
  }
  return plan;
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
      plan.zones_x, plan.zones_z, plan.tiles_per_zone * kTileSide, plan.apron(),
      plan.config->workers);
}

// Triangles by zone, and the inputs of the zones that have any.
struct ZoneInputs {
  TriangleBins bins;
  std::vector<format::ZoneInput> inputs;  // by z, then x

  [[nodiscard]] std::span<const uint32_t> triangles(size_t place) const {
    return {bins.items.data() + bins.first[place], bins.first[place + 1] - bins.first[place]};
  }
};

// Of the zones in a rectangle. In memory no zone is ever reused, so the hashes are not needed: they
// are left 0.
ZoneInputs find_inputs(const BakePlan& plan, const world::ZoneRect& zones, bool hashed) {
  ZoneInputs found{.bins = bin_zones(plan), .inputs = {}};
  for (int32_t z = zones.z0; z < zones.z1; ++z) {
    for (int32_t x = zones.x0; x < zones.x1; ++x) {
      const auto items = found.triangles(static_cast<size_t>(z * plan.zones_x + x));
      if (items.empty()) continue;
      found.inputs.emplace_back(x, z, 0);
    }
  }
  parallel_for(hashed ? found.inputs.size() : 0, plan.config->workers, [&](size_t i) {
    format::ZoneInput& input = found.inputs[i];
    const auto items = found.triangles(static_cast<size_t>(input.z() * plan.zones_x + input.x()));
    input = {input.x(), input.z(), zone_input(plan, input.x(), input.z(), items)};
  });
  return found;
}

ZoneInputs find_inputs(const BakePlan& plan, bool hashed) {
  return find_inputs(plan, {.x0 = 0, .z0 = 0, .x1 = plan.zones_x, .z1 = plan.zones_z}, hashed);
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
std::optional<Grid> old_grid(const BakePlan& plan, const Box3d& bounds,
                             const world::WorldData* old) {
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
ZoneInputs choose_grid(BakePlan& plan, const Box3d& bounds, const world::WorldData* old,
                       bool hashed) {
  if (const auto grid = old_grid(plan, bounds, old)) {
    const Grid own = plan.grid;
    plan.put_on(*grid);
    ZoneInputs inputs = find_inputs(plan, hashed);
    if (have_a_zone_in_common(inputs.inputs, old->inputs)) return inputs;
    plan.put_on(own);
  }
  return find_inputs(plan, hashed);
}

// The zones of BakeConfig::part, or all.
Result<world::ZoneRect> part_of(const BakePlan& plan) {
  const auto& part = plan.config->part;
  if (!part) return world::ZoneRect{.x0 = 0, .z0 = 0, .x1 = plan.zones_x, .z1 = plan.zones_z};
  auto zones =
      world::zones_in(*part, {plan.grid.origin_x, 0, plan.grid.origin_z},
                      plan.grid.cell * kTileSide * plan.tiles_per_zone, plan.zones_x, plan.zones_z);
  if (!zones) return Error{zones.error().code, "bake: " + zones.error().message};
  return zones;
}

// Of the zones beside BakeConfig::part, leaves those that the old world has from the same input.
// Fails if it has another.
Result<void> keep_part(const BakePlan& plan, const world::WorldData* old, ZoneInputs& zones) {
  const auto part = part_of(plan);
  if (!part) return part.error();
  std::map<std::pair<int32_t, int32_t>, uint64_t> known;
  if (old != nullptr) {
    for (const format::ZoneInput& input : old->inputs) known[{input.x(), input.z()}] = input.hash();
  }
  std::vector<format::ZoneInput> kept;
  for (const format::ZoneInput& input : zones.inputs) {
    const auto found = known.find({input.x(), input.z()});
    const bool is_own = part->contains(input.x(), input.z());
    if (!is_own && found != known.end() && found->second != input.hash()) {
      return Error{
          Errc::kBadConfig,
          "bake: the world in the folder was baked from other input or with other settings "
          "beside the part, in zone " +
              std::to_string(input.x()) + ", " + std::to_string(input.z()) +
              "; leave the part out, or give one that holds that zone"};
    }
    if (is_own || found != known.end()) kept.push_back(input);
  }
  zones.inputs = std::move(kept);
  return {};
}

}  // namespace

struct WorldBake::Plan {
  Plan(const Scene& scene, const BakeConfig& config, const Box3d& box)
      : bounds(box), coder(scene, config.classes, config.one_sided, config.workers) {}

  Box3d bounds;
  SurfaceCoder coder;
  BakePlan plan;
  ZoneInputs zones;
  bool hashed = false;
};

WorldBake::WorldBake(std::unique_ptr<Plan> plan) : plan_(std::move(plan)) {}
WorldBake::WorldBake(WorldBake&&) noexcept = default;
WorldBake::~WorldBake() = default;

Result<WorldBake> WorldBake::begin(const Scene& scene, const BakeConfig& config,
                                   const world::WorldData* old_world, bool hashed) {
  auto plan = std::make_unique<Plan>(scene, config,
                                     corner_box(scene.positions, scene.triangles, config.workers));
  auto made = make_plan(scene, config, plan->bounds, plan->coder);
  if (!made) return made.error();
  plan->plan = *std::move(made);
  plan->zones = choose_grid(plan->plan, plan->bounds, old_world, hashed);
  if (config.part) {
    if (auto ok = keep_part(plan->plan, old_world, plan->zones); !ok) return ok.error();
    const auto& inputs = plan->zones.inputs;
    const auto part = part_of(plan->plan);
    if (std::none_of(inputs.begin(), inputs.end(), [&](const format::ZoneInput& input) {
          return part->contains(input.x(), input.z());
        })) {
      return no_triangles_in_part();
    }
  }
  plan->hashed = hashed;
  return WorldBake(std::move(plan));
}

Result<WorldBake> WorldBake::begin_block(const Scene& scene, const BakeConfig& config,
                                         const world::WorldData* old_world, const Box3d& bounds,
                                         const world::ZoneRect& zones) {
  auto plan = std::make_unique<Plan>(scene, config, bounds);
  auto made = make_plan(scene, config, bounds, plan->coder);
  if (!made) return made.error();
  plan->plan = *std::move(made);
  plan->zones = find_inputs(plan->plan, zones, true);
  if (config.part) {
    if (auto ok = keep_part(plan->plan, old_world, plan->zones); !ok) return ok.error();
  }
  plan->hashed = true;
  return WorldBake(std::move(plan));
}

Result<WorldBake> WorldBake::begin_join(const Scene& none, const BakeConfig& config,
                                        const world::WorldData& like,
                                        std::vector<format::ZoneInput> inputs) {
  auto plan = std::make_unique<Plan>(none, config, like.summary.bounds);
  auto made = make_plan(none, config, plan->bounds, plan->coder);
  if (!made) return made.error();
  plan->plan = *std::move(made);
  Grid grid = plan->plan.grid;
  grid.origin_x = like.summary.origin.x;
  grid.origin_z = like.summary.origin.z;
  grid.width = like.width;
  grid.depth = like.depth;
  plan->plan.put_on(grid);
  plan->zones = {.bins = bin_zones(plan->plan), .inputs = std::move(inputs)};
  plan->hashed = true;
  return WorldBake(std::move(plan));
}

Error WorldBake::no_triangles_in_part() {
  return {Errc::kBadConfig, "bake: the scene has no triangle in the part"};
}

world::ZoneRect WorldBake::all_zones() const {
  return {.x0 = 0, .z0 = 0, .x1 = plan_->plan.zones_x, .z1 = plan_->plan.zones_z};
}

Result<world::ZoneRect> WorldBake::part() const { return part_of(plan_->plan); }

Box3d WorldBake::box(const world::ZoneRect& zones) const {
  const Grid& grid = plan_->plan.grid;
  const double side = grid.cell * kTileSide * plan_->plan.tiles_per_zone;
  const double apron = (plan_->plan.apron() + 1) * grid.cell;
  return {.min = {grid.origin_x + zones.x0 * side - apron, plan_->bounds.min.y,
                  grid.origin_z + zones.z0 * side - apron},
          .max = {grid.origin_x + zones.x1 * side + apron, plan_->bounds.max.y,
                  grid.origin_z + zones.z1 * side + apron}};
}

std::span<const format::ZoneInput> WorldBake::zones() const { return plan_->zones.inputs; }

uint64_t WorldBake::place_count() const {
  return static_cast<uint64_t>(plan_->plan.zones_x) * static_cast<uint64_t>(plan_->plan.zones_z);
}

uint64_t WorldBake::place(size_t zone) const { return place_of(plan_->zones.inputs[zone]); }

uint64_t WorldBake::place_of(const format::ZoneInput& input) const {
  return static_cast<uint64_t>(input.z()) * static_cast<uint64_t>(plan_->plan.zones_x) +
         static_cast<uint64_t>(input.x());
}

size_t WorldBake::triangle_count(size_t zone) const {
  return plan_->zones.triangles(place(zone)).size();
}

uint64_t WorldBake::input_hash() const {
  const Grid& grid = plan_->plan.grid;
  const auto& inputs = plan_->zones.inputs;
  const uint64_t of_zones = hash_bytes(inputs.data(), inputs.size() * sizeof(inputs[0]));
  const std::array<double, 4> of_grid{grid.origin_x, grid.origin_z, grid.cell,
                                      static_cast<double>(plan_->plan.tiles_per_zone)};
  return hash_bytes(of_grid.data(), sizeof of_grid, of_zones);
}

bool WorldBake::bake(size_t zone, ZoneScratch& scratch, Context& context, ZoneFacts& facts,
                     flatbuffers::DetachedBuffer& bytes) const {
  const int32_t x = plan_->zones.inputs[zone].x(), z = plan_->zones.inputs[zone].z();
  ZoneResult result;
  if (!bake_zone(plan_->plan, x, z, plan_->zones.triangles(place(zone)), scratch, context,
                 result) ||
      context.cancel) {
    return false;
  }
  facts = {};
  const uint64_t hash =
      result.levels > 0 ? hash_bytes(result.bytes.data(), result.bytes.size()) : 0;
  facts.entry = {x, z, result.levels, result.tiles, result.bytes.size(), hash};
  facts.flat_levels = result.flat_levels;
  facts.spans = result.spans;
  std::copy(result.legal_cells.begin(), result.legal_cells.end(), facts.legal_cells.begin());
  facts.seconds_columns = result.seconds_columns;
  facts.seconds_levels = result.seconds_levels;
  facts.seconds_clearance = result.seconds_clearance;
  bytes = std::move(result.bytes);
  return true;
}

ZoneFacts WorldBake::facts_of(const WorldFolder::Reused& reused) const {
  ZoneFacts facts;
  facts.reused = true;
  facts.entry = reused.entry;
  for (uint32_t i = 0; i < reused.entry.levels(); ++i) {
    facts.flat_levels += reused.zone->level(i).floor_kind() != format::HeightKind::Blocks ? 1 : 0;
    for (size_t c = 0; c < plan_->plan.bodies.size(); ++c) {
      facts.legal_cells[c] += reused.zone->clearance(i, static_cast<uint32_t>(c)).legal_cells();
    }
  }
  return facts;
}

Result<std::shared_ptr<world::WorldData>> WorldBake::world(std::span<const ZoneFacts> facts,
                                                           BakeReport& report) const {
  return world(zones(), facts, plan_->plan.scene->triangles.size(), report);
}

Result<std::shared_ptr<world::WorldData>> WorldBake::world(
    std::span<const format::ZoneInput> inputs, std::span<const ZoneFacts> facts, uint64_t triangles,
    BakeReport& report) const {
  const BakePlan& plan = plan_->plan;
  const BakeConfig& config = *plan.config;
  auto world = std::make_shared<world::WorldData>();
  WorldSummary& summary = world->summary;
  summary.cell = config.cell;
  summary.resolution = config.resolution;
  summary.origin = {plan.grid.origin_x, 0, plan.grid.origin_z};
  summary.bounds = plan_->bounds;
  summary.tiles_x = plan.grid.tiles_x();
  summary.tiles_z = plan.grid.tiles_z();
  summary.source_triangles = triangles;
  summary.classes = config.classes;
  world->width = plan.grid.width;
  world->depth = plan.grid.depth;
  world->tiles_per_zone = static_cast<uint32_t>(plan.tiles_per_zone);
  world->zones_x = plan.zones_x;
  world->zones_z = plan.zones_z;
  world->slot_of_zone.assign(place_count(), -1);

  std::vector<uint64_t> legal_cells(config.classes.size(), 0);
  for (size_t zone = 0; zone < facts.size(); ++zone) {
    const ZoneFacts& f = facts[zone];
    report.spans += f.spans;
    report.seconds_columns += f.seconds_columns;
    report.seconds_levels += f.seconds_levels;
    report.seconds_clearance += f.seconds_clearance;
    report.seconds_write += f.seconds_write;
    const uint32_t levels = f.entry.levels();
    if (levels == 0) {
      ++report.zones_empty;
      continue;
    }
    ++(f.reused ? report.zones_reused : report.zones_baked);
    for (size_t c = 0; c < legal_cells.size(); ++c) legal_cells[c] += f.legal_cells[c];
    report.tiles += f.entry.tiles();
    report.level_tiles += levels;
    report.constant_level_tiles += f.flat_levels;
    report.bytes += f.entry.bytes();
    ++report.zones;
    auto slot = std::make_unique<world::WorldData::Slot>();
    slot->entry = f.entry;
    slot->first_level = world->level_count;
    if (uint64_t{world->level_count} + levels >= UINT32_MAX) {
      return Error{Errc::kLimit, "bake: more than 2^32 level tiles; use a larger cell"};
    }
    world->level_count += levels;
    world->slot_of_zone[place_of(inputs[zone])] = static_cast<int32_t>(world->slots.size());
    world->slots.push_back(std::move(slot));
  }
  if (plan_->hashed) world->inputs.assign(inputs.begin(), inputs.end());
  for (const uint64_t cells : legal_cells) {
    summary.walkable_area.push_back(static_cast<double>(cells) * config.cell * config.cell);
    world->class_index.push_back(std::make_unique<world::ClassIndex>());
  }
  report.walkable_area = summary.walkable_area;
  summary.zones = world->slots.size();
  summary.level_tiles = world->level_count;
  summary.bytes = report.bytes;
  return world;
}

bool WorldBake::has_air() const { return wants_air(*plan_->plan.config); }

AirBaker WorldBake::air_baker(const WorldFolder* folder, int32_t workers) const {
  return {plan_->plan, air_shape(plan_->plan, plan_->bounds), folder, workers};
}

Result<std::unique_ptr<world::AirData::Slot>> WorldBake::bake_air(size_t zone, AirBaker& baker,
                                                                  Context& context) const {
  const format::ZoneInput& input = zones()[zone];
  return baker.bake(input.x(), input.z(), plan_->zones.triangles(place(zone)), input.hash(),
                    context);
}

Result<AirSlots> WorldBake::bake_air(WorldFolder* folder, Context& context,
                                     BakeReport& report) const {
  const BakePlan& plan = plan_->plan;
  AirSlots slots;
  if (!wants_air(*plan.config)) return slots;
  const auto start = std::chrono::steady_clock::now();
  const WorkerGroups assigned = assign_workers(zones().size(), plan.config->workers);
  std::vector<AirBaker> air;
  for (int32_t group = 0; group < assigned.groups; ++group) {
    air.push_back(air_baker(folder, assigned.workers));
  }
  slots.resize(zones().size());
  const auto baked = side_by_side(
      zones().size(), assigned, context,
      [&](size_t zone) {
        if (context.on_progress) context.on_progress({"air", zone, zones().size()});
      },
      [&](size_t zone, int32_t group) -> Result<void> {
        auto made = bake_air(zone, air[static_cast<size_t>(group)], context);
        if (!made) return made.error();
        slots[zone] = *std::move(made);
        return {};
      });
  if (!baked) return baked.error();
  if (context.cancel) return Error{Errc::kCancelled, "bake: cancelled; nothing was written"};
  for (const AirBaker& baker : air) report.air_zones_reused += baker.reused();
  report.seconds_air +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return slots;
}

void WorldBake::set_air(AirSlots slots, world::WorldData& world, BakeReport& report) const {
  if (!wants_air(*plan_->plan.config)) return;
  world.air = gather_air(air_shape(plan_->plan, plan_->bounds), world, std::move(slots));
  report.air_zones = world.air->slots.size();
  report.air_bytes = world.air->bytes;
}

Result<void> WorldBake::add_air(WorldFolder* folder, world::WorldData& world, Context& context,
                                BakeReport& report) const {
  auto slots = bake_air(folder, context, report);
  if (!slots) return slots.error();
  set_air(*std::move(slots), world, report);
  return {};
}

Result<void> check_settings(const BakeConfig& config) { return check_config(config); }

Result<void> check_triangles(const Scene& scene) { return check_scene(scene); }

Result<void> check_bake(const Scene& scene, const BakeConfig& config) {
  if (auto ok = check_config(config); !ok) return ok;
  if (scene.triangles.empty()) {
    return Error{Errc::kBadInput, "bake: the scene has no triangles"};
  }
  return check_scene(scene);
}

}  // namespace throng::bake
