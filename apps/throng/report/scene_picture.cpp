// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "report/scene_picture.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "number_checks.h"
#include "report/avatars_csv.h"
#include "throng/bake.h"
#include "throng/impostor.h"
#ifdef THRONG_WITH_DRAW
#include "throng_draw/draw.h"
#endif

// A picture of a world and avatars from an eye, drawn as impostors without a window.
namespace throng::app {

bool ScenePictureOptions::needs_camera() const {
  return !atlases.empty() || !sources.files.empty() || !sources.scene.empty() || crowd > 0 ||
         height > 0 || view_angle != 45;
}

void add_scene_picture_options(CLI::App* command, ScenePictureOptions& options) {
  command
      ->add_option("--camera", options.camera,
                   "Draw the view from an eye: its position and its target [m]")
      ->expected(6)
      ->delimiter(',')
      ->type_name("X,Y,Z,TX,TY,TZ");
  command
      ->add_option("--atlas", options.atlases,
                   "With --camera: characters, made by throng atlas; may be repeated")
      ->type_name("FILE.atlas")
      ->allow_extra_args(false);
  command
      ->add_option("--crowd", options.crowd,
                   "With --camera: place so many avatars, if no --avatars are given")
      ->check(between(0, 1'000'000));
  command->add_option("--height", options.height, "With --camera: height of the picture [px]")
      ->check(between(0, 8192));
  command
      ->add_option("--view-angle", options.view_angle,
                   "With --camera: from the top to the bottom of the picture [degrees]")
      ->check(between(1, 170));
  add_source_options(command, options.sources, "--source");
}

#ifndef THRONG_WITH_DRAW

int draw_scene_picture(Session&, const World&, const ScenePictureOptions&, const std::string&) {
  return fail({Errc::kNotFound,
               "--camera: this program was built without drawing; install libepoxy-dev and "
               "libegl-dev and build it again"});
}

#else

namespace {

// Random bits of an avatar, the same in each picture.
uint64_t scramble(uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

Result<std::vector<CsvWalker> > walkers_of(const World& world, const ScenePictureOptions& options) {
  if (!options.avatars.empty()) return read_walkers(options.avatars);
  std::vector<CsvWalker> walkers;
  for (uint32_t i = 0; i < options.crowd; ++i) {
    const Place place = world.random_place(options.avatar_class, 1, i);
    if (!place) return Error{Errc::kNotFound, "--crowd: no avatar of this class can stand here"};
    CsvWalker& walker = walkers.emplace_back();
    walker.id = i;
    walker.position = place.position;
    walker.last_move = 1;
  }
  return walkers;
}

Result<std::vector<Atlas> > atlases_of(Session& session, const ScenePictureOptions& options) {
  std::vector<Atlas> atlases;
  for (const std::string& path : options.atlases) {
    Result<Atlas> atlas = load_atlas(path);
    if (!atlas) return atlas.error();
    atlases.push_back(*std::move(atlas));
  }
  if (!atlases.empty()) return atlases;
  AtlasConfig config;
  config.clips = {"Walk", "Idle"};
  Result<Atlas> atlas = create_atlas(built_in_character(), config, session.context);
  if (!atlas) return atlas.error();
  atlases.push_back(*std::move(atlas));
  return atlases;
}

// Avatars that share an atlas and a clip, as arrays.
struct Group {
  std::vector<float> x, y, z;
  std::vector<uint16_t> heading, phase, look;
  std::vector<Vec3d> ups;
};

// By atlas, clip and whether they lean.
using Groups = std::map<std::tuple<size_t, size_t, bool>, Group>;

// The first clip that moves, or the first that stands; the first clip if there is none.
size_t clip_for(const Atlas& atlas, bool moves) {
  for (size_t i = 0; i < atlas.clips.size(); ++i) {
    if ((atlas.clips[i].stride != 0) == moves) return i;
  }
  return 0;
}

uint16_t steps_of(double turns) {
  return static_cast<uint16_t>(static_cast<int64_t>(std::floor(turns * 65536)) & 0xffff);
}

Groups group_walkers(const std::vector<CsvWalker>& walkers, const std::vector<Atlas>& atlases,
                     Vec3d origin) {
  Groups groups;
  for (const CsvWalker& walker : walkers) {
    const uint64_t own = scramble(walker.id);
    const size_t atlas = (own >> 48) % atlases.size();
    const size_t clip = clip_for(atlases[atlas], walker.last_move > 1e-3);
    const bool leans = !(walker.up == Vec3d{0, 1, 0});
    Group& group = groups[{atlas, clip, leans}];
    if (leans) group.ups.push_back(walker.up);
    const Vec3d p = walker.position - origin;
    group.x.push_back(static_cast<float>(p.x));
    group.y.push_back(static_cast<float>(p.y));
    group.z.push_back(static_cast<float>(p.z));
    const bool headed = walker.heading.x != 0 || walker.heading.z != 0;
    const double angle = std::atan2(walker.heading.x, walker.heading.z) / (2 * std::numbers::pi);
    group.heading.push_back(headed ? steps_of(angle) : static_cast<uint16_t>(own));
    const double start = static_cast<double>(own >> 16 & 0xffff) / 65536;
    group.phase.push_back(steps_of(walk_phase(atlases[atlas].clips[clip], walker.walked, start)));
    group.look.push_back(static_cast<uint16_t>(own >> 32 & 2047));
  }
  return groups;
}

Result<Scene> scene_of(Session& session, const World& world, const ScenePictureOptions& options) {
  if (options.sources.files.empty() && options.sources.scene.empty()) {
    if (auto ok = check_units(options.sources); !ok) return ok.error();
    return walkable_surface(world, options.avatar_class, session.context);
  }
  Result<Scene> scene = read_sources(options.sources, session.context, SceneMaterials::kRead);
  if (scene) note_if_elsewhere(*scene, world.summary().bounds);
  return scene;
}

}  // namespace

int draw_scene_picture(Session& session, const World& world, const ScenePictureOptions& options,
                       const std::string& output) {
  const std::vector<double>& c = options.camera;
  const Vec3d origin{std::round(c[3]), std::round(c[4]), std::round(c[5])};
  DrawingConfig config;
  config.camera.eye = Vec3d{c[0], c[1], c[2]} - origin;
  config.camera.target = Vec3d{c[3], c[4], c[5]} - origin;
  config.camera.field_of_view = options.view_angle * std::numbers::pi / 180;
  config.width = options.width;
  config.height = options.height > 0 ? options.height : options.width * 9 / 16;
  for (const auto& [name, pixels] :
       {std::pair("--width", config.width), std::pair("--height", config.height)}) {
    if (pixels >= 16 && pixels <= 8192) continue;
    return fail({Errc::kBadConfig,
                 fmt::format("{}: {} is outside of 16 to 8192, the pixels of a view from an eye; "
                             "give another number",
                             name, pixels)});
  }
  if (auto sound = Drawing::check(config); !sound) return fail(sound.error());
  Result<Drawing> drawing = Drawing::create();
  if (!drawing) return fail(drawing.error());
  const Result<std::vector<CsvWalker> > walkers = walkers_of(world, options);
  if (!walkers) return fail(walkers.error());
  const Result<Scene> scene = scene_of(session, world, options);
  if (!scene) return fail(scene.error());
  const Result<std::vector<Atlas> > atlases = atlases_of(session, options);
  if (!atlases) return fail(atlases.error());

  if (auto set = drawing->set_scene(*scene, origin); !set) return fail(set.error());
  for (const Atlas& atlas : *atlases) {
    if (auto added = drawing->add_atlas(atlas); !added) return fail(added.error());
  }
  const Groups groups = group_walkers(*walkers, *atlases, origin);
  std::vector<DrawnCrowd> crowds;
  for (const auto& [key, g] : groups) {
    crowds.push_back({.atlas = std::get<0>(key),
                      .clip = std::get<1>(key),
                      .avatars = {g.x, g.y, g.z, g.heading, g.phase, g.look},
                      .up_vectors = g.ups});
  }
  DrawingReport report;
  const Result<Image> image = drawing->draw(crowds, config, &report);
  if (!image) return fail(image.error());
  if (auto done = write_png(*image, output); !done) return fail(done.error());
  print_result(
      session,
      {{"picture", output},
       {"width", image->width},
       {"height", image->height},
       {"triangles", scene->triangles.size()},
       {"avatars", report.avatars},
       {"drawn", report.drawn},
       {"seconds_pack", report.seconds_pack},
       {"seconds_draw", report.seconds_draw},
       {"renderer", drawing->renderer()}},
      fmt::format("{}: {} x {} pixels, {} of {} avatars in the picture, {} triangles; {}\n", output,
                  image->width, image->height, report.drawn, report.avatars,
                  scene->triangles.size(), drawing->renderer()));
  return kDone;
}

#endif

}  // namespace throng::app
