// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "number_checks.h"
#include "throng/picture.h"
#include "window/view_stage.h"
#include "window/view_window.h"

// throng view: a world, a scenario, a model or a recording in a window, or one picture of it.
namespace throng::app {
namespace {

struct ViewOptions {
  ViewTarget target;
  std::vector<double> camera;
  std::string picture;
  std::vector<std::string> overlays;
  int64_t pick = -1;
  std::string pictures = ".";
  double after = 4;
  bool panel = false;
  bool forget = false;
  int32_t width = 1280, height = 720;
  int32_t workers = 0;
  double seconds = 0;
};

ViewerConfig viewer_config(const ViewOptions& options) {
  return {.settings = {}, .font = panel_font(), .workers = options.workers};
}

// What [CAACD] says of the avatars that it steers.
void add_curves(Json& json, const ViewerStatus& status) {
  if (status.states.size() == 4) {
    json["states"] = {{"tolerable", status.states[0]},
                      {"alert", status.states[1]},
                      {"critical", status.states[2]},
                      {"collision", status.states[3]}};
  }
  if (!status.experiment) return;
  const caacd::Counts& counts = *status.experiment;
  json["experiment"] = {{"frames", counts.frames},
                        {"collisions", counts.collisions},
                        {"obstacle_collisions", counts.obstacle_collisions},
                        {"arrived", counts.arrived},
                        {"waiting", counts.waiting},
                        {"walked", counts.walked}};
}

// Without a window: lets `after` seconds pass in small steps, then draws.
int take_picture(Session& session, const ViewOptions& options) {
  Result<Drawing> drawing = Drawing::create();
  if (!drawing) return fail(drawing.error());
  ViewerConfig config = viewer_config(options);
  config.panel = options.panel;
  Result<Viewer> viewer = Viewer::create(*std::move(drawing), config);
  if (!viewer) return fail(viewer.error());
  const std::vector<double>& c = options.camera;
  if (!c.empty()) viewer->look_at({c[0], c[1], c[2]}, {c[3], c[4], c[5]});
  viewer->load(short_name(options.target.path), stage_of(options.target));
  viewer->wait_until_loaded();
  if (const std::string error = viewer->status().error; !error.empty()) {
    return fail({Errc::kBadFile, error});
  }
  viewer->play_for(options.after);
  viewer->pick(options.pick);
  for (const std::string& overlay : options.overlays) viewer->show_overlay(overlay);
  viewer->wait_for_overlays();
  // The panel describes the frame before: draw one ahead.
  if (options.panel) (void)viewer->picture(0, options.width, options.height);
  const Result<Image> image = viewer->picture(0, options.width, options.height);
  if (!image) return fail(image.error());
  if (auto done = write_png(*image, options.picture); !done) return fail(done.error());
  const ViewerStatus status = viewer->status();
  Json json = {{"picture", options.picture}, {"width", image->width},     {"height", image->height},
               {"time", status.time},        {"avatars", status.avatars}, {"drawn", status.drawn}};
  add_curves(json, status);
  print_result(session, json,
               fmt::format("{}: {} x {} pixels, {:.1f} s, {} of {} avatars in the picture\n",
                           options.picture, image->width, image->height, status.time, status.drawn,
                           status.avatars));
  return kDone;
}

int view(Session& session, const ViewOptions& options) {
  if (!options.picture.empty()) return take_picture(session, options);
  WindowConfig window{.width = options.width,
                      .height = options.height,
                      .remember = !options.forget,
                      .pictures = options.pictures,
                      .open = {},
                      .cancel = &session.context.cancel,
                      .seconds = options.seconds};
  window.open = [options](const std::string& path) {
    ViewTarget dropped = options.target;
    dropped.path = path;
    dropped.world.clear();
    dropped.sources = {};
    return stage_of(dropped);
  };
  const auto closed = run_window(short_name(options.target.path), stage_of(options.target),
                                 viewer_config(options), window);
  return closed ? kDone : fail(closed.error());
}

}  // namespace

void add_view(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(parser, session, "view", "Show a world and its crowd in a window",
                                  "throng bake builtin:garage -o garage.throng\n"
                                  "throng view garage.throng --source builtin:garage "
                                  "--avatars 200 --picture view.png");
  const auto options = std::make_shared<ViewOptions>();
  ViewTarget& target = options->target;
  command
      ->add_option("target", target.path,
                   "World folder, scenario, recording, or a model (or builtin:NAME) to bake now; "
                   "builtin:caacd runs the experiment of [CAACD] section V")
      ->required()
      ->type_name("WORLD|SCENARIO.toml|FILE.replay|MODEL");
  command->add_option("--avatars", target.start.avatars, "Avatars in a world")
      ->capture_default_str();
  command->add_option("--seed", target.start.seed, "Seed of all chance")->capture_default_str();
  command->add_option("--dt", target.start.dt, "Length of a step [s]")
      ->check(between(0.01, 0.5))
      ->capture_default_str();
  command->add_option("--speed", target.start.speed, "Walking speed, 0 for each class's own [m/s]")
      ->check(at_least(0));
  command->add_option("--near", target.start.near, "Max distance of goals, 0: anywhere [m]")
      ->check(at_least(0))
      ->capture_default_str();
  add_speedup(*command, "--zones", PathSpeedup::kZones, target.start.speedup,
              "Paths by zones: for large worlds");
  add_curve_options(command, target);
  add_people_options(command, target);
  command->add_option("--cell", target.cell, "Side of a cell, to bake a model with [m]")
      ->capture_default_str();
  add_source_options(command, target.sources, "--source");
  command->add_option("--camera", options->camera, "With --picture: where to look from and to [m]")
      ->expected(6)
      ->delimiter(',')
      ->type_name("X,Y,Z,TX,TY,TZ");
  add_output(*command, session, "--picture", options->picture,
             "Write a picture instead of opening a window")
      ->type_name("FILE.png");
  command->add_option("--after", options->after, "With --picture: time before it [s]")
      ->check(between(0.0, 3600.0))
      ->capture_default_str();
  command->add_option("--overlay", options->overlays, "With --picture: switch on, may be repeated")
      ->check(CLI::IsMember(Viewer::overlay_names(), CLI::ignore_case))
      ->allow_extra_args(false);
  command->add_option("--pick", options->pick, "With --picture: the avatar picked")
      ->type_name("ID");
  command->add_flag("--panel", options->panel, "With --picture: the panel, too");
  command->add_option("--width", options->width, "Of the window or picture [px]")
      ->check(between(160, 8192))
      ->capture_default_str();
  command->add_option("--height", options->height, "Of the window or picture [px]")
      ->check(between(120, 8192))
      ->capture_default_str();
  add_threads(*command, options->workers);
  add_image_folder(*command, session, "--pictures", options->pictures, "throng-",
                   "Folder for the pictures that F12 keeps");
  command->add_flag("--forget", options->forget, "Neither read nor keep settings");
  command->add_option("--seconds", options->seconds, "Close the window after so long [s]")
      ->check(at_least(0));
  command->callback([&session, options, command] {
    if (command->count("--seed") > 0) options->target.seed = options->target.start.seed;
    const auto fits = check_options(*command, options->target);
    session.exit_code = fits ? view(session, *options) : fail(fits.error());
  });
}

}  // namespace throng::app
