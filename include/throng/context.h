// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>

#include "throng/base.h"

/// Progress and cancel for long calls. One Context may serve several calls, from several threads.
namespace throng {

/// How far a long call has come. `total` is 0 while it is unknown.
struct Progress {
  std::string_view stage;  ///< "read", "bake", "verify" ...: valid during the callback only.
  uint64_t done = 0;
  uint64_t total = 0;
};

/// Connects a long call to its caller. With a default Context it runs silently to the end.
struct Context {
  /// Called from time to time, never by two threads at once. May set `cancel`.
  std::function<void(const Progress&)> on_progress;
  /// Set from any thread (or a signal handler) to stop: the call returns Errc::kCancelled.
  std::atomic<bool> cancel{false};
};

}  // namespace throng
