// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "command.h"
#include "number_checks.h"
#include "window/film_pipe.h"
#include "window/view_stage.h"
#include "window/view_window.h"

// throng film: a recording, or a crowd that is simulated now, as a film. Needs no display.
namespace throng::app {
namespace {

struct FilmOptions {
  ViewTarget target;
  std::vector<double> camera;
  std::vector<std::string> overlays;
  std::string output;
  FilmFormat format;
  double seconds = 0;
  double from = 0;
  double speed = 1;
  double turn = 0;
  int32_t workers = 0;
};

// The eye, turned around its target.
Vec3d turned(Vec3d eye, Vec3d target, double angle) {
  const Vec3d d = eye - target;
  const double c = std::cos(angle), s = std::sin(angle);
  return target + Vec3d{c * d.x + s * d.z, d.y, c * d.z - s * d.x};
}

int film(Session& session, const FilmOptions& options) {
  const FilmFormat& format = options.format;
  if (format.width % 2 != 0 || format.height % 2 != 0) {
    return fail({Errc::kBadConfig, "film: width and height must be even"});
  }
  Result<Drawing> drawing = Drawing::create();
  if (!drawing) return fail(drawing.error());
  Result<Viewer> viewer = Viewer::create(
      *std::move(drawing), {.settings = fmt::format("{{\"speed\": {}}}", options.speed),
                            .font = {},
                            .workers = options.workers,
                            .panel = false});
  if (!viewer) return fail(viewer.error());
  const std::vector<double>& c = options.camera;
  if (!c.empty()) viewer->look_at({c[0], c[1], c[2]}, {c[3], c[4], c[5]});
  viewer->load(short_name(options.target.path), stage_of(options.target));
  viewer->wait_until_loaded();
  if (const std::string error = viewer->status().error; !error.empty()) {
    return fail({Errc::kBadFile, error});
  }
  viewer->play_for(options.from / options.speed);
  for (const std::string& overlay : options.overlays) viewer->show_overlay(overlay);
  if (!options.overlays.empty()) viewer->wait_for_overlays();
  // The rest of a recording, or ten seconds of a crowd.
  double seconds = options.seconds;
  const ViewerStatus begin = viewer->status();
  if (seconds <= 0)
    seconds = begin.last_time > 0 ? (begin.last_time - begin.time) / options.speed : 10;
  const auto frames = static_cast<uint64_t>(std::max(1.0, std::round(seconds * format.rate)));

  Result<FilmPipe> pipe = FilmPipe::open(options.output, format);
  if (!pipe) return fail(pipe.error());
  Result<Image> image = viewer->picture(0, format.width, format.height);
  const EyeCamera start = viewer->status().camera;
  for (uint64_t frame = 0; frame < frames; ++frame) {
    if (session.context.cancel) return fail({Errc::kCancelled, "film: interrupted"});
    if (frame > 0) {
      const double elapsed = static_cast<double>(frame) / format.rate;
      if (options.turn != 0) {
        const double angle = options.turn * elapsed * std::numbers::pi / 180;
        viewer->look_at(turned(start.eye, start.target, angle), start.target);
      }
      viewer->play_for(1.0 / format.rate);
      image = viewer->picture(0, format.width, format.height);
    }
    if (!image) return fail(image.error());
    if (auto ok = pipe->add(*image); !ok) return fail(ok.error());
    show_progress(session, "film", frame + 1, frames);
  }
  if (auto ok = pipe->finish(); !ok) return fail(ok.error());
  const ViewerStatus end = viewer->status();
  print_result(
      session,
      {{"film", options.output},
       {"frames", frames},
       {"width", format.width},
       {"height", format.height},
       {"rate", format.rate},
       {"from", begin.time},
       {"to", end.time},
       {"avatars", end.avatars}},
      fmt::format("{}: {} pictures of {} x {}, {:.2f} to {:.2f} s, {} avatars\n", options.output,
                  frames, format.width, format.height, begin.time, end.time, end.avatars));
  return kDone;
}

}  // namespace

void add_film(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(
      parser, session, "film", "Make a film of a recording, or of a crowd simulated now",
      "throng bake builtin:garage -o garage.throng\n"
      "throng run garage.throng --avatars 200 --steps 10 --goals random --record walk.replay\n"
      "throng film walk.replay --source builtin:garage --width 320 --height 180 "
      "--rate 10 -o walk.mp4");
  const auto options = std::make_shared<FilmOptions>();
  ViewTarget& target = options->target;
  command->add_option("target", target.path, "Recording, world folder, or model to bake now")
      ->required()
      ->type_name("FILE.replay|WORLD|MODEL");
  add_output(*command, session, "-o,--output", options->output, "Film to write, by ffmpeg")
      ->required()
      ->type_name("FILE.mp4");
  command->add_option("--camera", options->camera, "Where to look from and to [m]")
      ->expected(6)
      ->delimiter(',')
      ->type_name("X,Y,Z,TX,TY,TZ");
  command->add_option("--overlay", options->overlays, "Switch on, may be repeated")
      ->check(CLI::IsMember(Viewer::overlay_names(), CLI::ignore_case))
      ->allow_extra_args(false);
  command->add_option("--turn", options->turn, "Turn the eye around its target [degrees/s]");
  command->add_option("--from", options->from, "Leave out what comes before [s]")
      ->check(at_least(0));
  command
      ->add_option("--seconds", options->seconds,
                   "Length of the film, 0: all of a recording, ten of a crowd [s]")
      ->check(between(0, 86400));
  command->add_option("--play-speed", options->speed, "Speed of time")
      ->check(between(0.05, 16.0))
      ->capture_default_str();
  command->add_option("--rate", options->format.rate, "Pictures a second")
      ->check(between(1, 120))
      ->capture_default_str();
  command->add_option("--width", options->format.width, "[px]")
      ->check(between(16, 4096))
      ->capture_default_str();
  command->add_option("--height", options->format.height, "[px]")
      ->check(between(16, 4096))
      ->capture_default_str();
  command->add_option("--avatars", target.start.avatars, "Avatars in a world")
      ->capture_default_str();
  command->add_option("--seed", target.start.seed, "Seed of all chance")->capture_default_str();
  command->add_option("--near", target.start.near, "Max distance of goals, 0: anywhere [m]")
      ->check(at_least(0))
      ->capture_default_str();
  add_curve_options(command, target);
  add_people_options(command, target);
  add_threads(*command, options->workers);
  add_source_options(command, target.sources, "--source");
  command->callback([&session, options, command] {
    if (command->count("--seed") > 0) options->target.seed = options->target.start.seed;
    const auto fits = check_options(*command, options->target);
    session.exit_code = fits ? film(session, *options) : fail(fits.error());
  });
}

}  // namespace throng::app
