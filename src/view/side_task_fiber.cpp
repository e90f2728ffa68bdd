// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <emscripten/fiber.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

#include "view/side_task.h"

// Tasks of a browser page without threads: the work has a stack of its own. It is left in the
// middle of any call when its share of a frame is used up, and entered again in the next frame, by
// means of Emscripten's Asyncify.
namespace throng::view {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kShare = std::chrono::milliseconds(12);  // Of a frame, for each task.
constexpr size_t kStack = 1 << 21;                      // [bytes]
constexpr size_t kUnwound = 1 << 18;  // [bytes] Buffer for the unwound stack of a paused task.

// Compiled code expects a stack aligned to 16 bytes; malloc gives less.
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
  emscripten_fiber_t* back = nullptr;  // The fiber that runs it.
  State* caller = nullptr;             // That fiber's task, or null.
  Clock::time_point until;
  bool done = false;

  static State* running;
};

SideTask::State* SideTask::State::running = nullptr;

namespace {

// The fiber of the page's own stack.
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
  while (!state_->done) run_slice();
}

void SideTask::run_slice() {
  State& s = *state_;
  if (s.done) return;
  s.caller = State::running;
  s.back = s.caller != nullptr ? &s.caller->fiber : page();
  s.until = Clock::now() + kShare;
  State::running = &s;
  emscripten_fiber_swap(s.back, &s.fiber);
}

void SideTask::pause_if_due() {
  if (State::running != nullptr && Clock::now() >= State::running->until) State::leave();
}

void SideTask::sleep_briefly() {}
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
    task.run_slice();
    lock.lock();
  }
}

}  // namespace throng::view
