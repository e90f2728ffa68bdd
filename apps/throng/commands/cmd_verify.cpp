// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "paths/boxes.h"
#include "sources.h"
#include "throng/verify.h"
#include "throng/world.h"

// throng verify: tests a baked world, its nodes or its paths against the source triangles.
namespace throng::app {
namespace {

constexpr double kLostLimit = 0.01;  ///< Max share of the area where the grown body stands.

struct VerifyOptions {
  std::string world;
  SourceOptions sources;
  std::string class_name = "all";
  bool nodes = false, paths = false;
  std::vector<double> blocks;  // six numbers a box
  VerifyConfig config;
};

struct ClassReport {
  std::string name;
  VerifyReport report;
  std::optional<FlightReport> flight;  // of a class that flies
};

bool passes(const VerifyReport& report) {
  return report.entered == 0 && report.unsupported == 0 && report.broken == 0 &&
         report.lost_grown <= kLostLimit;
}

// File, node and material of a triangle; null for a scene without parts.
Json part_json(const Scene& scene, uint32_t triangle) {
  const auto after =
      std::upper_bound(scene.parts.begin(), scene.parts.end(), triangle,
                       [](uint32_t t, const ScenePart& part) { return t < part.first_triangle; });
  if (after == scene.parts.begin()) return nullptr;
  const ScenePart& part = *std::prev(after);
  return {{"file", part.file}, {"node", part.node}, {"material", part.material}};
}

Json faults_json(const Scene& scene, const VerifyReport& report) {
  Json faults = Json::array();
  for (const VerifyFault& fault : report.faults) {
    Json json = {{"what", fault.what},
                 {"feet", {fault.position.x, fault.position.y, fault.position.z}}};
    if (fault.what == "entered" || fault.what == "lost") {
      json["triangle"] = fault.triangle;
      json["part"] = part_json(scene, fault.triangle);
    }
    faults.push_back(std::move(json));
  }
  return faults;
}

Json flight_json(const ClassReport& entry) {
  if (!entry.flight) return nullptr;
  const FlightReport& flight = *entry.flight;
  return {{"points", flight.points},       {"pairs", flight.pairs},
          {"reached", flight.reached},     {"segments", flight.segments},
          {"positions", flight.positions}, {"entered", flight.entered},
          {"seconds", flight.seconds}};
}

Json class_json(const Scene& scene, const ClassReport& entry) {
  const VerifyReport& report = entry.report;
  return {{"class", entry.name},
          {"flight", flight_json(entry)},
          {"states", report.states},
          {"moves", report.moves},
          {"surface_points", report.surface_points},
          {"entered", report.entered},
          {"unsupported", report.unsupported},
          {"broken", report.broken},
          {"no_surface_under_centre", report.no_surface_under_centre},
          {"feet_error", {{"mean", report.feet_error_mean}, {"p95", report.feet_error_p95}}},
          {"lost",
           {{"grown", report.lost_grown},
            {"grown_error", report.lost_grown_error},
            {"exact", report.lost_exact},
            {"exact_error", report.lost_exact_error}}},
          {"isolated", {{"grown", report.isolated_grown}, {"exact", report.isolated_exact}}},
          {"standable_area",
           {{"grown", report.standable_area_grown}, {"exact", report.standable_area_exact}}},
          {"faults", faults_json(scene, report)},
          {"seconds", report.seconds},
          {"passed", passes(report)}};
}

// Sums and maxima over all classes, and each class.
Json verify_json(const VerifyOptions& options, const Scene& scene,
                 const std::vector<ClassReport>& entries) {
  VerifyReport all;
  Json classes = Json::array();
  for (const ClassReport& entry : entries) {
    const VerifyReport& report = entry.report;
    if (entry.flight) all.entered += entry.flight->entered;
    all.entered += report.entered;
    all.unsupported += report.unsupported;
    all.broken += report.broken;
    all.states += report.states;
    all.moves += report.moves;
    all.surface_points += report.surface_points;
    all.seconds += report.seconds;
    all.feet_error_mean = std::max(all.feet_error_mean, report.feet_error_mean);
    all.feet_error_p95 = std::max(all.feet_error_p95, report.feet_error_p95);
    all.lost_grown = std::max(all.lost_grown, report.lost_grown);
    all.lost_exact = std::max(all.lost_exact, report.lost_exact);
    classes.push_back(class_json(scene, entry));
  }
  return {{"world", options.world},
          {"triangles", scene.triangles.size()},
          {"seed", options.config.seed},
          {"states", all.states},
          {"moves", all.moves},
          {"surface_points", all.surface_points},
          {"entered", all.entered},
          {"unsupported", all.unsupported},
          {"broken", all.broken},
          {"feet_error", {{"mean", all.feet_error_mean}, {"p95", all.feet_error_p95}}},
          {"lost", {{"grown", all.lost_grown}, {"exact", all.lost_exact}}},
          {"classes", classes},
          {"seconds", all.seconds},
          {"peak_bytes", peak_memory()},
          {"passed", passes(all)}};
}

std::string class_text(const ClassReport& entry) {
  const VerifyReport& report = entry.report;
  std::string text = fmt::format(
      "{}: {} states, {} moves, {} points of surfaces in {:.1f} s\n"
      "  entered {}, unsupported {}, broken {}\n"
      "  feet off by {:.1f} mm on average, {:.1f} mm at p95 ({} without a surface under the "
      "centre)\n"
      "  lost {:.3f} % +- {:.3f} of {:.0f} m2 for the body grown by a cell, isolated {:.3f} %\n"
      "  lost {:.3f} % +- {:.3f} of {:.0f} m2 for the body as it is, isolated {:.3f} %\n",
      entry.name, report.states, report.moves, report.surface_points, report.seconds,
      report.entered, report.unsupported, report.broken, report.feet_error_mean * 1e3,
      report.feet_error_p95 * 1e3, report.no_surface_under_centre, report.lost_grown * 100,
      report.lost_grown_error * 100, report.standable_area_grown, report.isolated_grown * 100,
      report.lost_exact * 100, report.lost_exact_error * 100, report.standable_area_exact,
      report.isolated_exact * 100);
  for (const VerifyFault& fault : report.faults) {
    text += fmt::format("  {} at {:.4f} {:.4f} {:.4f}", fault.what, fault.position.x,
                        fault.position.y, fault.position.z);
    if (fault.what == "entered") text += fmt::format(" by triangle {}", fault.triangle);
    text += '\n';
  }
  if (!entry.flight) return text;
  const FlightReport& flight = *entry.flight;
  text += fmt::format(
      "  in the air: {} points, {} of {} pairs reached over {} segments, {} bodies on them in "
      "{:.1f} "
      "s; "
      "entered {}\n",
      flight.points, flight.reached, flight.pairs, flight.segments, flight.positions,
      flight.seconds, flight.entered);
  for (const VerifyFault& fault : flight.faults) {
    text += fmt::format("  {} in the air at {:.4f} {:.4f} {:.4f} by triangle {}\n", fault.what,
                        fault.position.x, fault.position.y, fault.position.z, fault.triangle);
  }
  return text;
}

// The indices of the classes to verify.
Result<std::vector<int32_t>> pick_classes(const World& world, const std::string& name) {
  const std::vector<AvatarClass> classes = world.summary().classes;
  std::vector<int32_t> picked;
  std::string known = "all";
  for (size_t i = 0; i < classes.size(); ++i) {
    if (name == "all" || name == classes[i].name) picked.push_back(static_cast<int32_t>(i));
    known += ", " + classes[i].name;
  }
  if (!picked.empty()) return picked;
  return Error{Errc::kNotFound,
               fmt::format("--class {}: the world has no such class; choose from {}", name, known)};
}

bool passes(const NodeVerifyReport& report) {
  return report.entered + report.unsupported + report.steeper + report.lower + report.one_way == 0;
}

bool passes(const AirLinkReport& report) {
  return report.blocked + report.entered + report.one_way + report.sinks == 0;
}

std::string fault_lines(const std::vector<VerifyFault>& faults) {
  std::string text;
  for (const VerifyFault& fault : faults) {
    text += fmt::format("  {} at {:.4f} {:.4f} {:.4f}\n", fault.what, fault.position.x,
                        fault.position.y, fault.position.z);
  }
  return text;
}

Json air_links_json(const AirLinkReport& report) {
  return {{"links", report.links},     {"places", report.places},   {"blocked", report.blocked},
          {"entered", report.entered}, {"one_way", report.one_way}, {"sinks", report.sinks},
          {"seconds", report.seconds}};
}

std::string air_links_text(const AirLinkReport& report) {
  return fmt::format(
             "  to the air: {} links, {} places that take off in {:.1f} s; blocked {}, entered {}, "
             "one-way {}, sinks {}\n",
             report.links, report.places, report.seconds, report.blocked, report.entered,
             report.one_way, report.sinks) +
         fault_lines(report.faults);
}

// Prints the classes and the verdict. Returns the exit code.
int print_verdict(Session& session, const VerifyOptions& options, const Json& classes, bool passed,
                  std::string text) {
  text += passed ? "passed\n" : "NOT passed\n";
  print_result(session,
               {{"world", options.world},
                {"seed", options.config.seed},
                {"classes", classes},
                {"passed", passed}},
               text);
  return passed ? kDone : kAnswerIsNo;
}

// Verifies the nodes of a world instead of its level tiles.
int verify_all_nodes(Session& session, VerifyOptions& options, const std::vector<int32_t>& picked,
                     const Scene& scene) {
  const Result<Nodes> nodes = Nodes::open(options.world);
  if (!nodes) return fail(nodes.error());
  if (auto ok = nodes->check_all(); !ok) return fail(ok.error());
  std::optional<AirLinks> links;
  if (AirLinks::exist(nodes->world())) {
    auto opened = AirLinks::open(*nodes);
    if (!opened) return fail(opened.error());
    links = *std::move(opened);
  }
  const std::vector<AvatarClass> classes = nodes->summary().classes;
  Json list = Json::array();
  std::string text;
  bool passed = true;
  for (const int32_t index : picked) {
    options.config.avatar_class = index;
    const auto report = verify_nodes(*nodes, scene, options.config, session.context);
    if (!report) return fail(report.error());
    const std::string& name = classes[static_cast<size_t>(index)].name;
    passed = passed && passes(*report);
    list.push_back({{"class", name},
                    {"places", report->places},
                    {"arcs", report->arcs},
                    {"links_over_holes", report->hole_links},
                    {"entered", report->entered},
                    {"unsupported", report->unsupported},
                    {"steeper", report->steeper},
                    {"lower", report->lower},
                    {"one_way", report->one_way},
                    {"seconds", report->seconds}});
    text += fmt::format(
        "{}: {} places on nodes, {} arcs, {} links over holes in {:.1f} s\n"
        "  entered {}, unsupported {}, steeper {}, lower {}, one-way {}\n",
        name, report->places, report->arcs, report->hole_links, report->seconds, report->entered,
        report->unsupported, report->steeper, report->lower, report->one_way);
    text += fault_lines(report->faults);
    if (!links || !classes[static_cast<size_t>(index)].flies) continue;
    const auto air = verify_air_links(*links, *nodes, scene, options.config, session.context);
    if (!air) return fail(air.error());
    passed = passed && passes(*air);
    list.back()["air_links"] = air_links_json(*air);
    text += air_links_text(*air);
  }
  return print_verdict(session, options, list, passed, std::move(text));
}

bool passes(const NodePathReport& report) {
  return report.entered + report.unsupported + report.broken + report.disagree == 0;
}

bool passes(const PathReport& report) {
  return report.illegal + report.entered + report.unsupported + report.broken + report.disagree ==
         0;
}

// The verified paths of a class.
struct ClassPaths {
  Json json;
  std::string text;
  bool passed = false;
};

// Adds the keys that paths over nodes and over level tiles share.
template <class Report>
Json with_sums(Json json, const Report& report) {
  json.update({{"entered", report.entered},
               {"unsupported", report.unsupported},
               {"broken", report.broken},
               {"disagree", report.disagree},
               {"length", report.length},
               {"straight", report.straight},
               {"search_seconds", report.search_seconds},
               {"make_seconds", report.make_seconds},
               {"finder_bytes", report.finder_bytes},
               {"seconds", report.seconds}});
  return json;
}

ClassPaths paths_of(const std::string& name, const NodePathReport& report) {
  Json kinds = Json::object();
  for (uint8_t k = 0; k < kLinkKinds; ++k) {
    if (report.links_of_kind[k] != 0) {
      kinds[word_for(static_cast<LinkKind>(k))] = report.links_of_kind[k];
    }
  }
  return {
      with_sums({{"class", name},
                 {"over", "nodes"},
                 {"pairs", report.pairs},
                 {"reached", report.reached},
                 {"disconnected", report.disconnected},
                 {"blocked", report.blocked},
                 {"segments", report.segments},
                 {"links", kinds},
                 {"links_over_holes", report.hole_links},
                 {"poses", report.poses}},
                report),
      fmt::format(
          "{}, over nodes: {} pairs, {} reached, {} in different components, {} disconnected by "
          "--block; {} segments, {} links over holes, {} bodies on them in {:.1f} s\n"
          "  entered {}, unsupported {}, broken {}, against the components {}\n",
          name, report.pairs, report.reached, report.disconnected, report.blocked, report.segments,
          report.hole_links, report.poses, report.seconds, report.entered, report.unsupported,
          report.broken, report.disagree) +
          fault_lines(report.faults),
      passes(report)};
}

ClassPaths paths_of(const std::string& name, const PathReport& report) {
  return {
      with_sums({{"class", name},
                 {"over", "level tiles"},
                 {"pairs", report.pairs},
                 {"reached", report.reached},
                 {"disconnected", report.disconnected},
                 {"segments", report.segments},
                 {"bodies", report.bodies},
                 {"illegal", report.illegal}},
                report),
      fmt::format(
          "{}: {} pairs, {} reached, {} in different components; {} segments, {} bodies on them in "
          "{:.1f} s\n"
          "  illegal {}, entered {}, unsupported {}, broken {}, against the components {}\n",
          name, report.pairs, report.reached, report.disconnected, report.segments, report.bodies,
          report.seconds, report.illegal, report.entered, report.unsupported, report.broken,
          report.disagree) +
          fault_lines(report.faults),
      passes(report)};
}

// Verifies paths between random places: over nodes for classes that climb or drop and with --nodes,
// else over level tiles.
int verify_all_paths(Session& session, VerifyOptions& options, const World& world,
                     const std::vector<int32_t>& picked, const Scene& scene) {
  std::optional<Nodes> nodes;
  Json list = Json::array();
  std::string text;
  bool passed = true;
  const std::vector<AvatarClass> classes = world.summary().classes;
  for (const int32_t index : picked) {
    const AvatarClass& avatar = classes[static_cast<size_t>(index)];
    options.config.avatar_class = index;
    const auto over_nodes = [&]() -> Result<ClassPaths> {
      if (!nodes) {
        auto opened = Nodes::open(options.world);
        if (!opened) return opened.error();
        nodes = *std::move(opened);
      }
      const auto report = verify_node_paths(*nodes, scene, options.config, session.context);
      if (!report) return report.error();
      return paths_of(avatar.name, *report);
    };
    const auto over_tiles = [&]() -> Result<ClassPaths> {
      const auto report = verify_paths(world, scene, options.config, session.context);
      if (!report) return report.error();
      return paths_of(avatar.name, *report);
    };
    const bool on_nodes = options.nodes || avatar.climb_slope > 0 || avatar.max_drop > 0;
    if (!on_nodes && !options.blocks.empty()) {
      return fail(
          {Errc::kBadConfig,
           fmt::format("--block is for paths over nodes: add --nodes, or name a --class that "
                       "climbs or drops; {} does not",
                       avatar.name)});
    }
    auto report = on_nodes ? over_nodes() : over_tiles();
    if (!report) return fail(report.error());
    list.push_back(std::move(report->json));
    text += report->text;
    passed = passed && report->passed;
  }
  return print_verdict(session, options, list, passed, std::move(text));
}

int verify(Session& session, VerifyOptions& options) {
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
  const Result<std::vector<int32_t>> picked = pick_classes(*world, options.class_name);
  if (!picked) return fail(picked.error());
  const Result<Scene> scene = read_sources(options.sources, session.context);
  if (!scene) return fail(scene.error());
  note_if_elsewhere(*scene, world->summary().bounds);
  if (!options.paths && !options.blocks.empty()) {
    return fail({Errc::kBadConfig, "--block is for paths: add --paths"});
  }
  const auto boxes = boxes_of(options.blocks);
  if (!boxes) return fail(boxes.error());
  options.config.obstacles = *boxes;
  if (options.paths) return verify_all_paths(session, options, *world, *picked, *scene);
  if (options.nodes) return verify_all_nodes(session, options, *picked, *scene);

  const std::vector<AvatarClass> classes = world->summary().classes;
  std::vector<ClassReport> entries;
  std::string text;
  bool passed = true;
  for (const int32_t index : *picked) {
    options.config.avatar_class = index;
    Result<VerifyReport> report = verify_world(*world, *scene, options.config, session.context);
    if (!report) return fail(report.error());
    const AvatarClass& avatar = classes[static_cast<size_t>(index)];
    entries.push_back({avatar.name, *std::move(report), std::nullopt});
    if (avatar.flies) {
      Result<FlightReport> flight = verify_flight(*world, *scene, options.config, session.context);
      if (!flight) return fail(flight.error());
      entries.back().flight = *std::move(flight);
      passed = passed && entries.back().flight->entered == 0;
    }
    text += class_text(entries.back());
    passed = passed && passes(entries.back().report);
  }
  text += passed ? "passed\n" : "NOT passed\n";
  print_result(session, verify_json(options, *scene, entries), text);
  return passed ? kDone : kAnswerIsNo;
}

}  // namespace

void add_verify(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "verify", "Test a baked world against its source triangles",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng verify garage.throng --source builtin:garage --samples 20000\n"
                  "throng verify garage.throng --source builtin:garage --paths --samples 1000");
  const auto options = std::make_shared<VerifyOptions>();
  command->add_option("world", options->world, "World folder")->required()->type_name("WORLD");
  add_source_options(command, options->sources, "--source");
  command
      ->add_option("--samples", options->config.samples,
                   "States per class, and as many moves and points of surfaces")
      ->capture_default_str();
  command->add_option("--seed", options->config.seed, "Seed of the samples")->capture_default_str();
  command->add_option("--class", options->class_name, "Avatar class by name, or all")
      ->capture_default_str();
  command->add_flag("--nodes", options->nodes, "Test the world's nodes, not its level tiles");
  command->add_flag(
      "--paths", options->paths,
      "Test the paths between as many pairs of places; over nodes for classes that climb or "
      "drop, or with --nodes");
  add_blocks(command, options->blocks);
  add_threads(*command, options->config.workers);
  command->callback([&session, options] { session.exit_code = verify(session, *options); });
}

}  // namespace throng::app
