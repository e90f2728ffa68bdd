// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "core/parallel.h"

// parallel.h without oneTBB (option THRONG_STD_THREADS). ThreadSanitizer cannot see into Debian's
// oneTBB, so it would report races that are none; here it sees every hand-over. Threads are started
// for each call: slow, and not for anything but such builds.
namespace throng {
namespace {

// Calls body(piece, worker) for every piece in [0, pieces), each on whichever thread is free.
// Throws what a body threw first, once the others have ended; no piece is begun after it.
void share(size_t pieces, int32_t threads, FunctionRef<void(size_t, int32_t)> body) {
  std::atomic<size_t> next{0};
  std::mutex mutex;  // of the failure
  std::exception_ptr failure;
  const auto work = [&](int32_t worker) {
    try {
      for (size_t piece = next++; piece < pieces; piece = next++) body(piece, worker);
    } catch (...) {
      next = pieces;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::jthread> others;  // Joined before what they work on ends, whatever is thrown.
  others.reserve(static_cast<size_t>(threads));
  try {
    for (int32_t worker = 1; worker < threads; ++worker) others.emplace_back(work, worker);
  } catch (const std::system_error&) {
    // The system starts no more of them: those that run do the work.
  }
  work(0);
  others.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

int32_t worker_count(int32_t workers) {
  return workers > 0 ? workers
                     : std::max(1, static_cast<int32_t>(std::thread::hardware_concurrency()));
}

void parallel_ranges(size_t count, size_t grain, int32_t workers,
                     FunctionRef<void(size_t, size_t)> body) {
  if (count == 0) return;
  const int32_t threads = worker_count(workers);
  const size_t piece = std::max({grain, size_t{1}, count / (4 * static_cast<size_t>(threads))});
  if (threads == 1 || count <= grain) {
    body(0, count);
    return;
  }
  share((count + piece - 1) / piece, threads,
        [&](size_t index, int32_t) { body(index * piece, std::min(count, (index + 1) * piece)); });
}

void parallel_for_worker(size_t count, int32_t workers, FunctionRef<void(size_t, int32_t)> body) {
  share(count, worker_count(workers), body);
}

}  // namespace throng
