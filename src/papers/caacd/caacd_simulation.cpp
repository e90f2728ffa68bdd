// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

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
  Simulation run;
  run.space_ = std::move(space);
  run.model_ = model;
  run.dt_ = dt;
  for (Body& body : run.space_.bodies) {
    run.largest_alert_ = std::max(run.largest_alert_, body.fields.alert);
    body.velocity = steered(body.velocity, {}, dt, model);
    body.forward = heading_of(body.forward, heading_of(body.velocity, {1, 0, 0}));
  }
  run.activities_.assign(n, Activity::kTravelling);
  run.threats_.resize(n);
  run.steer_.resize(n);
  run.stop_before_.assign(n, 0);
  run.claims_.assign(n, 0);
  run.inside_.assign(n * (n - std::min<size_t>(n, 1)) / 2, 0);
  run.inside_obstacle_.assign(n * run.space_.obstacles.size(), 0);
  run.find_rivals();
  // Overlaps at the start are not entries.
  run.count();
  run.counts_ = {};
  return run;
}

void Simulation::find_rivals() {
  const size_t n = space_.bodies.size();
  rival_first_.assign(1, 0);
  rivals_.clear();
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      const double apart = space_.bodies[i].fields.repulsive + space_.bodies[j].fields.repulsive;
      if (i != j && distance2(space_.targets[i], space_.targets[j]) <= apart * apart) {
        rivals_.push_back(static_cast<uint32_t>(j));
      }
    }
    rival_first_.push_back(static_cast<uint32_t>(rivals_.size()));
  }
}

Result<void> Simulation::send(uint32_t id, Vec3d target) {
  if (id >= space_.bodies.size()) {
    return Error{Errc::kNotFound, "caacd: there is no body " + std::to_string(id)};
  }
  if (!is_finite(target)) return Error{Errc::kBadInput, "caacd: a target must be finite"};
  space_.targets[id] = target;
  activities_[id] = Activity::kTravelling;
  claims_[id] = 0;
  find_rivals();
  return {};
}

// Of avatars with targets too near to each other, the first one near its target reserves it; the
// others stop before it, outside of the precaution field.
void Simulation::negotiate() {
  const auto& bodies = space_.bodies;
  const auto rivals = [&](size_t i) {
    return std::span(rivals_).subspan(rival_first_[i], rival_first_[i + 1] - rival_first_[i]);
  };
  const auto is_near = [&](size_t i) {
    const double radius = std::max(model_.deceleration, 2 * bodies[i].fields.alert);
    return distance2(bodies[i].position, space_.targets[i]) <= radius * radius;
  };
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (claims_[i] != 0 || !is_near(i)) continue;
    const bool first = std::ranges::all_of(rivals(i), [&](uint32_t j) {
      return claims_[j] == 0 && (!is_near(j) || goes_first(bodies[i], space_.targets[i], bodies[j],
                                                           space_.targets[j]));
    });
    if (first) claims_[i] = 1;
  }
  for (size_t i = 0; i < bodies.size(); ++i) {
    stop_before_[i] = 0;
    if (claims_[i] != 0) continue;
    for (const uint32_t j : rivals(i)) {
      if (claims_[j] == 0) continue;
      const double apart = bodies[i].fields.precaution + bodies[j].fields.precaution;
      stop_before_[i] = std::max(
          stop_before_[i], apart + std::sqrt(distance2(space_.targets[i], space_.targets[j])));
    }
  }
}

void Simulation::sense(size_t i) {
  const Body& self = space_.bodies[i];
  threats_[i] = {};
  if (activities_[i] == Activity::kArrived) {
    steer_[i] = {};
    return;
  }
  const double radius = threat_radius(self, largest_alert_, model_);
  const Threat greatest = greatest_threat(self, space_.bodies, space_.obstacles, model_, radius);
  threats_[i] = greatest;
  if (greatest.level != State::kTolerable) {
    activities_[i] = Activity::kAvoiding;
    steer_[i] = avoidance(self, greatest, model_);
    return;
  }
  steer_[i] = path_amendment(self, space_.targets[i], stop_before_[i], model_);
  const double left = std::sqrt(distance2(space_.targets[i], self.position)) - stop_before_[i];
  activities_[i] = left >= model_.deceleration ? Activity::kTravelling
                   : stop_before_[i] > 0       ? Activity::kWaiting
                                               : Activity::kArriving;
}

void Simulation::move(size_t i) {
  if (activities_[i] == Activity::kArrived) return;
  Body& body = space_.bodies[i];
  body.velocity = steered(body.velocity, steer_[i], dt_, model_);
  body.forward = heading_of(body.velocity, body.forward);
  body.position = body.position + body.velocity * dt_;
  counts_.walked += length(body.velocity) * dt_;
  const double arrival = kArrival * body.fields.repulsive;
  if (stop_before_[i] == 0 && distance2(body.position, space_.targets[i]) <= arrival * arrival) {
    body.velocity = {};
    activities_[i] = Activity::kArrived;
  }
}

void Simulation::count() {
  const auto& bodies = space_.bodies;
  const auto enter = [](uint8_t& inside, bool now) {
    const bool entered = now && inside == 0;
    inside = now ? 1 : 0;
    return entered ? 1 : 0;
  };
  size_t pair = 0;
  for (size_t i = 0; i < bodies.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      const double apart = bodies[i].fields.repulsive + bodies[j].fields.repulsive;
      const bool now = distance2(bodies[i].position, bodies[j].position) <= apart * apart;
      counts_.collisions += enter(inside_[pair++], now);
    }
  }
  pair = 0;
  for (const Body& body : bodies) {
    for (const Obstacle& o : space_.obstacles) {
      const double apart = body.fields.repulsive + o.fields.repulsive;
      const bool now = distance2(body.position, o.position) <= apart * apart;
      counts_.obstacle_collisions += enter(inside_obstacle_[pair++], now);
    }
  }
  counts_.arrived = std::ranges::count(activities_, Activity::kArrived);
  counts_.waiting = std::ranges::count(activities_, Activity::kWaiting);
}

void Simulation::step() {
  const size_t n = space_.bodies.size();
  negotiate();
  for (size_t i = 0; i < n; ++i) sense(i);
  for (size_t i = 0; i < n; ++i) move(i);
  ++counts_.frames;
  count();
}

bool Simulation::finished() const {
  for (size_t i = 0; i < activities_.size(); ++i) {
    if (activities_[i] == Activity::kArrived) continue;
    if (activities_[i] != Activity::kWaiting) return false;
    const Body& body = space_.bodies[i];
    if (length(body.velocity) > 1e-3 * model_.max_speed) return false;
  }
  return true;
}

uint64_t Simulation::state_hash() const {
  std::vector<double> state;
  for (const Body& body : space_.bodies) {
    for (const Vec3d& v : {body.position, body.velocity}) {
      state.insert(state.end(), {v.x, v.y, v.z});
    }
  }
  std::vector<uint64_t> bits(state.size());
  std::ranges::transform(state, bits.begin(), [](double x) { return std::bit_cast<uint64_t>(x); });
  return hash_span(std::span<const uint64_t>(bits));
}

}  // namespace throng::caacd
