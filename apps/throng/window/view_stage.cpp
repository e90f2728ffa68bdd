// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "window/view_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <utility>

#include "input_file.h"
#include "number_checks.h"
#include "run/rerun.h"
#include "throng/bake.h"
#include "throng/impostor.h"
#include "throng/scenario.h"
#include "throng/surface.h"
#include "window/user_files.h"

// Loads what throng view and throng film show: scene, world, figures and a source of avatars.
namespace throng::app {
namespace {

namespace fs = std::filesystem;

bool has_sources(const SourceOptions& sources) {
  return !sources.files.empty() || !sources.scene.empty();
}

// More poses than an atlas: near the eye the changes are visible.
Result<FigureModel> model_of(const Character& character, AtlasConfig config, Context& context) {
  config.frames = 24;
  return create_figure_model(character, config, context);
}

AtlasConfig figure_config(double height) {
  AtlasConfig config;
  config.clips = {"Walk", "Idle"};
  config.height = height;
  return config;
}

// The built-in figure at a height. It takes seconds to make and is cached.
Result<Atlas> atlas_of(double height, Context& context) {
  const AtlasConfig config = figure_config(height);
  const std::string kept =
      user_file(UserFolder::kCache, fmt::format("figure-2-{:.0f}mm.atlas", height * 1000));
  if (!kept.empty()) {
    if (Result<Atlas> atlas = load_atlas(kept)) return atlas;
  }
  Result<Atlas> atlas = create_atlas(built_in_character_with_parts(), config, context);
  // A cache that cannot be written costs time, nothing else.
  if (atlas && !kept.empty() && make_folder_of(kept)) (void)save_atlas(*atlas, kept);
  return atlas;
}

// A character of a file. Without a clip "Idle" it only walks.
Result<ViewFigure> figure_of_file(const std::string& path, Context& context) {
  const Result<Character> character = load_character(path, context);
  if (!character) return character.error();
  AtlasConfig config = figure_config(AtlasConfig{}.height);
  if (!find_clip(*character, "Idle")) config.clips = {"Walk"};
  Result<Atlas> atlas = create_atlas(*character, config, context);
  if (!atlas) return Error{atlas.error().code, path + ": " + atlas.error().message};
  Result<FigureModel> model = model_of(*character, config, context);
  if (!model) return Error{model.error().code, path + ": " + model.error().message};
  return ViewFigure{.atlas = *std::move(atlas), .model = *std::move(model)};
}

Result<std::vector<std::vector<ViewFigure>>> figures_of(const ViewTarget& target,
                                                        const std::vector<double>& heights,
                                                        Context& context) {
  std::vector<std::vector<ViewFigure>> of_class;
  if (!target.atlases.empty() || !target.characters.empty()) {
    auto& all = of_class.emplace_back();
    for (const std::string& path : target.atlases) {
      Result<Atlas> atlas = load_atlas(path);
      if (!atlas) return atlas.error();
      all.push_back({.atlas = *std::move(atlas)});
    }
    for (const std::string& path : target.characters) {
      Result<ViewFigure> figure = figure_of_file(path, context);
      if (!figure) return figure.error();
      all.push_back(*std::move(figure));
    }
    return of_class;
  }
  const Character character = built_in_character_with_parts();
  for (const double height : heights) {
    Result<Atlas> atlas = atlas_of(height, context);
    if (!atlas) return atlas.error();
    Result<FigureModel> model = model_of(character, figure_config(height), context);
    if (!model) return model.error();
    of_class.emplace_back().push_back({.atlas = *std::move(atlas), .model = *std::move(model)});
  }
  return of_class;
}

std::vector<double> heights_of(const std::vector<AvatarClass>& classes) {
  std::vector<double> heights;
  for (const AvatarClass& c : classes) heights.push_back(c.height);
  return heights;
}

// Sets the scene: the sources of the options, or the walkable surface.
Result<void> set_scene(StageParts& parts, const ViewTarget& target, const World& world,
                       Context& context) {
  const bool given = has_sources(target.sources);
  if (auto ok = check_units(target.sources); !given && !ok) return ok;
  Result<Scene> scene = given ? read_sources(target.sources, context, SceneMaterials::kRead)
                              : walkable_surface(world, 0, context);
  if (!scene) return scene.error();
  if (given) note_if_elsewhere(*scene, world.summary().bounds);
  return parts.set_scene(*scene);
}

Result<void> show_world(StageParts& parts, const ViewTarget& target, const World& world,
                        Context& context) {
  // A world may have no nodes; then the overlay reports it.
  std::optional<Nodes> nodes;
  if (!target.path.empty() && fs::exists(fs::path(target.path) / "manifest.thm")) {
    if (Result<Nodes> opened = Nodes::open(target.path)) nodes = *std::move(opened);
  }
  parts.set_world(world, nodes);
  auto figures = figures_of(target, heights_of(world.summary().classes), context);
  if (!figures) return figures.error();
  parts.set_figures(*std::move(figures));
  if (target.crowd) parts.set_crowd(target.start);
  return {};
}

Result<void> load_world(StageParts& parts, const ViewTarget& target, Context& context) {
  const Result<World> world = World::open(target.path);
  if (!world) return world.error();
  if (auto ok = set_scene(parts, target, *world, context); !ok) return ok;
  return show_world(parts, target, *world, context);
}

Result<void> load_model(StageParts& parts, ViewTarget target, Context& context) {
  target.sources.files.insert(target.sources.files.begin(), target.path);
  const Result<Scene> scene = read_sources(target.sources, context, SceneMaterials::kRead);
  if (!scene) return scene.error();
  if (auto ok = parts.set_scene(*scene); !ok) return ok;
  BakeConfig config;
  config.cell = target.cell;
  const Result<World> world = bake_world(*scene, config, context);
  if (!world) return world.error();
  return show_world(parts, target, *world, context);
}

Result<void> load_replay(StageParts& parts, const ViewTarget& target, Context& context) {
  Result<Replay> replay = Replay::open(target.path);
  if (!replay) return replay.error();
  if (auto ok = check_has_frames(*replay, target.path); !ok) return ok;
  std::vector<double> heights;
  for (const RecordedClass& c : replay->info().classes) heights.push_back(c.height);
  const Result<World> world = world_of(replay->info(), target.world);
  if (!world) return world.error();
  if (auto ok = set_scene(parts, target, *world, context); !ok) return ok;
  parts.set_world(*world);
  auto figures = figures_of(target, heights, context);
  if (!figures) return figures.error();
  parts.set_figures(*std::move(figures));
  parts.set_replay(*std::move(replay));
  return {};
}

// The plane of the experiment, a little larger than the square of starts and targets.
Result<void> load_experiment(StageParts& parts, const ViewTarget& target, Context& context) {
  constexpr double kMargin = 2;  // [m]
  const double side = target.experiment.space.side * ExperimentStart::kUnit;
  Scene scene;
  scene.add_box({-kMargin, -0.1, -kMargin}, {side + kMargin, 0, side + kMargin});
  if (auto ok = parts.set_scene(scene); !ok) return ok;
  auto figures = figures_of(target, {ExperimentStart::kHeight}, context);
  if (!figures) return figures.error();
  parts.set_figures(*std::move(figures));
  parts.set_experiment(target.experiment);
  return {};
}

// A file that load_scenario is for: TOML, or a JSON object that is no city of CityJSON's.
bool is_scenario(const fs::path& path) {
  std::error_code none;
  if (fs::is_directory(path, none)) return false;
  if (path.extension() == ".toml") return true;
  if (path.extension() != ".json") return false;
  const Json json = Json::parse(read_text(path.string()), nullptr, false);
  return json.is_object() && !json.contains("type") && !json.contains("patches");
}

// Sources of the options are drawn in place of the model that was baked.
Result<void> load_scenario_stage(StageParts& parts, const ViewTarget& target, Context& context) {
  Result<Scenario> scenario = load_scenario(target.path);
  if (!scenario) return scenario.error();
  if (target.seed) scenario->seed = *target.seed;
  Result<World> world = Error{Errc::kNotFound, ""};
  if (scenario->world.empty()) {
    const Result<Scene> scene = load_scene(*scenario, context, SceneMaterials::kRead);
    if (!scene) return scene.error();
    if (!has_sources(target.sources)) {
      if (auto ok = parts.set_scene(*scene); !ok) return ok;
    }
    world = bake_world(*scenario, *scene, context);
    if (!world) return world.error();
  } else {
    world = World::open(scenario->world);
    if (!world) return world.error();
  }
  if (has_sources(target.sources) || !scenario->world.empty()) {
    if (auto ok = set_scene(parts, target, *world, context); !ok) return ok;
  }
  ViewTarget without = target;
  without.crowd = false;
  without.path = scenario->world;  // It may have nodes.
  if (auto ok = show_world(parts, without, *world, context); !ok) return ok;
  parts.set_scenario(*scenario);
  return {};
}

// --set, --order, --avatars and --seed, as of throng caacd.
Result<void> read_experiment(ViewTarget& target, bool has_avatars) {
  CrowdTuning tuning;
  if (auto ok = read_curves(target.curves, SteeringModel::kCurvilinear, tuning); !ok) return ok;
  const CurvilinearTuning& t = tuning.curvilinear;
  ExperimentStart& experiment = target.experiment;
  experiment.model = caacd::with_set({}, {t.mass, t.max_speed, t.max_force});
  if (t.by_state) experiment.model.order = caacd::Order::kState;
  if (auto ok = caacd::check_model(experiment.model); !ok) return ok;
  experiment.space.seed = target.start.seed;
  if (has_avatars) {
    experiment.space.avatars = static_cast<int32_t>(std::min(target.start.avatars, 100'000U));
  }
  // Asked now, so that a bad number is refused before a window opens.
  const auto space = caacd::random_space(experiment.space, experiment.model);
  if (!space) return space.error();
  return {};
}

// --density and --density-box: read now, so that a bad picture is refused before a window opens.
Result<void> read_density(ViewTarget& target, bool has_box) {
  if (target.density.empty()) {
    if (!has_box) return {};
    return Error{Errc::kBadConfig,
                 target.path + ": --density-box goes with --density; add that, or leave it out"};
  }
  Result<DensityGrid> map = load_density(target.density);
  if (!map) return map.error();
  target.start.map = *std::move(map);
  if (!has_box) return {};
  const std::vector<double>& box = target.density_box;
  if (!(box[0] < box[2] && box[1] < box[3])) {
    return Error{Errc::kBadConfig,
                 target.path + ": --density-box is X0,Z0,X1,Z1, low corner first"};
  }
  DensityGrid& grid = target.start.map;
  grid.x0 = box[0], grid.z0 = box[1], grid.x1 = box[2], grid.z1 = box[3];
  return {};
}

}  // namespace

void add_people_options(CLI::App* command, ViewTarget& target) {
  command->add_flag("--only-seen", target.start.only_seen,
                    "For a camera in a street: simulate only avatars that could be seen from it");
  command->add_option("--sight", target.start.sight, "With --only-seen: max distance [m]")
      ->check(between(1.0, 2000.0))
      ->capture_default_str();
  command
      ->add_option("--density", target.density,
                   "With --only-seen: picture from above; the brighter, the more avatars, which "
                   "walk where it is bright and never where it is black")
      ->type_name("FILE.png");
  command
      ->add_option("--density-box", target.density_box,
                   "With --density: corners of the picture, the world's if not given [m]")
      ->expected(4)
      ->delimiter(',')
      ->type_name("X0,Z0,X1,Z1");
  command
      ->add_option("--region", target.start.region,
                   "With --only-seen: also what is seen from so far beside the camera [m]")
      ->check(between(0.0, 100.0));
  command->add_flag("--coarse-far", target.start.coarse_far,
                    "Simulate avatars more than 300 m away in longer steps");
  command
      ->add_option("--atlas", target.atlases, "Characters, made by throng atlas; may be repeated")
      ->type_name("FILE.atlas")
      ->allow_extra_args(false);
  command
      ->add_option("--character", target.characters,
                   "Characters with a skeleton (fbx, glb ...); may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("--world", target.world, "World of a recording, if it is not where it was")
      ->type_name("WORLD");
}

void add_curve_options(CLI::App* command, ViewTarget& target) {
  add_model(*command, target.start.model);
  add_curve_options(*command, target.curves);
}

Result<void> check_options(const CLI::App& command, ViewTarget& target) {
  const fs::path path(target.path);
  const bool is_replay = path.extension() == ".replay", is_plane = target.path == kExperiment;
  const auto is_given = [&](const char* name) {
    const CLI::Option* option = command.get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
  };
  const auto refusal = [&](const char* name, const char* what) {
    return Error{Errc::kBadConfig, fmt::format("{}: {} {}, leave it out", target.path, name, what)};
  };
  if (!is_replay && is_given("--world")) return refusal("--world", "is for recordings");
  if (is_plane) {
    for (const char* name :
         {"--model", "--axes", "--near", "--speed", "--dt", "--zones", "--only-seen", "--sight",
          "--coarse-far", "--cell", "--source", "--density", "--density-box", "--region"}) {
      if (is_given(name)) return refusal(name, "is not for the experiment of [CAACD]");
    }
    return read_experiment(target, is_given("--avatars"));
  }
  if (!is_replay && !is_scenario(path)) {
    CrowdTuning tuning;
    if (auto ok = read_curves(target.curves, target.start.model, tuning); !ok) return ok;
    target.start.curves = tuning.curvilinear;
    target.start.flyer_axes = tuning.flyer_axes;
    for (const char* name : {"--density", "--region"}) {
      if (is_given(name) && !target.start.only_seen) {
        return refusal(name, "goes with --only-seen; add that, or");
      }
    }
    return read_density(target, is_given("--density-box"));
  }
  for (const char* name : {"--avatars", "--near", "--speed", "--dt", "--zones", "--only-seen",
                           "--sight", "--coarse-far", "--model", "--set", "--order", "--axes",
                           "--density", "--density-box", "--region"}) {
    if (is_given(name)) return refusal(name, "is for a crowd in a world or model");
  }
  if (is_given("--cell")) return refusal("--cell", "is for a model that is baked now");
  if (is_replay && is_given("--seed")) return refusal("--seed", "cannot change a recording");
  return {};
}

LoadStage stage_of(const ViewTarget& target) {
  return [target](StageParts& parts, Context& context) -> Result<void> {
    if (target.path == kExperiment) return load_experiment(parts, target, context);
    const fs::path path(target.path);
    std::error_code none;
    if (is_scenario(path)) return load_scenario_stage(parts, target, context);
    if (path.extension() == ".replay") return load_replay(parts, target, context);
    if (fs::exists(path / "manifest.thm", none)) return load_world(parts, target, context);
    if (path.extension() == ".throng") return World::open(target.path).error();
    return load_model(parts, target, context);
  };
}

std::string short_name(const std::string& path) {
  const fs::path p(path);
  return (p.has_filename() ? p : p.parent_path()).filename().string();
}

}  // namespace throng::app
