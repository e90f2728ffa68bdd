// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run_crowd.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "throng/flight.h"
#include "throng/ground_query.h"

namespace throng::app {
namespace {

constexpr double kNearGround = 2;    // [m] from the ground a goal of a file may be
constexpr double kStorey = 4;        // [m] up or down a random goal may be
constexpr uint64_t kTries = 32;      // to find one
constexpr uint64_t kAir = 0x616972;  // stream of chance

// Uniform in [0, 1), of a stream.
double random_number(uint64_t seed, uint64_t stream, uint64_t n) {
  uint64_t x = (seed * 0x9e3779b97f4a7c15ULL + stream) * 0xd1342543de82ef95ULL + n;
  for (int i = 0; i < 3; ++i) x = (x ^ (x >> 31)) * 0xbf58476d1ce4e5b9ULL;
  return static_cast<double>(x >> 11) * 0x1p-53;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

// Numbers of a line, apart by commas; none if it has others.
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
  std::vector<double> seconds;
  double progress = 0;
  uint64_t checks = 0;
  CrowdCheck found;

  void add(const CrowdReport& r) {
    sum.stood += r.stood;
    sum.contested += r.contested;
    sum.arrived += r.arrived;
    sum.planned += r.planned;
    sum.no_way += r.no_way;
    sum.flying = r.flying;  // at the end
    sum.seconds_plan += r.seconds_plan;
    sum.seconds_sort += r.seconds_sort;
    sum.seconds_steer += r.seconds_steer;
    sum.seconds_commit += r.seconds_commit;
    sum.seconds_settle += r.seconds_settle;
    sum.seconds_total += r.seconds_total;
    seconds.push_back(r.seconds_total);
    progress += r.progress;
  }
  void add(const CrowdCheck& check) {
    ++checks;
    found.wall_entries += check.wall_entries;
    found.overlaps += check.overlaps;
  }
};

void print(Session& session, const CrowdRun& run, const Crowd& crowd, const Totals& t) {
  const auto steps = std::max<double>(1, static_cast<double>(t.seconds.size()));
  const double avatars = std::max<double>(1, crowd.size());
  const double ns = median(t.seconds) * 1e9 / avatars;
  const double ns_mean = t.sum.seconds_total * 1e9 / avatars / steps;
  print_result(
      session,
      {{"world", run.world_name},
       {"class", run.class_name},
       {"goals", run.goals},
       {"model", name_of(run.config.model)},
       {"avatars", crowd.size()},
       {"steps", t.seconds.size()},
       {"dt", run.config.dt},
       {"seed", run.config.seed},
       {"threads", run.config.workers},
       {"ns_per_avatar_step", ns},
       {"ns_per_avatar_step_mean", ns_mean},
       {"progress", t.progress / steps},
       {"arrived", t.sum.arrived},
       {"planned", t.sum.planned},
       {"no_way", t.sum.no_way},
       {"flying", t.sum.flying},
       {"blocked", t.sum.stood},
       {"contested", t.sum.contested},
       {"checks", t.checks},
       {"wall_entries", t.found.wall_entries},
       {"overlaps", t.found.overlaps},
       {"state_hash", fmt::format("{:016x}", crowd.state_hash())},
       {"seconds_plan", t.sum.seconds_plan},
       {"seconds_sort", t.sum.seconds_sort},
       {"seconds_steer", t.sum.seconds_steer},
       {"seconds_commit", t.sum.seconds_commit},
       {"seconds_settle", t.sum.seconds_settle},
       {"seconds_total", t.sum.seconds_total},
       {"crowd_bytes", crowd.memory().total()},
       {"peak_bytes", peak_memory()}},
      fmt::format("{} {} avatars, {} steps of {} s: {:.1f} ns an avatar a step (median)\n"
                  "{} goals reached, {} ways planned, {} goals without a way; got on at {:.2f} of "
                  "their speeds\n"
                  "{} checks: {} wall entries, {} overlaps\n"
                  "state {:016x}\n",
                  crowd.size(), run.class_name, t.seconds.size(), run.config.dt, ns, t.sum.arrived,
                  t.sum.planned, t.sum.no_way, t.progress / steps, t.checks, t.found.wall_entries,
                  t.found.overlaps, crowd.state_hash()));
}

}  // namespace

Result<void> read_goals(CrowdRun& run) {
  if (run.goals == "random") return {};
  std::ifstream file(run.goals, std::ios::binary);
  if (!file) {
    return Error{Errc::kNotFound,
                 run.goals + ": cannot be read; give 'random' or a file of lines x,y,z"};
  }
  run.goals_text.assign(std::istreambuf_iterator<char>(file), {});
  return {};
}

GoalCrowd::GoalCrowd(const World& world, const CrowdRun& run, int32_t avatar_class, Crowd&& crowd)
    : world_(world), run_(run), avatar_class_(avatar_class), crowd_(std::move(crowd)) {}

Result<GoalCrowd> GoalCrowd::make(const World& world, const CrowdRun& run, Context& context) {
  const Result<int32_t> avatar_class = class_named(world, run.class_name);
  if (!avatar_class) return avatar_class.error();
  auto crowd = Crowd::create(world, run.config);
  if (!crowd) return crowd.error();
  GoalCrowd made(world, run, *avatar_class, std::move(*crowd));
  AvatarSpawn like{
      .place = {}, .avatar_class = *avatar_class, .radius = run.radius, .speed = run.speed};
  const bool flies = world.summary().classes[static_cast<size_t>(*avatar_class)].flies;
  if (flies) like.place = air_place({});
  auto ids = made.crowd_.scatter(run.avatars, like, context);
  if (!ids && flies && ids.error().code == Errc::kBadConfig) {
    like.place = {};  // Without air who could fly walks.
    ids = made.crowd_.scatter(run.avatars, like, context);
  }
  if (!ids) return ids.error();
  if (auto ok = made.read_places(); !ok) return ok.error();
  made.given_.resize(ids->size());
  made.give(*ids);
  return made;
}

Result<void> GoalCrowd::read_places() {
  if (run_.goals == "random") return {};
  const auto bad = [&](size_t line, const std::string& what) {
    return Error{Errc::kBadFile, run_.goals + ":" + std::to_string(line) + ": " + what};
  };
  auto query = GroundQuery::make(world_, avatar_class_);
  if (!query) return query.error();
  std::istringstream lines(run_.goals_text);
  std::string line;
  for (size_t n = 1; std::getline(lines, line); ++n) {
    if (line.empty() || line[0] == '#' || line == "\r") continue;
    const auto at = numbers_of(line);
    if (!at) return bad(n, "is no goal; write x,y,z in metres");
    const Place place = query->nearest_place(*at, kNearGround);
    const FlightFinder* flight = crowd_.flight_finder(avatar_class_);
    const bool in_air = !place && flight != nullptr && flight->is_legal(*at);
    if (!place && !in_air) {
      return bad(n, "no avatar of this class can stand within 2 m of it; move it");
    }
    places_.push_back(in_air ? air_place(*at) : place);
  }
  if (places_.empty()) return bad(1, "has no goals; write lines x,y,z in metres");
  return {};
}

// In the air; nowhere if none was found.
Place GoalCrowd::goal_in_air(uint32_t slot, uint64_t nth, const Vec3d& from) const {
  const FlightFinder& flight = *crowd_.flight_finder(avatar_class_);
  const uint64_t seed = run_.config.seed ^ kAir;
  if (run_.near <= 0) {
    const auto point = flight.random_point(seed, uint64_t{slot} << 32 | nth);
    return point ? air_place(*point) : Place{};
  }
  for (uint64_t n = nth * kTries; n < (nth + 1) * kTries; ++n) {
    const auto offset = [&](uint64_t stream) {
      return run_.near * (2 * random_number(seed, 3 * uint64_t{slot} + stream, n) - 1);
    };
    const Vec3d at{from.x + offset(0), from.y + offset(1), from.z + offset(2)};
    if (flight.is_legal(at)) return air_place(at);
  }
  return {};
}

// The n-th goal of an avatar.
Place GoalCrowd::goal(uint32_t slot, uint64_t nth, const Vec3d& from) const {
  if (!places_.empty()) return places_[(slot + nth) % places_.size()];
  if ((slot + nth) % 2 == 0 && crowd_.flight_finder(avatar_class_) != nullptr) {
    const Place place = goal_in_air(slot, nth, from);
    if (place) return place;
  }
  const uint64_t seed = run_.config.seed, draw = nth * kTries;
  if (run_.near <= 0) return world_.random_place(avatar_class_, seed, uint64_t{slot} << 32 | nth);
  for (uint64_t n = draw; n < draw + kTries; ++n) {
    const auto offset = [&](uint64_t stream) {
      return run_.near * (2 * random_number(seed, stream, n) - 1);
    };
    const Vec3d at{from.x + offset(2 * uint64_t{slot}), from.y,
                   from.z + offset(2 * uint64_t{slot} + 1)};
    const Place place = world_.find_place(avatar_class_, at, kStorey);
    if (place) return place;
  }
  return world_.find_place(avatar_class_, from, kNearGround);
}

void GoalCrowd::give(std::span<const AvatarId> ids) {
  if (ids.empty()) return;
  goals_.clear();
  if (run_.near > 0) crowd_.read(states_);
  for (const AvatarId id : ids) {
    const uint32_t slot = id.slot1 - 1;  // Nobody is ever removed, so slots are numbers of states.
    const Vec3d from = run_.near > 0 ? states_[slot].position : Vec3d{};
    goals_.push_back(goal(slot, given_[slot]++, from));
  }
  crowd_.set_goals(ids, goals_);
}

CrowdReport GoalCrowd::step() {
  const CrowdReport report = crowd_.step();
  give(crowd_.stranded());
  if (run_.goals == "random") give(crowd_.arrived());
  return report;
}

int run_crowd(Session& session, const CrowdRun& run, GoalCrowd& crowd,
              const std::function<Result<void>(uint64_t step)>& shown,
              const std::function<Result<void>()>& finished) {
  if (auto ok = shown(0); !ok) return fail(ok.error());
  Totals totals;
  for (uint64_t step = 1; step <= run.steps; ++step) {
    totals.add(crowd.step());
    if (step % run.check_every == 0 || step == run.steps) totals.add(crowd.crowd().check());
    if (auto ok = shown(step); !ok) return fail(ok.error());
    show_progress(session, "walk", step, run.steps);
    if (session.context.cancel) return fail({Errc::kCancelled, "run: interrupted"});
  }
  if (auto ok = finished(); !ok) return fail(ok.error());
  print(session, run, crowd.crowd(), totals);
  return totals.found.wall_entries + totals.found.overlaps == 0 ? kDone : kAnswerIsNo;
}

}  // namespace throng::app
