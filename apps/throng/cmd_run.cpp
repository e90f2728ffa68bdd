// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

#include "command.h"
#include "output_file.h"
#include "rerun.h"
#include "run_recorder.h"
#include "throng/wanderers.h"
#include "throng/world.h"

// throng run: a crowd of wanderers in a baked world, timed, checked and hashed.
namespace throng::app {
namespace {

struct RunOptions {
  std::string world;
  std::string class_name;
  std::string trajectories;
  std::string record;
  uint64_t steps = 100;
  uint64_t every = 1;
  uint64_t check_every = 0;
  WanderConfig config;
};

// Sums over all steps.
struct RunTotals {
  uint64_t moved = 0;
  uint64_t blocked_by_wall = 0;
  uint64_t blocked_by_avatar = 0;
  uint64_t waited = 0;
  double seconds_sort = 0;
  double seconds_move = 0;
  double seconds_total = 0;
  std::vector<double> seconds;  // One a step, for the median.
  uint64_t checks = 0;
  CrowdCheck found;

  void add(const WanderReport& report) {
    moved += report.moved;
    blocked_by_wall += report.blocked_by_wall;
    blocked_by_avatar += report.blocked_by_avatar;
    waited += report.waited;
    seconds_sort += report.seconds_sort;
    seconds_move += report.seconds_move;
    seconds_total += report.seconds_total;
    seconds.push_back(report.seconds_total);
  }

  void add(const CrowdCheck& check) {
    ++checks;
    found.wall_entries += check.wall_entries;
    found.overlaps += check.overlaps;
  }

  [[nodiscard]] double median_seconds() const {
    std::vector<double> sorted = seconds;
    std::sort(sorted.begin(), sorted.end());
    const size_t n = sorted.size();
    return n == 0 ? 0 : (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
  }
};

// One line an avatar: step,id,class,x,y,z,radius.
class TrajectoryWriter {
 public:
  Result<void> open(const std::string& path, const AvatarClass& avatar) {
    avatar_ = avatar;
    Result<void> opened = file_.open(path);
    if (opened) file_.write("step,id,class,x,y,z,radius\n");
    return opened;
  }

  [[nodiscard]] bool is_open() const { return file_.is_open(); }

  void add(uint64_t step, const Wanderers& crowd) {
    crowd.read(states_);
    text_.clear();
    for (const AvatarState& state : states_) {
      const Vec3d& p = state.position;
      fmt::format_to(std::back_inserter(text_), "{},{},{},{:.4f},{:.4f},{:.4f},{:.4f}\n", step,
                     state.id, avatar_.name, p.x, p.y, p.z, avatar_.radius);
    }
    file_.write({text_.data(), text_.size()});
  }

  Result<void> finish() { return file_.finish(); }

