// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace throng {
namespace {

TEST(Parallel, RangesVisitEveryIndexOnceForAnyNumberOfWorkers) {
  for (const int32_t workers : {1, 2, 3, 8, 0}) {
    for (const size_t count : {size_t{0}, size_t{1}, size_t{7}, size_t{1000}, size_t{10007}}) {
      for (const size_t grain : {size_t{1}, size_t{64}, size_t{20000}}) {
        std::vector<int> visits(count, 0);
        parallel_ranges(count, grain, workers, [&](size_t begin, size_t end) {
          for (size_t i = begin; i < end; ++i) ++visits[i];
        });
        EXPECT_EQ(visits, std::vector<int>(count, 1)) << workers << " workers, grain " << grain;
      }
    }
  }
}

TEST(Parallel, NoTwoThreadsEverShareAWorkerNumber) {
  for (const int32_t workers : {1, 2, 5}) {
    std::vector<std::atomic<int>> inside(static_cast<size_t>(worker_count(workers)));
    std::atomic<int> overlaps{0};
    std::vector<int> visits(2000, 0);
    parallel_for_worker(visits.size(), workers, [&](size_t index, int32_t worker) {
      ASSERT_GE(worker, 0);
      ASSERT_LT(worker, worker_count(workers));
      if (inside[static_cast<size_t>(worker)]++ != 0) ++overlaps;
      ++visits[index];
      --inside[static_cast<size_t>(worker)];
    });
    EXPECT_EQ(overlaps, 0);
    EXPECT_EQ(visits, std::vector<int>(2000, 1));
  }
}

TEST(Parallel, WorkersMayWorkInsideAWorker) {
  std::vector<int> sums(16, 0);
  parallel_for(sums.size(), 2, [&](size_t outer) {
    std::vector<int> inner(100, 0);
    parallel_for(inner.size(), 2, [&](size_t i) { inner[i] = static_cast<int>(i); });
    for (const int value : inner) sums[outer] += value;
  });
  EXPECT_EQ(sums, std::vector<int>(16, 4950));
}

TEST(Parallel, GroupsVisitEveryIndexOnceAndWorkOnThreadsOfTheirOwn) {
  for (const int32_t groups : {1, 2, 5}) {
    std::vector<std::atomic<int>> inside(static_cast<size_t>(groups));
    std::atomic<int> overlaps{0};
    std::vector<int> sums(200, 0);
    parallel_groups(sums.size(), groups, [&](size_t index, int32_t group) {
      if (inside[static_cast<size_t>(group)]++ != 0) ++overlaps;
      // Scratch memory of a group's workers: no other group may use it.
      std::vector<std::atomic<int>> used(2);
      std::atomic<int> sum{0};
      parallel_for_worker(100, 2, [&](size_t i, int32_t worker) {
        if (used[static_cast<size_t>(worker)]++ != 0) ++overlaps;
        sum += static_cast<int>(i);
        --used[static_cast<size_t>(worker)];
      });
      sums[index] += sum;
      --inside[static_cast<size_t>(group)];
    });
    EXPECT_EQ(overlaps, 0);
    EXPECT_EQ(sums, std::vector<int>(200, 4950)) << groups << " groups";
  }
}

TEST(Parallel, WhatAGroupThrowsIsThrownOnceTheOthersHaveEnded) {
  for (const int32_t groups : {1, 3}) {
    std::atomic<int> running{0};
    const auto run = [&] {
      parallel_groups(1000, groups, [&](size_t index, int32_t) {
        ++running;
        const bool fails = index == 20;
        --running;
        if (fails) throw std::runtime_error("the twentieth");
      });
    };
    EXPECT_THROW(run(), std::runtime_error);
    EXPECT_EQ(running, 0);
  }
}

// Each kind of loop over 1000 indices whose body throws at the twentieth.
TEST(Parallel, WhatABodyThrowsIsThrownOnceTheOthersHaveEnded) {
  for (const int32_t workers : {1, 3}) {
    std::atomic<int> running{0}, visits{0};
    const auto body = [&](size_t index) {
      ++running;
      ++visits;
      const bool fails = index == 20;
      --running;
      if (fails) throw std::runtime_error("the twentieth");
    };
    const auto ranges = [&] {
      parallel_ranges(1000, 1, workers, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) body(i);
      });
    };
    const auto indices = [&] { parallel_for(1000, workers, body); };
    const auto with_worker = [&] {
      parallel_for_worker(1000, workers, [&](size_t index, int32_t) { body(index); });
    };
    EXPECT_THROW(ranges(), std::runtime_error) << workers << " workers";
    EXPECT_EQ(running, 0);
    EXPECT_THROW(indices(), std::runtime_error) << workers << " workers";
    EXPECT_EQ(running, 0);
    EXPECT_THROW(with_worker(), std::runtime_error) << workers << " workers";
    EXPECT_EQ(running, 0);
    // The threads are as usable as before.
    visits = 0;
    parallel_for(20, workers, body);
    EXPECT_EQ(visits, 20);
  }
}

// A loop calls all its bodies; those that see the cancel do nothing.
TEST(Parallel, ACancelThatABodySetsIsSeenByAllThatBeginLater) {
  for (const int32_t workers : {1, 3}) {
    std::mutex mutex;
    bool cancel = false;
    int calls = 0, done = 0;
    parallel_for_worker(1000, workers, [&](size_t, int32_t) {
      const std::lock_guard lock(mutex);
      ++calls;
      if (cancel) return;
      if (++done == 20) cancel = true;
    });
    EXPECT_EQ(calls, 1000);
    EXPECT_EQ(done, 20);
  }
}

// A copy, of a body or of what it captures, would count.
TEST(Parallel, BodiesAreNeitherCopiedNorMoved) {
  struct Counted {
    std::atomic<int>& made;
    explicit Counted(std::atomic<int>& count) : made(count) {}
    Counted(const Counted& other) : made(other.made) { ++made; }
    Counted& operator=(const Counted&) = delete;
    ~Counted() = default;
  };
  for (const int32_t workers : {1, 3}) {
    std::atomic<int> made{0}, visits{0};
    const Counted counted(made);
    const auto ranges = [counted, &visits](size_t begin, size_t end) {
      visits += static_cast<int>(end - begin);
    };
    const auto index = [counted, &visits](size_t) { ++visits; };
    const auto with_number = [counted, &visits](size_t, int32_t) { ++visits; };
    const int captured = made;
    EXPECT_EQ(captured, 3);
    parallel_ranges(100, 1, workers, ranges);
    parallel_for(100, workers, index);
    parallel_for_worker(100, workers, with_number);
    parallel_groups(100, workers, with_number);
    EXPECT_EQ(visits, 400);
    EXPECT_EQ(made, captured) << workers << " workers";
  }
}

TEST(Parallel, WorkersAreAssignedSoThatNoneIsLeft) {
  for (int32_t workers = 1; workers <= 33; ++workers) {
    for (const size_t tasks : {size_t{0}, size_t{1}, size_t{3}, size_t{10}, size_t{5000}}) {
      const WorkerGroups assigned = assign_workers(tasks, workers);
      EXPECT_GE(assigned.groups * assigned.workers, workers);
      EXPECT_LT((assigned.groups - 1) * assigned.workers, 2 * workers);
      EXPECT_LE(assigned.groups, std::max<size_t>(tasks, 1));
      EXPECT_TRUE(workers >= 4 || assigned.groups == 1);
    }
  }
}

}  // namespace
}  // namespace throng
