// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/door_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"

namespace throng {
namespace {

// When an avatar that arrives in `tick` has passed: all are served in order of arrival, one by one.
double pass_time_by_events(std::vector<uint32_t> ticks, double flow, uint32_t tick, uint32_t now) {
  for (uint32_t& t : ticks) t = std::max(t, now);
  std::sort(ticks.begin(), ticks.end());
  double free = -1e9;
  for (const uint32_t t : ticks) {
    if (t > std::max(tick, now)) break;
    free = std::max(free, t * scenario::DoorQueue::kTick) + 1 / flow;
  }
  return std::max(free, std::max(tick, now) * scenario::DoorQueue::kTick) + 1 / flow;
}

TEST(DoorQueue, ServesNoAvatarBeforeItsArrival) {
  scenario::DoorQueue door(2);
  EXPECT_DOUBLE_EQ(door.pass_time(scenario::DoorQueue::tick(10), 0), 10.5);
  // Four arrive at 20 s: an arrival at 10 s passes before them, one at 21 s after them.
  for (int k = 0; k < 4; ++k) door.add(scenario::DoorQueue::tick(20));
  EXPECT_DOUBLE_EQ(door.pass_time(scenario::DoorQueue::tick(10), 0), 10.5);
  EXPECT_DOUBLE_EQ(door.pass_time(scenario::DoorQueue::tick(21), 0), 22.5);
  EXPECT_DOUBLE_EQ(door.pass_time(scenario::DoorQueue::tick(30), 0), 30.5);
  // At 25 s all four are late: they stand at the door.
  EXPECT_DOUBLE_EQ(door.pass_time(scenario::DoorQueue::tick(21), scenario::DoorQueue::tick(25)),
                   27.5);
  door.remove(scenario::DoorQueue::tick(20));
  EXPECT_DOUBLE_EQ(door.pass_time(scenario::DoorQueue::tick(21), 0), 22);
}

TEST(DoorQueue, ReturnsTheTimesOfASimulationOfAllEvents) {
  for (uint64_t seed = 0; seed < 30; ++seed) {
    const double flow = 0.2 + 4 * random_unit(seed, 1, 0);
    scenario::DoorQueue door(flow);
    std::vector<uint32_t> ticks;
    uint64_t draws = 0;
    const auto below = [&](uint64_t end) { return random_below(seed, 2, draws++, end); };
    for (int change = 0; change < 600; ++change) {
      // Some ticks lie far ahead: the tree grows.
      const auto tick = static_cast<uint32_t>(below(change % 97 == 96 ? 20000 : 300));
      if (!ticks.empty() && below(3) == 0) {
        const size_t k = below(ticks.size());
        door.remove(ticks[k]);
        ticks.erase(ticks.begin() + static_cast<int64_t>(k));
      } else {
        door.add(tick);
        ticks.push_back(tick);
      }
      const auto arrival = static_cast<uint32_t>(below(400)),
                 now = static_cast<uint32_t>(below(200));
      EXPECT_NEAR(door.pass_time(arrival, now), pass_time_by_events(ticks, flow, arrival, now),
                  1e-6);
    }
  }
}

// Ticks before now are forgotten, except for the avatars expected there that are late.
TEST(DoorQueue, NeedsNoMoreMemoryOverDays) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const double flow = 0.5 + 2 * random_unit(seed, 1, 0);
    scenario::DoorQueue door(flow);
    std::vector<uint32_t> ticks;
    uint64_t draws = 0;
    const auto below = [&](uint64_t end) { return random_below(seed, 2, draws++, end); };
    uint32_t now = 0;
    size_t max_kept = 0;
    for (int change = 0; change < 20000; ++change) {
      // Nights: no arrivals for hours.
      now += static_cast<uint32_t>(change % 4000 == 3999 ? 8 * 3600 * 20 : below(100));
      door.forget_before(now);
      if (ticks.size() > 40 || (!ticks.empty() && below(2) == 0)) {
        const size_t k = below(ticks.size());
        door.remove(ticks[k]);
        ticks.erase(ticks.begin() + static_cast<int64_t>(k));
      } else {
        ticks.push_back(door.add(now + static_cast<uint32_t>(below(3000))));
      }
      if (change % 7 != 0) continue;
      const auto arrival = now + static_cast<uint32_t>(below(3000));
      const double pass_time = pass_time_by_events(ticks, flow, arrival, now);
      ASSERT_NEAR(door.pass_time(arrival, now), pass_time, 1e-9 * pass_time) << change;
      max_kept = std::max(max_kept, door.kept());
    }
    EXPECT_LE(max_kept, 8192U);
  }
}

TEST(DoorQueue, ClampsTimesOutOfRange) {
  scenario::DoorQueue door(1);
  EXPECT_EQ(scenario::DoorQueue::tick(-3), 0U);
  const uint32_t last = scenario::DoorQueue::tick(INFINITY);
  EXPECT_EQ(last, scenario::DoorQueue::tick(1e12));
  const uint32_t kept = door.add(last);
  EXPECT_EQ(kept, scenario::DoorQueue::tick(6 * 3600));
  door.remove(kept);
  EXPECT_DOUBLE_EQ(door.pass_time(0, 0), 1);
}

}  // namespace
}  // namespace throng
