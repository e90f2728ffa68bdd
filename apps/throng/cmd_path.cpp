// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "boxes.h"
#include "command.h"
#include "in_world.h"
#include "path_ground.h"
#include "path_options.h"
#include "path_output.h"
#include "throng/path.h"
#include "throng/world.h"

// throng path: the shortest path of an avatar class between two places, on foot, over nodes or
// through the air.
namespace throng::app {
namespace {

Json mesh_json(const PathSummary& summary) {
  return {{"rectangles", summary.rectangles},
          {"portals", summary.portals},
          {"corners", summary.corners},
          {"bytes", summary.bytes},
          {"seconds", summary.seconds}};
}

// What is printed of a path that was found in so many seconds.
PathRun run_of(const PathOptions& options, const Vec3d& goal, double seconds) {
  return {.world = options.world,
          .avatar_class = options.avatar_class,
          .goal = goal,
          .seconds = seconds,
          .search_bytes = options.search_bytes};
}

template <class Find>
double seconds_of(const Find& find) {
  const auto start = std::chrono::steady_clock::now();
  find();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

int fly(Session& session, const PathOptions& options, const World& world, int32_t avatar_class) {
  const auto from = position_of(world, options, options.from, "--from");
  if (!from) return fail(from.error());
  const auto to = position_of(world, options, options.to, "--to");
  if (!to) return fail(to.error());
  Result<FlightFinder> finder = FlightFinder::create(
      world, {.avatar_class = avatar_class, .workers = options.threads}, session.context);
  if (!finder) return fail(finder.error());
  for (const auto& [position, option] : {std::pair{*from, "--from"}, std::pair{*to, "--to"}}) {
    if (finder->is_legal(position) || world.find_place(avatar_class, position, options.tolerance)) {
      continue;
    }
    return fail(bad_end(options, position, option,
                        fmt::format("is neither in the air nor on the ground for class {}: its "
                                    "body would touch a solid, or it lies above or below the air",
                                    options.avatar_class)));
  }
  if (auto ok = add_boxes(options.blocks, *finder); !ok) return fail(ok.error());
  Path found;
  const double seconds = seconds_of([&] {
    finder->find({.from = *from,
                  .to = *to,
                  .vertical_tolerance = options.tolerance,
                  .budget = {UINT64_MAX, &session.context.cancel, options.search_bytes}},
                 found);
  });
  if (found.end == PathEnd::kNoPlace) {
    // Find out which end is blocked: a path from an end to itself.
    for (const auto& [position, option] : {std::pair{*from, "--from"}, std::pair{*to, "--to"}}) {
      finder->find({.from = position, .to = position, .vertical_tolerance = options.tolerance},
                   found);
      if (found.end != PathEnd::kNoPlace) continue;
      return fail(bad_end(options, position, option, "is blocked: a --block is there"));
    }
  }
  const PathRun run = run_of(options, *to, seconds);
  const FlightSummary summary = finder->summary();
  Json json = path_json(run, found);
  json["air"] = {{"boxes", summary.boxes}, {"bytes", summary.bytes}, {"seconds", summary.seconds}};
  print_result(session, json, path_text(run, found));
  return found.end == PathEnd::kReached ? kDone : kAnswerIsNo;
}

constexpr double kMaxOffset = 0.01;  // of an end in the plane; larger ones are printed [m]

int find_over_nodes(Session& session, const PathOptions& options, const World& world,
                    int32_t avatar_class) {
  const auto from_position = position_of(world, options, options.from, "--from");
  if (!from_position) return fail(from_position.error());
  const auto to_position = position_of(world, options, options.to, "--to");
  if (!to_position) return fail(to_position.error());
  const Result<Nodes> nodes = Nodes::open(options.world);
  if (!nodes) return fail(nodes.error());
  auto finder = NodePathFinder::create(*nodes,
                                       {.avatar_class = avatar_class,
                                        .slope_cost = options.slope_cost,
                                        .overlay = false,  // One query does not repay its time.
                                        .workers = options.threads},
                                       session.context);
  if (!finder) return fail(finder.error());
  if (auto ok = add_boxes(options.blocks, *finder); !ok) return fail(ok.error());
  // A class that only walks: the ground above or below; if there is none, the nearest place.
  const bool climbs = goes_over_nodes(world.summary().classes[static_cast<size_t>(avatar_class)]);
  const auto find_place = [&](const Vec3d& position) {
    const Place ground =
        climbs ? Place{} : world.find_place(avatar_class, position, options.tolerance);
    return finder->find_place(ground ? ground.position : position, options.tolerance);
  };
  const NodePlace from = find_place(*from_position);
  const NodePlace to = find_place(*to_position);
  for (const auto& [place, position, option] :
       {std::tuple{from, *from_position, "--from"}, std::tuple{to, *to_position, "--to"}}) {
    if (place) continue;
    return fail(bad_end(options, position, option,
                        fmt::format("is no place on nodes where class {} can be, within {} m; see "
                                    "`throng picture --nodes`, or give a larger --tolerance",
                                    options.avatar_class, options.tolerance)));
  }
  Path found;
  const double seconds = seconds_of([&] {
    finder->find(from, to, found, 0.25,
                 {UINT64_MAX, &session.context.cancel, options.search_bytes});
  });
  if (found.spent == SpentBudget::kCancelled) return fail({Errc::kCancelled, "path: interrupted"});
  const PathRun run = run_of(options, to.feet, seconds);
  const NodePathSummary summary = finder->summary();
  Json json = path_json(run, found);
  json["finder"] = {{"blocks", summary.blocks},
                    {"crossings", summary.crossings},
                    {"bytes", summary.bytes},
                    {"seconds", summary.seconds}};
  std::string text = path_text(run, found);
  for (const auto& [place, position, end] :
       {std::tuple{from, *from_position, "from"}, std::tuple{to, *to_position, "to"}}) {
    const double offset = std::hypot(place.feet.x - position.x, place.feet.z - position.z);
    json["beside"][end] = offset;
    if (offset < kMaxOffset) continue;
    text += fmt::format("  --{} is {:.3f} m beside, at ({})\n", end, offset, where(place.feet));
  }
  print_result(session, json, text);
  return found.end == PathEnd::kReached ? kDone : kAnswerIsNo;
}

int path(Session& session, const PathOptions& options) {
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
  const Result<int32_t> avatar_class = class_named(*world, options.avatar_class);
  if (!avatar_class) return fail(avatar_class.error());
  const AvatarClass avatar = world->summary().classes[static_cast<size_t>(*avatar_class)];
  const bool over_nodes = options.nodes || (!options.fly && goes_over_nodes(avatar));
  if (auto ok = check_options(options, over_nodes); !ok) return fail(ok.error());
  if (options.fly) return fly(session, options, *world, *avatar_class);
  if (over_nodes) return find_over_nodes(session, options, *world, *avatar_class);
  if (options.is_live()) {
    // A LiveGround reads zones on demand and takes a damaged one for empty: check all first.
    if (auto ok = world->check_ground(); !ok) return fail(ok.error());
  }
  const auto from = place_of(*world, options, *avatar_class, options.from, "--from");
  if (!from) return fail(from.error());
  const auto to = place_of(*world, options, *avatar_class, options.to, "--to");
  if (!to) return fail(to.error());
  const SearchBudget budget(UINT64_MAX, &session.context.cancel, options.search_bytes);
  Path found;
  Json mesh;
  double seconds = 0;
  if (!options.is_live()) {
    Result<PathFinder> finder = PathFinder::create(
        *world, {.avatar_class = *avatar_class, .workers = options.threads}, session.context);
    if (!finder) return fail(finder.error());
    mesh = mesh_json(finder->summary());
    seconds += seconds_of([&] { finder->find(*from, *to, found, budget); });
  }
  // Only LiveGround finds the nearest point and its blocker.
  if (options.is_live() || found.end == PathEnd::kUnreachable) {
    auto ground = live_ground(*world, options, *avatar_class);
    if (!ground) return fail(ground.error());
    for (const auto& [place, option] : {std::pair{*from, "--from"}, std::pair{*to, "--to"}}) {
      if (ground->is_free(place)) continue;
      return fail(bad_end(options, place.position, option,
                          "is blocked: a --block stands there, or its ground is closed"));
    }
    seconds += seconds_of([&] { ground->find(*from, *to, found, budget); });
  }
  if (found.spent == SpentBudget::kCancelled) return fail({Errc::kCancelled, "path: interrupted"});
  const PathRun run = run_of(options, to->position, seconds);
  Json json = path_json(run, found);
  if (!mesh.is_null()) json["mesh"] = mesh;
  print_result(session, json, path_text(run, found));
  return found.end == PathEnd::kReached ? kDone : kAnswerIsNo;
}

}  // namespace

void add_path(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "path", "Find the shortest path between two places",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng path garage.throng --from 14,0,8 --to 30,8.7,30 --class adult\n"
                  "throng path garage.throng --from 14,0,8 --to 20,0,8 --block 16,0,0,17,2,9\n"
                  "throng bake builtin:bridge --fly -o bridge.throng\n"
                  "throng path bridge.throng --from 10,9,10 --to 30,9,30 --class flyer --fly\n"
                  "throng bake builtin:landscape,size=160 -o hills.throng --cell 0.5 --nodes\n"
                  "throng path hills.throng --from 20,5,20 --to 120,5,90 --tolerance 20 --nodes");
  const auto options = std::make_shared<PathOptions>();
  add_path_options(*command, *options);
  command->callback([&session, options] { session.exit_code = path(session, *options); });
}

}  // namespace throng::app
