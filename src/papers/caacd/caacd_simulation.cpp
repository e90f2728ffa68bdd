// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/hash.h"
#include "throng/papers.h"

// One run of [CAACD] section V: determination, avoidance and path amendment of section III, all
// avatars at once, frame by frame. Time of a frame: the square of the bodies.
namespace throng::caacd {
namespace {

// An avatar has arrived if its centre is this near to the target, in repulsive radii: "until its
// repulsive field origin completely overlaps its target destination origin".
constexpr double kArrival = 0.1;

double distance2(Vec3d a, Vec3d b) {
  const Vec3d d = a - b;
  return dot(d, d);
}

bool is_finite(Vec3d v) {
  constexpr double kMax = 1e9;
  return std::fabs(v.x) < kMax && std::fabs(v.y) < kMax && std::fabs(v.z) < kMax;
}

bool is_sound(const Fields& f) {
  return f.repulsive > 0 && f.precaution >= f.repulsive && f.alert >= f.precaution && f.alert < 1e9;
}

Error bad_input(const char* what, size_t index) {
  return {Errc::kBadInput, std::string("caacd: ") + what + " " + std::to_string(index) +
                               " is not finite, or its fields do not grow outwards"};
}

}  // namespace

struct Simulation::Run {
  Space space;
  Model model;
  std::vector<ParameterSet> sets;  // of each avatar
  double dt = 1;
  double largest_alert = 0, fastest = 0;
  std::vector<Activity> activities;
  std::vector<Threat> threats;
  std::vector<Vec3d> steer;
  std::vector<double> stop_before;    // Avatars that wait stop so far from the target; others 0.
  std::vector<uint8_t> claims;        // 1 if the avatar may go on to its target.
  std::vector<uint32_t> rival_first;  // n + 1 offsets into rivals.
  std::vector<uint32_t> rivals;       // Avatars whose targets are too near to one's own.
  std::vector<uint8_t> inside;        // Pair (i, j < i) at i (i - 1) / 2 + j: is it in r_rep now?
  std::vector<uint8_t> inside_obstacle;
  Counts counts;

  void find_rivals();
  void negotiate();
  void sense(size_t i);
  void move(size_t i);
  void count();
  [[nodiscard]] Model model_of(size_t i) const { return with_set(model, sets[i]); }
};

Simulation::Simulation(std::unique_ptr<Run> run) : run_(std::move(run)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

std::span<const Body> Simulation::bodies() const { return run_->space.bodies; }
std::span<const Vec3d> Simulation::targets() const { return run_->space.targets; }
std::span<const Obstacle> Simulation::obstacles() const { return run_->space.obstacles; }
std::span<const Activity> Simulation::activities() const { return run_->activities; }
std::span<const Threat> Simulation::threats() const { return run_->threats; }
const Counts& Simulation::counts() const { return run_->counts; }
const Model& Simulation::model() const { return run_->model; }

Result<Simulation> Simulation::create(Space space, const Model& model, double dt) {
  if (auto ok = check_model(model); !ok) return ok.error();
  if (!(dt >= 1e-3 && dt <= 1e3)) {
    return Error{Errc::kBadConfig, "caacd: dt must be 0.001 to 1000 frames"};
  }
  const size_t n = space.bodies.size();
  if (space.targets.size() != n) {
    return Error{Errc::kBadInput, "caacd: need one target for each body"};
  }
  for (size_t i = 0; i < n; ++i) {
    const Body& b = space.bodies[i];
    if (b.id != i) return Error{Errc::kBadInput, "caacd: the id of body i must be i"};
    const bool sound = is_finite(b.position) && is_finite(b.velocity) && is_finite(b.forward) &&
                       is_finite(space.targets[i]) && is_sound(b.fields);
    if (!sound) return bad_input("body", i);
  }
  for (size_t i = 0; i < space.obstacles.size(); ++i) {
    const Obstacle& o = space.obstacles[i];
    if (!is_finite(o.position) || !is_sound(o.fields)) return bad_input("obstacle", i);
  }
  auto made = std::make_unique<Run>();
  Run& run = *made;
  run.space = std::move(space);
  run.model = model;
  run.dt = dt;
  for (Body& body : run.space.bodies) {
    run.largest_alert = std::max(run.largest_alert, body.fields.alert);
    body.velocity = steered(body.velocity, {}, dt, model);
    body.forward = heading_of(body.forward, heading_of(body.velocity, {1, 0, 0}));
  }
  run.fastest = model.max_speed;
  run.sets.assign(n, {model.mass, model.max_speed, model.max_force});
  run.activities.assign(n, Activity::kTravelling);
  run.threats.resize(n);
  run.steer.resize(n);
  run.stop_before.assign(n, 0);
  run.claims.assign(n, 0);
  run.inside.assign(n * (n - std::min<size_t>(n, 1)) / 2, 0);
  run.inside_obstacle.assign(n * run.space.obstacles.size(), 0);
  run.find_rivals();
  // Overlaps at the start are not entries.
  run.count();
  run.counts = {};
  return Simulation(std::move(made));
}

void Simulation::Run::find_rivals() {
  const size_t n = space.bodies.size();
  rival_first.assign(1, 0);
  rivals.clear();
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      const double apart = space.bodies[i].fields.repulsive + space.bodies[j].fields.repulsive;
      if (i != j && distance2(space.targets[i], space.targets[j]) <= apart * apart) {
        rivals.push_back(static_cast<uint32_t>(j));
      }
    }
    rival_first.push_back(static_cast<uint32_t>(rivals.size()));
  }
}

