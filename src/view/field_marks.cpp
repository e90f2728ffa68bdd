// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "throng/papers.h"
#include "view/overlays.h"

// [CAACD] II: three concentric fields around each avatar, the probe ahead, and the state that
// results from the other avatars, in O(n^2) for at most 300 avatars. The `sampled` model does not
// use them; of a crowd that [CAACD] steers they are those that it steers by.
namespace throng::view {
namespace {

constexpr double kMarkHeight = 0.05;                            // [m]
constexpr double kPrecautionMargin = 0.25, kAlertMargin = 0.7;  // [m] Beyond the body's radius.
constexpr size_t kMaxAvatars = 300;  // Avatars that are shown, the nearest first.
constexpr double kMarkRadius = 8;    // [m] Around the picked avatar.

caacd::Model model_of_metres() {
  caacd::Model model;
  model.max_speed = 2;
  model.horizon = 3;       // [s]
  model.probe_time = 0.8;  // [s]
  model.trigger = caacd::Trigger::kThreat;
  return model;
}

Rgba colour_of(caacd::State state, uint32_t alpha) {
  switch (state) {
    case caacd::State::kTolerable:
      return rgba(90, 200, 110, alpha);
    case caacd::State::kAlert:
      return rgba(245, 210, 60, alpha);
    case caacd::State::kCritical:
      return rgba(250, 130, 40, alpha);
    case caacd::State::kCollision:
      return rgba(230, 40, 40, alpha);
  }
  return 0;
}

MarkVertex vertex(Vec3d p, Rgba colour) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), colour};
}

void add_circle(Marks& marks, Vec3d middle, double radius, Rgba colour) {
  constexpr int32_t kSides = 32;
  const auto rim = [&](int32_t n) {
    const double angle = 2 * std::numbers::pi * n / kSides;
    return middle + Vec3d{radius * std::cos(angle), 0, radius * std::sin(angle)};
  };
  for (int32_t k = 0; k < kSides; ++k) {
    marks.lines.push_back(vertex(rim(k), colour));
    marks.lines.push_back(vertex(rim(k + 1), colour));
  }
}

void add_probe(Marks& marks, const caacd::Body& body, double far, Rgba colour) {
  const Vec3d ahead = body.forward * far;
  const Vec3d side = caacd::right_of(body.forward) * body.fields.repulsive;
  const std::array<Vec3d, 4> c = {body.position + side, body.position + side + ahead,
                                  body.position - side + ahead, body.position - side};
  for (const size_t k : {0, 1, 2, 0, 2, 3}) marks.triangles.push_back(vertex(c[k], colour));
}

caacd::Body body_of(const TimelineFrame& crowd, size_t i, const std::vector<double>& radii) {
  const double radius =
      radii.empty() ? 0.25 : radii[std::min<size_t>(crowd.classes[i], radii.size() - 1)];
  const double angle = 2 * std::numbers::pi * static_cast<double>(crowd.heading[i]);
  caacd::Body body;
  body.position = {crowd.x[i], crowd.y[i] + kMarkHeight, crowd.z[i]};
  body.forward = {std::sin(angle), 0, std::cos(angle)};
  body.velocity = body.forward * static_cast<double>(crowd.speed[i]);
  body.fields = {radius, radius + kPrecautionMargin, radius + kAlertMargin};
  if (crowd.curved) body.fields = crowd.curved->avatars[i].fields;
  body.id = static_cast<uint32_t>(i);
  return body;
}

// The worst state: of the distances to others now, and of the predicted ones.
caacd::State state_of(const caacd::Body& self, const std::vector<caacd::Body>& all,
                      const caacd::Model& model) {
  auto worst = caacd::State::kTolerable;
  for (const caacd::Body& other : all) {
    if (other.id == self.id || std::abs(other.position.y - self.position.y) > 2) continue;
    const Vec3d apart{other.position.x - self.position.x, 0, other.position.z - self.position.z};
    const caacd::State now =
        caacd::state_at(length(apart), caacd::joint_fields(self.fields, other.fields));
    worst = std::max({worst, now, caacd::threat_of(self, other, model).state});
  }
  return worst;
}

}  // namespace

Marks field_marks(const TimelineFrame& crowd, size_t picked, Vec3d middle,
                  const std::vector<double>& radii) {
  const bool has_picked = picked < crowd.size();
  if (has_picked) middle = {crowd.x[picked], crowd.y[picked], crowd.z[picked]};
  std::vector<std::pair<double, size_t>> near;
  for (size_t i = 0; i < crowd.size(); ++i) {
    const double away = length(Vec3d{crowd.x[i], crowd.y[i], crowd.z[i]} - middle);
    if (!has_picked || crowd.curved || away < kMarkRadius) near.emplace_back(away, i);
  }
  std::sort(near.begin(), near.end());
  if (near.size() > kMaxAvatars) near.resize(kMaxAvatars);
  std::vector<caacd::Body> bodies;
  for (const auto& [away, i] : near) bodies.push_back(body_of(crowd, i, radii));
  const caacd::Model model = model_of_metres();
  Marks marks;
  for (const caacd::Body& body : bodies) {
    const CurvedAvatar* const curved = crowd.curved ? &crowd.curved->avatars[body.id] : nullptr;
    const caacd::State state = curved ? curved->state : state_of(body, bodies, model);
    const double far = curved ? curved->probe : caacd::probe_length(body, model);
    add_probe(marks, body, far, colour_of(state, 90));
    add_circle(marks, body.position, body.fields.repulsive, colour_of(state, 255));
    add_circle(marks, body.position, body.fields.precaution, colour_of(state, 190));
    add_circle(marks, body.position, body.fields.alert, colour_of(state, 110));
  }
  marks.line_width = 1.5F;
  return marks;
}

}  // namespace throng::view
