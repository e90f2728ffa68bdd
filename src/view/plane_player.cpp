// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/plane_player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

// A timeline frame for each frame of the experiment. The plane is y = 0 in the world; obstacles are
// as wide as their repulsive fields. Time: the square of the avatars, as for the experiment.
namespace throng::view {
namespace {

constexpr double kUnit = ExperimentStart::kUnit;
constexpr double kFrame = 1 / ExperimentStart::kFramesPerSecond;  // [s]
constexpr double kObstacleHeight = 1;                             // [m]

Prism prism_of(const caacd::Obstacle& obstacle) {
  constexpr int kSides = 32;
  Prism prism;
  prism.low = 0;
  prism.high = kObstacleHeight;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSides;
    const double radius = obstacle.fields.repulsive * kUnit;
    prism.corners.push_back({obstacle.position.x * kUnit + radius * std::cos(angle),
                             obstacle.position.z * kUnit + radius * std::sin(angle)});
  }
  return prism;
}

}  // namespace

PlanePlayer::PlanePlayer(caacd::Simulation&& simulation, Vec3d origin)
    : simulation_(std::move(simulation)), origin_(origin) {
  std::vector<Prism> prisms;
  for (const caacd::Obstacle& obstacle : simulation_.obstacles()) {
    prisms.push_back(prism_of(obstacle));
  }
  obstacles_ = std::make_shared<const std::vector<Prism>>(std::move(prisms));
}

Result<std::unique_ptr<PlanePlayer>> PlanePlayer::create(const ExperimentStart& start,
                                                         Vec3d origin) {
  Result<caacd::Space> space = caacd::random_space(start.space, start.model);
  if (!space) return space.error();
  Result<caacd::Simulation> made = caacd::Simulation::create(*std::move(space), start.model);
  if (!made) return made.error();
  return std::unique_ptr<PlanePlayer>(new PlanePlayer(*std::move(made), origin));
}

std::shared_ptr<const TimelineFrame> PlanePlayer::next() {
  if (!last_) return again();
  if (simulation_.finished()) return nullptr;
  simulation_.step();
  return again();
}

std::shared_ptr<const TimelineFrame> PlanePlayer::again() {
  states_.clear();
  for (const caacd::Body& body : simulation_.bodies()) {
    AvatarState& state = states_.emplace_back();
    state.id = body.id;
    state.position = body.position * kUnit;
    state.heading_x = static_cast<float>(body.forward.x);
    state.heading_z = static_cast<float>(body.forward.z);
  }
  const auto frame = std::make_shared<TimelineFrame>();
  frame->time = static_cast<double>(simulation_.counts().frames) * kFrame;
  frame->obstacles = obstacles_;
  frame->curved = curved();
  put_states(states_, origin_, *frame);
  follow(last_ ? *last_ : TimelineFrame{}, *frame);
  last_ = frame;
  return frame;
}

// Each avatar's state: that of its greatest threat, or of the nearest avatar now if that is worse.
std::shared_ptr<const CurvedFrame> PlanePlayer::curved() const {
  auto frame = std::make_shared<CurvedFrame>();
  frame->counts = simulation_.counts();
  const std::span<const caacd::Body> bodies = simulation_.bodies();
  for (size_t i = 0; i < bodies.size(); ++i) {
    const caacd::Body& self = bodies[i];
    caacd::State worst = simulation_.threats()[i].state;
    for (const caacd::Body& other : bodies) {
      if (other.id == self.id) continue;
      const Vec3d apart = other.position - self.position;
      worst = std::max(
          worst, caacd::state_at(length(apart), caacd::joint_fields(self.fields, other.fields)));
    }
    for (const caacd::Obstacle& obstacle : simulation_.obstacles()) {
      // Of an obstacle only its solid part counts: its other fields are for probes.
      const Vec3d apart = obstacle.position - self.position;
      if (length(apart) <= self.fields.repulsive + obstacle.fields.repulsive) {
        worst = caacd::State::kCollision;
      }
    }
    const caacd::ParameterSet set = simulation_.parameters(self.id);
    frame->avatars.push_back(
        {.state = worst,
         .fields = {self.fields.repulsive * kUnit, self.fields.precaution * kUnit,
                    self.fields.alert * kUnit},
         .probe = caacd::probe_length(self, simulation_.model()) * kUnit,
         .tuning = {.mass = set.mass,
                    .max_speed = set.max_speed,
                    .max_force = set.max_force,
                    .by_state = simulation_.model().order == caacd::Order::kState}});
  }
  return frame;
}

void PlanePlayer::set_curves(std::optional<uint64_t> id, const CurvilinearTuning& tuning) {
  const caacd::ParameterSet set{tuning.mass, tuning.max_speed, tuning.max_force};
  for (const caacd::Body& body : simulation_.bodies()) {
    if (!id || *id == body.id) (void)simulation_.set_parameters(body.id, set);
  }
}

}  // namespace throng::view
