// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>

#include "throng/path.h"

// Budgets of searches as numbers, without a search.
namespace throng {
namespace {

TEST(SearchBudget, IsSpentBeyondItsNodesItsMemoryOrACancel) {
  const SearchBudget five = 5;
  for (uint64_t n = 1; n <= 5; ++n) EXPECT_FALSE(five.is_spent(n)) << n;
  EXPECT_TRUE(five.is_spent(6));
  EXPECT_FALSE(SearchBudget{}.is_spent(UINT64_MAX)) << "no limit";

  const SearchBudget small{100, nullptr, 1000};
  EXPECT_FALSE(small.is_spent(100, 1000));
  EXPECT_TRUE(small.is_spent(1, 1001));
  EXPECT_TRUE(small.is_spent(101, 0));

  std::atomic<bool> cancel = false;
  const SearchBudget until{1000, &cancel};
  for (uint64_t n = 1; n <= 200; ++n) EXPECT_FALSE(until.is_spent(n)) << n;
  cancel = true;
  for (uint64_t first = 1; first < 200; ++first) {  // Wherever it was when it was cancelled.
    uint64_t n = first;
    while (n < first + 64 && !until.is_spent(n)) ++n;
    EXPECT_LT(n, first + 64) << first;
  }
}

TEST(SearchBudget, NamesThePartThatIsSpent) {
  std::atomic<bool> cancel = false;
  const SearchBudget budget{10, &cancel, 1000};
  EXPECT_EQ(budget.spent(11), SpentBudget::kNodes);
  EXPECT_EQ(budget.spent(10), SpentBudget::kMemory) << "nothing else can have stopped it";
  cancel = true;
  EXPECT_EQ(budget.spent(1), SpentBudget::kCancelled);
  EXPECT_EQ(SearchBudget(10).spent(3), SpentBudget::kMemory);
}

TEST(SearchBudget, WhatIsLeftKeepsTheOtherLimits) {
  std::atomic<bool> cancel = true;
  const SearchBudget budget{100, &cancel, 1000};
  const SearchBudget left = budget.after(30);
  EXPECT_EQ(left.max_nodes, 70u);
  EXPECT_EQ(left.max_bytes, 1000u);
  EXPECT_EQ(left.cancel, &cancel);
  EXPECT_EQ(left.after(69).max_nodes, 1u);
  EXPECT_FALSE(SearchBudget{}.after(1'000'000).is_spent(1'000'000'000));
}

TEST(SearchBudget, MoreNodesThanItHasLeaveNone) {
  for (const uint64_t nodes : {uint64_t{100}, uint64_t{101}, UINT64_MAX}) {
    const SearchBudget left = SearchBudget(100).after(nodes);
    EXPECT_EQ(left.max_nodes, 0u) << nodes;
    EXPECT_TRUE(left.is_spent(1)) << nodes;
  }
  EXPECT_TRUE(SearchBudget(0).is_spent(1));
  EXPECT_EQ(SearchBudget(0).spent(1), SpentBudget::kNodes);
}

}  // namespace
}  // namespace throng
