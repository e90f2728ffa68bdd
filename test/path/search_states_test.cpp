// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/search_states.h"

#include <gtest/gtest.h>

#include <vector>

namespace throng {
namespace {

struct State {
  uint32_t search = 0;
  int32_t value = 0;
};

template <class States>
void expect_that_a_search_forgets_the_one_before(States states) {
  states.begin(2000);
  EXPECT_FALSE(states.is_reached(states[7]));
  states[7] = {states.search(), 1};
  states[1999] = {states.search(), 2};
  EXPECT_TRUE(states.is_reached(states[7]));
  EXPECT_EQ(states[1999].value, 2);
  states.grow(3000);
  EXPECT_TRUE(states.is_reached(states[7]));
  EXPECT_FALSE(states.is_reached(states[2999]));
  states.begin(3000);
  EXPECT_FALSE(states.is_reached(states[7]));
  EXPECT_FALSE(states.is_reached(states[1999]));
}

TEST(SearchStates, OfOneSearchAreNotThoseOfTheNext) {
  expect_that_a_search_forgets_the_one_before(path::SearchStates<State>());
  expect_that_a_search_forgets_the_one_before(path::SearchStates<State, std::vector<State>>());
}

TEST(SearchStates, InPagesTakeMemoryOnlyWhereTheyWereReached) {
  path::SearchStates<State> states;
  states.begin(size_t{1} << 20);
  EXPECT_EQ(states.allocated_bytes(), 0u);
  states[1 << 19] = {states.search(), 1};
  EXPECT_GT(states.allocated_bytes(), 0u);
  EXPECT_LT(states.allocated_bytes(), sizeof(State) << 12);
  states.give_back();
  EXPECT_EQ(states.allocated_bytes(), 0u);
  EXPECT_FALSE(states.is_reached(states[1 << 19]));
}

}  // namespace
}  // namespace throng
