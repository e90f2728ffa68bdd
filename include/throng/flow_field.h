// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/live_ground.h"
#include "throng/path.h"
#include "throng/result.h"
#include "throng/world.h"

/// Flow fields: the distance to the nearest of some goals from everywhere, by one search for all
/// avatars that share these goals.
namespace throng {

/// Settings for FlowField::make.
struct FlowConfig {
  /// Largest distance that is searched. [> 0, m]
  double max_distance = std::numeric_limits<double>::infinity();
};

/// Sizes of a flow field.
struct FlowSummary {
  uint64_t points = 0;  ///< Points on borders of rectangles that the search reached from the goals.
  uint64_t bytes = 0;
  double seconds = 0;  ///< To make it.
};

/// Distances to goals over points on the borders of rectangles, as LiveGround searches them. It
/// describes the ground at the time when it was made; if the ground changes, make another one.
/// Off-mesh links are ignored. Each copy has its own memory for queries; give every thread one.
class THRONG_API FlowField {
 public:
  /// Makes a field by one Dijkstra search. Goals that are no places of the class are ignored. Fails
  /// with kBadInput (no goal is left) or kCancelled.
  [[nodiscard]] static Result<FlowField> make(const LiveGround& ground,
                                              std::span<const Place> goals,
                                              const FlowConfig& config, Context& context);
  FlowField(const FlowField&);
  FlowField& operator=(const FlowField&);
  FlowField(FlowField&&) noexcept;
  FlowField& operator=(FlowField&&) noexcept;
  ~FlowField();

  /// Cost of the path to the nearest goal over the points: on average 1 to 2 % above the minimum.
  /// Infinite if no path leads there, or none within `max_distance`. [m]
  [[nodiscard]] double distance(const Place& place);
  /// The next local target: the farthest point of the path to the nearest goal to which a straight
  /// line leads. At last the goal itself; nowhere if no path leads there.
  [[nodiscard]] Place next(const Place& place);
  /// Finds the whole path to the nearest goal, pulled taut.
  void find_path(const Place& place, Path& path);

  [[nodiscard]] FlowSummary summary() const;

 private:
  struct State;
  explicit FlowField(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
