// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/run_crowd.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "input_file.h"
#include "run/rerun.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/world.h"

// A crowd of avatars that get one goal after the other: random places, or those of a file.
namespace throng::app {
namespace {

constexpr double kNearGround = 2;       // max distance of a goal of a file from the ground [m]
constexpr double kStorey = 4;           // vertical tolerance of a random goal [m]
constexpr uint64_t kDrawsPerGoal = 32;  // random points per goal
constexpr uint64_t kPlaces = 1024;      // random places of nodes per goal
constexpr uint64_t kAir = 0x616972;     // stream of random numbers

// Uniform in [0, 1), of a stream.
double random_number(uint64_t seed, uint64_t stream, uint64_t n) {
  uint64_t x = (seed * 0x9e3779b97f4a7c15ULL + stream) * 0xd1342543de82ef95ULL + n;
  for (int i = 0; i < 3; ++i) x = (x ^ (x >> 31)) * 0xbf58476d1ce4e5b9ULL;
  return static_cast<double>(x >> 11) * 0x1p-53;
}

// The three numbers of a line "x,y,z"; null if it is another.
std::optional<Vec3d> numbers_of(const std::string& line) {
  double v[3];
  const char* at = line.c_str();
  for (int i = 0; i < 3; ++i) {
    char* end = nullptr;
    v[i] = std::strtod(at, &end);
    if (end == at || (i < 2 && *end != ',')) return std::nullopt;
    at = end + 1;
    if (i == 2 && *end != '\0' && *end != '\r') return std::nullopt;
  }
  return Vec3d{v[0], v[1], v[2]};
}

struct Totals {
  CrowdReport sum;
  double progress = 0;
  uint64_t checks = 0;
  CrowdCheck found;
  uint64_t ranks = 1, most_avatars = 0;
  std::vector<uint64_t> sent_bytes;  // of each step, by the rank that sent most

