// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/run_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "input_file.h"
#include "output_file.h"
#include "run/run_crowd.h"
#include "run/run_times.h"
#include "throng/bake.h"

// Runs a scenario file and writes its trips, obstacles and counts.
namespace throng::app {
namespace {

// Avatars that left, per exit area.
struct ExitCount {
  uint64_t left = 0;
  double first = 0, last = 0;  // [s]
};

struct Outcome {
  std::map<std::string, ExitCount> exits;
  double last = 0;       // [s]
  double mean_time = 0;  // from start to exit [s]
};

Outcome outcome_of(const Scenario& scenario, const Simulation& simulation) {
  Outcome out;
  uint64_t left = 0;
  for (const Trip& trip : simulation.trips()) {
    if (trip.left < 0) continue;
    ExitCount& exit = out.exits[scenario.areas[static_cast<size_t>(trip.exit)].name];
    if (exit.left++ == 0) exit.first = trip.left;
    exit.first = std::min(exit.first, trip.left);
    exit.last = std::max(exit.last, trip.left);
    out.last = std::max(out.last, trip.left);
    out.mean_time += trip.left - trip.started;
    ++left;
  }
  if (left > 0) out.mean_time /= static_cast<double>(left);
  return out;
}

template <class Things>
std::string name_in(const Things& things, int32_t index) {
  return index < 0 ? "" : things[static_cast<size_t>(index)].name;
}

Result<void> write_trips(const std::string& path, const Scenario& scenario,
                         const Simulation& simulation) {
  OutputFile file;
  if (auto ok = file.open(path); !ok) return ok;
  file.write("person,source,profile,journey,speed,entered,started,left,exit\n");
  const auto time = [](double t) { return t < 0 ? std::string() : fmt::format("{:.3f}", t); };
  for (const Trip& v : simulation.trips()) {
    if (v.entered < 0) continue;
    file.write(fmt::format(
        "{},{},{},{},{:.4f},{},{},{},{}\n", v.person, name_in(scenario.sources, v.source),
        name_in(scenario.profiles, v.profile), name_in(scenario.journeys, v.journey), v.speed,
        time(v.entered), time(v.started), time(v.left), name_in(scenario.areas, v.exit)));
  }
  return file.finish();
}

// The times of an obstacle in a sentence.
std::string words_for(const ScenarioObstacle& obstacle, const ObstacleTimes& times) {
  std::string words = fmt::format("to come at {:.1f} s, ", times.requested_at);
  if (times.up >= 0) {
    words += fmt::format("up at {:.1f} s", times.up);
  } else if (times.removed_at >= 0) {
    words += fmt::format("never up until it went at {:.1f} s", times.removed_at);
  } else {
    words += fmt::format("still open: {} avatars are in it", times.waits_for);
  }
  if (times.inside > 0) words += fmt::format("; {} avatars were in it then", times.inside);
  if (obstacle.policy == ObstaclePolicy::kWait) words += "; it waits until it is free";
  return words;
}

// A line for each obstacle whose time has come; all of them into `json`.
std::string obstacle_lines(const Scenario& scenario, const Simulation& simulation, Json& json) {
  std::string lines;
  for (size_t n = 0; n < scenario.obstacles.size(); ++n) {
    const ScenarioObstacle& obstacle = scenario.obstacles[n];
    const ObstacleTimes& times = simulation.obstacle_times()[n];
    const auto time = [](double t) { return t < 0 ? Json(nullptr) : Json(t); };
    const std::string words = times.requested_at < 0 ? "" : words_for(obstacle, times);
    json[obstacle.name] = {{"policy", name_of(obstacle.policy)},
                           {"requested_at", time(times.requested_at)},
                           {"up", time(times.up)},
                           {"removed_at", time(times.removed_at)},
                           {"inside", times.inside},
                           {"waits_for", times.waits_for},
                           {"words", words}};
    if (!words.empty()) lines += fmt::format("  obstacle {}: {}\n", obstacle.name, words);
  }
  return lines;
}

Result<void> write_obstacles(const std::string& path, const Scenario& scenario,
                             const Simulation& simulation) {
  OutputFile file;
  if (auto ok = file.open(path); !ok) return ok;
  file.write("obstacle,policy,requested_at,up,removed_at,inside,waits_for\n");
  const auto time = [](double t) { return t < 0 ? std::string() : fmt::format("{:.3f}", t); };
  for (size_t n = 0; n < scenario.obstacles.size(); ++n) {
    const ScenarioObstacle& obstacle = scenario.obstacles[n];
    const ObstacleTimes& times = simulation.obstacle_times()[n];
    file.write(fmt::format("{},{},{},{},{},{},{}\n", obstacle.name, name_of(obstacle.policy),
                           time(times.requested_at), time(times.up), time(times.removed_at),
                           times.inside, times.waits_for));
  }
  return file.finish();
}

struct ScenarioTotals {
  uint64_t steps = 0, max_avatars = 0, checks = 0, out_of_memory = 0;
  uint64_t jam_searches = 0, changed_route = 0;
  double avatar_steps = 0, progress = 0;
  CrowdCheck found;
  SimulationReport last;
};

void print(Session& session, const ScenarioRun& run, const Scenario& scenario,
           const Simulation& simulation, const ScenarioTotals& t, const RunTimes& times) {
  const Outcome outcome = outcome_of(scenario, simulation);
  const uint64_t hash = simulation.state_hash();
  const double progress = t.avatar_steps > 0 ? t.progress / t.avatar_steps : 0;
  Json exits = Json::object();
  std::string lines;
  for (const auto& [name, exit] : outcome.exits) {
    exits[name] = {{"left", exit.left}, {"first", exit.first}, {"last", exit.last}};
    lines += fmt::format("  {:<16} {:6} avatars, {:.1f} to {:.1f} s\n", name, exit.left, exit.first,
                         exit.last);
  }
  Json obstacles = Json::object();
  lines += obstacle_lines(scenario, simulation, obstacles);
  Json json = {{"scenario", run.file},
               {"steps", t.steps},
               {"seconds", t.last.time},
               {"dt", scenario.dt},
               {"model", name_of(scenario.steering)},
               {"slow_on_slopes", scenario.slow_on_slopes},
               {"avoid_jams", scenario.avoid_jams},
               {"pushing", scenario.pushing},
               {"acceleration", scenario.acceleration},
               {"seed", scenario.seed},
               {"threads", run.workers},
               {"entered", t.last.entered},
               {"left", t.last.left},
               {"still_here", simulation.crowd().size()},
               {"outside", t.last.outside},
               {"in_links", t.last.in_links},
               {"goal_unreachable", t.last.goal_unreachable},
               {"max_at_a_time", t.max_avatars},
               {"last_left", outcome.last},
               {"mean_time", outcome.mean_time},
               {"exits", exits},
               {"obstacles", obstacles},
               {"progress", progress},
               {"out_of_memory", t.out_of_memory},
               {"jam_searches", t.jam_searches},
               {"changed_route", t.changed_route},
               {"checks", t.checks},
               {"wall_entries", t.found.wall_entries},
               {"overlaps", t.found.overlaps},
               {"obstacle_entries", t.found.obstacle_entries},
               {"state_hash", fmt::format("{:016x}", hash)},
               {"peak_bytes", peak_memory()}};
  if (t.last.crowd.ranks > 1) json["ranks"] = t.last.crowd.ranks;
  times.add_to(json);
  if (rank_info().rank > 0) return;  // All know the same.
  print_result(
      session, json,
      fmt::format("{}: {:.1f} s, {} avatars came, {} left, {} are still here\n{}"
                  "the last left after {:.1f} s; a trip took {:.1f} s in the mean\n"
                  "{} with an unreachable goal, {} without room to come in\n{}\n{}{}"
                  "{} checks: {} wall entries, {} overlaps, {} in obstacles\nstate {:016x}\n",
                  run.file, t.last.time, t.last.entered, t.last.left, simulation.crowd().size(),
                  lines, outcome.last, outcome.mean_time, t.last.goal_unreachable, t.last.outside,
                  times.text_of_steps(), times.text_of_parts(),
                  memory_text(t.out_of_memory, "search_memory"), t.checks, t.found.wall_entries,
                  t.found.overlaps, t.found.obstacle_entries, hash));
}

Result<ScenarioTotals> run_steps(Session& session, const ScenarioRun& run, const Scenario& scenario,
                                 Simulation& simulation, Sinks& sinks, RunTimes& times) {
  ScenarioTotals t;
  const uint64_t steps =
      run.steps.value_or(static_cast<uint64_t>(std::ceil(scenario.seconds / scenario.dt - 1e-9)));
  const uint64_t check_every =
      run.check_every > 0 ? run.check_every : std::max<uint64_t>(1, steps / 10);
  t.last.entered = simulation.crowd().size();
  const auto check = [&] {
    const CrowdCheck found = times.measure("check", [&] { return simulation.crowd().check(); });
    ++t.checks;
    t.found.wall_entries += found.wall_entries;
    t.found.overlaps += found.overlaps;
    t.found.obstacle_entries += found.obstacle_entries;
  };
  const auto write = [&](uint64_t step) {
    return times.measure("write", [&] { return sinks.add(step, simulation); });
  };
  if (auto ok = write(0); !ok) return ok.error();
  while (t.steps < steps && (run.steps || !simulation.is_over())) {
    const auto start = RunTimes::Clock::now();
    const auto report = simulation.step();
    if (!report) return report.error();
    const double whole = std::chrono::duration<double>(RunTimes::Clock::now() - start).count();
    add_step(report->crowd, times);
    times.add("journeys", whole - report->crowd.seconds_total);
    ++t.steps;
    t.last = *report;
    const auto avatars = static_cast<double>(report->crowd.avatars);
    t.max_avatars = std::max(t.max_avatars, report->crowd.avatars);
    t.avatar_steps += avatars;
    t.out_of_memory += report->crowd.out_of_memory;
    t.jam_searches += report->crowd.jam_searches;
    t.changed_route += report->crowd.changed_route;
    t.progress += report->crowd.progress * avatars;
    if (t.steps % check_every == 0) check();
    if (auto ok = write(t.steps); !ok) return ok.error();
    show_progress(session, "run", t.steps, steps);
    if (session.context.cancel) return Error{Errc::kCancelled, "run: interrupted"};
  }
  check();
  Json obstacles = Json::object();
  const std::string lines = obstacle_lines(scenario, simulation, obstacles);
  const Json outcome = {{"obstacles", obstacles}};
  const std::string text = lines.empty() ? "" : outcome.dump();
  if (auto ok = times.measure("write", [&] { return sinks.finish(text); }); !ok) {
    return ok.error();
  }
  return t;
}

Result<int> try_run(Session& session, ScenarioRun& run) {
  RunTimes times;
  auto text = read_file(run.file, "name a scenario file (.toml or .json) or a world folder");
  if (!text) return text.error();
  run.text = *std::move(text);
  auto scenario = parse_scenario(run.text, run.file);
  if (!scenario) return scenario.error();
  if (run.seed) scenario->seed = *run.seed;
  if (run.model) scenario->steering = *run.model;
  if (run.full_speed) scenario->slow_on_slopes = false;
  if (run.ignore_jams) scenario->avoid_jams = false;
  if (run.pushing) scenario->let_push();
  const auto world = times.measure("open", [&] { return open_world(*scenario, session.context); });
  if (!world) return world.error();
  auto simulation = times.measure("prepare", [&] {
    return Simulation::create_over_ranks(*world, *scenario, run.workers, session.context);
  });
  if (!simulation) return simulation.error();
  Sinks sinks(run.sinks);
  // Absolute: pictures, models and worlds of the scenario are found from any folder later.
  const auto whole = [](const std::string& path) {
    std::error_code failed;
    const auto absolute = std::filesystem::absolute(path, failed);
    return failed ? path : absolute.lexically_normal().string();
  };
  const Json settings = {{"scenario", run.text},
                         {"file", whole(run.file)},
                         {"seed", scenario->seed},
                         {"model", name_of(scenario->steering)},
                         {"slow_on_slopes", scenario->slow_on_slopes},
                         {"avoid_jams", scenario->avoid_jams},
                         {"pushing", scenario->pushing},
                         {"acceleration", scenario->acceleration}};
  auto ok =
      sinks.open(*world, {.world = scenario->world.empty() ? run.file : whole(scenario->world),
                          .dt = scenario->dt,
                          .model = kScenarioModel,
                          .settings = settings.dump(),
                          .leans = simulation->crowd().may_lean()});
  if (!ok) return ok.error();
  const auto totals = run_steps(session, run, *scenario, *simulation, sinks, times);
  if (!totals) return totals.error();
  if (rank_info().rank == 0) {
    if (!run.trips.empty()) ok = write_trips(run.trips, *scenario, *simulation);
    if (ok && !run.obstacles.empty()) ok = write_obstacles(run.obstacles, *scenario, *simulation);
  }
  if (ok = agree_over_ranks(ok); !ok) return ok.error();
  print(session, run, *scenario, *simulation, *totals, times);
  const CrowdCheck& found = totals->found;
  const bool sound = found.wall_entries + found.overlaps + found.obstacle_entries == 0;
  return sound ? kDone : kAnswerIsNo;
}

}  // namespace

bool is_scenario_file(const std::string& name) {
  return (name.ends_with(".toml") || name.ends_with(".json")) &&
         !std::filesystem::is_directory(name);
}

int run_scenario(Session& session, ScenarioRun& run) {
  const Result<int> code = try_run(session, run);
  return code ? *code : fail(code.error());
}

Result<Scenario> recorded_scenario(const Json& settings) {
  const auto text = settings.find("scenario"), file = settings.find("file"),
             seed = settings.find("seed");
  const bool is_right = text != settings.end() && text->is_string() && file != settings.end() &&
                        file->is_string() && seed != settings.end() && seed->is_number_unsigned();
  if (!is_right) {
    return Error{Errc::kBadFile,
                 "the recording's settings hold no scenario; record the run again "
                 "with this program"};
  }
  auto scenario = parse_scenario(text->get<std::string>(), file->get<std::string>());
  if (!scenario) return scenario;
  scenario->seed = *seed;
  // Older recordings do not have it: nothing slowed their avatars.
  const auto slow = settings.find("slow_on_slopes");
  scenario->slow_on_slopes = slow != settings.end() && *slow == true;
  const auto avoid = settings.find("avoid_jams");  // The same: none took another route.
  scenario->avoid_jams = avoid != settings.end() && *avoid == true;
  const auto pushing = settings.find("pushing");  // The same: all pushed, with no limit.
  scenario->pushing = pushing == settings.end() || *pushing == true;
  const auto limit = settings.find("acceleration");
  scenario->acceleration = limit != settings.end() && limit->is_number() ? limit->get<double>() : 0;
  const auto name = settings.find("model");
  if (name == settings.end()) return scenario;  // as the file says
  const auto model =
      name->is_string() ? find_steering_model(name->get<std::string>()) : std::nullopt;
  if (!model) {
    return Error{
        Errc::kBadFile,
        "the recording is of a model that this program does not know; use the program that "
        "recorded it"};
  }
  scenario->steering = *model;
  return scenario;
}

}  // namespace throng::app
