// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/models.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "steer/social_force.h"
#include "throng/base.h"

// [CAACD] and [HM95] as models of a crowd. They define no step length: both are integrated by
// Euler's method in parts of a step that are short beside their time constants.
namespace throng::steer {
namespace {

// Of [CAACD]'s figures: a body's repulsive, precaution and alert fields.
constexpr caacd::Fields kFields = {5, 7.5, 12};
constexpr double kMaxFrames = 2.5;  // of a part of a step
constexpr double kMaxPart = 0.03;   // [s] of a part of a step

Vec3d flat(Plane p, double scale) { return {p.x * scale, 0, p.z * scale}; }

Plane limited(double x, double z, double max) {
  const double size = std::sqrt(x * x + z * z);
  const double scale = size > max ? max / size : 1;
  return {static_cast<float>(x * scale), static_cast<float>(z * scale)};
}

// The unit of length makes the repulsive field as large as the body; the unit of time makes the
// model's maximum speed equal to `fastest`.
Plane curvilinear_velocity(const View& view, float dt, const caacd::Model& model) {
  const double units = kFields.repulsive / view.radius;          // a metre
  const double frames = view.fastest * units / model.max_speed;  // a second
  const double speed = units / frames;
  const Plane heading = size_of(view.velocity) > 1e-6f ? view.velocity : view.preferred;
  caacd::Body self{.position = {},
                   .velocity = flat(view.velocity, speed),
                   .forward = caacd::heading_of(flat(heading, speed), {1, 0, 0}),
                   .fields = kFields,
                   .id = view.slot};
  std::array<caacd::Body, kMaxNear> others;
  THRONG_ASSERT(view.others.size() <= others.size());
  for (size_t n = 0; n < view.others.size(); ++n) {
    const Other& other = view.others[n];
    const double size = double{other.radius} / view.radius;
    others[n] = {
        .position = flat(other.at, units),
        .velocity = flat(other.velocity, speed),
        .fields = {kFields.repulsive * size, kFields.precaution * size, kFields.alert * size},
        .id = other.slot};
  }
  const std::span<caacd::Body> near(others.data(), view.others.size());
  // The avatar does not stop at a corner: the target is moved beyond the braking distance.
  Vec3d target = flat(view.to_target, units);
  const double far = length(target);
  if (!view.stops && far > 1e-9) target = target * ((far + 2 * model.deceleration) / far);
  const int parts = std::max(1, static_cast<int>(std::ceil(dt * frames / kMaxFrames)));
  const double part = dt * frames / parts;
  for (int k = 0; k < parts; ++k) {
    const caacd::Threat threat = caacd::greatest_threat(self, near, {}, model);
    const Vec3d force = threat.state != caacd::State::kTolerable
                            ? caacd::avoidance(self, threat, model)
                            : caacd::path_amendment(self, target, 0, model);
    self.velocity = caacd::steered(self.velocity, force, part, model);
    self.forward = caacd::heading_of(self.velocity, self.forward);
    self.position = self.position + self.velocity * part;
    for (caacd::Body& other : near) other.position = caacd::position_at(other, part);
  }
  return limited(self.velocity.x / speed, self.velocity.z / speed, view.fastest);
}

// No speed is above `fastest`: a crowd's moves must not be longer.
Plane force_velocity(const View& view, float dt) {
  const SocialForceConfig config;
  ForceWalker self{.vx = view.velocity.x,
                   .vz = view.velocity.z,
                   .preferred_x = view.preferred.x,
                   .preferred_z = view.preferred.z};
  std::array<ForceWalker, kMaxNear> others;
  THRONG_ASSERT(view.others.size() <= others.size());
  for (size_t n = 0; n < view.others.size(); ++n) {
    const Other& other = view.others[n];
    others[n] = {.x = other.at.x, .z = other.at.z, .vx = other.velocity.x, .vz = other.velocity.z};
  }
  const std::span<ForceWalker> near(others.data(), view.others.size());
  const int parts = std::max(1, static_cast<int>(std::ceil(dt / kMaxPart)));
  const double part = double{dt} / parts;
  for (int k = 0; k < parts; ++k) {
    Force sum = drive(self, config);
    for (const ForceWalker& other : near) add_repulsion(sum, self, other, config);
    if (view.has_wall) add_wall(sum, view.wall.x - self.x, view.wall.z - self.z, config);
    const Plane v = limited(self.vx + sum.x * part, self.vz + sum.z * part, view.fastest);
    self.vx = v.x;
    self.vz = v.z;
    self.x += self.vx * part;
    self.z += self.vz * part;
    for (ForceWalker& other : near) {
      other.x += other.vx * part;
      other.z += other.vz * part;
    }
  }
  return {static_cast<float>(self.vx), static_cast<float>(self.vz)};
}

}  // namespace

Plane preferred_velocity(SteeringModel model, const View& view, float dt,
                         const caacd::Model& curves) {
  THRONG_ASSERT(model != SteeringModel::kSampled);
  return model == SteeringModel::kCurvilinear ? curvilinear_velocity(view, dt, curves)
                                              : force_velocity(view, dt);
}

Choices candidates_about(Plane preferred) {
  const float size = size_of(preferred);
  const Fan fan = fan_around(preferred);  // every 15 degrees, from X to Z: to the right
  Choices candidates{preferred};
  constexpr std::array<size_t, 6> kTurned = {2, 22, 4, 20, 6, 18};
  for (size_t n = 0; n < kTurned.size(); ++n) {
    const Plane direction = fan[kTurned[n]];
    candidates[n + 1] = {direction.x * size, direction.z * size};
  }
  candidates.back() = {preferred.x * 0.75f, preferred.z * 0.75f};
  return candidates;
}

}  // namespace throng::steer
