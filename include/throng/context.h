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

/// Where a long call is. `total` is 0 while it is not yet known.
struct Progress {
  std::string_view stage;  ///< "read", "bake", "verify" ...: valid during the callback only.
  uint64_t done = 0;
  uint64_t total = 0;
};

/// What a long call asks and tells its caller. A default Context runs silently to the end.
struct Context {
  /// Called now and then, never from two threads at once. May set `cancel`.
  std::function<void(const Progress&)> on_progress;
  /// Set from any thread (or a signal handler) to stop: the call returns Errc::kCancelled.
  std::atomic<bool> cancel{false};
};

}  // namespace throng
