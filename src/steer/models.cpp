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

// The velocity after `frames`, in which the others keep theirs. In parts that are short beside the
// time in which a body turns.
Vec3d velocity_after(caacd::Body self, std::span<caacd::Body> near, Vec3d target, double frames,
                     const caacd::Model& model) {
  const int parts = std::max(1, static_cast<int>(std::ceil(frames / kMaxFrames)));
  const double part = frames / parts;
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
  return self.velocity;
}

caacd::Fields fields_of(double size) {
  return {kFields.repulsive * size, kFields.precaution * size, kFields.alert * size};
}

// An avatar does not stop at a corner: the target is moved beyond the braking distance.
Vec3d onward(Vec3d target, bool stops, const caacd::Model& model) {
  const double far = length(target);
  if (!stops && far > 1e-9) return target * ((far + 2 * model.deceleration) / far);
  return target;
}

// The unit of length makes the repulsive field as large as the body; the unit of time makes the
// model's maximum speed equal to `fastest`.
Plane curvilinear_velocity(const View& view, float dt, const caacd::Model& model) {
  const double units = kFields.repulsive / view.radius;          // a metre
  const double frames = view.fastest * units / model.max_speed;  // a second
  const double speed = units / frames;
  const Plane heading = size_of(view.velocity) > 1e-6f ? view.velocity : view.preferred;
  const caacd::Body self{.position = {},
                         .velocity = flat(view.velocity, speed),
                         .forward = caacd::heading_of(flat(heading, speed), {1, 0, 0}),
                         .fields = kFields,
                         .id = view.slot};
  std::array<caacd::Body, kMaxNear> others;
  THRONG_ASSERT(view.others.size() <= others.size());
  for (size_t n = 0; n < view.others.size(); ++n) {
    const Other& other = view.others[n];
    others[n] = {.position = flat(other.at, units),
                 .velocity = flat(other.velocity, speed),
                 .fields = fields_of(double{other.radius} / view.radius),
                 .id = other.slot};
  }
  const std::span<caacd::Body> near(others.data(), view.others.size());
  const Vec3d target = onward(flat(view.to_target, units), view.stops, model);
  const Vec3d v = velocity_after(self, near, target, dt * frames, model);
  return limited(v.x / speed, v.z / speed, view.fastest);
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

Space curvilinear_in_air(const AirSituation& situation, const AirView& view, float dt,
                         const caacd::Model& curves) {
  const double units = kFields.repulsive / view.radius;                // a metre
  const double frames = situation.fastest * units / curves.max_speed;  // a second
  const double speed = units / frames;
  const double squash = 2 * double{view.radius} / situation.height;  // of heights
  const auto scaled = [squash](Space p, double scale) {
    return Vec3d{p.x * scale, p.y * scale * squash, p.z * scale};
  };
  const Space heading =
      size_of(situation.velocity) > 1e-6f ? situation.velocity : situation.preferred;
  const caacd::Body self{.position = {},
                         .velocity = scaled(situation.velocity, speed),
                         .forward = caacd::heading_of(scaled(heading, speed), {1, 0, 0}),
                         .fields = kFields,
                         .id = view.slot};
  std::array<caacd::Body, kMaxNearInAir> others;
  for (size_t n = 0; n < situation.size; ++n) {
    const AirNeighbour& other = situation.near[n];
    Space at = other.at;  // of the middles, whose heights differ from those of the feet
    at.y += (other.height - situation.height) / 2;
    others[n] = {.position = scaled(at, units),
                 .velocity = scaled(other.velocity, speed),
                 .fields = fields_of((double{other.radii} - view.radius) / view.radius),
                 .id = other.slot};
  }
  const std::span<caacd::Body> near(others.data(), situation.size);
  const Vec3d target = onward(scaled(view.to_target, units), view.stops, curves);
  const Vec3d v = velocity_after(self, near, target, dt * frames, curves);
  const Space out{static_cast<float>(v.x / speed), static_cast<float>(v.y / speed / squash),
                  static_cast<float>(v.z / speed)};
  const float size = size_of(out);
  return size > situation.fastest ? (situation.fastest / size) * out : out;
}

AirChoices candidates_in_air(Space preferred) {
  const Choices level = candidates_about({preferred.x, preferred.z});
  AirChoices candidates;
  static_assert(std::tuple_size_v<Choices> == kAirChoices);
  for (size_t n = 0; n < candidates.size(); ++n) {
    candidates[n] = {level[n].x, preferred.y, level[n].z};
  }
  candidates.back() = 0.75f * preferred;
  return candidates;
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
