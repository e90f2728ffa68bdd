// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "boxes.h"
#include "command.h"
#include "in_world.h"
#include "number_checks.h"
#include "throng/flight.h"
#include "throng/live_ground.h"
#include "throng/node_path.h"
#include "throng/path.h"
#include "throng/world.h"

// throng path: the shortest way for an avatar class between two places.
namespace throng::app {
namespace {

struct PathOptions {
  std::string world;
  std::string avatar_class = "adult";
  std::vector<double> from, to;
  double reach = 1.0;
  int32_t threads = 0;
  bool fly = false;
  bool nodes = false;
  std::vector<double> blocks;          // six numbers a box
  std::vector<double> off_mesh_links;  // six numbers a jump
  std::vector<double> area_costs;      // a kind and its cost
  double slope_cost = 0;
  uint64_t search_bytes = SearchBudget::kDefaultBytes;

  [[nodiscard]] bool is_live() const {
    return !blocks.empty() || !off_mesh_links.empty() || !area_costs.empty() || slope_cost > 0;
  }
};

const char* word_for(SpentBudget spent) {
  switch (spent) {
    case SpentBudget::kNone:
      return "";
    case SpentBudget::kNodes:
      return "nodes";
    case SpentBudget::kMemory:
      return "memory";
    case SpentBudget::kCancelled:
      return "cancelled";
  }
  return "";
}

// What a search had too little of, and what to do; empty if it had enough.
std::string text_for(const PathOptions& options, SpentBudget spent) {
  if (spent != SpentBudget::kMemory) return {};
  return fmt::format("  the search would take more than {} MiB of memory; raise --search-memory\n",
                     options.search_bytes >> 20);
}

const char* word_for(PathEnd end) {
  switch (end) {
    case PathEnd::kReached:
      return "reached";
    case PathEnd::kUnreachable:
      return "unreachable";
    case PathEnd::kNoPlace:
      return "no place";
    case PathEnd::kBudgetExhausted:
      return "gave up";
  }
  return "";
}

// "WORLD: --from (1, 2, 3) " and what is wrong with that end.
Error bad_end(const PathOptions& options, const Vec3d& position, const char* option,
              const std::string& what) {
  return bad_position(options.world, option, position, what);
}

// One end of the way as a position; fails with a sentence if it is none of the world's.
Result<Vec3d> position_of(const World& world, const PathOptions& options,
                          const std::vector<double>& at, const char* option) {
  return position_in(world, options.world, option, at);
}

// The same as a place; fails with a sentence if the class cannot stand there.
Result<Place> place_of(const World& world, const PathOptions& options, int32_t avatar_class,
                       const std::vector<double>& at, const char* option) {
  const Result<Vec3d> found = position_of(world, options, at, option);
  if (!found) return found.error();
  const Vec3d position = *found;
  const auto bad = [&](const std::string& what) {
    return bad_end(options, position, option, what);
  };
  const Place place = world.find_place(avatar_class, position, options.reach);
  if (!place) {
    if (auto ok = world.check_ground(); !ok) return ok.error();  // Its zone may be what is bad.
    return bad(
        fmt::format("is no place where class {} can stand, within {} m up or down; see "
                    "`throng picture`, or give a wider --reach",
                    options.avatar_class, options.reach));
  }
  return place;
}

double plan_distance(const Vec3d& a, const Vec3d& b) { return std::hypot(a.x - b.x, a.z - b.z); }

// "1.200 m from there in the plane and 2.900 m below".
std::string how_near(const Vec3d& nearest, const Vec3d& goal) {
  const double below = goal.y - nearest.y;
  std::string text = fmt::format("{:.3f} m from there in the plane", plan_distance(nearest, goal));
  if (std::fabs(below) < 0.0005) return text;
  return text + fmt::format(" and {:.3f} m {}", std::fabs(below), below > 0 ? "below" : "above");
}

Json path_json(const PathOptions& options, const Path& path, const Place& to, double seconds) {
  Json points = Json::array(), links = Json::array();
  for (const Place& p : path.points) points.push_back(numbers(p.position));
  for (const uint32_t point : path.off_mesh_links) {
    links.push_back({{"point", point}, {"kind", app::word_for(LinkKind::kOffMesh)}});
  }
  // Where nothing costs more than its length, that is the cost.
  Json json = {{"world", options.world},
               {"class", options.avatar_class},
               {"end", word_for(path.end)},
               {"length", path.length},
               {"cost", options.is_live() ? path.cost : path.length},
               {"points", points},
               {"links", links},
               {"nodes", path.nodes},
               {"seconds", seconds}};
  if (path.spent != SpentBudget::kNone) json["spent"] = word_for(path.spent);
  if (options.is_live()) json["jumps"] = path.off_mesh_links;
  if (path.end == PathEnd::kUnreachable && !path.points.empty()) {
    const Vec3d& nearest = path.points.back().position;
    json["nearest"] = {{"place", numbers(nearest)},
                       {"distance", plan_distance(nearest, to.position)},
                       {"below", to.position.y - nearest.y},
                       {"obstacle", app::word_for(path.obstacle)}};
  }
  return json;
}

Json mesh_json(const PathSummary& summary) {
  return {{"rectangles", summary.rectangles},
          {"portals", summary.portals},
          {"corners", summary.corners},
          {"bytes", summary.bytes},
          {"seconds", summary.seconds}};
}

std::string path_text(const PathOptions& options, const Path& path, const Place& to,
                      double seconds) {
  std::string text;
  if (path.end == PathEnd::kReached) {
    text = fmt::format("{:.3f} m for {}, {} legs, found in {:.3f} ms\n", path.length,
                       options.avatar_class, path.points.size() - 1, seconds * 1e3);
    if (options.is_live()) text += fmt::format("  costs {:.3f}\n", path.cost);
  } else {
    text = fmt::format("no way for {}: {}\n", options.avatar_class, word_for(path.end)) +
           text_for(options, path.spent);
    if (path.end != PathEnd::kUnreachable || path.points.empty()) return text;
    const Vec3d& nearest = path.points.back().position;
    text += fmt::format("  gets to ({}), {}; what is in the way: {}\n", where(nearest),
                        how_near(nearest, to.position), app::word_for(path.obstacle));
  }
  size_t off_mesh_link = 0;
  for (size_t i = 0; i < path.points.size(); ++i) {
    const bool off_mesh_links =
        off_mesh_link < path.off_mesh_links.size() && path.off_mesh_links[off_mesh_link] == i;
    if (off_mesh_links) ++off_mesh_link;
    text += "  " + where(path.points[i].position) + (off_mesh_links ? "  jump\n" : "\n");
  }
  return text;
}

const char* word_for(SegmentKind kind) {
  switch (kind) {
    case SegmentKind::kWalk:
      return "walk";
    case SegmentKind::kTakeOff:
      return "take off";
    case SegmentKind::kFly:
      return "fly";
    case SegmentKind::kLand:
      return "land";
  }
  return "";
}

Json flight_json(const PathOptions& options, const FlightPath& path, const Vec3d& to,
                 const FlightSummary& summary, double seconds) {
  Json points = Json::array(), segments = Json::array();
  for (const Vec3d& p : path.points) points.push_back(numbers(p));
  for (const SegmentKind kind : path.segments) segments.push_back(word_for(kind));
  Json json = {
      {"world", options.world},
      {"class", options.avatar_class},
      {"end", word_for(path.end)},
      {"length", path.length},
      {"cost", path.length},
      {"points", points},
      {"legs", segments},
      {"nodes", path.nodes},
      {"seconds", seconds},
      {"air", {{"boxes", summary.boxes}, {"bytes", summary.bytes}, {"seconds", summary.seconds}}}};
  if (path.spent != SpentBudget::kNone) json["spent"] = word_for(path.spent);
  if (path.end == PathEnd::kUnreachable && !path.points.empty()) {
    const Vec3d& nearest = path.points.back();
    json["nearest"] = {{"place", numbers(nearest)},
                       {"distance", length(to - nearest)},
                       {"obstacle", app::word_for(path.obstacle)}};
  }
  return json;
}

std::string flight_text(const PathOptions& options, const FlightPath& path, const Vec3d& to,
                        double seconds) {
  std::string text;
  if (path.end == PathEnd::kReached) {
    text = fmt::format("{:.3f} m for {}, {} legs, found in {:.3f} ms\n", path.length,
                       options.avatar_class, path.segments.size(), seconds * 1e3);
  } else {
    text = fmt::format("no way for {}: {}\n", options.avatar_class, word_for(path.end)) +
           text_for(options, path.spent);
    if (path.end != PathEnd::kUnreachable || path.points.empty()) return text;
    const Vec3d& nearest = path.points.back();
    text += fmt::format("  gets to ({}), {:.3f} m from there; what is in the way: {}\n",
                        where(nearest), length(to - nearest), app::word_for(path.obstacle));
  }
  for (size_t i = 0; i < path.points.size(); ++i) {
    text += fmt::format("  {}{}\n", where(path.points[i]),
                        i == 0 ? "" : fmt::format("  {}", word_for(path.segments[i - 1])));
  }
  return text;
}

// Puts the boxes of --block up, over the ground or in the air.
template <class Finder>
Result<void> put_up(const PathOptions& options, Finder& finder) {
  const auto boxes = boxes_of(options.blocks);
  if (!boxes) return boxes.error();
  for (const Prism& box : *boxes) {
    if (auto added = finder.add_obstacle(box); !added) return added.error();
  }
  return {};
}

int fly(Session& session, const PathOptions& options, const World& world, int32_t avatar_class) {
  const auto from = position_of(world, options, options.from, "--from");
  if (!from) return fail(from.error());
  const auto to = position_of(world, options, options.to, "--to");
  if (!to) return fail(to.error());
  Result<FlightFinder> finder = FlightFinder::make(
      world, {.avatar_class = avatar_class, .workers = options.threads}, session.context);
  if (!finder) return fail(finder.error());
  for (const auto& [position, option] : {std::pair{*from, "--from"}, std::pair{*to, "--to"}}) {
    if (finder->is_legal(position) || world.find_place(avatar_class, position, options.reach)) {
      continue;
    }
    return fail(bad_end(options, position, option,
                        fmt::format("is neither in the air nor on the ground for class {}: its "
                                    "body would touch matter, or it lies above or below the air",
                                    options.avatar_class)));
  }
  if (auto ok = put_up(options, *finder); !ok) return fail(ok.error());
  FlightPath found;
  const auto start = std::chrono::steady_clock::now();
  finder->find({.from = *from,
                .to = *to,
                .vertical_tolerance = options.reach,
                .max_bytes = options.search_bytes,
                .cancel = &session.context.cancel},
               found);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (found.end == PathEnd::kNoPlace) {
    // Which end it is: a way from each to itself is told at once.
    for (const auto& [position, option] : {std::pair{*from, "--from"}, std::pair{*to, "--to"}}) {
      finder->find({.from = position, .to = position, .vertical_tolerance = options.reach}, found);
      if (found.end != PathEnd::kNoPlace) continue;
      return fail(bad_end(options, position, option, "is no place to be now: a --block is there"));
    }
  }
  print_result(session, flight_json(options, found, *to, finder->summary(), seconds),
               flight_text(options, found, *to, seconds));
  return found.end == PathEnd::kReached ? kDone : kAnswerIsNo;
}

Json node_path_json(const PathOptions& options, const NodePath& path, const NodePlace& to,
                    const NodePathSummary& summary, double seconds) {
  Json points = Json::array(), normals = Json::array(), links = Json::array();
  for (const NodePathPoint& p : path.points) {
    points.push_back(numbers(p.place.feet));
    normals.push_back(numbers(p.place.normal));
  }
  for (const NodePathLink& link : path.links) {
    links.push_back(
        {{"point", link.point}, {"kind", app::word_for(link.kind)}, {"leaps", link.over_hole}});
  }
  Json json = {{"world", options.world},
               {"class", options.avatar_class},
               {"end", word_for(path.end)},
               {"length", path.length},
               {"cost", path.cost},
               {"points", points},
               {"normals", normals},
               {"links", links},
               {"corridor", path.corridor},
               {"nodes", path.nodes},
               {"seconds", seconds},
               {"finder",
                {{"blocks", summary.blocks},
                 {"crossings", summary.crossings},
                 {"bytes", summary.bytes},
                 {"seconds", summary.seconds}}}};
  if (path.spent != SpentBudget::kNone) json["spent"] = word_for(path.spent);
  if (path.end == PathEnd::kUnreachable && !path.points.empty()) {
    const Vec3d nearest = path.points.back().place.feet;
    json["nearest"] = {{"place", numbers(nearest)},
                       {"distance", length(nearest - to.feet)},
                       {"obstacle", app::word_for(path.obstacle)}};
  }
  return json;
}

const char* word_of_gap(const NodePathLink& link) {
  return link.over_hole && link.kind != LinkKind::kDrop ? " over a gap" : "";
}

std::string node_path_text(const PathOptions& options, const NodePath& path, const NodePlace& to,
                           double seconds) {
  std::string text;
  if (path.end == PathEnd::kReached) {
    text = fmt::format("{:.3f} m for {} over {} nodes, found in {:.3f} ms\n", path.length,
                       options.avatar_class, path.corridor.size(), seconds * 1e3);
  } else {
    text = fmt::format("no way for {}: {}\n", options.avatar_class, word_for(path.end)) +
           text_for(options, path.spent);
    if (path.end != PathEnd::kUnreachable || path.points.empty()) return text;
    const Vec3d nearest = path.points.back().place.feet;
    text += fmt::format("  gets to ({}), {:.3f} m from there; what is in the way: {}\n",
                        where(nearest), length(nearest - to.feet), app::word_for(path.obstacle));
  }
  size_t link = 0;
  for (size_t i = 0; i < path.points.size(); ++i) {
    const NodePlace& place = path.points[i].place;
    text += fmt::format("  {}  {:3.0f} deg", where(place.feet),
                        std::acos(std::clamp(place.normal.y, -1.0, 1.0)) * 180 / std::numbers::pi);
    if (!path.points[i].place) text += "  over the edge";
    for (; link < path.links.size() && path.links[link].point == i; ++link) {
      if (path.links[link].kind == LinkKind::kWalk) continue;
      text += fmt::format("  {}{}", app::word_for(path.links[link].kind),
                          word_of_gap(path.links[link]));
    }
    text += '\n';
  }
  return text;
}

constexpr double kBeside = 0.01;  // What an end may be off in the plane without a word. [m]

int go_over_nodes(Session& session, const PathOptions& options, const World& world,
                  int32_t avatar_class) {
  const auto from_position = position_of(world, options, options.from, "--from");
  if (!from_position) return fail(from_position.error());
  const auto to_position = position_of(world, options, options.to, "--to");
  if (!to_position) return fail(to_position.error());
  const Result<Nodes> nodes = Nodes::open(options.world);
  if (!nodes) return fail(nodes.error());
  auto finder =
      NodePathFinder::make(*nodes,
                           {.avatar_class = avatar_class,
                            .slope_cost = options.slope_cost,
                            .overlay = false,  // For one way they are not worth their time.
                            .workers = options.threads},
                           session.context);
  if (!finder) return fail(finder.error());
  if (auto ok = put_up(options, *finder); !ok) return fail(ok.error());
  // Who only walks is on the ground up or down from there; else it is the nearest place.
  const bool climbs = goes_over_nodes(world.summary().classes[static_cast<size_t>(avatar_class)]);
  const auto place_at = [&](const Vec3d& position) {
    const Place ground = climbs ? Place{} : world.find_place(avatar_class, position, options.reach);
    return finder->find_place(ground ? ground.position : position, options.reach);
  };
  const NodePlace from = place_at(*from_position);
  const NodePlace to = place_at(*to_position);
  for (const auto& [place, position, option] :
       {std::tuple{from, *from_position, "--from"}, std::tuple{to, *to_position, "--to"}}) {
    if (place) continue;
    return fail(bad_end(options, position, option,
                        fmt::format("is no place on nodes where class {} can be, within {} m; see "
                                    "`throng picture --nodes`, or give a wider --reach",
                                    options.avatar_class, options.reach)));
  }
  NodePath found;
  const auto start = std::chrono::steady_clock::now();
  finder->find(from, to, found, 0.25, {UINT64_MAX, &session.context.cancel, options.search_bytes});
  if (found.spent == SpentBudget::kCancelled) return fail({Errc::kCancelled, "path: interrupted"});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Json json = node_path_json(options, found, to, finder->summary(), seconds);
  std::string text = node_path_text(options, found, to, seconds);
  for (const auto& [place, asked, end] :
       {std::tuple{from, *from_position, "from"}, std::tuple{to, *to_position, "to"}}) {
    const double beside = plan_distance(place.feet, asked);
    json["beside"][end] = beside;
    if (beside < kBeside) continue;
    text += fmt::format("  --{} is {:.3f} m beside, at ({})\n", end, beside, where(place.feet));
  }
  print_result(session, json, text);
  return found.end == PathEnd::kReached ? kDone : kAnswerIsNo;
}

// The ground as the options say that it is now.
Result<LiveGround> live_ground(const World& world, const PathOptions& options,
                               int32_t avatar_class) {
  auto ground =
      LiveGround::make(world, {.avatar_class = avatar_class, .slope_cost = options.slope_cost});
  if (!ground) return ground.error();
  if (auto ok = put_up(options, *ground); !ok) return ok.error();
  for (size_t i = 0; i < options.area_costs.size(); i += 2) {
    const double kind = options.area_costs[i];
    if (!(kind >= 0 && kind <= 255 && kind == std::floor(kind))) {
      return Error{
          Errc::kBadConfig,
          fmt::format("--area-cost: {} is no kind of ground, which are whole numbers", kind)};
    }
    if (auto ok = ground->set_area_cost(static_cast<uint8_t>(kind), options.area_costs[i + 1]);
        !ok) {
      return Error{ok.error().code, "--area-cost: " + ok.error().message};
    }
  }
  for (size_t i = 0; i < options.off_mesh_links.size(); i += 6) {
    OffMeshLink off_mesh_link;
    for (Place* end : {&off_mesh_link.from, &off_mesh_link.to}) {
      const auto at = options.off_mesh_links.begin() +
                      static_cast<ptrdiff_t>(i + (end == &off_mesh_link.to ? 3 : 0));
      auto place = place_of(world, options, avatar_class, {at, at + 3}, "--jump");
      if (!place) return place.error();
      *end = *place;
    }
    off_mesh_link.cost = length(off_mesh_link.to.position - off_mesh_link.from.position);
    if (auto added = ground->add_off_mesh_link(off_mesh_link); !added) {
      return Error{Errc::kBadInput, "--jump: " + added.error().message};
    }
  }
  return ground;
}

int path(Session& session, const PathOptions& options) {
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
  const Result<int32_t> avatar_class = class_named(*world, options.avatar_class);
  if (!avatar_class) return fail(avatar_class.error());
  const AvatarClass avatar = world->summary().classes[static_cast<size_t>(*avatar_class)];
  if (options.fly && options.nodes) {
    return fail({Errc::kBadConfig, "--fly leads through the air, --nodes over the ground"});
  }
  if (options.fly) {
    if (!options.off_mesh_links.empty() || !options.area_costs.empty() || options.slope_cost > 0) {
      return fail({Errc::kBadConfig,
                   "--jump, --area-cost and --slope-cost are about the ground; ways through the "
                   "air (--fly) only mind a --block"});
    }
    return fly(session, options, *world, *avatar_class);
  }
  if (options.nodes || goes_over_nodes(avatar)) {
    if (!options.off_mesh_links.empty() || !options.area_costs.empty()) {
      return fail({Errc::kBadConfig,
                   "--jump and --area-cost change the ground of level tiles; ways over nodes take "
                   "jumps from `throng bake --jumps`"});
    }
    return go_over_nodes(session, options, *world, *avatar_class);
  }
  if (options.is_live()) {
    // Ground that changes is read as it is needed, and a zone that cannot be is nobody's ground.
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
  const auto timed = [&](auto&& find) {
    const auto start = std::chrono::steady_clock::now();
    find();
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  if (!options.is_live()) {
    Result<PathFinder> finder = PathFinder::make(
        *world, {.avatar_class = *avatar_class, .workers = options.threads}, session.context);
    if (!finder) return fail(finder.error());
    mesh = mesh_json(finder->summary());
    timed([&] { finder->find(*from, *to, found, budget); });
  }
  // How near it gets, and why no nearer, only the other one says.
  if (options.is_live() || found.end == PathEnd::kUnreachable) {
    auto ground = live_ground(*world, options, *avatar_class);
    if (!ground) return fail(ground.error());
    for (const auto& [place, option] : {std::pair{*from, "--from"}, std::pair{*to, "--to"}}) {
      if (ground->is_free(place)) continue;
      return fail(
          bad_end(options, place.position, option,
                  "is no place to stand now: a --block stands there, or its ground is closed"));
    }
    timed([&] { ground->find(*from, *to, found, budget); });
  }
  if (found.spent == SpentBudget::kCancelled) return fail({Errc::kCancelled, "path: interrupted"});
  Json json = path_json(options, found, *to, seconds);
  if (!mesh.is_null()) json["mesh"] = mesh;
  print_result(session, json, path_text(options, found, *to, seconds));
  return found.end == PathEnd::kReached ? kDone : kAnswerIsNo;
}

}  // namespace

void add_path(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "path", "Find the shortest way between two places",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng path garage.throng --from 14,0,8 --to 30,8.7,30 --class adult\n"
                  "throng path garage.throng --from 14,0,8 --to 20,0,8 --block 16,0,0,17,2,9\n"
                  "throng bake builtin:bridge --fly -o bridge.throng\n"
                  "throng path bridge.throng --from 10,9,10 --to 30,9,30 --class flyer --fly\n"
                  "throng bake builtin:landscape,size=160 -o hills.throng --cell 0.5 --nodes\n"
                  "throng path hills.throng --from 20,5,20 --to 120,5,90 --reach 20 --nodes");
  const auto options = std::make_shared<PathOptions>();
  const auto add_place = [&](const char* name, std::vector<double>& at, const char* what) {
    command->add_option(name, at, what)
        ->delimiter(',')
        ->expected(3)
        ->required()
        ->type_name("X,Y,Z");
  };
  command->add_option("world", options->world, "World folder")->required()->type_name("WORLD");
  add_place("--from", options->from, "Where it begins [m]");
  add_place("--to", options->to, "Where it ends [m]");
  command->add_option("--class", options->avatar_class, "Avatar class by name")
      ->capture_default_str();
  command
      ->add_option(
          "--reach", options->reach,
          "How far up or down the feet may be; for climbers, and over nodes where there is no "
          "ground up or down, how far off at all [m]")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_flag("--fly", options->fly,
                    "Through the air, for a class that flies; either end may be on the ground");
  command->add_flag("--nodes", options->nodes,
                    "Over the world's nodes, as classes that climb always go");
  const auto add_list = [&](const char* name, std::vector<double>& list, const char* what,
                            char between, int count, const char* type) {
    command->add_option(name, list, what)
        ->delimiter(between)
        ->type_size(count)
        ->expected(1, 1 << 16)
        ->type_name(type);
  };
  add_blocks(command, options->blocks);
  add_list("--jump", options->off_mesh_links,
           "A way from one place to another and back, given by hand [m]", ',', 6, "X,Y,Z,X,Y,Z");
  add_list("--area-cost", options->area_costs,
           "What a metre on ground of a kind costs; inf closes it", '=', 2, "KIND=COST");
  command
      ->add_option("--slope-cost", options->slope_cost,
                   "What a metre costs more for each metre that the ground rises on it")
      ->check(between(0.0, 1000.0))
      ->capture_default_str();
  add_search_memory(*command, options->search_bytes);
  command->add_option("--threads", options->threads, "Threads for making the mesh, 0 for all cores")
      ->check(between(0, 1024))
      ->capture_default_str();
  command->callback([&session, options] { session.exit_code = path(session, *options); });
}

}  // namespace throng::app
