// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "command.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "throng/world.h"

// throng info: prints the content of a baked world, and checks its files.
namespace throng::app {
namespace {

struct InfoOptions {
  std::string world;
  bool check = false;
};

double bytes_per_area(const WorldSummary& summary) {
  const double area = summary.walkable_area.empty() ? 0 : summary.walkable_area.front();
  return area > 0 ? static_cast<double>(summary.bytes) / area : 0;
}

Json air_json(const AirSummary& air) {
  return {{"cell", air.cell},
          {"floor", air.floor},
          {"ceiling", air.ceiling},
          {"zones", air.zones},
          {"bytes", air.bytes},
          {"nodes", air.nodes},
          {"free_cells", air.free_cells}};
}

Json info_json(const InfoOptions& options, const WorldSummary& summary,
               const std::optional<AirSummary>& air, const std::optional<uint32_t>& nodes) {
  Json classes = Json::array();
  for (size_t i = 0; i < summary.classes.size(); ++i) {
    const AvatarClass& avatar = summary.classes[i];
    classes.push_back({{"name", avatar.name},
                       {"height", avatar.height},
                       {"radius", avatar.radius},
                       {"step", avatar.step_height},
                       {"max_slope", avatar.max_slope},
                       {"speed", avatar.speed},
                       {"climb_slope", avatar.climb_slope},
                       {"max_drop", avatar.max_drop},
                       {"turning_radius", avatar.turning_radius},
                       {"flies", avatar.flies},
                       {"walkable_area", summary.walkable_area[i]}});
  }
  const Box3d& box = summary.bounds;
  Json json = {{"world", options.world},
               {"cell", summary.cell},
               {"resolution", summary.resolution},
               {"origin", {summary.origin.x, summary.origin.y, summary.origin.z}},
               {"bounds_min", {box.min.x, box.min.y, box.min.z}},
               {"bounds_max", {box.max.x, box.max.y, box.max.z}},
               {"tiles_x", summary.tiles_x},
               {"tiles_z", summary.tiles_z},
               {"zones", summary.zones},
               {"level_tiles", summary.level_tiles},
               {"bytes", summary.bytes},
               {"bytes_per_walkable_m2", bytes_per_area(summary)},
               {"source_triangles", summary.source_triangles},
               {"classes", classes}};
  if (air) json["air"] = air_json(*air);
  if (nodes) json["nodes"] = *nodes;
  if (options.check) json["intact"] = true;
  return json;
}

std::string info_of_moves(const AvatarClass& avatar) {
  std::string text;
  if (avatar.climb_slope > 0) text += fmt::format(", climbs to {:.0f} deg", avatar.climb_slope);
  if (avatar.max_drop > 0) text += fmt::format(", drops {:.2f} m", avatar.max_drop);
  if (avatar.turning_radius > 0) {
    text += fmt::format(", turns in circles of {:.2f} m", avatar.turning_radius);
  }
  if (avatar.flies) text += ", flies";
  return text;
}

std::string info_text(const InfoOptions& options, const WorldSummary& summary,
                      const std::optional<AirSummary>& air, const std::optional<uint32_t>& nodes) {
  const Vec3d size = summary.bounds.max - summary.bounds.min;
  std::string text = fmt::format(
      "{}: {:.1f} x {:.1f} m, {:.1f} m high, from {}\n"
      "from ({}) to ({})\n"
      "cells of {} m, resolution {} m; {}, {}, {} ({:.1f} bytes per walkable m2)\n",
      options.world, size.x, size.z, size.y, counted(summary.source_triangles, "triangle"),
      where(summary.bounds.min), where(summary.bounds.max), summary.cell, summary.resolution,
      counted(summary.zones, "zone"), counted(summary.level_tiles, "level tile"),
      human_bytes(summary.bytes), bytes_per_area(summary));
  for (size_t i = 0; i < summary.classes.size(); ++i) {
    const AvatarClass& avatar = summary.classes[i];
    text += fmt::format(
        "  {:<12} {:.2f} m high, radius {:.2f} m, step {:.2f} m, slope {:.1f} deg: ", avatar.name,
        avatar.height, avatar.radius, avatar.step_height, avatar.max_slope);
    text += fmt::format("{:.1f} m2 walkable{}\n", summary.walkable_area[i], info_of_moves(avatar));
  }
  if (air) {
    text += fmt::format(
        "air from {:.1f} to {:.1f} m in voxels of {} m: {} with solids, {} in an octree of {} "
        "boxes, {}\n",
        air->floor, air->ceiling, air->cell, counted(air->zones, "zone"),
        counted(air->free_cells, "free voxel"), air->nodes, human_bytes(air->bytes));
  }
  text += nodes ? counted(*nodes, "node") + " for paths over all surfaces\n"
                : std::string("no nodes: paths on level ground alone\n");
  if (options.check) text += "all zones are intact\n";
  return text;
}

int info(const Session& session, const InfoOptions& options) {
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
  if (options.check) {
    if (auto intact = world->check_all(); !intact) return fail(intact.error());
    if (auto intact = Graph::check_files(*world); !intact) return fail(intact.error());
    if (Nodes::exist(*world)) {
      const Result<Nodes> nodes = Nodes::open(*world);
      if (!nodes) return fail(nodes.error());
      if (auto intact = nodes->check_all(); !intact) return fail(intact.error());
      if (AirLinks::exist(*world)) {
        const Result<AirLinks> links = AirLinks::open(*nodes);
        if (!links) return fail(links.error());
        if (auto intact = links->check_all(); !intact) return fail(intact.error());
      }
    }
  }
  const WorldSummary summary = world->summary();
  std::optional<AirSummary> air;
  if (Result<AirSummary> found = air_summary(*world)) {
    air = *found;
  } else if (found.error().code != Errc::kNotFound) {
    return fail(found.error());
  }
  std::optional<uint32_t> count;
  if (Nodes::exist(*world)) {
    const Result<Nodes> nodes = Nodes::open(*world);
    if (nodes) count = nodes->node_count();
    if (!nodes) note(nodes.error().message);  // The ground can be used all the same.
  }
  print_result(session, info_json(options, summary, air, count),
               info_text(options, summary, air, count));
  return kDone;
}

}  // namespace

void add_info(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "info", "Show what a baked world holds",
                                  "throng bake builtin:garage -o garage.throng\n"
                                  "throng info garage.throng --check");
  const auto options = std::make_shared<InfoOptions>();
  command->add_option("world", options->world, "World folder")->required()->type_name("WORLD");
  command->add_flag("--check", options->check, "Check every zone file against its checksum");
  command->callback([&session, options] { session.exit_code = info(session, *options); });
}

}  // namespace throng::app
