// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <mutex>

/// Work beside a window, which must not wait for it: on a thread of its own, or, where there are no
/// threads, on a stack of its own that gets a share of each frame.
namespace throng {

class SideTask {
 public:
  /// Starts `work`, which throws nothing.
  explicit SideTask(std::function<void()> work);
  SideTask(const SideTask&) = delete;
  SideTask& operator=(const SideTask&) = delete;
  ~SideTask();  ///< Waits for its end.

  /// Lets it run until it has paused. Only for who owns it; does nothing where it has a thread.
  void turn();
  /// For the work itself, now and then: pauses if its share of the frame is used up. Does nothing
  /// on threads, or outside any task.
  static void breathe();
  /// For an owner who asks again and again: leaves a thread some time.
  static void nap();

 private:
  friend class SideSignal;
  static void pause();
  struct State;
  std::unique_ptr<State> state_;
};

/// Lets a task and its owner wait for each other.
class SideSignal {
 public:
  SideSignal();
  ~SideSignal();
  void notify_all();
  /// For the work: returns when `is_so`, which is asked with the lock held.
  void wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_so);
  /// For the task's owner, who lets it run meanwhile.
  void wait_for(SideTask& task, std::unique_lock<std::mutex>& lock,
                const std::function<bool()>& is_so);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace throng