  void add(const CrowdReport& r) {
    ranks = static_cast<uint64_t>(r.ranks);
    most_avatars = r.most_avatars;  // at the end
    if (r.ranks > 1) sent_bytes.push_back(r.sent_bytes);
    sum.stood += r.stood;
    sum.contested += r.contested;
    sum.arrived += r.arrived;
    sum.planned += r.planned;
    sum.no_path += r.no_path;
    sum.jam_searches += r.jam_searches;
    sum.changed_route += r.changed_route;
    sum.flying = r.flying;  // at the end
    sum.climbing = r.climbing;
    sum.out_of_memory += r.out_of_memory;
    sum.seconds_total += r.seconds_total;
    progress += r.progress;
  }
  void add(const CrowdCheck& check) {
    ++checks;
    found.wall_entries += check.wall_entries;
    found.overlaps += check.overlaps;
  }
};

// The first step is not like the others: it shows neighbours all that they see.
uint64_t median_of(std::vector<uint64_t> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string rank_text(const Totals& t) {
  if (t.ranks <= 1) return {};
  return fmt::format("{} ranks, at most {} avatars on one; {:.1f} kB sent by one in a step\n",
                     t.ranks, t.most_avatars, static_cast<double>(median_of(t.sent_bytes)) * 1e-3);
}

// What all ranks know; rank 0 prints it.
void print(Session& session, const CrowdRun& run, const Crowd& crowd, const Totals& t,
           const RunTimes& times) {
  const CurvilinearTuning& curves = run.config.tuning.curvilinear;
  const auto steps = std::max<double>(1, static_cast<double>(times.steps()));
  Json json = {{"world", run.world_name},
               {"class", run.class_name},
               {"goals", run.goals},
               {"model", name_of(run.config.model)},
               {"slow_on_slopes", run.config.slow_on_slopes},
               {"avoid_jams", run.config.avoid_jams},
               {"pushing", !run.config.tuning.queues},
               {"acceleration", run.config.tuning.acceleration},
               {"set", Json::array({curves.mass, curves.max_speed, curves.max_force})},
               {"by_state", curves.by_state},
               {"avatars", crowd.size()},
               {"steps", times.steps()},
               {"dt", run.config.dt},
               {"seed", run.config.seed},
               {"threads", run.config.workers},
               {"progress", t.progress / steps},
               {"arrived", t.sum.arrived},
               {"planned", t.sum.planned},
               {"no_path", t.sum.no_path},
               {"out_of_memory", t.sum.out_of_memory},
               {"jam_searches", t.sum.jam_searches},
               {"changed_route", t.sum.changed_route},
               {"flying", t.sum.flying},
               {"climbing", t.sum.climbing},
               {"blocked", t.sum.stood},
               {"contested", t.sum.contested},
               {"checks", t.checks},
               {"wall_entries", t.found.wall_entries},
               {"overlaps", t.found.overlaps},
               {"state_hash", ""},
               {"seconds_total", t.sum.seconds_total},
               {"crowd_bytes", crowd.memory().total()},
               {"peak_bytes", peak_memory()}};
  if (!run.also.empty()) json["also"] = json_of(run.also);
  if (run.config.tuning.flyer_axes != FlyerAxes::kOurs) {
    json["axes"] = word_for(run.config.tuning.flyer_axes);
  }
  if (t.ranks > 1) {
    json["ranks"] = t.ranks;
    json["most_avatars"] = t.most_avatars;
    json["sent_bytes"] = median_of(t.sent_bytes);
  }
  const uint64_t hash = crowd.state_hash();
  json["state_hash"] = fmt::format("{:016x}", hash);
  times.add_to(json);
  if (rank_info().rank > 0) return;
  print_result(
      session, json,
      fmt::format(
          "{} {} avatars, {} steps of {} s: {}\n{}"
          "{} goals reached, {} paths planned, {} goals without a path; mean progress {:.2f} of "
          "the speed\n{}"
          "{} checks: {} wall entries, {} overlaps\n"
          "state {:016x}\n",
          crowd.size(), class_names(run.class_name, run.also), times.steps(), run.config.dt,
          times.text_of_steps(), times.text_of_parts(), t.sum.arrived, t.sum.planned, t.sum.no_path,
          t.progress / steps, memory_text(t.sum.out_of_memory, "--search-memory"), t.checks,
          t.found.wall_entries, t.found.overlaps, hash) +
          rank_text(t));
}

// If another rank dies, this one is ended while it waits for it: in a step, or at its end.
void set_last_words(const CrowdRun& run, uint64_t step, std::optional<uint64_t> saved_at) {
  if (rank_info().size <= 1) return;
  const std::string& file =
      run.checkpoints.write.empty() ? run.checkpoints.resume : run.checkpoints.write;
  const std::string remedy =
      saved_at ? fmt::format("go on from step {} with --resume {}", *saved_at, file)
               : std::string("start it again; with --checkpoint FILE it can go on");
  last_words(fmt::format("run: ended in step {}, by a signal or because a rank has died; {}", step,
                         remedy));
}

}  // namespace

Result<void> read_goals(CrowdRun& run) {
  if (run.goals == "random") return {};
  auto text = read_file(run.goals, "give --goals 'random' or a file of lines x,y,z");
  if (!text) return text.error();
  run.goals_text = *std::move(text);
  return {};
}

GoalCrowd::GoalCrowd(const World& world, const CrowdRun& run, Crowd&& crowd)
    : world_(world), run_(run), crowd_(std::move(crowd)) {}

Result<GoalCrowd> GoalCrowd::create(const World& world, const CrowdRun& run, Context& context) {
  return create(world, run, nullptr, context);
}

Result<GoalCrowd> GoalCrowd::restore(const World& world, const CrowdRun& run,
                                     const Checkpoint& checkpoint, Context& context) {
  return create(world, run, &checkpoint, context);
}

Checkpoint GoalCrowd::checkpoint(const Json& settings) const {
  return {.step = steps_,
          .settings = settings,
          .world = world_.summary().hash,
          .given = given_,
          .crowd = crowd_.save()};
}

Result<void> GoalCrowd::add_restored(const std::string& class_name, uint32_t count) {
  const Result<int32_t> avatar_class = class_named(world_, class_name);
  if (!avatar_class) return avatar_class.error();
  class_of_.resize(class_of_.size() + count, *avatar_class);
  while (all_.size() < class_of_.size()) {  // No avatar is ever removed.
    all_.push_back({.slot1 = static_cast<uint32_t>(all_.size() + 1), .generation = 1});
  }
  return {};
}

Result<GoalCrowd> GoalCrowd::create(const World& world, const CrowdRun& run,
                                    const Checkpoint* checkpoint, Context& context) {
  CrowdRun with_nodes = run;
  const std::vector<AvatarClass> classes = world.summary().classes;
  std::vector<AvatarGroup> groups = run.also;
  groups.insert(groups.begin(), {run.class_name, run.avatars});
  bool wants_nodes = false;
  for (size_t g = 0; g < groups.size(); ++g) {
    const Result<int32_t> avatar_class =
        class_named(world, groups[g].class_name, g == 0 ? "--class" : "--also");
    if (!avatar_class) return avatar_class.error();
    const AvatarClass& avatar = classes[static_cast<size_t>(*avatar_class)];
    // A world baked for such a class has nodes; without nodes it walks.
    wants_nodes = wants_nodes || throng::goes_over_nodes(avatar);
  }
  if (wants_nodes && Nodes::exist(world)) {
    auto nodes = Nodes::open(world);
    if (!nodes) return nodes.error();
    with_nodes.config.nodes = *std::move(nodes);
  }
  auto crowd = checkpoint == nullptr
                   ? crowd_over_ranks(world, with_nodes.config)
                   : restore_over_ranks(world, with_nodes.config, checkpoint->crowd, context);
  if (!crowd) return crowd.error();
  GoalCrowd made(world, with_nodes, std::move(*crowd));
  for (const auto& [name, count] : groups) {
    const auto ok =
        checkpoint == nullptr ? made.scatter(name, count, context) : made.add_restored(name, count);
    if (!ok) return ok.error();
  }
  for (const SetChange& change : run.set_changes) {
    if (change.avatar.value_or(0) < made.all_.size()) continue;
    return Error{Errc::kBadConfig, fmt::format("--set-at {}: there are {} avatars, from 0 on",
                                               *change.avatar, made.all_.size())};
  }
  if (auto ok = made.read_places(); !ok) return ok.error();
  made.given_.resize(made.class_of_.size());
  if (checkpoint != nullptr) {
    if (checkpoint->given.size() != made.given_.size() || made.crowd_.size() != made.all_.size()) {
      return Error{Errc::kBadFile, "the checkpoint has other avatars; start the run again"};
    }
    made.given_ = checkpoint->given;
    made.steps_ = checkpoint->step;
  } else {
    made.give(made.all_);
  }
  return made;
}

Result<void> GoalCrowd::scatter(const std::string& class_name, uint32_t count, Context& context) {
  const Result<int32_t> avatar_class = class_named(world_, class_name);
  if (!avatar_class) return avatar_class.error();
  AvatarSpawn like{
      .place = {}, .avatar_class = *avatar_class, .radius = run_.radius, .speed = run_.speed};
  const bool flies = world_.summary().classes[static_cast<size_t>(*avatar_class)].flies;
  if (flies) like.place = air_place({});
  auto ids = crowd_.scatter(count, like, context);
  if (!ids && flies && ids.error().code == Errc::kBadConfig) {
    like.place = {};  // A flyer walks in a world without air.
    ids = crowd_.scatter(count, like, context);
  }
  if (!ids) return ids.error();
  class_of_.resize(class_of_.size() + ids->size(), *avatar_class);
  all_.insert(all_.end(), ids->begin(), ids->end());
  return {};
}

bool GoalCrowd::flies(int32_t avatar_class) const {
  return world_.summary().classes[static_cast<size_t>(avatar_class)].flies;
}

bool GoalCrowd::goes_over_nodes(int32_t avatar_class) const {
  const AvatarClass avatar = world_.summary().classes[static_cast<size_t>(avatar_class)];
  return run_.config.nodes && !avatar.flies && throng::goes_over_nodes(avatar);
}

Result<void> GoalCrowd::read_places() {
  if (run_.goals == "random") return {};
  const auto bad = [&](size_t line, const std::string& what) {
    return Error{Errc::kBadFile, run_.goals + ":" + std::to_string(line) + ": " + what};
  };
  // All classes share the file. It is checked for the first; others may not reach each goal.
  const int32_t avatar_class = class_of_.empty() ? 0 : class_of_[0];
  const bool over_nodes = goes_over_nodes(avatar_class);
  auto query = GroundQuery::create(world_, avatar_class);
  if (!query) return query.error();
  std::istringstream lines(run_.goals_text);
  std::string line;
  for (size_t n = 1; std::getline(lines, line); ++n) {
    if (line.empty() || line[0] == '#' || line == "\r") continue;
    const auto at = numbers_of(line);
    if (!at) return bad(n, "is no goal; write x,y,z in metres");
    // The crowd uses the position alone of a climber's goal.
    const Place place = over_nodes ? Place{*at, 1} : query->nearest_place(*at, kNearGround);
    const bool in_air = !place && crowd_.may_fly(avatar_class, *at);
    if (!place && !in_air) {
      return bad(n, "no avatar of this class can stand within 2 m of it; move it");
    }
    places_.push_back(in_air ? air_place(*at) : place);
  }
  if (places_.empty()) return bad(1, "has no goals; write lines x,y,z in metres");
  return {};
}

// A random goal in the air; null if none was found or the class does not fly.
Place GoalCrowd::goal_in_air(uint32_t slot, uint64_t nth, const Vec3d& from) const {
  if (!flies(class_of_[slot])) return {};
  const int32_t avatar_class = class_of_[slot];
  const uint64_t seed = run_.config.seed ^ kAir;
  if (run_.near <= 0) {
    const auto point = crowd_.random_air_point(avatar_class, seed, uint64_t{slot} << 32 | nth);
    return point ? air_place(*point) : Place{};
  }
  for (uint64_t n = nth * kDrawsPerGoal; n < (nth + 1) * kDrawsPerGoal; ++n) {
    const auto offset = [&](uint64_t stream) {
      return run_.near * (2 * random_number(seed, 3 * uint64_t{slot} + stream, n) - 1);
    };
    const Vec3d at{from.x + offset(0), from.y + offset(1), from.z + offset(2)};
    if (crowd_.may_fly(avatar_class, at)) return air_place(at);
  }
  return {};
}

// The n-th goal of an avatar.
Place GoalCrowd::goal(uint32_t slot, uint64_t nth, const Vec3d& from) const {
  if (!places_.empty()) return places_[(slot + nth) % places_.size()];
  const int32_t avatar_class = class_of_[slot];
  if ((slot + nth) % 2 == 0) {
    const Place place = goal_in_air(slot, nth, from);
    if (place) return place;
  }
  const uint64_t seed = run_.config.seed, draw = nth * kDrawsPerGoal;
  if (run_.near <= 0) return world_.random_place(avatar_class, seed, uint64_t{slot} << 32 | nth);
  for (uint64_t n = draw; n < draw + kDrawsPerGoal; ++n) {
    const auto offset = [&](uint64_t stream) {
      return run_.near * (2 * random_number(seed, stream, n) - 1);
    };
    const Vec3d at{from.x + offset(2 * uint64_t{slot}), from.y,
                   from.z + offset(2 * uint64_t{slot} + 1)};
    const Place place = world_.find_place(avatar_class, at, kStorey);
    if (place) return place;
  }
  return world_.find_place(avatar_class, from, kNearGround);
}

// The n-th goal over nodes: the first of kPlaces random places that is near enough, or the nearest.
NodePlace GoalCrowd::goal_on_nodes(uint32_t slot, uint64_t nth, const Vec3d& from) const {
  const Nodes& nodes = run_.config.nodes;
  const int32_t avatar_class = class_of_[slot];
  const uint64_t seed = run_.config.seed, stream = uint64_t{slot} << 32;
  if (run_.near <= 0) return nodes.random_place(avatar_class, seed, stream | nth);
  NodePlace best;
  for (uint64_t n = nth * kPlaces; n < (nth + 1) * kPlaces; ++n) {
    const NodePlace place = nodes.random_place(avatar_class, seed, stream | n);
    if (!place) continue;
    if (!best || length(place.feet - from) < length(best.feet - from)) best = place;
    if (length(best.feet - from) <= run_.near) break;
  }
  return best;
}

void GoalCrowd::give(std::span<const AvatarId> ids) {
  if (ids.empty()) return;
  on_ground_.clear();
  on_nodes_.clear();
  goals_.clear();
  goals_on_nodes_.clear();
  for (const AvatarId id : ids) {
    const uint32_t slot = id.slot1 - 1;
    const auto here = crowd_.read_here(id);
    if (!here) {  // Another rank gives it a goal; what is given to it is forgotten on all.
      ++given_[slot];
      goals_.emplace_back();
      on_ground_.push_back(id);
      continue;
    }
    const Vec3d from = here->position;
    if (places_.empty() && goes_over_nodes(class_of_[slot])) {
      goals_on_nodes_.push_back(goal_on_nodes(slot, given_[slot]++, from));
      on_nodes_.push_back(id);
    } else {
      goals_.push_back(goal(slot, given_[slot]++, from));
      on_ground_.push_back(id);
    }
  }
  crowd_.set_goals(on_ground_, goals_);
  crowd_.set_goals(on_nodes_, goals_on_nodes_);
}

// [CAACD]'s MaxSpeed is a speed: the avatar's own is as many times as large as the set says. Time
// per step: the changes, and the avatars of each that is made.
void GoalCrowd::change_sets() {
  const std::vector<AvatarClass> classes = world_.summary().classes;
  const CurvilinearTuning& at_start = run_.config.tuning.curvilinear;
  for (const SetChange& change : run_.set_changes) {
    if (change.step != steps_) continue;
    CurvilinearTuning tuning = at_start;
    tuning.mass = change.set.mass;
    tuning.max_speed = change.set.max_speed;
    tuning.max_force = change.set.max_force;
    for (size_t slot = 0; slot < all_.size(); ++slot) {
      if (change.avatar && *change.avatar != slot) continue;
      const auto avatar_class = static_cast<size_t>(class_of_[slot]);
      const double own = run_.speed > 0 ? run_.speed : classes[avatar_class].speed;
      const double speed = own * tuning.max_speed / at_start.max_speed;
      crowd_.set_curvilinear({&all_[slot], 1}, {&tuning, 1});
      crowd_.set_speeds({&all_[slot], 1}, {&speed, 1});
    }
  }
}

CrowdReport GoalCrowd::step() {
  if (!run_.set_changes.empty()) change_sets();
  ++steps_;
  return crowd_.step();
}

void GoalCrowd::give_goals() {
  give(crowd_.goal_unreachable());
  if (run_.goals == "random") give(crowd_.arrived());
}

std::string memory_text(uint64_t out_of_memory, const char* setting) {
  if (out_of_memory == 0) return {};
  return fmt::format("{} searches for paths ran out of memory; raise {}\n", out_of_memory, setting);
}

void add_step(const CrowdReport& report, RunTimes& times) {
  times.add_step(report.seconds_total, static_cast<double>(report.avatars));
  times.add("plan", report.seconds_plan);
  times.add("sort", report.seconds_sort);
  times.add("steer", report.seconds_steer);
  times.add("commit", report.seconds_commit);
  times.add("settle", report.seconds_settle);
  times.add("obstacles", report.seconds_obstacles);
  times.add("events", report.seconds_events);
}

int run_crowd(Session& session, const CrowdRun& run, GoalCrowd& crowd, RunTimes& times,
              const std::function<Result<void>(uint64_t step)>& shown,
              const std::function<Result<void>()>& finished) {
  const auto write = [&](uint64_t step) {
    return times.measure("write", [&] { return shown(step); });
  };
  std::optional<uint64_t> saved_at;
  if (!run.checkpoints.resume.empty()) saved_at = crowd.steps();
  const auto save = [&]() -> Result<void> {
    const Checkpoint checkpoint = crowd.checkpoint(crowd_settings(run));
    Result<void> ok;
    if (rank_info().rank == 0) ok = write_checkpoint(run.checkpoints.write, checkpoint);
    return agree_over_ranks(ok);
  };
  if (auto ok = write(crowd.steps()); !ok) return fail(ok.error());
  Totals totals;
  for (uint64_t step = crowd.steps() + 1; step <= run.steps; ++step) {
    set_last_words(run, step, saved_at);
    const CrowdReport report = crowd.step();
    totals.add(report);
    add_step(report, times);
    times.measure("goals", [&] { crowd.give_goals(); });
    if (step % run.check_every == 0 || step == run.steps) {
      totals.add(times.measure("check", [&] { return crowd.crowd().check(); }));
    }
    if (auto ok = write(step); !ok) return fail(ok.error());
    if (!run.checkpoints.write.empty() && step % run.checkpoints.every == 0) {
      if (auto ok = times.measure("checkpoint", save); !ok) return fail(ok.error());
      saved_at = step;
    }
    show_progress(session, "walk", step, run.steps);
    if (session.context.cancel) return fail({Errc::kCancelled, "run: interrupted"});
  }
  if (auto ok = times.measure("write", finished); !ok) return fail(ok.error());
  print(session, run, crowd.crowd(), totals, times);
  return totals.found.wall_entries + totals.found.overlaps == 0 ? kDone : kAnswerIsNo;
}

}  // namespace throng::app
