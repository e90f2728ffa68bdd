// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "crowd/walk/queue.h"

namespace throng::crowd {
namespace {

QueueOrder random_order(uint64_t seed, uint32_t slot) {
  const auto number = [&](uint64_t n) {
    return static_cast<int32_t>(2e5 * (random_unit(seed, slot, n) - 0.5));
  };
  QueueOrder order;
  order.name = slot;
  order.at = {number(1), number(2)};
  order.target = {number(3), number(4)};
  order.beyond = {static_cast<float>(number(5)), static_cast<float>(number(6))};
  order.left = static_cast<float>(random_unit(seed, slot, 7));
  return order;
}

TEST(QueueOrder, OfTwoExactlyOneIsAhead) {
  for (uint32_t i = 0; i < 20000; ++i) {
    QueueOrder a = random_order(1, 2 * i), b = random_order(1, 2 * i + 1);
    if (i % 3 == 0) b.target = a.target;
    if (i % 5 == 0) b.at = a.at;
    if (i % 7 == 0) b.left = a.left;
    EXPECT_NE(a < b, b < a) << i;
    EXPECT_FALSE(a < a);
    EXPECT_TRUE(a < QueueOrder{});
    EXPECT_FALSE(QueueOrder{} < a);
  }
  EXPECT_FALSE(QueueOrder{} < QueueOrder{});
}

// Both head to the door at (0, 0): the goal behind it, which is nearer to the second, is no matter.
TEST(QueueOrder, TheNearerToTheDoorIsAheadWhateverItsGoal) {
  const QueueOrder near{5, {-1000, 0}, {0, 0}, {2, 0}, 20};
  const QueueOrder far{4, {-1500, 800}, {0, 0}, {2, 0}, 10};
  EXPECT_TRUE(near < far);
}

TEST(QueueOrder, OfTwoThatMeetTheShorterPathIsAhead) {
  const QueueOrder near{5, {-1000, 0}, {9000, 0}, {2, 0}, 20};
  const QueueOrder far{4, {-500, 0}, {-9000, 0}, {-2, 0}, 21};
  EXPECT_TRUE(near < far);
}

}  // namespace
}  // namespace throng::crowd
