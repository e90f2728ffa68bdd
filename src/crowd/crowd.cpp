// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/crowd.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "core/access.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "crowd/crowd_check.h"
#include "crowd/crowd_state.h"
#include "throng/avatar.h"
#include "world/tile_grid.h"

// The public face of a crowd: configuration, the order of a step's parts, and reports. Avatars,
// targets, obstacles, events and saved crowds lie in the files beside, the modes in their rooms.
namespace throng {
namespace {

constexpr double kMinDt = 1e-3, kMaxDt = 1;              // [s]
constexpr uint64_t kMinSearchBytes = uint64_t{1} << 20;  // of each search

Error bad_config(const std::string& what) { return {Errc::kBadConfig, "crowd: " + what}; }

// As far as known from outside: worlds that were never written have no hash.
bool is_same_world(const Nodes& nodes, const World& world) {
  const WorldSummary &a = data_of(nodes.world())->summary, &b = data_of(world)->summary;
  return a.hash == b.hash && a.cell == b.cell && a.origin == b.origin &&
         a.classes.size() == b.classes.size() &&
         data_of(nodes.world())->level_count == data_of(world)->level_count;
}

// Of each class of the world. Empty: stairs and slopes slow none.
Result<std::vector<SlopeFactors>> slope_factors_of(const World& world, const CrowdConfig& config) {
  const size_t classes = data_of(world)->summary.classes.size();
  if (config.slope_factors.size() > classes) {
    return bad_config("slope_factors are more than the world has classes");
  }
  const auto is_factor = [](double factor) { return factor >= 0.01 && factor <= 1; };
  for (const SlopeFactors& factors : config.slope_factors) {
    if (is_factor(factors.stairs_up) && is_factor(factors.stairs_down)) continue;
    return bad_config("slope_factors must be 0.01 to 1");
  }
  if (!config.slow_on_slopes) return std::vector<SlopeFactors>();
  std::vector<SlopeFactors> all = config.slope_factors;
  all.resize(kMaxAvatarClasses);
  return all;
}

}  // namespace

Crowd::Crowd(std::unique_ptr<State> state) : state_(std::move(state)) {}
Crowd::Crowd(Crowd&&) noexcept = default;
Crowd& Crowd::operator=(Crowd&&) noexcept = default;
Crowd::~Crowd() = default;

Result<Crowd> Crowd::create(const World& world, const CrowdConfig& config) {
  if (!data_of(world)) return bad_config("there is no world");
  if (!(config.dt >= kMinDt && config.dt <= kMaxDt)) {
    return bad_config("dt must be 0.001 to 1 s");
  }
  if (config.search_bytes < kMinSearchBytes) {
    return bad_config("search_bytes must be 1048576 (1 MiB) or more");
  }
  if (config.workers < 0) return bad_config("workers must be 0 (all cores) or more");
  if (!(config.tuning.sight >= 1 && config.tuning.sight <= 50))
    return bad_config("sight must be 1 to 50 m");
  if (!(config.tuning.reaction >= 0 && config.tuning.reaction <= 1)) {
    return bad_config("reaction must be 0 to 1 s");
  }
  if (!(config.tuning.rounds >= 1 && config.tuning.rounds <= 100))
    return bad_config("rounds must be 1 to 100");
  if (!(config.tuning.low_detail_reaction >= 0 && config.tuning.low_detail_reaction <= 10)) {
    return bad_config("low_detail_reaction must be 0 to 10 s");
  }
  if (!(config.tuning.low_detail_steps >= 1 && config.tuning.low_detail_steps <= 16)) {
    return bad_config("low_detail_steps must be 1 to 16");
  }
  if (!(config.tuning.acceleration >= 0 && config.tuning.acceleration <= 1000)) {
    return bad_config("acceleration must be 0 to 1000 m/s2");
  }
  if (!(config.tuning.no_progress_after >= 0 && config.tuning.no_progress_after <= 1e6)) {
    return bad_config("no_progress_after must be 0 to 1000000 s");
  }
  if (!crowd::is_tuning(config.tuning.curvilinear)) {
    return bad_config(
        "of curvilinear, mass must be 0.01 to 1000, max_speed 0.01 to 100, max_force 0.001 to "
        "1000");
  }
  if (!(config.slope_cost >= 0 && config.slope_cost <= 1000)) {
    return bad_config("slope_cost must be 0 to 1000");
  }
  if (config.speedup == PathSpeedup::kOnDemand) {
    return bad_config("it searches the whole ground: PathSpeedup::kOnDemand is not for crowds");
  }
  if (config.nodes && !is_same_world(config.nodes, world)) {
    return bad_config("the nodes are of another world");
  }
  auto slope_factors = slope_factors_of(world, config);
  if (!slope_factors) return slope_factors.error();
  const double unit = data_of(world)->summary.cell / world::kUnitsPerCell;
  crowd::MoveConfig move{.units = {static_cast<float>(unit), static_cast<float>(config.dt)},
                         .sight = static_cast<float>(config.tuning.sight),
                         .rounds = config.tuning.rounds,
                         .deadlock_avoidance = config.tuning.deadlock_avoidance,
                         .reaction = static_cast<float>(config.tuning.reaction),
                         .seed = config.seed,
                         .workers = config.workers,
                         .model = config.model,
                         .curves = crowd::with_tuning({}, config.tuning.curvilinear),
                         .flyer_axes = config.tuning.flyer_axes,
                         .queues = config.tuning.queues,
                         .acceleration = static_cast<float>(config.tuning.acceleration),
                         .slope_factors = *std::move(slope_factors)};
  return Crowd(std::make_unique<State>(world, config, std::move(move)));
}

void Crowd::set_views(std::span<const CrowdView> views) {
  const Vec3d& origin = data_of(state_->shared.world)->summary.origin;
  state_->views.clear();
  for (const CrowdView& v : views) {
    if (!std::isfinite(v.position.x + v.position.y + v.position.z) || !(v.radius >= 0)) continue;
    state_->views.push_back({static_cast<float>(v.position.x - origin.x),
                             static_cast<float>(v.position.z - origin.z),
                             static_cast<float>(v.position.y), static_cast<float>(v.radius)});
  }
}

CrowdReport Crowd::step() {
  const auto start = Clock::now();
  State& s = *state_;
  s.everywhere.clear();
  if (s.shared.share) s.shared.share->forget_sent_bytes();
  s.follow_edits();
  CrowdReport report;
  report.step = ++s.shared.step;
  report.avatars = s.count();
  report.most_avatars = report.avatars;
  s.shared.arrived.clear();
  s.shared.goal_unreachable.clear();
  s.shared.planned = 0;
  s.shared.out_of_memory = 0;
  s.shared.jam_searches = 0;
  s.shared.changed_route = 0;
  s.shared.flight_boxes = 0;
  // A copy, because what settles is taken out of the list.
  const std::span<const uint32_t> waiting = s.shared.obstacles.waiting();
  report.waiting = s.settle_obstacles(std::vector(waiting.begin(), waiting.end()), &s.blockers);
  s.renew_flows();
  report.seconds_obstacles = seconds_since(start);
  crowd::EngineCounts counts;
  crowd::EngineTimes times;
  s.walk.engine().set_detail(
      {.views = s.views,
       .steps = s.shared.config.tuning.low_detail_steps,
       .reaction = static_cast<float>(s.shared.config.tuning.low_detail_reaction),
       .narrowest = s.extent.narrowest});
  for (int32_t i = 0; i < s.shared.sub_steps; ++i) {
    ++s.shared.sub_step;
    s.shared.time = s.shared.step * crowd::SharedState::kTimeUnits +
                    static_cast<uint64_t>(i) * crowd::SharedState::kTimeUnits /
                        static_cast<uint64_t>(s.shared.sub_steps);
    if (s.shared.share) s.migrate();
    for (crowd::Mode* mode : s.modes) mode->step(s.walk.bodies(), counts, times);
  }
  s.where_is_old = true;
  if (s.fly.row_count() > 0 || s.climb.row_count() > 0) {
    for (const crowd::Body& body : s.walk.bodies()) {
      report.flying += body.flies() ? 1 : 0;
      report.climbing += body.climbs ? 1 : 0;
    }
  }
  report.on_links = s.link.count_riding();
  const auto events_start = Clock::now();
  s.arrive_in_targets();
  s.find_events();
  if (s.shared.share) s.gather_events(counts, report);
  for (std::vector<AvatarId>* ids : {&s.shared.arrived, &s.shared.goal_unreachable}) {
    std::sort(ids->begin(), ids->end(), [](AvatarId a, AvatarId b) { return a.slot1 < b.slot1; });
  }
  report.seconds_events = seconds_since(events_start);
  const auto moves = std::max<double>(1, static_cast<double>(report.avatars) * s.shared.sub_steps);
  const auto sub_steps = static_cast<uint64_t>(s.shared.sub_steps);
  report.stood = counts.stood / sub_steps;
  report.contested = counts.contested;
  report.low_detail = counts.low_detail / sub_steps;
  report.skipped = counts.skipped / sub_steps;
  report.arrived = s.shared.arrived.size();
  report.planned = s.shared.planned;
  report.no_path = s.shared.goal_unreachable.size();
  report.out_of_memory = s.shared.out_of_memory;
  report.jam_searches = s.shared.jam_searches;
  report.changed_route = s.shared.changed_route;
  report.flight_boxes = s.shared.flight_boxes;
  report.progress = static_cast<double>(counts.progress) * 1e-6 / moves;
  report.seconds_plan = times.plan;
  report.seconds_sort = times.sort;
  report.seconds_steer = times.steer;
  report.seconds_commit = times.resolve;
  report.seconds_settle = times.settle;
  report.seconds_total = seconds_since(start);
  return report;
}

CrowdCheck Crowd::check() const {
  const State& s = *state_;
  if (s.shared.share) return s.check_shared();
  std::vector<crowd::CheckedBody> bodies;
  bodies.reserve(s.walk.bodies().size());
  for (const crowd::Body& b : s.walk.bodies()) bodies.push_back(s.checked(b));
  CrowdCheck found =
      crowd::check_bodies(s.shared.world, bodies, obstacles(), s.shared.config.workers);
  for (const crowd::Mode* mode : s.modes) mode->check(s.walk.bodies(), found);
  return found;
}

// A sum over the avatars, so that neither their order matters nor which rank has which of them.
crowd::CheckedBody Crowd::State::checked(const crowd::Body& b) const {
  return {b.x,
          b.z,
          b.y,
          b.level,
          static_cast<int32_t>(shared.baked_class(b.avatar_class)),
          b.radius * shared.unit,
          mode_of(b).height_of(b),
          b.flies(),
          b.climbs,
          b.on_link};
}

uint64_t Crowd::state_hash() const {
  const State& s = *state_;
  const std::span<const crowd::Body> bodies = s.walk.bodies();
  std::atomic<uint64_t> sum{0};
  parallel_ranges(bodies.size(), 4096, s.shared.config.workers, [&](size_t begin, size_t end) {
    uint64_t here = 0;
    for (crowd::Body body : bodies.subspan(begin, end - begin)) {
      body.state = crowd::Body::kFree;  // of the step, not of the avatar
      body.steps = 0;
      const uint32_t slot = std::exchange(body.slot, s.shared.name_of(body));
      uint64_t hash = hash_bytes(&body, sizeof body);
      body.slot = slot;
      for (const crowd::Mode* mode : s.modes) hash = mode->hash(body, hash);
      here += hash;
    }
    sum += here;
  });
  return s.shared.share ? s.shared.share->sum(sum) : sum.load();
}

void Crowd::read(std::vector<AvatarState>& out) const {
  const State& s = *state_;
  if (s.shared.share) {
    out = s.states_everywhere();
    return;
  }
  s.find_bodies();
  out.clear();
  for (const uint32_t i : s.where) {
    if (i == kNoBody) continue;
    const crowd::Body& body = s.walk.bodies()[i];
    out.push_back(s.mode_of(body).state_of(body));
  }
}

std::optional<AvatarState> Crowd::read(AvatarId id) const {
  return state_->shared.share ? state_->state_everywhere(id) : read_here(id);
}

std::optional<AvatarState> Crowd::read_here(AvatarId id) const {
  const crowd::Body* body = state_->body(id);
  if (body == nullptr) return std::nullopt;
  return state_->mode_of(*body).state_of(*body);
}

bool Crowd::may_lean() const { return static_cast<bool>(state_->shared.config.nodes); }

std::span<const AvatarId> Crowd::arrived() const { return state_->shared.arrived; }
std::span<const AvatarId> Crowd::goal_unreachable() const {
  return state_->shared.goal_unreachable;
}

bool Crowd::may_fly(int32_t avatar_class, const Vec3d& feet) const {
  const path::FlightFinder* finder = state_->fly.finder(avatar_class);
  return finder != nullptr && finder->is_legal(feet);
}

std::optional<Vec3d> Crowd::random_air_point(int32_t avatar_class, uint64_t seed,
                                             uint64_t n) const {
  const path::FlightFinder* finder = state_->fly.finder(avatar_class);
  return finder == nullptr ? std::nullopt : finder->random_point(seed, n);
}

bool Crowd::is_alive(AvatarId id) const {
  return state_->shared.share ? state_->shared.names.is_alive(id) : state_->body(id) != nullptr;
}
uint32_t Crowd::size() const { return static_cast<uint32_t>(state_->count()); }

CrowdMemory Crowd::memory() const {
  const State& s = *state_;
  CrowdMemory memory;
  memory.avatars = s.shared.names.bytes() + s.where.capacity() * 4 +
                   s.shared.orientations.capacity() * sizeof(crowd::Orientation) +
                   s.inside.capacity() * sizeof(uint64_t) +
                   s.checked_at.capacity() * sizeof(s.checked_at[0]) + s.own_curves.bytes();
  for (const crowd::Mode* mode : s.modes) mode->add_memory(memory);
  for (const auto& of : s.shared.classes) memory.ground += of ? of->ground.bytes() : 0;
  memory.ground += s.shared.obstacles.bytes();
  return memory;
}

}  // namespace throng
