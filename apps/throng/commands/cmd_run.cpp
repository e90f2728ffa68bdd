// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <vector>

#include "command.h"
#include "number_checks.h"
#include "run/rerun.h"
#include "run/run_crowd.h"
#include "run/run_scenario.h"
#include "run/run_sinks.h"
#include "run/run_times.h"
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
  bool wander = false;            // without goals
  bool full_speed = false;        // on stairs and slopes, too
  bool ignore_jams = false;       // no other routes around them
  bool pushing = false;           // no queues, no limit of accelerations
  std::vector<std::string> also;  // CLASS:N
};

// Sums over all steps.
struct RunTotals {
  uint64_t moved = 0;
  uint64_t blocked_by_wall = 0;
  uint64_t blocked_by_avatar = 0;
  uint64_t waited = 0;
  double seconds_total = 0;
  uint64_t checks = 0;
  CrowdCheck found;

  void add(const WanderReport& report) {
    moved += report.moved;
    blocked_by_wall += report.blocked_by_wall;
    blocked_by_avatar += report.blocked_by_avatar;
    waited += report.waited;
    seconds_total += report.seconds_total;
  }

  void add(const CrowdCheck& check) {
    ++checks;
    found.wall_entries += check.wall_entries;
    found.overlaps += check.overlaps;
  }
};

Json run_json(const RunOptions& options, const Wanderers& crowd, const RunTotals& totals,
              const RunTimes& times) {
  Json json = {{"world", options.world},
               {"class", options.class_name},
               {"avatars", crowd.size()},
               {"steps", times.steps()},
               {"dt", options.config.dt},
               {"seed", options.config.seed},
               {"threads", options.config.workers},
               {"moved", totals.moved},
               {"blocked", totals.blocked_by_wall + totals.blocked_by_avatar},
               {"blocked_by_wall", totals.blocked_by_wall},
               {"blocked_by_avatar", totals.blocked_by_avatar},
               {"waited", totals.waited},
               {"checks", totals.checks},
               {"wall_entries", totals.found.wall_entries},
               {"overlaps", totals.found.overlaps},
               {"state_hash", fmt::format("{:016x}", crowd.state_hash())},
               {"seconds_total", totals.seconds_total},
               {"crowd_bytes", crowd.bytes()},
               {"peak_bytes", peak_memory()}};
  times.add_to(json);
  return json;
}

std::string run_text(const RunOptions& options, const Wanderers& crowd, const RunTotals& totals,
                     const RunTimes& times) {
  return fmt::format(
      "{} {} avatars, {} steps of {} s: {}\n{}"
      "blocked {} times by walls, {} by avatars; waited {} times\n"
      "{} checks: {} wall entries, {} overlaps\n"
      "state {:016x}\n",
      crowd.size(), options.class_name, times.steps(), options.config.dt, times.text_of_steps(),
      times.text_of_parts(), totals.blocked_by_wall, totals.blocked_by_avatar, totals.waited,
      totals.checks, totals.found.wall_entries, totals.found.overlaps, crowd.state_hash());
}

// The class's index, by name or the first; fills in the name.
Result<int32_t> pick_class(const World& world, std::string& name) {
  if (name.empty()) name = world.summary().classes.front().name;
  return class_named(world, name);
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
  if (options.pushing) {
    run.config.tuning.queues = false;
    run.config.tuning.acceleration = 0;
  }
  if (auto ok = read_goals(run); !ok) return fail(ok.error());
  for (const std::string& group : options.also) {
    const size_t colon = group.rfind(':');
    uint32_t count = 0;
    const char* end = group.data() + group.size();
    const bool is_right = colon != std::string::npos && colon > 0 &&
                          std::from_chars(group.data() + colon + 1, end, count).ptr == end &&
                          count > 0;
    if (!is_right) {
      return fail({Errc::kBadConfig, "--also " + group + ": write CLASS:N, as in climber:50"});
    }
    run.also.emplace_back(group.substr(0, colon), count);
  }
  auto crowd =
      times.measure("prepare", [&] { return GoalCrowd::create(world, run, session.context); });
  if (!crowd) return fail(crowd.error());
  Sinks sinks(options.sinks);
  if (auto ok = sinks.open(world, {.world = options.world,
                                   .dt = run.config.dt,
                                   .model = kCrowdModel,
                                   .settings = crowd_settings(run).dump(),
                                   .leans = crowd->crowd().may_lean()});
      !ok)
    return fail(ok.error());
  const auto shown = [&](uint64_t step) { return sinks.add(step, crowd->crowd()); };
  return run_crowd(session, run, *crowd, times, shown, [&] { return sinks.finish(); });
}

