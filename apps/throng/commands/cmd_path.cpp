// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "in_world.h"
#include "paths/clearance_output.h"
#include "paths/path_ground.h"
#include "paths/path_options.h"
#include "paths/path_output.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "throng/world.h"

// throng path: the shortest path of an avatar class between two places, on foot, over nodes or
// through the air.
namespace throng::app {
namespace {

// What was made for a search: nothing where its data is made on demand.
void add_summary(const PathSummary& summary, PathSpace space, Json& json) {
  Json made;
  const char* name = "mesh";
  if (space == PathSpace::kAir) {
    name = "air";
    made["boxes"] = summary.boxes;
  } else if (space == PathSpace::kNodes) {
    name = "finder";
    made["blocks"] = summary.blocks;
    made["crossings"] = summary.crossings;
  } else if (summary.bytes == 0) {
    return;
  } else {
    made["rectangles"] = summary.rectangles;
    made["portals"] = summary.portals;
    made["corners"] = summary.corners;
  }
  made["bytes"] = summary.bytes;
  made["seconds"] = summary.seconds;
  json[name] = std::move(made);
}

// What is printed of a path that was found in so many seconds.
uint64_t search_bytes(const PathOptions& options) {
  return options.memory ? std::min(options.memory.search(), options.search_bytes)
                        : options.search_bytes;
}

PathRun run_of(const PathOptions& options, const Vec3d& goal, double seconds) {
  return {.world = options.world,
          .avatar_class = options.avatar_class,
          .goal = goal,
          .seconds = seconds,
          .search_bytes = search_bytes(options),
          .memory_option = options.memory ? "--memory" : "--search-memory"};
}

template <class Find>
double seconds_of(const Find& find) {
  const auto start = std::chrono::steady_clock::now();
  find();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What both ends of a path are asked for.
struct End {
  PathPoint at;
  Vec3d position;
  const char* option;
};

// The end of a path in its space. Fails with a sentence if the class cannot be there.
Result<End> end_of(const PathStage& stage, PathFinder& finder, const std::vector<double>& at,
                   const char* option) {
  const auto position = position_of(stage.world, stage.options, at, option);
  if (!position) return position.error();
  End end{.at = *position, .position = *position, .option = option};
  if (stage.space == PathSpace::kGround) {
    const auto place = place_of(stage, at, option);
    if (!place) return place.error();
    end.at = *place;
  } else if (stage.space == PathSpace::kNodes) {
    const auto place = node_place_of(stage, finder, at, option);
    if (!place) return place.error();
    end.at = *place;
  }
  return end;
}

Vec3d feet_of(const End& end) {
  if (const auto* place = std::get_if<NodePlace>(&end.at)) return place->feet;
  if (const auto* place = std::get_if<Place>(&end.at)) return place->position;
  return end.position;
}

constexpr double kMaxOffset = 0.01;  // of an end in the plane; larger ones are printed [m]

// How far ends over nodes are beside what was asked for.
void add_offset(const End& end, const char* name, Json& json, std::string& text) {
  const Vec3d feet = feet_of(end);
  const double offset = std::hypot(feet.x - end.position.x, feet.z - end.position.z);
  json["beside"][name] = offset;
  if (offset < kMaxOffset) return;
  text += fmt::format("  --{} is {:.3f} m beside, at ({})\n", name, offset, where(feet));
}

// What nodes promise all along a path.
void add_clearance(const PathStage& stage, const Nodes& nodes, const Path& found, Json& json,
                   std::string& text) {
  if (found.node_places.empty()) return;
  const std::vector<AvatarClass> classes = stage.world.summary().classes;
  const NodeClearance clearance = clearance_along(nodes, stage.avatar_class, found);
  json["clearance"] = clearance_json(clearance, classes);
  text += clearance_text(clearance, classes, "all along");
}

int find(Session& session, const PathStage& stage) {
  const World& world = stage.world;
  const PathOptions& options = stage.options;
  const PathSpace space = stage.space;
  const bool on_ground = space == PathSpace::kGround;
  if (options.memory && !on_ground) {
    return fail({Errc::kBadConfig,
                 fmt::format("--memory bounds paths on level ground alone; add --on-foot for class "
                             "{}, or leave it out",
                             options.avatar_class)});
  }
  if (on_ground) {
    // Data that is made on demand takes a damaged zone for empty: check all first. Where memory is
    // bounded, those that the search came to are known in the end.
    if (!options.memory) {
      if (auto ok = world.check_ground(); !ok) return fail(ok.error());
    }
    for (const auto& [at, option] :
         {std::pair{&options.from, "--from"}, std::pair{&options.to, "--to"}}) {
      if (auto place = place_of(stage, *at, option); !place) return fail(place.error());
    }
  }
  Nodes nodes;
  if (space == PathSpace::kNodes) {
    const Result<Nodes> opened = Nodes::open(world);
    if (!opened) return fail(opened.error());
    nodes = *opened;
  }
  Edits edits;
  const bool on_demand = on_ground && (options.is_live() || options.memory);
  auto finder =
      PathFinder::create(world,
                         {.avatar_class = stage.avatar_class,
                          .slope_cost = options.slope_cost,
                          .narrow_cost = options.narrow_cost,
                          .low_cost = options.low_cost,
                          .overlay = false,  // One query does not repay its time.
                          .workers = options.threads,
                          .speedup = on_demand ? PathSpeedup::kOnDemand : PathSpeedup::kNone,
                          .counts_ground = static_cast<bool>(options.memory),
                          .space = space,
                          .nodes = nodes,
                          .edits = edits},
                         session.context);
  if (!finder) return fail(finder.error());
  const auto from = end_of(stage, *finder, options.from, "--from");
  if (!from) return fail(from.error());
  const auto to = end_of(stage, *finder, options.to, "--to");
  if (!to) return fail(to.error());
  for (const End& end : {*from, *to}) {
    if (space != PathSpace::kAir || finder->is_free(end.at, options.tolerance)) continue;
    return fail(bad_end(options, end.position, end.option,
                        fmt::format("is neither in the air nor on the ground for class {}: its "
                                    "body would touch a solid, or it lies above or below the air",
                                    options.avatar_class)));
  }
  if (auto ok = put_up(stage, *finder, edits); !ok) return fail(ok.error());
  for (const End& end : {*from, *to}) {
    if (finder->is_free(end.at, options.tolerance)) continue;
    return fail(bad_end(options, end.position, end.option,
                        space == PathSpace::kAir
                            ? "is blocked: a --block is there"
                            : "is blocked: a --block stands there, or its ground is closed"));
  }
  Path found;
  const double seconds = seconds_of([&] {
    finder->find({.from = from->at,
                  .to = to->at,
                  .tolerance = options.tolerance,
                  .spacing = options.spacing,
                  .nearest = true,
                  .budget = {UINT64_MAX, &session.context.cancel, search_bytes(options)}},
                 found);
  });
  if (found.spent == SpentBudget::kCancelled) return fail({Errc::kCancelled, "path: interrupted"});
  if (options.memory) {
    if (auto ok = world.check_touched(); !ok) return fail(ok.error());
    if (auto ok = options.memory.check("the path was searched", "give more"); !ok) {
      return fail(ok.error());
    }
  }
  const PathRun run = run_of(options, feet_of(*to), seconds);
  Json json = path_json(run, found);
  std::string text = path_text(run, found);
  add_summary(finder->summary(), space, json);
  if (space == PathSpace::kNodes) {
    add_offset(*from, "from", json, text);
    add_offset(*to, "to", json, text);
    add_clearance(stage, nodes, found, json, text);
  }
  print_result(session, json, text);
  return found.end == PathEnd::kReached ? kDone : kAnswerIsNo;
}

int path(Session& session, const PathOptions& options) {
  const Result<World> world =
      World::open(options.world, {.resident_bytes = options.memory.zones()});
  if (!world) return fail(world.error());
  const Result<int32_t> avatar_class = class_named(*world, options.avatar_class);
  if (!avatar_class) return fail(avatar_class.error());
  const AvatarClass avatar = world->summary().classes[static_cast<size_t>(*avatar_class)];
  const auto space = space_of(options, *world, avatar);
  if (!space) return fail(space.error());
  return find(session, {*world, options, *avatar_class, *space});
}

}  // namespace

void add_path(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "path", "Find the shortest path between two places",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng path garage.throng --from 14,0,8 --to 30,8.7,30 --class adult\n"
                  "throng path garage.throng --from 14,0,8 --to 20,0,8 --block 16,0,0,17,2,9\n"
                  "throng bake builtin:bridge --fly -o bridge.throng\n"
                  "throng path bridge.throng --from 10,9,10 --to 30,9,30 --class flyer\n"
                  "throng bake builtin:landscape,size=160 -o hills.throng --cell 0.5 --nodes\n"
                  "throng path hills.throng --from 20,5,20 --to 120,5,90 --tolerance 20 --nodes");
  const auto options = std::make_shared<PathOptions>();
  add_path_options(*command, *options);
  command->callback([&session, options] { session.exit_code = path(session, *options); });
}

}  // namespace throng::app
