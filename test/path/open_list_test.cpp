// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/open_list.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "core/random.h"

namespace throng {
namespace {

struct Entry {
  double cost = 0;
  uint32_t node = 0;
  bool operator<(const Entry& other) const {
    return cost != other.cost ? cost > other.cost : node > other.node;
  }
};

TEST(OpenList, GivesTheLeastCostFirstAndOfEqualCostsTheLowerNumber) {
  path::OpenList<Entry> open;
  for (const auto& [cost, node] : {std::pair{3.0, 1u}, {1.0, 7u}, {2.0, 0u}, {1.0, 2u}}) {
    open.push({cost, node});
  }
  std::vector<uint32_t> order;
  EXPECT_EQ(open.first().node, 2u);
  while (!open.empty()) order.push_back(open.pop().node);
  EXPECT_EQ(order, (std::vector<uint32_t>{2, 7, 0, 1}));
}

TEST(OpenList, ServesAnyOrderThatIsGiven) {
  path::OpenList<std::pair<double, uint32_t>, std::greater<>> open;
  open.push({2, 5});
  open.push({1, 9});
  open.push({1, 3});
  EXPECT_EQ(open.pop(), (std::pair<double, uint32_t>{1, 3}));
  EXPECT_EQ(open.pop(), (std::pair<double, uint32_t>{1, 9}));
}

// Random pushes and pops with many equal costs, beside the standard library's queue.
TEST(OpenList, AgreesWithAPriorityQueue) {
  path::OpenList<Entry> open;
  std::priority_queue<Entry> queue;
  uint32_t number = 0;
  for (uint64_t n = 0; n < 20000; ++n) {
    if (random_unit(1, 1, n) < 0.6) {
      const Entry entry{std::floor(random_unit(1, 2, n) * 8), number++};
      open.push(entry);
      queue.push(entry);
    } else if (!queue.empty()) {
      const Entry entry = open.pop();
      ASSERT_EQ(std::tie(entry.cost, entry.node), std::tie(queue.top().cost, queue.top().node));
      queue.pop();
    }
    ASSERT_EQ(open.size(), queue.size());
  }
}

TEST(OpenList, KeepsTheOrderOfWhatStaysAndAsksForEachEntryOnce) {
  path::OpenList<Entry> open;
  for (uint32_t n = 0; n < 1000; ++n) open.push({static_cast<double>(n * 7919 % 97), n});
  std::vector<int> asked(1000, 0);
  open.keep_if([&](const Entry& entry) {
    ++asked[entry.node];
    return entry.node % 3 != 0;
  });
  EXPECT_EQ(asked, std::vector<int>(1000, 1));
  EXPECT_EQ(open.size(), 666u);
  Entry before = open.pop();
  while (!open.empty()) {
    const Entry entry = open.pop();
    EXPECT_NE(entry.node % 3, 0u);
    EXPECT_TRUE(std::tie(before.cost, before.node) < std::tie(entry.cost, entry.node));
    before = entry;
  }
}

TEST(OpenList, CountsWhatItUsesAndGivesBackWhatItAllocated) {
  path::OpenList<Entry> open;
  for (uint32_t n = 0; n < 100; ++n) open.push({1, n});
  EXPECT_EQ(open.used_bytes(), 3 * 100 * sizeof(Entry));
  EXPECT_GE(open.allocated_bytes(), 100 * sizeof(Entry));
  open.clear();
  EXPECT_EQ(open.used_bytes(), 0u);
  EXPECT_GE(open.allocated_bytes(), 100 * sizeof(Entry));
  open.give_back();
  EXPECT_EQ(open.allocated_bytes(), 0u);
}

}  // namespace
}  // namespace throng
