// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "throng/surface.h"

// throng surface: how many nodes and arcs a world has, their links to the air, their connected
// components per class, and how much of a class's ground is how steep, high and wide.
namespace throng::app {
namespace {

// Areas by what is promised, without those of rounding.
struct Promised {
  const char* name;
  const char* limit;  // "at_least" or "at_most"
  const char* unit;
  std::array<double, 16> areas;
  std::vector<double> values;  // by code
};

std::vector<Promised> promised(const NodeDistribution& found, const NodeBins& bins) {
  std::vector<double> slopes, heights, widths;
  for (uint8_t code = 0; code < 16; ++code) {
    slopes.push_back(bins.inclination_of(code));
    heights.push_back(bins.height_of(code));
    widths.push_back(bins.width_of(code));
  }
  return {{"inclination", "at_most", "deg", found.inclination, slopes},
          {"height", "at_least", "m", found.height, heights},
          {"headroom", "at_least", "m", found.headroom, heights},
          {"width", "at_least", "m", found.width, widths}};
}

void add_distribution(const NodeDistribution& found, const NodeBins& bins, Json& json,
                      std::string& text) {
  constexpr double kNothing = 1e-6;  // [m^2]
  for (const Promised& one : promised(found, bins)) {
    Json list = Json::array();
    std::string line;
    for (size_t code = 0; code < one.areas.size(); ++code) {
      if (one.areas[code] < kNothing) continue;
      list.push_back({{one.limit, one.values[code]}, {"area", one.areas[code]}});
      line += fmt::format("{}{:g} {}: {:.1f} m2", line.empty() ? "" : ", ", one.values[code],
                          one.unit, one.areas[code]);
    }
    json[one.name] = std::move(list);
    if (line.empty()) continue;
    text += fmt::format("    {:<11} {} {}\n", one.name,
                        one.limit == std::string("at_most") ? "at most " : "at least", line);
  }
}

int print_surface(Session& session, const std::string& path) {
  const Result<Nodes> nodes = Nodes::open(path);
  if (!nodes) return fail(nodes.error());
  if (auto ok = nodes->check_all(); !ok) return fail(ok.error());
  const NodeSummary summary = nodes->summary();
  const double count = static_cast<double>(std::max<uint64_t>(summary.nodes, 1));
  Json json = {{"world", path},
               {"nodes", summary.nodes},
               {"terminal", summary.terminal},
               {"partial", summary.partial},
               {"arcs", summary.arcs},
               {"patches", summary.patches},
               {"zones", summary.zones},
               {"bytes", summary.bytes},
               {"bytes_a_node", static_cast<double>(summary.bytes) / count}};
  std::string text = fmt::format(
      "{}: {} ({} terminal, {} partial), {}, {} patches in {}, {} ({:.1f} bytes a node)\n", path,
      counted(summary.nodes, "node"), summary.terminal, summary.partial,
      counted(summary.arcs, "arc"), summary.patches, counted(summary.zones, "zone"),
      human_bytes(summary.bytes), static_cast<double>(summary.bytes) / count);
  if (AirLinks::exist(nodes->world())) {
    const Result<AirLinks> links = AirLinks::open(*nodes);
    if (!links) return fail(links.error());
    if (auto ok = links->check_all(); !ok) return fail(ok.error());
    const AirLinkSummary air = links->summary();
    json["air_links"] = {{"links", air.links},
                         {"leaves", air.leaves},
                         {"nodes", air.nodes},
                         {"leaf_sinks", air.leaf_sinks},
                         {"bytes", air.bytes}};
    text +=
        fmt::format("  leaves of the air: {} linked to {} by {} in both directions, {} not, {}\n",
                    air.leaves, counted(air.nodes, "node"), counted(air.links, "link"),
                    air.leaf_sinks, human_bytes(air.bytes));
  }
  json["classes"] = Json::array();
  for (size_t c = 0; c < summary.classes.size(); ++c) {
    const auto components = nodes->components(static_cast<int32_t>(c));
    double area = 0;
    uint64_t stands = 0;
    for (const NodeComponent& component : components) {
      area += component.area;
      stands += component.nodes;
    }
    const double largest = components.empty() ? 0 : components[0].area;
    Json of_class = {{"class", summary.classes[c].name},
                     {"nodes", stands},
                     {"area", area},
                     {"components", components.size()},
                     {"largest", largest}};
    text += fmt::format("  {:<12} {:9} nodes {:12.1f} m2, {} components, the largest {:.1f} m2\n",
                        summary.classes[c].name, stands, area, components.size(), largest);
    add_distribution(nodes->distribution(static_cast<int32_t>(c)), summary.bins, of_class, text);
    json["classes"].push_back(std::move(of_class));
  }
  print_result(session, json, text);
  return kDone;
}

}  // namespace

void add_surface(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "surface",
                  "Show what each class can reach over the nodes of a world, and how steep, high "
                  "and wide it is",
                  "throng bake builtin:landscape,size=160 -o hills.throng --cell 0.5 --nodes\n"
                  "throng surface hills.throng");
  const auto path = std::make_shared<std::string>();
  command->add_option("world", *path, "World folder with nodes")
      ->required()
      ->type_name("WORLD.throng");
  command->callback([&session, path] { session.exit_code = print_surface(session, *path); });
}

}  // namespace throng::app
