// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace throng {

/// Empties a vector and gives its memory back; `v = {}` would keep it.
template <class Value>
void release(std::vector<Value>& values) {
  std::vector<Value>().swap(values);
}

}  // namespace throng
