// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <utility>

#include "import/builtin/builtin_table.h"
#include "import/builtin/patch_world.h"
#include "import/patches/patch_scene.h"
#include "import/raw/name_colour.h"
#include "throng/scene.h"

// The table of built-in worlds: checks a config, fills in defaults and calls the builder.
namespace throng {
namespace {

struct Entry {
  BuiltinWorldInfo info;
  double (*size_for)(uint64_t triangles, int32_t levels) = nullptr;  // Null: does not grow.
  void (*build)(importer::WorldBuilder&, const BuiltinWorldConfig&) = nullptr;
  PatchSet (*build_patches)(const BuiltinWorldConfig&) = nullptr;  // Instead of `build`.
  // For a world that has exactly as many triangles as are asked for: the most of a size.
  uint64_t (*max_triangles)(double size) = nullptr;
  uint64_t default_triangles = 0;
};

constexpr uint64_t kMaxTriangles = 100'000'000;  // Corners must stay below 2^32 with room.

const std::array<Entry, 10> kWorlds = {{
    {{"cube", "a hollow cube: floor, roof and four walls without thickness", 5.8, 0.5, 10000},
     nullptr,
     importer::builtin::build_cube},
    {{"stairs", "flights of all kinds up two terraces: easy, steep, too high, ramps, spirals", 44,
      44, 4000},
     nullptr,
     importer::builtin::build_stairs},
    {{"garage", "a car park: floors, ramps, pillars, cars, stairwells", 60, 45, 2000, 3, 40},
     nullptr,
     importer::builtin::build_garage},
    {{"bridge", "a road over a river and a road: arches, embankments, stairs, an underpass", 160,
      160, 4000},
     nullptr,
     importer::builtin::build_bridge},
    {{"church", "nave, arcades, galleries at two heights, spiral stairs, a tower", 42, 30, 400},
     nullptr,
     importer::builtin::build_church},
    {{"powerplant", "a dense steel frame: gratings, stairs, pipes, tanks, ladders", 36, 24, 1200,
      22, 22, kMaxTriangles},
     importer::builtin::powerplant_size,
     importer::builtin::build_powerplant},
    {{"city", "streets, kerbs, buildings with storeys inside, a canal, bridges, underpasses", 500,
      100, 12000, 0, 0, 10'000'000},
     [](uint64_t triangles, int32_t) { return importer::builtin::city_size(triangles); },
     importer::builtin::build_city},
    {{"maze", "a perfect maze of 2 m corridors on levels joined by spiral stairs", 50, 30, 1500, 2,
      40},
     nullptr,
     importer::builtin::build_maze},
    {{"landscape", "curved hills, cliffs, overhangs, sunken rocks and arches, as Bezier patches",
      320, 64, 12000},
     nullptr,
     nullptr,
     importer::builtin::build_landscape},
    {{"blocks", "closed houses in plain streets: as many triangles as you ask for", 316, 100, 4000,
      0, 0, kMaxTriangles},
     nullptr,
     importer::builtin::build_blocks,
     nullptr,
     importer::builtin::max_block_triangles,
     2368},
}};

const Entry* find_entry(const std::string& name) {
  for (const Entry& entry : kWorlds) {
    if (entry.info.name == name) return &entry;
  }
  return nullptr;
}

std::string all_names() {
  std::string names;
  for (const Entry& entry : kWorlds) {
    if (!names.empty()) names += ", ";
    names += entry.info.name;
  }
  return names;
}

}  // namespace

std::span<const BuiltinWorldInfo> builtin_worlds() {
  static const auto infos = [] {
    std::array<BuiltinWorldInfo, kWorlds.size()> list;
    for (size_t i = 0; i < list.size(); ++i) list[i] = kWorlds[i].info;
    return list;
  }();
  return infos;
}

namespace {

// An entry and what is asked of it, with its defaults.
struct Order {
  const Entry* entry = nullptr;
  BuiltinWorldConfig config;

  [[nodiscard]] Error refuse(const std::string& what) const {
    return {Errc::kBadConfig, fmt::format("world {}: {}", config.name, what)};
  }
};

Result<Order> check(const BuiltinWorldConfig& config) {
  Order order{.entry = find_entry(config.name), .config = config};
  const Entry* entry = order.entry;
  if (entry == nullptr) {
    return Error{Errc::kNotFound,
                 fmt::format("world: there is no built-in world \"{}\"; use one of {}", config.name,
                             all_names())};
  }
  const auto refuse = [&](const std::string& what) { return order.refuse(what); };
  BuiltinWorldConfig& full = order.config;
  if (config.levels != 0 && entry->info.default_levels == 0) {
    return refuse("has no levels to count; leave levels out");
  }
  if (config.levels < 0 || config.levels > entry->info.max_levels) {
    return refuse(fmt::format("levels is {}, use 1 to {}", config.levels, entry->info.max_levels));
  }
  if (config.levels == 0) full.levels = entry->info.default_levels;
  if (entry->max_triangles != nullptr) {
    if (config.triangles == 0) full.triangles = entry->default_triangles;
    if (config.size == 0) full.size = entry->info.default_size;
  } else if (config.triangles != 0) {
    if (entry->size_for == nullptr) {
      return refuse("does not grow by triangles; use size (only powerplant, city and blocks grow)");
    }
    if (config.size != 0) return refuse("takes either size or triangles; leave one out");
    if (config.triangles > entry->info.max_triangles) {
      return refuse(fmt::format("triangles is {}, at most {} fit", config.triangles,
                                entry->info.max_triangles));
    }
    full.size = entry->size_for(config.triangles, full.levels);
    if (full.size < entry->info.min_size) {
      return refuse(fmt::format("triangles is {}, too few even for its smallest size; use size {}",
                                config.triangles, entry->info.min_size));
    }
  } else if (config.size == 0) {
    full.size = entry->info.default_size;
  }
  if (!(full.size >= entry->info.min_size && full.size <= entry->info.max_size)) {
    return refuse(fmt::format("size is {} m, use {} to {}", full.size, entry->info.min_size,
                              entry->info.max_size));
  }
  if (entry->max_triangles != nullptr) {
    const uint64_t most = entry->max_triangles(full.size);
    if (full.triangles < 2 || full.triangles > most) {
      return refuse(fmt::format("triangles is {}, use 2 to {} for a size of {} m", full.triangles,
                                most, full.size));
    }
  }
  return order;
}

}  // namespace

Result<importer::builtin::PatchWorld> importer::builtin::create_patch_world(
    const BuiltinWorldConfig& config) {
  const auto order = check(config);
  if (!order) return order.error();
  PatchWorld world;
  if (order->entry->build_patches == nullptr) return world;
  world.patches = order->entry->build_patches(order->config);
  world.tolerance = landscape_tolerance(order->config.size);
  return world;
}

Result<Scene> create_builtin_world(const BuiltinWorldConfig& config) {
  const auto order = check(config);
  if (!order) return order.error();
  Scene scene;
  if (order->entry->build_patches != nullptr) {
    auto world = importer::builtin::create_patch_world(config);
    if (!world) return world.error();
    scene.patches = std::move(world->patches);
    Context context;
    SceneConfig how;
    how.curve_tolerance = world->tolerance;
    if (const auto cut = importer::cut_patches(scene, how, context); !cut) {
      return order->refuse(cut.error().message);
    }
  } else {
    importer::WorldBuilder builder;
    order->entry->build(builder, order->config);
    scene = builder.finish();
  }
  importer::add_named_materials(scene);
  return scene;
}

}  // namespace throng
