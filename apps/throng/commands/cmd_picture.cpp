// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "command.h"
#include "input_file.h"
#include "number_checks.h"
#include "report/avatars_csv.h"
#include "report/scene_picture.h"
#include "throng/picture.h"
#include "throng/surface.h"

// throng picture: a baked world, and a crowd in it, drawn from above as one PNG.
namespace throng::app {
namespace {

struct PictureOptions {
  std::string world;
  std::string output;
  std::string avatars;
  std::string avatar_class;
  std::string storey = "all";
  std::string path;
  std::vector<double> area;
  bool nodes = false;
  ScenePictureOptions scene;
  PictureConfig config;
  NodePictureConfig node_config;
};

// The points of a path that `throng path --json` printed.
Result<std::vector<Vec3d>> read_path(const std::string& name) {
  const auto bad = [&](const char* what) { return Error{Errc::kBadFile, name + ": " + what}; };
  const auto text = read_file(name, "write it with `throng path ... --json`");
  if (!text) return text.error();
  const Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("points") || !json["points"].is_array()) {
    return bad("has no points; write it with `throng path ... --json`");
  }
  std::vector<Vec3d> points;
  for (const Json& p : json["points"]) {
    const bool sound =
        p.is_array() && p.size() == 3 && p[0].is_number() && p[1].is_number() && p[2].is_number();
    if (!sound) return bad("a point is not three numbers");
    points.push_back({p[0].get<double>(), p[1].get<double>(), p[2].get<double>()});
  }
  return points;
}

Result<Image> draw_all_nodes(PictureOptions& options) {
  const Result<Nodes> nodes = Nodes::open(options.world);
  if (!nodes) return nodes.error();
  NodePictureConfig& config = options.node_config;
  config.width = options.config.width;
  config.storey = options.config.storey;
  if (!options.avatar_class.empty()) config.avatar_class = options.config.avatar_class;
  config.title = options.config.title;
  if (!options.area.empty()) {
    config.area.add({options.area[0], 0, options.area[1]});
    config.area.add({options.area[2], 0, options.area[3]});
  }
  config.path = options.config.path;
  return draw_nodes(*nodes, config);
}

int picture(Session& session, PictureOptions& options) {
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
  if (auto ok = world->check_ground(); !ok) return fail(ok.error());
  const auto is_storey = [&] {
    const std::string& text = options.storey;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), options.config.storey);
    return error == std::errc() && end == text.data() + text.size() && options.config.storey >= 0;
  };
  if (options.storey != "all" && !is_storey()) {
    return fail({Errc::kBadConfig,
                 fmt::format("--storey {}: write a number from 0 up, or all", options.storey)});
  }
  if (!options.avatar_class.empty()) {
    const Result<int32_t> index = class_named(*world, options.avatar_class);
    if (!index) return fail(index.error());
    options.config.avatar_class = *index;
  }
  if (!options.scene.camera.empty()) {
    options.scene.avatars = options.avatars;
    options.scene.avatar_class = options.config.avatar_class;
    options.scene.width = options.config.width;
    return draw_scene_picture(session, *world, options.scene, options.output);
  }
  if (options.scene.needs_camera()) {
    return fail(
        {Errc::kBadConfig,
         "--atlas, --crowd, --height, --source and --view-angle draw a view from an eye: add "
         "--camera X,Y,Z,TX,TY,TZ"});
  }
  std::vector<PictureAvatar> avatars;
  if (!options.avatars.empty()) {
    Result<std::vector<PictureAvatar>> read = read_avatars(options.avatars);
    if (!read) return fail(read.error());
    avatars = *std::move(read);
  }
  if (options.config.title.empty()) {
    const std::filesystem::path path(options.world);
    options.config.title = (path.has_filename() ? path : path.parent_path()).stem().string();
  }
  show_progress(session, "draw", 0, 0);
  if (!options.nodes &&
      (options.node_config.links || options.node_config.air || options.node_config.cylinders ||
       options.node_config.boxes || !options.area.empty())) {
    return fail({Errc::kBadConfig,
                 "--links, --air, --cylinders, --boxes and --area draw nodes: add --nodes"});
  }
  if (!options.path.empty()) {
    Result<std::vector<Vec3d>> read = read_path(options.path);
    if (!read) return fail(read.error());
    options.config.path = *std::move(read);
  }
  const Result<Image> image =
      options.nodes ? draw_all_nodes(options) : draw_world(*world, avatars, options.config);
  if (!image) return fail(image.error());
  if (auto done = write_png(*image, options.output); !done) return fail(done.error());
  print_result(session,
               {{"picture", options.output},
                {"width", image->width},
                {"height", image->height},
                {"avatars", avatars.size()}},
               fmt::format("{}: {} x {} pixels, {} avatars\n", options.output, image->width,
                           image->height, avatars.size()));
  return kDone;
}

}  // namespace

void add_picture(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "picture", "Draw a world and the crowd in it",
                                  "throng bake builtin:garage -o garage.throng\n"
                                  "throng picture garage.throng -o garage.png\n"
                                  "throng picture garage.throng --source builtin:garage "
                                  "--crowd 300 --camera 40,14,46,22,2,22 -o seen.png");
  const auto options = std::make_shared<PictureOptions>();
  command->add_option("world", options->world, "World folder")
      ->required()
      ->type_name("WORLD.throng");
  add_output(*command, session, "-o,--output", options->output, "PNG file to write")
      ->required()
      ->type_name("FILE.png");
  command->add_option("--storey,--level", options->storey, "One storey, or all")
      ->type_name("K|all")
      ->capture_default_str();
  command->add_option("--avatars", options->avatars, "Trajectories; the last step is drawn")
      ->type_name("FILE.csv");
  command
      ->add_option("--class", options->avatar_class,
                   "Class of the floors to draw; with --nodes: of the nodes and links")
      ->type_name("NAME");
  command->add_flag("--nodes", options->nodes, "Draw the world's nodes, by inclination");
  command->add_flag("--links", options->node_config.links, "With --nodes: also their links");
  command->add_flag("--air", options->node_config.air,
                    "With --nodes: also the links of the air, and between air and ground");
  command->add_flag("--cylinders", options->node_config.cylinders,
                    "With --nodes: also the cylinders of terminal nodes, as wide and as high as "
                    "these promise");
  command->add_flag("--boxes", options->node_config.boxes,
                    "With --nodes: also the free boxes of the air's octree");
  command->add_option("--area", options->area, "With --nodes: only this part of the ground [m]")
      ->expected(4)
      ->delimiter(',')
      ->type_name("X0,Z0,X1,Z1");
  command->add_option("--path", options->path, "A path, as `throng path --json` prints it")
      ->type_name("FILE.json");
  command->add_option("--width", options->config.width, "Width of the picture [px]")
      ->check(between(16, 16000))
      ->capture_default_str();
  command->add_option("--title", options->config.title, "Title; the folder's name if not given");
  add_scene_picture_options(command, options->scene);
  command->callback([&session, options] { session.exit_code = picture(session, *options); });
}

}  // namespace throng::app
