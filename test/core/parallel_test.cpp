// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
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
    std::atomic<int> clashes{0};
    std::vector<int> visits(2000, 0);
    parallel_for_worker(visits.size(), workers, [&](size_t index, int32_t worker) {
      ASSERT_GE(worker, 0);
      ASSERT_LT(worker, worker_count(workers));
      if (inside[static_cast<size_t>(worker)]++ != 0) ++clashes;
      ++visits[index];
      --inside[static_cast<size_t>(worker)];
    });
    EXPECT_EQ(clashes, 0);
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

}  // namespace
}  // namespace throng
