// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "command.h"
#include "input_file.h"
#include "number_checks.h"
#include "run/avatar_group.h"
#include "run/caacd_options.h"
#include "run/memory_bound.h"
#include "run/rerun.h"
#include "run/run_crowd.h"
#include "run/run_scenario.h"
#include "run/run_sinks.h"
#include "run/run_times.h"
#include "run/run_wanderers.h"
#include "throng/bake.h"
#include "throng/papers.h"
#include "throng/world.h"

// throng run: moves a crowd with goals, or one of wanderers, through a baked world, or runs a
// scenario; times, checks and hashes it.
namespace throng::app {
namespace {

struct RunOptions {
  std::string world;
  std::string class_name;
  SinkOptions sinks;
  std::string trips, obstacles;
  uint64_t steps = 100;
  uint64_t check_every = 0;
  WanderConfig config;
  CrowdRun crowd;
  std::vector<double> part;  // --part: x0, z0, x1, z1
  MemoryBound memory;
  bool wander = false;       // without goals
  bool full_speed = false;   // on stairs and slopes, too
  bool ignore_jams = false;  // no other routes around them
  bool pushing = false;      // no queues, no limit of accelerations
  CurveWords curves;         // of the model caacd
  std::vector<std::string> set_changes;
  std::vector<std::string> also;  // CLASS:N
};

// The class's index, by name or the first; fills in the name.
Result<int32_t> pick_class(const World& world, std::string& name) {
  if (name.empty()) name = world.summary().classes.front().name;
  return class_named(world, name);
}

// --set-at.
Result<void> read_set_changes(const std::vector<std::string>& texts, CrowdRun& run) {
  if (texts.empty()) return {};
  if (run.config.model != SteeringModel::kCurvilinear) {
    return Error{Errc::kBadConfig, "--set-at is of [CAACD]; add --model caacd"};
  }
  for (const std::string& text : texts) {
    const auto change = parse_set_change(text);
    if (!change) return change.error();
    run.set_changes.push_back(*change);
  }
  return {};
}

Result<void> check_memory(const RunOptions& options, const std::string& when) {
  return options.memory.check(when, options.part.empty()
                                        ? "give more, or --part for a district of the world"
                                        : "give more, or a smaller --part");
}

int run_with_goals(Session& session, const World& world, RunOptions& options, RunTimes& times) {
  CrowdRun& run = options.crowd;
  run.world_name = options.world;
  run.class_name = options.class_name;
  run.avatars = options.config.avatars;
  run.speed = options.config.speed;
  run.config.dt = options.config.dt;
  run.config.seed = options.config.seed;
  run.config.workers = options.config.workers;
  run.config.slow_on_slopes = !options.full_speed;
  run.config.avoid_jams = !options.ignore_jams;
  run.part = options.part;
  if (options.memory) {
    run.config.search_bytes = std::min(run.config.search_bytes, options.memory.search());
  }
  if (options.pushing) run.config.tuning.let_push();
  if (auto ok = read_curves(options.curves, run.config.model, run.config.tuning); !ok) {
    return fail(ok.error());
  }
  if (auto ok = read_set_changes(options.set_changes, run); !ok) return fail(ok.error());
  if (auto ok = read_goals(run); !ok) return fail(ok.error());
  const auto also = read_groups(options.also);
  if (!also) return fail(also.error());
  run.also = *also;
  const std::string& resume = run.checkpoints.resume;
  auto checkpoint = resume.empty() ? Result<Checkpoint>(Checkpoint()) : read_checkpoint(resume);
  if (!checkpoint) return fail(checkpoint.error());
  if (!resume.empty()) {
    const auto ok = check_settings(*checkpoint, resume, world.summary().hash, crowd_settings(run));
    if (!ok) return fail(ok.error());
  }
  auto crowd = times.measure("prepare", [&] {
    return resume.empty() ? GoalCrowd::create(world, run, session.context)
                          : GoalCrowd::restore(world, run, *checkpoint, session.context);
  });
  if (!crowd) return fail(crowd.error());
  *checkpoint = {};
  if (auto ok = check_memory(options, "the crowd and its paths were made"); !ok) {
    return fail(ok.error());
  }
  Sinks sinks(options.sinks);
  if (auto ok = sinks.open(world, {.world = options.world,
                                   .dt = run.config.dt,
                                   .model = kCrowdModel,
                                   .settings = crowd_settings(run).dump(),
                                   .leans = crowd->crowd().may_lean()});
      !ok)
    return fail(ok.error());
  const auto shown = [&](uint64_t step) {
    if (auto ok = check_memory(options, "steps were made"); !ok) return ok;
    return sinks.add(step, crowd->crowd());
  };
  return run_crowd(session, run, *crowd, times, shown, [&] { return sinks.finish(); });
}

// Fails if an option stands beside a scenario that the file has a key for, or scenarios never obey.
Result<void> check_scenario(const CLI::App& command, const std::string& file) {
  constexpr std::pair<const char*, const char*> kKeys[] = {{"--avatars", "count of a [[source]]"},
                                                           {"--dt", "dt"},
                                                           {"--class", "class of a [[profile]]"},
                                                           {"--speed", "speed of a [[profile]]"},
                                                           {"--radius", "radius of a [[profile]]"},
                                                           {"--goals", "stages of a [[journey]]"},
                                                           {"--also", "another [[profile]]"},
                                                           {"--labels", "paths = \"labels\""},
                                                           {"--zones", "paths = \"zones\""},
                                                           {"--search-memory", "search_memory"},
                                                           {"--part", "part"}};
  for (const auto& [name, key] : kKeys) {
    if (command.count(name) == 0) continue;
    return Error{Errc::kBadConfig,
                 fmt::format("{} goes with a world; in {} write {}", name, file, key)};
  }
  for (const char* name : {"--wander", "--near", "--set", "--order", "--axes", "--set-at",
                           "--memory", "--checkpoint", "--resume"}) {
    if (command.count(name) == 0) continue;
    return Error{Errc::kBadConfig,
                 fmt::format("{} goes with a world, and no scenario can have it; leave it out for "
                             "{}",
                             name, file)};
  }
  return {};
}

int run_file(Session& session, const CLI::App& command, const RunOptions& options) {
  if (auto fits = check_scenario(command, options.world); !fits) return fail(fits.error());
  ScenarioRun run{.file = options.world,
                  .text = {},
                  .steps = {},
                  .seed = {},
                  .model = {},
                  .full_speed = options.full_speed,
                  .ignore_jams = options.ignore_jams,
                  .pushing = options.pushing,
                  .check_every = options.check_every,
                  .workers = options.config.workers,
                  .trips = options.trips,
                  .obstacles = options.obstacles,
                  .sinks = options.sinks};
  if (command.count("--steps") > 0) run.steps = options.steps;
  if (command.count("--seed") > 0) run.seed = options.config.seed;
  if (command.count("--model") > 0) run.model = options.crowd.config.model;
  return run_scenario(session, run);
}

// Fails if an option of avatars with goals stands beside --wander.
Result<void> check_wander(const CLI::App& command, const char* remedy = "leave out --wander") {
  if (rank_info().size > 1) {
    return Error{Errc::kBadConfig, "--wander is for one process; start it without mpirun"};
  }
  for (const char* name :
       {"--goals", "--near", "--radius", "--labels", "--zones", "--search-memory", "--model",
        "--memory", "--set", "--order", "--axes", "--set-at", "--full-speed", "--ignore-jams",
        "--pushing", "--checkpoint", "--resume"}) {
    if (command.count(name) == 0) continue;
    return Error{Errc::kBadConfig, fmt::format("{} is for avatars with goals; {}", name, remedy)};
  }
  return {};
}

WanderRun wander_run(const RunOptions& options, std::vector<AvatarGroup> also) {
  return {.world = options.world,
          .class_name = options.class_name,
          .also = std::move(also),
          .config = options.config,
          .part = options.part,
          .steps = options.steps,
          .check_every = options.check_every,
          .sinks = options.sinks};
}

// --wander on slices; everything but the classes as on a world.
int run_slices(Session& session, const CLI::App& command, RunOptions& options) {
  if (auto ok = check_file(options.world, kNoSlices); !ok) return fail(ok.error());
  if (!options.wander) {
    return fail(
        {Errc::kBadConfig,
         options.world + ": on slices avatars have no goals; add --wander, or bake a world"});
  }
  if (auto fits = check_wander(command, "on slices there are none, leave it out"); !fits) {
    return fail(fits.error());
  }
  if (!options.part.empty()) {
    return fail({Errc::kBadConfig, "--part is for worlds; on slices leave it out"});
  }
  const auto also = read_groups(options.also);
  if (!also) return fail(also.error());
  if (options.check_every == 0) options.check_every = std::max<uint64_t>(1, options.steps / 10);
  return run_slice_wanderers(session, wander_run(options, *also));
}

int run(Session& session, RunOptions& options) {
  RunTimes times;
  WorldConfig opened{.resident_bytes = options.memory.zones()};
  if (!options.part.empty()) opened.part = box_of_part(options.part);
  const Result<World> world =
      times.measure("open", [&] { return World::open(options.world, opened); });
  if (!world) return fail(world.error());
  const Result<int32_t> avatar_class = pick_class(*world, options.class_name);
  if (!avatar_class) return fail(avatar_class.error());
  options.config.avatar_class = *avatar_class;
  if (options.check_every == 0) options.check_every = std::max<uint64_t>(1, options.steps / 10);
  options.crowd.steps = options.steps;
  options.crowd.check_every = options.check_every;
  if (!options.wander) return run_with_goals(session, *world, options, times);
  const auto also = read_groups(options.also);
  if (!also) return fail(also.error());
  return run_wanderers(session, *world, wander_run(options, *also), times);
}

void add_checkpoints(CLI::App& command, Session& session, CheckpointOptions& checkpoints) {
  add_output(command, session, "--checkpoint", checkpoints.write,
             "Save the run in this file, again and again, so that it can go on if it is ended")
      ->type_name("FILE");
  command.add_option("--checkpoint-every", checkpoints.every, "Save it after each K-th step")
      ->check(above(0))
      ->capture_default_str();
  command
      .add_option("--resume", checkpoints.resume,
                  "Go on from a checkpoint, with the options of its run and any number of ranks; "
                  "files hold the steps from there on")
      ->type_name("FILE");
}

}  // namespace

void add_run(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "run", "Move a crowd through a baked world, or run a scenario",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng run garage.throng --avatars 200 --steps 50 --trajectories walk.csv");
  const auto options = std::make_shared<RunOptions>();
  WanderConfig& config = options->config;
  command
      ->add_option("world", options->world,
                   "World folder, a scenario file, or, with --wander, a file of slices")
      ->required()
      ->type_name("WORLD|SCENARIO.toml|FILE.slices");
  command->add_option("--avatars", config.avatars, "How many")->capture_default_str();
  command->add_option("--steps", options->steps, "How many steps")->capture_default_str();
  command->add_option("--dt", config.dt, "Length of a step [s]")->capture_default_str();
  command->add_option("--seed", config.seed, "Seed of all chance")->capture_default_str();
  add_threads(*command, config.workers);
  command->add_option("--class", options->class_name, "Avatar class (the world's first)");
  command->add_option("--speed", config.speed, "Walking speed, 0 for the class's own [m/s]");
  command
      ->add_option(
          "--goals", options->crowd.goals,
          "Goals of the avatars: 'random', or a file of lines x,y,z. Avatars that fly begin in "
          "the air, and half of their random goals are there; those that climb move over nodes, "
          "if the world has any")
      ->type_name("random|FILE")
      ->capture_default_str();
  command->add_flag("--wander", options->wander,
                    "Without goals: avatars walk straight on and turn at random when blocked");
  command
      ->add_option("--near", options->crowd.near, "Max distance of random goals, 0: anywhere [m]")
      ->check(at_least(0));
  command->add_option("--also", options->also, "Avatars of another class; may be repeated")
      ->type_name("CLASS:N");
  command->add_option("--radius", options->crowd.radius,
                      "Radius of avatars with goals, 0 for the class's own [m]");
  PathSpeedup& speedup = options->crowd.config.speedup;
  CLI::Option* labels = add_speedup(*command, "--labels", PathSpeedup::kLabels, speedup,
                                    "Label corners: faster paths, for small worlds");
  add_speedup(*command, "--zones", PathSpeedup::kZones, speedup, "Paths by zones: for large worlds")
      ->excludes(labels);
  add_search_memory(*command, options->crowd.config.search_bytes);
  add_memory(*command, options->memory,
             "Max memory of the run; it ends where it would need more [MiB]");
  add_part(*command, options->part,
           "A district, by two opposite corners as seen from above: only the world's zones that "
           "touch it are there [m]");
  add_model(*command, options->crowd.config.model);
  add_curve_options(*command, options->curves);
  command
      ->add_option("--set-at", options->set_changes,
                   "Of the model caacd: another set from a step on, for all avatars or for one, "
                   "whose speed changes with MaxSpeed; may be repeated")
      ->type_name("STEP:[ID:]M/V/F")
      ->allow_extra_args(false);
  command->add_flag("--full-speed", options->full_speed,
                    "Stairs and slopes slow no avatar; without it they do");
  command->add_flag("--ignore-jams", options->ignore_jams,
                    "No avatar takes another route around a jam; without it avatars do");
  command->add_flag("--pushing", options->pushing,
                    "Avatars push instead of queueing, and nothing limits their acceleration");
  add_output(*command, session, "--trajectories", options->sinks.trajectories,
             "Write positions to this file")
      ->type_name("FILE.csv");
  add_output(*command, session, "--record", options->sinks.record, "Record the run in this file")
      ->type_name("FILE.replay");
  command->add_option("--every", options->sinks.every, "Write each K-th step")
      ->check(above(0))
      ->capture_default_str();
  add_checkpoints(*command, session, options->crowd.checkpoints);
  command->add_option("--check-every", options->check_every,
                      "Check for walls entered and overlaps each K-th step, 0: ten times a run");
  add_output(*command, session, "--trips", options->trips,
             "Of a scenario: write a line for each trip of an avatar")
      ->type_name("FILE.csv");
  add_output(*command, session, "--obstacles", options->obstacles,
             "Of a scenario: write when obstacles were requested, and when they were up")
      ->type_name("FILE.csv");
  command->callback([&session, options, command] {
    if (is_scenario_file(options->world)) {
      session.exit_code = run_file(session, *command, *options);
      return;
    }
    for (const auto& [name, path] :
         {std::pair("--trips", &options->trips), std::pair("--obstacles", &options->obstacles)}) {
      if (path->empty()) continue;
      const std::string what = name;
      session.exit_code = fail({Errc::kBadConfig, what + " goes with a scenario file"});
      return;
    }
    if (names_slices(options->world)) {
      session.exit_code = run_slices(session, *command, *options);
      return;
    }
    const Result<void> fits = options->wander ? check_wander(*command) : Result<void>{};
    session.exit_code = fits ? run(session, *options) : fail(fits.error());
  });
}

}  // namespace throng::app
