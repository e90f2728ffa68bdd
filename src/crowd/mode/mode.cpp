// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/mode/mode.h"

#include <cmath>

#include "crowd/mode/given_moves.h"

// What most modes do alike.
namespace throng::crowd {

BodyExtent Mode::extent_of(const Body& body, double /*radius*/) const {
  return {body.radius, body.radius, body.height};
}

void Mode::areas_changed(std::span<Body> /*bodies*/) {}

bool Mode::must_leave(const Body& /*body*/, const Prism& /*obstacle*/) const { return true; }

double Mode::height_of(const Body& body) const {
  return shared_.body_class(body.avatar_class).height;
}

void Mode::check(std::span<const Body> /*bodies*/, CrowdCheck& /*found*/) const {}

uint64_t Mode::hash(const Body& /*body*/, uint64_t hash) const { return hash; }

bool Mode::is_in_place(const Body& /*body*/) const { return true; }

Vec3d Mode::control(Body& body, const Vec3d& velocity) {
  const Vec3d& v = velocity;
  double size = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  if (!std::isfinite(size)) size = INFINITY;
  const double part = size > body.speed ? body.speed / size : 1;
  if (!body.has(Body::kExternal)) forget_rest(body);
  body.flags = (body.flags & Body::kMovedElsewhere) | Body::kExternal;
  const Vec3d cut = part > 0 ? Vec3d{v.x * part, v.y * part, v.z * part} : Vec3d{};
  body.preferred = {static_cast<float>(cut.x), static_cast<float>(cut.z)};
  return cut;
}

}  // namespace throng::crowd
