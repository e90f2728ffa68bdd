// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <emscripten/fiber.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

#include "view/side_task.h"

// A browser's page without threads: the work has a stack of its own, which is left in the middle of
// any call when its share of a frame is over, and entered again in the next. Emscripten's Asyncify
// makes that possible.
namespace throng {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kShare = std::chrono::milliseconds(12);  // Of a frame, for each task.
constexpr size_t kStack = 1 << 21;                      // [bytes]
constexpr size_t kUnwound = 1 << 18;                    // [bytes] What a paused stack is kept in.

// What code expects of its stack; malloc gives less.
struct alignas(16) StackBlock {
  std::array<uint8_t, 16> bytes;
};

}  // namespace

struct SideTask::State {
  explicit State(std::function<void()> given)
      : work(std::move(given)), stack(kStack / sizeof(StackBlock)), unwound(kUnwound) {
    emscripten_fiber_init(&fiber, &State::enter, this, stack.data(), kStack, unwound.data(),
                          unwound.size());
  }

  static void enter(void* self) {
    auto* state = static_cast<State*>(self);
    state->work();
    state->done = true;
    leave();
  }
  static void leave() {
    State* const self = running;
    running = self->caller;
    emscripten_fiber_swap(&self->fiber, self->back);
  }

  std::function<void()> work;
  std::vector<StackBlock> stack;
  std::vector<uint8_t> unwound;
  emscripten_fiber_t fiber{};
  emscripten_fiber_t* back = nullptr;  // Whoever let it run.
  State* caller = nullptr;             // The same, if that is a task, too.
  Clock::time_point until;
  bool done = false;

  static State* running;
};

SideTask::State* SideTask::State::running = nullptr;

namespace {

// The stack that the page calls on.
emscripten_fiber_t* page() {
  static emscripten_fiber_t fiber{};
  static std::array<uint8_t, kUnwound> unwound;
  static const bool made = [] {
    emscripten_fiber_init_from_current_context(&fiber, unwound.data(), unwound.size());
    return true;
  }();
  static_cast<void>(made);
  return &fiber;
}

}  // namespace

SideTask::SideTask(std::function<void()> work) : state_(std::make_unique<State>(std::move(work))) {}

SideTask::~SideTask() {
  while (!state_->done) turn();
}

void SideTask::turn() {
  State& s = *state_;
  if (s.done) return;
  s.caller = State::running;
  s.back = s.caller != nullptr ? &s.caller->fiber : page();
  s.until = Clock::now() + kShare;
  State::running = &s;
  emscripten_fiber_swap(s.back, &s.fiber);
}

void SideTask::breathe() {
  if (State::running != nullptr && Clock::now() >= State::running->until) State::leave();
}

void SideTask::nap() {}
void SideTask::pause() { State::leave(); }

struct SideSignal::State {};

SideSignal::SideSignal() = default;
SideSignal::~SideSignal() = default;

void SideSignal::notify_all() {}

void SideSignal::wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_so) {
  while (!is_so()) {
    lock.unlock();
    SideTask::pause();
    lock.lock();
  }
}

void SideSignal::wait_for(SideTask& task, std::unique_lock<std::mutex>& lock,
                          const std::function<bool()>& is_so) {
  while (!is_so()) {
    lock.unlock();
    task.turn();
    lock.lock();
  }
}

}  // namespace throng
