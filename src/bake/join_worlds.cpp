// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bake/folder/finish_bake.h"
#include "bake/folder/graph_bake.h"
#include "bake/folder/world_bake.h"
#include "bake/folder/world_folder.h"
#include "bake/folder/zone_baker.h"
#include "core/access.h"
#include "core/files/file_map.h"
#include "core/hash.h"
#include "core/stopwatch.h"
#include "throng/bake.h"
#include "world/air_data.h"
#include "world/zone_data.h"

// Joins worlds of parts of one scene: a bake that finds all its zones in their folders, and so has
// only the graph over their borders to make.
namespace throng {
namespace {

bool is_same(const AvatarClass& a, const AvatarClass& b) {
  const auto numbers = [](const AvatarClass& c) {
    return std::array<double, 9>{c.turning_radius, c.height,    c.radius,
                                 c.step_height,    c.max_slope, c.max_drop,
                                 c.climb_slope,    c.speed,     c.flies ? 1.0 : 0.0};
  };
  return a.name == b.name && numbers(a) == numbers(b);
}

// What two parts of one scene cannot differ in, or nothing.
std::string difference(const world::WorldData& a, const world::WorldData& b) {
  const int32_t air = a.air ? a.air->shape.multiple : 0, others = b.air ? b.air->shape.multiple : 0;
  if (air != others) return "have other air, or one of them has none";
  const WorldSummary &one = a.summary, &other = b.summary;
  if (one.cell != other.cell || one.resolution != other.resolution) {
    return "have other cells or another resolution";
  }
  if (!(one.origin == other.origin) || a.width != b.width || a.depth != b.depth ||
      a.tiles_per_zone != b.tiles_per_zone || !(one.bounds.min == other.bounds.min) ||
      !(one.bounds.max == other.bounds.max)) {
    return "lie on other grids or have other bounds";
  }
  if (one.source_triangles != other.source_triangles) return "were baked of other scenes";
  if (!std::equal(one.classes.begin(), one.classes.end(), other.classes.begin(),
                  other.classes.end(), is_same)) {
    return "have other classes";
  }
  return "";
}

struct Part {
  std::string path;
  World world;
};

Result<std::vector<Part>> open_parts(const std::vector<std::string>& paths) {
  if (paths.empty()) return Error{Errc::kBadConfig, "join: no world given"};
  std::vector<Part> parts;
  for (const std::string& path : paths) {
    auto world = World::open(path);
    if (!world) return world.error();
    if (data_of(*world)->inputs.empty()) {
      return Error{Errc::kBadInput, path + ": does not say what it was baked from; bake it again"};
    }
    parts.push_back({path, *std::move(world)});
    const std::string differs = difference(*data_of(parts[0].world), *data_of(parts.back().world));
    if (differs.empty()) continue;
    return Error{Errc::kBadInput, "join: " + parts[0].path + " and " + path + " " + differs +
                                      "; join parts of one scene that were baked alike"};
  }
  return parts;
}

// A zone, and where its files are.
struct Joined {
  format::ZoneEntry entry;
  uint64_t input = 0;
  size_t part = 0;
};
using JoinedZones = std::map<std::pair<int32_t, int32_t>, Joined>;  // by z, then x

Result<JoinedZones> list_zones(const std::vector<Part>& parts) {
  JoinedZones zones;
  for (size_t p = 0; p < parts.size(); ++p) {
    const world::WorldData& data = *data_of(parts[p].world);
    for (const format::ZoneInput& input : data.inputs) {
      const size_t place = static_cast<size_t>(input.z()) * static_cast<size_t>(data.zones_x) +
                           static_cast<size_t>(input.x());
      const int32_t slot = data.slot_of_zone[place];
      Joined zone{.entry = {input.x(), input.z(), 0, 0, 0, 0}, .input = input.hash(), .part = p};
      if (slot >= 0) zone.entry = data.slots[static_cast<size_t>(slot)]->entry;
      const auto [at, is_new] = zones.try_emplace({input.z(), input.x()}, zone);
      if (is_new || at->second.input == zone.input) continue;
      return Error{Errc::kBadInput,
                   "join: zone " + std::to_string(input.x()) + ", " + std::to_string(input.z()) +
                       " of " + parts[at->second.part].path + " and of " + parts[p].path +
                       " were baked of other triangles or with other settings; bake one again"};
    }
  }
  return zones;
}

// Without its air file a zone would be free air. Others are made again if they are damaged.
Result<void> check_air(const Part& part, const Joined& zone) {
  const world::WorldData& data = *data_of(part.world);
  if (data.air == nullptr) return {};
  const int32_t x = zone.entry.x(), z = zone.entry.z();
  const int32_t slot = data.air->slot_of_zone[static_cast<size_t>(z * data.zones_x + x)];
  if (slot < 0) return {};
  const format::AirEntry& entry = data.air->slots[static_cast<size_t>(slot)]->entry;
  const std::string name = part.path + "/" + world::air_file_name(x, z);
  const auto map = FileMap::open(name);
  if (map && map->bytes().size() == entry.bytes() &&
      hash_bytes(map->bytes().data(), map->bytes().size()) == entry.hash()) {
    return {};
  }
  return Error{Errc::kBadFile, name + ": is missing or damaged; bake that world again"};
}

BakeConfig config_of(const world::WorldData& world, int32_t workers) {
  BakeConfig config;
  config.cell = world.summary.cell;
  config.resolution = world.summary.resolution;
  config.zone = world.tiles_per_zone * 64 * world.summary.cell;
  config.classes = world.summary.classes;
  config.workers = workers;
  if (world.air != nullptr) config.air = world.air->shape.multiple * world.summary.cell;
  return config;
}

}  // namespace

Result<BakeReport> join_worlds(const std::vector<std::string>& worlds, const std::string& path,
                               int32_t workers, Context& context) {
  if (workers < 0) return Error{Errc::kBadConfig, "join: workers must be 0 (all cores) or more"};
  const auto start = Clock::now();
  const auto parts = open_parts(worlds);
  if (!parts) return parts.error();
  const auto zones = list_zones(*parts);
  if (!zones) return zones.error();
  const world::WorldData& like = *data_of((*parts)[0].world);
  const BakeConfig config = config_of(like, workers);
  auto folder = bake::WorldFolder::begin(path, OldZones::kKeep);
  if (!folder) return folder.error();
  std::vector<format::ZoneInput> inputs;
  for (const auto& [place, zone] : *zones) {
    if (context.cancel) return Error{Errc::kCancelled, "join: cancelled; nothing was written"};
    if (context.on_progress) context.on_progress({"join", inputs.size(), zones->size()});
    inputs.emplace_back(place.second, place.first, zone.input);
    if (auto ok = check_air((*parts)[zone.part], zone); !ok) return ok.error();
    if (auto ok = folder->take_over((*parts)[zone.part].path, zone.entry, zone.input); !ok) {
      return ok.error();
    }
  }
  const Scene none;
  const auto bake = bake::WorldBake::begin_join(none, config, like, std::move(inputs));
  if (!bake) return bake.error();
  BakeReport report;
  bake::ZoneBaker baker(*bake, config, context, &*folder);
  if (auto ok = baker.run(); !ok) return ok.error();
  for (const bake::ZoneFacts& facts : baker.facts()) {
    if (facts.reused) continue;
    const Joined& zone = zones->at({facts.entry.z(), facts.entry.x()});
    return Error{Errc::kBadFile, (*parts)[zone.part].path + "/" +
                                     world::zone_file_name(facts.entry.x(), facts.entry.z()) +
                                     ": is damaged; bake that world again"};
  }
  auto world = bake->world(bake->zones(), baker.facts(), like.summary.source_triangles, report);
  if (!world) return world.error();
  if (auto ok = bake->add_air(&*folder, **world, context, report); !ok) return ok.error();
  const auto graph = bake::bake_graph(*folder, **world, workers, context, report);
  if (!graph) return graph.error();
  if (auto ok = bake::finish_bake(*folder, **world, **graph, none, config, context, report); !ok) {
    return ok.error();
  }
  report.seconds_total = seconds_since(start);
  return report;
}

}  // namespace throng
