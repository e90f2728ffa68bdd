// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <thread>
#include <utility>

#include "core/function_ref.h"
#include "throng/base.h"

/// Threads only through here. Bodies write only what their index owns, so results never depend on
/// the number of workers. A body is called where it stands: it is neither copied nor moved. A loop
/// allocates nothing once its threads have started; parallel_groups starts threads in each call. If
/// a body throws, what has not begun may be left out, and once the others have ended the loop
/// throws it.
namespace throng {

/// Threads to use for a setting: 0 means all that the machine gives this process.
int32_t worker_count(int32_t workers);

/// Calls body(begin, end) over [0, count) in pieces of at least `grain`, on up to `workers`
/// threads. Exported for throng_draw, a library of its own.
THRONG_API void parallel_ranges(size_t count, size_t grain, int32_t workers,
                                FunctionRef<void(size_t begin, size_t end)> body);

/// Calls body(index) for every index in [0, count).
template <class Body>
void parallel_for(size_t count, int32_t workers, Body&& body) {
  parallel_ranges(count, 1, workers, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) body(i);
  });
}

/// Like parallel_for, but also gives the body the worker that it runs on: [0,
/// worker_count(workers)). For scratch memory only; the result must not depend on it.
void parallel_for_worker(size_t count, int32_t workers,
                         FunctionRef<void(size_t index, int32_t worker)> body);

/// How workers are assigned to tasks of which each could use several: where there are many, each
/// task has one, and as many are done side by side, with the memory of as many. Few do one after
/// the other.
struct WorkerGroups {
  int32_t groups = 1;
  int32_t workers = 1;  ///< Of each.
};
WorkerGroups assign_workers(size_t tasks, int32_t workers);

/// Calls body(index, group) for every index in [0, count), begun in order, from a thread of each of
/// `groups`. What is called in it with several workers runs on threads of that group's own. Throws
/// what a body threw, once the others have ended.
void parallel_groups(size_t count, int32_t groups,
                     FunctionRef<void(size_t index, int32_t group)> body);

/// The group of parallel_groups that this thread belongs to, from 1; 0: none.
int32_t worker_group();

/// A thread for work that must not hold up its owner, which waits for it with join(), at the latest
/// when it is destroyed.
class SideThread {
 public:
  explicit SideThread(std::function<void()> body)
      : thread_([this, run = std::move(body)] {
          try {
            run();
          } catch (...) {
            failure_ = std::current_exception();
          }
        }) {}
  SideThread(const SideThread&) = delete;
  SideThread& operator=(const SideThread&) = delete;
  ~SideThread() {
    if (thread_.joinable()) thread_.join();
  }
  /// Throws what the body threw.
  void join() {
    thread_.join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace throng
