// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include "core/parallel.h"

// Runs tasks side by side in groups of workers: one group per task at a time, with all workers of a
// group in it.
namespace throng {
namespace {

thread_local int32_t t_group = 0;  // of this thread

}  // namespace

int32_t worker_group() { return t_group; }

WorkerGroups assign_workers(size_t tasks, int32_t workers) {
  constexpr int32_t kMinThreads = 4;  // Fewer seldom wait for each other.
  const int32_t threads = worker_count(workers);
  const auto max_groups = static_cast<int32_t>(std::clamp<size_t>(tasks, 1, 1024));
  const int32_t groups = threads < kMinThreads ? 1 : std::min(threads, max_groups);
  return {groups, (threads + groups - 1) / groups};
}

void parallel_groups(size_t count, int32_t groups, FunctionRef<void(size_t, int32_t)> body) {
  if (groups <= 1) {
    for (size_t i = 0; i < count; ++i) body(i, 0);
    return;
  }
  std::atomic<size_t> next{0};
  std::atomic<bool> failed{false};
  const auto run = [&](int32_t group) {
    t_group = group + 1;
    try {
      for (size_t i = next++; i < count && !failed; i = next++) body(i, group);
    } catch (...) {
      failed = true;
      throw;
    }
  };
  std::vector<std::unique_ptr<SideThread>> threads;
  for (int32_t group = 0; group < groups; ++group) {
    threads.push_back(std::make_unique<SideThread>([&run, group] { run(group); }));
  }
  std::exception_ptr failure;
  for (const auto& thread : threads) {
    try {
      thread->join();
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace throng
