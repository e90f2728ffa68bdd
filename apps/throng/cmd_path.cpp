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
#include "throng/path.h"
#include "throng/world.h"

// throng path: the shortest path of an avatar class between two places, on foot, over nodes or
// through the air.
namespace throng::app {
namespace {

struct PathOptions {
  std::string world;
  std::string avatar_class = "adult";
  std::vector<double> from, to;
  double tolerance = 1.0;
  int32_t threads = 0;
  bool fly = false;
  bool nodes = false;
  std::vector<double> blocks;          // six numbers a box
  std::vector<double> off_mesh_links;  // six numbers a link
  std::vector<double> area_costs;      // a kind and its cost
  double slope_cost = 0;
  uint64_t search_bytes = SearchBudget::kDefaultBytes;

  [[nodiscard]] bool is_live() const {
    return !blocks.empty() || !off_mesh_links.empty() || !area_costs.empty() || slope_cost > 0;
  }
};

const char* path_word(SpentBudget spent) {
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

// The remedy if the memory of a search was exhausted; else empty.
std::string text_for(const PathOptions& options, SpentBudget spent) {
  if (spent != SpentBudget::kMemory) return {};
  return fmt::format("  the search needs more than {} MiB of memory; raise --search-memory\n",
                     options.search_bytes >> 20);
}

const char* path_word(PathEnd end) {
  switch (end) {
    case PathEnd::kReached:
      return "reached";
    case PathEnd::kUnreachable:
      return "unreachable";
    case PathEnd::kNoPlace:
      return "no place";
    case PathEnd::kBudgetExhausted:
      return "budget exhausted";
  }
  return "";
}

// "WORLD: --from (1, 2, 3) " and the fault of that end.
Error bad_end(const PathOptions& options, const Vec3d& position, const char* option,
              const std::string& what) {
  return bad_position(options.world, option, position, what);
}

// One end of the path as a position. Fails with a sentence if it lies outside the world.
Result<Vec3d> position_of(const World& world, const PathOptions& options,
                          const std::vector<double>& at, const char* option) {
  return position_in(world, options.world, option, at);
}

// One end of the path as a place. Fails with a sentence if the class cannot stand there.
Result<Place> place_of(const World& world, const PathOptions& options, int32_t avatar_class,
                       const std::vector<double>& at, const char* option) {
  const Result<Vec3d> found = position_of(world, options, at, option);
  if (!found) return found.error();
  const Vec3d position = *found;
  const auto bad = [&](const std::string& what) {
    return bad_end(options, position, option, what);
  };
  const Place place = world.find_place(avatar_class, position, options.tolerance);
  if (!place) {
    if (auto ok = world.check_ground(); !ok) return ok.error();  // Its zone may be damaged.
    return bad(
        fmt::format("is no place where class {} can stand, within {} m up or down; see "
                    "`throng picture`, or give a larger --tolerance",
                    options.avatar_class, options.tolerance));
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
  // Without costs of ground, the cost is the length.
  Json json = {{"world", options.world},
               {"class", options.avatar_class},
               {"end", path_word(path.end)},
               {"length", path.length},
               {"cost", options.is_live() ? path.cost : path.length},
               {"points", points},
               {"links", links},
               {"nodes", path.nodes},
               {"seconds", seconds}};
  if (path.spent != SpentBudget::kNone) json["spent"] = path_word(path.spent);
  if (options.is_live()) json["off_mesh_links"] = path.off_mesh_links;
  if (path.end == PathEnd::kUnreachable && !path.points.empty()) {
    const Vec3d& nearest = path.points.back().position;
    json["nearest"] = {{"place", numbers(nearest)},
                       {"distance", plan_distance(nearest, to.position)},
                       {"below", to.position.y - nearest.y},
                       {"blocked_by", app::word_for(path.blocked_by)}};
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
    text = fmt::format("{:.3f} m for {}, {} segments, found in {:.3f} ms\n", path.length,
                       options.avatar_class, path.points.size() - 1, seconds * 1e3);
    if (options.is_live()) text += fmt::format("  costs {:.3f}\n", path.cost);
  } else {
    text = fmt::format("no path for {}: {}\n", options.avatar_class, path_word(path.end)) +
           text_for(options, path.spent);
    if (path.end != PathEnd::kUnreachable || path.points.empty()) return text;
    const Vec3d& nearest = path.points.back().position;
    text += fmt::format("  gets to ({}), {}; blocked by: {}\n", where(nearest),
                        how_near(nearest, to.position), app::word_for(path.blocked_by));
  }
  size_t link = 0;
  for (size_t i = 0; i < path.points.size(); ++i) {
    const bool is_start = link < path.off_mesh_links.size() && path.off_mesh_links[link] == i;
    if (is_start) ++link;
    text += "  " + where(path.points[i].position) + (is_start ? "  off-mesh link\n" : "\n");
  }
  return text;
}

const char* path_word(SegmentKind kind) {
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
  for (const SegmentKind kind : path.segments) segments.push_back(path_word(kind));
  Json json = {
      {"world", options.world},
      {"class", options.avatar_class},
      {"end", path_word(path.end)},
      {"length", path.length},
      {"cost", path.length},
      {"points", points},
      {"segments", segments},
      {"nodes", path.nodes},
      {"seconds", seconds},
      {"air", {{"boxes", summary.boxes}, {"bytes", summary.bytes}, {"seconds", summary.seconds}}}};
  if (path.spent != SpentBudget::kNone) json["spent"] = path_word(path.spent);
  if (path.end == PathEnd::kUnreachable && !path.points.empty()) {
    const Vec3d& nearest = path.points.back();
    json["nearest"] = {{"place", numbers(nearest)},
                       {"distance", length(to - nearest)},
                       {"blocked_by", app::word_for(path.blocked_by)}};
  }
  return json;
}

std::string flight_text(const PathOptions& options, const FlightPath& path, const Vec3d& to,
                        double seconds) {
  std::string text;
  if (path.end == PathEnd::kReached) {
    text = fmt::format("{:.3f} m for {}, {} segments, found in {:.3f} ms\n", path.length,
                       options.avatar_class, path.segments.size(), seconds * 1e3);
  } else {
    text = fmt::format("no path for {}: {}\n", options.avatar_class, path_word(path.end)) +
           text_for(options, path.spent);
    if (path.end != PathEnd::kUnreachable || path.points.empty()) return text;
    const Vec3d& nearest = path.points.back();
    text += fmt::format("  gets to ({}), {:.3f} m from there; blocked by: {}\n", where(nearest),
                        length(to - nearest), app::word_for(path.blocked_by));
  }
  for (size_t i = 0; i < path.points.size(); ++i) {
    text += fmt::format("  {}{}\n", where(path.points[i]),
                        i == 0 ? "" : fmt::format("  {}", path_word(path.segments[i - 1])));
  }
  return text;
}

// Adds the boxes of --block as obstacles.
template <class Finder>
Result<void> add_boxes(const PathOptions& options, Finder& finder) {
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
  if (auto ok = add_boxes(options, *finder); !ok) return fail(ok.error());
  FlightPath found;
  const auto start = std::chrono::steady_clock::now();
  finder->find({.from = *from,
                .to = *to,
                .vertical_tolerance = options.tolerance,
                .max_bytes = options.search_bytes,
                .cancel = &session.context.cancel},
               found);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (found.end == PathEnd::kNoPlace) {
    // Find out which end is blocked: a path from an end to itself.
    for (const auto& [position, option] : {std::pair{*from, "--from"}, std::pair{*to, "--to"}}) {
      finder->find({.from = position, .to = position, .vertical_tolerance = options.tolerance},
                   found);
      if (found.end != PathEnd::kNoPlace) continue;
      return fail(bad_end(options, position, option, "is blocked: a --block is there"));
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
        {{"point", link.point}, {"kind", app::word_for(link.kind)}, {"over_hole", link.over_hole}});
  }
  Json json = {{"world", options.world},
               {"class", options.avatar_class},
               {"end", path_word(path.end)},
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
  if (path.spent != SpentBudget::kNone) json["spent"] = path_word(path.spent);
  if (path.end == PathEnd::kUnreachable && !path.points.empty()) {
    const Vec3d nearest = path.points.back().place.feet;
    json["nearest"] = {{"place", numbers(nearest)},
                       {"distance", length(nearest - to.feet)},
                       {"blocked_by", app::word_for(path.blocked_by)}};
  }
  return json;
}

const char* text_of_hole(const NodePathLink& link) {
  return link.over_hole && link.kind != LinkKind::kDrop ? " over a hole" : "";
}

std::string node_path_text(const PathOptions& options, const NodePath& path, const NodePlace& to,
                           double seconds) {
  std::string text;
  if (path.end == PathEnd::kReached) {
    text = fmt::format("{:.3f} m for {} over {} nodes, found in {:.3f} ms\n", path.length,
                       options.avatar_class, path.corridor.size(), seconds * 1e3);
  } else {
    text = fmt::format("no path for {}: {}\n", options.avatar_class, path_word(path.end)) +
           text_for(options, path.spent);
    if (path.end != PathEnd::kUnreachable || path.points.empty()) return text;
    const Vec3d nearest = path.points.back().place.feet;
    text += fmt::format("  gets to ({}), {:.3f} m from there; blocked by: {}\n", where(nearest),
                        length(nearest - to.feet), app::word_for(path.blocked_by));
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
                          text_of_hole(path.links[link]));
    }
    text += '\n';
  }
  return text;
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
  if (auto ok = add_boxes(options, *finder); !ok) return fail(ok.error());
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
  NodePath found;
  const auto start = std::chrono::steady_clock::now();
  finder->find(from, to, found, 0.25, {UINT64_MAX, &session.context.cancel, options.search_bytes});
  if (found.spent == SpentBudget::kCancelled) return fail({Errc::kCancelled, "path: interrupted"});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Json json = node_path_json(options, found, to, finder->summary(), seconds);
  std::string text = node_path_text(options, found, to, seconds);
  for (const auto& [place, position, end] :
       {std::tuple{from, *from_position, "from"}, std::tuple{to, *to_position, "to"}}) {
    const double offset = plan_distance(place.feet, position);
    json["beside"][end] = offset;
    if (offset < kMaxOffset) continue;
    text += fmt::format("  --{} is {:.3f} m beside, at ({})\n", end, offset, where(place.feet));
  }
  print_result(session, json, text);
  return found.end == PathEnd::kReached ? kDone : kAnswerIsNo;
}

// The ground with the boxes, costs and off-mesh links of the options.
Result<LiveGround> live_ground(const World& world, const PathOptions& options,
                               int32_t avatar_class) {
  auto ground =
      LiveGround::create(world, {.avatar_class = avatar_class, .slope_cost = options.slope_cost});
  if (!ground) return ground.error();
  if (auto ok = add_boxes(options, *ground); !ok) return ok.error();
  for (size_t i = 0; i < options.area_costs.size(); i += 2) {
    const double kind = options.area_costs[i];
    if (!(kind >= 0 && kind <= 255 && kind == std::floor(kind))) {
      return Error{
          Errc::kBadConfig,
          fmt::format("--area-cost: {} is no kind of ground; kinds are whole numbers from 0 to 255",
                      kind)};
    }
    if (auto ok = ground->set_area_cost(static_cast<uint8_t>(kind), options.area_costs[i + 1]);
        !ok) {
      return Error{ok.error().code, "--area-cost: " + ok.error().message};
    }
  }
  for (size_t i = 0; i < options.off_mesh_links.size(); i += 6) {
    OffMeshLink link;
    for (Place* end : {&link.from, &link.to}) {
      const auto at =
          options.off_mesh_links.begin() + static_cast<ptrdiff_t>(i + (end == &link.to ? 3 : 0));
      auto place = place_of(world, options, avatar_class, {at, at + 3}, "--off-mesh-link");
      if (!place) return place.error();
      *end = *place;
    }
    link.cost = length(link.to.position - link.from.position);
    if (auto added = ground->add_off_mesh_link(link); !added) {
      return Error{Errc::kBadInput, "--off-mesh-link: " + added.error().message};
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
    return fail({Errc::kBadConfig, "--fly finds paths through the air, --nodes over the ground"});
  }
  if (options.fly) {
    if (!options.off_mesh_links.empty() || !options.area_costs.empty() || options.slope_cost > 0) {
      return fail({Errc::kBadConfig,
                   "--off-mesh-link, --area-cost and --slope-cost change the ground; paths through "
                   "the air (--fly) take only --block"});
    }
    return fly(session, options, *world, *avatar_class);
  }
  if (options.nodes || goes_over_nodes(avatar)) {
    if (!options.off_mesh_links.empty() || !options.area_costs.empty()) {
      return fail({Errc::kBadConfig,
                   "--off-mesh-link and --area-cost change the ground of level tiles; paths over "
                   "nodes take off-mesh links from `throng bake --off-mesh-links`"});
    }
    return find_over_nodes(session, options, *world, *avatar_class);
  }
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
  const auto timed = [&](auto&& find) {
    const auto start = std::chrono::steady_clock::now();
    find();
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  if (!options.is_live()) {
    Result<PathFinder> finder = PathFinder::create(
        *world, {.avatar_class = *avatar_class, .workers = options.threads}, session.context);
    if (!finder) return fail(finder.error());
    mesh = mesh_json(finder->summary());
    timed([&] { finder->find(*from, *to, found, budget); });
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
      add_command(parser, session, "path", "Find the shortest path between two places",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng path garage.throng --from 14,0,8 --to 30,8.7,30 --class adult\n"
                  "throng path garage.throng --from 14,0,8 --to 20,0,8 --block 16,0,0,17,2,9\n"
                  "throng bake builtin:bridge --fly -o bridge.throng\n"
                  "throng path bridge.throng --from 10,9,10 --to 30,9,30 --class flyer --fly\n"
                  "throng bake builtin:landscape,size=160 -o hills.throng --cell 0.5 --nodes\n"
                  "throng path hills.throng --from 20,5,20 --to 120,5,90 --tolerance 20 --nodes");
  const auto options = std::make_shared<PathOptions>();
  const auto add_place = [&](const char* name, std::vector<double>& at, const char* what) {
    command->add_option(name, at, what)
        ->delimiter(',')
        ->expected(3)
        ->required()
        ->type_name("X,Y,Z");
  };
  command->add_option("world", options->world, "World folder")->required()->type_name("WORLD");
  add_place("--from", options->from, "Start of the path [m]");
  add_place("--to", options->to, "Goal of the path [m]");
  command->add_option("--class", options->avatar_class, "Avatar class by name")
      ->capture_default_str();
  command
      ->add_option(
          "--tolerance", options->tolerance,
          "Vertical tolerance of both ends; search radius for classes that climb, and over nodes "
          "without ground above or below [m]")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_flag("--fly", options->fly,
                    "Path through the air, for a class that flies; an end may be on the ground");
  command->add_flag("--nodes", options->nodes,
                    "Path over the world's nodes, as always for classes that climb");
  const auto add_list = [&](const char* name, std::vector<double>& list, const char* what,
                            char between, int count, const char* type) {
    command->add_option(name, list, what)
        ->delimiter(between)
        ->type_size(count)
        ->expected(1, 1 << 16)
        ->type_name(type);
  };
  add_blocks(command, options->blocks);
  add_list("--off-mesh-link", options->off_mesh_links,
           "A link from one place to another and back, given by hand [m]", ',', 6, "X,Y,Z,X,Y,Z");
  add_list("--area-cost", options->area_costs, "Cost of a metre on ground of a kind; inf closes it",
           '=', 2, "KIND=COST");
  command
      ->add_option("--slope-cost", options->slope_cost,
                   "Additional cost of a metre per metre of rise")
      ->check(between(0.0, 1000.0))
      ->capture_default_str();
  add_search_memory(*command, options->search_bytes);
  command->add_option("--threads", options->threads, "Threads for making the mesh, 0 for all cores")
      ->check(between(0, 1024))
      ->capture_default_str();
  command->callback([&session, options] { session.exit_code = path(session, *options); });
}

}  // namespace throng::app
