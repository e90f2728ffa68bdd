// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/rerun.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "run/run_scenario.h"

// Repeats recorded runs from their settings, to compare state hashes.
namespace throng::app {
namespace {

// Names a class of the settings in messages: no option gives it.
constexpr const char* kClassOfSettings = "the recording's class";

// Fails if a key is missing or of another kind.
Result<void> need(const Json& settings, std::initializer_list<const char*> keys,
                  bool (*is_right)(const Json&)) {
  for (const char* key : keys) {
    const auto found = settings.find(key);
    if (found != settings.end() && is_right(*found)) continue;
    return Error{Errc::kBadFile, fmt::format("the recording's settings have no usable '{}'; record "
                                             "the run again with this program",
                                             key)};
  }
  return {};
}

// "set": [mass, max speed, max force], and "by_state"; older recordings have neither.
Result<void> read_curves(const Json& settings, CurvilinearTuning& tuning) {
  if (!settings.contains("set")) return {};
  if (auto ok = need(settings, {"by_state"}, [](const Json& j) { return j.is_boolean(); }); !ok)
    return ok;
  auto ok = need(settings, {"set"}, [](const Json& j) {
    return j.is_array() && j.size() == 3 && j[0].is_number() && j[1].is_number() &&
           j[2].is_number();
  });
  if (!ok) return ok;
  const Json& set = settings.at("set");
  tuning = {.mass = set[0],
            .max_speed = set[1],
            .max_force = set[2],
            .by_state = settings.at("by_state")};
  return {};
}

// "axes" and "sets_at", which runs without them do not record.
Result<void> read_changes(const Json& settings, CrowdRun& run) {
  if (settings.contains("axes")) {
    if (auto ok = need(settings, {"axes"}, [](const Json& j) { return j.is_string(); }); !ok)
      return ok;
    const auto axes = parse_axes(settings.at("axes"));
    if (!axes) return Error{Errc::kBadFile, "the recording's settings: " + axes.error().message};
    run.config.tuning.flyer_axes = *axes;
  }
  if (!settings.contains("sets_at")) return {};
  auto ok = need(settings, {"sets_at"}, [](const Json& j) {
    return j.is_array() && std::ranges::all_of(j, [](const Json& row) {
             return row.is_array() && row.size() == 5 && row[0].is_number_unsigned() &&
                    (row[1].is_null() || row[1].is_number_unsigned()) && row[2].is_number() &&
                    row[3].is_number() && row[4].is_number();
           });
  });
  if (!ok) return ok;
  for (const Json& row : settings.at("sets_at")) {
    SetChange& change = run.set_changes.emplace_back();
    change.step = row[0];
    if (!row[1].is_null()) change.avatar = row[1].get<uint32_t>();
    change.set = {.mass = row[2], .max_speed = row[3], .max_force = row[4]};
  }
  return {};
}

Result<Rerun> rerun_wanderers(const Json& settings, const World& world, int32_t workers) {
  auto ok =
      need(settings, {"avatars", "seed"}, [](const Json& j) { return j.is_number_unsigned(); });
  if (ok) ok = need(settings, {"dt", "speed"}, [](const Json& j) { return j.is_number(); });
  if (ok) ok = need(settings, {"class"}, [](const Json& j) { return j.is_string(); });
  if (!ok) return ok.error();
  WanderConfig config{.avatars = settings.at("avatars"),
                      .avatar_class = 0,
                      .dt = settings.at("dt"),
                      .speed = settings.at("speed"),
                      .seed = settings.at("seed"),
                      .workers = workers};
  const Result<int32_t> avatar_class = class_named(world, settings.at("class"), kClassOfSettings);
  if (!avatar_class) return avatar_class.error();
  config.avatar_class = *avatar_class;
  const auto also = groups_of(settings);
  if (!also) return also.error();
  for (const auto& [name, avatars] : *also) {
    const Result<int32_t> other = class_named(world, name, kClassOfSettings);
    if (!other) return other.error();
    config.also.push_back({*other, avatars});
  }
  Result<Wanderers> made = Wanderers::create(world, config);
  if (!made) return made.error();
  const auto crowd = std::make_shared<Wanderers>(std::move(*made));
  return Rerun{.step = [crowd] { crowd->step(); },
               .state_hash = [crowd] { return crowd->state_hash(); }};
}

Result<Rerun> rerun_crowd(const Json& settings, const World& world, int32_t workers) {
  auto ok =
      need(settings, {"avatars", "seed"}, [](const Json& j) { return j.is_number_unsigned(); });
  if (ok) {
    ok = need(settings, {"dt", "speed", "radius", "near"},
              [](const Json& j) { return j.is_number(); });
  }
  if (ok) {
    ok = need(settings, {"class", "goals", "goals_text"},
              [](const Json& j) { return j.is_string(); });
  }
  if (ok && settings.contains("search_bytes")) {
    ok = need(settings, {"search_bytes"}, [](const Json& j) { return j.is_number_unsigned(); });
  }
  if (ok) ok = need(settings, {"labels", "zones"}, [](const Json& j) { return j.is_boolean(); });
  for (const char* key : {"slow_on_slopes", "avoid_jams", "pushing"}) {
    if (!ok || !settings.contains(key)) continue;
    ok = need(settings, {key}, [](const Json& j) { return j.is_boolean(); });
  }
  if (ok && settings.contains("acceleration")) {
    ok = need(settings, {"acceleration"}, [](const Json& j) { return j.is_number(); });
  }
  if (ok && settings.contains("model")) {
    ok = need(settings, {"model"}, [](const Json& j) { return j.is_string(); });
  }
  if (!ok) return ok.error();
  CrowdRun run;
  run.class_name = settings.at("class");
  run.goals = settings.at("goals");
  run.goals_text = settings.at("goals_text");
  run.near = settings.at("near");
  run.avatars = settings.at("avatars");
  auto also = groups_of(settings);
  if (!also) return also.error();
  run.also = *std::move(also);
  run.speed = settings.at("speed");
  run.radius = settings.at("radius");
  run.config.dt = settings.at("dt");
  run.config.seed = settings.at("seed");
  if (settings.at("labels")) run.config.speedup = PathSpeedup::kLabels;
  if (settings.at("zones")) run.config.speedup = PathSpeedup::kZones;
  run.config.search_bytes = settings.value("search_bytes", run.config.search_bytes);
  // Older recordings do not have it: nothing slowed their avatars.
  run.config.slow_on_slopes = settings.value("slow_on_slopes", false);
  // The same: they took no other routes.
  run.config.avoid_jams = settings.value("avoid_jams", false);
  // The same: they pushed, and accelerated without a limit.
  run.config.tuning.queues = !settings.value("pushing", true);
  run.config.tuning.acceleration = settings.value("acceleration", 0.0);
  if (auto set = read_curves(settings, run.config.tuning.curvilinear); !set) return set.error();
  if (auto changes = read_changes(settings, run); !changes) return changes.error();
  run.config.workers = workers;
  const auto model = find_steering_model(settings.value("model", name_of(run.config.model)));
  if (!model) {
    return Error{
        Errc::kBadFile,
        "the recording is of a model that this program does not know; use the program that "
        "recorded it"};
  }
  run.config.model = *model;
  Context context;
  Result<GoalCrowd> made = GoalCrowd::create(world, run, context);
  if (!made) return made.error();
  const auto crowd = std::make_shared<GoalCrowd>(std::move(*made));
  return Rerun{.step =
                   [crowd] {
                     crowd->step();
                     crowd->give_goals();
                   },
               .state_hash = [crowd] { return crowd->crowd().state_hash(); }};
}

Result<Rerun> rerun_scenario(const Json& settings, const World& world, int32_t workers) {
  const auto scenario = recorded_scenario(settings);
  if (!scenario) return scenario.error();
  Context context;
  auto made = Simulation::create(world, *scenario, workers, context);
  if (!made) return made.error();
  const auto simulation = std::make_shared<Simulation>(std::move(*made));
  // If a step fails, the state differs from the recording, and so does its hash.
  return Rerun{.step = [simulation] { (void)simulation->step(); },
               .state_hash = [simulation] { return simulation->state_hash(); }};
}

// The world that a scenario bakes itself; a null world if it opens a folder.
Result<World> own_world(const RecordingInfo& info) {
  const Json settings = Json::parse(info.settings, nullptr, /*allow_exceptions=*/false);
  const auto scenario = recorded_scenario(settings);
  if (!scenario) return scenario.error();
  if (!scenario->world.empty()) return World();
  Context context;
  return open_world(*scenario, context);
}

// "part" of the settings: a district of the world. Those of scenarios are in their text.
Result<WorldConfig> world_config(const RecordingInfo& info) {
  const Json settings = Json::parse(info.settings, nullptr, /*allow_exceptions=*/false);
  if (!settings.is_object()) return WorldConfig{};
  if (info.model == kScenarioModel) {
    const auto scenario = recorded_scenario(settings);
    if (!scenario) return scenario.error();
    return WorldConfig{.part = scenario->part};
  }
  if (!settings.contains("part")) return WorldConfig{};
  auto ok = need(settings, {"part"}, [](const Json& j) {
    return j.is_array() && j.size() == 4 &&
           std::ranges::all_of(j, [](const Json& number) { return number.is_number(); });
  });
  if (!ok) return ok.error();
  return WorldConfig{.part = box_of_part(settings.at("part").get<std::vector<double>>())};
}

struct Model {
  const char* name;
  Result<Rerun> (*rerun)(const Json& settings, const World& world, int32_t workers);
};

// One line per model that `throng replay --check` can repeat.
constexpr Model kModels[] = {{kWanderersModel, rerun_wanderers},
                             {kCrowdModel, rerun_crowd},
                             {kScenarioModel, rerun_scenario}};

}  // namespace

Json wanderers_settings(const WanderRun& run) {
  Json settings = {{"avatars", run.config.avatars},
                   {"class", run.class_name},
                   {"dt", run.config.dt},
                   {"speed", run.config.speed},
                   {"seed", run.config.seed}};
  if (!run.also.empty()) settings["also"] = json_of(run.also);
  if (!run.part.empty()) settings["part"] = run.part;
  return settings;
}

Json crowd_settings(const CrowdRun& run) {
  const CurvilinearTuning& curves = run.config.tuning.curvilinear;
  Json settings = {{"avatars", run.avatars},
                   {"also", json_of(run.also)},
                   {"class", run.class_name},
                   {"goals", run.goals},
                   {"goals_text", run.goals_text},
                   {"near", run.near},
                   {"dt", run.config.dt},
                   {"speed", run.speed},
                   {"radius", run.radius},
                   {"labels", run.config.speedup == PathSpeedup::kLabels},
                   {"zones", run.config.speedup == PathSpeedup::kZones},
                   {"search_bytes", run.config.search_bytes},
                   {"seed", run.config.seed},
                   {"model", name_of(run.config.model)},
                   {"slow_on_slopes", run.config.slow_on_slopes},
                   {"avoid_jams", run.config.avoid_jams},
                   {"pushing", !run.config.tuning.queues},
                   {"acceleration", run.config.tuning.acceleration},
                   {"set", Json::array({curves.mass, curves.max_speed, curves.max_force})},
                   {"by_state", curves.by_state}};
  if (!run.part.empty()) settings["part"] = run.part;
  const FlyerAxes axes = run.config.tuning.flyer_axes;
  if (axes != FlyerAxes::kOurs) settings["axes"] = word_for(axes);
  for (const auto& [step, avatar, set] : run.set_changes) {
    Json row = {step, nullptr, set.mass, set.max_speed, set.max_force};
    if (avatar) row[1] = *avatar;
    settings["sets_at"].push_back(std::move(row));
  }
  return settings;
}

Result<Rerun> make_rerun(const RecordingInfo& info, const World& world, int32_t workers) {
  for (const Model& model : kModels) {
    if (info.model != model.name) continue;
    const Json settings = Json::parse(info.settings, nullptr, /*allow_exceptions=*/false);
    if (!settings.is_object()) break;
    return model.rerun(settings, world, workers);
  }
  return Error{Errc::kBadFile,
               fmt::format("the recording is of '{}', which this program cannot run again; use the "
                           "program that recorded it",
                           info.model)};
}

Result<World> world_of(const RecordingInfo& info, const std::string& folder) {
  if (folder.empty() && info.model == kScenarioModel) {
    auto world = own_world(info);
    if (!world || *world) return world;
  }
  const std::string& name = folder.empty() ? info.world : folder;
  const Result<WorldConfig> opened = world_config(info);
  if (!opened) return opened.error();
  Result<World> world = World::open(name, *opened);
  if (!world && world.error().code == Errc::kBadConfig) return world;
  if (!world) {
    return Error{
        Errc::kBadFile,
        fmt::format("{}: the recording's world is not there; name its folder with --world", name)};
  }
  const uint64_t hash = world->summary().hash;
  if (hash == info.world_hash) return world;
  return Error{Errc::kBadFile,
               fmt::format("{}: not the world that was recorded (its hash is {:016x}, recorded "
                           "{:016x}); bake it as it was, or name another folder with --world",
                           name, hash, info.world_hash)};
}

}  // namespace throng::app
