// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "throng/papers.h"

// [CAACD] equations 1 to 15, one function for each step that has a meaning of its own. What the
// paper leaves open, and the measurements that decided it: docs/design/007-caacd.md. The greatest
// threat takes time linear in the bodies and obstacles.
namespace throng::caacd {
namespace {

// A speed or a length below this has no direction.
constexpr double kNone = 1e-150;

Vec3d limited(Vec3d v, double max) {
  const double size = length(v);
  return size > max ? v * (max / size) : v;
}

// The side to push to when eq. 11 vanishes. Of two bodies head-on each has the other ahead and goes
// right; of two in one line the rear one goes right and the front one left, or they would stay in
// line.
double side_when_in_line(const Body& self, const Threat& threat) {
  const double ahead = dot(threat.now - self.position, self.forward);
  if (ahead != 0) return ahead > 0 ? 1 : -1;
  return self.id < threat.id ? 1 : -1;
}

// The state of a threat that will be `then`: as printed it is alert or critical. By state, a
// collision counts as such, also one of now.
State state_of(State then, const Body& self, Vec3d position, const Fields& fields,
               const Model& model) {
  if (model.order == Order::kTime) return then == State::kAlert ? then : State::kCritical;
  const State now = state_at(length(self.position - position), joint_fields(self.fields, fields));
  return now == State::kCollision ? now : then;
}

}  // namespace

Fields joint_fields(const Fields& a, const Fields& b) {
  return {a.repulsive + b.repulsive, a.precaution + b.precaution, a.alert + b.alert};
}

State state_at(double distance, const Fields& joint) {
  if (distance <= joint.repulsive) return State::kCollision;
  if (distance <= joint.precaution) return State::kCritical;
  if (distance <= joint.alert) return State::kAlert;
  return State::kTolerable;
}

Result<void> check_model(const Model& m) {
  constexpr double kMax = 1e100;
  struct Setting {
    const char* name;
    double value, min, max;
    bool above;  // Above `min`, not equal to it.
  };
  const std::array<Setting, 8> settings{{
      {"mass", m.mass, 1e-100, kMax, false},
      {"max_speed", m.max_speed, 0, kMax, true},
      {"max_force", m.max_force, 0, kMax, true},
      {"horizon", m.horizon, 0, kMax, true},
      {"deceleration", m.deceleration, 0, kMax, true},
      {"zone_time", m.probe_time, 0, kMax, false},
      {"lambda1", m.lambda1, 0.5, 1, false},
      {"lambda3", m.lambda3, 0, 1, false},
  }};
  for (const Setting& s : settings) {
    // Written so that a NaN is refused as well.
    if ((s.above ? s.value > s.min : s.value >= s.min) && s.value <= s.max) continue;
    const std::string range = s.max < kMax ? s.min == 0.5 ? "from 0.5 to 1" : "from 0 to 1"
                              : s.above    ? "above 0 and finite"
                              : s.min > 0  ? "1e-100 or more and finite"
                                           : "0 or more and finite";
    return Error{Errc::kBadConfig, std::string("caacd: ") + s.name + " must be " + range};
  }
  return {};
}

Approach nearest_approach(const Body& self, const Body& other) {
  const Vec3d relative_velocity = other.velocity - self.velocity;  // eq. 1
  const double speed = length(relative_velocity);                  // eq. 2
  if (speed < kNone) return {};
  const Vec3d tangent = relative_velocity * (1 / speed);              // eq. 3
  const Vec3d relative_position = self.position - other.position;     // eq. 4
  const double projected_distance = dot(tangent, relative_position);  // eq. 5
  return {.speed = speed, .time = projected_distance / speed};        // eq. 6
}

Vec3d position_at(const Body& body, double time) { return body.position + body.velocity * time; }

double convergence_distance(Vec3d r, const Model& model) {
  if (model.length == Length::kTrue) return length(r);
  const double x = std::fabs(r.x), y = std::fabs(r.y), z = std::fabs(r.z);
  const double max = std::max({x, y, z});
  return max * model.lambda1 + ((x + y + z) - max) * (1 - model.lambda1);
}

Threat threat_of(const Body& self, const Body& other, const Model& model) {
  if (model.trigger == Trigger::kNever) return {};
  const Approach approach = nearest_approach(self, other);
  if (!(approach.time >= 0 && approach.time < model.horizon)) return {};
  Threat threat{.time = approach.time,
                .id = other.id,
                .now = other.position,
                .self_then = position_at(self, approach.time),
                .other_then = position_at(other, approach.time)};
  threat.distance = convergence_distance(threat.self_then - threat.other_then, model);
  const State state = state_at(threat.distance, joint_fields(self.fields, other.fields));
  if (state == State::kTolerable) return {};
  if (model.trigger == Trigger::kNear &&
      state_at(length(self.position - other.position), joint_fields(self.fields, other.fields)) ==
          State::kTolerable) {
    return {};
  }
  if (model.trigger == Trigger::kZones && !probes_meet(self, other, model)) return {};
  threat.state = state_of(state, self, other.position, other.fields, model);
  return threat;
}

Threat threat_of(const Body& self, const Obstacle& obstacle, const Model& model) {
  if (model.trigger == Trigger::kNever) return {};
  if (!probe_overlaps(self, obstacle.position, obstacle.fields.precaution, model)) return {};
  const Body standing{.position = obstacle.position, .velocity = {}, .fields = obstacle.fields};
  const Approach approach = nearest_approach(self, standing);
  // An obstacle behind is no threat, even if the zone still covers it.
  if (approach.time < 0) return {};
  // A zone may reach farther than T3, so the time is not bounded here.
  Threat threat{.state = State::kCritical,
                .time = approach.time,
                .id = Threat::kObstacle,
                .now = obstacle.position,
                .self_then = position_at(self, approach.time),
                .other_then = obstacle.position};
  threat.distance = convergence_distance(threat.self_then - threat.other_then, model);
  const State state = state_at(threat.distance, joint_fields(self.fields, obstacle.fields));
  threat.state = state_of(state == State::kCollision ? state : State::kCritical, self,
                          obstacle.position, obstacle.fields, model);
  return threat;
}

bool more_urgent(const Threat& a, const Threat& b, Order order) {
  if (order == Order::kState && a.state != b.state) return a.state > b.state;
  if (a.time != b.time) return a.time < b.time;
  if (a.distance != b.distance) return a.distance < b.distance;
  return a.id < b.id;
}

Threat greatest_threat(const Body& self, std::span<const Body> others,
                       std::span<const Obstacle> obstacles, const Model& model,
                       double search_radius) {
  Threat greatest;
  const auto consider = [&](const Threat& threat) {
    if (threat.state != State::kTolerable && more_urgent(threat, greatest, model.order))
      greatest = threat;
  };
  for (const Body& other : others) {
    const Vec3d offset = other.position - self.position;
    if (other.id == self.id || dot(offset, offset) > search_radius * search_radius) continue;
    consider(threat_of(self, other, model));
  }
  for (const Obstacle& obstacle : obstacles) consider(threat_of(self, obstacle, model));
  return greatest;
}

double threat_radius(const Body& self, double alert, const Model& model) {
  // Eq. 10's other length is at least half of the true one.
  const double joint = (self.fields.alert + alert) * (model.length == Length::kTrue ? 1 : 2);
  // A body outside the alert field now is no threat.
  if (model.trigger == Trigger::kNear) return joint * (1 + 1e-9);
  return joint + model.horizon * (length(self.velocity) + model.max_speed);
}

Vec3d right_of(Vec3d forward) {
  const Vec3d right = cross(forward, {0, 1, 0});
  const double size = length(right);
  return size > 1e-9 ? right * (1 / size) : Vec3d{0, 0, 1};
}

Vec3d lateral_avoidance(const Body& self, const Threat& threat, const Model& model) {
  const Vec3d away = self.position - threat.other_then;
  const Vec3d right = right_of(self.forward);
  const double aside = dot(away, right);
  Vec3d force = right * aside;
  if (model.axes == Axes::kSideAndUp) {
    const Vec3d up = cross(right, self.forward);
    force = force + up * dot(away, up);
  }
  if (force == Vec3d{}) force = right * (side_when_in_line(self, threat) * model.max_force);
  return force;
}

Vec3d forward_avoidance(const Body& self, const Threat& threat, const Model& model) {
  if (length(self.velocity) < model.max_speed * model.lambda3) return self.forward;  // eq. 12
  return self.forward * dot(threat.self_then - threat.other_then, self.forward);     // eq. 13
}

Vec3d avoidance(const Body& self, const Threat& threat, const Model& model) {
  return limited(lateral_avoidance(self, threat, model) + forward_avoidance(self, threat, model),
                 model.max_force);
}

Vec3d path_amendment(const Body& self, Vec3d target, double stop_before, const Model& model) {
  const Vec3d to_target = target - self.position;
  const double distance = length(to_target);
  const double left = distance - stop_before;
  Vec3d wanted{};
  if (left > 0 && distance > kNone) {
    // Even braking: the speed falls with the square root of the distance left.
    const double speed = left < model.deceleration
                             ? model.max_speed * std::sqrt(left / model.deceleration)
                             : model.max_speed;
    wanted = to_target * (speed / distance);
  }
  return limited(wanted - self.velocity, model.max_force);
}

Vec3d steered(Vec3d velocity, Vec3d steer, double dt, const Model& model) {
  const Vec3d acceleration = limited(steer, model.max_force) * (1 / model.mass);
  return limited(velocity + acceleration * dt, model.max_speed);
}

Vec3d heading_of(Vec3d velocity, Vec3d before) {
  const double speed = length(velocity);
  return speed > 1e-9 ? velocity * (1 / speed) : before;
}

Curvilinear curvilinear(Vec3d forward, Vec3d acceleration) {
  const double tangential = dot(acceleration, forward);
  return {.tangential = tangential, .centripetal = length(acceleration - forward * tangential)};
}

bool goes_first(const Body& a, Vec3d target_a, const Body& b, Vec3d target_b) {
  const double left_a = length(target_a - a.position), left_b = length(target_b - b.position);
  if (left_a != left_b) return left_a < left_b;
  return a.id < b.id;
}

}  // namespace throng::caacd
