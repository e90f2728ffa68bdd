// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "paths/path_options.h"

#include <fmt/format.h>

#include "command.h"
#include "number_checks.h"
#include "paths/boxes.h"

// The options of `throng path`: their help, their ranges, and which go together.
namespace throng::app {

void add_path_options(CLI::App& command, PathOptions& options) {
  const auto add_place = [&](const char* name, std::vector<double>& at, const char* what) {
    command.add_option(name, at, what)->delimiter(',')->expected(3)->required()->type_name("X,Y,Z");
  };
  command.add_option("world", options.world, "World folder")->required()->type_name("WORLD");
  add_place("--from", options.from, "Start of the path [m]");
  add_place("--to", options.to, "Goal of the path [m]");
  command.add_option("--class", options.avatar_class, "Avatar class by name")
      ->capture_default_str();
  command
      .add_option("--tolerance", options.tolerance,
                  "How far above or below an end its place may be; for classes that climb, and "
                  "over nodes if "
                  "there is none: how far away [m]")
      ->check(at_least(0))
      ->capture_default_str();
  command
      .add_option("--spacing", options.spacing,
                  "Over nodes: largest distance between points of the path on curved ground [m]")
      ->check(at_least(0.01))
      ->capture_default_str();
  command.add_flag(
      "--fly", options.fly,
      "Path through the air, for a class that flies, as always if the world has air and no "
      "option changes the ground; an end may be on the ground");
  command.add_flag("--nodes", options.nodes,
                   "Path over the world's nodes, as always for classes that climb");
  command.add_flag("--on-foot", options.on_foot,
                   "Path over level ground, also for a class that climbs or flies");
  const auto add_list = [&](const char* name, std::vector<double>& list, const char* what,
                            char between, int count, const char* type) {
    command.add_option(name, list, what)
        ->delimiter(between)
        ->type_size(count)
        ->expected(1, 1 << 16)
        ->type_name(type);
  };
  add_blocks(&command, options.blocks);
  add_list("--off-mesh-link", options.off_mesh_links,
           "A link from one place to another and back, given by hand [m]", ',', 6, "X,Y,Z,X,Y,Z");
  add_list("--area", options.areas,
           "A box, by two opposite corners, in which the ground has an area kind [m, 1 to 63]", ',',
           7, "X,Y,Z,X,Y,Z,KIND");
  add_list("--area-cost", options.area_costs,
           "Cost of a metre on ground of a kind; inf closes it; over nodes, kinds of --area alone "
           "count",
           '=', 2, "KIND=COST");
  command
      .add_option("--slope-cost", options.slope_cost,
                  "Additional cost of a metre per metre of rise")
      ->check(between(0.0, 1000.0))
      ->capture_default_str();
  command
      .add_option("--narrow-cost", options.narrow_cost,
                  "Over nodes: additional cost of a metre where no more width is promised than the "
                  "body's radius; less where it is more")
      ->check(between(0.0, 1000.0))
      ->capture_default_str();
  command
      .add_option("--low-cost", options.low_cost,
                  "Over nodes: the same where no more height is promised than the body's")
      ->check(between(0.0, 1000.0))
      ->capture_default_str();
  add_search_memory(command, options.search_bytes);
  add_memory(command, options.memory,
             "Max memory of the command, on level ground: only what the search comes to is read "
             "[MiB]");
  add_threads(command, options.threads,
              "Threads for what is made before the search, 0 for all cores")
      ->capture_default_str();
}

namespace {

Result<void> check_options(const PathOptions& options) {
  if (options.fly + options.nodes + options.on_foot > 1) {
    return Error{
        Errc::kBadConfig,
        "--fly finds paths through the air, --nodes over all surfaces, --on-foot over level "
        "ground: give one of them"};
  }
  if (options.fly && options.changes_ground()) {
    return Error{Errc::kBadConfig,
                 "--off-mesh-link, --area, --area-cost and --slope-cost change the ground; paths "
                 "through the air (--fly) take only --block"};
  }
  if (options.memory && (options.fly || options.nodes)) {
    return Error{Errc::kBadConfig,
                 "--memory bounds paths on level ground alone; leave out --fly and --nodes, or "
                 "--memory"};
  }
  return {};
}

// Does a world have what --fly asks for?
Result<void> check_fly(const PathOptions& options, const World& world, const AvatarClass& avatar) {
  if (const auto air = air_summary(world); !air) {
    if (air.error().code != Errc::kNotFound) return air.error();
    return Error{Errc::kNotFound,
                 options.world +
                     ": --fly: the world was baked without air; bake it again with "
                     "--fly, or with --air and a class that flies"};
  }
  if (avatar.flies) return {};
  return Error{Errc::kBadConfig,
               fmt::format("{}: --fly: class {} does not fly; name one that does with --class",
                           options.world, avatar.name)};
}

}  // namespace

Result<PathSpace> space_of(const PathOptions& options, const World& world,
                           const AvatarClass& avatar) {
  const bool by_class = !options.fly && !options.nodes && !options.on_foot;
  const bool over_nodes = options.nodes || (by_class && !avatar.flies && goes_over_nodes(avatar));
  if (auto ok = check_options(options); !ok) return ok.error();
  if (!over_nodes && (options.narrow_cost > 0 || options.low_cost > 0)) {
    return Error{Errc::kBadConfig,
                 "--narrow-cost and --low-cost are what nodes promise: add --nodes"};
  }
  if (options.fly) {
    if (auto ok = check_fly(options, world, avatar); !ok) return ok.error();
    return PathSpace::kAir;
  }
  if (over_nodes) return PathSpace::kNodes;
  if (!by_class || !avatar.flies || options.changes_ground()) return PathSpace::kGround;
  const auto air = air_summary(world);
  if (!air && air.error().code != Errc::kNotFound) return air.error();
  if (air) return PathSpace::kAir;
  return goes_over_nodes(avatar) ? PathSpace::kNodes : PathSpace::kGround;
}

}  // namespace throng::app
