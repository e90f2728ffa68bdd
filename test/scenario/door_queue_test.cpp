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

// When who comes in `tick` is through: everybody is served in order of coming, event by event.
double pass_time_by_events(std::vector<uint32_t> ticks, double flow, uint32_t tick, uint32_t now) {
  for (uint32_t& t : ticks) t = std::max(t, now);
  std::sort(ticks.begin(), ticks.end());
  double free = -1e9;
  for (const uint32_t t : ticks) {
    if (t > std::max(tick, now)) break;
    free = std::max(free, t * DoorQueue::kTick) + 1 / flow;
  }
  return std::max(free, std::max(tick, now) * DoorQueue::kTick) + 1 / flow;
}

TEST(DoorQueue, a_door_serves_nobody_before_he_has_come) {
  DoorQueue door(2);
  EXPECT_DOUBLE_EQ(door.pass_time(DoorQueue::tick(10), 0), 10.5);
  // Four come at 20 s: whoever comes at 10 s is through before them, whoever comes at 21 s is not.
  for (int k = 0; k < 4; ++k) door.add(DoorQueue::tick(20));
  EXPECT_DOUBLE_EQ(door.pass_time(DoorQueue::tick(10), 0), 10.5);
  EXPECT_DOUBLE_EQ(door.pass_time(DoorQueue::tick(21), 0), 22.5);
  EXPECT_DOUBLE_EQ(door.pass_time(DoorQueue::tick(30), 0), 30.5);
  // They are late: at 25 s all four still stand at the door.
  EXPECT_DOUBLE_EQ(door.pass_time(DoorQueue::tick(21), DoorQueue::tick(25)), 27.5);
  door.remove(DoorQueue::tick(20));
  EXPECT_DOUBLE_EQ(door.pass_time(DoorQueue::tick(21), 0), 22);
}

TEST(DoorQueue, tells_the_times_of_a_simulation_event_by_event) {
  for (uint64_t seed = 0; seed < 30; ++seed) {
    const double flow = 0.2 + 4 * random_unit(seed, 1, 0);
    DoorQueue door(flow);
    std::vector<uint32_t> ticks;
    uint64_t draws = 0;
    const auto below = [&](uint64_t end) { return random_below(seed, 2, draws++, end); };
    for (int change = 0; change < 600; ++change) {
      // Long ways now and then: the tree grows.
      const auto tick = static_cast<uint32_t>(below(change % 97 == 96 ? 20000 : 300));
      if (!ticks.empty() && below(3) == 0) {
        const size_t k = below(ticks.size());
        door.remove(ticks[k]);
        ticks.erase(ticks.begin() + static_cast<int64_t>(k));
      } else {
        door.add(tick);
        ticks.push_back(tick);
      }
      const auto asked = static_cast<uint32_t>(below(400)), now = static_cast<uint32_t>(below(200));
      EXPECT_NEAR(door.pass_time(asked, now), pass_time_by_events(ticks, flow, asked, now), 1e-6);
    }
  }
}

// As time goes on, what was is forgotten, but for those who are late and still here.
TEST(DoorQueue, days_take_no_more_memory_and_tell_the_same) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const double flow = 0.5 + 2 * random_unit(seed, 1, 0);
    DoorQueue door(flow);
    std::vector<uint32_t> ticks;
    uint64_t draws = 0;
    const auto below = [&](uint64_t end) { return random_below(seed, 2, draws++, end); };
    uint32_t now = 0;
    size_t most = 0;
    for (int change = 0; change < 20000; ++change) {
      // Nights are long: nobody comes for hours.
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
      const auto asked = now + static_cast<uint32_t>(below(3000));
      const double pass_time = pass_time_by_events(ticks, flow, asked, now);
      ASSERT_NEAR(door.pass_time(asked, now), pass_time, 1e-9 * pass_time) << change;
      most = std::max(most, door.kept());
    }
    EXPECT_LE(most, 8192U);
  }
}

TEST(DoorQueue, times_beyond_reason_are_held) {
  DoorQueue door(1);
  EXPECT_EQ(DoorQueue::tick(-3), 0U);
  const uint32_t last = DoorQueue::tick(INFINITY);
  EXPECT_EQ(last, DoorQueue::tick(1e12));
  const uint32_t kept = door.add(last);
  EXPECT_EQ(kept, DoorQueue::tick(6 * 3600));
  door.remove(kept);
  EXPECT_DOUBLE_EQ(door.pass_time(0, 0), 1);
}

}  // namespace
}  // namespace throng
