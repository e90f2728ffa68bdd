// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/run_wanderers.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "in_world.h"
#include "run/rerun.h"
#include "throng/avatar.h"

// Times, checks and hashes a crowd of wanderers.
namespace throng::app {
namespace {

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

template <class Crowd>
Json run_json(const WanderRun& run, const Crowd& crowd, const RunTotals& totals,
              const RunTimes& times) {
  Json json = {{"world", run.world},
               {"class", run.class_name},
               {"avatars", crowd.size()},
               {"steps", times.steps()},
               {"dt", run.config.dt},
               {"seed", run.config.seed},
               {"threads", run.config.workers},
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
  if (!run.also.empty()) json["also"] = json_of(run.also);
  times.add_to(json);
  return json;
}

template <class Crowd>
std::string run_text(const WanderRun& run, const Crowd& crowd, const RunTotals& totals,
                     const RunTimes& times) {
  return fmt::format(
      "{} {} avatars, {} steps of {} s: {}\n{}"
      "blocked {} times by walls, {} by avatars; waited {} times\n"
      "{} checks: {} wall entries, {} overlaps\n"
      "state {:016x}\n",
      crowd.size(), class_names(run.class_name, run.also), times.steps(), run.config.dt,
      times.text_of_steps(), times.text_of_parts(), totals.blocked_by_wall,
      totals.blocked_by_avatar, totals.waited, totals.checks, totals.found.wall_entries,
      totals.found.overlaps, crowd.state_hash());
}

// Steps, checks and writes a crowd whose files are open.
template <class Crowd>
int run_steps(Session& session, const WanderRun& run, Crowd& crowd, Sinks& sinks, RunTimes& times) {
  const auto write = [&](uint64_t step) {
    return times.measure("write", [&] { return sinks.add(step, crowd); });
  };
  auto ok = write(0);
  if (!ok) return fail(ok.error());
  RunTotals totals;
  for (uint64_t step = 1; step <= run.steps; ++step) {
    const WanderReport report = crowd.step();
    totals.add(report);
    times.add_step(report.seconds_total, crowd.size());
    times.add("sort", report.seconds_sort);
    times.add("move", report.seconds_move);
    if (step % run.check_every == 0 || step == run.steps) {
      totals.add(times.measure("check", [&] { return crowd.check(); }));
    }
    ok = write(step);
    if (!ok) return fail(ok.error());
    show_progress(session, "walk", step, run.steps);
    if (session.context.cancel) return fail({Errc::kCancelled, "run: interrupted"});
  }
  ok = times.measure("write", [&] { return sinks.finish(); });
  if (!ok) return fail(ok.error());
  print_result(session, run_json(run, crowd, totals, times), run_text(run, crowd, totals, times));
  return totals.found.wall_entries + totals.found.overlaps == 0 ? kDone : kAnswerIsNo;
}

// One of the default classes.
Result<AvatarClass> default_class(const std::string& name, const char* option) {
  std::string names;
  for (AvatarClass& avatar : default_classes()) {
    if (avatar.name == name) return std::move(avatar);
    names += (names.empty() ? "" : ", ") + avatar.name;
  }
  return Error{
      Errc::kNotFound,
      fmt::format("{} {}: on slices there is no such class; choose from {}", option, name, names)};
}

}  // namespace

int run_wanderers(Session& session, const World& world, WanderRun run, RunTimes& times) {
  for (const AvatarGroup& group : run.also) {
    const Result<int32_t> avatar_class = class_named(world, group.class_name, "--also");
    if (!avatar_class) return fail(avatar_class.error());
    run.config.also.push_back({*avatar_class, group.avatars});
  }
  Result<Wanderers> crowd =
      times.measure("prepare", [&] { return Wanderers::create(world, run.config); });
  if (!crowd) return fail(crowd.error());
  Sinks sinks(run.sinks);
  const auto ok = sinks.open(world, {.world = run.world,
                                     .dt = run.config.dt,
                                     .model = kWanderersModel,
                                     .settings = wanderers_settings(run).dump()});
  if (!ok) return fail(ok.error());
  return run_steps(session, run, *crowd, sinks, times);
}

int run_slice_wanderers(Session& session, WanderRun run) {
  RunTimes times;
  if (!run.sinks.record.empty()) {
    return fail({Errc::kBadConfig, "--record goes with a world; of slices write --trajectories"});
  }
  Result<DepthSlices> slices = times.measure("open", [&] { return load_slices(run.world); });
  if (!slices) return fail(slices.error());
  if (run.class_name.empty()) run.class_name = AvatarClass{}.name;
  SliceWanderConfig config{
      .groups = {}, .dt = run.config.dt, .seed = run.config.seed, .workers = run.config.workers};
  std::vector<std::string> names;
  std::vector<AvatarGroup> groups{{run.class_name, run.config.avatars}};
  groups.insert(groups.end(), run.also.begin(), run.also.end());
  for (const AvatarGroup& group : groups) {
    const char* option = config.groups.empty() ? "--class" : "--also";
    Result<AvatarClass> avatar = default_class(group.class_name, option);
    if (!avatar) return fail(avatar.error());
    if (run.config.speed != 0) avatar->speed = run.config.speed;
    names.push_back(avatar->name);
    config.groups.push_back({*std::move(avatar), group.avatars});
  }
  Result<SliceWanderers> crowd =
      times.measure("prepare", [&] { return SliceWanderers::create(*std::move(slices), config); });
  if (!crowd) return fail(crowd.error());
  Sinks sinks(run.sinks);
  if (auto ok = sinks.open(std::move(names)); !ok) return fail(ok.error());
  return run_steps(session, run, *crowd, sinks, times);
}

}  // namespace throng::app
