// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "command.h"
#include "in_world.h"
#include "number_checks.h"
#include "throng/world.h"

// throng components: the connected components of a world, per avatar class.
namespace throng::app {
namespace {

struct ComponentsOptions {
  std::string world;
  std::string avatar_class = "all";
  std::vector<double> at;
  uint64_t limit = 10;
  int32_t threads = 0;
};

constexpr double kVerticalTolerance = 1.0;  // of the feet at --at [m]

std::string place_text(const Vec3d& p) {
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", p.x, p.y, p.z);
}

double total_area(std::span<const Component> components) {
  double area = 0;
  for (const Component& component : components) area += component.area;
  return area;
}

Json components_json(std::span<const Component> components, uint64_t limit) {
  Json list = Json::array();
  for (const Component& c : components.first(std::min<size_t>(limit, components.size()))) {
    list.push_back({{"area", c.area},
                    {"regions", c.regions},
                    {"place", {c.place.position.x, c.place.position.y, c.place.position.z}}});
  }
  return list;
}

// Appends the components of one class to the object and the text.
void describe(const World& world, const Graph& graph, const ComponentsOptions& options,
              int32_t avatar_class, Json& classes, std::string& text) {
  const auto summary = world.summary();
  const std::string& name = summary.classes[static_cast<size_t>(avatar_class)].name;
  const auto components = graph.components(avatar_class);
  const double area = total_area(components);
  Json json = {
      {"class", name},
      {"goes_over_nodes", goes_over_nodes(summary.classes[static_cast<size_t>(avatar_class)])},
      {"components", components.size()},
      {"area", area},
      {"largest", components_json(components, options.limit)}};
  text += fmt::format("{}: {} component{}, {:.1f} m2\n", name, components.size(),
                      components.size() == 1 ? "" : "s", area);
  text += note_of_nodes(summary.classes[static_cast<size_t>(avatar_class)]);
  const size_t shown = std::min<size_t>(options.limit, components.size());
  for (size_t i = 0; i < shown; ++i) {
    const Component& c = components[i];
    text += fmt::format("  {:>4}  {:>12.2f} m2  {:>6.2f} %  {:>8} regions, one place at {}\n", i,
                        c.area, 100 * c.area / area, c.regions, place_text(c.place.position));
  }
  if (shown < components.size())
    text += fmt::format("        and {} smaller ones (--limit)\n", components.size() - shown);
  if (!options.at.empty()) {
    const Vec3d at{options.at[0], options.at[1], options.at[2]};
    const int32_t found =
        graph.component_at(avatar_class, world.find_place(avatar_class, at, kVerticalTolerance));
    json["at"] = found >= 0 ? Json(found) : Json(nullptr);
    text += found >= 0 ? fmt::format("  ({}) lies in component {}\n", place_text(at), found)
                       : fmt::format("  ({}) is no place for this class\n", place_text(at));
  }
  classes.push_back(json);
}

int print_components(Session& session, const ComponentsOptions& options) {
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
  std::optional<int32_t> only;
  if (options.avatar_class != "all") {
    const Result<int32_t> named = class_named(*world, options.avatar_class);
    if (!named) return fail({named.error().code, named.error().message + ", or all"});
    only = *named;
  }
  if (!options.at.empty()) {
    const Result<Vec3d> at = position_in(*world, options.world, "--at", options.at);
    if (!at) return fail(at.error());
  }
  const Result<Graph> graph = Graph::create(*world, {.workers = options.threads}, session.context);
  if (!graph) return fail(graph.error());
  if (!options.at.empty()) {
    const auto usable = graph->check_at({options.at[0], options.at[1], options.at[2]});
    if (!usable) return fail(usable.error());
  }
  const GraphSummary summary = graph->summary();
  Json classes = Json::array();
  std::string text =
      fmt::format("{}: {} regions, {} links, {} in {:.3f} s\n", options.world, summary.regions,
                  summary.links, human_bytes(summary.bytes), summary.seconds);
  const auto count = static_cast<int32_t>(world->summary().classes.size());
  for (int32_t c = 0; c < count; ++c) {
    if (!only || *only == c) describe(*world, *graph, options, c, classes, text);
  }
  print_result(session,
               {{"world", options.world},
                {"regions", summary.regions},
                {"links", summary.links},
                {"bytes", summary.bytes},
                {"on_disk", summary.on_disk},
                {"seconds", summary.seconds},
                {"classes", classes}},
               text);
  return kDone;
}

}  // namespace

void add_components(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "components",
                                  "List the connected components of a world, per class",
                                  "throng bake builtin:garage -o garage.throng\n"
                                  "throng components garage.throng --class adult --at 14,0,8");
  const auto options = std::make_shared<ComponentsOptions>();
  command->add_option("world", options->world, "World folder")->required()->type_name("WORLD");
  command->add_option("--class", options->avatar_class, "Avatar class by name, or all")
      ->capture_default_str();
  command->add_option("--at", options->at, "Name the component of this place [m]")
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
  command->add_option("--limit", options->limit, "Components to list for each class")
      ->check(at_least(0))
      ->capture_default_str();
  add_threads(*command, options->threads)->capture_default_str();
  command->callback(
      [&session, options] { session.exit_code = print_components(session, *options); });
}

}  // namespace throng::app
