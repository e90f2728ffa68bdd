// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "command.h"
#include "number_checks.h"
#include "throng/scene.h"

// throng generate: writes a built-in world as a GLB file.
namespace throng::app {
namespace {

struct GenerateOptions {
  BuiltinWorldConfig config;
  std::string output;
  bool list = false;
};

int list_worlds(const Session& session) {
  Json worlds = Json::array();
  std::string text;
  for (const BuiltinWorldInfo& info : builtin_worlds()) {
    worlds.push_back({{"name", std::string(info.name)},
                      {"summary", std::string(info.summary)},
                      {"default_size", info.default_size},
                      {"min_size", info.min_size},
                      {"max_size", info.max_size},
                      {"default_levels", info.default_levels},
                      {"max_levels", info.max_levels},
                      {"max_triangles", info.max_triangles}});
    text += fmt::format("{:<11} {:>6} m  {}\n", info.name, info.default_size, info.summary);
  }
  print_result(session, {{"worlds", worlds}}, text);
  return kDone;
}

// Patches keep their neighbours in a file of their own kind; everything else is a GLB.
Result<void> write_world(const Scene& scene, const std::string& path) {
  if (!path.ends_with(".patches.json")) return write_glb(scene, path);
  if (!scene.patches.empty()) return write_patches(scene.patches, path);
  return Error{Errc::kBadConfig,
               path + ": this world has no patches; name a .glb file, or make a landscape"};
}

int generate_world(const Session& session, const GenerateOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const Result<Scene> scene = create_builtin_world(options.config);
  if (!scene) return fail(scene.error());
  const double made = seconds();
  if (session.context.cancel)
    return fail({Errc::kCancelled, "generate: stopped; nothing was written"});
  const Result<void> written = write_world(*scene, options.output);
  if (!written) return fail(written.error());

  const Box3d box = scene->bounds();
  const Vec3d size = box.max - box.min;
  const Json json = {{"world", options.config.name},
                     {"file", options.output},
                     {"triangles", scene->triangles.size()},
                     {"vertices", scene->positions.size()},
                     {"parts", scene->parts.size()},
                     {"patches", scene->patches.size()},
                     {"min", {box.min.x, box.min.y, box.min.z}},
                     {"max", {box.max.x, box.max.y, box.max.z}},
                     {"extent", {size.x, size.y, size.z}},
                     {"seconds_make", made},
                     {"seconds", seconds()},
                     {"peak_memory", peak_memory()}};
  print_result(
      session, json,
      fmt::format("{}: {} triangles, {} vertices, {:.2f} x {:.2f} m, {:.2f} m high, {:.1f} s\n",
                  options.output, scene->triangles.size(), scene->positions.size(), size.x, size.z,
                  size.y, seconds()));
  return kDone;
}

}  // namespace

void add_generate(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "generate", "Write a built-in world as a GLB file",
                  "throng generate --list\n"
                  "throng generate garage --size 120 --levels 4 -o garage.glb\n"
                  "throng generate landscape --seed 3 -o hills.patches.json");
  const auto options = std::make_shared<GenerateOptions>();
  BuiltinWorldConfig& config = options->config;
  config.name.clear();
  auto* list = command->add_flag("--list", options->list, "Name the built-in worlds and stop");
  command->add_option("name", config.name, "One of the names that --list shows")->type_name("NAME");
  command->add_option("--size", config.size, "Side of the footprint [m]; 0: the world's own")
      ->type_name("M");
  command->add_option("--levels", config.levels, "Storeys, where the world has storeys")
      ->type_name("N");
  command
      ->add_option("--triangles", config.triangles,
                   "Grow the world to about this many (powerplant, city); exactly so many (blocks)")
      ->check(at_least(0))
      ->type_name("N");
  command->add_option("--seed", config.seed, "Another seed, another world")
      ->check(at_least(0))
      ->type_name("S");
  auto* output = add_output(*command, session, "-o,--output", options->output,
                            "File to write; .patches.json keeps a landscape curved")
                     ->type_name("GLB");
  list->excludes(output);
  command->callback([&session, options] {
    if (options->list) {
      session.exit_code = list_worlds(session);
    } else if (options->config.name.empty() || options->output.empty()) {
      session.exit_code = fail(
          {Errc::kBadConfig,
           "generate: name the world and the file: throng generate NAME -o FILE.glb, or --list"});
    } else {
      session.exit_code = generate_world(session, *options);
    }
  });
}

}  // namespace throng::app
