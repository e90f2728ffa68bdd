// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/parallel.h"

// parallel.h where there are no threads: in a browser's page, which may have them only from hosts
// that send special headers.
namespace throng {

int32_t worker_count(int32_t) { return 1; }

void parallel_ranges(size_t count, size_t, int32_t, FunctionRef<void(size_t, size_t)> body) {
  if (count > 0) body(0, count);
}

void parallel_for_worker(size_t count, int32_t, FunctionRef<void(size_t, int32_t)> body) {
  for (size_t i = 0; i < count; ++i) body(i, 0);
}

}  // namespace throng
