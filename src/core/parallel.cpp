// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

// parallel_for and its kin on TBB arenas.
namespace throng {
namespace {

// One arena per thread count and group for the life of the process: starting threads for each call
// costs more than a whole step of a small crowd. More threads than cores are allowed if requested
// (results do not depend on it, and tests prove that); without a global_control TBB warns of it on
// standard error.
tbb::task_arena& arena_for(int32_t threads) {
  static std::mutex mutex;
  static std::map<std::pair<int32_t, int32_t>, std::unique_ptr<tbb::task_arena>> arenas;
  constexpr size_t kMaxThreads = 256;
  static const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, kMaxThreads);
  const std::lock_guard lock(mutex);
  auto& arena = arenas[{worker_group(), threads}];
  if (!arena) arena = std::make_unique<tbb::task_arena>(threads);
  return *arena;
}

}  // namespace

int32_t worker_count(int32_t workers) {
  return workers > 0 ? workers : std::max(1, tbb::info::default_concurrency());
}

void parallel_ranges(size_t count, size_t grain, int32_t workers,
                     FunctionRef<void(size_t, size_t)> body) {
  if (count == 0) return;
  const int32_t threads = worker_count(workers);
  if (threads == 1 || count <= grain) {
    body(0, count);
    return;
  }
  arena_for(threads).execute([&] {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, std::max<size_t>(grain, 1)),
                      [&](const tbb::blocked_range<size_t>& r) { body(r.begin(), r.end()); });
  });
}

void parallel_for_worker(size_t count, int32_t workers, FunctionRef<void(size_t, int32_t)> body) {
  const int32_t threads = worker_count(workers);
  if (threads == 1) {
    for (size_t i = 0; i < count; ++i) body(i, 0);
    return;
  }
  arena_for(threads).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, count, 1),
        [&](const tbb::blocked_range<size_t>& r) {
          const int32_t worker = tbb::this_task_arena::current_thread_index();
          for (size_t i = r.begin(); i < r.end(); ++i) body(i, worker);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace throng