 private:
  OutputFile file_;
  AvatarClass avatar_;
  std::vector<AvatarState> states_;
  fmt::memory_buffer text_;
};

double ns_per_avatar(double seconds, uint32_t avatars) {
  return avatars > 0 ? seconds * 1e9 / avatars : 0;
}

Json run_json(const RunOptions& options, const Wanderers& crowd, const RunTotals& totals) {
  const double steps = std::max<double>(1, static_cast<double>(totals.seconds.size()));
  return {{"world", options.world},
          {"class", options.class_name},
          {"avatars", crowd.size()},
          {"steps", totals.seconds.size()},
          {"dt", options.config.dt},
          {"seed", options.config.seed},
          {"threads", options.config.workers},
          {"ns_per_avatar_step", ns_per_avatar(totals.median_seconds(), crowd.size())},
          {"ns_per_avatar_step_mean", ns_per_avatar(totals.seconds_total / steps, crowd.size())},
          {"moved", totals.moved},
          {"blocked", totals.blocked_by_wall + totals.blocked_by_avatar},
          {"blocked_by_wall", totals.blocked_by_wall},
          {"blocked_by_avatar", totals.blocked_by_avatar},
          {"waited", totals.waited},
          {"checks", totals.checks},
          {"wall_entries", totals.found.wall_entries},
          {"overlaps", totals.found.overlaps},
          {"state_hash", fmt::format("{:016x}", crowd.state_hash())},
          {"seconds_sort", totals.seconds_sort},
          {"seconds_move", totals.seconds_move},
          {"seconds_total", totals.seconds_total},
          {"crowd_bytes", crowd.bytes()},
          {"peak_bytes", peak_memory()}};
}

std::string run_text(const RunOptions& options, const Wanderers& crowd, const RunTotals& totals) {
  return fmt::format(
      "{} {} avatars, {} steps of {} s: {:.1f} ns an avatar a step (median)\n"
      "blocked {} times by walls, {} by avatars; waited {} times\n"
      "{} checks: {} wall entries, {} overlaps\n"
      "state {:016x}\n",
      crowd.size(), options.class_name, totals.seconds.size(), options.config.dt,
      ns_per_avatar(totals.median_seconds(), crowd.size()), totals.blocked_by_wall,
      totals.blocked_by_avatar, totals.waited, totals.checks, totals.found.wall_entries,
      totals.found.overlaps, crowd.state_hash());
}

// Every `every`-th step as a frame, of the others the hash alone.
Result<void> record_step(const RunOptions& options, uint64_t step, const Wanderers& crowd,
                         std::vector<AvatarState>& states, RunRecorder& recorder) {
  if (step % options.every != 0) return recorder.add_hash(step, crowd.state_hash());
  crowd.read(states);
  return recorder.add(step, crowd.state_hash(), states);
}

// The class's index, by name or the first; fills in the name.
Result<int32_t> pick_class(const World& world, std::string& name) {
  if (name.empty()) name = world.summary().classes.front().name;
  return class_named(world, name);
}

int run(Session& session, RunOptions& options) {
  const Result<World> world = World::open(options.world);
  if (!world) return fail(world.error());
  const Result<int32_t> avatar_class = pick_class(*world, options.class_name);
  if (!avatar_class) return fail(avatar_class.error());
  options.config.avatar_class = *avatar_class;
  Result<Wanderers> crowd = Wanderers::create(*world, options.config);
  if (!crowd) return fail(crowd.error());

  TrajectoryWriter trajectories;
  if (!options.trajectories.empty()) {
    const AvatarClass avatar = world->summary().classes[static_cast<size_t>(*avatar_class)];
    const Result<void> opened = trajectories.open(options.trajectories, avatar);
    if (!opened) return fail(opened.error());
    trajectories.add(0, *crowd);
  }
  RunRecorder recorder;
  std::vector<AvatarState> states;
  if (!options.record.empty()) {
    Result<void> ok =
        recorder.open(options.record, options.world, *world, options.config.dt, kWanderersModel,
                      wanderers_settings(options.config, options.class_name));
    if (ok) ok = record_step(options, 0, *crowd, states, recorder);
    if (!ok) return fail(ok.error());
  }
  const uint64_t check_every =
      options.check_every > 0 ? options.check_every : std::max<uint64_t>(1, options.steps / 10);
  RunTotals totals;
  for (uint64_t step = 1; step <= options.steps; ++step) {
    totals.add(crowd->step());
    if (step % check_every == 0 || step == options.steps) totals.add(crowd->check());
    if (trajectories.is_open() && step % options.every == 0) trajectories.add(step, *crowd);
    if (recorder.is_open()) {
      const Result<void> ok = record_step(options, step, *crowd, states, recorder);
      if (!ok) return fail(ok.error());
    }
    show_progress(session, "walk", step, options.steps);
    if (session.context.cancel) return fail({Errc::kCancelled, "run: interrupted"});
  }
  if (trajectories.is_open()) {
    const Result<void> finished = trajectories.finish();
    if (!finished) return fail(finished.error());
  }
  if (recorder.is_open()) {
    const Result<void> finished = recorder.finish();
    if (!finished) return fail(finished.error());
  }
  print_result(session, run_json(options, *crowd, totals), run_text(options, *crowd, totals));
  return totals.found.wall_entries + totals.found.overlaps == 0 ? kDone : kAnswerIsNo;
}

}  // namespace

void add_run(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "run", "Walk a crowd through a baked world",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng run garage.throng --avatars 200 --steps 50 --trajectories walk.csv");
  const auto options = std::make_shared<RunOptions>();
  WanderConfig& config = options->config;
  command->add_option("world", options->world, "World folder")->required()->type_name("WORLD");
  command->add_option("--avatars", config.avatars, "How many")->capture_default_str();
  command->add_option("--steps", options->steps, "How many steps")->capture_default_str();
  command->add_option("--dt", config.dt, "Length of a step [s]")->capture_default_str();
  command->add_option("--seed", config.seed, "Seed of all chance")->capture_default_str();
  command->add_option("--threads", config.workers, "Threads, 0 for all cores");
  command->add_option("--class", options->class_name, "Avatar class (the world's first)");
  command->add_option("--speed", config.speed, "Walking speed, 0 for the class's own [m/s]");
  command->add_option("--trajectories", options->trajectories, "Write positions to this file")
      ->type_name("FILE.csv");
  command->add_option("--record", options->record, "Record the run in this file")
      ->type_name("FILE.replay");
  command->add_option("--every", options->every, "Write each K-th step")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--check-every", options->check_every,
                      "Look for walls entered and overlaps each K-th step, 0 for ten times a run");
  command->callback([&session, options] { session.exit_code = run(session, *options); });
}

}  // namespace throng::app
