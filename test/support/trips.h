// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>

#include "throng/crowd.h"

/// Steps a crowd until its avatars have arrived, and checks it meanwhile.
namespace throng {

/// `Stage`: has Faults (overlaps, entered, bodies, pairs) and look(crowd, faults).
template <class Stage>
struct TripRun {
  size_t arrived = 0;
  int steps = 0;
  typename Stage::Faults faults;
};

/// Steps until `all` have arrived, at most `max_steps`; checks each `every`-th step.
template <class Stage>
TripRun<Stage> go(Crowd& crowd, Stage& stage, size_t all, int max_steps, int every = 1) {
  TripRun<Stage> trip;
  std::set<uint32_t> there;
  for (; trip.steps < max_steps && there.size() < all; ++trip.steps) {
    crowd.step();
    for (const AvatarId id : crowd.arrived()) there.insert(id.slot1);
    if (trip.steps % every == 0) stage.look(crowd, trip.faults);
  }
  trip.arrived = there.size();
  testing::Test::RecordProperty("steps", trip.steps);
  testing::Test::RecordProperty("bodies", std::to_string(trip.faults.bodies));
  testing::Test::RecordProperty("pairs", std::to_string(trip.faults.pairs));
  return trip;
}

template <class Stage>
void expect_all(const TripRun<Stage>& trip, size_t all) {
  EXPECT_EQ(trip.arrived, all);
  EXPECT_EQ(trip.faults.overlaps, 0u);
  EXPECT_EQ(trip.faults.entered, 0u);
  EXPECT_GT(trip.faults.bodies, 0u);
}

}  // namespace throng