Result<void> Simulation::send(uint32_t id, Vec3d target) {
  if (id >= run_->space.bodies.size()) {
    return Error{Errc::kNotFound, "caacd: there is no body " + std::to_string(id)};
  }
  if (!is_finite(target)) return Error{Errc::kBadInput, "caacd: a target must be finite"};
  run_->space.targets[id] = target;
  run_->activities[id] = Activity::kTravelling;
  run_->claims[id] = 0;
  run_->find_rivals();
  return {};
}

Result<void> Simulation::set_parameters(uint32_t id, const ParameterSet& set) {
  if (id >= run_->sets.size()) {
    return Error{Errc::kNotFound, "caacd: there is no body " + std::to_string(id)};
  }
  if (auto ok = check_model(with_set(run_->model, set)); !ok) return ok;
  run_->sets[id] = set;
  run_->fastest = std::max(run_->fastest, set.max_speed);
  return {};
}

ParameterSet Simulation::parameters(uint32_t id) const {
  THRONG_ASSERT(id < run_->sets.size());
  return run_->sets[id];
}

// Of avatars with targets too near to each other, the first one near its target reserves it; the
// others stop before it, outside of the precaution field.
void Simulation::Run::negotiate() {
  const auto& bodies = space.bodies;
  const auto rivals_of = [&](size_t i) {
    return std::span(rivals).subspan(rival_first[i], rival_first[i + 1] - rival_first[i]);
  };
  const auto is_near = [&](size_t i) {
    const double radius = std::max(model.deceleration, 2 * bodies[i].fields.alert);
    return distance2(bodies[i].position, space.targets[i]) <= radius * radius;
  };
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (claims[i] != 0 || !is_near(i)) continue;
    const bool first = std::ranges::all_of(rivals_of(i), [&](uint32_t j) {
      return claims[j] == 0 &&
             (!is_near(j) || goes_first(bodies[i], space.targets[i], bodies[j], space.targets[j]));
    });
    if (first) claims[i] = 1;
  }
  for (size_t i = 0; i < bodies.size(); ++i) {
    stop_before[i] = 0;
    if (claims[i] != 0) continue;
    for (const uint32_t j : rivals_of(i)) {
      if (claims[j] == 0) continue;
      const double apart = bodies[i].fields.precaution + bodies[j].fields.precaution;
      stop_before[i] = std::max(stop_before[i],
                                apart + std::sqrt(distance2(space.targets[i], space.targets[j])));
    }
  }
}

