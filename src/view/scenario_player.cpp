// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/scenario_player.h"

#include <algorithm>
#include <utility>

// A frame per step of a simulation; obstacles are shared between frames while they stay the same.
namespace throng::view {
namespace {

bool are_alike(const std::vector<Prism>& a, const std::vector<Prism>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Prism& p, const Prism& q) {
    return p.low == q.low && p.high == q.high && p.corners == q.corners;
  });
}

}  // namespace

ScenarioPlayer::ScenarioPlayer(Simulation&& simulation, double seconds, Vec3d origin)
    : simulation_(std::move(simulation)), seconds_(seconds), origin_(origin) {}

Result<std::unique_ptr<ScenarioPlayer>> ScenarioPlayer::create(const World& world,
                                                               const Scenario& scenario,
                                                               int32_t workers, Vec3d origin,
                                                               Context& context) {
  Result<Simulation> simulation = Simulation::create(world, scenario, workers, context);
  if (!simulation) return simulation.error();
  return std::unique_ptr<ScenarioPlayer>(
      new ScenarioPlayer(*std::move(simulation), scenario.seconds, origin));
}

std::shared_ptr<const TimelineFrame> ScenarioPlayer::next() {
  if (!last_) return again();
  const bool is_over = report_.time >= seconds_ - 1e-9 || simulation_.is_over();
  if (is_over || !fault_.empty()) return nullptr;
  const Result<SimulationReport> report = simulation_.step();
  if (report) {
    report_ = *report;
  } else {
    fault_ = report.error().message;
  }
  return again();
}

std::shared_ptr<const TimelineFrame> ScenarioPlayer::again() {
  simulation_.read(states_);
  const auto frame = std::make_shared<TimelineFrame>();
  frame->time = report_.time;
  frame->report = report_.crowd;
  frame->fault = fault_;
  frame->flow = {.entered = std::max<uint64_t>(report_.entered, states_.size()),
                 .left = report_.left,
                 .outside = report_.outside,
                 .in_links = report_.in_links,
                 .goal_unreachable = report_.goal_unreachable};
  std::vector<Prism> obstacles = simulation_.crowd().obstacles();
  if (!obstacles_ || !are_alike(*obstacles_, obstacles)) {
    obstacles_ = std::make_shared<const std::vector<Prism>>(std::move(obstacles));
  }
  frame->obstacles = obstacles_;
  put_states(states_, origin_, *frame);
  follow(last_ ? *last_ : TimelineFrame{}, *frame);
  last_ = frame;
  return frame;
}

}  // namespace throng::view
