// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <utility>

#include "avatars_csv.h"
#include "command.h"
#include "throng/picture.h"

// throng picture: a baked world, and a crowd in it, on one sheet.
namespace throng::app {
namespace {

struct PictureOptions {
  std::string world;
  std::string output;
  std::string avatars;
  std::string avatar_class;
  std::string storey = "all";
  PictureConfig config;
};

int picture(Session& session, PictureOptions& options) {
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
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
  const Result<Image> image = draw_world(*world, avatars, options.config);
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
                                  "throng picture garage.throng -o garage.png");
  const auto options = std::make_shared<PictureOptions>();
  command->add_option("world", options->world, "World folder")
      ->required()
      ->type_name("WORLD.throng");
  command->add_option("-o,--output", options->output, "PNG file to write")
      ->required()
      ->type_name("FILE.png");
  command->add_option("--storey,--level", options->storey, "One storey, or all")
      ->type_name("K|all")
      ->capture_default_str();
  command->add_option("--avatars", options->avatars, "Trajectories; the last step is drawn")
      ->type_name("FILE.csv");
  command->add_option("--class", options->avatar_class, "Whose floors to show")->type_name("NAME");
  command->add_option("--width", options->config.width, "Width of the picture [px]")
      ->capture_default_str();
  command->add_option("--title", options->config.title, "Title; the folder's name if not given");
  command->callback([&session, options] { session.exit_code = picture(session, *options); });
}

}  // namespace throng::app
