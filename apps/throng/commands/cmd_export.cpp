// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <string>

#include "command.h"
#include "throng/bake.h"
#include "throng/world.h"

// throng export: the walkable surface of a class as a model for other programs.
namespace throng::app {
namespace {

struct ExportOptions {
  std::string world;
  std::string avatar_class = "adult";
  std::string output;
};

int export_surface(Session& session, const ExportOptions& options) {
  const bool obj = options.output.ends_with(".obj");
  if (!obj && !options.output.ends_with(".glb")) {
    return fail(
        {Errc::kBadConfig, options.output + ": not a name of a model; end it with .glb or .obj"});
  }
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
  const Result<int32_t> avatar_class = class_named(*world, options.avatar_class);
  if (!avatar_class) return fail(avatar_class.error());
  const AvatarClass avatar = world->summary().classes[static_cast<size_t>(*avatar_class)];
  const Result<Scene> surface = walkable_surface(*world, *avatar_class, session.context);
  if (!surface) return fail(surface.error());
  if (surface->triangles.empty()) {
    print_result(session, {{"world", options.world}, {"triangles", 0}},
                 fmt::format("{}: class {} can stand nowhere, so nothing is written\n",
                             options.world, options.avatar_class));
    return kAnswerIsNo;
  }
  const Result<void> written =
      obj ? write_obj(*surface, options.output) : write_glb(*surface, options.output);
  if (!written) return fail(written.error());
  print_result(session,
               {{"world", options.world},
                {"class", options.avatar_class},
                {"output", options.output},
                {"goes_over_nodes", goes_over_nodes(avatar)},
                {"triangles", surface->triangles.size()},
                {"storeys", surface->parts.size()}},
               fmt::format("{}: {} triangles of floor for {}, {} storeys\n", options.output,
                           surface->triangles.size(), options.avatar_class, surface->parts.size()) +
                   note_of_nodes(avatar));
  return kDone;
}

}  // namespace

void add_export(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "export",
                                  "Write where a class can stand as a model (GLB or OBJ)",
                                  "throng bake builtin:garage -o garage.throng\n"
                                  "throng export garage.throng --class adult -o floors.glb");
  const auto options = std::make_shared<ExportOptions>();
  command->add_option("world", options->world, "World folder")->required()->type_name("WORLD");
  command->add_option("--class", options->avatar_class, "Avatar class by name")
      ->capture_default_str();
  add_output(*command, session, "-o,--output", options->output, "File to write")
      ->required()
      ->type_name("GLB|OBJ");
  command->callback([&session, options] { session.exit_code = export_surface(session, *options); });
}

}  // namespace throng::app
