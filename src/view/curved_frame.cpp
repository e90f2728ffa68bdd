// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/curved_frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

// States by [CAACD] II and III.A, in metres and seconds: what the steering decides does not depend
// on the units. Neighbours come from cells that are sorted by column.
namespace throng::view {
namespace {

// [CAACD]'s figures, as the steering model of a crowd has them: radii of the fields by that of the
// body, and the latest nearest approach in frames of MaxSpeed.
constexpr double kRepulsive = 5, kPrecaution = 7.5, kAlert = 12;  // [units]
constexpr double kHorizon = 60;                                   // [frames]
constexpr double kStorey = 2;                                     // [m]

caacd::Body body_of(const CurvedWalker& w, uint32_t id) {
  const double unit = w.radius / kRepulsive;
  return {.position = {w.position.x, 0, w.position.z},
          .velocity = {w.velocity.x, 0, w.velocity.z},
          .fields = {w.radius, kPrecaution * unit, kAlert * unit},
          .id = id};
}

caacd::Model model_of(const CurvedWalker& w) {
  const double units = kRepulsive / w.radius;                  // a metre
  const double frames = w.speed * units / w.tuning.max_speed;  // a second
  caacd::Model model;
  model.max_speed = w.speed;
  model.horizon = kHorizon / frames;
  return model;
}

using Column = std::pair<int64_t, int64_t>;

}  // namespace

std::array<size_t, 4> CurvedFrame::count_states() const {
  std::array<size_t, 4> counts{};
  for (const CurvedAvatar& avatar : avatars) ++counts[static_cast<size_t>(avatar.state)];
  return counts;
}

std::shared_ptr<const CurvedFrame> curved_frame(std::span<const CurvedWalker> walkers) {
  auto frame = std::make_shared<CurvedFrame>();
  std::vector<caacd::Body> bodies;
  double widest = 0.25;
  for (uint32_t i = 0; i < walkers.size(); ++i) {
    bodies.push_back(body_of(walkers[i], i));
    widest = std::max(widest, bodies.back().fields.alert);
  }
  // Farther apart than a cell no pair is in its alert field.
  const double side = 2 * widest;
  const auto cell_of = [side](Vec3d p) {
    return Column{static_cast<int64_t>(std::floor(p.x / side)),
                  static_cast<int64_t>(std::floor(p.z / side))};
  };
  std::vector<std::pair<Column, uint32_t>> sorted;
  for (const caacd::Body& body : bodies) sorted.emplace_back(cell_of(body.position), body.id);
  std::sort(sorted.begin(), sorted.end());
  for (uint32_t i = 0; i < walkers.size(); ++i) {
    const caacd::Body& self = bodies[i];
    const caacd::Model model = model_of(walkers[i]);
    const Column here = cell_of(self.position);
    auto worst = caacd::State::kTolerable;
    for (int64_t column = here.first - 1; column <= here.first + 1; ++column) {
      const std::pair<Column, uint32_t> first{{column, here.second - 1}, 0};
      for (auto at = std::lower_bound(sorted.begin(), sorted.end(), first);
           at != sorted.end() && at->first <= Column{column, here.second + 1}; ++at) {
        const caacd::Body& other = bodies[at->second];
        if (other.id == i ||
            std::abs(walkers[other.id].position.y - walkers[i].position.y) > kStorey) {
          continue;
        }
        const caacd::State now = caacd::state_at(length(other.position - self.position),
                                                 caacd::joint_fields(self.fields, other.fields));
        worst = std::max({worst, now, caacd::threat_of(self, other, model).state});
      }
    }
    frame->avatars.push_back({.state = worst,
                              .fields = self.fields,
                              .probe = caacd::probe_length(self, model),
                              .tuning = walkers[i].tuning});
  }
  return frame;
}

}  // namespace throng::view
