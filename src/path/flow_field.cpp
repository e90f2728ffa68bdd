// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <string>
#include <utility>

#include "core/access.h"
#include "core/stopwatch.h"
#include "path/edits/flow_points.h"
#include "path/path_finder_state.h"

// A FlowField is a table of FlowPoints with a ground of its own.
namespace throng {

struct FlowField::State {
  path::GroundFinder ground;
  std::shared_ptr<const path::FlowPoints> points;
  double seconds = 0;
};

FlowField::FlowField(std::unique_ptr<State> state) : state_(std::move(state)) {}
FlowField::FlowField(const FlowField& other) : state_(std::make_unique<State>(*other.state_)) {}
FlowField& FlowField::operator=(const FlowField& other) {
  if (this != &other) state_ = std::make_unique<State>(*other.state_);
  return *this;
}
FlowField::FlowField(FlowField&&) noexcept = default;
FlowField& FlowField::operator=(FlowField&&) noexcept = default;
FlowField::~FlowField() = default;

Result<FlowField> FlowField::create(const PathFinder& finder, std::span<const Place> goals,
                                    const FlowConfig& config, Context& context) {
  if (!(config.max_distance > 0))
    return Error{Errc::kBadConfig, "flow field: max_distance must be above 0"};
  const auto start = Clock::now();
  auto state =
      std::make_unique<State>(State{Access::state(finder)->ground_of_its_own(), nullptr, 0});
  auto points = path::FlowPoints::create(state->ground, goals, config.max_distance, context);
  if (!points) return Error{Errc::kCancelled, "flow field: cancelled"};
  if (points->empty()) {
    return Error{Errc::kBadInput, "flow field: none of " + std::to_string(goals.size()) +
                                      " goals is a place where the class can stand"};
  }
  state->points = std::make_shared<const path::FlowPoints>(std::move(*points));
  state->seconds = seconds_since(start);
  return FlowField(std::move(state));
}

double FlowField::distance(const Place& place) {
  return state_->points->distance(state_->ground, place);
}

Place FlowField::next(const Place& place) { return state_->points->next(state_->ground, place); }

void FlowField::find_path(const Place& place, Path& path) {
  state_->points->find_path(state_->ground, place, path);
}

FlowSummary FlowField::summary() const {
  return {state_->points->size(), state_->points->bytes(), state_->seconds};
}

}  // namespace throng
