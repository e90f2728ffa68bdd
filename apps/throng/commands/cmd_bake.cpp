// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "command.h"
#include "input_file.h"
#include "number_checks.h"
#include "run/memory_bound.h"
#include "scene_hints.h"
#include "sources.h"
#include "throng/bake.h"
#include "throng/surface.h"

// throng bake: turns models into a folder of zone files.
namespace throng::app {
namespace {

struct BakeOptions {
  SourceOptions sources;
  std::string output;
  std::string classes;
  std::vector<double> part;  // --part: x0, z0, x1, z1
  MemoryBound memory;
  bool coarse = false;
  bool rebuild = false;
  bool nodes = false;
  std::string off_mesh_links;
  bool fly = false;
  BakeConfig config;
  NodeConfig node_config;
  uint64_t node_memory = node_config.working_bytes >> 20;  // [MiB]
};

// Of the world's zones, while nodes are made.
constexpr uint64_t kResidentBytes = uint64_t{256} << 20;

// Nodes are made on request, and if a class climbs or drops: it moves over nodes alone.
bool wants_nodes(const BakeOptions& options) {
  return options.nodes || !options.off_mesh_links.empty() ||
         std::any_of(options.config.classes.begin(), options.config.classes.end(),
                     [](const AvatarClass& avatar) { return goes_over_nodes(avatar); });
}

bool read_point(const Json& entry, const char* key, Vec3d& out) {
  if (!entry.is_object() || !entry.contains(key)) return false;
  const Json& p = entry[key];
  const auto is_number = [](const Json& number) { return number.is_number(); };
  if (!p.is_array() || p.size() != 3 || !std::all_of(p.begin(), p.end(), is_number)) return false;
  out = {p[0].get<double>(), p[1].get<double>(), p[2].get<double>()};
  return true;
}

// Off-mesh links from a file: [{"from": [x, y, z], "to": [x, y, z], "class": NAME, "two_way":
// false}].
Result<std::vector<NodeOffMeshLink>> read_off_mesh_links(const std::string& name,
                                                         const std::vector<AvatarClass>& classes) {
  const auto text = read_file(name, "give --off-mesh-links a list of links in JSON");
  if (!text) return text.error();
  const Json json = Json::parse(*text, nullptr, false);
  if (!json.is_array()) {
    return Error{
        Errc::kBadFile,
        name +
            ": is no list of off-mesh links in JSON, as [{\"from\": [0, 0, 0], \"to\": [3, 0, 0], "
            "\"class\": \"adult\", \"two_way\": true}]"};
  }
  std::vector<NodeOffMeshLink> links;
  for (const Json& entry : json) {
    const auto bad = [&](const std::string& what) {
      return Error{Errc::kBadFile,
                   fmt::format("{}: off-mesh link {}: {}", name, links.size() + 1, what)};
    };
    NodeOffMeshLink link;
    if (!read_point(entry, "from", link.from) || !read_point(entry, "to", link.to)) {
      return bad("needs \"from\" and \"to\", three numbers each");
    }
    if (!entry.contains("class") || !entry["class"].is_string()) return bad("needs a \"class\"");
    const auto wanted = entry["class"].get<std::string>();
    const auto of = std::find_if(classes.begin(), classes.end(),
                                 [&](const AvatarClass& avatar) { return avatar.name == wanted; });
    if (of == classes.end()) {
      std::string known;
      for (const AvatarClass& avatar : classes) known += (known.empty() ? "" : ", ") + avatar.name;
      return bad(fmt::format("there is no class {}; choose from {}", wanted, known));
    }
    link.avatar_class = static_cast<int32_t>(of - classes.begin());
    for (const char* key : {"both_ways", "two_way"}) {  // The first is the name of before.
      if (!entry.contains(key)) continue;
      if (!entry[key].is_boolean()) return bad(fmt::format("{} must be true or false", key));
      link.two_way = entry[key].get<bool>();
    }
    links.push_back(link);
  }
  return links;
}

template <class AnyScene>
Result<NodeSummary> bake_nodes(BakeOptions& options, const AnyScene& scene, Context& context) {
  const uint64_t resident = options.memory ? options.memory.bytes / 8 : kResidentBytes;
  const Result<World> world = World::open(options.output, {.resident_bytes = resident});
  const auto opened = meet_over_ranks(world ? Result<void>() : world.error(), context);
  if (!opened) return opened.error();
  return nodes_over_ranks(*world, scene, options.node_config, context);
}

// What is said of the models.
struct Models {
  SceneFacts facts;
  std::vector<std::string> hints;
};

Models models_of(const Scene& scene) {
  return {.facts = {.bounds = scene.bounds(),
                    .triangles = scene.triangles.size(),
                    .patches = scene.patches.size(),
                    .report = scene.report},
          .hints = scene_hints(scene)};
}

Json bake_json(const BakeOptions& options, const Models& models, const BakeReport& report,
               uint64_t peak_read) {
  Json areas = Json::object();
  for (size_t i = 0; i < report.walkable_area.size(); ++i) {
    areas[options.config.classes[i].name] = report.walkable_area[i];
  }
  return {{"world", options.output},
          {"triangles", models.facts.triangles},
          {"patches", models.facts.patches},
          {"import", report_json(models.facts.report)},
          {"hints", models.hints},
          {"cell", options.config.cell},
          {"resolution", options.config.resolution},
          {"zones", report.zones},
          {"zones_baked", report.zones_baked},
          {"zones_reused", report.zones_reused},
          {"zones_empty", report.zones_empty},
          {"zones_relinked", report.zones_relinked},
          {"tiles", report.tiles},
          {"level_tiles", report.level_tiles},
          {"constant_level_tiles", report.constant_level_tiles},
          {"spans", report.spans},
          {"bytes", report.bytes},
          {"walkable_area", areas},
          {"graph_bytes", report.graph_bytes},
          {"seconds_graph", report.seconds_graph},
          {"air_zones", report.air_zones},
          {"air_zones_reused", report.air_zones_reused},
          {"air_bytes", report.air_bytes},
          {"seconds_air", report.seconds_air},
          {"seconds_columns", report.seconds_columns},
          {"seconds_levels", report.seconds_levels},
          {"seconds_clearance", report.seconds_clearance},
          {"seconds_write", report.seconds_write},
          {"seconds_total", report.seconds_total},
          {"peak_bytes_read", peak_read},  // Before the bake began: the scene and its reader.
          {"peak_bytes", peak_memory()}};
}

bool stands_nowhere(const BakeReport& report) {
  return std::all_of(report.walkable_area.begin(), report.walkable_area.end(),
                     [](double area) { return area == 0; });
}

std::string bake_text(const BakeOptions& options, const Models& models, const BakeReport& report) {
  std::string text = fmt::format("{}: {} in {:.2f} s, {} ({} reused), {} ({} of them flat), {}\n",
                                 options.output, counted(models.facts.triangles, "triangle"),
                                 report.seconds_total, counted(report.zones, "zone"),
                                 report.zones_reused, counted(report.level_tiles, "level tile"),
                                 report.constant_level_tiles, human_bytes(report.bytes));
  text += fmt::format("  {}\n", size_text(models.facts.bounds));
  for (size_t i = 0; i < report.walkable_area.size(); ++i) {
    text += fmt::format("  {:<12} {:12.1f} m2 walkable\n", options.config.classes[i].name,
                        report.walkable_area[i]);
  }
  if (report.air_zones == 0 && stands_nowhere(report)) {
    text += fmt::format(
        "  no class can stand anywhere: check the unit (--scale), the up axis (--up) and "
        "the classes (--classes){}\n",
        options.config.one_sided ? ", and whether all triangles are wound backwards (--one-sided)"
                                 : "");
  }
  for (const std::string& hint : models.hints) text += fmt::format("  {}\n", hint);
  if (report.air_zones > 0) {
    text += fmt::format("  air over {} ({} reused), {}, in {:.2f} s of the above\n",
                        counted(report.air_zones, "zone"), report.air_zones_reused,
                        human_bytes(report.air_bytes), report.seconds_air);
  }
  return text;
}

// Reads the files of options other than the models. It runs before the bake, which replaces the old
// world: an error found later would leave a world without nodes.
Result<void> prepare(BakeOptions& options) {
  if (!options.classes.empty()) {
    Result<std::vector<AvatarClass>> classes = load_classes(options.classes);
    if (!classes) return classes.error();
    for (const AvatarClass& avatar : *classes) {
      if (avatar.name != "all") continue;
      return Error{Errc::kBadFile, options.classes +
                                       ": a class is named all, which stands for every class in "
                                       "--class; give it another name"};
    }
    options.config.classes = *std::move(classes);
  }
  if (options.fly) options.config.classes.push_back(flyer_class());
  options.config.fine = !options.coarse;
  if (options.rebuild) options.config.old_zones = OldZones::kBakeAgain;
  if (!options.part.empty()) options.config.part = box_of_part(options.part);
  options.config.carry_nodes = options.config.part.has_value();
  if (options.config.part && options.rebuild) {
    return Error{
        Errc::kBadConfig,
        "--rebuild: bakes all zones again, and a part keeps those beside it; leave one out"};
  }
  if (!wants_nodes(options)) return {};
  if (options.config.part) {
    return Error{Errc::kBadConfig,
                 "--part: nodes are made of whole worlds; bake all parts without --nodes and "
                 "classes that climb or drop, then the whole with them"};
  }
  options.node_config.workers = options.config.workers;
  options.node_config.working_bytes = options.node_memory << 20;
  options.node_config.rebuild = options.rebuild;
  options.config.carry_nodes = !options.rebuild;
  if (!options.off_mesh_links.empty()) {
    Result<std::vector<NodeOffMeshLink>> off_mesh_links =
        read_off_mesh_links(options.off_mesh_links, options.config.classes);
    if (!off_mesh_links) return off_mesh_links.error();
    options.node_config.off_mesh_links = *std::move(off_mesh_links);
  }
  options.config.nodes = &options.node_config;
  return check_node_config(options.node_config);
}

// The state of the world if making its nodes failed.
std::string after_the_ground(const std::string& path) {
  const auto world = World::open(path);
  return world && Nodes::open(*world) ? "; the ground has not changed, and its nodes are the old "
                                        "ones"
                                      : "; the world is baked, but it has no nodes yet";
}

int fail_after_ground(const BakeOptions& options, const Error& error) {
  const std::string& what = error.message;  // Empty: another rank says it.
  return fail({error.code, what.empty() ? "" : what + after_the_ground(options.output)});
}

void add_nodes(const NodeSummary& nodes, Json& json, std::string& text) {
  json["node_zones_made"] = nodes.zones_made;
  json["node_zones_reused"] = nodes.zones_reused;
  json["nodes"] = nodes.nodes;
  json["node_arcs"] = nodes.arcs;
  json["node_bytes"] = nodes.bytes;
  json["seconds_nodes"] = nodes.seconds;
  json["peak_bytes"] = peak_memory();
  text +=
      fmt::format("  {}, {} in {:.2f} s, {}, over {} ({} reused)\n", counted(nodes.nodes, "node"),
                  counted(nodes.arcs, "arc"), nodes.seconds, human_bytes(nodes.bytes),
                  counted(nodes.zones_made + nodes.zones_reused, "zone"), nodes.zones_reused);
}

// What the ranks have in common, whether each holds the scene or only parts of it.
template <class AnyScene>
int bake_scene(Session& session, BakeOptions& options, const AnyScene& scene,
               const Models& models) {
  const uint64_t peak_read = peak_memory();
  const Result<BakeReport> report =
      bake_over_ranks(options.output, scene, options.config, session.context);
  const bool nodes_follow = wants_nodes(options);
  if (nodes_follow) {
    // Rank 0 still puts the world into its place when the others have parted.
    const auto baked = meet_over_ranks(report ? Result<void>() : report.error(), session.context);
    if (!baked) return fail(report ? baked.error() : report.error());
  }
  if (!report) return fail(report.error());
  std::optional<NodeSummary> nodes;
  if (nodes_follow) {
    const Result<NodeSummary> made = bake_nodes(options, scene, session.context);
    if (!made) return fail_after_ground(options, made.error());
    nodes = *made;
  }
  if (rank_info().rank > 0) return kDone;
  Json json = bake_json(options, models, *report, peak_read);
  std::string text = bake_text(options, models, *report);
  if (nodes) add_nodes(*nodes, json, text);
  print_result(session, json, text);
  return kDone;
}

// With --memory.
int bake_by_block(Session& session, BakeOptions& options) {
  options.config.block_bytes = options.memory.blocks();
  options.node_config.working_bytes =
      std::min(options.node_config.working_bytes, options.memory.nodes());
  // Beside the world, not in it.
  std::string output = options.output;
  while (output.size() > 1 && (output.back() == '/' || output.back() == '\\')) output.pop_back();
  const auto folder = std::filesystem::path(output).parent_path();
  const auto scene = read_regions(options.sources, folder.string(), session.context);
  const auto read = agree_over_ranks(scene ? Result<void>() : scene.error());
  if (!read) return fail(read.error());
  return bake_scene(session, options, **scene, {.facts = (*scene)->facts(), .hints = {}});
}

int bake(Session& session, BakeOptions& options) {
  const auto ready = agree_over_ranks(prepare(options));
  if (!ready) return fail(ready.error());
  if (options.memory) return bake_by_block(session, options);
  const Result<Scene> scene = read_sources(options.sources, session.context);
  const auto read = agree_over_ranks(scene ? Result<void>() : scene.error());
  if (!read) return fail(read.error());
  return bake_scene(session, options, *scene, models_of(*scene));
}

}  // namespace

void add_bake(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "bake", "Turn models into a walkable world",
                                  "throng bake builtin:garage -o garage.throng");
  const auto options = std::make_shared<BakeOptions>();
  add_source_options(command, options->sources);
  BakeConfig& config = options->config;
  command->add_option("-o,--output", options->output, "World folder to write")
      ->required()
      ->type_name("WORLD.throng");
  command->add_option("--cell", config.cell, "Side of a cell [m]")->capture_default_str();
  command->add_flag("--fly", options->fly, "Add the class flyer, an adult with wings");
  command
      ->add_option(
          "--air", config.air,
          "Side of a voxel of the air: 1, 2, 4, 8 or 16 cells; 0: none unless a class flies [m]")
      ->capture_default_str();
  command
      ->add_option("--resolution", config.resolution,
                   "Headroom that `throng verify` allows the bake to lose; the ground is the same "
                   "for any [m]")
      ->capture_default_str();
  add_part(*command, options->part,
           "Bake a district alone, by two opposite corners as seen from above; zones beside it are "
           "kept as the folder has them [m]");
  command->add_option("--zone", config.zone, "Side of a zone [m]")->capture_default_str();
  command->add_option("--classes", options->classes, "Avatar classes (TOML or JSON)")
      ->type_name("FILE");
  add_memory(*command, options->memory,
             "Approximate max memory: models are read and baked district by district; none: as "
             "much as the models take [MiB]");
  add_threads(*command, config.workers,
              "Threads, 0 for all cores (under mpirun: of each rank, and its share)");
  command->add_flag("--coarse", options->coarse,
                    "Solids as whole cells: faster, loses up to a cell beside walls");
  command->add_flag("--one-sided", config.one_sided,
                    "Trust windings: only triangles that face up are floor");
  command->add_flag("--rebuild", options->rebuild,
                    "Bake all zones, also those that have not changed");
  command->add_flag("--nodes", options->nodes,
                    "Also make nodes and links; always done where a class climbs or drops, "
                    "and with --off-mesh-links");
  command
      ->add_option("--off-mesh-links", options->off_mesh_links,
                   "Off-mesh links given by hand (JSON); implies --nodes")
      ->type_name("FILE.json");
  command
      ->add_option("--node-size", options->node_config.size,
                   "Finest sub-patches of curved patches [m]")
      ->capture_default_str();
  command
      ->add_option("--node-memory", options->node_memory,
                   "Approximate max memory while nodes are made; less is slower [MiB]")
      ->capture_default_str()
      ->check(between(1, 1 << 20));
  command->callback([&session, options] { session.exit_code = bake(session, *options); });
}

}  // namespace throng::app
