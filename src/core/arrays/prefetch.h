// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

namespace throng {

/// Asks for the cache line at `p`, which need not be readable.
inline void prefetch(const void* p) {
  __builtin_prefetch(p);
  // To g++ 12 a prefetch is no effect: it deletes calls of functions that do nothing else, and the
  // loops around them. The empty statement, which emits nothing, is one.
  asm volatile("" : : "r"(p));
}

}  // namespace throng
