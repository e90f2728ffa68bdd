// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <mutex>

#include "core/parallel.h"
#include "throng/base.h"

namespace throng {

/// Calls body(index, group) for every index in [0, count) by parallel_groups, and begin(index),
/// which reports progress, before each of them, one call at a time. Once one has failed or the
/// context is cancelled no more are begun. Fails with the failure of the lowest index that has one.
template <class Begin, class Body>
Result<void> side_by_side(size_t count, const WorkerGroups& assigned, const Context& context,
                          Begin begin, Body body) {
  std::mutex mutex;
  std::map<size_t, Error> failed;
  parallel_groups(count, assigned.groups, [&](size_t index, int32_t group) {
    {
      const std::lock_guard lock(mutex);
      if (!failed.empty() || context.cancel) return;
      begin(index);
    }
    if (Result<void> ok = body(index, group); !ok) {
      const std::lock_guard lock(mutex);
      failed.emplace(index, ok.error());
    }
  });
  if (!failed.empty()) return failed.begin()->second;
  return {};
}

}  // namespace throng