void Simulation::Run::sense(size_t i) {
  const Body& self = space.bodies[i];
  const Model own = model_of(i);
  threats[i] = {};
  if (activities[i] == Activity::kArrived) {
    steer[i] = {};
    return;
  }
  Model of_others = own;  // how fast another may come
  of_others.max_speed = fastest;
  const double radius = threat_radius(self, largest_alert, of_others);
  const Threat greatest = greatest_threat(self, space.bodies, space.obstacles, own, radius);
  threats[i] = greatest;
  if (greatest.state != State::kTolerable) {
    activities[i] = Activity::kAvoiding;
    steer[i] = avoidance(self, greatest, own);
    return;
  }
  steer[i] = path_amendment(self, space.targets[i], stop_before[i], own);
  const double left = std::sqrt(distance2(space.targets[i], self.position)) - stop_before[i];
  activities[i] = left >= model.deceleration ? Activity::kTravelling
                  : stop_before[i] > 0       ? Activity::kWaiting
                                             : Activity::kArriving;
}

void Simulation::Run::move(size_t i) {
  if (activities[i] == Activity::kArrived) return;
  Body& body = space.bodies[i];
  body.velocity = steered(body.velocity, steer[i], dt, model_of(i));
  body.forward = heading_of(body.velocity, body.forward);
  body.position = body.position + body.velocity * dt;
  counts.walked += length(body.velocity) * dt;
  const double arrival = kArrival * body.fields.repulsive;
  if (stop_before[i] == 0 && distance2(body.position, space.targets[i]) <= arrival * arrival) {
    body.velocity = {};
    activities[i] = Activity::kArrived;
  }
}

void Simulation::Run::count() {
  const auto& bodies = space.bodies;
  const auto enter = [](uint8_t& was, bool now) {
    const bool entered = now && was == 0;
    was = now ? 1 : 0;
    return entered ? 1 : 0;
  };
  size_t pair = 0;
  for (size_t i = 0; i < bodies.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      const double apart = bodies[i].fields.repulsive + bodies[j].fields.repulsive;
      const bool now = distance2(bodies[i].position, bodies[j].position) <= apart * apart;
      counts.collisions += enter(inside[pair++], now);
    }
  }
  pair = 0;
  for (const Body& body : bodies) {
    for (const Obstacle& o : space.obstacles) {
      const double apart = body.fields.repulsive + o.fields.repulsive;
      const bool now = distance2(body.position, o.position) <= apart * apart;
      counts.obstacle_collisions += enter(inside_obstacle[pair++], now);
    }
  }
  counts.arrived = std::count(activities.begin(), activities.end(), Activity::kArrived);
  counts.waiting = std::count(activities.begin(), activities.end(), Activity::kWaiting);
}

void Simulation::step() {
  const size_t n = run_->space.bodies.size();
  run_->negotiate();
  for (size_t i = 0; i < n; ++i) run_->sense(i);
  for (size_t i = 0; i < n; ++i) run_->move(i);
  ++run_->counts.frames;
  run_->count();
}

bool Simulation::finished() const {
  for (size_t i = 0; i < run_->activities.size(); ++i) {
    if (run_->activities[i] == Activity::kArrived) continue;
    if (run_->activities[i] != Activity::kWaiting) return false;
    const Body& body = run_->space.bodies[i];
    if (length(body.velocity) > 1e-3 * run_->sets[i].max_speed) return false;
  }
  return true;
}

uint64_t Simulation::state_hash() const {
  std::vector<double> state;
  for (const Body& body : run_->space.bodies) {
    for (const Vec3d& v : {body.position, body.velocity}) {
      state.insert(state.end(), {v.x, v.y, v.z});
    }
  }
  std::vector<uint64_t> bits(state.size());
  std::transform(state.begin(), state.end(), bits.begin(),
                 [](double x) { return std::bit_cast<uint64_t>(x); });
  return hash_span(std::span<const uint64_t>(bits));
}

}  // namespace throng::caacd
