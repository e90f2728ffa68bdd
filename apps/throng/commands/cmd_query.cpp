// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "in_world.h"
#include "number_checks.h"
#include "paths/clearance_output.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "throng/world.h"

// throng query: the nearest place of a class to a position, its wall, a ray from it, places near
// it; over nodes, how steep it is there, and how tall and how wide a body passes.
namespace throng::app {
namespace {

struct QueryOptions {
  std::string world;
  std::string avatar_class = "adult";
  std::vector<double> at;
  std::vector<double> toward;
  double radius = 5;
  uint64_t random = 0;
  uint64_t seed = 1;
  bool nodes = false;
  std::vector<double> body;  // radius, height, and if given step height and steepest slope
};

void describe_wall(GroundQuery& query, const Place& place, double radius, Json& json,
                   std::string& text) {
  const NearestWall wall = query.nearest_wall(place, radius);
  if (!wall.found) {
    json["wall"] = nullptr;
    text += fmt::format("  no wall within {} m\n", radius);
    return;
  }
  json["wall"] = {{"distance", wall.distance},
                  {"at", {wall.x, wall.z}},
                  {"normal", {wall.normal_x, wall.normal_z}}};
  text += fmt::format("  nearest wall: {:.3f} m away, at {:.3f}, {:.3f}\n", wall.distance, wall.x,
                      wall.z);
}

void describe_ray(GroundQuery& query, const Place& place, const std::vector<double>& toward,
                  Json& json, std::string& text) {
  const GroundRay ray = query.ray(place, toward[0], toward[1]);
  const Place slid = query.slide(place, toward[0], toward[1]);
  json["toward"] = {{"arrived", ray.arrived},
                    {"place", numbers(ray.place.position)},
                    {"blocked_by", ray.arrived ? Json(nullptr) : Json(word_for(ray.blocked_by))},
                    {"slides_to", numbers(slid.position)}};
  text += fmt::format("  straight on by {}, {}: to ({})", toward[0], toward[1],
                      where(ray.place.position));
  if (!ray.arrived) {
    text +=
        fmt::format(", then {}; sliding, to ({})", word_for(ray.blocked_by), where(slid.position));
  }
  text += "\n";
}

// The body of an option. Fails with a sentence if no class could have it.
Result<AvatarClass> body_of(const std::vector<double>& given) {
  AvatarClass body{.name = "body", .height = given[1], .radius = given[0]};
  if (given.size() > 2) body.step_height = given[2];
  if (given.size() > 3) body.max_slope = given[3];
  if (auto ok = check_classes({&body, 1}); !ok) {
    return Error{ok.error().code, "--body: " + ok.error().message};
  }
  return body;
}

// Nothing but what nodes promise.
int query_nodes(Session& session, const QueryOptions& options, const World& world,
                int32_t avatar_class) {
  const Result<Nodes> nodes = Nodes::open(world);
  if (!nodes) return fail(nodes.error());
  if (auto ok = nodes->check_all(); !ok) return fail(ok.error());
  const Result<Vec3d> at = position_in(world, options.world, "--at", options.at);
  if (!at) return fail(at.error());
  AvatarClass body;
  if (!options.body.empty()) {
    const Result<AvatarClass> given = body_of(options.body);
    if (!given) return fail(given.error());
    body = *given;
  }
  Result<PathFinder> finder = PathFinder::create(
      world,
      {.avatar_class = avatar_class, .overlay = false, .space = PathSpace::kNodes, .nodes = *nodes},
      session.context);
  if (!finder) return fail(finder.error());
  const NodePlace place = finder->find_node_place(*at, options.radius);
  Json json = {{"world", options.world}, {"class", options.avatar_class}};
  if (!place) {
    json["place"] = nullptr;
    print_result(session, json,
                 fmt::format("no place on nodes for {} within {} m of ({})\n", options.avatar_class,
                             options.radius, where(*at)));
    return kAnswerIsNo;
  }
  const std::vector<AvatarClass> classes = world.summary().classes;
  const NodeClearance clearance = nodes->clearance(avatar_class, place);
  json["place"] = numbers(place.feet);
  json["distance"] = length(place.feet - *at);
  json["normal"] = numbers(place.normal);
  json["node"] = place.node1 - 1;
  json["clearance"] = clearance_json(clearance, classes);
  std::string text =
      fmt::format("{} can stand at ({}), {:.3f} m away, on node {}\n", options.avatar_class,
                  where(place.feet), length(place.feet - *at), place.node1 - 1) +
      clearance_text(clearance, classes, "here");
  bool fits = true;
  if (!options.body.empty()) {
    fits = nodes->fits(place, body);
    json["body"] = {{"radius", body.radius},
                    {"height", body.height},
                    {"step_height", body.step_height},
                    {"max_slope", body.max_slope},
                    {"fits", fits}};
    text += fmt::format("  a body with a radius of {:g} m, {:g} m tall: {}\n", body.radius,
                        body.height, fits ? "fits" : "nothing promises that it fits");
  }
  print_result(session, json, text);
  return fits ? kDone : kAnswerIsNo;
}

int query_place(Session& session, const QueryOptions& options) {
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
  const Result<int32_t> avatar_class = class_named(*world, options.avatar_class);
  if (!avatar_class) return fail(avatar_class.error());
  if (options.nodes) return query_nodes(session, options, *world, *avatar_class);
  Result<GroundQuery> query = GroundQuery::create(*world, *avatar_class);
  if (!query) return fail(query.error());
  const Vec3d at{options.at[0], options.at[1], options.at[2]};
  if (!std::isfinite(at.x + at.y + at.z)) {
    return fail({Errc::kBadInput, options.world + ": --at is not a finite position"});
  }
  if (auto ok = query->check_near(at, options.radius); !ok) return fail(ok.error());
  const Place found = query->nearest_place(at, options.radius);
  const AvatarClass avatar = world->summary().classes[static_cast<size_t>(*avatar_class)];
  Json json = {{"world", options.world},
               {"class", options.avatar_class},
               {"goes_over_nodes", goes_over_nodes(avatar)}};
  if (!found) {
    const Result<Vec3d> inside = position_in(*world, options.world, "--at", options.at);
    if (!inside) return fail(inside.error());
    json["place"] = nullptr;
    print_result(session, json,
                 fmt::format("no place for {} within {} m of ({})\n", options.avatar_class,
                             options.radius, where(at)) +
                     note_of_nodes(avatar));
    return kAnswerIsNo;
  }
  double far = options.radius;
  if (!options.toward.empty()) {
    far = std::max(far, std::hypot(options.toward[0], options.toward[1]));
  }
  if (auto ok = query->check_near(found.position, far); !ok) return fail(ok.error());
  const double area = query->area_near(found, options.radius);
  json["place"] = numbers(found.position);
  json["distance"] = length(found.position - at);
  json["area"] = area;
  std::string text =
      fmt::format("{} can stand at ({}), {:.3f} m away\n  {:.2f} m2 connected to it within {} m\n",
                  options.avatar_class, where(found.position), length(found.position - at), area,
                  options.radius);
  describe_wall(*query, found, options.radius, json, text);
  if (!options.toward.empty()) describe_ray(*query, found, options.toward, json, text);
  Json random = Json::array();
  for (uint64_t n = 0; n < options.random; ++n) {
    const Place p = query->random_place_near(found, options.radius, options.seed, n);
    random.push_back(numbers(p.position));
    text += fmt::format("  at random: {}\n", where(p.position));
  }
  if (options.random > 0) json["random"] = random;
  text += note_of_nodes(avatar);
  print_result(session, json, text);
  return kDone;
}

}  // namespace

void add_query(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(
      parser, session, "query", "Find the nearest place to stand, and what is around it",
      "throng bake builtin:garage -o garage.throng\n"
      "throng query garage.throng --at 14,0,8 --toward 30,0 --random 3\n"
      "throng bake builtin:garage -o garage.throng --nodes\n"
      "throng query garage.throng --at 14,0,8 --nodes --body 0.4,1.5");
  const auto options = std::make_shared<QueryOptions>();
  command->add_option("world", options->world, "World folder")->required()->type_name("WORLD");
  command->add_option("--at", options->at, "Near where [m]")
      ->delimiter(',')
      ->expected(3)
      ->required()
      ->type_name("X,Y,Z");
  command->add_option("--class", options->avatar_class, "Avatar class by name")
      ->capture_default_str();
  command->add_option("--radius", options->radius, "How far around to look [m]")
      ->check(between(0.0, 1000.0))
      ->capture_default_str();
  CLI::Option* nodes = command->add_flag(
      "--nodes", options->nodes,
      "Instead: what the world's nodes promise at the nearest place on any surface, how steep it "
      "is, and how tall and how wide a body passes");
  command
      ->add_option("--body", options->body,
                   "Of a world with --nodes: also whether a body of this size fits there; step "
                   "height and steepest slope are those of an adult if left out [m, m, m, degrees]")
      ->delimiter(',')
      ->expected(2, 4)
      ->needs(nodes)
      ->type_name("RADIUS,HEIGHT[,STEP[,SLOPE]]");
  CLI::Option* toward =
      command->add_option("--toward", options->toward, "Also cast a ray by this vector [m]")
          ->delimiter(',')
          ->expected(2)
          ->type_name("DX,DZ");
  CLI::Option* random =
      command->add_option("--random", options->random, "Also this many random places around it")
          ->check(between(0, 1000000))
          ->capture_default_str();
  nodes->excludes(toward)->excludes(random);
  command->add_option("--seed", options->seed, "Of the random places")->capture_default_str();
  command->callback([&session, options] { session.exit_code = query_place(session, *options); });
}

}  // namespace throng::app
