// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/entry_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/random.h"

namespace throng::scenario {
namespace {

using Queue = EntryQueue<uint64_t>;

std::vector<uint64_t> all_of(const Queue& queue) {
  std::vector<uint64_t> all;
  queue.for_each([&](uint64_t entry) { all.push_back(entry); });
  return all;
}

// The same as one list, of which those that are due are tried in order.
struct PlainItem {
  uint64_t entry = 0;
  double due = 0;
};

TEST(EntryQueue, TriesInTheOrderInWhichTheyCameWhateverTheirOrigin) {
  Queue queue;
  std::vector<PlainItem> plain;
  queue.resize(3);
  constexpr double kLater[] = {0, 0, 2};  // [s] The third origin is a link that takes a while.
  uint64_t pushed = 0;
  for (uint64_t step = 0; step < 300; ++step) {
    const auto time = static_cast<double>(step) * 0.1;
    for (uint64_t k = random_below(1, 0, step, 6); k-- > 0; ++pushed) {
      const uint64_t origin = random_below(2, 0, pushed, 3);
      queue.push(origin, time + kLater[origin], pushed);
      plain.push_back({pushed, time + kLater[origin]});
    }
    queue.begin_step(time);
    for (uint64_t round = 0; round < 3; ++round) {
      std::vector<uint64_t> expected, tried;
      for (const PlainItem& item : plain) {
        if (item.due <= time) expected.push_back(item.entry);
      }
      const auto gets_in = [&](uint64_t entry) {
        return random_below(3, step * 3 + round, entry, 4) == 0;
      };
      queue.begin_round();
      for (size_t max_count = 2;; max_count *= 2) {
        const std::vector<uint64_t*> batch = queue.next(max_count);
        if (batch.empty()) break;
        ASSERT_LE(batch.size(), max_count);
        std::vector<bool> entered;
        for (const uint64_t* entry : batch) {
          tried.push_back(*entry);
          entered.push_back(gets_in(*entry));
        }
        queue.settle(entered);
      }
      ASSERT_EQ(tried, expected) << step;
      std::erase_if(plain, [&](const PlainItem& i) { return i.due <= time && gets_in(i.entry); });
      ASSERT_EQ(queue.size(), plain.size());
      std::vector<uint64_t> left;
      for (const PlainItem& item : plain) left.push_back(item.entry);
      ASSERT_EQ(all_of(queue), left) << step;
    }
  }
  EXPECT_GT(pushed, 500u);
}

// Returns how many were tried in a step of four rounds in which `room` of origin 0 get in, and all
// of the others.
uint64_t tries_of_step(Queue& queue, size_t room, uint64_t first_of_others, uint64_t& others_in) {
  uint64_t tries = 0;
  queue.begin_step(0);
  for (int round = 0; round < 4; ++round) {
    queue.begin_round();
    for (size_t max_count = 1024;; max_count *= 2) {
      const std::vector<uint64_t*> batch = queue.next(max_count);
      if (batch.empty()) break;
      tries += batch.size();
      std::vector<bool> entered;
      for (const uint64_t* entry : batch) {
        const bool is_other = *entry >= first_of_others;
        entered.push_back(is_other || room > 0);
        others_in += is_other ? 1 : 0;
        if (!is_other && room > 0) --room;
      }
      queue.settle(entered);
    }
  }
  return tries;
}

TEST(EntryQueue, WhatAFullOriginCostsDoesNotDependOnHowManyWait) {
  for (const size_t room : {0, 1, 100}) {
    uint64_t tries[2];
    for (const size_t big : {0, 1}) {
      Queue queue;
      queue.resize(2);
      const uint64_t waiting = big == 0 ? 20000 : 200000;
      for (uint64_t n = 0; n < waiting; ++n) queue.push(0, 0, n);
      for (uint64_t n = 0; n < 50; ++n) queue.push(1, 0, waiting + n);
      uint64_t others_in = 0;
      tries[big] = tries_of_step(queue, room, waiting, others_in);
      EXPECT_EQ(others_in, 50u) << "a full origin stops no other";
      EXPECT_EQ(queue.size(), waiting - room);
    }
    EXPECT_EQ(tries[0], tries[1]) << room;
    EXPECT_LE(tries[0], 4096 + 3 * Queue::kTriesByEntry * room) << room;
  }
}

TEST(EntryQueue, AnOriginWithRoomIsNeverFull) {
  Queue queue;
  queue.resize(1);
  for (uint64_t n = 0; n < 5000; ++n) queue.push(0, 0, n);
  uint64_t others_in = 0;
  EXPECT_EQ(tries_of_step(queue, 5000, 5000, others_in), 5000u);
  EXPECT_TRUE(queue.empty());
}

}  // namespace
}  // namespace throng::scenario
