// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <mutex>

/// Work beside a window, which must not wait for it: on a thread of its own or, without threads, on
/// a fiber that gets a share of each drawn frame.
namespace throng::view {

class SideTask {
 public:
  /// Starts `work`, which throws nothing.
  explicit SideTask(std::function<void()> work);
  SideTask(const SideTask&) = delete;
  SideTask& operator=(const SideTask&) = delete;
  ~SideTask();  ///< Waits for the end of the work.

  /// Runs a fiber until it pauses. Only for the owner; does nothing with threads.
  void run_slice();
  /// Pauses a fiber whose share of the frame is used up. The work calls it now and then; does
  /// nothing with threads, or outside a task.
  static void pause_if_due();
  /// For an owner that polls: sleeps for a millisecond, with threads.
  static void sleep_briefly();

 private:
  friend class SideSignal;
  static void pause();
  struct State;
  std::unique_ptr<State> state_;
};

/// A condition variable between a task and its owner.
class SideSignal {
 public:
  SideSignal();
  ~SideSignal();
  void notify_all();
  /// For the work: returns when `is_so`, which is called with the lock held.
  void wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_so);
  /// For the task's owner; a fiber runs meanwhile.
  void wait_for(SideTask& task, std::unique_lock<std::mutex>& lock,
                const std::function<bool()>& is_so);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace throng::view
