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

/// How far it is to the nearest of some goals, from everywhere: one search for all who share them.
namespace throng {

struct FlowConfig {
  double max_distance = std::numeric_limits<double>::infinity();  ///< Costs to look up to. [> 0, m]
};

struct FlowSummary {
  uint64_t points = 0;  ///< Of borders of rectangles that the goals were seen from.
  uint64_t bytes = 0;
  double seconds = 0;  ///< To make it.
};

/// Distances to goals over the points of borders of rectangles, as LiveGround searches them. It
/// shows the ground as it was when the field was made: whoever changes the ground makes another.
/// Jumps are left out.
/// Each copy has its own memory for walking; give every thread one.
class THRONG_API FlowField {
 public:
  /// Fails with kBadInput (no goal is a place of the class) or kCancelled. Goals that are no places
  /// are left out.
  [[nodiscard]] static Result<FlowField> make(const LiveGround& ground,
                                              std::span<const Place> goals,
                                              const FlowConfig& config, Context& context);
  FlowField(const FlowField&);
  FlowField& operator=(const FlowField&);
  FlowField(FlowField&&) noexcept;
  FlowField& operator=(FlowField&&) noexcept;
  ~FlowField();

  /// Cost of the way to the nearest goal, as it goes over the points: in the mean 1 to 2 % above
  /// the least. Infinite where none leads there, or none within `max_distance`. [m]
  [[nodiscard]] double distance(const Place& place);
  /// Where to walk to in a straight line, to come nearer to the goal: the farthest point of the way
  /// that such a line reaches. The goal itself at last; nowhere if no way leads there.
  [[nodiscard]] Place next(const Place& place);
  /// The whole way, drawn straight.
  void find_path(const Place& place, Path& path);

  [[nodiscard]] FlowSummary summary() const;

 private:
  struct State;
  explicit FlowField(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