int run_wanderers(Session& session, const World& world, const RunOptions& options,
                  RunTimes& times) {
  Result<Wanderers> crowd =
      times.measure("prepare", [&] { return Wanderers::create(world, options.config); });
  if (!crowd) return fail(crowd.error());
  Sinks sinks(options.sinks);
  auto ok = sinks.open(world,
                       {.world = options.world,
                        .dt = options.config.dt,
                        .model = kWanderersModel,
                        .settings = wanderers_settings(options.config, options.class_name).dump()});
  const auto write = [&](uint64_t step) {
    return times.measure("write", [&] { return sinks.add(step, *crowd); });
  };
  if (ok) ok = write(0);
  if (!ok) return fail(ok.error());
  RunTotals totals;
  for (uint64_t step = 1; step <= options.steps; ++step) {
    const WanderReport report = crowd->step();
    totals.add(report);
    times.add_step(report.seconds_total, crowd->size());
    times.add("sort", report.seconds_sort);
    times.add("move", report.seconds_move);
    if (step % options.check_every == 0 || step == options.steps) {
      totals.add(times.measure("check", [&] { return crowd->check(); }));
    }
    ok = write(step);
    if (!ok) return fail(ok.error());
    show_progress(session, "walk", step, options.steps);
    if (session.context.cancel) return fail({Errc::kCancelled, "run: interrupted"});
  }
  ok = times.measure("write", [&] { return sinks.finish(); });
  if (!ok) return fail(ok.error());
  print_result(session, run_json(options, *crowd, totals, times),
               run_text(options, *crowd, totals, times));
  return totals.found.wall_entries + totals.found.overlaps == 0 ? kDone : kAnswerIsNo;
}

int run_file(Session& session, const CLI::App& command, const RunOptions& options) {
  // These are in the scenario file, or belong to worlds alone.
  for (const char* name :
       {"--avatars", "--dt", "--class", "--speed", "--goals", "--wander", "--near", "--also",
        "--radius", "--labels", "--zones", "--search-memory"}) {
    if (command.count(name) == 0) continue;
    return fail({Errc::kBadConfig,
                 fmt::format("{} goes with a world; write it into {}", name, options.world)});
  }
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
Result<void> check_wander(const CLI::App& command) {
  for (const char* name :
       {"--goals", "--near", "--also", "--radius", "--labels", "--zones", "--search-memory",
        "--model", "--full-speed", "--ignore-jams", "--pushing"}) {
    if (command.count(name) == 0) continue;
    return Error{Errc::kBadConfig,
                 fmt::format("{} is for avatars with goals; leave out --wander", name)};
  }
  return {};
}

int run(Session& session, RunOptions& options) {
  RunTimes times;
  const Result<World> world = times.measure("open", [&] { return World::open(options.world); });
  if (!world) return fail(world.error());
  const Result<int32_t> avatar_class = pick_class(*world, options.class_name);
  if (!avatar_class) return fail(avatar_class.error());
  options.config.avatar_class = *avatar_class;
  if (options.check_every == 0) options.check_every = std::max<uint64_t>(1, options.steps / 10);
  options.crowd.steps = options.steps;
  options.crowd.check_every = options.check_every;
  return options.wander ? run_wanderers(session, *world, options, times)
                        : run_with_goals(session, *world, options, times);
}

}  // namespace

void add_run(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "run", "Move a crowd through a baked world, or run a scenario",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng run garage.throng --avatars 200 --steps 50 --trajectories walk.csv");
  const auto options = std::make_shared<RunOptions>();
  WanderConfig& config = options->config;
  command->add_option("world", options->world, "World folder, or a scenario file")
      ->required()
      ->type_name("WORLD|SCENARIO.toml");
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
  add_model(*command, options->crowd.config.model);
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
    const Result<void> fits = options->wander ? check_wander(*command) : Result<void>{};
    session.exit_code = fits ? run(session, *options) : fail(fits.error());
  });
}

}  // namespace throng::app
