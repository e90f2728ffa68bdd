// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <condition_variable>
#include <thread>
#include <utility>

#include "view/side_task.h"

// Tasks as threads: the functions for fibers do nothing.
namespace throng::view {

struct SideTask::State {
  std::thread thread;
};

SideTask::SideTask(std::function<void()> work)
    : state_(std::make_unique<State>(State{std::thread(std::move(work))})) {}

SideTask::~SideTask() { state_->thread.join(); }

void SideTask::run_slice() {}
void SideTask::pause_if_due() {}
void SideTask::sleep_briefly() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }
void SideTask::pause() {}

struct SideSignal::State {
  std::condition_variable condition;
};

SideSignal::SideSignal() : state_(std::make_unique<State>()) {}
SideSignal::~SideSignal() = default;

void SideSignal::notify_all() { state_->condition.notify_all(); }

void SideSignal::wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_so) {
  state_->condition.wait(lock, is_so);
}

void SideSignal::wait_for(SideTask&, std::unique_lock<std::mutex>& lock,
                          const std::function<bool()>& is_so) {
  state_->condition.wait(lock, is_so);
}

}  // namespace throng::view
